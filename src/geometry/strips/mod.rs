//! Lines from meshes of plants: leaves become ribbons, branches become tubes (marroquim2008, section 4.3).
//!
//! Triangles that share sides form a component. Coincident vertices are welded, because programs often write the corners of each face anew.
//! A small open sheet that is longer than wide becomes a [ribbon](leaf), rings of vertices become a [tube](branch); all other triangles are
//! kept.

mod branch;
mod component;
mod leaf;
mod line_cloud;
mod weld;

use super::Cloud;
use crate::error::Result;
use component::components;
use line_cloud::LineCloud;
use weld::weld;

/// Options of [`Cloud::to_lines`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToLines {
    /// Largest radius of a tube, in the positions' unit; by default 1/250 of the diagonal of the mesh's bounds, which is four pixels in a
    /// picture of a thousand. Thick trunks are kept as triangles: the lighting of tubes is correct only for thin ones.
    pub thickest: Option<f32>,
}

/// Counts of [`Cloud::to_lines`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Lined {
    /// Number of triangles, without degenerate and duplicate ones.
    pub triangles: u64,
    /// Number of triangles that became ribbons, and of their segments.
    pub leaves: [u64; 2],
    /// Number of triangles that became tubes, and of their segments.
    pub branches: [u64; 2],
    /// Number of vertices of the triangles, and of the result.
    pub vertices: [u64; 2],
}

/// Radius of the default [thickest](ToLines::thickest) tube, in diagonals of the bounds.
const THICKEST: f64 = 1.0 / 250.0;

impl Cloud {
    /// Replaces leaves and branches among the cloud's triangles by ribbons and tubes. Other triangles, lines and other points are kept;
    /// unused points are removed.
    ///
    /// A new vertex has the mean colour, in linear light, of the vertices that it replaces, and their most frequent material; it has no
    /// scalar. A texture becomes colours.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::Error::Usage) if there are more than 2³² − 1 points afterwards.
    pub fn to_lines(&self, how: &ToLines) -> Result<(Self, Lined)> {
        if self.texture.is_some() {
            let mut coloured = self.clone();
            coloured.bake_texture();
            return coloured.to_lines(how);
        }
        let welded = weld(&self.positions, &self.triangles);
        let thickest = how.thickest.map_or(THICKEST * welded.diagonal, f64::from);
        let mut line_cloud = LineCloud::new(self, &welded);
        let mut lined = Lined { triangles: welded.triangles.len() as u64, ..Default::default() };
        for component in components(&welded) {
            if let Some(rows) = leaf::rows(&component, &welded) {
                lined.leaves[0] += component.len() as u64;
                lined.leaves[1] += line_cloud.ribbon(&rows, &component);
                continue;
            }
            let tubes = branch::tubes(&component, &welded, thickest);
            lined.branches[0] += (component.len() - tubes.rest.len()) as u64;
            lined.branches[1] += line_cloud.tubes(&tubes, &component);
            line_cloud.keep(&tubes.rest);
        }
        let cloud = line_cloud.finish(&mut lined)?;
        Ok((cloud, lined))
    }
}

#[cfg(test)]
mod tests;
