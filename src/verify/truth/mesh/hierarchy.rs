//! Bounding volume hierarchy of triangles, by the crate `bvh`.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, BvhNode, rayon_executor};
use bvh::ray::Ray;
use glam::DVec3;
use nalgebra::{Point3, Vector3};

/// Relative widening of boxes against rounding, of the largest coordinate.
const MARGIN: f64 = 1e-12;

/// A bounding volume hierarchy.
pub struct Hierarchy(Bvh<f64, 3>);

struct Item {
    bounds: Aabb<f64, 3>,
    node: usize,
}

impl Bounded<f64, 3> for Item {
    fn aabb(&self) -> Aabb<f64, 3> {
        self.bounds
    }
}

impl BHShape<f64, 3> for Item {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Hierarchy {
    /// The hierarchy of `boxes`, which are identified by their indices.
    pub fn new(boxes: &[[DVec3; 2]]) -> Self {
        let largest = boxes.iter().flatten().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
        let margin = DVec3::splat(MARGIN * largest);
        let item = |[min, max]: &[DVec3; 2]| {
            let (min, max) = ((min - margin).to_array(), (max + margin).to_array());
            Item { bounds: Aabb::with_bounds(Point3::from(min), Point3::from(max)), node: 0 }
        };
        let mut items: Vec<_> = boxes.iter().map(item).collect();
        Self(Bvh::build_with_executor(&mut items, rayon_executor))
    }

    /// Calls `visit` for the boxes that a ray may hit, near ones first, with the current distance limit; `visit`
    /// returns the new limit.
    pub fn visit(&self, origin: DVec3, direction: DVec3, mut visit: impl FnMut(usize, f64) -> f64) {
        let ray = Ray::new(Point3::from(origin.to_array()), Vector3::from(direction.to_array()));
        let mut limit = f64::INFINITY;
        let mut open = vec![(0.0, 0)];
        while let Some((near, node)) = open.pop() {
            if near > limit {
                continue;
            }
            match &self.0.nodes[node] {
                BvhNode::Leaf { shape_index, .. } => limit = visit(*shape_index, limit),
                BvhNode::Node { child_l_index, child_l_aabb, child_r_index, child_r_aabb, .. } => {
                    let enter = |bounds| ray.intersection_slice_for_aabb(bounds).map(|slice| slice.0);
                    let left = enter(child_l_aabb).map(|near| (near, *child_l_index));
                    let right = enter(child_r_aabb).map(|near| (near, *child_r_index));
                    match (left, right) {
                        // The last pushed is visited next.
                        (Some(a), Some(b)) if a.0 < b.0 => open.extend([b, a]),
                        (a, b) => open.extend([a, b].into_iter().flatten()),
                    }
                }
            }
        }
    }
}
