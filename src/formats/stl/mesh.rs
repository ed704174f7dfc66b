//! Triangles that share vertices.

use crate::formats::source::Parsed;
use std::collections::HashMap;

/// Vertices at different coordinates, and triangles between them.
#[derive(Debug, Default)]
pub struct Mesh {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// Bytes after the last triangle.
    pub trailing: u64,
}

/// Makes a mesh of triangles that are given by the coordinates of their corners.
#[derive(Default)]
pub struct Welder {
    mesh: Mesh,
    /// The vertex at the coordinates with these bits.
    at: HashMap<[u64; 3], u32>,
}

impl Welder {
    /// Adds a triangle.
    pub fn triangle(&mut self, corners: [[f64; 3]; 3]) -> Parsed<()> {
        let [a, b, c] = corners;
        let triangle = [self.vertex(a)?, self.vertex(b)?, self.vertex(c)?];
        self.mesh.triangles.push(triangle);
        Ok(())
    }

    fn vertex(&mut self, position: [f64; 3]) -> Parsed<u32> {
        let count = self.mesh.vertices.len();
        // −0 is 0.
        let bits = position.map(|coordinate| (coordinate + 0.0).to_bits());
        let vertex = *self.at.entry(bits).or_insert(u32::try_from(count).unwrap_or(u32::MAX));
        if vertex == u32::MAX {
            return Err(format!("more than {count} vertices: divide the file").into());
        }
        if vertex as usize == count {
            self.mesh.vertices.push(position);
        }
        Ok(vertex)
    }

    /// The mesh, with so many bytes after the last triangle.
    pub fn finish(self, trailing: u64) -> Mesh {
        Mesh { trailing, ..self.mesh }
    }
}
