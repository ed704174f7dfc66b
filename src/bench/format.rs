//! Numbers and names as text.

use super::disturbance::{self, Disturbance};
use super::group::distinct;
use super::record::{
    Ceilings, Clock, Implementation, Memory, Provenance, Rate, Run, RunSettings, Session, Sweep, Time,
};
use crate::frame::times::Statistics;
use crate::settings::methods::Method;

/// Rounds to `digits` significant digits, without trailing zeros; uses a power of ten if the number would be long.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value.is_infinite() { sign(value) + "∞" } else { value.to_string() };
    }
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    match rounded.abs() {
        size if (1e-4..1e6).contains(&size) => sign(rounded) + &rounded.abs().to_string(),
        _ => scientific(rounded),
    }
}

/// An error: three digits, also if the last ones are 0, so that errors in one table are equally precise.
pub fn error(value: f64) -> String {
    let text = significant(value, 3);
    let digits = text.chars().filter(char::is_ascii_digit).skip_while(|digit| *digit == '0').count();
    match text.contains('.') {
        true if digits < 3 && !text.contains('·') => text + &"0".repeat(3 - digits),
        _ => text,
    }
}

fn sign(value: f64) -> String {
    if value < 0.0 { "−".into() } else { String::new() }
}

/// A factor and a power of ten; a factor of 1 is omitted.
pub fn scientific(value: f64) -> String {
    let text = format!("{:e}", value.abs());
    let (factor, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let factor = if factor == "1" { String::new() } else { format!("{factor}·") };
    format!("{}{factor}10{}", sign(value), superscript(exponent))
}

/// An integer as superscript.
fn superscript(number: &str) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(digit),
    };
    number.chars().map(raise).collect()
}

/// A number of points: `500`, `20 k`, `1.5 M`.
pub fn count(points: u64) -> String {
    let value = points as f64;
    match points {
        0..=9_999 => points.to_string(),
        10_000..=999_499 => format!("{} k", significant(value * 1e-3, 3)),
        _ => format!("{} M", significant(value * 1e-6, 3)),
    }
}

/// Milliseconds, without the unit.
pub fn ms(value: f64) -> String {
    significant(value, 3)
}

/// A median with its 95 % interval, if it is known.
pub fn spread(of: &Statistics) -> String {
    let interval = of.interval.map(|[low, high]| format!(" ({}–{})", ms(low), ms(high)));
    ms(of.median) + &interval.unwrap_or_default()
}

/// The 95 % interval of a median, or the number of frames where these are too few for one.
pub fn ends_or_frames(of: &Statistics, frames: usize) -> String {
    match of.interval {
        Some([low, high]) => format!("{}–{}", ms(low), ms(high)),
        None if frames == 1 => "1 frame".into(),
        None => format!("{frames} frames"),
    }
}

/// The work of a frame: its median with [`ends_or_frames`].
pub fn work(time: &Time) -> String {
    let work = time.work();
    format!("{} ({})", ms(work.median), ends_or_frames(&work, time.frames))
}

/// A number with a prefix of ten to the power of three: `8.1 G`.
pub fn with_prefix(value: f64) -> String {
    let prefixes = [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")];
    match prefixes.into_iter().find(|(size, _)| value >= *size) {
        Some((size, prefix)) => format!("{} {prefix}", significant(value / size, 3)),
        None => format!("{} ", significant(value, 3)),
    }
}

/// Median of a rate with its unit.
pub fn rate(rate: &Rate, unit: &str) -> String {
    with_prefix(rate.per_second.median) + unit
}

/// The rates of a device, on one line.
pub fn ceilings(ceilings: &Ceilings) -> String {
    let wide = ceilings.wide_atomics.map(|wide| format!(" of 32 bits, {} of 64 bits", rate(&wide, "/s")));
    let [copy, fill] = [rate(&ceilings.copy, "B/s"), rate(&ceilings.fill, "px/s")];
    let atomics = rate(&ceilings.atomics, "/s") + &wide.unwrap_or_default();
    format!("copy bandwidth {copy}, atomics {atomics}, fill rate {fill}")
}

/// A share in per cent.
pub fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
}

/// How many runs and values of hard cases the time of a session did not suffice for, of how many; none if it was enough.
pub fn missing_counts(session: &Session) -> Option<[usize; 2]> {
    let count: usize = session.missing.iter().map(|missing| missing.count).sum();
    // Variants of a method share their values.
    let of_sweep = |sweep: &Sweep| {
        distinct(sweep.points.iter().map(|point| (point.value.to_bits(), &point.implementation.method))).len()
    };
    let values: usize = session.sweeps.iter().map(of_sweep).sum();
    (count > 0).then(|| [count, count + session.runs.len() + values])
}

/// [`missing_counts`] as a sentence.
pub fn missing(session: &Session) -> Option<String> {
    let [count, all] = missing_counts(session)?;
    Some(format!("{count} of {all} runs were not measured, as the time was over."))
}

/// A method with options.
pub fn with_options(implementation: &Implementation, settings: &str) -> String {
    format!("{} {settings}", implementation.label()).trim_end().into()
}

/// What the times of these runs are.
pub fn time_of<'a>(runs: impl IntoIterator<Item = &'a Run>) -> &'static str {
    time_by(runs.into_iter().filter_map(|run| Some(run.time.as_ref()?.clock)))
}

/// What the ratios of these runs are of.
pub fn ratio_of<'a>(runs: impl IntoIterator<Item = &'a Run>) -> &'static str {
    time_by(runs.into_iter().filter_map(Run::ratio_of))
}

fn time_by(clocks: impl Iterator<Item = Clock>) -> &'static str {
    let clocks: Vec<Clock> = clocks.collect();
    match () {
        () if clocks.contains(&Clock::Gpu) => "GPU time",
        () if clocks.contains(&Clock::Wall) => "wall time",
        () => "CPU time",
    }
}

/// [`time_of`], as a heading.
pub fn time_heading<'a>(runs: impl IntoIterator<Item = &'a Run>) -> String {
    format!("{} of a frame, ms", time_of(runs))
}

/// The filters of the exact pictures that these runs are compared with, as names.
fn truth_filters<'a>(runs: impl IntoIterator<Item = &'a Run>) -> Vec<&'a str> {
    let errors = runs.into_iter().filter_map(|run| run.error.as_ref());
    distinct(errors.map(|error| if error.filter == "gaussian" { "Gaussian" } else { error.filter.as_str() }))
}

/// What the errors of these runs are against, as the label of an axis.
pub fn error_heading<'a>(what: &str, runs: impl IntoIterator<Item = &'a Run>) -> String {
    match truth_filters(runs) {
        none if none.is_empty() => format!("{what}, linear light"),
        filters => format!("{what}, linear light (truth: {})", filters.join(" or ")),
    }
}

/// A filter of exact pictures by its name in results, in words.
pub fn truth_filter(name: &str) -> &str {
    match name {
        "gaussian" => "a Gaussian with a variance of 1 px²",
        "box" => "the mean over each pixel",
        other => other,
    }
}

/// A disturbance of a run's times.
pub fn disturbance(disturbance: &Disturbance) -> String {
    match disturbance {
        Disturbance::Busy(others) => {
            format!("busy machine ({} processors)", significant(*others, 2))
        }
        Disturbance::Waited([wall, work]) => {
            format!("waited ({} instead of {} ms)", self::ms(*wall), self::ms(*work))
        }
    }
}

/// The disturbances of a run's times; empty if there are none.
pub fn disturbances(session: &Session, run: &Run) -> String {
    let all = disturbance::disturbances(session, run);
    all.iter().map(self::disturbance).collect::<Vec<_>>().join("; ")
}

/// A time relative to the CPU baseline.
pub fn baseline_ratio(value: f64) -> String {
    format!("{}×", significant(value, 2))
}

/// The largest of numbers from 0 on, or NaN if one is NaN, which `f64::max` would drop.
pub fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, b| if b.is_nan() || b > a { b } else { a })
}

/// Bytes as MiB, without the unit.
pub fn mib(bytes: u64) -> String {
    significant(bytes as f64 / f64::from(1 << 20), 3)
}

/// Total memory, bytes.
pub fn total(memory: Memory) -> u64 {
    memory.scene.saturating_add(memory.splats).saturating_add(memory.targets)
}

/// Width and height.
pub fn size([width, height]: [u32; 2]) -> String {
    format!("{width}×{height}")
}

/// A built-in scene's name without its prefix, or a file's name without its folder.
pub fn scene(name: &str) -> &str {
    let file = || name.rsplit(['/', '\\']).next().unwrap_or(name);
    name.strip_prefix("scene:").unwrap_or_else(file)
}

/// What distinguishes an implementation from the others: its variant if all have the same method.
pub fn distinct_label(implementation: &Implementation, all: &[&Implementation]) -> String {
    let one = all.iter().all(|other| other.method == implementation.method);
    if one && !implementation.variant.is_empty() {
        implementation.variant.clone()
    } else {
        implementation.label()
    }
}

/// The device and host of a session.
pub fn machine(session: &Session) -> String {
    let provenance = &session.provenance;
    let host = format!("{}, {} cores", provenance.host.cpu, provenance.host.cores);
    match &provenance.device {
        Some(gpu) => format!("{} ({host})", gpu.name),
        None => host,
    }
}

/// The date, UTC.
pub fn day(provenance: &Provenance) -> String {
    provenance.date.strftime("%Y-%m-%d").to_string()
}

/// A shortened commit.
pub fn commit(commit: &str) -> String {
    match commit.trim_end_matches('+') {
        "" => "unknown".into(),
        hash => {
            let changed = if commit.ends_with('+') { " (with changes)" } else { "" };
            hash.chars().take(10).collect::<String>() + changed
        }
    }
}

/// Why a session is out of date; none if it was measured by the present code.
pub fn stale(provenance: &Provenance, code: &str, now: &str) -> Option<String> {
    provenance.is_stale(code).then(|| {
        let (then, now) = (commit(&provenance.commit), commit(now));
        format!(
            "Measured by commit {then} on {}; the code, or how it is built, has changed since (now {now}).",
            day(provenance)
        )
    })
}

/// Place of the shading among [`settings`].
const SHADING: usize = 9;

/// Value of `--pixel-filter` of this variance.
fn pixel_filter_option(variance: f32) -> String {
    if variance > 0.0 { format!("gaussian:{variance}") } else { "none".into() }
}

/// Each setting as its option of `surfel render`, without the axes, which the implementation's name contains.
pub fn settings(setting: &RunSettings) -> [String; 10] {
    let RunSettings {
        cutoff,
        lowpass,
        pixel_filter,
        widen,
        lod,
        epsilon,
        cull,
        alpha,
        edges,
        shading,
        axes: _,
    } = setting;
    [
        format!("--lowpass {lowpass}"),
        format!("--pixel-filter {}", pixel_filter_option(*pixel_filter)),
        format!("--cutoff {cutoff}"),
        format!("--widen {widen}"),
        format!("--lod {lod}"),
        format!("--epsilon {epsilon}"),
        format!("--cull {cull}"),
        format!("--alpha {alpha}"),
        format!("--edges {edges}"),
        format!("--shading {shading}"),
    ]
}

/// The settings in which `runs` differ.
pub fn differing_settings<'a>(runs: impl IntoIterator<Item = &'a Run>) -> [bool; 10] {
    let all: Vec<_> = runs.into_iter().map(|run| settings(&run.settings)).collect();
    std::array::from_fn(|i| all.iter().any(|one| one[i] != all[0][i]))
}

/// The settings selected by `which`.
pub fn selected_settings(setting: &RunSettings, which: [bool; 10]) -> String {
    let chosen = settings(setting).into_iter().zip(which).filter(|(_, asked)| *asked);
    chosen.map(|(text, _)| text).collect::<Vec<_>>().join(" ")
}

/// The options of `surfel render` beside the implementation's: settings that differ from the method's defaults, without the shading.
pub fn options(run: &Run) -> String {
    let (own, preset) = (settings(&run.settings), settings(&RunSettings::preset(&run.implementation.method)));
    run_settings(run, std::array::from_fn(|i| i != SHADING && own[i] != preset[i]))
}

/// [`options`], and the shading if it is not that of all `runs`.
pub fn options_among(run: &Run, runs: &[&Run]) -> String {
    let shading = differing_settings(runs.iter().copied())[SHADING];
    let shading = shading.then(|| settings(&run.settings)[SHADING].clone());
    let all = std::iter::once(options(run)).chain(shading).filter(|option| !option.is_empty());
    all.collect::<Vec<_>>().join(" ")
}

/// The settings of `run` selected by `which`; pull–push has neither filter nor kernel nor ε.
pub fn run_settings(run: &Run, which: [bool; 10]) -> String {
    let splats = Method::named(&run.implementation.method).is_none_or(|method| method.pull_push.is_none());
    selected_settings(&run.settings, std::array::from_fn(|i| which[i] && (splats || i >= 4)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases = [(0.0, "0"), (0.020_49, "0.0205"), (140.23, "140"), (1e-7, "10⁻⁷"), (-2.5e8, "−2.5·10⁸")];
        for (value, text) in cases {
            assert_eq!(significant(value, 3), text);
        }
        let prefixed = [0.5, 12_345.0, 8.1e9, 4.8e12].map(with_prefix);
        assert_eq!(prefixed, ["0.5 ", "12.3 k", "8.1 G", "4.8 T"]);
        assert_eq!(significant(f64::NEG_INFINITY, 3), "−∞");
        let errors = [
            (0.010_02, "0.0100"),
            (0.25, "0.250"),
            (1.5, "1.50"),
            (0.0123, "0.0123"),
            (9.8e-5, "9.8·10⁻⁵"),
            (0.0, "0"),
        ];
        for (value, text) in errors {
            assert_eq!(error(value), text);
        }
        assert_eq!([500, 10_000, 1_500_000, 999_999].map(count), ["500", "10 k", "1.5 M", "1 M"]);
    }
}
