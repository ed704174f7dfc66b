//! Bounding volume hierarchy.

use glam::DVec3;

/// A bounding volume hierarchy, traversed from near to far.
pub struct Hierarchy {
    /// The first node is the root.
    nodes: Vec<Node>,
}

struct Node {
    corners: [DVec3; 2],
    content: Content,
}

enum Content {
    Item(u32),
    Children([u32; 2]),
}

/// Relative widening of boxes against rounding, of the largest coordinate.
const MARGIN: f64 = 1e-12;

/// The box around two boxes.
pub fn union(a: [DVec3; 2], b: [DVec3; 2]) -> [DVec3; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

impl Hierarchy {
    /// The hierarchy of items with these boxes; items are identified by their indices.
    pub fn new(boxes: &[[DVec3; 2]]) -> Self {
        let mut hierarchy = Self { nodes: Vec::with_capacity(2 * boxes.len()) };
        let largest = boxes.iter().flatten().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        if !items.is_empty() {
            hierarchy.build(boxes, MARGIN * largest, &mut items);
        }
        hierarchy
    }

    /// Adds the node of `items`, split at the median along the longest side, and returns its index.
    fn build(&mut self, boxes: &[[DVec3; 2]], margin: f64, items: &mut [u32]) -> u32 {
        let all = items.iter().map(|i| boxes[*i as usize]).reduce(union).unwrap_or_default();
        let index = self.nodes.len() as u32;
        self.nodes
            .push(Node { corners: [all[0] - margin, all[1] + margin], content: Content::Item(items[0]) });
        if items.len() > 1 {
            let side = all[1] - all[0];
            let axis = (0..3).max_by(|a, b| side[*a].total_cmp(&side[*b])).unwrap_or(0);
            let middle = |i: &u32| boxes[*i as usize][0][axis] + boxes[*i as usize][1][axis];
            let half = items.len() / 2;
            items.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
            let (low, high) = items.split_at_mut(half);
            let children = [self.build(boxes, margin, low), self.build(boxes, margin, high)];
            self.nodes[index as usize].content = Content::Children(children);
        }
        index
    }

    /// Calls `visit` with every item whose box a ray enters before `limit`, and the current limit; `visit` returns the
    /// new one. Limits are in lengths of the direction.
    pub fn visit(
        &self,
        [origin, direction]: [DVec3; 2],
        mut limit: f64,
        mut visit: impl FnMut(u32, f64) -> f64,
    ) {
        let inverse = direction.recip();
        let enter = |node: u32| enter(self.nodes[node as usize].corners, origin, inverse);
        let mut todo = Vec::with_capacity(64);
        todo.extend(self.nodes.first().and_then(|_| enter(0)).map(|t| (0, t)));
        while let Some((node, t)) = todo.pop() {
            if t >= limit {
                continue;
            }
            match self.nodes[node as usize].content {
                Content::Item(item) => limit = visit(item, limit),
                // The nearer one last, as that is taken first.
                Content::Children([a, b]) => match (enter(a), enter(b)) {
                    (Some(to_a), Some(to_b)) if to_a < to_b => {
                        todo.push((b, to_b));
                        todo.push((a, to_a));
                    }
                    (to_a, to_b) => {
                        to_a.into_iter().for_each(|t| todo.push((a, t)));
                        to_b.into_iter().for_each(|t| todo.push((b, t)));
                    }
                },
            }
        }
    }
}

/// Distance at which a ray enters a box; 0 if it starts inside.
#[inline]
fn enter(corners: [DVec3; 2], origin: DVec3, inverse: DVec3) -> Option<f64> {
    let (mut from, mut to) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let a = (corners[0][axis] - origin[axis]) * inverse[axis];
        let b = (corners[1][axis] - origin[axis]) * inverse[axis];
        // In a side's plane, 0 · ∞ is NaN, which min and max ignore: that side excludes nothing.
        from = from.max(a.min(b));
        to = to.min(a.max(b));
    }
    (from <= to * (1.0 + 1e-15)).then_some(from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_box_on_the_way_is_visited_and_no_other() {
        let corner = |i: u32| DVec3::new(f64::from(i % 7), f64::from(i / 7 % 7), f64::from(i / 49));
        let boxes: Vec<_> = (0..343).map(|i| [corner(i), corner(i) + 0.5]).collect();
        let hierarchy = Hierarchy::new(&boxes);
        let ray = [DVec3::new(-1.0, 2.25, 3.25), DVec3::X];
        let mut visited = Vec::new();
        hierarchy.visit(ray, f64::INFINITY, |item, limit| {
            visited.push(item);
            limit
        });
        let expected: Vec<u32> = (0..7).map(|x| x + 7 * 2 + 49 * 3).collect();
        assert_eq!(visited, expected, "near to far");
        let mut visited = Vec::new();
        hierarchy.visit(ray, 3.2, |item, limit| {
            visited.push(item);
            limit
        });
        assert_eq!(visited, expected[..3]);
        Hierarchy::new(&[]).visit(ray, 1.0, |_, _| panic!("there is no box"));
    }
}
