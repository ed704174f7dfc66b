//! `surfel view`.

mod surface;

use super::args::{self, View};
use super::files::config_folder;
use super::progress::{self, Silent};
use super::{camera, exit, rasterizers, render, vulkan};
use crate::viewer::{self, LoadRequest, Loaded, SceneInfo};
use glam::DVec3;
use std::ffi::OsString;
use std::sync::Arc;
use std::time::Instant;
use surfel::estimate::Estimate;
use surfel::formats::Filter;
use surfel::geometry::{Colours, Extent, Model, SurfelFormat};
use surfel::load::{
    Colouring, Listener, LoadOptions, Preview, SuggestedShading, Suggestion, Uncoloured, load, scene,
};
use surfel::settings::Hierarchy;
use surfel::settings::methods::Method;
use surfel::{Error, Progress, Result};

/// Opens the window, which loads the inputs in the background.
pub fn run(args: View) -> Result<()> {
    let start = Instant::now();
    let method = args.method()?;
    args.settings(&method.unwrap_or(Method::ALL[0])).check()?;
    if args.render_settings.hierarchy == Hierarchy::Paper {
        let text = "--hierarchy paper selects surfels for one camera, and the window moves it: leave it out, or give it to `surfel render`";
        return Err(Error::Usage(text.into()));
    }
    if !(args.frame_budget > 0.0 && args.frame_budget.is_finite()) {
        return Err(Error::Usage(format!(
            "--frame-budget is {} ms: give a number above 0",
            args.frame_budget
        )));
    }
    if !args.screenshots.is_dir() {
        return Err(Error::Usage(format!(
            "--screenshots {}: there is no such folder; create it, or give another",
            args.screenshots.display()
        )));
    }
    let file = camera::read(&args.camera)?;
    let given = {
        let args::Camera { eye, target, fov, parallel, file, .. } = &args.camera;
        eye.is_some() || target.is_some() || fov.is_some() || parallel.is_some() || file.is_some()
    };
    let (cameras, pose) = (args.camera.clone(), file.map(|(_, pose)| pose));
    let initial_camera = move |extent: &Extent, up, size| {
        given.then(|| camera::pose(&cameras, pose, extent, up, camera::Room::whole(size)))
    };
    let options = viewer::Options {
        inputs: args.inputs.clone(),
        filter: args.points.filter(),
        size: args.size,
        device: vulkan::options(&args.device)?,
        rasterizer: args.rasterizer,
        faster: rasterizers::read(),
        budget: args.frame_budget,
        fov_y_deg: args.camera.fov.unwrap_or(camera::FOV),
        initial_camera: Box::new(initial_camera),
        watch: args.watch,
        events: viewer::Events::new(start, args.json),
        save_folder: viewer::SaveFolder {
            path: args.screenshots.clone(),
            print_names: !(args.quiet || args.json),
        },
        remedy: exit::remedy,
        settings_file: config_folder().filter(|_| !args.fresh).map(|folder| folder.join("viewer.json")),
        method_chosen: method.is_some()
            || Method::CHOICES.iter().any(|method| args.settings(method) != method.settings()),
    };
    viewer::run(
        options,
        loader(&args, method, camera::up(&args.camera, file))?,
        Box::new(move |method| args.settings(method)),
    )
}

/// The function that loads inputs with the options of the arguments.
fn loader(args: &View, method: Option<Method>, up: Option<DVec3>) -> Result<viewer::Load> {
    // Errors of the options are reported before the window opens.
    args.colours.colouring()?;
    let colour_by = args.colours.by().map(|by| viewer::ColourBy {
        name: by.name.clone(),
        map: args.colours.color_map,
        range: by.range,
    });
    let format = SurfelFormat::quantized(args.quantize);
    let points = method.is_some_and(|method| args.settings(&method).draws_points());
    let options = LoadOptions {
        columns: args.points.columns.clone(),
        counts: true,
        estimate: Estimate { bare: points, ..args.points.estimate() },
        polygons: args.points.polygons,
        points: args.points.points,
        uncoloured: args.colours.uncoloured(Uncoloured::Suggest),
        up,
        texture: args.colours.texture()?,
        ..Default::default()
    };
    let reader = Reader { options, quiet: args.quiet };
    let [shading_given, ao_given] = args.render_settings.chosen_shading();
    // The triangles belong to the inputs of the command, not to files that are opened later.
    let (truth, own) = (args.truth.clone(), args.inputs.clone());
    Ok(Arc::new(move |request: &LoadRequest, window: &dyn viewer::LoadListener| {
        let names = &request.inputs;
        let reader = reader.filtered(&request.filter);
        let loaded = |model: Model, up: DVec3, suggestion: Option<Suggestion>| -> Result<Loaded> {
            let method = render::method(method, &model)?;
            let info = SceneInfo { names: names.iter().map(display_name).collect(), ..Default::default() };
            let suggested =
                suggestion.map(|Suggestion { name, map }| viewer::ColourBy { name, map, range: None });
            let colour_by = colour_by.clone().or(suggested);
            Ok(Loaded { colour_by, format, info, up, ..Loaded::new(model, method) })
        };
        let listener = WindowListener { window, loaded: &loaded, quiet: reader.quiet };
        let inputs = load(names, &reader.options, &listener)?;
        let truth = truth.as_deref().filter(|_| *names == own);
        let surface = surface::of_inputs(names, truth, &reader.options, &inputs);
        let suggested = if points { SuggestedShading::POINTS } else { inputs.shading() };
        let whole = loaded(inputs.model, inputs.up, inputs.suggestion)?;
        // Built-in scenes have no properties to read.
        let is_scene = names.iter().any(|name| scene(name).is_some());
        let own = names.clone();
        let read = move |name: &str, progress: &dyn Progress| reader.property(&own, name, progress);
        let skipped = if is_scene { vec![] } else { inputs.skipped };
        Ok(Loaded {
            surface,
            shading: (!shading_given).then_some(suggested.shading),
            ao: (!ao_given).then_some(suggested.ao),
            properties: Some(viewer::PointProperties { names: skipped, read: Arc::new(read) }),
            info: SceneInfo {
                points: inputs.read,
                dropped: inputs.dropped.total(),
                estimated: inputs.estimated.summary(),
                counts: inputs.counts,
                ..whole.info
            },
            ..whole
        })
    }))
}

/// Name of an input for the user.
fn display_name(name: &OsString) -> String {
    name.to_string_lossy().into_owned()
}

/// Forwards progress and previews to the window, and prints notes.
struct WindowListener<'a> {
    window: &'a dyn viewer::LoadListener,
    loaded: &'a (dyn Fn(Model, DVec3, Option<Suggestion>) -> Result<Loaded> + Sync),
    quiet: bool,
}

impl Progress for WindowListener<'_> {
    fn at(&self, stage: &'static str, done: u64, total: u64) {
        self.window.at(stage, done, total);
    }

    fn is_cancelled(&self) -> bool {
        self.window.is_cancelled()
    }
}

impl Listener for WindowListener<'_> {
    fn note(&self, text: &str) {
        if !self.quiet {
            progress::say(text);
        }
    }

    fn wants_preview(&self) -> bool {
        true
    }

    /// Forwards the preview. An error of it is one of the whole scene, too, which reports it.
    fn preview(&self, Preview { model, up, suggestion }: Preview) {
        (self.loaded)(model, up, suggestion).into_iter().for_each(|preview| self.window.preview(preview));
    }
}

/// Reads properties of inputs.
#[derive(Clone)]
struct Reader {
    options: LoadOptions,
    quiet: bool,
}

impl Reader {
    /// The reader of some of the points.
    fn filtered(&self, filter: &Filter) -> Self {
        let options = LoadOptions { filter: filter.clone(), ..self.options.clone() };
        Self { options, ..*self }
    }

    /// Reads a property of every surfel, and of every vertex of lines and triangles.
    fn property(&self, names: &[OsString], name: &str, progress: &dyn Progress) -> Result<[Vec<f32>; 2]> {
        let estimate = Estimate { radius: None, sharp: None, ..self.options.estimate.clone() };
        let options = LoadOptions {
            estimate,
            colouring: Some(Colouring::values(name)),
            counts: false,
            ..self.options.clone()
        };
        let Model { surfels, primitives } = load(names, &options, &Silent(progress))?.model;
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

    /// Records previews and stages, and cancels at a stage.
    #[derive(Default)]
    struct Window {
        previews: Mutex<Vec<usize>>,
        /// The stage at which it cancels.
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

    impl viewer::LoadListener for Window {
        fn preview(&self, loaded: viewer::Loaded) {
            self.previews.lock().unwrap().push(loaded.model.surfels.len());
        }
    }

    fn loaded(input: impl Into<OsString>, window: &Window) -> Result<viewer::Loaded> {
        let request = LoadRequest { inputs: vec![input.into()], ..Default::default() };
        let command = ["surfel", "view", "-q", "x.ply"];
        let Command::View(args) = Surfel::try_parse_from(command).unwrap().command else { panic!("no view") };
        loader(&args, None, None)?(&request, window)
    }

    #[test]
    fn errors_of_reading_name_the_input() {
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
    fn many_points_are_previewed_and_few_are_not() {
        let window = Window::default();
        let all = loaded("scene:sphere?points=120000", &window).unwrap();
        assert_eq!((all.model.surfels.len(), window.previews.into_inner().unwrap()), (120_000, vec![20_000]));
        let window = Window::default();
        loaded("scene:sphere?points=50000", &window).unwrap();
        assert!(window.previews.into_inner().unwrap().is_empty());
    }

    #[test]
    fn a_property_is_read_in_the_order_of_the_surfels_without_estimation() {
        let folder = tempfile::tempdir().unwrap();
        let names: Vec<OsString> = ["a.ply", "b.ply"].map(|name| folder.path().join(name).into()).to_vec();
        for (file, name) in names.iter().enumerate() {
            let mut text = String::from(
                "ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nproperty float y\nproperty float z\nproperty float heat\nend_header\n",
            );
            for i in 0..900 {
                let x = (i * 7919 % 900) as f32 / 3.0 + 400.0 * file as f32;
                text += &format!("{x} {} 0 {x}\n", i % 31);
            }
            std::fs::write(name, text).unwrap();
        }
        let command = ["surfel", "view", "-q", "--color-by", "heat", "--color-map", "magma", "x.ply"];
        let Command::View(args) = Surfel::try_parse_from(command).unwrap().command else { panic!("no view") };
        let load = loader(&args, None, None).unwrap();
        for inputs in [&names[..1], &names[..]] {
            let request = LoadRequest { inputs: inputs.to_vec(), ..Default::default() };
            let loaded = load(&request, &Window::default()).unwrap();
            let by = loaded.colour_by.unwrap();
            assert_eq!((by.name.as_str(), by.map), ("heat", surfel::geometry::ColourMap::Magma));
            assert!(loaded.model.surfels.colours.is_none(), "the panel colours them");
            assert!(loaded.info.estimated.is_some() && loaded.info.points == 900 * inputs.len() as u64);
            let properties = loaded.properties.unwrap();
            assert_eq!(properties.names, ["heat"]);
            let window = Window::default();
            let [heat, _] = (properties.read)("heat", &window).unwrap();
            let surfels = loaded.model.surfels;
            assert_eq!(heat.len(), surfels.len());
            let xs = surfels.positions.iter().map(|p| (surfels.origin + p.as_dvec3()).x as f32);
            assert!(xs.zip(&heat).all(|(x, heat)| (x - heat).abs() < 1e-3));
            let stages = window.stages.into_inner().unwrap();
            assert!(stages.iter().all(|stage| *stage == "reading"), "{stages:?}");
        }
    }

    #[test]
    fn loading_is_cancelled_while_reading_and_while_estimating() {
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
            let cancelled = loaded(&path, &window);
            assert!(matches!(cancelled, Err(Error::Cancelled)), "{until}");
            assert_eq!(window.stages.into_inner().unwrap().last(), Some(&last), "{until}");
        }
        assert_eq!(loaded(&path, &Window::default()).unwrap().model.surfels.len(), count);
    }
}
