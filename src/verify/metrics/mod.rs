//! How far a picture is from the truth. One file a metric, each with its definition, source, range and unit.
//!
//! | module | what it says | better |
//! |---|---|---|
//! | [`rmse`] | root of the mean square difference of colours | less |
//! | [`psnr`] | the same as decibels below the peak | more |
//! | [`ssim`] | structural similarity | more |
//! | [`flip`] | difference that a viewer sees who flips between the two | less |
//! | [`coverage`] | where only one of both has a surface | |
//! | [`normals`] | angle between normals | less |
//! | [`depth`] | difference of depths | less |
//! | [`flicker`] | error that comes and goes from frame to frame | less |
//!
//! All but `flicker` take a [`Pair`], which has looked at both pictures: same size, whole, and no value that is not finite. So a metric
//! is always a plain number. [`report::measure`] takes them all at once.
//!
//! Colours are compared as they look on a background, [composited](colour::over) with straight α: a pixel's colour counts as far as it
//! is covered, and a surface that is missing counts as the difference from the background.

pub mod colour;
pub mod coverage;
pub mod depth;
pub mod flicker;
pub mod flip;
pub mod normals;
mod pair;
pub mod psnr;
mod regions;
pub mod report;
pub mod rmse;
pub mod ssim;
mod statistics;

pub use pair::{NonFinite, Pair, Side, covers};
pub use report::{Better, Measured, Metric, Options, measure};
