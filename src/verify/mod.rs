//! Verification of pictures: the float64 reference of every pass, exact images, metrics of error, scenes with exact surfaces, and the CPU
//! baseline.

#[cfg(feature = "bench")]
pub mod baseline;
#[cfg(feature = "scenes")]
mod hierarchy;
#[cfg(feature = "metrics")]
pub mod metrics;
#[cfg(feature = "reference")]
pub mod reference;
#[cfg(feature = "scenes")]
pub mod scenes;
#[cfg(feature = "truth")]
pub mod truth;
