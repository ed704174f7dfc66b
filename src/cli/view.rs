//! `surfel view`.

use super::args::{self, View};
use super::colouring::Colouring;
use super::files::config_folder;
use super::inputs::{self, Wanted};
use super::{camera, render, vulkan};
use crate::viewer;
use glam::DVec3;
use std::ffi::OsString;
use std::sync::Arc;
use std::time::Instant;
use surfel::geometry::estimate::Estimate;
use surfel::geometry::{Bounds, Colours, MipMap, Model};
use surfel::methods::Method;
use surfel::{Error, Progress, Result};

/// Opens the window, which loads the inputs while it is there.
pub fn run(args: View) -> Result<()> {
    let start = Instant::now();
    args.settings(&args.method.unwrap_or(Method::ALL[0])).check()?;
    if !(args.budget > 0.0 && args.budget.is_finite()) {
        return Err(Error::Usage(format!(
            "frames cannot take {} ms: give --budget a number above 0",
            args.budget
        )));
    }
    let file = camera::read(&args.camera)?;
    let up = camera::up(&args.camera, file);
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
    let load = load(&args, up)?;
    viewer::run(options, load, Box::new(move |method| args.settings(method)))
}

/// How inputs are loaded, as the arguments say.
fn load(args: &View, up: DVec3) -> Result<viewer::Load> {
    let colouring = Colouring::new(&args.colours, up)?;
    let reader = Reader {
        estimate: args.points.estimate(),
        polygons: args.points.polygons,
        texture: args.colours.texture()?,
        quiet: args.quiet,
    };
    let asked = args.method;
    Ok(Arc::new(move |names: &[OsString], window: &dyn viewer::Loading| {
        let sketch = |model: Model| {
            // What is wrong with it is wrong with all of it, which says so.
            if let Ok(method) = render::method(asked, &model) {
                window.sketch(viewer::Loaded::sketch(model, method));
            }
        };
        let inputs = reader.load(names, colouring.clone(), window, Some(&sketch))?;
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
    }))
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
        sketch: Option<&dyn Fn(Model)>,
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
            sketch,
        })
    }

    /// A property of every surfel, and of every vertex of lines and triangles.
    fn numbers(&self, names: &[OsString], name: &str, progress: &dyn Progress) -> Result<[Vec<f32>; 2]> {
        let quiet = Self { quiet: true, ..self.clone() };
        let Model { surfels, primitives } =
            quiet.load(names, Some(Colouring::numbers(name)), progress, None)?.model;
        let numbers = |colours| match colours {
            Some(Colours::Linear(numbers)) => numbers.into_iter().map(|[number, ..]| number).collect(),
            _ => Vec::new(),
        };
        Ok([surfels.colours, primitives.colours].map(numbers))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::{Command, Surfel};
    use clap::Parser;
    use std::sync::Mutex;
    use surfel::{Error, Progress};

    /// Keeps what it is shown, and gives up where it is told to.
    #[derive(Default)]
    struct Window {
        sketches: Mutex<Vec<usize>>,
        /// The stage at which it gives up.
        until: Option<&'static str>,
        stages: Mutex<Vec<&'static str>>,
    }

    impl Progress for Window {
        fn at(&self, stage: &'static str, _: u64, _: u64) {
            self.stages.lock().unwrap().push(stage);
        }

        fn is_cancelled(&self) -> bool {
            self.until.is_some_and(|until| self.stages.lock().unwrap().contains(&until))
        }
    }

    impl viewer::Loading for Window {
        fn sketch(&self, loaded: viewer::Loaded) {
            self.sketches.lock().unwrap().push(loaded.model.surfels.len());
        }
    }

    fn loaded(input: impl Into<OsString>, window: &Window) -> Result<viewer::Loaded> {
        let input = [input.into()];
        let command = ["surfel", "view", "-q", "x.ply"];
        let Command::View(args) = Surfel::try_parse_from(command).unwrap().command else { panic!("no view") };
        load(&args, DVec3::Y)?(&input, window)
    }

    #[test]
    fn what_cannot_be_read_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
        let files = [
            ("none.ply", None),
            ("empty.ply", Some(String::new())),
            ("text.ply", Some("hello".into())),
            ("cut.ply", Some(format!("{header}0 0 0\n1 0 0\n"))),
            ("heap.ply", Some(format!("{header}{}", "1 2 3\n".repeat(4)))),
            ("huge.ply", Some(header.replace("vertex 4", "vertex 4000000000000"))),
        ];
        for (name, text) in files {
            let path = folder.path().join(name);
            text.into_iter().for_each(|text| std::fs::write(&path, text).unwrap());
            let error = loaded(&path, &Window::default()).err().unwrap().to_string();
            assert!(error.contains(name) && !error.contains('\n'), "{error}");
        }
        let error = loaded(folder.path(), &Window::default()).err().unwrap().to_string();
        assert!(error.contains(&folder.path().display().to_string()), "{error}");
    }

    #[test]
    fn many_points_are_sketched_and_few_are_not() {
        let window = Window::default();
        let all = loaded("scene:sphere?points=120000", &window).unwrap();
        assert_eq!((all.model.surfels.len(), window.sketches.into_inner().unwrap()), (120_000, vec![20_000]));
        let window = Window::default();
        loaded("scene:sphere?points=50000", &window).unwrap();
        assert!(window.sketches.into_inner().unwrap().is_empty());
    }

    #[test]
    fn loading_is_given_up_while_it_reads_and_while_it_estimates() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.ply");
        let count = 40_000;
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        );
        (0..count).for_each(|i| text += &format!("{} {} {}\n", i % 200, i / 200, i % 7));
        std::fs::write(&path, text).unwrap();
        let last = [
            ("reading", "reading"),
            ("building the search tree", "estimating normals and radii"),
            ("estimating normals and radii", "estimating normals and radii"),
        ];
        for (until, last) in last {
            let window = Window { until: Some(until), ..Default::default() };
            let given_up = loaded(&path, &window);
            assert!(matches!(given_up, Err(Error::Cancelled)), "{until}");
            assert_eq!(window.stages.into_inner().unwrap().last(), Some(&last), "{until}");
        }
        assert_eq!(loaded(&path, &Window::default()).unwrap().model.surfels.len(), count);
    }
}
