//! `surfel view`.

use super::args::{self, View};
use super::colouring::Colouring;
use super::files::config_folder;
use super::inputs::{self, Wanted};
use super::{camera, render, vulkan};
use crate::viewer;
use std::ffi::OsString;
use std::sync::Arc;
use std::time::Instant;
use surfel::Result;
use surfel::geometry::{Bounds, Model};
use surfel::methods::Method;

/// Opens the window, which loads the inputs while it is there.
pub fn run(args: View) -> Result<()> {
    let start = Instant::now();
    args.settings(&args.method.unwrap_or(Method::ALL[0])).check()?;
    let file = camera::read(&args.camera)?;
    let up = camera::up(&args.camera, file);
    let colouring = Colouring::new(&args.colours, up)?;
    let texture = args.colours.texture()?;
    let (estimate, polygons, quiet) = (args.points.estimate(), args.points.polygons, args.quiet);
    let asked = args.method;
    // Colours that are not the surface's are not what rays see.
    let is_exact = colouring.is_none();
    let load = move |names: &[OsString], window: &dyn viewer::Loading| {
        let sketch = |model: Model| {
            if let Ok(method) = render::method(asked, &model) {
                window.sketch(viewer::Loaded { model, surface: None, method });
            }
        };
        let wanted = Wanted {
            names,
            estimate: estimate.clone(),
            polygons,
            lines: None,
            simplify: None,
            voxel: None,
            colouring: colouring.clone(),
            texture: texture.clone(),
            quiet,
            progress: window,
            sketch: Some(&sketch),
        };
        let model = inputs::load(&wanted)?.model;
        let method = render::method(asked, &model)?;
        let surface = match names {
            [one] if is_exact => inputs::scene(one).map(Into::into),
            _ => None,
        };
        Ok(viewer::Loaded { model, surface, method })
    };
    let given = {
        let args::Camera { eye, target, fov, parallel, file, .. } = &args.camera;
        eye.is_some() || target.is_some() || fov.is_some() || parallel.is_some() || file.is_some()
    };
    let (cameras, pose) = (args.camera.clone(), file.map(|(_, pose)| pose));
    let place = move |bounds: &Bounds, size| given.then(|| camera::pose(&cameras, pose, bounds, size));
    let options = viewer::Options {
        inputs: args.inputs.clone(),
        size: args.size,
        device: vulkan::options(&args.device)?,
        rasterizer: args.rasterizer,
        up,
        budget: args.budget,
        fov_y_deg: args.camera.fov.unwrap_or(camera::FOV),
        place: Box::new(place),
        watch: args.watch,
        events: viewer::Events::new(start, args.json),
        keep: viewer::Folder { path: args.shots.clone(), tell: !(args.quiet || args.json) },
        remembered: config_folder().filter(|_| !args.fresh).map(|folder| folder.join("viewer.json")),
        asked: args.method.is_some()
            || Method::ALL.iter().any(|method| args.settings(method) != method.settings()),
    };
    viewer::run(options, Arc::new(load), Box::new(move |method| args.settings(method)))
}
