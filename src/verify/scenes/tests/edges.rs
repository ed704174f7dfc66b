//! Clips of scenes with sharp edges: kept parts lie on the surface, discs together cover all of it, and only discs at
//! sharp edges are clipped.

use super::super::random::Random;
use crate::geometry::Surfels;
use crate::verify::scenes;
use crate::verify::scenes::models::part::{BORE, BORE_RADIUS, DEPTH, PROFILE};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Spacing 0.013: no disc reaches both sides of the slot or of a step.
const FINE: &str = "scene:part?points=60000";

/// A clipped disc in float64.
struct Disc {
    centre: DVec3,
    normal: DVec3,
    radius: f64,
    index: usize,
}

fn disc(surfels: &Surfels, index: usize) -> Disc {
    let [centre, normal] = [surfels.positions[index], surfels.normals[index]].map(|v| v.as_dvec3());
    Disc { centre, normal, radius: surfels.radii[index].into(), index }
}

impl Disc {
    fn keeps(&self, surfels: &Surfels, from_centre: DVec3) -> bool {
        let clip = surfels.clips.as_ref().and_then(|clips| clips.get(self.index));
        from_centre.length() <= self.radius && clip.is_none_or(|clip| clip.keeps(from_centre))
    }

    /// Whether it lies on the wall of the bore.
    fn is_bore(&self) -> bool {
        self.normal.z == 0.0 && self.centre.truncate().distance(BORE) < 1.01 * BORE_RADIUS
    }
}

/// Distance from the outline, positive outside.
fn outside(p: DVec2) -> f64 {
    let corner = |i: usize| DVec2::from(PROFILE[i % PROFILE.len()]);
    let mut inside = false;
    let mut nearest = f64::INFINITY;
    for i in 0..PROFILE.len() {
        let (a, b) = (corner(i), corner(i + 1));
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
        let part = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        nearest = nearest.min(p.distance(a + part * (b - a)));
    }
    if inside { -nearest } else { nearest }
}

/// Distance from the part's surface.
fn distance(p: DVec3) -> f64 {
    let across = outside(p.truncate()).max(BORE_RADIUS - p.truncate().distance(BORE));
    let along = p.z.abs() - DEPTH;
    if across <= 0.0 && along <= 0.0 { -across.max(along) } else { across.max(0.0).hypot(along.max(0.0)) }
}

/// Points distributed over a disc.
fn around(disc: &Disc, random: &mut Random) -> Vec<DVec3> {
    let (a, b) = disc.normal.any_orthonormal_pair();
    let turn = random.unit();
    let point = |i: u32| {
        let (r, phi) = ((f64::from(i % 8) + 1.0) / 8.0, TAU * (f64::from(i / 8) + turn) / 24.0);
        disc.radius * r * (phi.cos() * a + phi.sin() * b)
    };
    (0..192).map(point).collect()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn what_discs_keep_is_on_the_surface() {
    for sampler in ["jittered", "blue-noise", "grid", "scanner"] {
        let surfels = scenes::open(&format!("{FINE}&sampler={sampler}")).unwrap();
        assert_eq!(surfels.count_invalid(), 0);
        let mut random = Random::new(1, 0);
        // On plane faces only rounding errs: the centre by 2⁻²⁴ in each coordinate, line and normal by as much times
        // the disc's reach. The bore's wall deviates from its tangent plane by a²/2R.
        let rounding = 4e-7;
        let (mut clipped, mut corners) = (0, 0);
        for index in 0..surfels.len() {
            let disc = disc(&surfels, index);
            // Discs of a scanner are wide at steep angles; those that cross more than two edges are not tested.
            if disc.radius > 0.03 {
                continue;
            }
            let bend = if disc.is_bore() { disc.radius.powi(2) / (2.0 * BORE_RADIUS) } else { 0.0 };
            let clip = surfels.clips.as_ref().and_then(|clips| clips.get(index));
            clipped += usize::from(clip.is_some());
            corners += usize::from(clip.is_some_and(|clip| clip.lines[1].is_some()));
            for from_centre in around(&disc, &mut random).into_iter().filter(|x| disc.keeps(&surfels, *x)) {
                let off = distance(disc.centre + from_centre);
                assert!(off <= bend + rounding, "{sampler}: {off} off, {:?} {clip:?}", disc.centre);
            }
        }
        assert!(clipped > 1000 && corners > 20, "{sampler}: {clipped} clipped, {corners} at corners");
    }
}

/// Points of the part's edges, with the normals of both faces.
fn edge_points(random: &mut Random) -> Vec<(DVec3, [DVec3; 2])> {
    let corner = |i: usize| DVec2::from(PROFILE[i % PROFILE.len()]);
    let along = |i: usize| (corner(i + 1) - corner(i)).normalize();
    let normal = |i: usize| (-along(i).perp()).extend(0.0);
    let mut points = Vec::new();
    for i in 0..PROFILE.len() {
        for _ in 0..40 {
            let at = corner(i).lerp(corner(i + 1), random.unit());
            points.push((at.extend(DEPTH), [normal(i), DVec3::Z]));
            let z = DEPTH * (2.0 * random.unit() - 1.0);
            points.push((corner(i + 1).extend(z), [normal(i), normal(i + 1)]));
        }
    }
    for _ in 0..100 {
        let out = DVec2::from_angle(TAU * random.unit());
        points.push(((BORE + BORE_RADIUS * out).extend(-DEPTH), [(-out).extend(0.0), -DVec3::Z]));
    }
    points
}

/// The nearest discs of both faces keep a point of their edge, moved inwards by at most the rounding error, and remove
/// it if moved outwards.
#[test]
#[ignore = "takes long: tools/test --all"]
fn faces_meet_at_their_edges_without_a_gap() {
    let surfels = scenes::open(FINE).unwrap();
    for (point, normals) in edge_points(&mut Random::new(2, 0)) {
        for (side, other) in [(normals[0], normals[1]), (normals[1], normals[0])] {
            let mut kept = 0;
            for index in 0..surfels.len() {
                let disc = disc(&surfels, index);
                if disc.centre.distance(point) > disc.radius || disc.normal.dot(side) < 0.99 {
                    continue;
                }
                // In the disc's plane, unlike the bore's wall; a rim's line is its tangent, so neighbours cover the
                // remainder.
                let from_centre = (point - disc.centre).reject_from_normalized(disc.normal);
                let inwards = (disc.centre - point).reject_from_normalized(disc.normal).normalize();
                let bend = if disc.is_bore() || other.z == 0.0 && point.truncate().distance(BORE) < 0.3 {
                    disc.radius.powi(2) / (2.0 * BORE_RADIUS)
                } else {
                    0.0
                };
                kept += usize::from(disc.keeps(&surfels, from_centre + (bend + 4e-7) * inwards));
            }
            assert!(kept > 0, "no disc of the face towards {side} keeps {point}");
        }
    }
}

#[test]
fn clips_are_of_discs_that_reach_an_edge_alone() {
    let surfels = scenes::open(FINE).unwrap();
    let clips = surfels.clips.as_ref().unwrap();
    let edges = |p: DVec3| {
        let corner = |i: usize| DVec2::from(PROFILE[i % PROFILE.len()]);
        let outline = |i: usize| {
            let (a, b) = (corner(i), corner(i + 1));
            let part = ((p.truncate() - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let beside = p.truncate().distance(a + part * (b - a));
            beside.hypot(p.z.abs() - DEPTH).min(p.truncate().distance(b).hypot((p.z.abs() - DEPTH).max(0.0)))
        };
        let rim = (p.truncate().distance(BORE) - BORE_RADIUS).hypot(p.z.abs() - DEPTH);
        (0..PROFILE.len()).map(outline).fold(rim, f64::min)
    };
    for index in 0..surfels.len() {
        let disc = disc(&surfels, index);
        let reach = edges(disc.centre) - disc.radius;
        // Closer than rounding, either result is right.
        if reach.abs() > 1e-6 {
            assert_eq!(clips.get(index).is_some(), reach < 0.0, "{:?}", disc.centre);
        }
    }
}

#[test]
fn slabs_end_at_their_edges_and_clips_can_be_turned_off() {
    let surfels = scenes::open("scene:slabs?slabs=2&thickness=0.5&gap=0.1&points=20000").unwrap();
    let middle = |p: DVec3| if p.y > -0.3 { DVec3::ZERO } else { DVec3::new(0.3, -0.6, 0.3) };
    let mut random = Random::new(3, 0);
    for index in 0..surfels.len() {
        let disc = disc(&surfels, index);
        for from_centre in around(&disc, &mut random).into_iter().filter(|x| disc.keeps(&surfels, *x)) {
            let p = disc.centre + from_centre - middle(disc.centre);
            assert!((p.abs() - DVec3::new(1.0, 0.25, 1.0)).max_element() < 1e-6, "{p}");
        }
    }
    assert!(surfels.clips.is_some());
    for name in ["scene:slabs", "scene:part"] {
        let [on, off] = ["on", "off"]
            .map(|clips| scenes::open(&format!("{name}?points=5000&noise=0.1&clips={clips}")).unwrap());
        assert!(on.clips.is_some() && on.count_invalid() == 0);
        assert_eq!(off, Surfels { clips: None, ..on });
    }
    assert_eq!(scenes::open("scene:torus?points=1000").unwrap().clips, None);
}

#[test]
fn surfels_of_the_disc_end_at_its_rim() {
    let surfels = scenes::open("scene:disc?points=2000").unwrap();
    let mut random = Random::new(3, 0);
    for index in 0..surfels.len() {
        let disc = disc(&surfels, index);
        let clip = surfels.clips.as_ref().and_then(|clips| clips.get(index));
        let reach = disc.centre.length() + disc.radius - 1.0;
        assert!(reach.abs() < 1e-6 || clip.is_some() == (reach > 0.0), "{:?}", disc.centre);
        // The line is a tangent of the rim.
        let bend = disc.radius.powi(2) / 2.0;
        let kept = around(&disc, &mut random).into_iter().filter(|x| disc.keeps(&surfels, *x));
        let farthest = kept.map(|x| (disc.centre + x).length()).fold(0.0, f64::max);
        assert!(farthest <= 1.0 + bend + 4e-7, "{farthest} at {:?}", disc.centre);
    }
}
