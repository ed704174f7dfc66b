//! Distances to ellipses.

use glam::DVec2;

/// Distance of `p`, in the first quadrant, to the ellipse of semi-axes `axes.x ≥ axes.y`. The foot of the perpendicular
/// is `(r² p.x / (t + r²), p.y / (t + 1))`, `r = axes.x / axes.y`, where `t` is the largest root of a monotonic
/// function, found by bisection. The first-order distance `|m - F| / |∇m|` fails at the tips of thin ellipses.
pub(super) fn to_ellipse(axes: DVec2, p: DVec2) -> f64 {
    if p.y <= 1e-12 * axes.y {
        return from_major_axis(axes, p.x);
    }
    let (ratio, x, y) = (axes.x / axes.y, p.x / axes.y, p.y / axes.y);
    let residual = |t: f64| (ratio * x / (t + ratio * ratio)).powi(2) + (y / (t + 1.0)).powi(2) - 1.0;
    let (mut low, mut high) = (y - 1.0, (ratio * x).hypot(y) - 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        *(if residual(middle) > 0.0 { &mut low } else { &mut high }) = middle;
    }
    let t = 0.5 * (low + high);
    DVec2::new(ratio * ratio * p.x / (t + ratio * ratio), p.y / (t + 1.0)).distance(p)
}

/// The same for a point on the major axis: up to the centre of curvature of the tip, the nearest points lie beside the
/// axis.
fn from_major_axis(axes: DVec2, x: f64) -> f64 {
    let evolute = axes.x - axes.y * (axes.y / axes.x);
    if x >= evolute {
        return (x - axes.x).abs();
    }
    let foot = x / evolute;
    (axes.x * foot - x).hypot(axes.y * (1.0 - foot * foot).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn distance_is_that_of_the_nearest_point() {
        for axes in [DVec2::new(3.0, 3.0), DVec2::new(5.0, 1.0), DVec2::new(4000.0, 0.71)] {
            // Dense about the tip of the major axis, where thin ellipses turn.
            let point = |i: i32| {
                let angle = FRAC_PI_2 * (f64::from(i) / 20_000.0).powi(3);
                axes * DVec2::new(angle.cos(), angle.sin())
            };
            let points: Vec<DVec2> = (0..=20_000).map(point).collect();
            for fraction in [0.0, 1e-6, 1e-3, 0.3, 0.9, 1.0] {
                for off in [-0.3, -3e-4, 0.0, 3e-4, 2.0] {
                    let p =
                        (axes * DVec2::from_angle(FRAC_PI_2 * fraction) + DVec2::splat(off)).max(DVec2::ZERO);
                    let to_segment = |s: &[DVec2]| {
                        let (from, along) = (p - s[0], s[1] - s[0]);
                        (from - (from.dot(along) / along.length_squared()).clamp(0.0, 1.0) * along).length()
                    };
                    let nearest = points.windows(2).map(to_segment).fold(f64::INFINITY, f64::min);
                    let found = to_ellipse(axes, p);
                    assert!(
                        (found - nearest).abs() < 0.01 * nearest + 1e-6,
                        "{axes} {p}: {found} for {nearest}"
                    );
                }
            }
        }
    }
}
