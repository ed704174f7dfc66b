//! From a cloud to a model: surfels, lines and triangles.

use super::{Estimate, Estimated, faces, lines};
use crate::Progress;
use crate::error::{Error, Result};
use crate::geometry::{Cloud, Colours, Model, Primitives, Surfels};
use glam::Vec3;

impl Cloud {
    /// Converts the cloud to a model.
    ///
    /// Points that a mesh leaves unused are left out. Lines become ribbons and tubes. Faces become triangles if there are lines, or with
    /// `polygons`. The points that neither uses become surfels, as [`Cloud::into_surfels`]. All have the cloud's origin.
    ///
    /// A tube's vertex without a tangent gets the mean direction of its segments (marroquim2008, section 4.3). A triangle's vertex without
    /// a normal gets that of its faces. A missing radius is 0 where there are only triangles. On a line it is [`Estimate::line_radius`],
    /// otherwise that of the nearest vertex along its line that has one, otherwise 1/2000 of the diagonal of the lines' bounds: about a
    /// pixel in a picture of all. A vertex of tubes that ribbons or triangles share becomes two, with a direction each.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::Error::Usage) if what is missing cannot be estimated or if a corner is no point.
    pub fn into_model(
        self,
        polygons: bool,
        how: &Estimate,
        progress: &dyn Progress,
    ) -> Result<(Model, Estimated)> {
        how.check()?;
        self.check_corners()?;
        let (cloud, unused) = self.without_unused();
        let (model, estimated) = cloud.into_model_whole(polygons, how, progress)?;
        Ok((model, Estimated { unused, ..estimated }))
    }

    /// Converts all points of a cloud whose elements are valid.
    fn into_model_whole(
        self,
        polygons: bool,
        how: &Estimate,
        progress: &dyn Progress,
    ) -> Result<(Model, Estimated)> {
        let (origin, faces) = (self.origin, polygons || self.has_lines());
        if !(faces && (self.has_lines() || !self.triangles.is_empty())) {
            let (surfels, estimated) = self.into_surfels(how, progress)?;
            return Ok((
                Model { surfels, primitives: Primitives { origin, ..Default::default() } },
                estimated,
            ));
        }
        let [drawn, points] = self.split(true);
        let (primitives, estimated) = drawn.into_primitives(how);
        let (surfels, more) = if points.is_empty() {
            (Surfels { origin, ..Default::default() }, Estimated::default())
        } else {
            points.into_surfels(how, progress)?
        };
        Ok((Model { surfels, primitives }, estimated + more))
    }

    fn check_corners(&self) -> Result<()> {
        let count = self.len();
        let corners = self.ribbons.iter().chain(&self.tubes).flatten().chain(self.triangles.iter().flatten());
        match corners.copied().find(|&i| i as usize >= count) {
            Some(corner) => Err(Error::Usage(format!(
                "a line or a triangle has the corner {corner}, which is none of the {count} points: count from 0"
            ))),
            None => Ok(()),
        }
    }

    /// Converts all points to vertices of lines and triangles.
    fn into_primitives(self, how: &Estimate) -> (Primitives, Estimated) {
        let mut estimated = Estimated::default();
        let given = self.radii.clone().unwrap_or_else(|| vec![0.0; self.len()]);
        let mut radii = lines::radii(&self, given, how.line_radius, &mut estimated);
        radii.iter_mut().for_each(|radius| *radius *= how.radius_scale);
        let tangents = lines::tangents(&self);
        let mut primitives = Primitives {
            origin: self.origin,
            directions: normals(&self),
            positions: self.positions,
            radii,
            colours: self.colours,
            texture: self.texture,
            materials: self.materials,
            ribbons: self.ribbons,
            tubes: self.tubes,
            triangles: self.triangles,
        };
        primitives.give_tangents(&tangents);
        (primitives, estimated)
    }
}

impl Primitives {
    /// Sets tangents at the vertices of tubes: in place of an unused normal, otherwise on a copy of the vertex.
    fn give_tangents(&mut self, tangents: &[Vec3]) {
        let mut needed = vec![false; self.len()];
        let others = self.ribbons.iter().flatten().chain(self.triangles.iter().flatten());
        others.for_each(|&i| needed[i as usize] = true);
        let mut place: Vec<u32> = (0..self.len() as u32).collect();
        let mut copied = Vec::new();
        for (i, tangent) in tangents.iter().enumerate().filter(|(_, tangent)| **tangent != Vec3::ZERO) {
            if needed[i] {
                place[i] = (self.len() + copied.len()) as u32;
                copied.push(i as u32);
            } else {
                self.directions[i] = *tangent;
            }
        }
        self.tubes.iter_mut().flatten().for_each(|i| *i = place[*i as usize]);
        self.append_copies(&copied);
        for &i in &copied {
            self.directions[place[i as usize] as usize] = tangents[i as usize];
        }
    }

    fn append_copies(&mut self, of: &[u32]) {
        for &i in of {
            self.positions.push(self.positions[i as usize]);
            self.directions.push(self.directions[i as usize]);
            self.radii.push(self.radii[i as usize]);
            if let Some(texture) = &mut self.texture {
                texture.coordinates.push(texture.coordinates[i as usize]);
            }
            if let Some(materials) = &mut self.materials {
                materials.of.push(materials.of[i as usize]);
            }
            match &mut self.colours {
                Some(Colours::Srgb8(codes)) => codes.push(codes[i as usize]),
                Some(Colours::Linear(linear)) => linear.push(linear[i as usize]),
                None => {}
            }
        }
    }
}

/// The points' normals; if missing, those of their faces; otherwise an arbitrary direction.
fn normals(cloud: &Cloud) -> Vec<Vec3> {
    let mut normals = cloud.normals.clone().unwrap_or_else(|| vec![Vec3::ZERO; cloud.len()]);
    if normals.contains(&Vec3::ZERO) {
        let from_faces = faces::normals(&cloud.positions, &cloud.triangles);
        for (normal, from_faces) in
            normals.iter_mut().zip(from_faces).filter(|(normal, _)| **normal == Vec3::ZERO)
        {
            *normal = from_faces.unwrap_or(Vec3::Z);
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// A square of two triangles, a point of its own, and a branch from one of the square's corners.
    fn hybrid() -> Cloud {
        let z = |z: f32| Vec3::new(1.0, 1.0, z);
        Cloud {
            origin: DVec3::new(1e6, 0.0, 0.0),
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(5.0, 5.0, 5.0), z(0.0), Vec3::Y, z(1.0), z(2.0)],
            radii: Some(vec![0.0, 0.125, 0.5, 0.0, 0.0, 0.25, 0.0]),
            normals: Some([vec![Vec3::ZERO; 2], vec![Vec3::Y], vec![Vec3::ZERO; 4]].concat()),
            colours: Some(Colours::Srgb8((0..7).map(|i| [i; 4]).collect())),
            triangles: vec![[0, 1, 3], [0, 3, 4]],
            tubes: vec![[3, 5], [6, 5]],
            ..Default::default()
        }
    }

    #[test]
    fn points_lines_and_triangles_become_one_model() {
        let (Model { surfels, primitives }, counts) =
            hybrid().into_model(false, &Estimate { radius_scale: 2.0, ..Default::default() }, &()).unwrap();
        assert_eq!((surfels.positions, surfels.normals), (vec![Vec3::splat(5.0)], vec![Vec3::Y]));
        assert_eq!((surfels.radii, surfels.origin), (vec![1.0], primitives.origin));
        // The corner where the branch begins has two directions.
        assert_eq!(primitives.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(primitives.tubes, [[6, 4], [5, 4]]);
        assert_eq!(primitives.directions, [Vec3::Z; 7]);
        assert_eq!(primitives.radii, [0.0, 0.25, 0.5, 0.0, 0.5, 0.5, 0.5]);
        let colours = [0, 1, 3, 4, 5, 6, 3].map(|i: u8| [i; 4]);
        assert_eq!(primitives.colours, Some(Colours::Srgb8(colours.to_vec())));
        assert_eq!((counts.line_radii_given, counts.line_radii_from_lines), (1, 2));
        assert_eq!((primitives.count_invalid(), primitives.check().is_ok()), (0, true));
    }

    #[test]
    fn faces_are_triangles_beside_lines_or_on_request() {
        let mesh = || Cloud { tubes: vec![], ..hybrid() };
        let model = |polygons| mesh().into_model(polygons, &Estimate::default(), &()).unwrap().0;
        assert_eq!((model(false).surfels.len(), model(false).primitives.is_empty()), (7, true));
        let drawn = model(true);
        assert_eq!((drawn.surfels.len(), drawn.primitives.len(), drawn.primitives.count()), (3, 4, 2));
        assert_eq!(drawn.primitives.radii, [0.0, 0.125, 0.0, 0.0]);
        let dangling = Cloud { tubes: vec![[0, 7]], ..hybrid() };
        let cause = dangling.into_model(false, &Estimate::default(), &()).unwrap_err().to_string();
        assert!(cause.contains("corner 7, which is none of the 7"), "{cause}");
    }
}
