//! The report of `--json`. Times are in milliseconds, sizes in bytes, colours linear.

use super::args::Render;
use super::render::{Outcome, Task};
use serde_json::{Map, Value, json};
use std::path::Path;
use surfel::estimate::Estimated;
use surfel::formats::Dropped;
use surfel::formats::camera::Fields;
use surfel::frame::times::Statistics;
use surfel::load::{Coloured, LoadedModel};
use surfel::settings::splatting::Splatting;
use surfel::settings::{Choice, DirectionalLight, Lighting};
use surfel::vk::{DeviceDescription, Usage};
use surfel::{Error, Precision, Rasterizer, RasterizerReason, Result, Settings, SplatCounts, TargetInfo};

/// The device and its resources.
pub struct Gpu {
    /// The device.
    pub description: DeviceDescription,
    /// Level of detail of the frame, px.
    pub lod: f32,
    /// Float width of the sums.
    pub precision: Precision,
    /// The rasterizer.
    pub rasterizer: Option<Rasterizer>,
    /// The reason for it.
    pub rasterizer_reason: Option<RasterizerReason>,
    /// Every render target.
    pub targets: Vec<TargetInfo>,
    /// Memory of the surfels, bytes.
    pub scene_bytes: u64,
    /// Memory of the splats, bytes.
    pub splat_bytes: u64,
    /// All resources.
    pub usage: Usage,
    /// Messages of the validation layers; empty unless they were enabled.
    pub validation_messages: Vec<String>,
    /// Error of 16-bit sums, if they were chosen and the device supports 32-bit ones to compare with.
    pub half_error: Option<HalfError>,
}

/// Difference of a picture with 16-bit sums or samples from one with 32-bit ones, over all channels of all pixels, linear.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct HalfError {
    /// Largest difference.
    pub largest: f64,
    /// Root mean square difference.
    pub rms: f64,
}

/// A report as a JSON object.
pub struct Report(Map<String, Value>);

impl Report {
    /// The report of a command and its outcome. Without a device, the entries of the device are null.
    ///
    /// # Errors
    /// Those of the selection of a cut.
    pub fn new(args: &Render, loaded: &LoadedModel, task: &Task<'_>, outcome: &Outcome) -> Result<Self> {
        let names = |name| Path::new(name).display().to_string();
        let mut report = Map::new();
        let mut put = |key: &str, value: Value| report.insert(key.into(), value);
        put("version", json!(env!("CARGO_PKG_VERSION")));
        put("inputs", args.inputs.iter().map(names).collect());
        put("output", json!(names(&args.output)));
        put("method", json!(task.method.name));
        put("reference", json!(args.backend.reference));
        put("size", json!(task.size));
        put("frames", json!(task.frames));
        put("settings", settings(&task.settings));
        put("quantized", json!(args.backend.quantize));
        put("hierarchy", json!(args.render_settings.hierarchy.name()));
        put("octree", json!(task.cut.map(|cut| cut.report(&task.camera)).transpose()?));
        put("camera", camera(task));
        put("counts", outcome.counts.map_or(Value::Null, |counts| tally(loaded, counts)));
        put("estimated", estimated(&loaded.estimated));
        put("color_by", loaded.coloured.as_ref().map_or(Value::Null, |coloured| color_by(args, coloured)));
        put("frame_ms", json!(outcome.times.frame()));
        put("passes", outcome.times.passes().map(pass).collect());
        let mut report = Self(report);
        report.put_gpu(outcome.gpu.as_ref());
        Ok(report)
    }

    /// Adds the entries of the device.
    fn put_gpu(&mut self, gpu: Option<&Gpu>) {
        let mut put = |key: &str, value: Option<Value>| self.0.insert(key.into(), json!(value));
        put("device", gpu.map(|gpu| device(&gpu.description)));
        put("lod", gpu.map(|gpu| json!(gpu.lod)));
        put("precision", gpu.map(|gpu| json!(gpu.precision.name())));
        put("rasterizer", gpu.map(|gpu| json!(gpu.rasterizer.map(Choice::name))));
        let reason = gpu.map(|gpu| gpu.rasterizer_reason.map(<&str>::from));
        put("rasterizer_reason", reason.map(|reason| json!(reason)));
        put("targets", gpu.map(|gpu| gpu.targets.iter().map(target).collect()));
        put("target_bytes", gpu.map(|gpu| json!(gpu.targets.iter().map(|target| target.bytes).sum::<u64>())));
        put("scene_bytes", gpu.map(|gpu| json!(gpu.scene_bytes)));
        put("splat_bytes", gpu.map(|gpu| json!(gpu.splat_bytes)));
        put("device_bytes", gpu.map(|gpu| json!(gpu.usage.bytes)));
        put("half_error", gpu.map(|gpu| json!(gpu.half_error)));
        put("pipelines", gpu.map(|gpu| json!(gpu.usage.pipelines)));
        put("allocations", gpu.map(|gpu| json!(gpu.usage.allocations)));
        put("validation_messages", gpu.map(|gpu| json!(gpu.validation_messages)));
    }

    /// The text of the report, with a line break at the end.
    pub fn to_json(&self) -> Result<String> {
        let text = serde_json::to_string_pretty(&self.0);
        Ok(text.map_err(|error| Error::Usage(format!("the report: {error}")))? + "\n")
    }
}

fn device(device: &DeviceDescription) -> Value {
    let DeviceDescription { name, kind, driver, api_version, .. } = device;
    json!({ "name": name, "kind": kind, "driver": driver, "api_version": api_version })
}

fn target(target: &TargetInfo) -> Value {
    json!({ "name": target.name, "format": format!("{:?}", target.format), "bytes": target.bytes })
}

fn settings(settings: &Settings) -> Value {
    let Settings {
        splatting,
        pull_push,
        cutoff,
        lowpass,
        pixel_filter,
        widen,
        point_size,
        lod,
        max_points,
        epsilon,
        cull,
        alpha,
        edges,
        shading,
        edl,
        ao,
        background,
        lighting,
    } = settings;
    let Splatting { footprint, kernel, filter, visibility, normalization, shade } = splatting;
    if let Some(pull_push) = pull_push {
        return json!({
            "rules": pull_push.rules.name(), "pixel_filter": pixel_filter, "lod": lod, "max_points": max_points, "cull": cull.name(),
            "alpha": alpha.name(), "shading": shading.name(), "edl": edl, "ao": ao, "background": background,
            "lighting": light(lighting),
        });
    }
    json!({
        "footprint": footprint.name(), "kernel": kernel.to_string(), "filter": filter.name(),
        "visibility": visibility.name(), "normalization": normalization.name(), "shade": shade.name(),
        "cutoff": cutoff, "lowpass": lowpass, "pixel_filter": pixel_filter, "widen": widen.name(), "point_size": point_size, "lod": lod, "max_points": max_points, "epsilon": epsilon, "cull": cull.name(),
        "alpha": alpha.name(), "edges": edges.name(), "shading": shading.name(), "edl": edl, "ao": ao,
        "background": background, "lighting": light(lighting),
    })
}

fn light(lighting: &Lighting) -> Value {
    let Lighting { albedo, ambient, headlight, specular, shininess, directional } = lighting;
    let lamp = |light: &DirectionalLight| json!({ "to_light": light.to_light, "radiance": light.radiance });
    json!({
        "albedo": albedo, "ambient": ambient, "headlight": headlight, "specular": specular, "shininess": shininess,
        "directional": directional.iter().map(lamp).collect::<Value>(),
    })
}

/// The pose of the camera, as in a camera file, and its matrices, by columns.
fn camera(task: &Task<'_>) -> Value {
    let camera = &task.camera;
    let [view, projection] = [camera.view, camera.projection].map(|matrix| matrix.to_cols_array_2d());
    json!({ "pose": Fields::from(task.pose), "view": view, "projection": projection, "reversed": camera.reversed })
}

fn pass((name, ms): (&'static str, Statistics)) -> Value {
    json!({ "name": name, "ms": ms })
}

/// Counts of points, each of which counts once: read = dropped + culled + drawn. Surfels of levels of detail count as points do.
fn tally(loaded: &LoadedModel, counts: SplatCounts) -> Value {
    let Dropped { position, transparent, thinned, filtered } = loaded.dropped;
    let SplatCounts { drawn, behind, eye_plane, back, outside, invalid, other_level, hidden } = counts;
    let Estimated { unused, outliers, .. } = loaded.estimated;
    json!({
        "read": loaded.read,
        "dropped": {
            "position": position, "transparent": transparent, "thinned": thinned, "filtered": filtered, "unused": unused, "outlier": outliers,
        },
        "culled": {
            "behind": behind, "eye_plane": eye_plane, "back": back, "outside": outside, "invalid": invalid,
            "other_level": other_level,
            "hidden": hidden,
        },
        "drawn": drawn,
    })
}

/// Where normals and radii come from, as numbers of points.
pub fn estimated(counts: &Estimated) -> Value {
    let Estimated {
        normals_given,
        normals_contradictory,
        normals_from_faces,
        normals_from_neighbours,
        two_sided,
        scattered,
        billboards,
        scanner_found,
        ..
    } = counts;
    let Estimated { radii_given, radii_from_faces, radii_from_neighbours, .. } = counts;
    json!({
        "normals": {
            "given": normals_given, "from_faces": normals_from_faces, "from_neighbours": normals_from_neighbours,
            "contradictory": normals_contradictory, "two_sided": two_sided, "scattered": scattered, "billboards": billboards,
        },
        "scanner_found": scanner_found,
        "radii": {
            "given": radii_given, "from_faces": radii_from_faces, "from_neighbours": radii_from_neighbours,
        },
    })
}

/// What points are coloured by; map and range are null without values, as for normals.
fn color_by(args: &Render, coloured: &Coloured) -> Value {
    let range = coloured.scale.map(|scale| [scale.range.min, scale.range.max]);
    json!({ "name": coloured.name, "map": range.map(|_| args.colours.color_map.name()), "range": range })
}
