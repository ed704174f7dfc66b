//! `surfel info --json`.

use super::{bounds, counts};
use crate::cli::args::Info;
use crate::cli::files::print_json;
use crate::cli::{progress, report};
use serde_json::{Map, Value, json};
use std::path::Path;
use surfel::Result;
use surfel::estimate::{Estimated, spacing};
use surfel::formats::declared::Element;
use surfel::formats::{self, Dropped, Inspected, Loaded, Report};
use surfel::geometry::{Cloud, Colours, Model, View};
use surfel::load::{scene, scene_cloud};

/// The entries of a JSON object.
type Object = Map<String, Value>;

/// Prints the contents of a file or scene as JSON. If its points cannot be rendered, prints what the header declares and fails with the cause.
pub(super) fn run(args: &Info) -> Result<()> {
    let mut all = Object::new();
    all.insert("input".into(), args.input.to_string_lossy().into());
    let found = match scene(&args.input) {
        Some(name) => scene_cloud(name).and_then(|cloud| {
            let points = cloud.len() as u64;
            model(&mut all, args, (name, points), cloud)
        }),
        None => file(&mut all, args),
    };
    // An input that cannot be opened has no further entries.
    if all.len() > 1 {
        print_json(&Value::Object(all))?;
    }
    found
}

/// Adds the entries of a file.
fn file(all: &mut Object, args: &Info) -> Result<()> {
    let path = Path::new(&args.input);
    let Inspected { encoding, elements, loaded, .. } =
        formats::inspect(path, &super::read_options(args), &*progress::bars(false))?;
    all.insert("format".into(), encoding.to_string().into());
    all.insert("elements".into(), elements.iter().map(element).collect());
    let Loaded { cloud, report, attributes } = loaded?;
    read(all, &report, &cloud);
    all.insert("points_by_class".into(), json!(counts::of_classes(&attributes)));
    all.insert("points_by_return".into(), json!(counts::of_returns(&attributes)));
    model(all, args, (&path.display().to_string(), report.points), super::kept(cloud, args))
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

/// Adds the entries of the model of `points` points.
fn model(all: &mut Object, args: &Info, (name, points): (&str, u64), cloud: Cloud) -> Result<()> {
    let polygons = args.points.polygons || scene(&args.input).is_some();
    let bounds = bounds::of(&cloud);
    let made = cloud.into_model(polygons, &args.points.estimate(), &*progress::bars(false));
    let (model, estimated) = made.map_err(|error| error.in_input(name))?;
    let Model { surfels, primitives } = &model;
    let colours = match surfels.colours.as_ref().or(primitives.colours.as_ref()) {
        None => Value::Null,
        Some(Colours::Srgb8(_)) => "srgb8".into(),
        Some(Colours::Linear(_)) => "linear".into(),
    };
    let Value::Object(model) = json!({
        "points": points,
        "surfels": surfels.len(),
        "ribbons": primitives.ribbons.len(),
        "tubes": primitives.tubes.len(),
        "triangles": primitives.triangles.len(),
        "bounds": bounds.map(|[min, max]| json!({ "min": min.to_array(), "max": max.to_array() })),
        "spacing": spacing(&surfels.positions),
        "radius": range(&surfels.radii),
        "radius_of_lines": range(&primitives.radii),
        "colours": colours,
        "estimated": sources(&estimated),
    }) else {
        return Ok(());
    };
    all.extend(model);
    Ok(())
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
