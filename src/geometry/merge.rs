//! Merging of clouds.

use super::join::{
    circles, common_origin, common_view, join, join_clips, join_colours, join_corners, join_materials,
    join_textures,
};
use super::{Cloud, Curvature, FaceTextures, Model, Primitives, Surfels, View, Viewpoints, Weights};
use crate::error::{Error, Result};
use glam::{DVec3, Vec3};

impl Surfels {
    /// Concatenates all surfels of `parts`.
    ///
    /// If the origins agree, origin and positions are kept; otherwise the origin is the middle of the common bounds, and positions are
    /// translated in float64. Attributes that only some parts have: surfels without colours get `albedo` (linear), and colours stay
    /// sRGB-encoded unless a part has linear ones; discs without shapes are circles; those without curvatures have unknown ones; surfels without sides are one-sided; discs without
    /// clips are whole; parts with different textures get their colours at the points; points without materials have none. Normalization
    /// weights are dropped unless all parts have them, because no value would fit the others.
    ///
    /// # Errors
    /// [`Error::Usage`] for more than 2³² − 1 surfels, or more than [`Materials::MOST`](super::Materials::MOST) materials.
    pub fn merge(parts: Vec<Self>, albedo: [f32; 3]) -> Result<Self> {
        Ok(Self::whole(Cloud::merge(parts.into_iter().map(Cloud::from).collect(), albedo)?))
    }

    /// The surfels of a complete cloud.
    fn whole(cloud: Cloud) -> Self {
        Self {
            origin: cloud.origin,
            positions: cloud.positions,
            normals: cloud.normals.unwrap_or_default(),
            radii: cloud.radii.unwrap_or_default(),
            ellipses: cloud.ellipses,
            curvatures: cloud.curvatures,
            two_sided: cloud.two_sided,
            clips: cloud.clips,
            weights: cloud.weights,
            colours: cloud.colours,
            texture: cloud.texture,
            materials: cloud.materials,
            point_indices: cloud.point_indices,
        }
    }
}

impl Model {
    /// Concatenates all parts with one origin: [`Surfels::merge`] of the surfels, and likewise of lines and triangles.
    ///
    /// # Errors
    /// [`Error::Usage`] for more than 2³² − 1 surfels or vertices.
    pub fn merge(mut parts: Vec<Self>, albedo: [f32; 3]) -> Result<Self> {
        if parts.len() == 1 {
            return Ok(parts.remove(0));
        }
        let split = |model: Self| [Cloud::from(model.surfels), Cloud::from(model.primitives)];
        let mut clouds: Vec<_> = parts.into_iter().map(split).collect();
        let origin = common_origin(clouds.iter().flatten().filter(|cloud| !cloud.is_empty()));
        clouds.iter_mut().flatten().for_each(|cloud| cloud.move_origin(origin));
        let (surfels, primitives): (Vec<_>, Vec<_>) =
            clouds.into_iter().map(|[surfels, primitives]| (surfels, primitives)).unzip();
        let join = |parts: Vec<Cloud>| {
            let some = parts.into_iter().filter(|part| !part.is_empty()).collect();
            Ok::<_, Error>(Cloud { origin, ..Cloud::merge(some, albedo)? })
        };
        Ok(Self { surfels: Surfels::whole(join(surfels)?), primitives: Primitives::whole(join(primitives)?) })
    }
}

impl From<Primitives> for Cloud {
    /// The vertices as points: directions become normals, and also tangents for tubes.
    fn from(primitives: Primitives) -> Self {
        let mut tangents = (!primitives.tubes.is_empty()).then(|| vec![Vec3::ZERO; primitives.len()]);
        let tangents_of = |tangents: &mut Vec<Vec3>| {
            let vertices = primitives.tubes.iter().flatten().map(|&i| i as usize);
            vertices.for_each(|i| tangents[i] = primitives.directions[i]);
        };
        tangents.iter_mut().for_each(tangents_of);
        Self {
            tangents,
            origin: primitives.origin,
            positions: primitives.positions,
            normals: Some(primitives.directions),
            radii: Some(primitives.radii),
            colours: primitives.colours,
            texture: primitives.texture,
            materials: primitives.materials,
            ribbons: primitives.ribbons,
            tubes: primitives.tubes,
            triangles: primitives.triangles,
            ..Default::default()
        }
    }
}

impl Primitives {
    /// The primitives that such a cloud was made from.
    pub(super) fn whole(cloud: Cloud) -> Self {
        Self {
            origin: cloud.origin,
            positions: cloud.positions,
            directions: cloud.normals.unwrap_or_default(),
            radii: cloud.radii.unwrap_or_default(),
            colours: cloud.colours,
            texture: cloud.texture,
            materials: cloud.materials,
            ribbons: cloud.ribbons,
            tubes: cloud.tubes,
            triangles: cloud.triangles,
        }
    }
}

impl Cloud {
    /// Concatenates all points of `parts`, as [`Surfels::merge`]. Points without normals, radii, tangents, scalars or indices have none in the
    /// result; the view is unknown unless it is the same for all parts, which otherwise have
    /// [`viewpoints`](Self::viewpoints).
    ///
    /// # Errors
    /// [`Error::Usage`] for more than 2³² − 1 points.
    pub fn merge(mut parts: Vec<Self>, albedo: [f32; 3]) -> Result<Self> {
        let count: usize = parts.iter().map(Self::len).sum();
        if u32::try_from(count).is_err() {
            return Err(Error::Usage(format!("{count} points in one scene: give at most 2³² − 1")));
        }
        if parts.len() == 1 {
            return Ok(parts.remove(0));
        }
        let origin = common_origin(parts.iter());
        parts.iter_mut().for_each(|part| part.move_origin(origin));
        let parts = &mut parts[..];
        let texture = join_textures(parts);
        let materials = join_materials(parts)?;
        Ok(Self {
            origin,
            viewpoints: Viewpoints::join(parts),
            view: common_view(parts),
            face_textures: FaceTextures::join(
                parts.iter_mut().map(|part| (part.face_textures.take(), part.triangles.len())),
            ),
            triangles: join_corners(parts, |part| &mut part.triangles),
            ribbons: join_corners(parts, |part| &mut part.ribbons),
            tubes: join_corners(parts, |part| &mut part.tubes),
            tangents: join(parts, |part| part.tangents.take(), |part| vec![Vec3::ZERO; part.len()]),
            texture,
            materials,
            colours: join_colours(parts, albedo),
            // Before the normals, which circles are made of.
            ellipses: join(parts, |part| part.ellipses.take(), circles),
            curvatures: join(
                parts,
                |part| part.curvatures.take(),
                |part| vec![Curvature::default(); part.len()],
            ),
            clips: join_clips(parts),
            weights: Weights::join(parts.iter_mut().map(|part| part.weights.take())),
            two_sided: join(parts, |part| part.two_sided.take(), |part| vec![false; part.len()]),
            scalar: join(parts, |part| part.scalar.take(), |part| vec![f64::NAN; part.len()]),
            point_indices: join(
                parts,
                |part| part.point_indices.take(),
                |part| vec![Surfels::NO_POINT; part.len()],
            ),
            radii: join(parts, |part| part.radii.take(), |part| vec![0.0; part.len()]),
            normals: join(parts, |part| part.normals.take(), |part| vec![Vec3::ZERO; part.len()]),
            positions: parts.iter_mut().flat_map(|part| std::mem::take(&mut part.positions)).collect(),
        })
    }

    /// Changes the origin of the positions.
    fn move_origin(&mut self, origin: DVec3) {
        let offset = self.origin - origin;
        if offset != DVec3::ZERO {
            let moved = |p: Vec3| (p.as_dvec3() + offset).as_vec3();
            self.positions.iter_mut().for_each(|p| *p = moved(*p));
            let views = self.viewpoints.iter_mut().flat_map(|all| &mut all.views);
            for view in views.chain([&mut self.view]) {
                if let View::From(eye) = view {
                    *eye = moved(*eye);
                }
            }
        }
        self.origin = origin;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Clip, ClipLine};
    use crate::geometry::{Clips, Colours, Ellipse};

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
    fn a_single_part_stays_where_it_is() {
        let part = part(5.0, 1.0, Some(Colours::Linear(vec![[0.1, 0.2, 0.3]])));
        let (copy, place) = (part.clone(), part.positions.as_ptr());
        let merged = Surfels::merge(vec![part], [0.5; 3]).unwrap();
        assert_eq!((merged.positions.as_ptr(), merged), (place, copy));
    }

    #[test]
    fn clouds_keep_what_each_of_them_has() {
        let (from, to) = (DVec3::splat(1e7), DVec3::splat(1e7 + 2.0));
        let bare = |origin| Cloud {
            origin,
            positions: vec![Vec3::ZERO; 3],
            triangles: vec![[0, 1, 2]],
            ribbons: vec![[0, 1]],
            tubes: vec![[1, 2]],
            view: View::From((to - origin).as_vec3()),
            ..Default::default()
        };
        let full = Cloud {
            normals: Some(vec![Vec3::Z; 3]),
            scalar: Some(vec![7.0; 3]),
            point_indices: Some(vec![4, 5, 6]),
            tangents: Some(vec![Vec3::X; 3]),
            ..bare(to)
        };
        let merged = Cloud::merge(vec![bare(from), full.clone()], [0.5; 3]).unwrap();
        assert_eq!((merged.len(), merged.radii.clone(), merged.colours.clone()), (6, None, None));
        assert_eq!(merged.triangles, [[0, 1, 2], [3, 4, 5]]);
        assert_eq!((merged.ribbons, merged.tubes), (vec![[0, 1], [3, 4]], vec![[1, 2], [4, 5]]));
        assert_eq!(merged.tangents.unwrap()[3..], [Vec3::X; 3]);
        let normals = merged.normals.unwrap();
        assert_eq!((normals[0], normals[5]), (Vec3::ZERO, Vec3::Z));
        let none = Surfels::NO_POINT;
        assert_eq!(merged.point_indices, Some(vec![none, none, none, 4, 5, 6]));
        let scalar = merged.scalar.unwrap();
        assert!(scalar[0].is_nan() && scalar[5] == 7.0, "{scalar:?}");
        assert_eq!(merged.view, View::From((to - merged.origin).as_vec3()), "both were seen from there");
        let elsewhere = Cloud { view: View::Towards(Vec3::Z), ..full };
        assert_eq!(Cloud::merge(vec![bare(from), elsewhere], [0.5; 3]).unwrap().view, View::Unknown);
    }

    #[test]
    fn models_meet_about_one_origin_and_keep_their_lines() {
        let lines = |x: f64| Primitives {
            origin: DVec3::new(x, 0.0, 0.0),
            positions: vec![Vec3::ZERO, Vec3::Y],
            directions: vec![Vec3::Z; 2],
            radii: vec![0.5, 0.25],
            ribbons: vec![[0, 1]],
            tubes: vec![[1, 0]],
            triangles: vec![[0, 1, 0]],
            ..Default::default()
        };
        let points = part(1e7, 1.0, None);
        let empty = || Surfels { origin: DVec3::splat(-9e9), ..Default::default() };
        let parts = vec![
            Model { surfels: empty(), primitives: lines(1e7) },
            Model::from(points.clone()),
            Model { surfels: empty(), primitives: lines(1e7 + 2.0) },
        ];
        let Model { surfels, primitives } = Model::merge(parts, [0.5; 3]).unwrap();
        assert_eq!((surfels.origin, surfels.len(), surfels.radii), (primitives.origin, 1, points.radii));
        assert_eq!((primitives.ribbons, primitives.tubes), (vec![[0, 1], [2, 3]], vec![[1, 0], [3, 2]]));
        assert_eq!(
            (primitives.triangles, primitives.radii),
            (vec![[0, 1, 0], [2, 3, 2]], vec![0.5, 0.25, 0.5, 0.25])
        );
        let world = |p: Vec3| p.as_dvec3() + primitives.origin;
        assert!((world(primitives.positions[3]) - DVec3::new(1e7 + 2.0, 1.0, 0.0)).length() < 1e-6);
        let none = Model::merge(vec![], [0.5; 3]).unwrap();
        assert!(none.surfels.is_empty() && none.primitives.is_empty());
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
    fn clips_keep_their_surfels() {
        let clip = |offset| Clip::line(ClipLine { outward: Vec3::X, offset });
        let clipped = |x: f64, offset| Surfels {
            origin: DVec3::new(x, 0.0, 0.0),
            clips: Clips::collect([Some(clip(offset))]),
            ..part(0.0, 1.0, None)
        };
        let parts = vec![clipped(0.0, 0.25), part(0.0, 1.0, None), clipped(1e7, -0.5)];
        let merged = Surfels::merge(parts, [0.5; 3]).unwrap();
        assert_eq!(merged.clips, Clips::collect([Some(clip(0.25)), None, Some(clip(-0.5))]));
        assert_eq!(Surfels::merge(vec![part(0.0, 1.0, None); 2], [0.5; 3]).unwrap().clips, None);
    }

    #[test]
    fn weights_are_kept_where_every_part_has_them() {
        let weighted = |weight| Surfels {
            weights: Some(Weights::collect([(weight, Some([weight; 4]))])),
            ..part(0.0, 1.0, None)
        };
        let merge = |parts| Surfels::merge(parts, [0.5; 3]).unwrap().weights;
        let both = Weights::collect([0.5, 0.25].map(|weight| (weight, Some([weight; 4]))));
        assert_eq!(merge(vec![weighted(0.5), weighted(0.25)]), Some(both));
        assert_eq!(merge(vec![weighted(0.5), part(0.0, 1.0, None)]), None);
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
