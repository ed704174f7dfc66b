//! The layer over raw Vulkan: the only module beside `embed` where `unsafe` is allowed. Devices, their limits and presentation are public;
//! buffers, pipelines and recording are internal:
//!
//! ```compile_fail,E0603
//! use surfel::vk::{Buffer, Commands, ComputePipeline, DescriptorSet, Framebuffer, Uploads};
//! ```
//!
//! Every owner of a Vulkan object holds an `Arc` of the [`Device`] and destroys the object on drop. No object is dropped while the GPU uses
//! it: a frame is waited for before its resources are dropped. On an external device, the recorder of a frame keeps its resources until the
//! host reports that the frame is over, see [`crate::embed`].
#![allow(unsafe_code)]

mod access;
mod buffer;
#[cfg(feature = "window")]
mod capture;
mod choose;
mod command_pool;
mod commands;
mod descriptor_pool;
mod descriptors;
mod device;
mod draw_state;
mod encoder;
mod external_device;
mod image;
mod instance;
mod labels;
mod limits;
mod memory;
#[cfg(feature = "window")]
mod overlay;
mod pipeline;
mod pipeline_cache;
mod pipeline_pool;
#[cfg(feature = "window")]
mod presenter;
mod recorder;
mod render_pass;
mod requirements;
mod set_layout;
mod shader_stage;
#[cfg_attr(
    not(all(feature = "bench", feature = "window")),
    allow(dead_code, reason = "some are for benchmarks or windows alone")
)]
pub(crate) mod shaders;
#[cfg(feature = "window")]
mod slot;
mod subgroups;
#[cfg(feature = "window")]
mod surface;
#[cfg(feature = "window")]
mod swapchain;
mod timestamps;
mod tracker;
mod transfer;
mod validation;

pub(crate) use access::{Access, Use};
pub(crate) use buffer::{Buffer, TexelView};
pub use choose::{DeviceDescription, describe_devices, preferred};
#[cfg(feature = "window")]
pub use command_pool::CommandPool;
pub(crate) use commands::Commands;
pub(crate) use descriptors::{Binding, DescriptorSet, HostDepth, input_layout};
pub use device::{Device, DeviceOptions, Usage};
pub(crate) use draw_state::{Blend, DepthTest, DrawState, Topology, Within};
pub(crate) use encoder::{Draws, Encoder};
pub use external_device::ExternalDevice;
pub(crate) use image::{Image, ImageUse, pixel_bytes};
pub use limits::{Capabilities, DeviceLimits};
pub use memory::{HostMemory, Location, MemoryBlocks, MemoryError, MemoryRequest, MemorySource};
pub(crate) use pipeline::{ComputePipeline, DrawPipeline};
#[cfg(feature = "window")]
pub(crate) use presenter::Stake;
#[cfg(feature = "window")]
pub use presenter::{FRAMES_IN_FLIGHT, Presented, Presenter};
pub(crate) use recorder::{Recorder, Update};
pub(crate) use render_pass::{Attachment, Framebuffer, RenderPass};
pub use requirements::{ABILITIES, API_VERSION, Abilities, Ability, Features, QUEUE};
pub(crate) use set_layout::SetLayout;
pub(crate) use shader_stage::{Code, Constants};
#[cfg(feature = "window")]
pub use surface::{Surface, Window};
pub use timestamps::PassTime;
pub(crate) use timestamps::{HostPass, Timestamps};
pub use transfer::Staging;
pub(crate) use transfer::{Pieces, Uploads};

/// Locks a mutex, also after a panic of another thread: what these mutexes guard is consistent at any time.
fn lock<T>(mutex: &std::sync::Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
