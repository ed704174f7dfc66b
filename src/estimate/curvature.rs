//! Curvatures from the nearest points: how far a surface bends away from the tangent plane or towards the normal, or how its
//! normals turn.

use super::sites::Sites;
use crate::Progress;
use crate::error::Result;
use crate::geometry::{Curvature, Surfels, tangents};
use glam::{DMat2, DMat3, DVec2, DVec3, Vec3};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Number of neighbours.
const NEIGHBOURS: usize = 10;
/// Cosine above which normals are of the same side of a surface.
const SAME_SIDE: f64 = 0.0;
/// Weight of flatness in the directions of no neighbour, relative to that of a neighbour.
const FLATNESS: f64 = 1e-3;
/// Least distance of the farthest neighbour along the longer axis of an ellipse, semi-axes, or distances of the farthest across it.
const LEAST_REACH: f32 = 0.5;
/// Number of surfels per task.
const PIECE: usize = 1 << 12;

/// What tells the curvature of a surface.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Bend {
    /// Where neighbours are: of points.
    Positions,
    /// How neighbours' normals differ: of surfels on triangles, which are flat, and have normals between those of the corners.
    Normals,
}

/// The curvature at every surfel: the shape operator nearest to the curvatures towards its neighbours. Unknown at two-sided surfels and
/// billboards.
pub(super) fn curvatures(
    surfels: &Surfels,
    sites: &Sites,
    bend: Bend,
    progress: &dyn Progress,
) -> Result<Vec<Curvature>> {
    let mut curvatures = vec![Curvature::default(); surfels.len()];
    let (done, total) = (AtomicU64::new(0), surfels.len() as u64);
    curvatures.par_chunks_mut(PIECE).enumerate().try_for_each(|(piece, curvatures)| {
        let first = piece * PIECE;
        let mut near = Vec::new();
        for (curvature, i) in curvatures.iter_mut().zip(first..) {
            near.clear();
            near.extend(sites.nearest(sites.of_point[i], NEIGHBOURS));
            *curvature = curvature_at(surfels, sites, bend, &near, i);
        }
        let piece = curvatures.len() as u64;
        progress.at("estimating curvatures", done.fetch_add(piece, Ordering::Relaxed) + piece, total);
        progress.check_cancelled()
    })?;
    Ok(curvatures)
}

fn curvature_at(surfels: &Surfels, sites: &Sites, bend: Bend, near: &[u32], i: usize) -> Curvature {
    let normal = surfels.normals[i].as_dvec3();
    let is_two_sided = |i: usize| surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
    if is_two_sided(i) || surfels.is_billboard(i) {
        return Curvature::default();
    }
    let site = sites.of_point[i];
    if !reach_across(surfels, sites, near, i) {
        return Curvature::default();
    }
    let basis = tangents(normal);
    let clip = surfels.clips.as_ref().and_then(|clips| clips.get(i));
    // Beyond a clip line is another surface.
    let is_kept = |offset: DVec3| clip.is_none_or(|clip| clip.keeps(f64::from(sites.unit) * offset));
    let in_plane = |vector: DVec3| DVec2::from_array(basis.map(|axis| axis.dot(vector)));
    let neighbours = near.iter().filter_map(|&other| {
        let point = sites.point[other as usize] as usize;
        let other_normal = surfels.normals[point].as_dvec3();
        let is_same_side = !is_two_sided(point) && other_normal.dot(normal) > SAME_SIDE;
        let offset = (sites.at(other) - sites.at(site)).as_dvec3();
        (is_same_side && is_kept(offset)).then_some((offset, other_normal))
    });
    let operator = match bend {
        Bend::Positions => fit(neighbours.filter_map(|(offset, _)| {
            let t = in_plane(offset).try_normalize()?;
            // Of the circle through the centre and the neighbour, tangent to the disc: tᵀ S t.
            let circle = -2.0 * offset.dot(normal) / offset.length_squared();
            Some((DVec3::new(t.x * t.x, 2.0 * t.x * t.y, t.y * t.y), circle))
        })),
        Bend::Normals => fit(neighbours.flat_map(|(offset, other_normal)| {
            let (offset, turn) = (in_plane(offset), in_plane(other_normal));
            let (t, turn) = (offset.normalize_or_zero(), turn / offset.length().max(f64::MIN_POSITIVE));
            // Both components of S t.
            [(DVec3::new(t.x, t.y, 0.0), turn.x), (DVec3::new(0.0, t.x, t.y), turn.y)]
        })),
    };
    Curvature::of_shape_operator(operator * (1.0 / f64::from(sites.unit)))
}

/// Whether the neighbours of an ellipse go on along its longer axis, rather than being all of one line of a scan.
fn reach_across(surfels: &Surfels, sites: &Sites, near: &[u32], i: usize) -> bool {
    let Some(ellipses) = &surfels.ellipses else { return true };
    let (at, major) = (sites.at(sites.of_point[i]), ellipses[i].major);
    let farthest = |axis: Vec3| {
        let distances = near.iter().map(|other| (sites.at(*other) - at).dot(axis).abs());
        sites.unit * distances.fold(0.0, f32::max)
    };
    farthest(major) >= LEAST_REACH * surfels.radii[i].min(farthest(surfels.normals[i].cross(major)))
}

/// The shape operator S with the least squares of row · (Sxx, Sxy, Syy) − value, of unit tangents.
fn fit(equations: impl Iterator<Item = (DVec3, f64)>) -> DMat2 {
    let flat = (DMat3::from_diagonal(DVec3::splat(FLATNESS)), DVec3::ZERO);
    let (matrix, right) = equations.fold(flat, |(matrix, right), (row, value)| {
        (matrix + DMat3::from_cols(row * row.x, row * row.y, row * row.z), right + value * row)
    });
    let [xx, xy, yy] = (matrix.inverse() * right).to_array();
    DMat2::from_cols_array(&[xx, xy, xy, yy])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ellipse;

    /// The curvatures of `count` points of a surface, given by the position and normal at parameters from 0 to 1.
    fn of(count: usize, surface: impl Fn(f32, f32) -> [Vec3; 2]) -> Vec<Curvature> {
        by(Bend::Positions, count, surface)
    }

    fn by(bend: Bend, count: usize, surface: impl Fn(f32, f32) -> [Vec3; 2]) -> Vec<Curvature> {
        let at = |i: usize| surface((i as f32 + 0.5) / count as f32, (i as f32 * 0.618_034).fract());
        let surfels = Surfels {
            positions: (0..count).map(|i| at(i)[0]).collect(),
            normals: (0..count).map(|i| at(i)[1]).collect(),
            radii: vec![1.0; count],
            ..Surfels::default()
        };
        let sites = Sites::new(&surfels.positions, &()).unwrap();
        curvatures(&surfels, &sites, bend, &()).unwrap()
    }

    fn middle(values: impl Iterator<Item = f64>) -> f64 {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    }

    #[test]
    fn spheres_of_any_size_have_the_inverse_of_their_radius() {
        for radius in [1e-20_f32, 0.1, 1.0, 1e15] {
            let sphere = |outwards: f32| {
                of(4000, move |s, t| {
                    let (z, angle) = (2.0 * s - 1.0, t * std::f32::consts::TAU);
                    let unit =
                        Vec3::new((1.0 - z * z).sqrt() * angle.cos(), (1.0 - z * z).sqrt() * angle.sin(), z);
                    [radius * unit, outwards * unit]
                })
            };
            let wrong = |k: &&Curvature| {
                [DVec2::X, DVec2::Y].iter().any(|t| (k.along(*t) * f64::from(radius) - 1.0).abs() > 0.02)
            };
            assert_eq!(sphere(1.0).iter().filter(wrong).count(), 0, "{radius}");
            let inside = sphere(-1.0);
            assert!(inside.iter().all(|k| (k.largest() * f64::from(radius) + 1.0).abs() < 0.02), "{radius}");
        }
    }

    #[test]
    fn a_cylinder_and_a_saddle_bend_away_along_one_direction() {
        let cylinder = |s: f32, t: f32| {
            let normal = Vec3::new((3.0 * t).cos(), (3.0 * t).sin(), 0.0);
            [normal + 2.0 * s * Vec3::Z, normal]
        };
        let found = of(4000, cylinder);
        let normals: Vec<Vec3> =
            (0..4000).map(|i| cylinder(0.0, (i as f32 * 0.618_034).fract())[1]).collect();
        let along = |direction: Vec3, i: usize| {
            let t = tangents(normals[i].as_dvec3()).map(|axis| axis.dot(direction.as_dvec3()));
            found[i].along(DVec2::from_array(t).normalize())
        };
        assert!(middle((0..4000).map(|i| along(Vec3::Z, i).abs())) < 0.05);
        assert!((middle((0..4000).map(|i| along(normals[i].cross(Vec3::Z), i))) - 1.0).abs() < 0.05);
        // z = −3 x² / 2 + y² / 2 near the origin: curvatures 3 and −1.
        let saddle = |s: f32, t: f32| {
            let (x, y) = (0.02 * (s - 0.5), 0.02 * (t - 0.5));
            [Vec3::new(x, y, -1.5 * x * x + 0.5 * y * y), Vec3::new(3.0 * x, -y, 1.0).normalize()]
        };
        let found = of(1000, saddle);
        assert!((middle(found.iter().map(|k| k.along(DVec2::X))) - 3.0).abs() < 0.1);
        assert!((middle(found.iter().map(|k| k.along(DVec2::Y))) + 1.0).abs() < 0.1);
    }

    #[test]
    fn neighbours_in_one_line_tell_none_across_it() {
        // A line of points with noise, beside which are no others.
        let positions: Vec<Vec3> = (0..100)
            .map(|i| Vec3::new(i as f32, (i * 7 % 5) as f32 * 0.1, (i * 3 % 4) as f32 * -0.1))
            .collect();
        let of = |radius: f32| {
            let surfels = Surfels {
                normals: vec![Vec3::Z; positions.len()],
                radii: vec![radius; positions.len()],
                ellipses: Some(vec![Ellipse { major: Vec3::Y, aspect: 0.1 }; positions.len()]),
                positions: positions.clone(),
                ..Surfels::default()
            };
            let sites = Sites::new(&surfels.positions, &()).unwrap();
            curvatures(&surfels, &sites, Bend::Positions, &()).unwrap()
        };
        assert!(of(10.0).iter().all(|k| *k == Curvature::default()));
        assert!(of(0.1).iter().any(|k| *k != Curvature::default()));
    }

    #[test]
    fn neighbours_all_around_tell_curvatures_however_long_the_ellipse_is() {
        // A cylinder along y, in whose dense points an ellipse on a long triangle of a mesh has its centre.
        let normal = |i: u32| Vec3::new((i as f32 * 0.01).sin(), 0.0, (i as f32 * 0.01).cos());
        let at = |i: u32| normal(i % 30) + Vec3::Y * (i / 30) as f32 * 0.01;
        let surfels = Surfels {
            positions: (0..900).map(at).collect(),
            normals: (0..900).map(|i| normal(i % 30)).collect(),
            radii: vec![1.0; 900],
            ellipses: Some(vec![Ellipse { major: Vec3::Y, aspect: 0.1 }; 900]),
            ..Surfels::default()
        };
        let sites = Sites::new(&surfels.positions, &()).unwrap();
        let found = curvatures(&surfels, &sites, Bend::Positions, &()).unwrap();
        assert!(found.iter().all(|curvature| curvature.largest() > 0.5));
    }

    #[test]
    fn normals_bend_what_is_flat() {
        let saddle = |s: f32, t: f32| {
            let (x, y) = (0.02 * (s - 0.5), 0.02 * (t - 0.5));
            [Vec3::new(x, y, 0.0), Vec3::new(3.0 * x, -y, 1.0).normalize()]
        };
        let of_normals = by(Bend::Normals, 1000, saddle);
        for (axis, curvature) in [(DVec2::X, 3.0), (DVec2::Y, -1.0)] {
            let worst = of_normals.iter().map(|k| (k.along(axis) - curvature).abs()).fold(0.0, f64::max);
            assert!(worst < 0.1, "{axis}: {worst}");
        }
        let of_positions = of(1000, saddle);
        assert!(middle(of_positions.iter().map(|k| k.along(DVec2::X).abs())) < 1.6);
    }

    #[test]
    fn planes_have_none() {
        assert!(of(500, |s, t| [Vec3::new(s, t, 0.0), Vec3::Z]).iter().all(|k| *k == Curvature::default()));
    }

    #[test]
    fn the_other_side_of_a_sheet_does_not_bend_it() {
        let sheet = |s: f32, t: f32| {
            let up = if ((s * 1000.0) as u32).is_multiple_of(2) { 1.0 } else { -1.0 };
            [Vec3::new(s, t, 1e-3 * up), up * Vec3::Z]
        };
        assert!(of(1000, sheet).iter().all(|k| *k == Curvature::default()));
    }

    #[test]
    fn neighbours_in_one_direction_leave_the_others_flat() {
        let fitted = Curvature::of_shape_operator(fit([(DVec3::X, 2.0), (DVec3::X, 2.0)].into_iter()));
        assert!((fitted.along(DVec2::X) - 2.0).abs() < 0.02 && fitted.along(DVec2::Y).abs() < 0.02);
    }
}
