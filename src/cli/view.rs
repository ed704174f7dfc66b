//! `surfel view`.

use super::args::View;
use super::colouring::Colouring;
use super::files::config_folder;
use super::inputs::{self, Wanted};
use super::{camera, render, vulkan};
use crate::viewer;
use std::ffi::OsString;
use std::sync::Arc;
use surfel::geometry::estimate::Estimate;
use surfel::geometry::{Colours, MipMap, Model};
use surfel::methods::Method;
use surfel::{Progress, Result};

/// Opens the window, which loads the inputs while it is there.
pub fn run(args: View) -> Result<()> {
    args.settings(&args.method.unwrap_or(Method::ALL[0])).check()?;
    let file = camera::read(&args.camera)?;
    let up = camera::up(&args.camera, file);
    let colouring = Colouring::new(&args.colours, up)?;
    let reader = Reader {
        estimate: args.points.estimate(),
        polygons: args.points.polygons,
        texture: args.colours.texture()?,
        quiet: args.quiet,
    };
    let asked = args.method;
    let load = move |names: &[OsString], progress: &dyn Progress| {
        let inputs = reader.load(names, colouring.clone(), progress)?;
        let method = render::method(asked, &inputs.model)?;
        let surface = match names {
            // Colours that are not the surface's are not what rays see.
            [one] if colouring.is_none() => inputs::scene(one).map(Into::into),
            _ => None,
        };
        // A built-in scene has none, and no other beside one.
        let skipped =
            if names.iter().any(|name| inputs::scene(name).is_some()) { vec![] } else { inputs.skipped };
        let (reader, own) = (reader.clone(), names.to_vec());
        let read = move |name: &str, progress: &dyn Progress| reader.numbers(&own, name, progress);
        let numbers = viewer::Numbers { names: skipped, read: Arc::new(read) };
        Ok(viewer::Loaded { model: inputs.model, surface, numbers, method })
    };
    let options = viewer::Options {
        inputs: args.inputs.clone(),
        size: args.size,
        device: vulkan::options(&args.device)?,
        rasterizer: args.rasterizer,
        up,
        budget: args.budget,
        remembered: config_folder().filter(|_| !args.fresh).map(|folder| folder.join("viewer.json")),
        asked: args.method.is_some()
            || Method::ALL.iter().any(|method| args.settings(method) != method.settings()),
    };
    viewer::run(options, Arc::new(load), Box::new(move |method| args.settings(method)))
}

/// How inputs are read.
#[derive(Clone)]
struct Reader {
    estimate: Estimate,
    polygons: bool,
    texture: Option<Arc<MipMap>>,
    quiet: bool,
}

impl Reader {
    fn load(
        &self,
        names: &[OsString],
        colouring: Option<Colouring>,
        progress: &dyn Progress,
    ) -> Result<inputs::Inputs> {
        inputs::load(&Wanted {
            names,
            estimate: self.estimate.clone(),
            polygons: self.polygons,
            lines: None,
            simplify: None,
            voxel: None,
            colouring,
            texture: self.texture.clone(),
            quiet: self.quiet,
            progress,
        })
    }

    /// A property of every surfel, and of every vertex of lines and triangles.
    fn numbers(&self, names: &[OsString], name: &str, progress: &dyn Progress) -> Result<[Vec<f32>; 2]> {
        let quiet = Self { quiet: true, ..self.clone() };
        let Model { surfels, primitives } =
            quiet.load(names, Some(Colouring::numbers(name)), progress)?.model;
        let numbers = |colours| match colours {
            Some(Colours::Linear(numbers)) => numbers.into_iter().map(|[number, ..]| number).collect(),
            _ => Vec::new(),
        };
        Ok([surfels.colours, primitives.colours].map(numbers))
    }
}
