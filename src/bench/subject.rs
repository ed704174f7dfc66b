//! Subjects of measurements: points of a built-in scene or a scan, and their exact surface, if it is known.

use crate::error::{Error, Result};
use crate::estimate::Estimate;
use crate::formats::{self, ReadOptions};
use crate::geometry::{Bounds, Camera, Cloud, Extent, Model, Pose};
use crate::progress::Progress;
use crate::verify::scenes::{self, Surface, Viewpoint};
use crate::verify::truth::{self, Mesh};
use glam::{DQuat, DVec3};
use std::path::Path;

/// Vertical field of view of a scan, degrees.
const FOV: f64 = 45.0;

/// A surface that can be sampled at several densities, with a viewpoint.
pub struct Subject {
    /// The scene with its parameters, without the number of points; or the file.
    pub name: String,
    /// Cache key of its exact pictures; empty without a surface.
    pub digest: String,
    viewpoint: Viewpoint,
    bounds: Bounds,
    shape: Shape,
}

enum Shape {
    /// A built-in scene.
    Built(Box<dyn Surface>),
    /// A scan.
    Scan(Box<Scan>),
}

/// Points, and the surface that they sample, if it is known.
struct Scan {
    cloud: Cloud,
    mesh: Option<Mesh>,
    /// File of the mesh; empty if there is none.
    mesh_name: String,
    /// Whether the mesh's corners are the points.
    is_of_points: bool,
}

impl Subject {
    /// A built-in scene, named without its number of points.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no scene of that name, or a parameter is wrong.
    pub fn scene(name: &str) -> Result<Self> {
        if name.split(['?', '&']).any(|part| part.starts_with("points=")) {
            return Err(Error::Usage(format!(
                "{name}: the bench sets the number of points; leave out `points`"
            )));
        }
        let built = scenes::surface(name)?;
        let (viewpoint, bounds) = (scenes::camera(name)?, truth::Traceable::bounds(&built));
        Ok(Self { name: name.into(), digest: name.into(), viewpoint, bounds, shape: Shape::Built(built) })
    }

    /// The points of a file, with the triangles of `mesh` or its own as the exact surface. Without triangles the surface is unknown.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::Input`] if a file cannot be read, has no points, or `mesh` has no triangles.
    pub fn scan(path: &Path, mesh: Option<&Path>, progress: &dyn Progress) -> Result<Self> {
        let triangles = ReadOptions { triangles: true, ..Default::default() };
        let loaded = formats::read(path, &triangles, progress)?;
        let (up, cloud) = (loaded.up(), loaded.cloud);
        let other =
            mesh.map(|mesh| Ok::<_, Error>(formats::read(mesh, &triangles, progress)?.cloud)).transpose()?;
        let name = path.display().to_string();
        let is_of_points = other.is_none();
        let file_of_mesh = mesh.unwrap_or(path).display().to_string();
        let mesh = match (mesh, other) {
            (Some(mesh), Some(other)) => Some(Mesh::new(&mesh.display().to_string(), &other)?),
            _ if cloud.triangles.is_empty() => None,
            _ => Some(Mesh::new(&name, &cloud)?),
        };
        let mesh_name = if mesh.is_some() { file_of_mesh } else { String::new() };
        let Some(extent) = Extent::of_cloud(&cloud) else {
            return Err(Error::input(name, "no points: give points, or a mesh"));
        };
        let bounds = mesh.as_ref().map_or(extent.bounds(), truth::Traceable::bounds);
        let (viewpoint, digest) =
            (framing(&extent, up)?, mesh.as_ref().map(Mesh::digest).unwrap_or_default());
        Ok(Self {
            name,
            digest,
            viewpoint,
            bounds,
            shape: Shape::Scan(Box::new(Scan { cloud, mesh, mesh_name, is_of_points })),
        })
    }

    /// Greatest number of points; none if there is no limit.
    pub fn most_points(&self) -> Option<u64> {
        match &self.shape {
            Shape::Built(_) => None,
            Shape::Scan(scan) => Some(scan.cloud.len() as u64),
        }
    }

    /// `points` surfels in Morton order with their curvatures, and the scene's lines and triangles. All points of a scan become what `surfel
    /// render` makes of the file. Fewer are bare points: normals are the file's, or estimated from the remaining points, and radii are new.
    ///
    /// # Errors
    /// As [`scenes::model`]; [`Error::Input`] if a scan's points cannot become surfels.
    pub fn model(&self, points: u64) -> Result<Model> {
        match &self.shape {
            Shape::Built(_) => {
                let separator = if self.name.contains('?') { '&' } else { '?' };
                let Model { surfels, primitives } =
                    scenes::model(&format!("{}{separator}points={points}", self.name))?;
                let surfels = match surfels.is_empty() {
                    true => surfels,
                    false => Cloud::from(surfels).into_surfels(&Estimate::default(), &())?.0,
                };
                Ok(Model { surfels, primitives })
            }
            Shape::Scan(scan) => {
                let model = scan.cloud.clone().at_most(points).into_model(false, &Estimate::default(), &());
                Ok(model.map_err(|error| error.in_input(self.name.as_str()))?.0)
            }
        }
    }

    /// The viewpoint.
    pub fn viewpoint(&self) -> Viewpoint {
        self.viewpoint
    }

    /// The camera of a picture of `size` px, turned by `angle`, rad, at its position. It does not depend on the number
    /// of points.
    ///
    /// # Errors
    /// [`Error::Usage`] if no such camera exists.
    pub fn camera(&self, from: &Viewpoint, angle: f64, size: [u32; 2]) -> Result<Camera> {
        let Viewpoint { eye, target, up, .. } = *from;
        let [eye, target_then, up] = [eye, target, up].map(DVec3::from);
        let turned = DQuat::from_axis_angle(up.normalize_or(DVec3::Y), angle) * (target_then - eye);
        let target = if angle == 0.0 { target } else { (eye + turned).to_array() };
        let viewpoint = Viewpoint { target, ..*from };
        viewpoint.camera(f64::from(size[0]) / f64::from(size[1]), &self.bounds())
    }

    /// Bounds of the surface, or of the points.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Area of the surface, hidden parts included; none if unknown.
    pub fn area(&self) -> Option<f64> {
        match &self.shape {
            Shape::Built(built) => Some(built.area()),
            Shape::Scan(_) => None,
        }
    }

    /// The exact surface, if it is known.
    pub fn surface(&self) -> Option<&dyn truth::Traceable> {
        match &self.shape {
            Shape::Built(built) => Some(built),
            Shape::Scan(scan) => scan.mesh.as_ref().map(|mesh| mesh as &dyn truth::Traceable),
        }
    }

    /// The scene, or the file whose triangles are the exact surface; empty if it is unknown.
    pub fn surface_name(&self) -> &str {
        match &self.shape {
            Shape::Built(_) => &self.name,
            Shape::Scan(scan) => &scan.mesh_name,
        }
    }

    /// The triangles between `points` points of a scan with triangles, those of its [`model`](Self::model). None if there are no triangles, or if
    /// they come from another file: the exact surface takes their place.
    ///
    /// # Errors
    /// [`Error::Usage`] if so few points span no triangle.
    pub fn coarse_mesh(&self, points: u64) -> Result<Option<Mesh>> {
        match &self.shape {
            Shape::Scan(scan) if scan.is_of_points && points < scan.cloud.len() as u64 => {
                let kept = scan.cloud.spread(points as usize);
                scan.mesh.as_ref().map(|mesh| mesh.coarse(&kept)).transpose()
            }
            _ => Ok(None),
        }
    }

    /// Whether its points have colours, or a texture.
    pub fn is_coloured(&self) -> bool {
        match &self.shape {
            Shape::Built(_) => true,
            Shape::Scan(scan) => scan.cloud.colours.is_some() || scan.cloud.texture.is_some(),
        }
    }
}

/// Angle of view of a pixel in the middle of a picture with `rows` rows, rad.
pub fn pixel_angle(from: &Viewpoint, rows: u32) -> f64 {
    2.0 * (0.5 * from.fov_y_deg.to_radians()).tan() / f64::from(rows)
}

/// The viewpoint of `surfel render` for a square picture, if no normals have to be estimated.
fn framing(extent: &Extent, up: DVec3) -> Result<Viewpoint> {
    let Pose { eye, target, up, .. } = extent.pose(up, FOV, 1.0)?;
    Ok(Viewpoint { eye: eye.to_array(), target: target.to_array(), up: up.to_array(), fov_y_deg: FOV })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_points_are_what_render_draws() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fan.obj");
        // The vertices of long triangles are replaced by ellipses on them.
        let rim = (0..40).map(|i| f64::from(i) * 0.15).map(|a| format!("v {} {} 0\n", a.cos(), a.sin()));
        let faces = (2..41).map(|i| format!("f 1 {i} {}\n", i + 1));
        std::fs::write(&path, format!("v 0 0 0.2\n{}{}", rim.collect::<String>(), faces.collect::<String>()))
            .unwrap();
        let subject = Subject::scan(&path, None, &()).unwrap();
        let read = formats::read(&path, &ReadOptions { triangles: true, ..Default::default() }, &()).unwrap();
        let (drawn, _) = read.cloud.into_model(false, &Estimate::default(), &()).unwrap();
        assert_eq!(subject.model(41).unwrap().surfels, drawn.surfels);
        assert!(drawn.surfels.len() != 41 && subject.model(40).unwrap().surfels.len() == 40);
    }
}
