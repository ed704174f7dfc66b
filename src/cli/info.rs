//! `surfel info`.

mod bounds;
mod counts;
mod value;

use super::args::Info;
use super::files::print;
use super::progress;
use std::fmt::Write;
use std::path::Path;
use surfel::estimate::{Estimate, Estimated, spacing};
use surfel::formats::declared::Element;
use surfel::formats::{self, Dropped, Faces, Inspected, Lines, Loaded, ReadOptions, Report};
use surfel::geometry::{Cloud, Colours, Model, View};
use surfel::load::{check_filter, check_points, scene, scene_cloud};
use surfel::{Result, thousands};

/// Number of skipped names that are printed; the header lists all of them.
const MOST_NAMES: usize = 8;

/// Prints the contents of a file or scene. If its points cannot be rendered, prints what the header declares and fails with the cause.
pub fn run(args: &Info) -> Result<()> {
    check_points(&[args.input.as_ref()], args.points.points)?;
    check_filter(&[args.input.as_ref()], &args.points.filter())?;
    if args.json {
        return value::run(args);
    }
    if let Some(name) = scene(&args.input) {
        return scene_text(name, &args.points.estimate()).and_then(|text| print(&text));
    }
    let path = Path::new(&args.input);
    let bars = progress::bars(false);
    let Inspected { format, encoding, elements, loaded } =
        formats::inspect(path, &read_options(args), &*bars)?;
    print(&header(path, &format!("{format}, {encoding}"), &elements))?;
    let Loaded { cloud, report, attributes } = loaded?;
    print(&(properties(&report) + &counts::text(&attributes) + &connectivity(&report, &cloud)))?;
    let bounds = bounds_text(&cloud);
    let model = kept(cloud, args).into_model(args.points.polygons, &args.points.estimate(), &*bars);
    let (model, estimated) = model.map_err(|error| error.in_input(path.display().to_string()))?;
    drop(bars);
    let text = describe(&model, report.points, &bounds) + &sources(&estimated);
    print(&(text + &dropped(report.dropped, &estimated) + &stated(&report) + &trailing(&report)))
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

/// The points of a file that are kept.
fn kept(cloud: Cloud, args: &Info) -> Cloud {
    args.points.points.map(|points| cloud.some(points as usize)).unwrap_or(cloud)
}

/// Describes a built-in scene under these options.
fn scene_text(name: &str, how: &Estimate) -> Result<String> {
    let cloud = scene_cloud(name)?;
    let (points, bounds) = (cloud.len() as u64, bounds_text(&cloud));
    let model = cloud.into_model(true, how, &());
    let (model, estimated) = model.map_err(|error| error.in_input(name))?;
    let dropped = dropped(Dropped::default(), &estimated);
    Ok(format!(
        "{name}: built-in scene\n{}{}{dropped}",
        describe(&model, points, &bounds),
        sources(&estimated)
    ))
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

/// Lists the properties that are understood and those that are skipped.
fn properties(report: &Report) -> String {
    // Only a few properties are ever understood.
    let (understood, skipped) = (listed(&report.understood, usize::MAX), listed(&report.skipped, MOST_NAMES));
    let mut text = String::new();
    for (name, value) in &report.details {
        let _ = writeln!(text, "{name}: {}", printable(value));
    }
    text + &format!(
        "understood: {understood}\nskipped: {skipped}\nskipped elements: {}\n",
        listed(&report.skipped_elements, MOST_NAMES)
    )
}

/// Describes the bounds of the points, without their discs.
fn bounds_text(cloud: &Cloud) -> String {
    bounds::of(cloud).map_or(String::new(), |[min, max]| format!("bounds: {min} to {max}\n"))
}

/// Describes a model of `points` points within these bounds.
fn describe(model: &Model, points: u64, bounds: &str) -> String {
    let Model { surfels, primitives } = model;
    let count = |count: usize| thousands(count as u64);
    let mut text = format!("points: {}\nsurfels: {}\n", thousands(points), count(surfels.len()));
    if !primitives.is_empty() {
        let [ribbons, tubes] = [primitives.ribbons.len(), primitives.tubes.len()].map(count);
        let [triangles, vertices] = [primitives.triangles.len(), primitives.len()].map(count);
        let _ = writeln!(text, "ribbons: {ribbons}\ntubes: {tubes}\ndrawn triangles: {triangles}");
        let _ = writeln!(text, "vertices of these: {vertices}, {}", range_text(&primitives.radii));
    }
    text += bounds;
    if let Some(spacing) = spacing(&surfels.positions) {
        let _ = writeln!(text, "spacing: {spacing}, the median distance to the nearest point");
    }
    if !surfels.is_empty() {
        let _ = writeln!(text, "{}", range_text(&surfels.radii));
    }
    let colours = match surfels.colours.as_ref().or(primitives.colours.as_ref()) {
        None => "none",
        Some(Colours::Srgb8(_)) => "sRGB, 8 bits",
        Some(Colours::Linear(_)) => "linear, float",
    };
    let _ = writeln!(text, "colours: {colours}");
    text
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

/// Describes where normals and radii come from.
fn sources(estimated: &Estimated) -> String {
    let list = |counts: &[(u64, &str)]| {
        let some = counts.iter().filter(|(count, _)| *count > 0);
        some.map(|(count, what)| format!("{} {what}", thousands(*count))).collect::<Vec<_>>().join(", ")
    };
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

/// Describes the points that are left out.
fn dropped(Dropped { position, transparent, thinned, filtered }: Dropped, estimated: &Estimated) -> String {
    let Estimated { unused, outliers, .. } = *estimated;
    let by = |count: u64, what: &str| {
        if count > 0 { format!(", {} {what}", thousands(count)) } else { String::new() }
    };
    let [position, transparent, unused, outliers] = [position, transparent, unused, outliers].map(thousands);
    let (thinned, filtered) = (by(thinned, "by thinning"), by(filtered, "by the filter"));
    format!(
        "left out: {position} without a finite position, {transparent} less than a tenth opaque, {unused} that no face uses, {outliers} \
         outliers{thinned}{filtered}\n"
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
