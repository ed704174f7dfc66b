//! What the benches share: the device, work that takes turns, and the Markdown table.

#![allow(dead_code, reason = "no bench uses all of it")]

use std::error::Error;
use std::sync::Arc;
use std::time::Duration;
use surfel::bench::engine::LoadedEngine;
use surfel::bench::record::Clock;
use surfel::bench::stopwatch::{Effort, Sample, Samples, Work, take_turns, timed};
use surfel::bench::{format, frame_times};
use surfel::frame::times::Statistics;
use surfel::geometry::Camera;
use surfel::settings::Settings;
use surfel::vk::{Device, DeviceDescription, DeviceOptions};

pub type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Turns of every row.
const EFFORT: Effort =
    Effort { warmup: 2, least: 15, most: 1000, budget: Duration::from_secs(3), until: None };

/// Processors that other programs may keep busy without a message.
const BUSY: f64 = 0.1;

/// The default device; `None`, with a message, if there is none.
pub fn device() -> Option<Arc<Device>> {
    Device::open(&DeviceOptions::default()).map_err(|error| eprintln!("SKIPPED: {error}")).ok()
}

/// Work that is timed as a whole, but for the destruction of what it returns.
pub fn whole<T>(mut work: impl FnMut() -> Result<T>) -> impl FnMut() -> Result<Sample> {
    move || Ok(timed(&mut work)?.1)
}

/// Frames of an engine, with their passes.
pub fn frames(
    mut engine: impl LoadedEngine + 'static,
    camera: Camera,
    settings: Settings,
) -> impl FnMut() -> Result<Sample> {
    move || Ok(frame_times::turn(&mut (&mut engine, &camera, &settings))?)
}

/// A row of a table.
pub struct Row<'a> {
    what: String,
    work: Work<'a, Box<dyn Error>>,
    /// What a turn does, and its unit.
    amount: Option<(f64, &'static str)>,
}

impl<'a> Row<'a> {
    pub fn new(what: impl Into<String>, work: impl FnMut() -> Result<Sample> + 'a) -> Self {
        Self { what: what.into(), work: Box::new(work), amount: None }
    }

    /// Adds how much a turn does, of which the table has the amount per second of wall time.
    pub fn of(self, amount: usize, unit: &'static str) -> Self {
        Self { amount: Some((amount as f64, unit)), ..self }
    }
}

/// A Markdown table of times, each as the median with its 95 % interval.
pub struct Table {
    /// What ratios are of: wall time where a GPU does the work.
    clock: Clock,
}

impl Table {
    /// Prints the machine, what the times are of, and the head.
    pub fn new(about: &str, device: Option<&Device>) -> Self {
        machine(about, device);
        head(&["", "CPU ms", "wall ms", "ratio", "rate"]);
        let by_wall = device.is_some_and(|device| device.description().kind != DeviceDescription::CPU);
        Self { clock: if by_wall { Clock::Wall } else { Clock::Cpu } }
    }

    /// Times rows in turns, and prints them. Ratios are to the first one, of CPU time, or on a GPU of wall time.
    pub fn compare(&self, rows: Vec<Row<'_>>) -> Result<()> {
        let (names, mut works): (Vec<_>, Vec<_>) =
            rows.into_iter().map(|row| ((row.what, row.amount), row.work)).unzip();
        let all = take_turns(&mut works, &EFFORT).into_iter().collect::<Result<Vec<_>>>()?;
        for (i, ((what, amount), samples)) in names.into_iter().zip(&all).enumerate() {
            let ratio = (i > 0).then(|| samples.ratio(&all[0], self.clock)).flatten();
            print(&what, samples, ratio, amount);
        }
        if let Some(others) = all.iter().find_map(|samples| samples.others).filter(|others| *others > BUSY) {
            eprintln!("other programs kept {} processors busy", format::significant(others, 2));
        }
        Ok(())
    }
}

/// Prints a row, and one for each pass by the device's timestamps.
fn print(what: &str, samples: &Samples, ratio: Option<Statistics>, amount: Option<(f64, &str)>) {
    let wall = samples.wall();
    let rate = amount
        .map(|(amount, unit)| format::with_prefix(amount / wall.median * 1e3) + unit)
        .unwrap_or_default();
    let ratio = ratio.as_ref().map(format::spread).unwrap_or_default();
    line(&[what.into(), format::spread(&samples.cpu()), format::spread(&wall), ratio, rate]);
    for (pass, ms) in samples.passes() {
        line(&[
            format!("{what}: `{pass}`"),
            String::new(),
            format::spread(&ms),
            String::new(),
            String::new(),
        ]);
    }
}

/// Prints the machine, and what a table is of.
pub fn machine(about: &str, device: Option<&Device>) {
    let device = device.map(Device::description);
    let device = device.map(|device| format!("{}, {}, ", device.name, device.driver)).unwrap_or_default();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    println!("{device}{cores} cores; {about}\n");
}

/// Prints the head of a Markdown table.
pub fn head(cells: &[&str]) {
    line(&cells.iter().map(ToString::to_string).collect::<Vec<_>>());
    println!("|{}", "---|".repeat(cells.len()));
}

/// Prints a row of a Markdown table.
pub fn line(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}
