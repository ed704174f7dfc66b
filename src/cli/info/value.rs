//! `surfel info --json`.

use super::counts;
use super::input::{Given, Input};
use crate::cli::args::Info;
use crate::cli::files::print_json;
use crate::cli::{progress, report};
use serde_json::{Map, Value, json};
use std::ffi::OsStr;
use std::path::Path;
use surfel::Result;
use surfel::estimate::{Estimated, spacing};
use surfel::formats::declared::Element;
use surfel::formats::{self, Dropped, Inspected, Report};
use surfel::geometry::{Cloud, Colours, Model, View};
use surfel::load::scene;

/// The entries of a JSON object.
type Object = Map<String, Value>;

/// Prints the contents of a file or scene as a JSON object, and those of several as an array. If the points of one cannot be used, prints what
/// its header declares and fails with the cause.
pub(super) fn run(args: &Info) -> Result<()> {
    let mut objects = Vec::new();
    let found = args.inputs.iter().try_for_each(|input| {
        let mut object = Object::new();
        object.insert("input".into(), input.to_string_lossy().into());
        let found = describe(&mut object, input, args);
        // An input that cannot be opened has no further entries.
        if object.len() > 1 {
            objects.push(Value::Object(object));
        }
        found
    });
    match &objects[..] {
        [] => {}
        [object] if args.inputs.len() == 1 => print_json(object)?,
        _ => print_json(&Value::Array(objects))?,
    }
    found
}

/// Adds the entries of an input.
fn describe(all: &mut Object, input: &OsStr, args: &Info) -> Result<()> {
    if let Some(name) = scene(input) {
        return points(all, Input::of_scene(name)?, args);
    }
    let path = Path::new(input);
    let Inspected { encoding, elements, loaded, .. } =
        formats::inspect(path, &super::read_options(args), &*progress::bars(false))?;
    all.insert("format".into(), encoding.to_string().into());
    all.insert("elements".into(), elements.iter().map(element).collect());
    let loaded = loaded?;
    read(all, &loaded.report, &loaded.cloud);
    all.insert("points_by_class".into(), json!(counts::of_classes(&loaded.attributes)));
    all.insert("points_by_return".into(), json!(counts::of_returns(&loaded.attributes)));
    points(all, Input::of_file(path, loaded, args), args)
}

/// An element of the header.
fn element(element: &Element) -> Value {
    let properties = element.properties.iter();
    let properties: Value = properties
        .map(|property| json!({ "name": property.name, "kind": property.kind.to_string() }))
        .collect();
    json!({ "name": element.name, "count": element.count, "properties": properties })
}

/// Adds the entries of what was read.
fn read(all: &mut Object, report: &Report, cloud: &Cloud) {
    let Dropped { position, transparent, thinned, filtered } = report.dropped;
    let seen = match cloud.view {
        View::Unknown => Value::Null,
        View::From(eye) => json!({ "from": (cloud.origin + eye.as_dvec3()).to_array() }),
        View::Towards(direction) => json!({ "along": direction.to_array() }),
    };
    let Value::Object(read) = json!({
        "understood": report.understood,
        "skipped": report.skipped,
        "skipped_elements": report.skipped_elements,
        "gaussians": report.gaussians,
        "origin": cloud.origin.to_array(),
        "seen": seen,
        "faces": { "understood": report.faces.understood, "skipped": report.faces.skipped },
        "lines": { "understood": report.lines.understood, "skipped": report.lines.skipped, "sides_of_faces": report.lines.sides },
        "left_out": { "without_position": position, "transparent": transparent, "thinned": thinned, "filtered": filtered },
        "stated_points": report.stated,
        "trailing_bytes": report.trailing,
        "details": report.details.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
    }) else {
        return;
    };
    all.extend(read);
}

/// Adds the entries of the points, and of the model if it is to be estimated; those of an estimation are null otherwise.
fn points(all: &mut Object, input: Input, args: &Info) -> Result<()> {
    let Given { normals, billboards, radii } = input.given();
    all.insert("points".into(), input.points.into());
    let bounds = input.bounds.map(|[min, max]| json!({ "min": min.to_array(), "max": max.to_array() }));
    all.insert("bounds".into(), json!(bounds));
    all.insert("up".into(), json!(input.up.to_array()));
    let given = json!({ "normals": normals, "billboards": billboards, "radii": radii });
    all.insert("given".into(), given);
    all.insert("radius".into(), range(&input.given_radii()));
    all.insert("colours".into(), colours(input.cloud.colours.as_ref()));
    let made = input.model(args)?;
    let surfels = made.as_ref().map(|(model, _)| &model.surfels);
    let primitives = made.as_ref().map(|(model, _)| &model.primitives);
    let entries = [
        ("surfels", json!(surfels.map(|surfels| surfels.len()))),
        ("ribbons", json!(primitives.map(|lines| lines.ribbons.len()))),
        ("tubes", json!(primitives.map(|lines| lines.tubes.len()))),
        ("triangles", json!(primitives.map(|lines| lines.triangles.len()))),
        ("spacing", json!(surfels.map(|surfels| spacing(&surfels.positions)))),
        ("radius_of_lines", primitives.map_or(Value::Null, |lines| range(&lines.radii))),
        ("estimated", made.as_ref().map_or(Value::Null, |(_, estimated)| sources(estimated))),
    ];
    all.extend(entries.map(|(key, value)| (key.into(), value)));
    if let Some((Model { surfels, primitives }, _)) = &made {
        all.insert("radius".into(), range(&surfels.radii));
        all.insert("colours".into(), colours(surfels.colours.as_ref().or(primitives.colours.as_ref())));
    }
    Ok(())
}

/// The type of colours; null without any.
fn colours(colours: Option<&Colours>) -> Value {
    match colours {
        None => Value::Null,
        Some(Colours::Srgb8(_)) => "srgb8".into(),
        Some(Colours::Linear(_)) => "linear".into(),
    }
}

/// Minimum, maximum and median of radii; null if there are none.
fn range(radii: &[f32]) -> Value {
    super::range(radii)
        .map_or(Value::Null, |[min, max, median]| json!({ "min": min, "max": max, "median": median }))
}

/// Where normals and radii come from, those of lines included, and the numbers of unused points and outliers.
fn sources(estimated: &Estimated) -> Value {
    let mut sources = report::estimated(estimated);
    sources["radii_of_lines"] = json!({
        "given": estimated.line_radii_given, "from_lines": estimated.line_radii_from_lines,
        "from_extent": estimated.line_radii_from_extent,
    });
    sources["unused"] = json!(estimated.unused);
    sources["outliers"] = json!(estimated.outliers);
    sources
}
