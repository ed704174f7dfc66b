//! Joins of the attributes of several clouds.

use super::{Bounds, Clips, Cloud, Colours, Ellipse, Materials, Texture, View};
use crate::error::Result;
use crate::geometry::srgb;
use glam::{DVec3, Vec3};

pub(super) fn common_origin<'a>(mut parts: impl Iterator<Item = &'a Cloud> + Clone) -> DVec3 {
    let all = parts.clone();
    let first = all.clone().next().map_or(DVec3::ZERO, |part| part.origin);
    if parts.all(|part| part.origin == first) {
        return first;
    }
    let boxes = all.filter_map(|part| Some(Bounds::of(&part.positions)?.translated(part.origin)));
    let union = |a: Bounds, b: Bounds| Bounds::of_box(a.min.min(b.min), a.max.max(b.max));
    boxes.reduce(union).map_or(first, |bounds| bounds.centre())
}

pub(super) fn common_view(parts: &[Cloud]) -> View {
    let first = parts.first().map(|part| part.view).unwrap_or_default();
    if parts.iter().all(|part| part.view == first) { first } else { View::Unknown }
}

/// Concatenates arrays of the parts, with `missing` for a part that has none; `None` if no part has any.
pub(super) fn join<T>(
    parts: &mut [Cloud],
    take: impl Fn(&mut Cloud) -> Option<Vec<T>>,
    missing: impl Fn(&Cloud) -> Vec<T>,
) -> Option<Vec<T>> {
    let arrays: Vec<_> = parts.iter_mut().map(take).collect();
    let fill = |(array, part): (Option<Vec<T>>, &Cloud)| array.unwrap_or_else(|| missing(part));
    let any = arrays.iter().any(Option::is_some);
    any.then(|| arrays.into_iter().zip(&*parts).flat_map(fill).collect())
}

pub(super) fn circles(part: &Cloud) -> Vec<Ellipse> {
    // Without a normal there is no disc yet.
    let circle = |normal: &Vec3| match *normal {
        Vec3::ZERO => Ellipse::circle(Vec3::Z),
        normal => Ellipse::circle(normal),
    };
    match &part.normals {
        Some(normals) => normals.iter().map(circle).collect(),
        None => vec![circle(&Vec3::ZERO); part.len()],
    }
}

/// Offsets are relative to the surfels' centres, so the origin does not matter.
pub(super) fn join_clips(parts: &mut [Cloud]) -> Option<Clips> {
    Clips::join(parts.iter_mut().map(|part| (part.clips.take(), part.len())))
}

pub(super) fn join_corners<const N: usize>(
    parts: &mut [Cloud],
    of: impl Fn(&mut Cloud) -> &mut Vec<[u32; N]>,
) -> Vec<[u32; N]> {
    let mut all = Vec::new();
    let mut first = 0;
    for part in parts {
        all.extend(std::mem::take(of(part)).iter().map(|corners| corners.map(|i| first + i)));
        // Fits, as the number of all points does.
        first += part.len() as u32;
    }
    all
}

/// One texture for all, or colours instead.
pub(super) fn join_textures(parts: &mut [Cloud]) -> Option<Texture> {
    let texture = Texture::join(parts.iter().map(|part| part.texture.as_ref()));
    parts.iter_mut().for_each(|part| match texture {
        Some(_) => part.texture = None,
        None => part.bake_texture(),
    });
    texture
}

pub(super) fn join_materials(parts: &[Cloud]) -> Result<Option<Materials>> {
    let each: Vec<_> = parts.iter().map(|part| (part.materials.as_ref(), part.len())).collect();
    Materials::join(&each)
}

pub(super) fn join_colours(parts: &mut [Cloud], albedo: [f32; 3]) -> Option<Colours> {
    if parts.iter().all(|part| part.colours.is_none()) {
        return None;
    }
    let [r, g, b] = albedo.map(srgb::encode8);
    let coded = |part: &Cloud| matches!(part.colours, Some(Colours::Srgb8(_)) | None);
    Some(if parts.iter().all(coded) {
        Colours::Srgb8(parts.iter_mut().flat_map(|part| codes(part, [r, g, b, 0])).collect())
    } else {
        Colours::Linear(parts.iter_mut().flat_map(|part| linear(part, albedo)).collect())
    })
}

/// sRGB codes of a part without linear colours.
fn codes(part: &mut Cloud, albedo: [u8; 4]) -> Vec<[u8; 4]> {
    match part.colours.take() {
        Some(Colours::Srgb8(colours)) => colours,
        _ => vec![albedo; part.len()],
    }
}

fn linear(part: &mut Cloud, albedo: [f32; 3]) -> Vec<[f32; 3]> {
    let decode = |code: u8| srgb::decode(f64::from(code) / 255.0) as f32;
    match part.colours.take() {
        None => vec![albedo; part.len()],
        Some(Colours::Linear(colours)) => colours,
        Some(Colours::Srgb8(colours)) => colours.iter().map(|&[r, g, b, _]| [r, g, b].map(decode)).collect(),
    }
}
