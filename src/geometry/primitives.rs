//! Lines and triangles, which pull–push draws beside surfels.

use super::{Bounds, Cloud, Colours, LevelTable, Levels, Materials, MipMap, SurfelFormat, Surfels, Texture};
use crate::error::{Error, Result};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// Ribbons, tubes and triangles with shared vertices (marroquim2008 sections 4 and 5). Every vertex array has one entry per vertex.
///
/// A ribbon is a flat two-sided strip around its centre line; a tube is round. Attributes are interpolated between vertices. Invalid
/// elements ([`Primitives::is_valid`]) are not drawn, and are counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitives {
    /// Origin of the positions, as [`Surfels::origin`](super::Surfels::origin).
    pub origin: DVec3,
    /// Vertex positions, relative to `origin`.
    pub positions: Vec<Vec3>,
    /// Unit vectors: normals of ribbons and triangles, tangents of tubes.
    pub directions: Vec<Vec3>,
    /// Half width of ribbons, radius of tubes, extension of a triangle's surface beyond its edges, in the positions' unit; 0 or more.
    pub radii: Vec<f32>,
    /// Colours, if the input has them.
    pub colours: Option<Colours>,
    /// Texture, in place of [`Primitives::colours`].
    pub texture: Option<Texture>,
    /// Materials: a segment or triangle has that of its first vertex.
    pub materials: Option<Materials>,
    /// Segments of ribbons.
    pub ribbons: Vec<[u32; 2]>,
    /// Segments of tubes.
    pub tubes: Vec<[u32; 2]>,
    /// Triangles, two-sided.
    pub triangles: Vec<[u32; 3]>,
}

/// A model: surfels, lines and triangles with one origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Points.
    pub surfels: Surfels,
    /// Lines and triangles.
    pub primitives: Primitives,
}

/// Borrowed parts of a model.
#[derive(Clone, Copy, Debug)]
pub struct Parts<'a> {
    /// Points.
    pub surfels: &'a Surfels,
    /// Lines and triangles, if any.
    pub primitives: Option<&'a Primitives>,
    /// Which of the surfels stand for others from afar: see [`Levels`].
    pub levels: Option<&'a LevelTable>,
    /// Format in which scenes store the surfels.
    pub format: SurfelFormat,
}

impl<'a> From<&'a Surfels> for Parts<'a> {
    fn from(surfels: &'a Surfels) -> Self {
        Self { surfels, primitives: None, levels: None, format: SurfelFormat::default() }
    }
}

impl<'a> From<&'a Model> for Parts<'a> {
    fn from(model: &'a Model) -> Self {
        let primitives = (!model.primitives.is_empty()).then_some(&model.primitives);
        Self { surfels: &model.surfels, primitives, levels: None, format: SurfelFormat::default() }
    }
}

impl<'a> From<&'a Levels> for Parts<'a> {
    fn from(levels: &'a Levels) -> Self {
        Self { levels: Some(&levels.table), ..(&levels.surfels).into() }
    }
}

impl From<Surfels> for Model {
    fn from(surfels: Surfels) -> Self {
        Self { surfels, primitives: Primitives::default() }
    }
}

impl Parts<'_> {
    /// Validates the parts, and that their origins agree.
    ///
    /// # Errors
    /// [`Error::Usage`], as [`Surfels::check`] and [`Primitives::check`].
    pub fn check(&self) -> Result<()> {
        self.surfels.check()?;
        let Some(primitives) = self.primitives else { return Ok(()) };
        primitives.check()?;
        let [a, b] = [self.surfels.origin, primitives.origin];
        if self.surfels.is_empty() || a == b {
            Ok(())
        } else {
            Err(Error::Usage(format!(
                "the surfels' origin is {a}, that of lines and triangles {b}: give the same"
            )))
        }
    }

    /// The texture of all parts; `None` unless they share one.
    pub fn texture(&self) -> Option<&Arc<MipMap>> {
        let of_surfels = (!self.surfels.is_empty()).then_some(self.surfels.texture.as_ref());
        let of_primitives = self.primitives.map(|primitives| primitives.texture.as_ref());
        let mut parts = of_surfels.into_iter().chain(of_primitives);
        let first = &parts.next()??.image;
        let same = |image: &Arc<MipMap>| Arc::ptr_eq(image, first) || image == first;
        parts.all(|part| part.is_some_and(|part| same(&part.image))).then_some(first)
    }

    /// Materials of surfels, segments and triangles, in the order of their ids; `None` if there are none.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are more than [`Materials::MOST`].
    pub(crate) fn materials(&self) -> Result<Option<Materials>> {
        let elements = self.primitives.map(Primitives::element_materials);
        let count = self.primitives.map_or(0, Primitives::count);
        let surfels = (self.surfels.materials.as_ref(), self.surfels.len());
        Materials::join(&[surfels, (elements.flatten().as_ref(), count)])
    }

    /// A copy with a colour per point in place of textures.
    pub(crate) fn baked(&self) -> Model {
        let mut model =
            Model { surfels: self.surfels.clone(), primitives: self.primitives.cloned().unwrap_or_default() };
        let Model { surfels: s, primitives: p } = &mut model;
        if let Some(texture) = s.texture.take() {
            s.colours = Some(Colours::Linear(texture.colours(&s.positions, Some(&s.radii))));
        }
        if let Some(texture) = p.texture.take() {
            p.colours = Some(Colours::Linear(texture.colours(&p.positions, Some(&p.radii))));
        }
        model
    }

    /// Whether a part has a texture.
    pub(crate) fn has_texture(&self) -> bool {
        self.surfels.texture.is_some()
            || self.primitives.is_some_and(|primitives| primitives.texture.is_some())
    }

    /// Origin of the positions.
    pub fn origin(&self) -> DVec3 {
        match self.primitives {
            Some(primitives) if self.surfels.is_empty() => primitives.origin,
            _ => self.surfels.origin,
        }
    }

    /// Number of points: of the surfels, those that stand for no others.
    pub(crate) fn points(&self) -> usize {
        let first = self.levels.and_then(|table| table.starts().first());
        first.map_or(self.surfels.len(), |start| *start as usize)
    }

    /// Bounds of the valid elements, world space; `None` if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        let surfels = self.surfels.bounds_of_first(self.points());
        let both = [surfels, self.primitives.and_then(Primitives::bounds)];
        both.into_iter().flatten().reduce(|a, b| a.with(&b))
    }
}

impl Primitives {
    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// The vertices `kept`, in that order, and the elements among them.
    pub(super) fn part(&self, kept: &[u32]) -> Self {
        Self::whole(Cloud::from(self.clone()).part(kept))
    }

    /// Number of segments and triangles.
    pub fn count(&self) -> usize {
        self.ribbons.len() + self.tubes.len() + self.triangles.len()
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.count() == 0
    }

    /// Segments, ribbons first, each with whether it is a tube.
    pub fn segments(&self) -> impl Iterator<Item = ([u32; 2], bool)> {
        let ribbons = self.ribbons.iter().map(|ends| (*ends, false));
        ribbons.chain(self.tubes.iter().map(|ends| (*ends, true)))
    }

    /// Materials of segments, ribbons first, and triangles: those of their first vertices.
    fn element_materials(&self) -> Option<Materials> {
        let materials = self.materials.as_ref()?;
        let segments = self.segments().map(|([first, _], _)| first);
        let firsts: Vec<u32> = segments.chain(self.triangles.iter().map(|[first, ..]| *first)).collect();
        Some(materials.gather(&firsts))
    }

    /// Line direction at every vertex: the mean of the adjacent segments' directions, regardless of their orientation; 0 without segments.
    /// Segments with invalid vertex indices are ignored.
    pub fn line_directions(&self) -> Vec<Vec3> {
        let mut directions = vec![Vec3::ZERO; self.len()];
        for ([from, to], _) in self.segments() {
            let ends = [from, to].map(|vertex| vertex as usize);
            let [Some(a), Some(b)] = ends.map(|end| self.positions.get(end)) else { continue };
            let along = (b - a).normalize_or_zero();
            for vertex in ends {
                let there = directions[vertex];
                directions[vertex] += if there.dot(along) < 0.0 { -along } else { along };
            }
        }
        directions.into_iter().map(Vec3::normalize_or_zero).collect()
    }

    /// Validates the lengths of the arrays, the origin, and the indices.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the lengths, origin, material or vertex.
    pub fn check(&self) -> Result<()> {
        if !self.origin.is_finite() {
            let text = format!("the origin of lines and triangles is {}: give a finite one", self.origin);
            return Err(Error::Usage(text));
        }
        let count = self.len();
        let colours = self.colours.as_ref().map_or(count, Colours::len);
        let textured = self.texture.as_ref().map_or(count, |texture| texture.coordinates.len());
        let materials = self.materials.as_ref().map_or(count, |materials| materials.of.len());
        let lengths = [
            ("directions", self.directions.len()),
            ("radii", self.radii.len()),
            ("colours", colours),
            ("texture coordinates", textured),
            ("materials", materials),
        ];
        if let Some((what, length)) = lengths.iter().find(|(_, length)| *length != count) {
            return Err(Error::Usage(format!("{count} vertices and {length} {what}: give one per vertex")));
        }
        self.materials.as_ref().map_or(Ok(()), Materials::check)?;
        let ends = self.segments().flat_map(|(ends, _)| ends);
        match ends.chain(self.triangles.iter().copied().flatten()).find(|&vertex| vertex as usize >= count) {
            None => Ok(()),
            Some(vertex) => Err(Error::Usage(format!(
                "a line or a triangle has vertex {vertex} of {count}: count from 0"
            ))),
        }
    }

    /// Whether elements with this vertex can be drawn: no attribute is NaN, infinite or beyond [`Surfels::LARGEST`], the direction is a
    /// unit vector, and the radius is 0 or more. `false` beyond the end of any array.
    pub fn is_valid(&self, vertex: usize) -> bool {
        let bounded = |v: Vec3| v.abs().cmple(Vec3::splat(Surfels::LARGEST)).all();
        let placed = self.positions.get(vertex).is_some_and(|&position| bounded(position));
        let directed = self.directions.get(vertex).is_some_and(|&direction| super::is_unit(direction));
        let sized = self.radii.get(vertex).is_some_and(|radius| (0.0..=Surfels::LARGEST).contains(radius));
        let coloured = match &self.colours {
            Some(Colours::Linear(colours)) => colours.get(vertex).is_some_and(|&c| bounded(c.into())),
            Some(Colours::Srgb8(colours)) => vertex < colours.len(),
            None => true,
        };
        let textured = match &self.texture {
            Some(texture) => texture.coordinates.get(vertex).is_some_and(|at| at.is_finite()),
            None => true,
        };
        placed && directed && sized && coloured && textured
    }

    /// Number of segments and triangles with an invalid vertex.
    pub fn count_invalid(&self) -> usize {
        let valid = |vertices: &[u32]| vertices.iter().all(|&vertex| self.is_valid(vertex as usize));
        let lines = self.segments().filter(|(ends, _)| !valid(ends)).count();
        lines + self.triangles.iter().filter(|corners| !valid(*corners)).count()
    }

    /// Bounds of the spheres around the valid vertices, world space; `None` if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        let valid = (0..self.len()).filter(|&i| self.is_valid(i));
        let (positions, radii): (Vec<_>, Vec<f32>) =
            valid.map(|i| (self.positions[i], self.radii[i])).unzip();
        let largest = radii.iter().copied().fold(0.0, f32::max);
        Some(Bounds::of(&positions)?.grown(largest.into()).translated(self.origin))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two() -> Primitives {
        Primitives {
            positions: vec![Vec3::ZERO, Vec3::X],
            directions: vec![Vec3::Z; 2],
            radii: vec![0.25, 0.0],
            ribbons: vec![[0, 1]],
            ..Default::default()
        }
    }

    #[test]
    fn invalid_indices_and_lengths_are_refused() {
        assert!(two().check().is_ok());
        let changes: [fn(&mut Primitives); 5] = [
            |p| p.tubes.push([0, 2]),
            |p| p.triangles.push([0, 1, 9]),
            |p| p.radii.truncate(1),
            |p| p.colours = Some(Colours::Linear(vec![])),
            |p| p.origin.x = f64::NAN,
        ];
        let causes = ["vertex 2 of 2", "vertex 9", "2 vertices and 1 radii", "and 0 colours", "finite"];
        for (change, expected) in changes.into_iter().zip(causes) {
            let mut primitives = two();
            change(&mut primitives);
            let text = primitives.check().unwrap_err().to_string();
            assert!(text.contains(expected), "{text}");
        }
    }

    #[test]
    fn what_is_out_of_bounds_is_invalid_and_bounds_leave_it_out() {
        assert_eq!((two().count_invalid(), two().bounds().unwrap().max.x), (0, 1.25));
        let changes: [fn(&mut Primitives); 6] = [
            |p| p.positions[1].x = f32::NAN,
            |p| p.positions[1].y = 2e15,
            |p| p.directions[1] *= 1.01,
            |p| p.radii[1] = -0.1,
            |p| p.radii[1] = f32::INFINITY,
            |p| p.colours = Some(Colours::Linear(vec![[0.0; 3], [0.0, f32::NAN, 0.0]])),
        ];
        for (i, change) in changes.into_iter().enumerate() {
            let mut primitives = two();
            change(&mut primitives);
            let bounds = primitives.bounds().unwrap();
            assert_eq!((primitives.count_invalid(), bounds.max.x), (1, 0.25), "change {i}");
        }
    }

    #[test]
    fn lines_go_on_from_segment_to_segment() {
        let mut bent = two();
        bent.positions.extend([Vec3::new(1.0, 1.0, 0.0), Vec3::Z]);
        // The second segment goes the other way.
        bent.ribbons.push([2, 1]);
        let directions = bent.line_directions();
        assert_eq!(directions[0], Vec3::X);
        assert!(
            (directions[1].abs() - Vec3::new(0.5f32.sqrt(), 0.5f32.sqrt(), 0.0)).length() < 1e-6,
            "{directions:?}"
        );
        assert_eq!((directions[2].abs(), directions[3]), (Vec3::Y, Vec3::ZERO));
        bent.tubes.push([3, 9]);
        assert_eq!(bent.line_directions(), directions);
    }

    #[test]
    fn surfels_and_lines_have_one_origin() {
        let surfels = Surfels {
            positions: vec![Vec3::Y],
            normals: vec![Vec3::Z],
            radii: vec![1.0],
            ..Default::default()
        };
        let mut model = Model { surfels, primitives: two() };
        let bounds = Parts::from(&model).bounds().unwrap();
        assert_eq!((bounds.min, bounds.max), (DVec3::new(-1.0, -0.25, -1.0), DVec3::new(1.25, 2.0, 1.0)));
        model.primitives.origin.x = 1.0;
        assert!(Parts::from(&model).check().is_err());
        model.surfels = Surfels::default();
        assert!(Parts::from(&model).check().is_ok());
        assert_eq!(Parts::from(&model).origin(), DVec3::X);
        assert!(Parts::from(&Model::from(Surfels::default())).primitives.is_none());
    }
}
