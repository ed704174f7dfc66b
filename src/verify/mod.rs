//! What pictures are held to: the float64 twin of every pass, exact images, measures of error, scenes with exact surfaces, and a native program.

#[cfg(feature = "bench")]
pub mod baseline;
#[cfg(feature = "metrics")]
pub mod metrics;
#[cfg(feature = "reference")]
pub mod reference;
#[cfg(feature = "scenes")]
pub mod scenes;
#[cfg(feature = "truth")]
pub mod truth;
