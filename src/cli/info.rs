//! `surfel info`.

mod bounds;
mod counts;
mod input;
mod value;

use super::args::Info;
use super::files::print;
use super::progress;
use input::Input;
use std::ffi::OsStr;
use std::fmt::Write;
use std::path::Path;
use surfel::estimate::{Estimated, spacing};
use surfel::formats::declared::{Element, Kind};
use surfel::formats::{self, Dropped, Faces, Inspected, Lines, ReadOptions, Report};
use surfel::geometry::{Cloud, Colours, Model, Surfels, View};
use surfel::load::{check_filter, check_points, scene};
use surfel::{Result, thousands};

/// Number of names of skipped elements that are printed; the header lists all of them.
const MOST_NAMES: usize = 8;

/// Prints the contents of files and scenes. If the points of one cannot be used, prints what its header declares and fails with the cause.
pub fn run(args: &Info) -> Result<()> {
    let inputs: Vec<&OsStr> = args.inputs.iter().map(AsRef::as_ref).collect();
    check_points(&inputs, args.points.points)?;
    check_filter(&inputs, &args.points.filter())?;
    if args.json {
        return value::run(args);
    }
    inputs.into_iter().try_for_each(|input| match scene(input) {
        Some(name) => scene_text(name, args),
        None => file_text(Path::new(input), args),
    })
}

/// Prints the contents of a file.
fn file_text(path: &Path, args: &Info) -> Result<()> {
    let bars = progress::bars(false);
    let Inspected { format, encoding, elements, loaded } =
        formats::inspect(path, &read_options(args), &*bars)?;
    drop(bars);
    print(&header(path, &format!("{format}, {encoding}"), &elements))?;
    let mut loaded = loaded?;
    let report = loaded.report.clone();
    let counts = counts::text(&std::mem::take(&mut loaded.attributes));
    print(&(properties(&report) + &counts + &connectivity(&report, &loaded.cloud)))?;
    let (text, estimated) = Input::of_file(path, loaded, args).text(args)?;
    print(&(text + &dropped(report.dropped, estimated.as_ref()) + &stated(&report) + &trailing(&report)))
}

/// Prints the contents of a built-in scene.
fn scene_text(name: &str, args: &Info) -> Result<()> {
    let (text, estimated) = Input::of_scene(name)?.text(args)?;
    let dropped = dropped(Dropped::default(), estimated.as_ref());
    print(&format!("{name}: built-in scene\n{text}{dropped}"))
}

/// What is read of a file.
fn read_options(args: &Info) -> ReadOptions {
    ReadOptions {
        columns: args.points.columns.clone(),
        filter: args.points.filter(),
        min_points: args.points.points,
        triangles: args.points.polygons,
        attributes: counts::wanted(),
        ..Default::default()
    }
}

/// Describes the header of a file.
fn header(path: &Path, format: &str, elements: &[Element]) -> String {
    let mut text = format!("{}: {format}\n", path.display());
    for element in elements {
        let (name, count) = (printable(&element.name), thousands(element.count));
        // Here and below: writing to a String cannot fail.
        let _ = writeln!(text, "element {name}: {count}");
        for property in &element.properties {
            let _ = writeln!(text, "  {} {}", property.kind, printable(&property.name));
        }
    }
    text
}

/// A name of the file without control characters, which must not reach the terminal.
fn printable(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// The first `most` names, and the number of the others.
fn listed(names: &[String], most: usize) -> String {
    let text = names.iter().take(most).map(|name| printable(name)).collect::<Vec<_>>().join(" ");
    match names.len().saturating_sub(most) {
        0 if names.is_empty() => "none".into(),
        0 => text,
        more => format!("{text} and {more} more"),
    }
}

/// Lists the properties that are understood and those that points can be coloured by.
fn properties(report: &Report) -> String {
    let is_list = |name: &&String| {
        let mut all = report.elements.iter().flat_map(|element| &element.properties);
        all.any(|property| property.name == **name && matches!(property.kind, Kind::List { .. }))
    };
    let (lists, numbers): (Vec<&String>, Vec<&String>) = report.skipped.iter().partition(is_list);
    let numbers: Vec<String> = numbers.into_iter().map(|name| printable(name)).collect();
    let lists: Vec<String> = lists.into_iter().cloned().collect();
    let mut text = String::new();
    for (name, value) in &report.details {
        let _ = writeln!(text, "{name}: {}", printable(value));
    }
    let _ = writeln!(text, "understood: {}", listed(&report.understood, usize::MAX));
    let numbers = if numbers.is_empty() { "none".into() } else { numbers.join(", ") };
    let _ = writeln!(text, "for --color-by, beside x, y, z, height, radius and normal: {numbers}");
    if !lists.is_empty() {
        let _ = writeln!(text, "skipped: {}", listed(&lists, usize::MAX));
    }
    let _ = writeln!(text, "skipped elements: {}", listed(&report.skipped_elements, MOST_NAMES));
    text
}

/// Describes the elements of a model, with the radii of lines and triangles.
fn elements_text(Model { surfels, primitives }: &Model) -> String {
    let count = |count: usize| thousands(count as u64);
    let mut text = format!("surfels: {}\n", count(surfels.len()));
    if !primitives.is_empty() {
        let [ribbons, tubes] = [primitives.ribbons.len(), primitives.tubes.len()].map(count);
        let [triangles, vertices] = [primitives.triangles.len(), primitives.len()].map(count);
        let _ = writeln!(text, "ribbons: {ribbons}\ntubes: {tubes}\ndrawn triangles: {triangles}");
        let _ = writeln!(text, "vertices of these: {vertices}, {}", range_text(&primitives.radii));
    }
    text
}

/// Describes distances and radii of surfels.
fn sizes(surfels: &Surfels) -> String {
    let spacing = spacing(&surfels.positions).map_or(String::new(), |spacing| {
        format!("spacing: {spacing}, the median distance to the nearest point\n")
    });
    spacing + &if surfels.is_empty() { String::new() } else { range_text(&surfels.radii) + "\n" }
}

/// Describes colours.
fn colours_text(colours: Option<&Colours>) -> &'static str {
    match colours {
        None => "colours: none\n",
        Some(Colours::Srgb8(_)) => "colours: sRGB, 8 bits\n",
        Some(Colours::Linear(_)) => "colours: linear, float\n",
    }
}

/// Minimum, maximum and median of radii; `None` if there are none.
fn range(radii: &[f32]) -> Option<[f32; 3]> {
    let mut radii = radii.to_vec();
    radii.sort_unstable_by(f32::total_cmp);
    Some([*radii.first()?, *radii.last()?, radii[radii.len() / 2]])
}

/// Describes the range of radii.
fn range_text(radii: &[f32]) -> String {
    range(radii)
        .map_or(String::new(), |[min, max, median]| format!("radius: {min} to {max}, median {median}"))
}

/// Describes origin, scanner position and connectivity of the points.
fn connectivity(report: &Report, cloud: &Cloud) -> String {
    let mut text = String::new();
    if report.gaussians {
        text += "kind: 3D Gaussians, as discs\n";
    }
    if cloud.origin != glam::DVec3::ZERO {
        let _ = writeln!(text, "origin: {}", cloud.origin);
    }
    match cloud.view {
        View::Unknown => {}
        View::From(eye) => {
            let _ = writeln!(text, "seen from: {}", cloud.origin + eye.as_dvec3());
        }
        View::Towards(direction) => {
            let _ = writeln!(text, "seen from: far away along {direction}");
        }
    }
    if let Some(viewpoints) = &cloud.viewpoints {
        let known = viewpoints.views.iter().filter(|view| **view != View::Unknown).count();
        let _ = writeln!(
            text,
            "seen from: {} of {} scans",
            thousands(known as u64),
            thousands(viewpoints.views.len() as u64)
        );
    }
    let Faces { understood, skipped } = report.faces;
    if understood + skipped > 0 {
        let [understood, skipped] = [understood, skipped].map(thousands);
        let _ = writeln!(text, "faces: {understood} understood, {skipped} skipped");
    }
    let Lines { understood, skipped, sides } = report.lines;
    if understood + skipped + sides > 0 {
        let [understood, skipped, sides] = [understood, skipped, sides].map(thousands);
        let _ = writeln!(text, "lines: {understood} understood, {skipped} skipped, {sides} sides of faces");
    }
    if !cloud.triangles.is_empty() {
        let _ = writeln!(text, "triangles: {}", thousands(cloud.triangles.len() as u64));
    }
    text
}

/// Numbers of points, and what they are of: those above 0.
fn list(counts: &[(u64, &str)]) -> String {
    let some = counts.iter().filter(|(count, _)| *count > 0);
    some.map(|(count, what)| format!("{} {what}", thousands(*count))).collect::<Vec<_>>().join(", ")
}

/// Describes where normals and radii come from.
fn sources(estimated: &Estimated) -> String {
    let normals = list(&[
        (estimated.normals_given, "given"),
        (estimated.normals_from_faces, "from faces"),
        (estimated.normals_from_neighbours, "from neighbours"),
        (estimated.two_sided, "two-sided"),
        (estimated.scattered, "unlike their neighbours'"),
        (estimated.billboards, "facing the eye"),
    ]);
    let radii = list(&[
        (estimated.radii_given, "given"),
        (estimated.radii_from_faces, "from faces"),
        (estimated.radii_from_neighbours, "from neighbours"),
    ]);
    let lines = list(&[
        (estimated.line_radii_given, "given"),
        (estimated.line_radii_from_lines, "from others of the line"),
        (estimated.line_radii_from_extent, "from the lines' extent"),
    ]);
    let lines = if lines.is_empty() { lines } else { format!("radii of lines: {lines}\n") };
    let scanner = match estimated.scanner_found {
        0 => String::new(),
        count => format!(
            "scanner: 0,0,0, as the directions of {} points from there are a grid\n",
            thousands(count)
        ),
    };
    format!("{scanner}normals: {normals}\nradii: {radii}\n{lines}")
}

/// Describes the points that are left out, also by an estimation.
fn dropped(
    Dropped { position, transparent, thinned, filtered }: Dropped,
    estimated: Option<&Estimated>,
) -> String {
    let by = |count: u64, what: &str| {
        if count > 0 { format!(", {} {what}", thousands(count)) } else { String::new() }
    };
    let of_estimation = estimated.map_or(String::new(), |Estimated { unused, outliers, .. }| {
        let [unused, outliers] = [*unused, *outliers].map(thousands);
        format!(", {unused} that no face uses, {outliers} outliers")
    });
    let [position, transparent] = [position, transparent].map(thousands);
    let (thinned, filtered) = (by(thinned, "by thinning"), by(filtered, "by the filter"));
    format!(
        "left out: {position} without a finite position, {transparent} less than a tenth opaque{of_estimation}{thinned}{filtered}\n"
    )
}

/// Names another number of points that the file states, if it does.
fn stated(report: &Report) -> String {
    report.stated.map_or(String::new(), |points| {
        format!("states: {} points; it may be cut or edited\n", thousands(points))
    })
}

/// Describes trailing bytes, if there are any.
fn trailing(report: &Report) -> String {
    match report.trailing {
        0 => String::new(),
        bytes => format!("after the last element: {} bytes that mean nothing\n", thousands(bytes)),
    }
}
