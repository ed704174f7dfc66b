//! Winding of triangles: neighbours consistent, closed surfaces counter-clockwise from outside.

use super::draft::Draft;
use super::faces::area_vector;
use super::forest::Forest;
use super::sheet::Sheet;
use super::sites::distinct;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Part of area × extent above which the volume of a surface without boundary is no rounding error.
const LEAST_VOLUME: f64 = 1e-6;

/// Turns triangles where normals are missing, so that those estimated from them point outwards.
///
/// Triangles that share a side which no third one has belong to one surface. Within it, those that contradict the others are turned: the
/// lesser part, or if the surface is closed, those wound inwards. Surfaces within the bounding box of the largest closed one are turned with
/// it, as they may bound its hollows.
pub(super) fn turn(draft: &mut Draft) {
    if draft.triangles.is_empty() || !draft.surfels.normals.contains(&Vec3::ZERO) {
        return;
    }
    let surfaces = Surfaces::new(&draft.surfels.positions, &draft.triangles);
    let outside = surfaces.outside();
    for (i, triangle) in draft.triangles.iter_mut().enumerate() {
        let (root, flipped) = surfaces.of_triangle[i];
        if flipped ^ outside[&root] {
            triangle.swap(1, 2);
            if let Some(textures) = &mut draft.face_textures {
                textures.faces[i].corners.swap(1, 2);
            }
            draft.estimated.triangles_turned += 1;
        }
    }
}

/// A surface with consistent winding, that of one of its triangles.
#[derive(Default)]
struct Surface {
    sheet: Sheet,
    /// Whether it has a boundary, branches, or one side only.
    open: bool,
    /// Areas of triangles that are as in the file, and of those turned to be consistent.
    areas: [f64; 2],
    least: DVec3,
    most: DVec3,
}

impl Surface {
    fn is_closed(&self) -> bool {
        let extent = (self.most - self.least).length();
        let area = self.areas[0] + self.areas[1];
        self.sheet.encloses() || !self.open && self.sheet.volume().abs() > LEAST_VOLUME * area * extent
    }

    /// Whether its winding is that of the lesser part in the file.
    fn is_minor(&self) -> bool {
        self.areas[1] > self.areas[0]
    }

    fn contains(&self, other: &Self) -> bool {
        self.least.cmple(other.least).all() && self.most.cmpge(other.most).all()
    }
}

/// Surfaces by their roots.
struct Surfaces {
    /// The surface of each triangle, and whether the triangle is wound otherwise.
    of_triangle: Vec<(u32, bool)>,
    surfaces: BTreeMap<u32, Surface>,
}

impl Surfaces {
    fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let sides = sides(positions, triangles);
        let mut forest = Forest::new(triangles.len());
        for side in sides.chunk_by(|a, b| a.ends == b.ends) {
            if let [a, b] = side {
                forest.join(a.triangle, b.triangle, a.ascends == b.ascends);
            }
        }
        let of_triangle: Vec<_> = (0..triangles.len() as u32).map(|i| forest.find(i)).collect();
        let mut surfaces = BTreeMap::<u32, Surface>::new();
        for (corners, &(root, flipped)) in triangles.iter().zip(&of_triangle) {
            let points = corners.map(|i| positions[i as usize].as_dvec3());
            let double = area_vector(positions, *corners);
            let double = if flipped { -double } else { double };
            let (centre, area) = (points.iter().sum::<DVec3>() / 3.0, 0.5 * double.length());
            let fresh = || Surface { least: points[0], most: points[0], ..Surface::default() };
            let surface = surfaces.entry(root).or_insert_with(fresh);
            surface.sheet.add(double.normalize_or_zero(), centre, area);
            surface.areas[usize::from(flipped)] += area;
            surface.least = points.iter().fold(surface.least, |least, point| least.min(*point));
            surface.most = points.iter().fold(surface.most, |most, point| most.max(*point));
        }
        for side in sides.chunk_by(|a, b| a.ends == b.ends) {
            let flips = |side: &Side| side.ascends ^ of_triangle[side.triangle as usize].1;
            let consistent = matches!(side, [a, b] if flips(a) != flips(b));
            for side in side.iter().filter(|_| !consistent) {
                surfaces.entry(of_triangle[side.triangle as usize].0).or_default().open = true;
            }
        }
        Self { of_triangle, surfaces }
    }

    /// Whether each surface is to be turned.
    fn outside(&self) -> BTreeMap<u32, bool> {
        let closed = self.surfaces.values().filter(|surface| surface.is_closed());
        let largest = closed.max_by(|a, b| a.sheet.volume().abs().total_cmp(&b.sheet.volume().abs()));
        let inwards = |surface: &Surface| match largest {
            Some(largest) if largest.contains(surface) => {
                surface.is_minor() ^ largest.is_minor() ^ (largest.sheet.volume() < 0.0)
            }
            _ if surface.is_closed() => surface.sheet.volume() < 0.0,
            _ => surface.is_minor(),
        };
        self.surfaces.iter().map(|(&root, surface)| (root, inwards(surface))).collect()
    }
}

/// A side of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The lesser vertex first; coinciding ones are one.
    ends: [u32; 2],
    triangle: u32,
    /// Whether the triangle passes the lesser vertex first.
    ascends: bool,
}

/// The sides of all triangles, those with the same ends together. Triangles with coinciding corners have none.
fn sides(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Side> {
    let (vertices, _) = distinct(positions);
    let of_triangle = |(i, corners): (usize, &[u32; 3])| {
        let [a, b, c] = corners.map(|i| vertices[i as usize]);
        let side =
            move |(a, b): (u32, u32)| Side { ends: [a.min(b), a.max(b)], triangle: i as u32, ascends: a < b };
        let distinct = a != b && b != c && c != a;
        [(a, b), (b, c), (c, a)].map(side).into_iter().filter(move |_| distinct)
    };
    let mut sides: Vec<Side> = triangles.par_iter().enumerate().flat_map_iter(of_triangle).collect();
    sides.par_sort_unstable();
    sides
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Estimate;
    use crate::geometry::Cloud;

    /// A sphere of rings, whose quads share no points, wound counter-clockwise from outside.
    fn sphere(centre: Vec3, radius: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let (rows, columns) = (8u32, 12u32);
        let at = |row: u32, column: u32| {
            let (polar, turn) = (
                std::f32::consts::PI * row as f32 / rows as f32,
                std::f32::consts::TAU * (column % columns) as f32 / columns as f32,
            );
            let sine = if row == rows { 0.0 } else { polar.sin() };
            centre + radius * Vec3::new(sine * turn.cos(), sine * turn.sin(), polar.cos())
        };
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let corners =
                [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            let first = positions.len() as u32;
            positions.extend(corners);
            if row + 1 < rows {
                triangles.push([first, first + 1, first + 2]);
            }
            if row > 0 {
                triangles.push([first, first + 2, first + 3]);
            }
        }
        (positions, triangles)
    }

    /// The triangles as turned, and how many were.
    fn turned(parts: &[(Vec<Vec3>, Vec<[u32; 3]>)]) -> (Vec<[u32; 3]>, u64) {
        let mut cloud = Cloud::default();
        for (positions, triangles) in parts {
            let first = cloud.positions.len() as u32;
            cloud.positions.extend(positions);
            cloud.triangles.extend(triangles.iter().map(|corners| corners.map(|i| first + i)));
        }
        let mut draft = Draft::new(cloud, &Estimate::default()).unwrap();
        turn(&mut draft);
        (draft.triangles, draft.estimated.triangles_turned)
    }

    fn inwards((positions, mut triangles): (Vec<Vec3>, Vec<[u32; 3]>)) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        (positions, triangles)
    }

    #[test]
    fn closed_surfaces_wound_inwards_are_turned() {
        let outwards = sphere(Vec3::ZERO, 1.0);
        let count = outwards.1.len() as u64;
        assert_eq!(turned(std::slice::from_ref(&outwards)), (outwards.1.clone(), 0));
        let (triangles, all) = turned(&[inwards(outwards.clone())]);
        assert_eq!(all, count);
        let volume: f32 = triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|i| outwards.0[i as usize]);
                a.dot(b.cross(c))
            })
            .sum();
        assert!(volume > 0.0, "{volume}");
        // Each by itself, if apart.
        let apart = sphere(4.0 * Vec3::X, 0.5);
        assert_eq!(turned(&[outwards.clone(), inwards(apart.clone())]).1, count);
        // A hollow is wound the other way, and stays so.
        let hollow = inwards(sphere(Vec3::ZERO, 0.5));
        assert_eq!(turned(&[outwards.clone(), hollow.clone()]).1, 0);
        assert_eq!(turned(&[inwards(outwards), inwards(hollow)]).1, 2 * count);
    }

    #[test]
    fn triangles_that_contradict_their_neighbours_are_turned() {
        let mut mixed = sphere(Vec3::ZERO, 1.0);
        mixed.1[..70].iter_mut().for_each(|triangle| triangle.swap(1, 2));
        assert_eq!(turned(std::slice::from_ref(&mixed)).1, 70);
        // Open surfaces are wound as the larger part of them is.
        mixed.1.truncate(100);
        assert_eq!(turned(&[mixed]).1, 30);
    }

    #[test]
    fn faces_back_to_back_stay() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        assert_eq!(turned(&[(corners, vec![[0, 1, 2], [0, 2, 1]])]).1, 0);
    }

    #[test]
    fn given_normals_stay() {
        let (positions, triangles) = inwards(sphere(Vec3::ZERO, 1.0));
        let normals = Some(vec![Vec3::Z; positions.len()]);
        let mut draft =
            Draft::new(Cloud { positions, normals, triangles, ..Cloud::default() }, &Estimate::default())
                .unwrap();
        turn(&mut draft);
        assert_eq!(draft.estimated.triangles_turned, 0);
    }
}
