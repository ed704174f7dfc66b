//! The points of an input.

use super::{bounds, colours_text, elements_text, list, range_text, sizes, sources};
use crate::cli::args::Info;
use crate::cli::progress;
use glam::{DVec3, Vec3};
use std::path::Path;
use surfel::estimate::Estimated;
use surfel::formats::Loaded;
use surfel::geometry::{Cloud, Model};
use surfel::load::scene_cloud;
use surfel::{Result, thousands};

/// The points of a file or scene.
pub struct Input {
    /// Its name in errors.
    name: String,
    /// Number of points, including dropped ones.
    pub points: u64,
    /// Least and greatest coordinates of the points that are read.
    pub bounds: Option<[DVec3; 2]>,
    /// The up direction.
    pub up: DVec3,
    /// The points that are kept.
    pub cloud: Cloud,
    /// Whether faces are drawn as triangles.
    polygons: bool,
}

/// Numbers of points that have a normal and a radius.
pub struct Given {
    /// With a normal.
    pub normals: u64,
    /// With a radius and no normal, as they face the eye.
    pub billboards: u64,
    /// With a radius.
    pub radii: u64,
}

impl Input {
    /// The points of a built-in scene.
    pub fn of_scene(name: &str) -> Result<Self> {
        let cloud = scene_cloud(name)?;
        let (points, bounds) = (cloud.len() as u64, bounds::of(&cloud));
        Ok(Self { name: name.into(), points, bounds, up: DVec3::Y, cloud, polygons: true })
    }

    /// The points of a file.
    pub fn of_file(path: &Path, loaded: Loaded, args: &Info) -> Self {
        let up = loaded.up();
        let Loaded { cloud, report, .. } = loaded;
        let bounds = report.bounds.map(bounds::outward);
        let cloud = match args.points.points {
            Some(points) => cloud.at_most(points),
            None => cloud,
        };
        let (name, polygons) = (path.display().to_string(), args.points.polygons);
        Self { name, points: report.points, bounds, up, cloud, polygons }
    }

    /// The model with what the points lack, if it is to be estimated.
    pub fn model(self, args: &Info) -> Result<Option<(Model, Estimated)>> {
        if !args.estimates() {
            return Ok(None);
        }
        let made = self.cloud.into_model(self.polygons, &args.points.estimate(), &*progress::bars(false));
        made.map(Some).map_err(|error| error.in_input(self.name))
    }

    /// Describes the points, and where it is to be estimated, what they lack.
    pub fn text(self, args: &Info) -> Result<(String, Option<Estimated>)> {
        let points = format!("points: {}\n", thousands(self.points));
        let [x, y, z] = self.up.to_array();
        let bounds = self.bounds.map_or(String::new(), |[min, max]| format!("bounds: {min} to {max}\n"));
        let extent = format!("{bounds}up: {x},{y},{z}\n");
        let given = self.given_text();
        let Some((model, estimated)) = self.model(args)? else {
            return Ok((points + &extent + &given, None));
        };
        let Model { surfels, primitives } = &model;
        let colours = colours_text(surfels.colours.as_ref().or(primitives.colours.as_ref()));
        let elements = elements_text(&model);
        let text = points + &elements + &extent + &sizes(surfels) + colours + &sources(&estimated);
        Ok((text, Some(estimated)))
    }

    /// Describes what the points have, and what they lack.
    fn given_text(&self) -> String {
        let Given { normals, billboards, radii } = self.given();
        let count = self.cloud.len() as u64;
        let missing = count - normals - billboards;
        let normals =
            list(&[(normals, "given"), (billboards, "facing the eye"), (missing, "to be estimated")]);
        let radii_text = list(&[(radii, "given"), (count - radii, "to be estimated")]);
        let range = match range_text(&self.given_radii()) {
            range if range.is_empty() => range,
            range => range + "\n",
        };
        let colours = match &self.cloud.texture {
            Some(_) => "colours: texture\n",
            None => colours_text(self.cloud.colours.as_ref()),
        };
        format!("{range}{colours}normals: {normals}\nradii: {radii_text}\n")
    }

    /// Numbers of points that have a normal and a radius.
    pub fn given(&self) -> Given {
        let Cloud { normals, radii, two_sided, .. } = &self.cloud;
        let has_normal = |i: usize| normals.as_ref().is_some_and(|normals| normals[i] != Vec3::ZERO);
        let has_radius = |i: usize| radii.as_ref().is_some_and(|radii| radii[i] > 0.0);
        let is_two_sided = |i: usize| two_sided.as_ref().is_some_and(|sides| sides[i]);
        let is_billboard = |i: usize| !has_normal(i) && has_radius(i) && is_two_sided(i);
        let count = |is: &dyn Fn(usize) -> bool| (0..self.cloud.len()).filter(|i| is(*i)).count() as u64;
        Given { normals: count(&has_normal), billboards: count(&is_billboard), radii: count(&has_radius) }
    }

    /// The radii that points have.
    pub fn given_radii(&self) -> Vec<f32> {
        self.cloud.radii.iter().flatten().copied().filter(|radius| *radius > 0.0).collect()
    }
}
