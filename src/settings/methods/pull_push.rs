//! `pull-push` and `pull-push-paper`: *Efficient Image Reconstruction for Point-Based and Line-Based Rendering*, Marroquim, Kraus, Cavalcanti,
//! Computers & Graphics 2008.
//!
//! ```text
//! project, fetch   surfels, lines, triangles → the nearest point of each pixel (§3.1)
//! pull             means of the discs in front, fine to coarse (§3.2)
//! push             holes filled, hidden points replaced, coarse to fine (§3.3)
//! shade            picture, normal, depth (§3.4)
//! ```

use super::{Method, perspective_ewa};
use crate::settings::pull_push::{PullPush, Rules};
use crate::settings::{Alpha, Cull, Edges};

/// The preset with robust rules.
pub const METHOD: Method =
    Method { name: "pull-push", pull_push: Some(PullPush::of(Rules::Robust)), cull: Cull::Auto, ..PAPER };

/// The preset as published.
pub const PAPER: Method = Method {
    name: "pull-push-paper",
    paper: "Marroquim, Kraus, Cavalcanti, Efficient Image Reconstruction for Point-Based and Line-Based Rendering, 2008",
    pull_push: Some(PullPush::of(Rules::Paper)),
    pixel_filter: 0.0,
    cull: Cull::Back,
    alpha: Alpha::Mask,
    edges: Edges::Nearest,
    ..perspective_ewa::METHOD
};
