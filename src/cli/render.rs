//! `surfel render`.

mod outputs;

use super::args::{ColorBar, PassTimes, Render};
use super::camera::{self, Room};
use super::cut::{self, Cut};
use super::report::{Gpu, HalfError};
use super::{progress, reference, summary, turntable, undrawn, vulkan};
use outputs::Pictures;
use std::path::Path;
use surfel::embed::Measured;
use surfel::estimate::Estimate;
use surfel::formats::colour_bar::ColourBar;
use surfel::formats::image::Output;
use surfel::frame::times::Times;
use surfel::geometry::{Camera, Extent, Levels, Model, Parts, Pose, SurfelFormat};
use surfel::load::{Coloured, Colouring, LoadOptions, LoadedModel, SuggestedShading, Uncoloured, load};
use surfel::settings::methods::{Method, pull_push};
use surfel::settings::{Hierarchy, Shading};
use surfel::vk::DeviceOptions;
use surfel::{Error, Outputs, Picture, Progress, Result, Settings, SplatCounts, thousands};

/// A picture to render, with Vulkan or the reference.
pub struct Task<'a> {
    /// The scene, of the camera's cut if there is an octree.
    pub scene: Parts<'a>,
    /// The octree that every camera has its own cut of, if there is one.
    pub cut: Option<&'a Cut>,
    /// The method, without the changes of its axes.
    pub method: Method,
    /// The camera.
    pub camera: Camera,
    /// Its pose.
    pub pose: Pose,
    /// The render settings.
    pub settings: Settings,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Additional images to write.
    pub layers: Outputs,
    /// Number of frames, at least 1.
    pub frames: u32,
    /// Whether frames whose stages are passes of their own are rendered beside.
    pub split: bool,
    /// Receives the progress.
    pub progress: &'a dyn Progress,
}

/// A rendered picture.
pub struct Outcome {
    /// The picture.
    pub picture: Picture,
    /// Counts of surfels by cull reason, if they were counted.
    pub counts: Option<SplatCounts>,
    /// Times of the frames.
    pub times: Times,
    /// Times of frames whose stages are passes of their own, if they were rendered beside.
    pub split: Option<Times>,
    /// The device and its resources; `None` for the reference.
    pub gpu: Option<Gpu>,
}

/// Renders inputs to a picture. Arguments, outputs and inputs are checked before the device is opened, cheap checks first.
pub fn run(args: &Render) -> Result<()> {
    let out = turntable::first(args)?;
    outputs::check(args, &out)?;
    let asked = args.method()?;
    let first = args.settings(&asked.unwrap_or(Method::ALL[0]));
    first.check()?;
    if has_octree(args) {
        cut::check(&first)?;
    }
    let device = vulkan::options(&args.backend.device)?;
    let file = camera::read(&args.camera)?;
    let options = load_options(args, &first, file, &out)?;
    let bars = progress::bars(args.quiet);
    let mut loaded = load(&args.inputs, &options, &*bars)?;
    let method = method(asked, &loaded.model)?;
    let settings = settings(args, &method, &loaded)?;
    print_assumptions(args, file, &settings, &loaded);
    let Framed { extent, pose, camera, bar } = framed(args, file, &loaded, settings.shading, &out)?;
    let backs = undrawn::culled_backs(&loaded.model.surfels, &camera, &settings);
    backs.iter().filter(|_| !args.quiet).for_each(|note| progress::say(note));
    let contents = summary::parts(&loaded.model);
    let (cut, levels) = hierarchy(args, &settings, &mut loaded.model, &camera, &*bars)?;
    let scene = parts(&loaded.model, levels.as_ref(), SurfelFormat::quantized(args.backend.quantize));
    let (layers, size, frames, progress) = (args.outputs(), args.size, args.frames, &*bars);
    let (cut, split) = (cut.as_ref(), args.times == Some(PassTimes::Split));
    let task = Task { scene, cut, method, camera, pose, settings, size, layers, frames, split, progress };
    let mut outcome = render(args, &task, &device)?;
    if backs.is_none() {
        warn_if_empty(args, &outcome.picture, &task, &extent);
    }
    let pictures = Pictures { args, out: &out, bar: bar.as_ref(), task: &task, device: &device };
    pictures.write_first(&mut outcome.picture)?;
    pictures.write_turn(extent.centre(), loaded.up)?;
    outputs::write_texts(args, &loaded, &task, &outcome)?;
    print_summary(args, &contents, &outcome);
    Ok(())
}

/// Whether surfels are drawn by the cut of an octree.
fn has_octree(args: &Render) -> bool {
    args.render_settings.hierarchy == Hierarchy::Paper
}

/// The options of loading for a method with these settings.
fn load_options(
    args: &Render,
    settings: &Settings,
    file: Option<(&Path, Pose)>,
    out: &Output,
) -> Result<LoadOptions> {
    let colouring = args.colours.colouring()?;
    check_colours(args, colouring.as_ref(), out)?;
    Ok(LoadOptions {
        columns: args.points.columns.clone(),
        filter: args.points.filter(),
        estimate: Estimate { bare: settings.draws_points(), ..args.points.estimate() },
        polygons: args.points.polygons,
        points: args.points.points,
        colouring,
        uncoloured: args.colours.uncoloured(Uncoloured::Colour),
        up: camera::up(&args.camera, file),
        texture: args.colours.texture()?,
        ..Default::default()
    })
}

/// The settings of a method, with the shading and ambient occlusion that the model suggests where none is given.
fn settings(args: &Render, method: &Method, loaded: &LoadedModel) -> Result<Settings> {
    let [shading_given, ao_given] = args.render_settings.chosen_shading();
    let settings = args.settings(method);
    let suggested = if settings.draws_points() { SuggestedShading::POINTS } else { loaded.shading() };
    let settings = Settings {
        shading: if shading_given { settings.shading } else { suggested.shading },
        ao: if ao_given { settings.ao } else { suggested.ao },
        ..settings
    };
    settings.check()?;
    settings.check_outputs(args.outputs())?;
    Ok(settings)
}

/// Prints what is assumed of inputs that do not tell, unless the program is quiet.
fn print_assumptions(args: &Render, file: Option<(&Path, Pose)>, settings: &Settings, loaded: &LoadedModel) {
    if args.quiet {
        return;
    }
    let [shading_given, ao_given] = args.render_settings.chosen_shading();
    let points = settings.draws_points();
    let input = args.inputs.first().map_or(Path::new(""), Path::new);
    let given = summary::Given {
        up: camera::up(&args.camera, file).is_some(),
        shading: shading_given || points,
        ao: ao_given || points,
    };
    summary::assumptions(input, given, loaded).iter().for_each(|line| progress::say(line));
}

/// The camera of the picture, with the colour bar beside the scene.
struct Framed {
    extent: Extent,
    pose: Pose,
    camera: Camera,
    bar: Option<ColourBar>,
}

/// The camera of the options, which by default frames the model, or all of its turn.
fn framed(
    args: &Render,
    file: Option<(&Path, Pose)>,
    loaded: &LoadedModel,
    shading: Shading,
    out: &Output,
) -> Result<Framed> {
    let extent = Extent::of(&loaded.model);
    let extent = extent.ok_or_else(|| undrawn::nothing(&names(args), &loaded.model))?;
    let turned = args.turntable.map(|_| extent.turned_about(extent.centre(), loaded.up));
    let bar = colour_bar(args, loaded.coloured.as_ref(), shading, out)?;
    let bar_width = bar.as_ref().map_or(0, |bar| bar.width(args.size));
    let room = Room { bar: bar_width, ..Room::whole(args.size) };
    let (pose, camera) =
        camera::make(&args.camera, file, turned.as_ref().unwrap_or(&extent), loaded.up, room)?;
    Ok(Framed { extent, pose, camera, bar })
}

/// Moves the surfels of the model to the octree or the levels of detail that the options choose, if any. With an octree the model gets the
/// camera's cut.
fn hierarchy(
    args: &Render,
    settings: &Settings,
    model: &mut Model,
    camera: &Camera,
    progress: &dyn Progress,
) -> Result<(Option<Cut>, Option<Levels>)> {
    if has_octree(args) {
        let cut = Cut::new(std::mem::take(&mut model.surfels), settings, args.size, progress)?;
        model.surfels = cut.surfels(camera)?;
        return Ok((Some(cut), None));
    }
    let has_levels = settings.lod > 0.0 || settings.max_points.is_some();
    let levels = has_levels.then(|| Levels::of(std::mem::take(&mut model.surfels))).transpose()?;
    Ok((None, levels))
}

/// Renders the picture, with Vulkan or the reference.
fn render(args: &Render, task: &Task<'_>, device: &DeviceOptions) -> Result<Outcome> {
    if args.backend.reference {
        return reference::render(task);
    }
    let counts = args.json.is_some();
    let wanted = Measured { times: counts || args.times.is_some(), counts };
    vulkan::render(task, device, &args.backend, wanted)
}

/// Warns if the picture shows next to nothing, with the cause.
fn warn_if_empty(args: &Render, picture: &Picture, task: &Task<'_>, extent: &Extent) {
    if let Some(warning) = undrawn::empty_picture(picture, task, &extent.bounds(), &given(args)) {
        log::warn!("{warning}");
    }
}

/// The inputs, in words.
fn names(args: &Render) -> String {
    let names: Vec<String> = args.inputs.iter().map(|input| input.display().to_string()).collect();
    names.join(", ")
}

/// The options that may be the cause of an empty picture.
fn given(args: &Render) -> undrawn::Given {
    let of = |options: &[(bool, &'static str)]| -> Vec<&'static str> {
        options.iter().filter(|(is_given, _)| *is_given).map(|(_, name)| *name).collect()
    };
    let (camera, points) = (&args.camera, &args.points);
    undrawn::Given {
        camera: of(&[
            (camera.file.is_some(), "--camera"),
            (camera.eye.is_some(), "--eye"),
            (camera.target.is_some(), "--target"),
        ]),
        radius: of(&[(points.radius.is_some(), "--radius"), (points.radius_scale != 1.0, "--radius-scale")])
            .pop(),
        several: args.inputs.len() > 1,
    }
}

/// The chosen method, or else the default one for the model. Fails if the method cannot render the model.
pub fn method(asked: Option<Method>, model: &Model) -> Result<Method> {
    let splats = model.primitives.is_empty();
    match asked {
        Some(method) if !splats && method.pull_push.is_none() => Err(Error::Usage(format!(
            "--method {} draws points alone, and the inputs have {}: leave it out, or give --method {}",
            method.name,
            summary::parts(model),
            pull_push::METHOD.name
        ))),
        Some(method) => Ok(method),
        None => Ok(if splats { Method::ALL[0] } else { pull_push::METHOD }),
    }
}

/// The colour bar of the picture, if it gets one.
fn colour_bar(
    args: &Render,
    coloured: Option<&Coloured>,
    shading: Shading,
    out: &Output,
) -> Result<Option<ColourBar>> {
    let bar = coloured.filter(|_| shading.is_coloured()).and_then(Coloured::bar);
    match args.color_bar {
        ColorBar::Off => Ok(None),
        ColorBar::Auto => Ok(bar.filter(|_| out.is_png() && ColourBar::check(args.size).is_ok())),
        ColorBar::On if coloured.is_none() => Err(Error::Usage(
            "--color-bar has no values to show, since the points have colours of their own: add --color-by"
                .into(),
        )),
        ColorBar::On => Ok(bar),
    }
}

/// Drops the images of a picture that are not among `layers`.
pub fn keep_layers(picture: &mut Picture, layers: Outputs) {
    picture.normal.take_if(|_| !layers.normal);
    picture.depth.take_if(|_| !layers.depth);
    picture.id.take_if(|_| !layers.id);
}

/// Fails if the shading does not show the colours, or if the colour bar cannot be drawn or has no values.
fn check_colours(args: &Render, colouring: Option<&Colouring>, out: &Output) -> Result<()> {
    let refuse = |text: &str| Err(Error::Usage(text.into()));
    let is_visible = args.render_settings.shading.is_none_or(Shading::is_coloured);
    if !is_visible && colouring.is_some() {
        return refuse("--color-by is visible with --shading lit or color only: choose one of them");
    }
    if args.color_bar != ColorBar::On {
        Ok(())
    } else if !is_visible {
        refuse("--color-bar belongs to --shading lit, color and edl: choose one of them, or leave it out")
    } else if !out.is_png() {
        refuse("--color-bar is drawn into a PNG alone: name the picture .png")
    } else if colouring.is_some_and(|colouring| !colouring.has_values()) {
        refuse("--color-bar has no values for normals: leave it out")
    } else {
        ColourBar::check(args.size)
    }
}

/// Passes that do several stages, and the passes of these stages in split frames.
const FUSED: [(&[&str], &[&str], &str); 2] = [
    (
        &["surface"],
        &["visibility", "attribute", "normalize"],
        "surface / (visibility + attribute + normalize)",
    ),
    (&["push", "shade"], &["push", "shade"], "push and shade with level 0 in shade / in push"),
];

/// The time of the passes that do several stages over that of the stages apart, in words.
fn ratio(fused: &Times, split: &Times) -> String {
    let sum = |times: &Times, names: &[&str]| -> f64 {
        let wanted = times.passes().filter(|(label, _)| names.contains(label));
        wanted.map(|(_, statistics)| statistics.median).sum()
    };
    let sums = FUSED.map(|(together, apart, name)| (sum(fused, together), sum(split, apart), name));
    match sums.into_iter().find(|(together, apart, _)| *together > 0.0 && *apart > 0.0) {
        Some((together, apart, name)) => format!("{name}: {:.2}", together / apart),
        None => "the device has no timestamps, or the method has no such stages".into(),
    }
}

/// Prints the summary to standard error; standard output is left to the picture.
fn print_summary(args: &Render, contents: &str, outcome: &Outcome) {
    if args.times.is_some() {
        if let Some(Gpu { description, usage, .. }) = &outcome.gpu {
            progress::say(&format!(
                "{} ({}), {} pipelines made",
                description.name, description.driver, usage.pipelines
            ));
        }
        progress::say(outcome.times.to_string().trim_end());
        if let Some(split) = &outcome.split {
            progress::say(split.to_string().trim_end());
            progress::say(&ratio(&outcome.times, split));
        }
    }
    if let Some(HalfError { largest, rms }) = outcome.gpu.as_ref().and_then(|gpu| gpu.half_error) {
        progress::say(&format!(
            "16-bit floats: linear colour is off by {largest:.1e} at most, {rms:.1e} RMS"
        ));
    }
    if !args.quiet {
        let [width, height] = args.size;
        let drawn = outcome
            .counts
            .map(|counts| format!(", {} drawn", thousands(counts.drawn.into())))
            .unwrap_or_default();
        let out = Path::new(&args.output).display();
        progress::say(&format!("{out}: {width}x{height}, {contents}{drawn}"));
    }
}

/// The scene, with its levels of detail if there are any.
fn parts<'a>(model: &'a Model, levels: Option<&'a Levels>, format: SurfelFormat) -> Parts<'a> {
    let model = Parts { format, ..model.into() };
    match levels {
        Some(Levels { surfels, table }) => Parts { surfels, levels: Some(table), ..model },
        None => model,
    }
}
