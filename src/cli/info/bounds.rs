//! Bounds of points, as `--bounds` takes them.

use glam::DVec3;
use surfel::geometry::Cloud;

/// How far rounded bounds may be from the points, in the longest side of the bounds.
const MOST: f64 = 1e-6;

/// Bounds of the points of a built-in scene, rounded outwards; `None` without points.
pub fn of(cloud: &Cloud) -> Option<[DVec3; 2]> {
    let min = cloud.positions.iter().copied().reduce(|a, b| a.min(b))?;
    let max = cloud.positions.iter().copied().reduce(|a, b| a.max(b))?;
    Some(outward([min, max].map(|at| cloud.origin + at.as_dvec3())))
}

/// Bounds that include these, with the fewest decimals that are near enough.
pub fn outward([min, max]: [DVec3; 2]) -> [DVec3; 2] {
    let most = MOST * (max - min).max_element();
    // 0 − 0 is 0, and −0 is not.
    [min.map(|least| 0.0 - above(-least, most)), max.map(|greatest| 0.0 + above(greatest, most))]
}

/// The number with the fewest decimals that is at least `coordinate`, and at most `most` above.
fn above(coordinate: f64, most: f64) -> f64 {
    const DECIMALS: i32 = 17;
    let rounded = |number: f64, decimals: i32| -> Option<f64> {
        format!("{number:.digits$}", digits = decimals as usize).parse().ok()
    };
    let up = |decimals: i32| {
        let nearest = rounded(coordinate, decimals)?;
        if nearest < coordinate { rounded(nearest + 0.1f64.powi(decimals), decimals) } else { Some(nearest) }
    };
    let is_near = |number: &f64| (coordinate..=coordinate + most).contains(number);
    (0..=DECIMALS).filter_map(up).find(is_near).unwrap_or(coordinate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn bounds_are_rounded_outwards() {
        let text = |min: DVec3, max: DVec3| {
            let [low, high] = outward([min, max]);
            assert!(low.cmple(min).all() && high.cmpge(max).all(), "{low} {high}");
            format!("{low} to {high}")
        };
        let (min, max) =
            (DVec3::new(636_001.762_345, 848_935.2, -0.1), DVec3::new(637_001.762_345, 849_497.9, -0.0));
        assert_eq!(text(min, max), "[636001.762, 848935.2, -0.1] to [637001.763, 849497.9, 0]");
        let float = |x: f32, y: f32, z: f32| Vec3::new(x, y, z).as_dvec3();
        assert_eq!(
            text(float(0.1, -0.3, 7.0), float(0.7, 0.2, 9.0)),
            "[0.1, -0.300001, 7] to [0.7, 0.200001, 9]"
        );
        for single in [DVec3::splat(1e-12), DVec3::splat(1e-30), DVec3::splat(-1e300), float(0.1, 1e9, -1e-7)]
        {
            assert_eq!(outward([single; 2]), [single; 2]);
        }
    }

    #[test]
    fn bounds_of_a_scene_are_those_of_its_points() {
        let origin = DVec3::new(5.0, 0.0, 0.0);
        let cloud = Cloud { origin, positions: vec![Vec3::ONE, Vec3::ZERO], ..Default::default() };
        assert_eq!(of(&cloud), Some([origin, DVec3::new(6.0, 1.0, 1.0)]));
        assert_eq!(of(&Cloud::default()), None);
    }
}
