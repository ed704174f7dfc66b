//! `surfel info`.

use super::files::print;
use super::inputs::scene;
use std::ffi::OsString;
use std::fmt::Write;
use std::path::Path;
use surfel::geometry::estimate::Estimate;
use surfel::geometry::{Colours, Surfels};
use surfel::io::ply::{self, Element, Format, Loaded, ReadOptions, Report};
use surfel::{Error, Result, scenes};

/// Says what is in a file or scene. Of a file whose points cannot be drawn it tells what there is, and the error why.
pub fn run(input: &OsString) -> Result<()> {
    if let Some(name) = scene(input) {
        let surfels = scenes::open(name)?;
        return print(&format!("{name}: built-in scene\n{}", describe(&surfels, surfels.len() as u64)));
    }
    let path = Path::new(input);
    let ply::Inspected { format, elements, loaded } = ply::inspect(path, &ReadOptions::default(), &())?;
    print(&header(path, format, &elements))?;
    let Loaded { cloud, report } = loaded?;
    let surfels = cloud.into_surfels(&Estimate::default(), &());
    let (surfels, _) = surfels.map_err(|cause| Error::input(path.display().to_string(), cause))?;
    print(&(properties(&report) + &describe(&surfels, report.points) + &dropped(&report)))
}

/// What a file declares.
fn header(path: &Path, format: Format, elements: &[Element]) -> String {
    let mut text = format!("{}: PLY, {format}\n", path.display());
    for element in elements {
        let (name, count) = (shown(&element.name), element.count);
        // Here and below: writing to a String cannot fail.
        let _ = writeln!(text, "element {name}: {count}");
        for property in &element.properties {
            let _ = writeln!(text, "  {} {}", property.kind, shown(&property.name));
        }
    }
    text
}

/// Names come from the file: one that holds control characters must not reach the terminal.
fn shown(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

fn properties(report: &Report) -> String {
    let list = |names: &[String]| match names.is_empty() {
        true => "none".to_owned(),
        false => names.iter().map(|name| shown(name)).collect::<Vec<_>>().join(" "),
    };
    format!("understood: {}\nskipped: {}\n", list(&report.understood), list(&report.skipped))
}

fn describe(surfels: &Surfels, points: u64) -> String {
    let mut text = format!("points: {points}\nsurfels: {}\n", surfels.len());
    if let Some(bounds) = surfels.bounds() {
        let _ = writeln!(text, "bounds: {} to {}", bounds.min, bounds.max);
    }
    let mut radii = surfels.radii.clone();
    radii.sort_unstable_by(f32::total_cmp);
    if let (Some(min), Some(max)) = (radii.first(), radii.last()) {
        let _ = writeln!(text, "radius: {min} to {max}, median {}", radii[radii.len() / 2]);
    }
    let colours = match &surfels.colours {
        None => "none",
        Some(Colours::Srgb8(_)) => "sRGB, 8 bits",
        Some(Colours::Linear(_)) => "linear, float",
    };
    let _ = writeln!(text, "colours: {colours}");
    text
}

fn dropped(report: &Report) -> String {
    format!("left out: {} without a finite position\n", report.dropped.position)
}
