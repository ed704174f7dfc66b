//! Bounds of points, as `--bounds` takes them.

use glam::DVec3;
use surfel::formats::declared::{Element, Kind, Property, Scalar};
use surfel::geometry::Cloud;

/// Least and greatest coordinates of the points, which `elements` declare, with the digits that tell them from others; `None` without points.
pub fn of(cloud: &Cloud, elements: &[Element]) -> Option<[DVec3; 2]> {
    let is_single = is_single(elements);
    let min = cloud.positions.iter().copied().reduce(|a, b| a.min(b))?;
    let max = cloud.positions.iter().copied().reduce(|a, b| a.max(b))?;
    let corner = |at: glam::Vec3| {
        let [x, y, z] = [0, 1, 2].map(|axis| shortest(cloud.origin[axis], at[axis], is_single));
        DVec3::new(x, y, z)
    };
    Some([min, max].map(corner))
}

/// Whether all coordinates are declared in single precision.
fn is_single(elements: &[Element]) -> bool {
    let has = |element: &Element, axis: &str| {
        let is = |property: &Property| property.name == axis && property.kind == Kind::Scalar(Scalar::F32);
        element.properties.iter().any(is)
    };
    elements.iter().any(|element| ["x", "y", "z"].iter().all(|axis| has(element, axis)))
}

/// The number with the fewest decimals that is stored as this position relative to the origin, or in single precision.
fn shortest(origin: f64, relative: f32, is_single: bool) -> f64 {
    const MOST: usize = 17;
    let exact = origin + f64::from(relative);
    let single = exact as f32;
    if origin == 0.0 || (is_single && f64::from(single) == exact) {
        return single.to_string().parse().unwrap_or(exact);
    }
    let mut numbers = (0..=MOST).filter_map(|digits| format!("{exact:.digits$}").parse().ok());
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
        let [min, max] = of(&cloud, &[]).unwrap();
        assert_eq!(
            format!("{min} {max}"),
            "[636001.76, 848935.2, -0.1] [637179.22, 849497.9, 0.000000000001]"
        );
        assert_eq!(of(&Cloud::default(), &[]), None);
        let far = Cloud {
            origin: DVec3::splat(-2.0),
            positions: vec![Vec3::splat(-2.063 + 2.0)],
            ..Default::default()
        };
        let property = |name: &str| Property { name: name.into(), kind: Kind::Scalar(Scalar::F32) };
        let properties = ["x", "y", "z"].map(property).into();
        let single = [Element { name: "vertex".into(), count: 1, properties }];
        assert_eq!(of(&far, &single), Some([DVec3::splat(-2.063); 2]));
        assert_ne!(of(&far, &[]), of(&far, &single), "a number of double precision has more digits");
        let one = Cloud { positions: vec![Vec3::new(0.1, -7.0, 1e9)], ..Default::default() };
        assert_eq!(of(&one, &[]), Some([DVec3::new(0.1, -7.0, 1e9); 2]));
    }
}
