//! Outputs of `surfel render`: pictures, camera and report.

use super::{Outcome, Task, keep_layers};
use crate::cli::args::Render;
use crate::cli::report::Report;
use crate::cli::{files, reference, turntable, vulkan};
use glam::DVec3;
use surfel::formats::atomic;
use surfel::formats::camera as camera_file;
use surfel::formats::colour_bar::{ColourBar, write_with};
use surfel::formats::image::Output;
use surfel::load::LoadedModel;
use surfel::vk::DeviceOptions;
use surfel::{Error, Picture, Result};

/// The pictures of a command.
pub struct Pictures<'a> {
    /// The options.
    pub args: &'a Render,
    /// The file of the first picture.
    pub out: &'a Output,
    /// The colour bar, if there is one.
    pub bar: Option<&'a ColourBar>,
    /// The first picture's task.
    pub task: &'a Task<'a>,
    /// The device, unless the reference renders.
    pub device: &'a DeviceOptions,
}

impl Pictures<'_> {
    /// Writes the first picture, whose folder is created for a turntable.
    pub fn write_first(&self, picture: &mut Picture) -> Result<()> {
        if let Some(folder) = turntable::folder(self.args, self.out) {
            atomic::create_folder(&folder, "cannot write")?;
        }
        self.write(picture, self.out)
    }

    /// Renders and writes the other pictures of a turntable, if it is one: a turn about the axis `up` through `middle`.
    pub fn write_turn(&self, middle: DVec3, up: DVec3) -> Result<()> {
        let Self { args, task, device, .. } = *self;
        let Some((count, pattern)) = args.turntable.zip(turntable::pattern(args)?) else { return Ok(()) };
        let cameras = turntable::cameras(&task.camera, middle, up, count);
        let others = &cameras[1..];
        let save = |number: usize, mut picture: Picture| {
            self.write(&mut picture, &Output::parse(&pattern.file(number as u32 + 1)))
        };
        if args.backend.reference {
            reference::turn(task, others, save)
        } else {
            vulkan::turn(task, device, &args.backend, others, save)
        }
    }

    /// Writes a picture, to an EXR with the layers of the options alone.
    fn write(&self, picture: &mut Picture, out: &Output) -> Result<()> {
        if !out.is_png() {
            keep_layers(picture, self.task.layers);
        }
        write_with(picture, self.task.settings.shading, self.bar, out)
    }
}

/// Writes the camera and the report, if they are wanted.
pub fn write_texts(args: &Render, loaded: &LoadedModel, task: &Task<'_>, outcome: &Outcome) -> Result<()> {
    if let Some(output) = &args.save_camera {
        files::write_text(output, &camera_file::text(&task.pose))?;
    }
    if let Some(output) = &args.json {
        files::write_text(output, &Report::new(args, loaded, task, outcome)?.to_json()?)?;
    }
    Ok(())
}

/// Checks that the outputs can be written, and that report and camera overwrite no other file.
pub fn check(args: &Render, out: &Output) -> Result<()> {
    match turntable::folder(args, out).filter(|folder| !folder.exists()) {
        Some(folder) => {
            out.check_name()?;
            atomic::check_folder(&folder)?;
        }
        None => out.check()?,
    }
    if out.is_png() && !args.layers.is_empty() {
        return Err(Error::Usage("--layers are written to EXR alone: name the picture .exr".into()));
    }
    let given = || std::iter::once(&args.output).chain(&args.inputs);
    if let Some(json) = &args.json {
        turntable::check_file(args, out, json)?;
        files::check_distinct("--json", json, given())?;
    }
    let Some(camera) = &args.save_camera else { return Ok(()) };
    turntable::check_file(args, out, camera)?;
    files::check_distinct("--save-camera", camera, given().chain(&args.json))
}
