//! Exact rays: where a ray first meets the bumpy sphere, with proof that it was not met before.
//!
//! Along a ray, `g(t) = |p(t)| − r`. Two bounds on it hold between the spheres of radius 0.9 and 1.1, outside of which `g` has no root:
//! - `|g′| ≤ √(1 + (2.5 / 0.9)²)`, as the slope of `r` on the unit sphere is at most 2.5, which is approached at the poles;
//! - `|g″| ≤ 6.5 + 16 (1 − s²)⁵ / s`, where `s = sin θ` is the least on the way: the Hessian's spectral norm, which grows like `14.7 / s`
//!   to the poles and is 4.2 at the equator. The form is fitted to it, with a tenth to spare (`the_bounds_hold`).
//!
//! An interval on which Taylor's formula with these bounds excludes a root is dropped, one on which it proves `g` monotone has at most one
//! root, and any other is halved, the nearer half first.

use super::{GREATEST, LEAST, colour, implicit};
use glam::DVec3;

/// Bound of |g″| where sin θ is no less than this.
fn most_curved(sin: f64) -> f64 {
    6.5 + 16.0 * (1.0 - sin * sin).max(0.0).powi(5) / sin
}

/// Where a ray meets the surface.
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
/// How far the shell is widened, against rounding at its edges.
const MARGIN: f64 = 1e-9;
/// Rounding error of g.
const ROUNDING: f64 = 2e-15;
/// A step of Newton's method after which the root is known.
const ENOUGH: f64 = 1e-13;
/// A ray that comes this near without a provable crossing touches the surface.
const TOUCH: f64 = 1e-14;

/// The first point, at or after `origin`, at which the ray meets the surface, to about 10⁻¹² in distance (where the ray touches the
/// surface rather than crosses it, to 10⁻¹⁴ in |p| − r). `direction` need not be of unit length; a zero or non-finite ray meets
/// nothing.
pub fn trace(origin: DVec3, direction: DVec3) -> Option<Hit> {
    let (distance, position, normal) = meet(origin, direction)?;
    Some(Hit { distance, position, normal, colour: colour(position) })
}

/// The same without the colour: distance, point and normal.
pub fn meet(origin: DVec3, direction: DVec3) -> Option<(f64, DVec3, DVec3)> {
    let direction = direction.try_normalize().filter(|_| origin.is_finite())?;
    // Parameters count from the foot of the perpendicular from the centre, so that far origins cost no digits.
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

/// What is known of an interval.
enum Verdict {
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
            match self.judge(a, middle, b) {
                Verdict::Nothing => {}
                Verdict::Root(t) => return Some(t),
                Verdict::Unknown => todo.extend([[middle, b], [a, middle]]),
            }
        }
        None
    }

    fn judge(&self, a: f64, middle: f64, b: f64) -> Verdict {
        let half = 0.5 * (b - a);
        let (value, slope) = self.value(middle);
        let curvature = most_curved(self.axis_distance(a, b) / GREATEST);
        let reach = (STEEPEST * half).min(slope.abs() * half + 0.5 * curvature * half * half);
        if value.abs() > reach + ROUNDING {
            return Verdict::Nothing;
        }
        let monotone = slope.abs() > curvature * half;
        // Neighbours share an end, and so its computed sign: no crossing falls between two intervals.
        if monotone || half < 1e-13 {
            return match self.value(a).0 < 0.0 {
                inside if inside == (self.value(b).0 < 0.0) => Verdict::Nothing,
                inside => Verdict::Root(self.crossing([a, middle, b], (value, slope), inside)),
            };
        }
        if value.abs() <= TOUCH && half < 1e-6 { Verdict::Root(middle) } else { Verdict::Unknown }
    }

    /// Least distance from the y axis between `a` and `b`.
    fn axis_distance(&self, a: f64, b: f64) -> f64 {
        let (p, d) = (DVec3 { y: 0.0, ..self.foot }, DVec3 { y: 0.0, ..self.direction });
        let nearest = -p.dot(d) / d.length_squared();
        // A ray along the axis is at the same distance everywhere.
        let t = if nearest.is_finite() { nearest.clamp(a, b) } else { a };
        (p + t * d).length()
    }

    /// The root between `low`, where g is negative if `inside`, and `high`, where it is not: Newton's steps from `t`, where g and g′ are
    /// given, halving where they leave the bracket.
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
            // Newton's steps square their error, so that the one after this would be less than rounding.
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

    /// Length of the gradient, and spectral norm of the Hessian by the power method, where both are greatest.
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
        // Steep along the ray means steep against the radius: |∇g| is √(1 + slope²).
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
            // A little inside, as a sample is off the surface by f32 rounding and a ray that grazes it could miss.
            let p = p.as_dvec3() * (1.0 - 1e-6);
            let hit = trace(eye, p - eye).unwrap_or_else(|| panic!("missed {p}"));
            let distance = (p - eye).length();
            assert!(hit.distance < distance, "{p}");
            met += usize::from(distance - hit.distance < 1e-5);
            assert!(implicit(hit.position).0.abs() < 2e-14);
            assert!((hit.distance - (hit.position - eye).length()).abs() < 1e-14);
        }
        // Seen from 3.5 radii, (1 − 1 / 3.5) / 2 of a sphere is visible, and of this one a little less.
        assert!((1_200..1_900).contains(&met), "{met}");
    }

    #[test]
    fn straight_rays_meet_the_known_points() {
        // Along the axis, to a pole; along x, where sin 5φ = 0; from inside; from far away.
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
                // Steps may pass over a crossing and back, tracing not.
                (Some(hit), Some(first)) => prop_assert!(hit.distance <= first && (hit.distance > first - step || touches(&hit, direction, step))),
                (Some(hit), None) => prop_assert!(touches(&hit, direction, step)),
                (None, first) => prop_assert!(first.is_none()),
            }
        }
    }

    /// Whether the ray leaves the surface again within a step or so.
    fn touches(hit: &Hit, direction: DVec3, step: f64) -> bool {
        implicit(hit.position + step * direction).0 > -1e-12
    }
}
