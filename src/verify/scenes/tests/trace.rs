//! Ray intersections against parametrizations, implicit functions and closed forms.

use super::super::random::Random;
use super::super::shapes::{Jet, Parametric, Patch, Ray, Shape, Torus};
use super::{points, scenes, vector};
use crate::verify::scenes::models::part::{BORE, BORE_RADIUS, DEPTH};
use crate::verify::scenes::{self, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A ray towards any point of a surface hits that point or an earlier one, and the hit lies on the surface.
#[test]
fn every_point_is_met_or_hidden() {
    let mut random = Random::new(2, 0);
    for (name, surface) in scenes() {
        let bounds = surface.bounds();
        let mut met = 0;
        for (piece, uv, sample) in points(&*surface, &mut random, 1500) {
            let eye = bounds.centre()
                + (1.0 + 2.0 * random.unit()) * bounds.radius * vector(&mut random).normalize();
            let aim = sample.point.position - eye;
            let hit = surface.trace(eye, aim).unwrap_or_else(|| panic!("{name} {uv} from {eye}: missed"));
            // The distance of a grazing ray is ill-conditioned.
            let facing = sample.point.normal.dot(aim.normalize()).abs();
            assert!(hit.t < 1.0 + 1e-12 / facing.powi(2).max(1e-9), "{name} {uv} from {eye}: {}", hit.t);
            let off = (eye + hit.t * aim - hit.position).length();
            assert!(off < 1e-9 * bounds.radius, "{name}: met {off} beside the ray");
            if facing > 0.05 && (hit.t - 1.0).abs() < 1e-9 {
                met += 1;
                assert!((hit.normal - sample.point.normal).length() < 1e-5, "{name} {uv} {hit:?} {sample:?}");
                let albedo = piece.texture.at(&sample.point);
                let difference = (0..3).map(|i| (albedo[i] - hit.albedo[i]).abs()).fold(0.0, f64::max);
                assert!(difference < 1e-4 || is_at_an_edge(&*surface, &hit), "{name} {uv}: {difference}");
            }
        }
        assert!(met > 200, "{name}: {met} of 1500 points were met");
    }
}

/// Whether the albedo changes within rounding of the hit.
fn is_at_an_edge(surface: &dyn Surface, hit: &scenes::Hit) -> bool {
    let side = hit.normal.any_orthonormal_vector();
    let around = |offset: DVec3| {
        surface.trace(hit.position + hit.normal * 1e-3 + 1e-6 * offset, -hit.normal).map(|hit| hit.albedo)
    };
    let other = side.cross(hit.normal);
    [side, -side, other, -other].into_iter().any(|offset| around(offset) != Some(hit.albedo))
}

/// The first of equal steps along a ray at which `inside` is true.
fn march(
    inside: &dyn Fn(DVec3) -> bool,
    origin: DVec3,
    direction: DVec3,
    [from, to]: [f64; 2],
) -> Option<f64> {
    const STEP: f64 = 2e-4;
    let steps = ((to - from) / STEP) as u32;
    (0..steps).map(|i| from + f64::from(i) * STEP).find(|t| inside(origin + *t * direction))
}

#[test]
fn first_hits_agree_with_small_steps() {
    let slab = |p: DVec3, i: f64| {
        let p = p - DVec3::new(0.3 * i, -0.03 * i, 0.3 * i);
        p.x.abs() < 1.0 && p.y.abs() < 0.005 && p.z.abs() < 1.0
    };
    let part = |p: DVec3| {
        let block = p.x.abs() < 1.0 && p.y.abs() < 0.6 && p.z.abs() < DEPTH;
        let step = p.x > 0.3 && p.y > 0.2;
        let slot = p.x > -0.5 && p.x < -0.2 && p.y > 0.2;
        block && !step && !slot && (p.truncate() - BORE).length() > BORE_RADIUS
    };
    let wave = |kx: f64, kz: f64, part: f64, p: DVec3| 0.15 * part * (kx * p.x + kz * p.z).sin();
    let relief = |p: DVec3| {
        let y = wave(2.1, 0.7, 0.4, p)
            + wave(-1.3, 2.9, 0.3, p)
            + wave(4.7, -3.1, 0.2, p)
            + wave(1.9, 7.3, 0.1, p);
        p.x.abs() < 6.0 && p.z.abs() < 6.0 && p.y < y && p.y > -0.5
    };
    let solids: [(&str, &dyn Fn(DVec3) -> bool); 5] = [
        ("scene:sphere", &|p| p.length() < 1.0),
        ("scene:torus", &|p| (p.x.hypot(p.z) - 1.0).hypot(p.y) < 0.4),
        ("scene:part", &part),
        ("scene:slabs", &|p| (0..3).any(|i| slab(p, f64::from(i)))),
        ("scene:relief", &relief),
    ];
    let mut random = Random::new(3, 0);
    for (name, inside) in solids {
        let surface = scenes::surface(name).unwrap();
        let bounds = surface.bounds();
        let mut met = 0;
        for _ in 0..150 {
            let mut origin = bounds.centre() + 1.2 * bounds.radius * vector(&mut random).normalize();
            // The relief has no underside.
            origin.y = if name == "scene:relief" { 0.3 + 2.0 * random.unit() } else { origin.y };
            let direction =
                (bounds.centre() + 0.7 * bounds.radius * vector(&mut random) - origin).normalize();
            let marched = march(inside, origin, direction, [0.0, 3.0 * bounds.radius]);
            match (surface.trace(origin, direction), marched) {
                (Some(hit), Some(first)) => {
                    met += 1;
                    assert!(hit.t <= first + 1e-9, "{name}: met at {}, not {first}", hit.t);
                    // Steps may pass over two crossings, tracing does not.
                    let thin = !inside(hit.position + 4e-4 * direction);
                    let side = name == "scene:relief" && hit.t > first - 1.0;
                    assert!(hit.t > first - 2.1e-4 || thin || side, "{name}: met at {}, not {first}", hit.t);
                }
                (Some(hit), None) => assert!(!inside(hit.position + 4e-4 * direction), "{name}: {hit:?}"),
                // The relief is a sheet: below its edge there is nothing.
                (None, first) => {
                    assert!(first.is_none() || name == "scene:relief", "{name}: missed {first:?}")
                }
            }
        }
        assert!(met > 30, "{name}: {met}");
    }
}

/// The torus as a parametrized surface: the tracer of patches must agree with the quartic.
struct Parametrised(Torus);

impl Parametric for Parametrised {
    fn jet(&self, uv: DVec2) -> Jet {
        let (around, tube) = (DVec2::from_angle(TAU * uv.x), DVec2::from_angle(TAU * uv.y));
        let reach = self.0.major + self.0.minor * tube.x;
        let spoke = DVec3::new(around.x, 0.0, around.y);
        Jet {
            position: self.0.centre + reach * spoke + self.0.minor * tube.y * DVec3::Y,
            du: -TAU * reach * DVec3::new(around.y, 0.0, -around.x),
            dv: TAU * self.0.minor * (tube.x * DVec3::Y - tube.y * spoke),
        }
    }

    fn extent(&self) -> DVec2 {
        DVec2::ONE
    }
}

fn tori() -> (Torus, Patch<Parametrised>) {
    let torus = Torus { centre: DVec3::new(0.1, -0.2, 0.3), major: 1.0, minor: 0.4 };
    (torus, Patch::new(Parametrised(torus), [48, 24]))
}

#[test]
fn patches_meet_what_the_closed_form_has() {
    let (torus, patch) = tori();
    let mut random = Random::new(5, 0);
    let mut met = 0;
    for i in 0..4000 {
        let origin = 3.0 * vector(&mut random).normalize() + torus.centre;
        // Half of the rays pass close to the outline.
        let point = torus.at(DVec2::new(random.unit(), random.unit())).point;
        let mut aim = point.position - origin;
        if i % 2 == 0 {
            let beside = point.position + 10f64.powf(-2.0 - 8.0 * random.unit()) * point.normal;
            aim = point.normal.any_orthonormal_vector() * (beside - origin).length();
        }
        let origin = if i % 2 == 0 { point.position + 1e-7 * point.normal - aim } else { origin };
        let ray = Ray { origin, direction: aim.normalize() };
        let [a, b] = [torus.trace(&ray, f64::INFINITY), patch.trace(&ray, f64::INFINITY)];
        match (a, b) {
            (Some((a, point)), Some((b, _))) => {
                let tolerance = 1e-11 / point.normal.dot(ray.direction).abs().max(1e-6);
                assert!((a - b).abs() < tolerance.min(1e-5), "{a} and {b}");
                met += 1;
            }
            (a, b) => assert!(a.is_none() && b.is_none(), "{a:?} and {b:?}"),
        }
    }
    assert!(met > 2000, "{met}");
}

#[test]
fn rays_that_graze_are_decided_to_a_billionth() {
    let (torus, patch) = tori();
    for shape in [&torus as &dyn Shape, &patch] {
        for depth in [1e-3, 1e-6, 1e-9, 1e-10] {
            for turn in [0.0, 0.3, 1.1] {
                // Above the highest circle, in radial direction.
                let spoke = DVec3::new(f64::cos(turn), 0.0, f64::sin(turn));
                let ray = |height: f64| {
                    let origin = torus.centre + 3.0 * spoke + height * DVec3::Y;
                    shape.trace(&Ray { origin, direction: -spoke }, f64::INFINITY)
                };
                let (t, _) = ray(0.4 - depth).unwrap_or_else(|| panic!("missed {depth} below the top"));
                // Half the chord of a circle at this depth.
                let expected = 2.0 - (2.0 * 0.4 * depth - depth * depth).sqrt();
                assert!((t - expected).abs() < 1e-14 / depth + 1e-11, "{depth}: {t}, not {expected}");
                assert!(ray(0.4 + depth).is_none(), "{depth} above the top");
            }
        }
    }
}

#[test]
fn rays_may_be_of_any_length_from_anywhere() {
    for (name, expected) in
        [("scene:sphere", 1e6 - 1.0), ("scene:torus", 1e6 - 1.4), ("scene:part", 1e6 - 1.0)]
    {
        let surface = scenes::surface(name).unwrap();
        let far = DVec3::new(1e6, 0.0, 0.0);
        let hit = surface.trace(far, DVec3::new(-0.5, 0.0, 0.0)).unwrap();
        assert!((hit.t - 2.0 * expected).abs() < 1e-8, "{name}: {}", hit.t);
        assert!((hit.position.x - (1e6 - expected)).abs() < 1e-9, "{name}: {}", hit.position);
        assert!(surface.trace(far, DVec3::X).is_none(), "{name}: behind");
        for (origin, direction) in
            [(far, DVec3::ZERO), (DVec3::NAN, DVec3::X), (far, DVec3::splat(f64::INFINITY))]
        {
            assert!(surface.trace(origin, direction).is_none(), "{name}");
        }
    }
    // From inside, the far side.
    let sphere = scenes::surface("scene:sphere").unwrap();
    assert!((sphere.trace(DVec3::ZERO, DVec3::Z).unwrap().t - 1.0).abs() < 1e-15);
}

#[test]
fn the_horizon_is_where_the_plane_ends() {
    let plane = scenes::surface("scene:plane?radius=500").unwrap();
    let eye = DVec3::Y;
    // In a diagonal direction, in which the disc ends before its bounding box.
    let aslant = DVec3::new(0.8, 0.0, -0.6);
    let along = |level: DVec3, distance: f64| plane.trace(eye, level - DVec3::Y / distance);
    assert!((along(aslant, 499.9).unwrap().position.length() - 499.9).abs() < 1e-9);
    assert!(along(aslant, 500.1).is_none() && plane.trace(eye, aslant).is_none());
    let at = |distance: f64| along(DVec3::NEG_Z, distance);
    assert_ne!(at(10.4).unwrap().albedo, at(11.4).unwrap().albedo);
}
