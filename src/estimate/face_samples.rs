//! Surfels on the faces of uneven and of angular meshes: an ellipse about each triangle in the place of a disc about each vertex.
//!
//! A vertex' disc covers the parts of all its triangles that are nearest to it. Where triangles differ in size, as in decimated meshes and those of
//! CAD programs, the longest of them sets the radius, and the disc stands out beyond the surface on all other sides; where they meet at an angle, the disc is in the plane of none. The ellipse through the
//! corners of a triangle of least area (Steiner's) is the triangle's size in every direction.

use super::draft::Draft;
use super::faces::area_vector;
use super::sites::distinct;
use super::{Estimate, Estimated, MARGIN};
use crate::geometry::{Clip, ClipLine, Clips, Colours, Ellipse, Surfels, srgb};
use glam::{DMat2, DVec2, DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Most area of the vertices' discs, without margin, relative to that of the triangles. Of equilateral triangles it is 1.2, of scanned meshes 1.3 to
/// 2.8, of the ellipses 2.4: as there are twice as many of these, they have to cover less.
const MOST_OVERLAP: f64 = 2.8;
/// Largest mean sine of the angle between vertices' normals and their triangles: 14°. Of scanned meshes it is 0.06 to 0.2.
const MOST_ANGULAR: f64 = 0.25;
/// Most triangles per vertex: twice as many on closed surfaces, some more on those with handles.
const MOST_TRIANGLES: f64 = 2.2;
/// Cosine of the angle to the face beyond which a vertex' normal is another surface's: 45°.
const ALIKE: f64 = 0.707;
/// Cosine of the angle between triangles at a sharp edge: 60°. Ellipses that overlap beyond flatter edges are more accurate than clipped ones.
const SHARP: f64 = 0.5;
/// Least aspect of an ellipse.
const LEAST_ASPECT: f64 = 1e-3;

/// Replaces the discs of vertices by ellipses on the triangles, if the discs overlap too much or are not in the triangles' planes. Only of meshes whose radii are all of faces, and
/// without attributes that belong to points.
pub(super) fn replace(draft: &mut Draft, how: &Estimate) {
    let Some(areas) = areas_of_uneven(draft) else { return };
    let mesh = Mesh::new(draft, how.outlines);
    let kept: Vec<usize> = (0..draft.triangles.len()).filter(|&i| areas[i] > 0.0).collect();
    let samples: Vec<Sample> = kept.par_iter().filter_map(|&i| mesh.sample(i)).collect();
    let surfels = mesh.surfels(&samples);
    let count = samples.len() as u64;
    // Means of given normals are given ones.
    let given = draft.estimated.normals_given > 0;
    draft.estimated = Estimated {
        vertices_replaced: draft.surfels.len() as u64,
        normals_given: if given { count } else { 0 },
        normals_from_faces: if given { 0 } else { count },
        radii_from_faces: count,
        clipped: surfels.clips.as_ref().map_or(0, |clips| clips.clips.len() as u64),
        ..draft.estimated
    };
    draft.surfels = surfels;
    draft.triangles = Vec::new();
}

/// The areas of the triangles, if the mesh is uneven or angular.
fn areas_of_uneven(draft: &Draft) -> Option<Vec<f64>> {
    let Draft { surfels, triangles, estimated } = draft;
    let bound = surfels.weights.is_some()
        || surfels.clips.is_some()
        || surfels.texture.is_some()
        || surfels.materials.is_some()
        || surfels.ellipses.is_some()
        || surfels.curvatures.is_some();
    let of_faces = estimated.radii_from_faces == surfels.len() as u64;
    let count = triangles.len() as f64;
    // Where faces are back to back, neighbours tell normals.
    let has_normals = !surfels.normals.contains(&Vec3::ZERO);
    if triangles.is_empty()
        || bound
        || !of_faces
        || !has_normals
        || count > MOST_TRIANGLES * surfels.len() as f64
    {
        return None;
    }
    let vectors: Vec<DVec3> =
        triangles.par_iter().map(|&corners| 0.5 * area_vector(&surfels.positions, corners)).collect();
    let area: f64 = vectors.iter().map(|vector| vector.length()).sum();
    let discs: f64 = surfels.radii.iter().map(|&radius| PI * (f64::from(radius) / MARGIN).powi(2)).sum();
    // Sines, weighted by area.
    let across = |(vector, corners): (&DVec3, &[u32; 3])| {
        corners.iter().map(|&i| surfels.normals[i as usize].as_dvec3().cross(*vector).length()).sum::<f64>()
            / 3.0
    };
    let angular: f64 = vectors.iter().zip(triangles).map(across).sum();
    (area > 0.0 && (discs > MOST_OVERLAP * area || angular > MOST_ANGULAR * area))
        .then(|| vectors.iter().map(|vector| vector.length()).collect())
}

/// A surfel on a triangle.
struct Sample {
    position: Vec3,
    normal: Vec3,
    radius: f32,
    ellipse: Ellipse,
    corners: [u32; 3],
    clip: Option<Clip>,
}

/// A mesh whose triangles are sampled.
struct Mesh<'a> {
    draft: &'a Draft,
    /// The vertex of each point; coinciding points are one.
    vertices: Vec<u32>,
    /// The sides of all triangles by the vertices at their ends, sorted, each with its triangle.
    sides: Vec<([u32; 2], u32)>,
    /// Whether ellipses end at the sides beyond which the surface does.
    outlines: bool,
}

impl<'a> Mesh<'a> {
    fn new(draft: &'a Draft, outlines: bool) -> Self {
        let (vertices, _) = distinct(&draft.surfels.positions);
        let sides_of = |(i, corners): (usize, &[u32; 3])| {
            let [a, b, c] = corners.map(|i| vertices[i as usize]);
            [(a, b), (b, c), (c, a)].map(|(a, b)| ([a.min(b), a.max(b)], i as u32))
        };
        let mut sides: Vec<_> = draft.triangles.par_iter().enumerate().flat_map_iter(sides_of).collect();
        sides.par_sort_unstable();
        Self { draft, vertices, sides, outlines }
    }

    /// The unit normal of triangle `i`, on the side of its vertices' normals; 0 if it is degenerate.
    fn face_normal(&self, i: usize) -> DVec3 {
        let corners = self.draft.triangles[i];
        let surfels = &self.draft.surfels;
        let own = area_vector(&surfels.positions, corners).normalize_or_zero();
        let mean: DVec3 = corners.iter().map(|&corner| surfels.normals[corner as usize].as_dvec3()).sum();
        if own.dot(mean) < 0.0 { -own } else { own }
    }

    fn sample(&self, i: usize) -> Option<Sample> {
        let corners = self.draft.triangles[i];
        let surfels = &self.draft.surfels;
        let points = corners.map(|corner| surfels.positions[corner as usize].as_dvec3());
        let centre = points.iter().sum::<DVec3>() / 3.0;
        let face = self.face_normal(i);
        let normals = corners.map(|corner| surfels.normals[corner as usize].as_dvec3());
        let mean = normals.iter().filter(|normal| normal.dot(face) >= ALIKE).sum::<DVec3>();
        let normal = mean.try_normalize().unwrap_or(face).as_vec3().try_normalize()?;
        let (radius, ellipse) = ellipse(points.map(|point| point - centre), normal)?;
        let clip = self.clip(i, points, centre, normal, radius);
        Some(Sample { position: centre.as_vec3(), normal, radius: radius as f32, ellipse, corners, clip })
    }

    /// The clip at sides beyond which there is no surface, or one at an angle: the two nearest ones within the ellipse's reach.
    fn clip(&self, i: usize, points: [DVec3; 3], centre: DVec3, normal: Vec3, radius: f64) -> Option<Clip> {
        let mut lines: Vec<ClipLine> = (0..3)
            .filter(|_| self.outlines)
            .filter_map(|k| {
                let [a, b, opposite] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| points[k]);
                if !self.ends_at(i, k) {
                    return None;
                }
                let outward = (a - opposite).reject_from((b - a).try_normalize()?).try_normalize()?;
                let line = ClipLine::of_half_space(outward, outward.dot(a - centre), normal)?;
                (f64::from(line.offset) < radius).then_some(line)
            })
            .collect();
        lines.sort_by(|a, b| a.offset.total_cmp(&b.offset));
        let mut nearest = lines.into_iter();
        Clip::of_some([nearest.next(), nearest.next()], false)
    }

    /// Whether the smooth surface of triangle `i` ends at its side `k`.
    fn ends_at(&self, i: usize, k: usize) -> bool {
        let corners = self.draft.triangles[i].map(|corner| self.vertices[corner as usize]);
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let side = [a.min(b), a.max(b)];
        let first = self.sides.partition_point(|(other, _)| *other < side);
        let triangles = self.sides[first..].iter().take_while(|(other, _)| *other == side);
        let own = self.face_normal(i);
        !triangles
            .map(|&(_, other)| other as usize)
            .any(|other| other != i && self.face_normal(other).dot(own) >= SHARP)
    }

    fn surfels(&self, samples: &[Sample]) -> Surfels {
        let from = &self.draft.surfels;
        let two_sided = from.two_sided.as_ref().map(|two_sided| {
            samples.iter().map(|sample| sample.corners.iter().any(|&i| two_sided[i as usize])).collect()
        });
        Surfels {
            origin: from.origin,
            positions: samples.iter().map(|sample| sample.position).collect(),
            normals: samples.iter().map(|sample| sample.normal).collect(),
            radii: samples.iter().map(|sample| sample.radius).collect(),
            ellipses: Some(samples.iter().map(|sample| sample.ellipse).collect()),
            two_sided,
            clips: Clips::collect(samples.iter().map(|sample| sample.clip)),
            colours: from.colours.as_ref().map(|colours| mean_colours(colours, samples)),
            ..Surfels::default()
        }
    }
}

/// Steiner's circumellipse of a triangle around 0, with the margin of discs, in the plane of a unit normal.
fn ellipse(points: [DVec3; 3], normal: Vec3) -> Option<(f64, Ellipse)> {
    let normal = normal.as_dvec3();
    let (u, v) = normal.any_orthonormal_pair();
    let [a, b, c] = points.map(|point| DVec2::new(point.dot(u), point.dot(v)));
    // Conjugate semi-axes, in units that neither overflow nor vanish.
    let unit = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let (p, q) = (a / unit, (b - c) / (3f64.sqrt() * unit));
    let square = DMat2::from_cols(p.x * p + q.x * q, p.y * p + q.y * q);
    let (middle, difference) =
        (0.5 * (square.x_axis.x + square.y_axis.y), 0.5 * (square.x_axis.x - square.y_axis.y));
    let root = difference.hypot(square.x_axis.y);
    let angle = 0.5 * square.x_axis.y.atan2(difference);
    let (major, minor) = ((middle + root).sqrt(), (middle - root).max(0.0).sqrt());
    let direction = angle.cos() * u + angle.sin() * v;
    let aspect = (minor / major).clamp(LEAST_ASPECT, 1.0) as f32;
    let radius = MARGIN * unit * major;
    (radius > 0.0 && radius.is_finite()).then(|| (radius, Ellipse { major: direction.as_vec3(), aspect }))
}

/// The mean colours of the corners, in linear light.
fn mean_colours(colours: &Colours, samples: &[Sample]) -> Colours {
    let mean = |of: &dyn Fn(u32) -> [f64; 3], sample: &Sample| {
        let corners = sample.corners.map(of);
        [0, 1, 2].map(|channel| corners.iter().map(|corner| corner[channel]).sum::<f64>() / 3.0)
    };
    match colours {
        Colours::Srgb8(codes) => {
            let light = |i: u32| {
                let [r, g, b, _] = codes[i as usize];
                [r, g, b].map(|code| srgb::decode(f64::from(code) / 255.0))
            };
            let code = |sample| {
                let [r, g, b] = mean(&light, sample).map(|linear| srgb::encode8(linear as f32));
                [r, g, b, u8::MAX]
            };
            Colours::Srgb8(samples.iter().map(code).collect())
        }
        Colours::Linear(linear) => {
            let light = |i: u32| linear[i as usize].map(f64::from);
            Colours::Linear(samples.iter().map(|sample| mean(&light, sample).map(|v| v as f32)).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Cloud;

    /// A cube of side 2 around 0, of two triangles a side.
    fn cube() -> Cloud {
        let corner =
            |i: usize| Vec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 }));
        let squares = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Cloud {
            positions: (0..8).map(corner).collect(),
            triangles: squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
            colours: Some(Colours::Linear((0..8).map(|i| [i as f32, 0.0, 1.0]).collect())),
            ..Cloud::default()
        }
    }

    #[test]
    fn a_cube_is_of_its_faces() {
        let (surfels, estimated) = cube().into_surfels(&Estimate::default(), &()).unwrap();
        assert_eq!((surfels.len(), estimated.vertices_replaced, estimated.clipped), (12, 8, 12));
        let (clips, ellipses) = (surfels.clips.as_ref().unwrap(), surfels.ellipses.as_ref().unwrap());
        for (i, ellipse) in ellipses.iter().enumerate() {
            let (at, normal) = (surfels.positions[i], surfels.normals[i]);
            assert!(
                (at.dot(normal) - 1.0).abs() < 1e-6 && at.abs().max_element() == 1.0,
                "{at} faces {normal}"
            );
            // Within the face, from the centre along the way outwards in the plane.
            let inside = (at - at.dot(normal) * normal).as_dvec3();
            let clip = clips.get(i).unwrap();
            assert!(clip.keeps(1.9 * inside) && !clip.keeps(2.1 * inside), "{at}: the edge is at 1");
            assert!(ellipse.major.dot(normal).abs() < 1e-6);
        }
        let Some(Colours::Linear(colours)) = surfels.colours else { panic!("colours are kept") };
        let red: f32 = colours.iter().map(|colour| colour[0]).sum::<f32>() / 12.0;
        assert!((red - 3.5).abs() < 1e-5 && colours.iter().all(|colour| colour[2] == 1.0), "{red}");
    }

    #[test]
    fn an_even_mesh_keeps_its_vertices_and_an_uneven_one_does_not() {
        // A plane grid whose columns are `width` apart, in turn with 1.
        let replaced = |width: f32| {
            let at =
                |x: u32, y: u32| Vec3::new((x / 2) as f32 * (1.0 + width) + (x % 2) as f32, y as f32, 0.0);
            let squares = (0..11).flat_map(|y| (0..11).map(move |x| 12 * y + x));
            let cloud = Cloud {
                positions: (0..144).map(|i| at(i % 12, i / 12)).collect(),
                triangles: squares.flat_map(|i| [[i, i + 1, i + 12], [i + 1, i + 13, i + 12]]).collect(),
                ..Cloud::default()
            };
            cloud.into_surfels(&Estimate::default(), &()).unwrap().1.vertices_replaced
        };
        assert_eq!([1.0, 8.0].map(replaced), [0, 144]);
    }

    /// The corners of the triangle are on Steiner's ellipse.
    #[test]
    fn an_ellipse_passes_through_the_corners() {
        let corners = [DVec3::new(3.0, 1.0, 0.0), DVec3::new(-1.0, 2.0, 0.0), DVec3::new(0.5, -1.0, 0.0)];
        let centre = corners.iter().sum::<DVec3>() / 3.0;
        let (radius, Ellipse { major, aspect }) =
            ellipse(corners.map(|corner| corner - centre), Vec3::Z).unwrap();
        for corner in corners {
            let (along, across) = (
                (corner - centre).dot(major.as_dvec3()),
                (corner - centre).dot(Vec3::Z.cross(major).as_dvec3()),
            );
            let distance = (along / radius).hypot(across / (radius * f64::from(aspect)));
            assert!((MARGIN * distance - 1.0).abs() < 1e-5, "{distance}");
        }
    }
}
