//! Surfels on the faces of coarse, uneven and angular meshes: ellipses on the triangles in the place of a disc about each vertex.
//!
//! A vertex' disc covers the parts of all its triangles that are nearest to it. Where triangles differ in size, as in decimated meshes and those of
//! CAD programs, the longest of them sets the radius, and the disc stands out beyond the surface on all other sides; where they meet at an
//! angle, the disc is in the plane of none. The ellipse through the corners of a triangle of least area (Steiner's) is the triangle's size in
//! every direction. Triangles of coarse meshes are halved where an ellipse would stand out far, or normals and colours differ over it, and those of
//! all meshes where their textures do.

use super::draft::Draft;
use super::face::{Face, Limits, Sample, mix};
use super::face_colours::FaceColours;
use super::face_edges::{FaceEdges, Fan};
use super::faces::area_vector;
use super::{Estimate, Estimated, MARGIN, MeshSampling};
use crate::geometry::{Clips, Colours, Surfels, srgb};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Most area of the vertices' discs, without margin, relative to that of the triangles. Of equilateral triangles it is 1.2, of scanned meshes
/// 1.3 to 2.8, of the ellipses 2.4: as there are twice as many of these, they have to cover less.
const MOST_OVERLAP: f64 = 2.8;
/// Largest mean sine of the angle between vertices' normals and their triangles: 14°. Of scanned meshes it is 0.06 to 0.2.
const MOST_ANGULAR: f64 = 0.25;
/// Most samples that halved triangles are made into. Meshes with fewer triangles are coarse.
const MOST_HALVED: usize = 30_000;
/// The same where textures differ: as many as a picture of 1000×1000 px has of a surface that fills it, half of which is seen.
const MOST_TEXTURED: usize = 500_000;
/// Part of the area whose textures vary, above which vertices are too few for them.
const LEAST_VARYING: f64 = 0.01;
/// Cosine of the angle between triangles at a sharp edge: 58°. Ellipses that overlap beyond flatter edges are more accurate than clipped ones.
const SHARP: f64 = 0.53;
/// The same of coarse meshes, whose ellipses are larger beside their details: 50°.
const SHARP_OF_COARSE: f64 = 0.643;
/// Most triangles per vertex: twice as many on closed surfaces, some more on those with handles.
const MOST_TRIANGLES: f64 = 2.2;
/// Cosine of the angle to the face beyond which a vertex' normal is another surface's: 45°.
const ALIKE: f64 = 0.707;

/// Replaces the discs of vertices by ellipses on the triangles, if [`MeshSampling`] says so. Only of meshes whose radii are all of faces, and
/// without attributes that belong to points. Returns whether it did.
pub(super) fn replace(draft: &mut Draft, how: &Estimate) -> bool {
    let textures = draft.face_textures.as_ref().filter(|_| how.mesh_sampling != MeshSampling::Vertices);
    let colours = textures.map(FaceColours::new);
    let Some(areas) = areas_of_sampled(draft, colours.as_ref(), how) else { return false };
    let mesh = Mesh::new(draft, colours.as_ref(), how.outlines);
    let kept: Vec<usize> = (0..draft.triangles.len()).filter(|&i| areas[i] > 0.0).collect();
    let faces: Vec<Face> = kept.par_iter().map(|&i| mesh.face(i, areas[i])).collect();
    let limits = mesh.limits(&faces);
    let samples: Vec<Sample> = faces.par_iter().flat_map_iter(|face| samples(face, &limits)).collect();
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
    draft.replace(surfels);
    true
}

/// The areas of the triangles, if they are sampled.
fn areas_of_sampled(draft: &Draft, colours: Option<&FaceColours>, how: &Estimate) -> Option<Vec<f64>> {
    let Draft { surfels, triangles, estimated, .. } = draft;
    let bound = surfels.weights.is_some()
        || surfels.clips.is_some()
        || surfels.texture.is_some()
        || surfels.materials.is_some()
        || surfels.ellipses.is_some()
        || surfels.curvatures.is_some();
    let of_faces = estimated.radii_from_faces == surfels.len() as u64;
    let impossible = triangles.is_empty() || bound || !of_faces;
    let too_many = triangles.len() as f64 > MOST_TRIANGLES * surfels.len() as f64;
    let wanted = match how.mesh_sampling {
        MeshSampling::Vertices => false,
        MeshSampling::Triangles => true,
        MeshSampling::Auto => !too_many,
    };
    if impossible || !wanted {
        return None;
    }
    let vectors: Vec<DVec3> =
        triangles.par_iter().map(|&corners| 0.5 * area_vector(&surfels.positions, corners)).collect();
    let areas: Vec<f64> = vectors.iter().map(|vector| vector.length()).collect();
    let area: f64 = areas.iter().sum();
    let discs: f64 = surfels.radii.iter().map(|&radius| PI * (f64::from(radius) / MARGIN).powi(2)).sum();
    // Sines, weighted by area.
    let across = |(vector, corners): (&DVec3, &[u32; 3])| {
        corners.iter().map(|&i| surfels.normals[i as usize].as_dvec3().cross(*vector).length()).sum::<f64>()
            / 3.0
    };
    let angular: f64 = vectors.iter().zip(triangles).map(across).sum();
    let needed = how.mesh_sampling == MeshSampling::Triangles
        || triangles.len() < MOST_HALVED
        || discs > MOST_OVERLAP * area
        || angular > MOST_ANGULAR * area
        || colours.is_some_and(|colours| colours.varying(&areas) > LEAST_VARYING * area);
    (area > 0.0 && needed).then_some(areas)
}

/// A mesh whose triangles are sampled.
struct Mesh<'a> {
    draft: &'a Draft,
    edges: FaceEdges<'a>,
    colours: Option<&'a FaceColours<'a>>,
    /// Diagonal of the bounding box.
    extent: f64,
    /// Whether ellipses end at the sides beyond which the surface does.
    outlines: bool,
}

impl<'a> Mesh<'a> {
    fn new(draft: &'a Draft, colours: Option<&'a FaceColours<'a>>, outlines: bool) -> Self {
        let positions = &draft.surfels.positions;
        let is_coarse = draft.triangles.len() < MOST_HALVED;
        let sharp = if is_coarse { SHARP_OF_COARSE } else { SHARP };
        let edges = FaceEdges::new(positions, &draft.triangles, sharp);
        let corners = |of: fn(Vec3, Vec3) -> Vec3| positions.iter().copied().reduce(of).unwrap_or_default();
        let extent = corners(Vec3::max).as_dvec3().distance(corners(Vec3::min).as_dvec3());
        Self { draft, edges, colours, extent, outlines }
    }

    /// Triangle `i`, of this area.
    fn face(&self, i: usize, area: f64) -> Face<'a> {
        let corners = self.draft.triangles[i];
        let fans = [0, 1, 2].map(|k| self.edges.fan(i, k));
        let own = self.edges.normal(i);
        let around = fans.iter().flat_map(|fan| &fan.triangles);
        let bend = around.map(|&other| own.cross(self.edges.normal(other as usize)).length());
        let mut ends: Vec<(u32, usize)> = fans.iter().flat_map(|fan| &fan.ends).copied().collect();
        ends.sort_unstable();
        ends.dedup();
        let border = |(triangle, side): (u32, usize)| self.edges.border(triangle as usize, side);
        let texture = self.colours.and_then(|colours| colours.of(i, area.sqrt() / self.extent));
        let of_vertices = self.draft.surfels.colours.as_ref().filter(|_| texture.is_none());
        Face {
            corners,
            points: self.edges.points(i),
            normals: [0, 1, 2].map(|k| self.corner_normal(i, k, &fans[k])),
            colours: of_vertices.map(|of| corners.map(|corner| of.light(corner as usize))),
            texture,
            borders: ends.into_iter().filter(|_| self.outlines).filter_map(border).collect(),
            sides: (0..3).filter_map(|k| self.edges.border(i, k)).collect(),
            bend: bend.fold(0.0, f64::max),
        }
    }

    /// The least limits with [`MOST_HALVED`] samples at most, without regard to textures, and [`MOST_TEXTURED`] with it; infinite if there are as
    /// many triangles.
    fn limits(&self, faces: &[Face]) -> Limits {
        let all = Limits { extent: self.extent, ellipse: f64::INFINITY, texture: f64::INFINITY };
        let ellipse = least_error(faces, MOST_HALVED, |ellipse| Limits { ellipse, ..all });
        let texture = match self.colours {
            Some(_) => least_error(faces, MOST_TEXTURED, |texture| Limits { ellipse, texture, ..all }),
            None => f64::INFINITY,
        };
        Limits { ellipse, texture, ..all }
    }

    /// The normal at corner `k` of triangle `i`: a given one if it is near the face's, otherwise the mean of the triangles around the corner on
    /// the same smooth surface, weighted by their angles.
    fn corner_normal(&self, i: usize, k: usize, fan: &Fan) -> DVec3 {
        let own = self.edges.normal(i);
        let surfels = &self.draft.surfels;
        if self.draft.estimated.normals_given > 0 {
            let given = self.draft.triangles[i].map(|corner| surfels.normals[corner as usize].as_dvec3());
            // The side of a face is that of its corners' normals.
            let own = if own.dot(given.iter().sum()) < 0.0 { -own } else { own };
            return if given[k].dot(own) >= ALIKE { given[k] } else { own };
        }
        let weighted = |&other: &u32| {
            let normal = self.edges.normal(other as usize);
            let same = if normal.dot(own) < 0.0 { -1.0 } else { 1.0 };
            self.edges.angle(other as usize, i, k) * same * normal
        };
        fan.triangles.iter().map(weighted).sum::<DVec3>().normalize_or(own)
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
            radii: samples.iter().map(|sample| sample.radius as f32).collect(),
            ellipses: Some(samples.iter().map(|sample| sample.ellipse).collect()),
            two_sided,
            clips: Clips::collect(samples.iter().map(|sample| sample.clip)),
            colours: from.colours.as_ref().map(|colours| mean_colours(colours, samples)),
            ..Surfels::default()
        }
    }
}

/// The least error from 1 on, in steps of a quarter, by whose limits there are `most` samples at most; infinite if there are as many triangles.
fn least_error(faces: &[Face], most: usize, limits: impl Fn(f64) -> Limits) -> f64 {
    if faces.len() >= most {
        return f64::INFINITY;
    }
    let error = |step: i32| 1.25f64.powi(step);
    let are_too_many = |step: i32| {
        let limits = limits(error(step));
        // All faces count together, so that many large ones end soon.
        let count = AtomicUsize::new(0);
        faces
            .par_iter()
            .for_each(|face| face.halve(&limits, &mut |_| count.fetch_add(1, Ordering::Relaxed) < most));
        count.into_inner() > most
    };
    // Too many by the first, not by the last.
    let (mut few, mut enough) = (-1, 0);
    while are_too_many(enough) {
        (few, enough) = (enough, 2 * enough + 1);
    }
    while enough - few > 1 {
        let middle = (few + enough) / 2;
        if are_too_many(middle) { few = middle } else { enough = middle }
    }
    error(enough)
}

fn samples(face: &Face, limits: &Limits) -> Vec<Sample> {
    let mut samples = Vec::new();
    face.halve(limits, &mut |part| {
        let colour = || face.texture.as_ref().map(|texture| texture.mean(part));
        samples.extend(face.sample(part).map(|sample| Sample { colour: colour(), ..sample }));
        true
    });
    samples
}

/// The samples' own colours, or the mean ones of the corners, in linear light.
fn mean_colours(colours: &Colours, samples: &[Sample]) -> Colours {
    let means = samples.iter().map(|sample| {
        let corners = || sample.corners.map(|corner| colours.light(corner as usize));
        sample.colour.unwrap_or_else(|| mix(&corners(), sample.weights)).to_array()
    });
    match colours {
        Colours::Srgb8(_) => {
            let code = |mean: [f64; 3]| {
                let [r, g, b] = mean.map(|linear| srgb::encode8(linear as f32));
                [r, g, b, u8::MAX]
            };
            Colours::Srgb8(means.map(code).collect())
        }
        Colours::Linear(_) => Colours::Linear(means.map(|mean| mean.map(|v| v as f32)).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::face::STANDS_OUT;
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
        assert_eq!((surfels.len() as u64, 8), (estimated.normals_from_faces, estimated.vertices_replaced));
        let (clips, ellipses) = (surfels.clips.as_ref().unwrap(), surfels.ellipses.as_ref().unwrap());
        for (i, ellipse) in ellipses.iter().enumerate() {
            let (at, normal) = (surfels.positions[i], surfels.normals[i]);
            assert!(
                (at.dot(normal) - 1.0).abs() < 1e-6 && at.abs().max_element() == 1.0,
                "{at} faces {normal}"
            );
            // No part of a disc is beyond an edge.
            let (major, minor) = (ellipse.major.as_dvec3(), normal.cross(ellipse.major).as_dvec3());
            let radius = f64::from(surfels.radii[i]);
            for k in 0..64 {
                let (sin, cos) = (PI * f64::from(k) / 32.0).sin_cos();
                let offset = radius * (cos * major + f64::from(ellipse.aspect) * sin * minor);
                let beyond = (at.as_dvec3() + offset).abs().max_element() - 1.0;
                let is_clipped = clips.get(i).is_some_and(|clip| !clip.keeps(offset));
                assert!(beyond < STANDS_OUT * 12f64.sqrt() || is_clipped, "{at}: {beyond} beyond an edge");
            }
        }
        // Red is 4 times z, 2 times y and once x, from 0 to 1 along each axis.
        let Some(Colours::Linear(colours)) = surfels.colours else { panic!("colours are kept") };
        for (at, colour) in surfels.positions.iter().zip(colours) {
            let red = (0.5 * (*at + 1.0)).dot(Vec3::new(1.0, 2.0, 4.0));
            assert!((colour[0] - red).abs() < 1e-5 && colour[2] == 1.0, "{at}: {colour:?}, not {red}");
        }
    }

    #[test]
    fn flat_faces_of_one_colour_are_not_halved_without_need() {
        let (surfels, _) = Cloud { colours: None, ..cube() }.into_surfels(&Estimate::default(), &()).unwrap();
        assert!((12..100).contains(&surfels.len()), "{} surfels of a cube", surfels.len());
    }

    /// Vertices of the sides of a grid.
    const SIDE: u32 = 130;

    /// A plane grid whose columns are `width` apart, in turn with 1.
    fn grid(width: f32) -> Cloud {
        let at = |x: u32, y: u32| Vec3::new((x / 2) as f32 * (1.0 + width) + (x % 2) as f32, y as f32, 0.0);
        let squares = (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| SIDE * y + x));
        let square = |i| [[i, i + 1, i + SIDE], [i + 1, i + SIDE + 1, i + SIDE]];
        Cloud {
            positions: (0..SIDE * SIDE).map(|i| at(i % SIDE, i / SIDE)).collect(),
            triangles: squares.flat_map(square).collect(),
            ..Cloud::default()
        }
    }

    #[test]
    fn ellipses_on_triangles_stay_where_discs_are_to_be_elliptical() {
        let of = |elliptical, width| {
            let how = Estimate { elliptical, ..Estimate::default() };
            grid(width).into_surfels(&how, &()).unwrap()
        };
        assert_eq!(of(true, 8.0), of(false, 8.0));
        let (at_vertices, estimated) = of(true, 1.0);
        let all = u64::from(SIDE * SIDE);
        assert!(at_vertices.ellipses.is_some() && at_vertices.len() as u64 == all);
        assert_eq!((estimated.radii_from_faces, estimated.radii_from_neighbours), (0, all));
    }

    #[test]
    fn an_even_mesh_keeps_its_vertices_and_an_uneven_one_does_not() {
        let replaced = |width: f32, mesh_sampling| {
            let how = Estimate { mesh_sampling, ..Estimate::default() };
            grid(width).into_surfels(&how, &()).unwrap().1.vertices_replaced
        };
        let all = u64::from(SIDE * SIDE);
        assert_eq!([1.0, 8.0].map(|width| replaced(width, MeshSampling::Auto)), [0, all]);
        assert_eq!(replaced(1.0, MeshSampling::Triangles), all);
        assert_eq!(replaced(8.0, MeshSampling::Vertices), 0);
    }

    #[test]
    fn many_large_faces_share_the_most_samples() {
        // Triangles across the unit cube, each with corners of its own.
        let corner = |i: u32| {
            let part = |prime: u32| (i.wrapping_mul(prime) % 1009) as f32 / 1009.0;
            [part(7919), part(104_729), part(1_299_709)]
        };
        let cloud = Cloud {
            positions: (0..6000).map(|i| Vec3::from_array(corner(i))).collect(),
            triangles: (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            colours: Some(Colours::Linear((0..6000).map(|i| corner(i + 1)).collect())),
            ..Cloud::default()
        };
        let how = Estimate { mesh_sampling: MeshSampling::Triangles, ..Estimate::default() };
        let (surfels, _) = cloud.into_surfels(&how, &()).unwrap();
        assert!((2000..=MOST_HALVED).contains(&surfels.len()), "{} surfels", surfels.len());
    }
}
