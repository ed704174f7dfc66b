//! Metrics: the difference of a picture from the truth. One file per metric, each with its definition, source, range
//! and unit.
//!
//! | module | measures | better |
//! |---|---|---|
//! | [`rmse`] | root mean square difference of colours | less |
//! | [`psnr`] | RMSE in decibels below the peak | more |
//! | [`ssim`] | structural similarity | more |
//! | [`flip`] | difference perceived when flipping between both | less |
//! | [`coverage`] | holes and bloat of the silhouette | |
//! | [`normals`] | angle between normals | less |
//! | [`depth`] | difference of depths | less |
//! | [`flicker`] | error that varies from frame to frame | less |
//! | [`path`] | error, change and flicker of each frame along a camera path | |
//!
//! All but `flicker` and `path` take a [`Pair`], which has checked both pictures: equal size, complete, all values finite. A
//! metric is therefore always a number. [`report::measure`] computes all of them.
//!
//! Colours are compared over a background, [composited](colour::over) with straight α: a pixel's colour is weighted by
//! its coverage, and a missing surface counts as its difference from the background.

pub mod colour;
pub mod coverage;
pub mod depth;
pub mod flicker;
pub mod flip;
pub mod normals;
mod pair;
pub mod path;
pub mod psnr;
mod regions;
pub mod report;
pub mod rmse;
pub mod ssim;
mod statistics;

pub use pair::{NonFinite, Pair, Side, covers};
pub use report::{Better, Measured, Metric, Options, measure};
