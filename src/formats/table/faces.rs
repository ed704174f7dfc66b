//! Triangles from faces, strips and fans.

use super::points::Points;
use crate::formats::Faces;

/// Collects triangles between the points.
pub struct Collector<'a> {
    points: &'a Points,
    keep: bool,
    /// The triangles, if they are kept.
    pub triangles: Vec<[u32; 3]>,
    pub faces: Faces,
    /// The corners of the triangles as they were given, of readers that ask for them.
    pub given: Option<Vec<[f64; 3]>>,
}

impl<'a> Collector<'a> {
    /// Collects triangles between `points` with `keep`; otherwise counts them.
    pub fn new(points: &'a Points, keep: bool) -> Self {
        Self { points, keep, triangles: Vec::new(), faces: Faces::default(), given: None }
    }

    /// Adds a polygon as a fan.
    pub fn face(&mut self, corners: &[f64]) {
        let inside = corners.iter().all(|corner| self.points.of_corner(*corner).is_some());
        let mut understood = false;
        if let (true, [first, rest @ ..]) = (inside, corners) {
            for pair in rest.windows(2) {
                understood |= self.triangle([*first, pair[0], pair[1]]);
            }
        }
        self.count(understood);
    }

    /// Adds a triangle strip; −1 starts another. Every other triangle is wound the other way; degenerate triangles only continue the strip.
    pub fn strip(&mut self, corners: &[f64]) {
        for strip in corners.split(|corner| *corner == -1.0) {
            for (index, corners) in strip.windows(3).enumerate() {
                let &[a, b, c] = corners else { continue };
                if a == b || b == c || c == a {
                    continue;
                }
                let understood = self.triangle(if index % 2 == 0 { [a, b, c] } else { [b, a, c] });
                self.count(understood);
            }
        }
    }

    /// Adds a triangle with three different points.
    pub fn add(&mut self, triangle: [u32; 3]) {
        self.count(true);
        if self.keep {
            self.triangles.push(triangle);
        }
    }

    /// Counts a face.
    pub fn count(&mut self, understood: bool) {
        if understood { self.faces.understood += 1 } else { self.faces.skipped += 1 }
    }

    /// Adds a triangle if its corners are three different points; returns whether they are.
    fn triangle(&mut self, corners: [f64; 3]) -> bool {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| self.points.of_corner(corner)) else {
            return false;
        };
        let proper = a != b && b != c && c != a;
        if proper && self.keep {
            self.triangles.push([a, b, c]);
            self.given.iter_mut().for_each(|given| given.push(corners));
        }
        proper
    }
}
