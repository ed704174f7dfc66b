//! `points`: every point a circle of one size on the screen, as viewers of point clouds draw them.
//!
//! ```text
//! footprint    point → a circle of a fixed diameter, px, at the depth of its centre
//! visibility   the nearest circle of each pixel
//! ```
//!
//! It needs neither normals nor radii, so that files load without estimation. It is the quickest look at a cloud, and no surface: it has holes
//! where points are sparse, and shows what is behind through them. It is no method of [`Method::ALL`], whose errors are measured.

use super::Method;
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use crate::settings::{Alpha, Cull, Edges, Settings, Widen};

/// The preset.
pub const METHOD: Method = Method {
    name: "points",
    paper: "circles of a fixed size in px, without a surface; of no paper",
    splatting: Splatting {
        footprint: Footprint::Point,
        kernel: Kernel::Gaussian,
        filter: Filter::None,
        visibility: Visibility::Nearest,
        normalization: Normalization::None,
        shade: Shade::Splat,
    },
    pull_push: None,
    cutoff: 3.5,
    lowpass: 0.0,
    pixel_filter: 0.0,
    widen: Widen::All,
    cull: Cull::None,
    alpha: Alpha::Mask,
    edges: Edges::Nearest,
};

/// The settings of points of this diameter, px.
pub fn settings(size: f32) -> Settings {
    Settings { point_size: size, ..METHOD.settings() }
}
