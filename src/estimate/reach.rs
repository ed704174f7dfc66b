//! How far the discs at a triangle's corners must reach so that together they cover it.

/// The part of a triangle that is nearest to its corner `p` ends this far from `p`: if every corner's disc reaches that far, they cover the
/// triangle without a gap. Given are the squares of the sides' lengths, `pa` from `p` to `a`, and so on.
///
/// Of an acute triangle it is the circumscribed circle's radius. Of an obtuse one, whose circle's centre is outside, it is where the
/// bisectors of the short sides meet the long one. 0 of a triangle without extent.
pub(super) fn reach(pa: f64, pb: f64, ab: f64) -> f64 {
    // By the law of cosines, twice the product of two sides with the cosine between them.
    let (at_p, at_a, at_b) = (pa + pb - ab, pa + ab - pb, pb + ab - pa);
    if at_p <= 0.0 {
        // The point of side ab that is as far from p as from a is |pa| / (2 cos A) away from both.
        let from_a = pa * ab.sqrt() / at_a;
        let from_b = pb * ab.sqrt() / at_b;
        from_a.max(from_b)
    } else if at_a <= 0.0 {
        pa * pb.sqrt() / at_p
    } else if at_b <= 0.0 {
        pb * pa.sqrt() / at_p
    } else {
        // 16 times the square of the area, by Heron; where two corners are close together it is rounding alone, but of an acute triangle
        // the circle's radius is between these two parts of the longest side.
        let area = (4.0 * pa * pb - at_p * at_p).max(0.0);
        let longest = pa.max(pb).max(ab).sqrt();
        (pa * pb * ab / area).sqrt().min(longest / 3f64.sqrt()).max(0.5 * longest)
    }
    .max(0.0)
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
    }
}
