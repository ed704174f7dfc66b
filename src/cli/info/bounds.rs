//! Bounds of points, as `--bounds` takes them.

use glam::DVec3;
use surfel::geometry::Cloud;

/// Least and greatest coordinates of the points, with the digits that tell them from others; `None` without points.
pub fn of(cloud: &Cloud) -> Option<[DVec3; 2]> {
    let min = cloud.positions.iter().copied().reduce(|a, b| a.min(b))?;
    let max = cloud.positions.iter().copied().reduce(|a, b| a.max(b))?;
    let corner = |at: glam::Vec3| {
        let [x, y, z] = [0, 1, 2].map(|axis| shortest(cloud.origin[axis], at[axis]));
        DVec3::new(x, y, z)
    };
    Some([min, max].map(corner))
}

/// The number with the fewest decimals that is stored as this position relative to the origin.
fn shortest(origin: f64, relative: f32) -> f64 {
    const MOST: usize = 17;
    let exact = origin + f64::from(relative);
    let text = |digits: usize| if origin == 0.0 { relative.to_string() } else { format!("{exact:.digits$}") };
    let mut numbers = (0..=MOST).filter_map(|digits| text(digits).parse().ok());
    numbers.find(|number: &f64| (number - origin) as f32 == relative).unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn coordinates_have_the_digits_of_the_file() {
        let origin = DVec3::new(636_000.0, 848_000.0, 0.0);
        let at = |x: f64, y: f64, z: f64| (DVec3::new(x, y, z) - origin).as_vec3();
        let [a, b] = [at(636_001.76, 848_935.2, -0.1), at(637_179.22, 849_497.9, 1e-12)];
        let cloud = Cloud { origin, positions: vec![b, a, b], ..Default::default() };
        let [min, max] = of(&cloud).unwrap();
        assert_eq!(
            format!("{min} {max}"),
            "[636001.76, 848935.2, -0.1] [637179.22, 849497.9, 0.000000000001]"
        );
        assert_eq!(of(&Cloud::default()), None);
        let one = Cloud { positions: vec![Vec3::new(0.1, -7.0, 1e9)], ..Default::default() };
        assert_eq!(of(&one), Some([DVec3::new(0.1, -7.0, 1e9); 2]));
    }
}
