//! The point octree of pajarola2004: levels of detail by division at the mean of the points.
//!
//! A node divides its points into octants about their mean, and stores the surfel that stands for them, their bounding sphere and their cone of
//! normals (section 3.2). For a camera, the nodes whose ellipses are small enough in the picture are [selected](PointOctree::select) on the
//! CPU, without what is outside it or faces away (section 6.2). [`Levels`](super::Levels) are selected on the GPU instead.

mod covariance;
mod node;
mod select;
mod split;
#[cfg(test)]
mod tests;

use super::{Bounds, Colours, Ellipse, Surfels, srgb};
use crate::Progress;
use crate::error::{Error, Result};
use node::{Builder, Node};
use rayon::prelude::*;
pub use select::{Selected, Selection};
use split::{Point, split};

/// Points with the nodes of their octree.
#[derive(Clone, Debug, Default)]
pub struct PointOctree {
    /// The valid points, in the order of the tree.
    surfels: Surfels,
    /// Each before its children.
    nodes: Vec<Node>,
}

/// How large the ellipses of nodes are. Their axes are those of the covariance in the tangent plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ellipses {
    /// The least that bound the boxes around the discs of all points (section 4.3): they cover what the discs cover.
    #[default]
    Bounding,
    /// As large as those of [`Levels`](super::Levels), by the covariance alone: smaller, and so sharper.
    Covariance,
}

impl PointOctree {
    /// Builds the octree of the valid ones of `surfels`. Every point counts alike in the means.
    ///
    /// # Errors
    /// [`Error::Usage`] for surfels with normalization weights, which do not aggregate; [`Error::Cancelled`].
    pub fn build(mut surfels: Surfels, ellipses: Ellipses, progress: &dyn Progress) -> Result<Self> {
        if surfels.weights.is_some() {
            let text = "surfels with normalization weights have no point octree: remove the weights";
            return Err(Error::Usage(text.into()));
        }
        surfels.check()?;
        let valid = (0..surfels.len()).into_par_iter().filter(|i| surfels.is_valid(*i));
        let point = |i: usize| Point { position: surfels.positions[i], index: i as u32 };
        let mut points: Vec<_> = valid.map(point).collect();
        let cells = split(&mut points, progress)?;
        let order: Vec<u32> = points.iter().map(|point| point.index).collect();
        drop(points);
        surfels.permute(&order);
        let origin = Bounds::of(&surfels.positions).map(|bounds| bounds.centre()).unwrap_or_default();
        let builder = Builder { surfels: &surfels, origin, ellipses, light: srgb::decode_table() };
        let covariances = builder.covariances(&cells);
        let nodes =
            cells.par_iter().zip(&covariances).map(|(cell, covariance)| builder.node(*cell, covariance));
        let nodes = nodes.collect();
        Ok(Self { surfels, nodes })
    }

    /// The points, in the order of the tree.
    pub fn points(&self) -> &Surfels {
        &self.surfels
    }

    /// Number of nodes, leaves included.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Bytes of the nodes, 84 each, and of the points' positions, normals, radii, ellipses and colours.
    pub fn bytes(&self) -> u64 {
        let surfels = &self.surfels;
        let colour = match &surfels.colours {
            Some(Colours::Srgb8(_)) => size_of::<[u8; 4]>(),
            Some(Colours::Linear(_)) => size_of::<[f32; 3]>(),
            None => 0,
        };
        let ellipse = surfels.ellipses.as_ref().map_or(0, |_| size_of::<Ellipse>());
        let point = 2 * size_of::<glam::Vec3>() + size_of::<f32>() + ellipse + colour;
        (self.nodes.len() * size_of::<Node>() + surfels.len() * point) as u64
    }

    /// The surfels that are selected: first points, then those that stand for nodes, each in the order of the tree.
    pub fn surfels(&self, selected: &Selected) -> Surfels {
        let mut all = self.surfels.clone();
        all.permute(&selected.points);
        if !selected.nodes.is_empty() {
            // Points are circles where none are ellipses, nodes never are.
            let circles = || all.normals.iter().map(|normal| Ellipse::circle(*normal)).collect();
            let ellipses = all.ellipses.take().unwrap_or_else(circles);
            all.ellipses = Some(ellipses);
            let discs = selected.nodes.iter().map(|node| &self.nodes[*node as usize].disc);
            all.append_discs(discs.clone(), self.surfels.sampled(discs));
        }
        all
    }
}
