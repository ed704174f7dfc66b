//! Meshes of plants as lines: leaves become ribbons, branches tubes (marroquim2008, section 4.3).
//!
//! Triangles that share sides are one component; vertices at one place are one, as programs often write the corners of each face anew. A
//! small open sheet that is longer than wide becomes a [ribbon](leaf); rings of vertices become a [tube](branch); the rest stays.

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

/// What becomes of a mesh's triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToLines {
    /// Largest radius of a tube, in the positions' unit; unless given 1/250 of the diagonal of the mesh's bounds, which is four pixels in a
    /// picture of a thousand. A thick trunk stays as it is: a tube's light is right of thin ones alone.
    pub thickest: Option<f32>,
}

/// What came of triangles, as numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lined {
    /// Triangles that there were, less those without area or there twice.
    pub triangles: u64,
    /// Triangles that became ribbons, and the segments that they became.
    pub leaves: [u64; 2],
    /// Triangles that became tubes, and the segments that they became.
    pub branches: [u64; 2],
    /// Vertices that triangles had, and vertices of what there is now.
    pub vertices: [u64; 2],
}

/// Part of the diagonal of the bounds that is the [thickest](ToLines::thickest) tube's radius.
const THICKEST: f64 = 1.0 / 250.0;

impl Cloud {
    /// Leaves and branches of the cloud's triangles as ribbons and tubes; triangles that are neither, lines and other points stay. Points
    /// that nothing uses any more go.
    ///
    /// New vertices have the mean colour, in linear light, of those that they stand for, and the material that most of them have; they
    /// have no scalar. A texture becomes colours.
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
