//! Point clouds as files store them: positions, and optional attributes.

use super::morton::order;
use super::{
    Clips, Colours, Curvature, Ellipse, FaceTextures, Materials, Surfels, Texture, Viewpoints, Weights,
};
use glam::{DVec3, Vec3};

/// Points as a structure of arrays; every array that is present has one entry per point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// Origin of the positions: see [`Surfels::origin`](super::Surfels::origin).
    pub origin: DVec3,
    /// Positions relative to `origin`, all finite.
    pub positions: Vec<Vec3>,
    /// Unit normals; 0 for points without one.
    pub normals: Option<Vec<Vec3>>,
    /// Radii of the discs, in the positions' unit; 0 for points without one. Of elliptical discs, the longer semi-axis.
    pub radii: Option<Vec<f32>>,
    /// Shapes of elliptical discs; need radii and normals.
    pub ellipses: Option<Vec<Ellipse>>,
    /// Curvatures: see [`Surfels::curvatures`](super::Surfels::curvatures); need normals.
    pub curvatures: Option<Vec<Curvature>>,
    /// Points whose normals have no known side. With a radius and without a normal they are billboards
    /// ([`Surfels::is_billboard`](super::Surfels::is_billboard)).
    pub two_sided: Option<Vec<bool>>,
    /// Clips of discs at sharp edges; need normals.
    pub clips: Option<Clips>,
    /// Normalization weights; 0 for points without one. Need normals and radii.
    pub weights: Option<Weights>,
    /// Colours.
    pub colours: Option<Colours>,
    /// Texture, in place of [`Cloud::colours`].
    pub texture: Option<Texture>,
    /// Materials of the points.
    pub materials: Option<Materials>,
    /// A scalar per point, selected on reading; not finite for points without one.
    pub scalar: Option<Vec<f64>>,
    /// Indices of the points in the inputs: see [`Surfels::point_indices`](super::Surfels::point_indices).
    pub point_indices: Option<Vec<u32>>,
    /// Triangles as point indices, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Textures of the triangles, finer than [`Cloud::colours`] are between the points. Need colours, which triangles without a texture have.
    pub face_textures: Option<FaceTextures>,
    /// Segments of ribbons as point indices: see [`Primitives`](super::Primitives). Their ends differ in index and position.
    pub ribbons: Vec<[u32; 2]>,
    /// Segments of tubes as point indices, likewise.
    pub tubes: Vec<[u32; 2]>,
    /// Unit tangents of tubes; 0 for points without one.
    pub tangents: Option<Vec<Vec3>>,
    /// Viewpoint of the scanner.
    pub view: View,
    /// Viewpoints of several scans, in place of `view`.
    pub viewpoints: Option<Viewpoints>,
}

/// Largest share of unused points in a mesh.
const MOST_UNUSED: f64 = 0.1;

/// Viewpoint from which a cloud was captured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum View {
    /// Unknown.
    #[default]
    Unknown,
    /// A point, relative to the cloud's origin.
    From(Vec3),
    /// Far away in this direction, a unit vector.
    Towards(Vec3),
}

impl Cloud {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// The points [`spread`](Self::spread), without triangles and lines, and without radii, ellipses, curvatures, clips and weights, because
    /// these belong to the denser points.
    pub fn some(&self, count: usize) -> Self {
        let kept = self.spread(count);
        self.points(&kept).without_sizes()
    }

    /// The cloud itself if it has at most `count` points, otherwise [`some`](Self::some) of it.
    pub fn at_most(self, count: u64) -> Self {
        if self.len() as u64 <= count { self } else { self.some(count as usize) }
    }

    /// Some of many points, without the radii, ellipses, curvatures, clips, weights and tangents of all, because these belong to the denser
    /// points: larger discs reach other edges.
    pub(crate) fn without_sizes(self) -> Self {
        Self {
            radii: None,
            ellipses: None,
            curvatures: None,
            clips: None,
            weights: None,
            tangents: None,
            ..self
        }
    }

    /// Indices of `count` points, evenly spread along the Z-curve of the bounds and in its order; all points if there are no more.
    pub fn spread(&self, count: usize) -> Vec<u32> {
        let order = order(&self.positions);
        let (count, all) = (count.min(order.len()) as u64, order.len() as u64);
        (0..count).map(|i| order[(i * all / count) as usize]).collect()
    }

    /// Whether there are points alone: neither normals nor faces nor lines.
    pub(crate) fn is_bare(&self) -> bool {
        self.normals.is_none() && self.triangles.is_empty() && !self.has_lines()
    }

    /// Whether there are ribbons or tubes.
    pub fn has_lines(&self) -> bool {
        !(self.ribbons.is_empty() && self.tubes.is_empty())
    }

    /// Splits off the points of lines, and with `faces` those of triangles, with these elements; the second cloud has the other points.
    /// Order is kept.
    pub(crate) fn split(self, faces: bool) -> [Self; 2] {
        let used = self.used(faces);
        let which = |is: bool| (0..self.len() as u32).filter(|&i| used[i as usize] == is).collect::<Vec<_>>();
        [which(true), which(false)].map(|kept| self.part(&kept))
    }

    /// Which points are on lines, or with `faces` in triangles.
    fn used(&self, faces: bool) -> Vec<bool> {
        let mut used = vec![false; self.len()];
        let triangles = if faces { &self.triangles[..] } else { &[] };
        let lines = self.ribbons.iter().chain(&self.tubes).flatten();
        lines.chain(triangles.iter().flatten()).for_each(|&i| used[i as usize] = true);
        used
    }

    /// The cloud without the points that a mesh leaves unused, and their number: points in no triangle and on no line, without a radius, if
    /// they are at most [`MOST_UNUSED`] of all. More of them are a cloud beside a mesh.
    pub(crate) fn without_unused(self) -> (Self, u64) {
        if self.triangles.is_empty() {
            return (self, 0);
        }
        let used = self.used(true);
        let has_radius = |i: usize| self.radii.as_ref().is_some_and(|radii| radii[i] > 0.0);
        let kept: Vec<u32> =
            (0..self.len() as u32).filter(|&i| used[i as usize] || has_radius(i as usize)).collect();
        let unused = self.len() - kept.len();
        if unused == 0 || unused as f64 > MOST_UNUSED * self.len() as f64 {
            return (self, 0);
        }
        (self.part(&kept), unused as u64)
    }

    /// The points `kept`, in that order, and the triangles and lines among them.
    pub(super) fn part(&self, kept: &[u32]) -> Self {
        let mut place = vec![None; self.len()];
        kept.iter().zip(0..).for_each(|(&from, to)| place[from as usize] = Some(to));
        let is_kept = |i: usize| self.triangles[i].iter().all(|&i| place[i as usize].is_some());
        let face_textures = self.face_textures.clone().map(|mut textures| {
            textures.keep(is_kept);
            textures
        });
        Self {
            triangles: moved(&self.triangles, &place),
            face_textures,
            ribbons: moved(&self.ribbons, &place),
            tubes: moved(&self.tubes, &place),
            ..self.points(kept)
        }
    }

    /// The points `kept`, in that order, without elements.
    fn points(&self, kept: &[u32]) -> Self {
        fn of<T: Copy>(values: &Option<Vec<T>>, kept: &[u32]) -> Option<Vec<T>> {
            values.as_ref().map(|values| kept.iter().map(|&i| values[i as usize]).collect())
        }
        Self {
            origin: self.origin,
            positions: kept.iter().map(|&i| self.positions[i as usize]).collect(),
            normals: of(&self.normals, kept),
            radii: of(&self.radii, kept),
            ellipses: of(&self.ellipses, kept),
            curvatures: of(&self.curvatures, kept),
            two_sided: of(&self.two_sided, kept),
            clips: self.clips.clone().map(|mut clips| {
                clips.permute(kept);
                clips
            }),
            weights: self.weights.clone().map(|mut weights| {
                weights.permute(kept);
                weights
            }),
            colours: self.colours.as_ref().map(|colours| colours.gather(kept)),
            texture: self.texture.as_ref().map(|texture| texture.gather(kept)),
            materials: self.materials.as_ref().map(|materials| materials.gather(kept)),
            scalar: of(&self.scalar, kept),
            point_indices: of(&self.point_indices, kept),
            tangents: of(&self.tangents, kept),
            view: self.view,
            viewpoints: self.viewpoints.as_ref().map(|all| all.gather(kept.iter().map(|&i| i as usize))),
            ..Default::default()
        }
    }

    /// Replaces the texture by its colours at the points.
    pub fn bake_texture(&mut self) {
        if let Some(texture) = self.texture.take() {
            self.colours = Some(texture.baked(&self.positions, self.radii.as_deref()));
        }
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}

/// Elements whose corners all have new indices.
fn moved<const N: usize>(all: &[[u32; N]], place: &[Option<u32>]) -> Vec<[u32; N]> {
    let whole = |corners: &&[u32; N]| corners.iter().all(|&i| place[i as usize].is_some());
    all.iter().filter(whole).map(|corners| corners.map(|i| place[i as usize].unwrap_or_default())).collect()
}

impl From<Surfels> for Cloud {
    /// A complete cloud.
    fn from(surfels: Surfels) -> Self {
        Self {
            origin: surfels.origin,
            positions: surfels.positions,
            normals: Some(surfels.normals),
            radii: Some(surfels.radii),
            ellipses: surfels.ellipses,
            curvatures: surfels.curvatures,
            two_sided: surfels.two_sided,
            clips: surfels.clips,
            weights: surfels.weights,
            colours: surfels.colours,
            texture: surfels.texture,
            materials: surfels.materials,
            point_indices: surfels.point_indices,
            ..Default::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::FaceTexture;
    use glam::Vec2;

    #[test]
    fn few_points_beside_a_mesh_are_unused_and_many_are_a_cloud() {
        let mesh = |beside: usize| Cloud {
            positions: vec![Vec3::ZERO; 30 + beside],
            triangles: (0..10).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            ..Default::default()
        };
        let left = |cloud: Cloud| {
            let (cloud, unused) = cloud.without_unused();
            (cloud.len(), unused)
        };
        assert_eq!((left(mesh(2)), left(mesh(10))), ((30, 2), (40, 0)));
        assert_eq!(left(Cloud { triangles: vec![], ..mesh(2) }), (32, 0));
        let mut radii = vec![0.0; 32];
        radii[31] = 1.0;
        assert_eq!(left(Cloud { radii: Some(radii), ..mesh(2) }), (31, 1));
        assert_eq!(left(Cloud { ribbons: vec![[30, 1]], ..mesh(2) }), (31, 1));
    }

    #[test]
    fn lines_and_points_are_split() {
        let cloud = Cloud {
            positions: (0..6u8).map(|i| Vec3::splat(i.into())).collect(),
            radii: Some((0..6u8).map(f32::from).collect()),
            ribbons: vec![[5, 1]],
            tubes: vec![[1, 3]],
            triangles: vec![[0, 1, 5], [1, 3, 5]],
            face_textures: Some(FaceTextures {
                faces: [[Vec2::ZERO; 3], [Vec2::ONE; 3]]
                    .map(|corners| FaceTexture { corners, ..FaceTexture::NONE })
                    .to_vec(),
                ..Default::default()
            }),
            ..Default::default()
        };
        let of = |cloud: &Cloud| {
            let textures = cloud.face_textures.as_ref();
            textures.map(|textures| textures.faces.iter().map(|face| face.corners[0].x).collect::<Vec<_>>())
        };
        let [lines, points] = cloud.clone().split(false);
        assert_eq!((of(&lines), of(&cloud)), (Some(vec![1.0]), Some(vec![0.0, 1.0])));
        assert!(!points.has_lines() && points.triangles.is_empty());
        assert_eq!((lines.radii, points.radii), (Some(vec![1.0, 3.0, 5.0]), Some(vec![0.0, 2.0, 4.0])));
        assert_eq!(
            (lines.ribbons, lines.tubes, lines.triangles),
            (vec![[2, 0]], vec![[0, 1]], vec![[0, 1, 2]])
        );
        let [drawn, points] = cloud.split(true);
        assert_eq!((drawn.triangles, points.radii), (vec![[0, 1, 3], [1, 2, 3]], Some(vec![2.0, 4.0])));
    }

    #[test]
    fn some_of_the_points_are_spread_evenly_and_stay_whole() {
        let xs: Vec<f32> = (0..1000u32).map(|i| (i * 7919 % 1000) as f32).collect();
        let cloud = Cloud {
            positions: xs.iter().map(|&x| Vec3::new(x, 0.0, 0.0)).collect(),
            colours: Some(Colours::Linear(xs.iter().map(|&x| [x; 3]).collect())),
            radii: Some(vec![1.0; 1000]),
            triangles: vec![[0, 1, 2]],
            tubes: vec![[3, 4]],
            ..Default::default()
        };
        let some = cloud.some(100);
        assert_eq!(
            some.positions.iter().map(|p| p.x).collect::<Vec<_>>(),
            (0..100).map(|i| 10.0 * i as f32).collect::<Vec<_>>()
        );
        let Some(Colours::Linear(colours)) = &some.colours else { panic!("no colours") };
        assert!(colours.iter().zip(&some.positions).all(|(colour, p)| colour[0] == p.x));
        assert_eq!((some.radii.is_none(), some.triangles.len(), some.has_lines()), (true, 0, false));
        assert_eq!((cloud.some(5000).len(), cloud.some(1000).triangles.len()), (1000, 0));
        assert!(cloud.some(0).is_empty());
    }
}
