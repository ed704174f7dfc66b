//! Clip lines along the boundaries of open meshes: discs do not reach beyond their surface there.

use super::sites::Sites;
use crate::geometry::{Clip, ClipLine, Clips, Surfels};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Largest radius of a disc at a boundary, in distances to the nearer of the boundary vertices next to it: farther away, the boundary may turn
/// inwards.
const REACH: f64 = 1.1;

/// Clips discs without a clip at the boundaries of the mesh of `triangles`: edges of one triangle. Coinciding points are one vertex. Returns
/// the number of new clips. If `scale` is given, the radii of discs at the boundary are limited to `scale` times [`REACH`] as well.
pub(super) fn clip(surfels: &mut Surfels, triangles: &[[u32; 3]], sites: &Sites, scale: Option<f32>) -> u64 {
    let boundary = Boundary::new(&surfels.positions, triangles, sites);
    if boundary.lines.is_empty() {
        return 0;
    }
    if let Some(scale) = scale {
        let is_clipped = |i: usize| surfels.clips.as_ref().is_some_and(|clips| clips.get(i).is_some());
        let keeps = |i: usize| is_clipped(i) || surfels.is_billboard(i);
        let most = |i: usize| (REACH * boundary.nearest(sites.of_point[i])) as f32 * scale;
        surfels.radii = (0..surfels.len())
            .into_par_iter()
            .map(|i| if keeps(i) { surfels.radii[i] } else { surfels.radii[i].min(most(i)) })
            .collect();
    }
    let new = |i: usize| {
        let (lines, normal) = (boundary.of(sites.of_point[i]), surfels.normals[i]);
        clip_of(lines, boundary.angles[sites.of_point[i] as usize], normal, &|line: &Line| {
            line.on(surfels.positions[i], normal, surfels.radii[i])
        })
    };
    let old = |i: usize| surfels.clips.as_ref().and_then(|clips| clips.get(i)).copied();
    let new = |i: usize| if surfels.is_billboard(i) { None } else { new(i) };
    let clips: Vec<_> = (0..surfels.len()).into_par_iter().map(|i| old(i).or_else(|| new(i))).collect();
    let count = (0..surfels.len()).filter(|&i| clips[i].is_some() && old(i).is_none()).count();
    surfels.clips = Clips::collect(clips);
    count as u64
}

/// A boundary edge near a vertex.
#[derive(Clone, Copy)]
struct Line {
    vertex: u32,
    /// A point of the edge, and the direction away from the mesh, in the plane of the triangle; unit.
    point: Vec3,
    outward: DVec3,
    /// The edge from the vertex, if this is one of its ends, not the corner of the triangle opposite to it.
    along: Option<DVec3>,
}

impl Line {
    /// The line in the tangent plane of a disc that reaches beyond it.
    fn on(&self, centre: Vec3, normal: Vec3, radius: f32) -> Option<ClipLine> {
        let offset = match self.along {
            Some(_) => 0.0,
            None => self.outward.dot((self.point - centre).as_dvec3()),
        };
        let line = ClipLine::of_half_space(self.outward, offset, normal)?;
        (line.offset < radius).then_some(line)
    }
}

/// The clip at the edges that end in a vertex with this normal, whose triangles have `angle` there, radians; without any, at the nearest two
/// edges.
fn clip_of(lines: &[Line], angle: f64, normal: Vec3, on: &dyn Fn(&Line) -> Option<ClipLine>) -> Option<Clip> {
    let ends: Vec<&Line> = lines.iter().filter(|line| line.along.is_some()).collect();
    match ends[..] {
        [a, b] => Clip::of_some([on(a), on(b)], angle > PI),
        [] => {
            let mut near: Vec<ClipLine> = lines.iter().filter_map(on).collect();
            near.sort_by(|a, b| a.offset.total_cmp(&b.offset));
            let mut nearest = near.into_iter();
            Clip::of_some([nearest.next(), nearest.next()], false)
        }
        _ => {
            let (gap, [a, b]) = widest_gap(&ends, normal)?;
            Clip::of_some([on(a), on(b)], gap < PI)
        }
    }
}

/// Where several boundaries meet, the widest angle without triangles around the normal, radians, and the edges that bound it; `None` where the
/// triangles overlap, seen along the normal.
fn widest_gap<'a>(ends: &[&'a Line], normal: Vec3) -> Option<(f64, [&'a Line; 2])> {
    let normal = normal.as_dvec3();
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    let mut edges: Vec<(f64, bool, &Line)> = ends
        .iter()
        .filter_map(|line| {
            let along = line.along?;
            // Whether the gap follows counter-clockwise.
            let opens = normal.cross(along).dot(line.outward) > 0.0;
            Some((along.dot(y).atan2(along.dot(x)), opens, *line))
        })
        .collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let next = |i: usize| edges[(i + 1) % edges.len()];
    let alternate = (0..edges.len()).all(|i| edges[i].1 != next(i).1);
    let gaps = (0..edges.len()).filter(|&i| edges[i].1).map(|i| {
        let (from, to) = (edges[i], next(i));
        ((to.0 - from.0).rem_euclid(2.0 * PI), [from.2, to.2])
    });
    gaps.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|_| alternate)
}

/// The boundary edges of a mesh.
struct Boundary {
    /// Sorted by vertex.
    lines: Vec<Line>,
    /// Sum of the triangles' angles at every vertex, radians.
    angles: Vec<f64>,
}

impl Boundary {
    fn new(positions: &[Vec3], triangles: &[[u32; 3]], sites: &Sites) -> Self {
        let vertices = |triangle: &[u32; 3]| triangle.map(|i| sites.of_point[i as usize]);
        let at = |site: u32| positions[sites.point[site as usize] as usize];
        let mut edges: Vec<([u32; 2], u32)> = triangles
            .par_iter()
            .map(vertices)
            .flat_map_iter(|[a, b, c]| [(a, b, c), (b, c, a), (c, a, b)])
            .filter(|&(a, b, c)| a != b && b != c && c != a)
            .map(|(a, b, opposite)| ([a.min(b), a.max(b)], opposite))
            .collect();
        edges.par_sort_unstable();
        let single = edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0]);
        let mut lines: Vec<Line> = single
            .filter_map(|([a, b], opposite)| {
                let along = (at(b) - at(a)).as_dvec3();
                let inwards = (at(opposite) - at(a)).as_dvec3();
                let outward = -inwards.reject_from(along).try_normalize()?;
                let line = |vertex, along| Line { vertex, point: at(a), outward, along };
                Some([line(a, Some(along)), line(b, Some(-along)), line(opposite, None)])
            })
            .flatten()
            .collect();
        lines.sort_by_key(|line| line.vertex);
        let mut angles = vec![0.0; sites.len()];
        for triangle in triangles.iter().map(vertices) {
            for turn in 0..3 {
                let [p, a, b] = [0, 1, 2].map(|i| at(triangle[(turn + i) % 3]).as_dvec3());
                angles[triangle[turn] as usize] += (a - p).angle_between(b - p);
            }
        }
        Self { lines, angles }
    }

    /// Distance to the nearer of the vertices next to this one on the boundary; infinite if it is not there.
    fn nearest(&self, vertex: u32) -> f64 {
        let edges = self.of(vertex).iter().filter_map(|line| line.along);
        edges.map(DVec3::length).fold(f64::INFINITY, f64::min)
    }

    /// The boundary edges at a vertex.
    fn of(&self, vertex: u32) -> &[Line] {
        let first = self.lines.partition_point(|line| line.vertex < vertex);
        let count = self.lines[first..].partition_point(|line| line.vertex == vertex);
        &self.lines[first..first + count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Surfels of radius 0.7 facing z at the corners of the unit squares for which `is_there`, with two triangles for each.
    fn sheet(is_there: impl Fn(i32, i32) -> bool) -> (Surfels, Vec<[u32; 3]>) {
        let (side, at) = (7, |x: i32, y: i32| (7 * y + x) as u32);
        let squares = (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| (x, y)));
        let triangles = squares.filter(|&(x, y)| is_there(x, y)).flat_map(|(x, y)| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            [[a, b, c], [d, c, b]]
        });
        let positions: Vec<Vec3> =
            (0..side * side).map(|i| Vec3::new((i % side) as f32, (i / side) as f32, 0.0)).collect();
        let count = positions.len();
        let surfels = Surfels {
            positions,
            normals: vec![Vec3::Z; count],
            radii: vec![0.7; count],
            ..Surfels::default()
        };
        (surfels, triangles.collect())
    }

    fn clipped(
        (mut surfels, triangles): (Surfels, Vec<[u32; 3]>),
    ) -> (u64, impl Fn(usize, usize) -> Option<Clip>) {
        let sites = Sites::new(&surfels.positions, &()).unwrap();
        let count = clip(&mut surfels, &triangles, &sites, None);
        (count, move |x, y| surfels.clips.as_ref()?.get(7 * y + x).copied())
    }

    #[test]
    fn discs_at_a_boundary_end_there() {
        let (count, clip) = clipped(sheet(|_, _| true));
        // At the sides; inside, discs of this radius end before the boundary, but for those next to a corner's diagonal.
        assert_eq!(count, 24);
        let is_kept = |x: usize, y: usize, at: [f64; 2]| {
            clip(x, y).is_none_or(|clip| clip.keeps(DVec3::new(at[0], at[1], 0.0)))
        };
        assert!(is_kept(3, 0, [0.3, 0.01]) && !is_kept(3, 0, [0.3, -0.01]));
        assert!(is_kept(6, 6, [-0.3, -0.3]) && !is_kept(6, 6, [0.1, -0.3]) && !is_kept(6, 6, [-0.3, 0.1]));
        assert!(clip(3, 3).is_none());
    }

    #[test]
    fn at_a_corner_inwards_the_union_is_kept() {
        let (_, clip) = clipped(sheet(|x, y| x < 3 || y < 3));
        let corner = clip(3, 3).unwrap();
        assert!(corner.concave);
        let is_kept = |x: f64, y: f64| corner.keeps(DVec3::new(x, y, 0.0));
        assert!(is_kept(-0.3, 0.3) && is_kept(0.3, -0.3) && !is_kept(0.1, 0.1));
    }

    #[test]
    fn discs_at_a_boundary_reach_the_next_vertices_there() {
        let (mut surfels, triangles) = sheet(|_, _| true);
        surfels.radii = vec![1.5; surfels.len()];
        // Nearer to the next vertex of the boundary, at (1, 0).
        surfels.positions[0] = Vec3::new(0.5, 0.0, 0.0);
        // A billboard at the boundary keeps its radius.
        surfels.normals[5] = Vec3::ZERO;
        let sites = Sites::new(&surfels.positions, &()).unwrap();
        for (scale, corner, side) in [(None, 1.5, 1.5), (Some(1.0), 0.55, 1.1), (Some(2.0), 1.1, 1.5)] {
            let mut surfels = surfels.clone();
            clip(&mut surfels, &triangles, &sites, scale);
            let radii = [0, 1, 3, 5, 3 * 7 + 3].map(|i| surfels.radii[i]);
            assert_eq!(radii, [corner, corner, side, 1.5, 1.5], "{scale:?}");
        }
    }

    #[test]
    fn closed_meshes_are_not_clipped() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let closed =
            Surfels { positions, normals: vec![Vec3::Z; 4], radii: vec![1.0; 4], ..Surfels::default() };
        assert_eq!(clipped((closed, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])).0, 0);
    }

    #[test]
    fn where_boundaries_meet_the_widest_gap_is_clipped() {
        // Two squares that touch at a corner, with two gaps of 90°.
        let (_, clip) = clipped(sheet(|x, y| (x, y) == (2, 2) || (x, y) == (3, 3)));
        let one_gap = clip(3, 3).unwrap();
        let kept = [[0.3, 0.3], [-0.3, -0.3], [-0.3, 0.3], [0.3, -0.3]]
            .map(|[x, y]| one_gap.keeps(DVec3::new(x, y, 0.0)));
        assert_eq!(kept.iter().filter(|kept| **kept).count(), 3, "{kept:?}");
        assert!(kept[0] && kept[1] && one_gap.concave);
        // Of the second, half a square: a gap of 45°, and one of 180° above.
        let (surfels, mut triangles) = sheet(|x, y| (x, y) == (2, 2) || (x, y) == (3, 2));
        triangles.retain(|corners| *corners != [2 * 7 + 3, 2 * 7 + 4, 3 * 7 + 3]);
        let (_, clip) = clipped((surfels, triangles));
        let wide_gap = clip(3, 3).unwrap();
        let keeps = |x: f64, y: f64| wide_gap.keeps(DVec3::new(x, y, 0.0));
        assert!(keeps(-0.3, -0.3) && keeps(0.3, -0.3) && !keeps(-0.3, 0.3) && !keeps(0.3, 0.3));
    }

    #[test]
    fn triangles_with_points_of_their_own_are_joined_where_these_coincide() {
        let (surfels, triangles) = sheet(|_, _| true);
        let own: Vec<u32> = triangles.iter().flatten().copied().collect();
        let gather = |values: &[Vec3]| own.iter().map(|&i| values[i as usize]).collect::<Vec<_>>();
        let mut soup = Surfels {
            positions: gather(&surfels.positions),
            normals: gather(&surfels.normals),
            radii: vec![0.7; own.len()],
            ..Surfels::default()
        };
        let triangles: Vec<_> = (0..own.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let sites = Sites::new(&soup.positions, &()).unwrap();
        clip(&mut soup, &triangles, &sites, None);
        let inside = |p: &Vec3| p.x > 0.0 && p.y > 0.0 && p.x < 6.0 && p.y < 6.0;
        let clips = soup.clips.unwrap();
        for (i, position) in soup.positions.iter().enumerate() {
            assert_eq!(clips.get(i).is_none(), inside(position), "{position}");
        }
    }
}
