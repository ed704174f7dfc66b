//! `surfel view`.

use super::args::View;
use super::colouring::Colouring;
use super::inputs::{self, Wanted};
use super::{camera, render, vulkan};
use crate::viewer;
use surfel::methods::Method;
use surfel::{Progress, Result};

/// Opens the window, which loads the inputs while it is there.
pub fn run(args: View) -> Result<()> {
    args.settings(&args.method.unwrap_or(Method::ALL[0])).check()?;
    let file = camera::read(&args.camera)?;
    let up = camera::up(&args.camera, file);
    let colouring = Colouring::new(&args.colours, up)?;
    let texture = args.colours.texture()?;
    let (names, estimate, polygons, quiet) =
        (args.inputs.clone(), args.points.estimate(), args.points.polygons, args.quiet);
    let asked = args.method;
    let load = move |progress: &dyn Progress| {
        let wanted = Wanted {
            names: &names,
            estimate,
            polygons,
            lines: None,
            simplify: None,
            voxel: None,
            colouring,
            texture,
            quiet,
            progress,
        };
        let model = inputs::load(&wanted)?.model;
        let method = render::method(asked, &model)?;
        Ok(viewer::Loaded { model, method })
    };
    let options = viewer::Options {
        size: args.size,
        device: vulkan::options(&args.device)?,
        rasterizer: args.rasterizer,
        up,
        budget: args.budget,
    };
    viewer::run(options, Box::new(load), Box::new(move |method| args.settings(method)))
}
