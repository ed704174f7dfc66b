//! The layer over raw Vulkan: the only place, beside the embedding and the swapchain, where `unsafe` is allowed.
//!
//! Everything that owns a Vulkan object holds an `Arc` of the [`Device`] and destroys the object when it is dropped; nothing is
//! dropped while the GPU still uses it, because a frame is waited for before its resources can be; on a device that a host lends, because
//! whoever records there keeps what a frame uses until the host says that it is over, see [`crate::embed`].
#![allow(unsafe_code)]

mod access;
mod buffer;
mod choose;
mod commands;
mod descriptors;
mod device;
mod encoder;
mod image;
mod instance;
mod limits;
mod memory;
mod pipeline;
mod pipeline_cache;
mod recorder;
mod render_pass;
mod requirements;
pub mod shaders;
mod timestamps;
mod transfer;
mod validation;

pub use access::{Access, Use};
pub use buffer::Buffer;
pub use choose::{DeviceDescription, describe_devices, preferred};
pub use commands::Commands;
pub use descriptors::{Binding, DescriptorSet, HostDepth, SetLayout, input_layout};
pub use device::{Device, DeviceOptions, Lent, Usage};
pub use encoder::{Draws, Encoder};
pub use image::{Image, ImageUse, pixel_bytes};
pub use limits::{Capabilities, DeviceLimits};
pub use memory::{HostMemory, Location, MemoryRequest, MemorySource};
pub use pipeline::{Blend, ComputePipeline, Constants, DepthTest, DrawPipeline, DrawState, Topology, Within};
pub use recorder::Recorder;
pub use render_pass::{Attachment, Framebuffer, RenderPass};
pub use requirements::{ABILITIES, API_VERSION, Abilities, Ability, Features, QUEUE};
pub use timestamps::PassTime;
pub use transfer::{Staging, Uploads};
