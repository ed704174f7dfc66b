//! Tangents and radii of lines.

use super::Estimated;
use crate::geometry::{Bounds, Cloud};
use glam::{DVec3, Vec3};
use std::collections::VecDeque;

/// Radius of lines without any radius, in diagonals of the lines' bounds.
const THIN: f64 = 1.0 / 2000.0;

/// Adjacency of vertices by segments.
struct Graph {
    /// Start of each vertex's neighbours; the last entry is the end.
    first: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Graph {
    fn new(count: usize, segments: impl Iterator<Item = [u32; 2]> + Clone) -> Self {
        let mut first = vec![0u32; count + 1];
        segments.clone().flatten().for_each(|i| first[i as usize + 1] += 1);
        for i in 0..count {
            first[i + 1] += first[i];
        }
        let mut next = first.clone();
        let mut neighbours = vec![0; first[count] as usize];
        for [a, b] in segments {
            for (from, to) in [(a, b), (b, a)] {
                let place = &mut next[from as usize];
                neighbours[*place as usize] = to;
                *place += 1;
            }
        }
        Self { first, neighbours }
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let i = vertex as usize;
        &self.neighbours[self.first[i] as usize..self.first[i + 1] as usize]
    }
}

/// Unit tangents of the vertices of tubes, 0 for others. A missing tangent is the mean direction of the vertex's segments (marroquim2008,
/// section 4.3), each oriented from the start of the line, whichever end the file has first.
pub(super) fn tangents(cloud: &Cloud) -> Vec<Vec3> {
    let mut tangents = vec![Vec3::ZERO; cloud.len()];
    if cloud.tubes.is_empty() {
        return tangents;
    }
    let graph = Graph::new(cloud.len(), cloud.tubes.iter().copied());
    let means = means(&cloud.positions, &graph);
    for i in (0..cloud.len()).filter(|&i| !graph.of(i as u32).is_empty()) {
        let given = cloud.tangents.as_ref().map_or(Vec3::ZERO, |tangents| tangents[i]);
        tangents[i] = if given == Vec3::ZERO { means[i] } else { given };
    }
    tangents
}

/// The mean direction at each vertex, by a traversal of each segment once from the ends of the lines.
fn means(positions: &[Vec3], graph: &Graph) -> Vec<Vec3> {
    const NOT_YET: u32 = u32::MAX;
    let count = positions.len() as u32;
    let (mut sums, mut any) = (vec![DVec3::ZERO; count as usize], vec![Vec3::ZERO; count as usize]);
    let mut step = vec![NOT_YET; count as usize];
    let mut add = |a: u32, b: u32| {
        let along = positions[b as usize].as_dvec3() - positions[a as usize].as_dvec3();
        let along = along.normalize_or_zero();
        for i in [a as usize, b as usize] {
            sums[i] += along;
            if any[i] == Vec3::ZERO {
                any[i] = along.as_vec3();
            }
        }
    };
    let ends = (0..count).filter(|&i| graph.of(i).len() == 1);
    let mut steps = 0;
    // Rings have no ends.
    for start in ends.chain(0..count) {
        if step[start as usize] != NOT_YET {
            continue;
        }
        (step[start as usize], steps) = (steps, steps + 1);
        let mut stack = vec![(start, start, graph.of(start).iter())];
        while let Some((from, parent, rest)) = stack.last_mut() {
            let (from, parent) = (*from, *parent);
            match rest.next() {
                None => drop(stack.pop()),
                Some(&to) if step[to as usize] == NOT_YET => {
                    add(from, to);
                    (step[to as usize], steps) = (steps, steps + 1);
                    stack.push((to, from, graph.of(to).iter()));
                }
                // A ring closes once: at the vertex that was visited before.
                Some(&to) if to != parent && step[to as usize] < step[from as usize] => add(from, to),
                Some(_) => {}
            }
        }
    }
    let mean = |(sum, any): (&DVec3, &Vec3)| {
        if sum.length() > 1e-3 {
            sum.normalize().as_vec3()
        } else {
            // Segments there and back again cancel.
            *any
        }
    };
    sums.iter().zip(&any).map(mean).collect()
}

/// Radii of all vertices. Missing ones of lines in `given` are `requested`, or are derived from the others.
pub(super) fn radii(
    cloud: &Cloud,
    given: Vec<f32>,
    requested: Option<f32>,
    estimated: &mut Estimated,
) -> Vec<f32> {
    let mut radii = given;
    let segments = || cloud.ribbons.iter().chain(&cloud.tubes).copied();
    let graph = Graph::new(cloud.len(), segments());
    let lines: Vec<u32> = (0..cloud.len() as u32).filter(|&i| !graph.of(i).is_empty()).collect();
    let mut known: VecDeque<u32> = lines.iter().copied().filter(|&i| radii[i as usize] > 0.0).collect();
    estimated.line_radii_given = known.len() as u64;
    if requested.is_none() {
        while let Some(from) = known.pop_front() {
            for &to in graph.of(from) {
                if radii[to as usize] == 0.0 {
                    radii[to as usize] = radii[from as usize];
                    estimated.line_radii_from_lines += 1;
                    known.push_back(to);
                }
            }
        }
    }
    let places: Vec<Vec3> = lines.iter().map(|&i| cloud.positions[i as usize]).collect();
    let diagonal = Bounds::of(&places).map_or(0.0, |bounds| bounds.min.distance(bounds.max));
    let rest = requested.unwrap_or((THIN * diagonal) as f32);
    for &i in lines.iter().filter(|&&i| radii[i as usize] == 0.0).collect::<Vec<_>>() {
        radii[i as usize] = rest;
        match requested {
            Some(_) => estimated.line_radii_given += 1,
            None => estimated.line_radii_from_extent += 1,
        }
    }
    radii
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(points: &[[f32; 3]], tubes: &[[u32; 2]]) -> Cloud {
        Cloud {
            positions: points.iter().map(|p| Vec3::from(*p)).collect(),
            tubes: tubes.to_vec(),
            ..Default::default()
        }
    }

    #[test]
    fn tangents_go_along_the_line_whichever_end_comes_first() {
        let corner = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [9.0, 9.0, 9.0]];
        let diagonal = Vec3::new(1.0, 1.0, 0.0).normalize();
        for tubes in [[[0, 1], [1, 2]], [[0, 1], [2, 1]], [[1, 0], [1, 2]], [[2, 1], [1, 0]]] {
            let found = tangents(&cloud(&corner, &tubes));
            assert!((found[1] - diagonal).length() < 1e-6, "{tubes:?}: {found:?}");
            assert_eq!((found[0], found[2], found[3]), (Vec3::X, Vec3::Y, Vec3::ZERO));
        }
        let mut given = cloud(&corner, &[[0, 1], [1, 2]]);
        given.tangents = Some(vec![Vec3::ZERO, Vec3::Z, Vec3::ZERO, Vec3::Z]);
        let found = tangents(&given);
        assert_eq!((found[0], found[1], found[3]), (Vec3::X, Vec3::Z, Vec3::ZERO));
    }

    #[test]
    fn tangents_agree_around_rings_and_at_forks() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let ring = tangents(&cloud(&square, &[[0, 1], [2, 1], [3, 2], [3, 0]]));
        let middle = Vec3::new(0.5, 0.5, 0.0);
        let turns: Vec<f32> =
            ring.iter().zip(square).map(|(t, p)| (Vec3::from(p) - middle).cross(*t).z).collect();
        assert!(turns.iter().all(|turn| (turn * turns[0] - 0.5).abs() < 1e-6), "{ring:?}");
        let fork = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let found = tangents(&cloud(&fork, &[[1, 2], [0, 1], [3, 1]]));
        assert!(found.iter().all(|t| (t.length() - 1.0).abs() < 1e-6), "{found:?}");
        // There and back again.
        let back = tangents(&cloud(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]], &[[0, 1], [1, 2]]));
        assert_eq!(back[1], Vec3::X);
    }

    #[test]
    fn radii_come_from_the_line_or_from_the_extent() {
        let points: Vec<_> = (0..7u8).map(|i| [f32::from(i), 0.0, 0.0]).collect();
        let cloud = cloud(&points, &[[0, 1], [1, 2], [2, 3], [4, 5]]);
        let given = vec![0.5, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0];
        let mut counts = Estimated::default();
        let found = radii(&cloud, given.clone(), None, &mut counts);
        assert_eq!(found, [0.5, 0.5, 0.25, 0.25, 0.0025, 0.0025, 0.0]);
        let [given_count, lines, extent] =
            [counts.line_radii_given, counts.line_radii_from_lines, counts.line_radii_from_extent];
        assert_eq!([given_count, lines, extent], [2, 2, 2]);
        let mut counts = Estimated::default();
        let found = radii(&cloud, given, Some(2.0), &mut counts);
        assert_eq!(found, [0.5, 2.0, 2.0, 0.25, 2.0, 2.0, 0.0]);
        assert_eq!((counts.line_radii_given, counts.line_radii_from_extent), (6, 0));
    }
}
