//! Exact ray intersections with the bumpy sphere: the first one, with proof that there is none before it.
//!
//! Along a ray, `g(t) = |p(t)| − r`. Two bounds hold between the spheres of radius 0.9 and 1.1, outside of which `g`
//! has no root:
//! - `|g′| ≤ √(1 + (2.5 / 0.9)²)`, as the slope of `r` on the unit sphere is at most 2.5, approached at the poles;
//! - `|g″| ≤ 6.5 + 16 (1 − s²)⁵ / s`, where `s = sin θ` is the least on the interval: a fit, 10 % above the Hessian's
//!   spectral norm, which grows like `14.7 / s` towards the poles and is 4.2 at the equator (test `the_bounds_hold`).
//!
//! An interval is dropped if Taylor's formula with these bounds excludes a root. It has at most one root if they prove
//! `g` monotone. Any other interval is halved, the nearer half first.

use super::{GREATEST, LEAST, colour, implicit};
use glam::DVec3;

/// Bound of |g″| for sin θ from this value on.
fn most_curved(sin: f64) -> f64 {
    6.5 + 16.0 * (1.0 - sin * sin).max(0.0).powi(5) / sin
}

/// Intersection of a ray with the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin, world units.
    pub distance: f64,
    /// The point, world space.
    pub position: DVec3,
    /// Unit normal, outwards.
    pub normal: DVec3,
    /// The checker's colour, sRGB-encoded.
    pub colour: [u8; 3],
}

/// Bound of |g′|.
const STEEPEST: f64 = 2.96;
/// Widening of the shell against rounding at its borders.
const MARGIN: f64 = 1e-9;
/// Rounding error of g.
const ROUNDING: f64 = 2e-15;
/// Step of Newton's method at which the root is found.
const ENOUGH: f64 = 1e-13;
/// Distance without a provable crossing at which a ray touches the surface.
const TOUCH: f64 = 1e-14;

/// The first intersection at or after `origin`, to about 10⁻¹² in distance; where the ray touches the surface without
/// crossing it, to 10⁻¹⁴ in |p| − r. `direction` may have any length; a zero or non-finite ray has none.
pub fn trace(origin: DVec3, direction: DVec3) -> Option<Hit> {
    let (distance, position, normal) = meet(origin, direction)?;
    Some(Hit { distance, position, normal, colour: colour(position) })
}

/// The same without colour: distance, point and normal.
pub fn meet(origin: DVec3, direction: DVec3) -> Option<(f64, DVec3, DVec3)> {
    let direction = direction.try_normalize().filter(|_| origin.is_finite())?;
    // Parameters count from the foot of the perpendicular from the centre, so that far origins lose no digits.
    let to_foot = -origin.dot(direction);
    let ray = Ray { foot: origin + to_foot * direction, direction };
    let half = |radius: f64| (radius * radius - ray.foot.length_squared()).max(0.0).sqrt();
    let (outer, inner) = (half(GREATEST + MARGIN), half(LEAST - MARGIN));
    if outer == 0.0 {
        return None;
    }
    let spans = [[-outer, -inner], [inner, outer]].map(|[a, b]| [a.max(-to_foot), b]);
    let t = spans.into_iter().filter(|[a, b]| a < b).find_map(|span| ray.first_root(span))?;
    let position = ray.at(t);
    Some((t + to_foot, position, implicit(position).1.normalize()))
}

struct Ray {
    /// The point nearest to the centre.
    foot: DVec3,
    /// Unit vector.
    direction: DVec3,
}

/// Result for an interval.
enum IntervalClass {
    Nothing,
    Root(f64),
    Unknown,
}

impl Ray {
    fn at(&self, t: f64) -> DVec3 {
        self.foot + t * self.direction
    }

    /// g and g′.
    fn value(&self, t: f64) -> (f64, f64) {
        let (value, gradient) = implicit(self.at(t));
        (value, gradient.dot(self.direction))
    }

    fn first_root(&self, span: [f64; 2]) -> Option<f64> {
        let mut todo = vec![span];
        while let Some([a, b]) = todo.pop() {
            let middle = 0.5 * (a + b);
            match self.classify(a, middle, b) {
                IntervalClass::Nothing => {}
                IntervalClass::Root(t) => return Some(t),
                IntervalClass::Unknown => todo.extend([[middle, b], [a, middle]]),
            }
        }
        None
    }

    fn classify(&self, a: f64, middle: f64, b: f64) -> IntervalClass {
        let half = 0.5 * (b - a);
        let (value, slope) = self.value(middle);
        let curvature = most_curved(self.axis_distance(a, b) / GREATEST);
        let reach = (STEEPEST * half).min(slope.abs() * half + 0.5 * curvature * half * half);
        if value.abs() > reach + ROUNDING {
            return IntervalClass::Nothing;
        }
        let monotone = slope.abs() > curvature * half;
        // Adjacent intervals share an end, and so its computed sign: no crossing falls between them.
        if monotone || half < 1e-13 {
            return match self.value(a).0 < 0.0 {
                inside if inside == (self.value(b).0 < 0.0) => IntervalClass::Nothing,
                inside => IntervalClass::Root(self.crossing([a, middle, b], (value, slope), inside)),
            };
        }
        if value.abs() <= TOUCH && half < 1e-6 { IntervalClass::Root(middle) } else { IntervalClass::Unknown }
    }

    /// Least distance from the y axis between `a` and `b`.
    fn axis_distance(&self, a: f64, b: f64) -> f64 {
        let (p, d) = (DVec3 { y: 0.0, ..self.foot }, DVec3 { y: 0.0, ..self.direction });
        let nearest = -p.dot(d) / d.length_squared();
        // A ray along the axis has a constant distance.
        let t = if nearest.is_finite() { nearest.clamp(a, b) } else { a };
        (p + t * d).length()
    }

    /// The root between `low`, where g is negative if `inside`, and `high`, where it is not: Newton's method from `t`,
    /// where g and g′ are given, with bisection where a step leaves the bracket.
    fn crossing(&self, [mut low, mut t, mut high]: [f64; 3], at_t: (f64, f64), inside: bool) -> f64 {
        let (mut value, mut slope) = at_t;
        for _ in 0..200 {
            if (value < 0.0) == inside {
                low = t
            } else {
                high = t
            }
            let newton = t - value / slope;
            let tame = newton >= low && newton <= high;
            // Newton's steps square their error: the next one would be below rounding.
            if tame && (newton - t).abs() <= ENOUGH {
                return newton;
            }
            t = if tame { newton } else { 0.5 * (low + high) };
            (value, slope) = self.value(t);
        }
        t
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from)
    }

    /// Length of the gradient, and spectral norm of the Hessian by power iteration, at the distance where both are
    /// greatest.
    fn steepness_and_curvature(theta: f64, phi: f64) -> (f64, f64) {
        let p = LEAST * DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
        let (gradient, step) = (|p| implicit(p).1, 1e-5 * theta.sin());
        let rows = [DVec3::X, DVec3::Y, DVec3::Z]
            .map(|axis| (gradient(p + step * axis) - gradient(p - step * axis)) / (2.0 * step));
        let times = |v: DVec3| DVec3::from_array(rows.map(|row| row.dot(v)));
        let long = (0..60).fold(DVec3::new(0.6, 0.5, 0.4), |v, _| times(v).normalize());
        (gradient(p).length(), times(long).length())
    }

    #[test]
    fn the_bounds_hold() {
        let (mut steepest, mut most) = (0.0f64, 0.0f64);
        let (thetas, phis) = (1500, 100);
        for i in 0..thetas * phis {
            // Denser towards the pole; the bumps repeat five times around.
            let theta = std::f64::consts::FRAC_PI_2 * (f64::from(i / phis + 1) / f64::from(thetas)).powi(2);
            let (steep, curved) = steepness_and_curvature(
                theta,
                std::f64::consts::TAU / 5.0 * f64::from(i % phis) / f64::from(phis),
            );
            steepest = steepest.max(steep);
            most = most.max(curved / most_curved(theta.sin()));
        }
        // The slope along the ray is at most |∇g|, which is √(1 + slope²).
        assert!(steepest < STEEPEST && steepest > 0.9 * STEEPEST, "{steepest}");
        assert!(most < 0.95 && most > 0.85, "{most}");
        assert!((1..100).all(|i| most_curved(f64::from(i) * 0.01) > most_curved(f64::from(i + 1) * 0.01)));
    }

    #[test]
    fn a_ray_through_a_sample_meets_it_or_something_nearer() {
        let surfels = sample(5_000, 3);
        let eye = 3.5 * DVec3::new(1.0, 0.8, 1.6).normalize();
        let mut met = 0;
        for p in &surfels.positions {
            // Slightly inside: a sample is off the surface by f32 rounding, and a grazing ray could miss it.
            let p = p.as_dvec3() * (1.0 - 1e-6);
            let hit = trace(eye, p - eye).unwrap_or_else(|| panic!("missed {p}"));
            let distance = (p - eye).length();
            assert!(hit.distance < distance, "{p}");
            met += usize::from(distance - hit.distance < 1e-5);
            assert!(implicit(hit.position).0.abs() < 2e-14);
            assert!((hit.distance - (hit.position - eye).length()).abs() < 1e-14);
        }
        // From 3.5 radii, (1 − 1 / 3.5) / 2 of a sphere is visible, and slightly less of this one.
        assert!((1_200..1_900).contains(&met), "{met}");
    }

    #[test]
    fn straight_rays_meet_the_known_points() {
        // Along the axis to a pole; along x, where sin 5φ = 0; from inside; from far away.
        let down = trace(DVec3::new(0.0, 5.0, 0.0), -DVec3::Y).unwrap();
        assert_eq!((down.distance, down.position), (4.0, DVec3::Y));
        assert!((trace(DVec3::new(3.0, 0.0, 0.0), -2.0 * DVec3::X).unwrap().distance - 2.0).abs() < 1e-15);
        assert!((trace(DVec3::ZERO, DVec3::Z).unwrap().distance - 1.1).abs() < 1e-12);
        assert!((trace(DVec3::new(0.0, 0.0, 1e6), -DVec3::Z).unwrap().distance - (1e6 - 1.1)).abs() < 1e-9);
        for (origin, direction) in [
            (DVec3::new(3.0, 1.2, 0.0), -DVec3::X),
            (DVec3::new(3.0, 0.0, 0.0), DVec3::X),
            (DVec3::new(3.0, 0.0, 0.0), DVec3::ZERO),
            (DVec3::NAN, DVec3::X),
        ] {
            assert_eq!(trace(origin, direction), None, "{origin} {direction}");
        }
    }

    #[test]
    fn rays_that_graze_a_bump_meet_it() {
        // Tangent rays just below and just above the highest point, on the equator in direction +z.
        for depth in [1e-3, 1e-6, 1e-9, 1e-12] {
            for (across, offset) in [(DVec3::X, DVec3::Z), (DVec3::Y, DVec3::Z)] {
                let ray = |height: f64| trace(height * offset - 2.0 * across, across);
                assert!(ray(1.1 - depth).is_some(), "{depth}, {across}");
                assert_eq!(ray(1.1 + depth), None, "{depth}, {across}");
            }
        }
    }

    proptest! {
        #[test]
        fn the_first_hit_agrees_with_small_steps(eye in vector(), aim in vector()) {
            let origin = 3.0 * eye.try_normalize().unwrap_or(DVec3::X);
            let direction = (1.2 * aim - origin).normalize();
            let step = 1e-4;
            let outside = |distance: f64| implicit(origin + distance * direction).0 > 0.0;
            let first = (0..60_000).map(|i| f64::from(i) * step).find(|&distance| !outside(distance));
            match (trace(origin, direction), first) {
                // Steps may pass over two crossings, tracing does not.
                (Some(hit), Some(first)) => prop_assert!(hit.distance <= first && (hit.distance > first - step || touches(&hit, direction, step))),
                (Some(hit), None) => prop_assert!(touches(&hit, direction, step)),
                (None, first) => prop_assert!(first.is_none()),
            }
        }
    }

    /// Whether the ray leaves the surface again within about a step.
    fn touches(hit: &Hit, direction: DVec3, step: f64) -> bool {
        implicit(hit.position + step * direction).0 > -1e-12
    }
}
