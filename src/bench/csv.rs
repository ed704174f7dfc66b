//! Results as CSV rows, for spreadsheets and scripts. A cell without a value is empty; no rows give an empty text
//! without a header.

use super::format;
use super::group::distinct;
use super::record::{
    Ceilings, Clock, Float64Error, Memory, PassWork, Rate, Results, Run, Session, SweepPoint, Viewpoint,
};
use crate::error::{Error, Result};
use crate::frame::times::Statistics;
use crate::settings::Choice;
use crate::verify::metrics::Metric;
use std::collections::BTreeSet;

/// A cell with the name of its column.
type Cell = (String, String);

/// One row per run: its session, settings, viewpoint, times, error with what it is against, and error against float64. Each metric has a
/// column of its name. Times have `NAME`, `NAME:min`, `NAME:max`, and `NAME:low` and `NAME:high` of the median's interval; passes are `pass:NAME`,
/// and their least work is `pass:NAME:bytes`, `pass:NAME:pixels` and `pass:NAME:atomics`. `stale` says whether the
/// session's source digest differs from `code`. Times are in ms, memory in bytes.
///
/// # Errors
/// [`Error::Usage`] if the rows cannot be written to memory.
pub fn runs(results: &Results, code: &str) -> Result<String> {
    let all =
        || results.sessions.iter().flat_map(|session| session.runs.iter().map(move |run| (session, run)));
    let metrics = metrics(all().map(|(_, run)| run));
    let passes = all().flat_map(|(_, run)| &run.time).flat_map(|time| &time.passes);
    let passes = distinct(passes.map(|pass| &*pass.name));
    let row = |(session, run): (&Session, &Run)| {
        let mut row = provenance(session, code);
        let viewpoint = viewpoint(run.viewpoint.as_ref());
        row.extend(
            [what(run), viewpoint, time(session, run), error(run), memory(&run.memory)].into_iter().flatten(),
        );
        row.extend(float64_error(run.float64_error.as_ref()));
        row.extend(metrics.iter().map(|name| (name.clone(), number(run.metric(name)))));
        row.extend(passes.iter().flat_map(|name| pass(run, name)));
        row
    };
    text(all().map(row))
}

/// One row per point of a sweep: its session, the sweep, the point, its error against float64, and its faults.
///
/// # Errors
/// As [`runs`].
pub fn sweeps(results: &Results, code: &str) -> Result<String> {
    let row = |session: &Session, (name, parameter): (&str, &str), point: &SweepPoint| {
        let mut row = provenance(session, code);
        let value = point.value.to_string();
        row.extend(cells([("sweep", name.into()), ("parameter", parameter.into()), ("value", value)]));
        row.extend(cells([
            ("method", point.implementation.method.clone()),
            ("variant", point.implementation.variant.clone()),
            ("refused", point.refused.clone().unwrap_or_default()),
        ]));
        row.extend(float64_error(Some(&point.float64_error).filter(|_| point.refused.is_none())));
        row.extend(cells([
            ("non_finite", point.faults.non_finite.to_string()),
            ("uncovered", point.faults.uncovered.to_string()),
            ("overcovered", point.faults.overcovered.to_string()),
            ("note", point.note.clone()),
        ]));
        row
    };
    text(results.sessions.iter().flat_map(|session| {
        session.sweeps.iter().flat_map(move |sweep| {
            sweep.points.iter().map(move |point| row(session, (&sweep.name, &sweep.parameter), point))
        })
    }))
}

fn cells<const N: usize>(cells: [(&str, String); N]) -> impl Iterator<Item = Cell> {
    cells.map(|(name, value)| (name.to_owned(), value)).into_iter()
}

fn number(value: Option<f64>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

fn provenance(session: &Session, code: &str) -> Vec<Cell> {
    let provenance = &session.provenance;
    let device = provenance.device.as_ref();
    cells([
        ("stale", provenance.is_stale(code).to_string()),
        ("version", provenance.version.clone()),
        ("commit", provenance.commit.clone()),
        ("code", provenance.code.clone()),
        ("date", provenance.date.to_string()),
        ("seconds", provenance.seconds.to_string()),
        ("command", provenance.command.clone()),
        ("suites", provenance.suites.join(" ")),
        ("cpu", provenance.host.cpu.clone()),
        ("cores", provenance.host.cores.to_string()),
        ("host_memory", provenance.host.memory.to_string()),
        ("system", provenance.host.system.clone()),
        ("device", device.map(|gpu| gpu.name.clone()).unwrap_or_default()),
        ("driver", device.map(|gpu| gpu.driver.clone()).unwrap_or_default()),
        ("validated", device.map(|gpu| gpu.validated.to_string()).unwrap_or_default()),
        ("copy_bytes_per_s", rate(session, |ceilings| Some(ceilings.copy))),
        ("atomics_per_s", rate(session, |ceilings| Some(ceilings.atomics))),
        ("wide_atomics_per_s", rate(session, |ceilings| ceilings.wide_atomics)),
        ("fill_pixels_per_s", rate(session, |ceilings| Some(ceilings.fill))),
    ])
    .collect()
}

fn rate(session: &Session, of: fn(&Ceilings) -> Option<Rate>) -> String {
    number(session.ceilings.as_ref().and_then(of).map(|rate| rate.per_second.median))
}

fn what(run: &Run) -> Vec<Cell> {
    let setting = &run.settings;
    cells([
        ("suite", run.suite.clone()),
        ("experiment", run.experiment.name().into()),
        ("paper_item", run.paper_item.clone()),
        ("scene", run.scene.clone()),
        ("points", run.points.to_string()),
        ("radius_scale", run.radius_scale.to_string()),
        ("width", run.size[0].to_string()),
        ("height", run.size[1].to_string()),
        ("method", run.implementation.method.clone()),
        ("variant", run.implementation.variant.clone()),
        ("cutoff", setting.cutoff.to_string()),
        ("lowpass", setting.lowpass.to_string()),
        ("pixel_filter", setting.pixel_filter.to_string()),
        ("widen", setting.widen.clone()),
        ("lod", setting.lod.to_string()),
        ("epsilon", setting.epsilon.to_string()),
        ("cull", setting.cull.clone()),
        ("alpha", setting.alpha.clone()),
        ("edges", setting.edges.clone()),
        ("shading", setting.shading.clone()),
        ("footprint", setting.axes.footprint.clone()),
        ("kernel", setting.axes.kernel.clone()),
        ("filter", setting.axes.filter.clone()),
        ("visibility", setting.axes.visibility.clone()),
        ("normalization", setting.axes.normalization.clone()),
        ("shade", setting.axes.shade.clone()),
        ("refused", run.refused.clone().unwrap_or_default()),
        ("octree_nodes", number(run.octree.map(|octree| octree.nodes as f64))),
        ("octree_bytes", number(run.octree.map(|octree| octree.bytes as f64))),
        ("octree_build_ms", number(run.octree.map(|octree| octree.build_ms))),
        ("octree_surfels", number(run.octree.map(|octree| octree.surfels as f64))),
        ("octree_select_ms", number(run.octree.map(|octree| octree.select_ms))),
        ("overlap", number(run.overlap)),
        ("blended", number(run.blended.map(|blended| blended.mean))),
        ("blended:max", number(run.blended.map(|blended| blended.largest))),
        ("images", run.images.map(|index| index.to_string()).unwrap_or_default()),
    ])
    .collect()
}

/// Name and coordinates of a viewpoint.
fn viewpoint(from: Option<&Viewpoint>) -> Vec<Cell> {
    let mut row = vec![("viewpoint".to_owned(), from.map(|from| from.place.clone()).unwrap_or_default())];
    let points = [
        ("eye", from.map(|from| from.eye)),
        ("target", from.map(|from| from.target)),
        ("up", from.map(|from| from.up)),
    ];
    for (name, point) in points {
        let axes = ["x", "y", "z"].into_iter().enumerate();
        row.extend(axes.map(|(i, axis)| (format!("{name}:{axis}"), number(point.map(|point| point[i])))));
    }
    row.push(("fov_y_deg".into(), number(from.map(|from| from.fov_y_deg))));
    row
}

fn time(session: &Session, run: &Run) -> Vec<Cell> {
    let time = run.time.as_ref();
    let mut row: Vec<Cell> = cells([
        ("frames", time.map(|time| time.frames.to_string()).unwrap_or_default()),
        ("warmup", time.map(|time| time.warmup.to_string()).unwrap_or_default()),
        ("clock", time.map(|time| <&str>::from(time.clock).to_owned()).unwrap_or_default()),
        ("disturbed", format::disturbances(session, run)),
        ("others", number(time.and_then(|time| time.others))),
    ])
    .collect();
    row.extend(spread("wall", time.map(|time| time.by(Clock::Wall))));
    row.extend(spread("cpu", time.map(|time| time.by(Clock::Cpu))));
    let by_timestamps = time.filter(|time| time.device.is_some());
    row.extend(spread("device_time", by_timestamps.map(|time| time.by(Clock::Gpu))));
    row.push(("baseline_ratio".into(), number(time.and_then(|time| time.baseline_ratio))));
    row.extend(spread("ratio", run.ratio));
    row.push((
        "ratio_clock".into(),
        run.ratio_of().map(|clock| <&str>::from(clock).into()).unwrap_or_default(),
    ));
    row
}

/// Median, minimum, maximum, and the median's interval.
fn spread(name: &str, times: Option<Statistics>) -> [Cell; 5] {
    let interval = times.and_then(|times| times.interval);
    [
        (name.to_owned(), number(times.map(|times| times.median))),
        (format!("{name}:min"), number(times.map(|times| times.min))),
        (format!("{name}:max"), number(times.map(|times| times.max))),
        (format!("{name}:low"), number(interval.map(|[low, _]| low))),
        (format!("{name}:high"), number(interval.map(|[_, high]| high))),
    ]
}

/// Times and least work of a pass.
fn pass(run: &Run, name: &str) -> impl Iterator<Item = Cell> {
    let times = run.time.as_ref().and_then(|time| time.passes.iter().find(|pass| pass.name == name));
    let work = run.work.iter().find(|work| work.name == name && times.is_some());
    let of = |what: &str, value: fn(&PassWork) -> u64| {
        (format!("pass:{name}:{what}"), work.map(|work| value(work).to_string()).unwrap_or_default())
    };
    let work = [
        of("bytes", |work| work.bytes),
        of("pixels", |work| work.pixels),
        of("atomics", |work| work.atomics),
    ];
    spread(&format!("pass:{name}"), times.map(|pass| pass.ms)).into_iter().chain(work)
}

fn error(run: &Run) -> Vec<Cell> {
    let error = run.error.as_ref();
    let terms = error.map(|error| error.terms);
    cells([
        ("against", error.map(|error| <&str>::from(error.against).to_owned()).unwrap_or_default()),
        ("surface", error.map(|error| error.surface.clone()).unwrap_or_default()),
        ("truth_filter", error.map(|error| error.filter.clone()).unwrap_or_default()),
        ("truth_target", number(error.map(|error| error.target))),
        ("truth_most_samples", number(error.map(|error| f64::from(error.most_samples)))),
        ("truth_rms", number(error.map(|error| error.truth_rms))),
        ("term:silhouette", number(terms.map(|terms| terms.silhouette))),
        ("term:inside", number(terms.map(|terms| terms.inside))),
        ("term:hidden", number(terms.and_then(|terms| terms.hidden))),
        ("term:precision", number(terms.and_then(|terms| terms.precision))),
    ])
    .collect()
}

fn memory(memory: &Memory) -> Vec<Cell> {
    let Memory { scene, splats, targets } = memory;
    let bytes = [("memory:scene", scene), ("memory:splats", splats), ("memory:targets", targets)];
    cells(bytes.map(|(name, bytes)| (name, bytes.to_string()))).collect()
}

fn float64_error(float64_error: Option<&Float64Error>) -> impl Iterator<Item = Cell> {
    let text = |value: fn(&Float64Error) -> String| float64_error.map(value).unwrap_or_default();
    cells([
        ("f64:object", text(|a| a.object_pixels.to_string())),
        ("f64:ambiguous", text(|a| a.ambiguous_pixels.to_string())),
        ("f64:failed", text(|a| a.failed_pixels.to_string())),
        ("f64:colour", text(|a| a.colour.to_string())),
        ("f64:normal", text(|a| a.normal.to_string())),
        ("f64:depth", text(|a| a.depth.to_string())),
    ])
}

/// Names of all metrics of the runs: known ones first, in their order.
pub(super) fn metrics<'a>(runs: impl Iterator<Item = &'a Run>) -> Vec<String> {
    let taken: BTreeSet<&String> =
        runs.filter_map(|run| run.error.as_ref()).flat_map(|error| error.metrics.keys()).collect();
    let mut names: Vec<String> = taken.into_iter().cloned().collect();
    let place =
        |name: &str| Metric::ALL.iter().position(|metric| metric.name() == name).unwrap_or(usize::MAX);
    names.sort_by_key(|name| place(name));
    names
}

/// Writes rows with equal columns, with a header.
fn text(rows: impl Iterator<Item = Vec<Cell>>) -> Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed =
        |cause: String| Error::Usage(format!("cannot write the results as CSV: {cause}; use --json"));
    for (index, row) in rows.enumerate() {
        if index == 0 {
            writer
                .write_record(row.iter().map(|(name, _)| name))
                .map_err(|error| failed(error.to_string()))?;
        }
        writer.write_record(row.iter().map(|(_, value)| value)).map_err(|error| failed(error.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|error| failed(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| failed(error.to_string()))
}
