//! Radii of discs at a triangle's corners that together cover the triangle.

/// Radius of the disc at corner `p`, if every corner has one, at which the discs cover the triangle: the distance to the farthest point
/// that is nearer to `p` than to the other corners. The arguments are squared lengths of sides: `pa` from `p` to `a`, and so on.
///
/// For an acute triangle it is the circumradius. For an obtuse one, whose circumcentre is outside, it is the distance to where the
/// bisectors of the short sides meet the long one. 0 for a degenerate triangle.
pub(super) fn reach(pa: f64, pb: f64, ab: f64) -> f64 {
    // By the law of cosines: twice the product of two sides and the cosine between them.
    let (at_p, at_a, at_b) = (pa + pb - ab, pa + ab - pb, pb + ab - pa);
    let longest = pa.max(pb).max(ab).sqrt();
    let found = if at_p <= 0.0 {
        // The point of side ab that is equally far from p and a is |pa| / (2 cos A) away from both.
        let from_a = pa * ab.sqrt() / at_a;
        let from_b = pb * ab.sqrt() / at_b;
        from_a.max(from_b)
    } else if at_a <= 0.0 {
        pa * pb.sqrt() / at_p
    } else if at_b <= 0.0 {
        pb * pa.sqrt() / at_p
    } else {
        // 16 times the squared area, by Heron. It is only rounding error where two corners are close together, but the circumradius of an
        // acute triangle is between these two parts of the longest side.
        let area = (4.0 * pa * pb - at_p * at_p).max(0.0);
        (pa * pb * ab / area).sqrt().min(longest / 3f64.sqrt()).max(0.5 * longest)
    };
    // Where two corners nearly coincide, twice a cosine may be rounded to 0.
    found.max(0.0).min(longest / 3f64.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// The distance from the corner at 0 to the farthest point of the triangle that is nearer to it than to the other two.
    fn searched(a: DVec2, b: DVec2) -> f64 {
        const STEPS: u32 = 400;
        let mut farthest: f64 = 0.0;
        for i in 0..=STEPS {
            for j in 0..=STEPS - i {
                let x = (f64::from(i) * a + f64::from(j) * b) / f64::from(STEPS);
                if x.length() <= x.distance(a).min(x.distance(b)) {
                    farthest = farthest.max(x.length());
                }
            }
        }
        farthest
    }

    #[test]
    fn it_is_the_farthest_point_that_is_nearest_to_the_corner() {
        let corners = [
            (DVec2::new(1.0, 0.0), DVec2::new(0.4, 0.9)),
            (DVec2::new(1.0, 0.0), DVec2::new(-0.7, 0.4)),
            (DVec2::new(1.0, 0.0), DVec2::new(3.0, 0.8)),
            (DVec2::new(3.0, 0.8), DVec2::new(1.0, 0.0)),
            (DVec2::new(1.0, 0.0), DVec2::new(0.0, 1.0)),
            (DVec2::new(1.0, 0.0), DVec2::new(0.9, 0.1)),
        ];
        for (a, b) in corners {
            let (found, expected) =
                (reach(a.length_squared(), b.length_squared(), a.distance_squared(b)), searched(a, b));
            assert!(
                (found - expected).abs() < 0.01 * a.length().max(b.length()),
                "{a} {b}: {found} {expected}"
            );
        }
    }

    #[test]
    fn triangles_without_area_reach_no_further_than_their_sides() {
        assert_eq!(reach(1.0, 1.0, 4.0), 0.5);
        assert_eq!(reach(1.0, 4.0, 1.0), 0.5);
        assert_eq!(reach(1.0, 1.0, 0.0), 0.5);
        assert_eq!(reach(0.0, 0.0, 0.0), 0.0);
        // A sliver whose area is lost in rounding.
        let (a, b) = (1.272_204_f64.powi(2), 9.6e-9_f64.powi(2) + 6.8e-9_f64.powi(2));
        for found in [reach(a, b, a + b), reach(b, a, a + b), reach(a, a + b, b), reach(a, a, b)] {
            assert!(found <= 0.75 * 1.272_204, "{found}");
        }
        // Corners as far apart as the sine of π is from 0, as at the poles of spheres.
        for found in [reach(1e-32, 1.0, 1.0), reach(1.0, 1e-32, 1.0), reach(1.0, 1.0, 1e-32)] {
            assert!((0.0..0.6).contains(&found), "{found}");
        }
    }
}
