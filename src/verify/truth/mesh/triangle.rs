//! Watertight ray–triangle intersection (Woop, Benthin, Wald, *Watertight Ray/Triangle Intersection*, Journal of
//! Computer Graphics Techniques 2013).

use glam::DVec3;

/// A prepared ray: a permutation that puts its longest axis last, and a shear that aligns the ray with that axis.
pub struct Ray {
    origin: DVec3,
    axes: [usize; 3],
    shear: DVec3,
}

impl Ray {
    /// `None` for a zero direction.
    pub fn new(origin: DVec3, direction: DVec3) -> Option<Self> {
        let z = direction.abs().max_position();
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if direction[z] == 0.0 {
            return None;
        }
        // Keeps the winding.
        if direction[z] < 0.0 {
            (x, y) = (y, x);
        }
        let shear = DVec3::new(direction[x], direction[y], 1.0) / direction[z];
        Some(Self { origin, axes: [x, y, z], shear })
    }

    /// Intersection with a triangle at `t > 0`, in lengths of the direction, and barycentric weights of the corners.
    /// Edges belong to the triangle.
    pub fn meet(&self, corners: [DVec3; 3]) -> Option<(f64, DVec3)> {
        let [x, y, z] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let p = corner - self.origin;
            DVec3::new(p[x] - self.shear.x * p[z], p[y] - self.shear.y * p[z], self.shear.z * p[z])
        });
        let edges = DVec3::new(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
        if edges.min_element() < 0.0 && edges.max_element() > 0.0 {
            return None;
        }
        let weights = edges / edges.element_sum();
        let t = weights.dot(DVec3::new(a.z, b.z, c.z));
        // A triangle seen edge-on divides 0 by 0.
        (t > 0.0 && t.is_finite()).then_some((t, weights))
    }
}
