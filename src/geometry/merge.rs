//! Several sets of surfels as one.

use super::{Bounds, Colours, Ellipse, Surfels};
use crate::error::{Error, Result};
use crate::io::srgb;
use glam::DVec3;

impl Surfels {
    /// All surfels of `parts`, one part after the other.
    ///
    /// If the parts' origins agree, the origin and every position stay as they are; otherwise the origin is the middle of the common
    /// bounds, and positions are moved in float64. Where only some parts have colours, `albedo` (linear) is the others' colour; colours
    /// stay sRGB-encoded unless a part has linear ones. Where only some have shapes, the others' discs are circles; where only some
    /// name two-sided surfels, the others' are not.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are more than 2³² − 1 surfels.
    pub fn merge(mut parts: Vec<Self>, albedo: [f32; 3]) -> Result<Self> {
        let count: usize = parts.iter().map(Self::len).sum();
        if u32::try_from(count).is_err() {
            return Err(Error::Usage(format!("{count} surfels in one scene: at most 2³² − 1 are drawn")));
        }
        let origin = common_origin(&parts);
        parts.iter_mut().for_each(|part| part.move_origin(origin));
        let colours = merge_colours(&parts, albedo);
        let (ellipses, two_sided) = (merge_ellipses(&parts), merge_two_sided(&parts));
        let mut merged = Self { origin, ellipses, two_sided, colours, ..Default::default() };
        for part in parts {
            merged.positions.extend(part.positions);
            merged.normals.extend(part.normals);
            merged.radii.extend(part.radii);
        }
        Ok(merged)
    }

    /// Makes `origin` what the positions are relative to.
    fn move_origin(&mut self, origin: DVec3) {
        let offset = self.origin - origin;
        if offset != DVec3::ZERO {
            self.positions.iter_mut().for_each(|p| *p = (p.as_dvec3() + offset).as_vec3());
        }
        self.origin = origin;
    }
}

fn common_origin(parts: &[Surfels]) -> DVec3 {
    let first = parts.first().map_or(DVec3::ZERO, |part| part.origin);
    if parts.iter().all(|part| part.origin == first) {
        return first;
    }
    let boxes = parts.iter().filter_map(|part| Some(Bounds::of(&part.positions)?.translated(part.origin)));
    let union = |a: Bounds, b: Bounds| Bounds::of_box(a.min.min(b.min), a.max.max(b.max));
    boxes.reduce(union).map_or(first, |bounds| bounds.centre())
}

fn merge_ellipses(parts: &[Surfels]) -> Option<Vec<Ellipse>> {
    let shapes = |part: &Surfels| match &part.ellipses {
        Some(ellipses) => ellipses.clone(),
        None => part.normals.iter().map(|normal| Ellipse::circle(*normal)).collect(),
    };
    let any = parts.iter().any(|part| part.ellipses.is_some());
    any.then(|| parts.iter().flat_map(shapes).collect())
}

fn merge_two_sided(parts: &[Surfels]) -> Option<Vec<bool>> {
    let flags = |part: &Surfels| part.two_sided.clone().unwrap_or_else(|| vec![false; part.len()]);
    let any = parts.iter().any(|part| part.two_sided.is_some());
    any.then(|| parts.iter().flat_map(flags).collect())
}

fn merge_colours(parts: &[Surfels], albedo: [f32; 3]) -> Option<Colours> {
    let coded = |part: &Surfels| matches!(part.colours, Some(Colours::Srgb8(_)) | None);
    if parts.iter().all(|part| part.colours.is_none()) {
        return None;
    }
    let [r, g, b] = albedo.map(srgb::encode8);
    Some(match parts.iter().all(coded) {
        true => Colours::Srgb8(parts.iter().flat_map(|part| codes(part, [r, g, b, 0])).collect()),
        false => Colours::Linear(parts.iter().flat_map(|part| linear(part, albedo)).collect()),
    })
}

/// sRGB codes of a part that has no linear colours.
fn codes(part: &Surfels, albedo: [u8; 4]) -> Vec<[u8; 4]> {
    match &part.colours {
        Some(Colours::Srgb8(colours)) => colours.clone(),
        _ => vec![albedo; part.len()],
    }
}

fn linear(part: &Surfels, albedo: [f32; 3]) -> Vec<[f32; 3]> {
    let decode = |code: u8| srgb::decode(f64::from(code) / 255.0) as f32;
    match &part.colours {
        None => vec![albedo; part.len()],
        Some(Colours::Linear(colours)) => colours.clone(),
        Some(Colours::Srgb8(colours)) => colours.iter().map(|&[r, g, b, _]| [r, g, b].map(decode)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn part(origin: f64, x: f32, colours: Option<Colours>) -> Surfels {
        Surfels {
            origin: DVec3::splat(origin),
            positions: vec![Vec3::splat(x)],
            normals: vec![Vec3::Z],
            radii: vec![x.abs()],
            colours,
            ..Default::default()
        }
    }

    #[test]
    fn equal_origins_leave_every_bit() {
        let merged = Surfels::merge(vec![part(1e7, 0.1, None), part(1e7, -0.3, None)], [0.5; 3]).unwrap();
        assert_eq!(merged.origin, DVec3::splat(1e7));
        assert_eq!(merged.positions, [Vec3::splat(0.1), Vec3::splat(-0.3)]);
        assert_eq!((merged.radii, merged.normals.len(), merged.colours), (vec![0.1, 0.3], 2, None));
    }

    #[test]
    fn unequal_origins_meet_without_rounding_the_world() {
        // In f32 a millimetre at 10 000 km would be lost.
        let merged =
            Surfels::merge(vec![part(1e7, 0.001, None), part(1e7 + 2.0, 0.0, None)], [0.5; 3]).unwrap();
        for (position, expected) in merged.positions.iter().zip([1e7 + 0.001, 1e7 + 2.0]) {
            assert!((position.as_dvec3() + merged.origin - expected).length() < 1e-6, "{merged:?}");
        }
    }

    #[test]
    fn parts_without_shapes_are_circles_and_parts_without_sides_are_one_sided() {
        let plain = || part(0.0, 1.0, None);
        let ellipse = Ellipse { major: Vec3::X, aspect: 0.25 };
        let special =
            || Surfels { ellipses: Some(vec![ellipse]), two_sided: Some(vec![true]), ..part(0.0, 2.0, None) };
        let merged = Surfels::merge(vec![plain(), special(), plain()], [0.5; 3]).unwrap();
        let ellipses = merged.ellipses.unwrap();
        assert_eq!((ellipses.len(), ellipses[1]), (3, ellipse));
        for circle in [ellipses[0], ellipses[2]] {
            assert_eq!(circle.aspect, 1.0);
            assert!(circle.major.dot(Vec3::Z).abs() < 1e-6 && circle.major.is_normalized(), "{circle:?}");
        }
        assert_eq!(merged.two_sided, Some(vec![false, true, false]));
        let merged = Surfels::merge(vec![plain(), plain()], [0.5; 3]).unwrap();
        assert_eq!((merged.ellipses, merged.two_sided), (None, None));
    }

    #[test]
    fn colours_of_either_kind_and_none_come_together() {
        let red = || Some(Colours::Srgb8(vec![[255, 0, 0, 0]]));
        let float = || Some(Colours::Linear(vec![[0.1, 0.2, 0.3]]));
        let merge = |kinds: [Option<Colours>; 2]| {
            Surfels::merge(kinds.map(|colours| part(0.0, 1.0, colours)).into(), [0.214_041; 3])
                .unwrap()
                .colours
        };
        assert_eq!(merge([red(), None]), Some(Colours::Srgb8(vec![[255, 0, 0, 0], [127, 127, 127, 0]])));
        assert_eq!(merge([float(), red()]), Some(Colours::Linear(vec![[0.1, 0.2, 0.3], [1.0, 0.0, 0.0]])));
        assert_eq!(merge([None, float()]), Some(Colours::Linear(vec![[0.214_041; 3], [0.1, 0.2, 0.3]])));
    }
}
