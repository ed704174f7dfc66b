//! `surfel bench`.

use super::args::Bench;
use super::files::{self, cache_folder, read_json};
use super::{inputs, progress, vulkan};
use std::ffi::OsString;
use std::path::Path;
use std::rc::Rc;
use surfel::bench::record::FORMAT;
use surfel::bench::subject::Subject;
use surfel::bench::suites::Own;
use surfel::bench::{Results, Suite, Wanted, code, csv, measure, report, table};
use surfel::io::atomic;
use surfel::vk::Device;
use surfel::{Error, Progress, Result};

/// Measures, and shows what was measured. Earlier results and places to write to are looked at first.
pub fn run(args: &Bench) -> Result<()> {
    check_outputs(args)?;
    let mut results = Results { format: FORMAT, sessions: Vec::new() };
    for path in &args.from {
        results.sessions.extend(read(path)?.sessions);
    }
    let suites = suites(args);
    if !suites.is_empty() {
        let bars = progress::bars(args.quiet);
        results.sessions.push(measure(&wanted(args, suites, &*bars)?, &*bars)?);
    }
    show(args, &results)
}

/// Writes what was asked for, and a table unless something else goes to standard output.
fn show(args: &Bench, results: &Results) -> Result<()> {
    if let Some(place) = &args.json {
        files::write_text(place, &(to_json(results)? + "\n"))?;
    }
    if let Some(place) = &args.csv {
        write_csv(place, results)?;
    }
    if let Some(folder) = &args.report {
        let files = report::write(results, code::DIGEST, code::COMMIT, folder)?;
        if let (false, Some(page)) = (args.quiet, files.first()) {
            progress::say(&format!("{}: the page, with {} plots beside it", page.display(), files.len() - 1));
        }
    }
    let taken = [&args.json, &args.csv].into_iter().flatten().any(|place| place == "-");
    match args.quiet || taken {
        true => Ok(()),
        false => files::print(&table(results, code::DIGEST, code::COMMIT)),
    }
}

/// A line a run; the hard cases, whose lines are of another kind, in a file of their own: `-hard` is put behind its name. On standard output
/// an empty line is between both.
fn write_csv(place: &OsString, results: &Results) -> Result<()> {
    let (runs, sweeps) = (csv::runs(results, code::DIGEST)?, csv::sweeps(results, code::DIGEST)?);
    let any = results.sessions.iter().any(|session| !session.sweeps.is_empty());
    match (any, place == "-") {
        (false, _) => files::write_text(place, &runs),
        (true, true) => files::print(&format!("{runs}\n{sweeps}")),
        (true, false) => {
            files::write_text(place, &runs)?;
            files::write_text(&hard_file(Path::new(place)), &sweeps)
        }
    }
}

fn hard_file(path: &Path) -> OsString {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push("-hard");
    let mut file = path.with_file_name(name).into_os_string();
    if let Some(extension) = path.extension() {
        file.push(".");
        file.push(extension);
    }
    file
}

/// Those that were asked for; the first impression unless there is something else to show.
fn suites(args: &Bench) -> Vec<Suite> {
    let own = (!args.inputs.is_empty()).then_some(Suite::Own);
    match args.suite.is_empty() && args.from.is_empty() && own.is_none() {
        true => vec![Suite::Quick],
        false => args.suite.iter().map(|&suite| suite.into()).chain(own).collect(),
    }
}

fn subject(args: &Bench, input: &OsString, progress: &dyn Progress) -> Result<Rc<Subject>> {
    Ok(Rc::new(match inputs::scene(input) {
        Some(scene) => Subject::scene(scene)?,
        None => Subject::scan(Path::new(input), args.truth.as_deref(), progress)?,
    }))
}

/// The command that repeats this, less where its results go.
fn command(args: &Bench, suites: &[Suite]) -> String {
    let mut words = vec!["surfel bench".to_owned()];
    words.extend(args.inputs.iter().map(|input| input.display().to_string()));
    words.extend(args.truth.iter().map(|mesh| format!("--truth {}", mesh.display())));
    let names: Vec<_> =
        suites.iter().filter(|suite| **suite != Suite::Own).map(|suite| suite.name()).collect();
    if !names.is_empty() {
        words.push(format!("--suite {}", names.join(",")));
    }
    words.join(" ")
}

fn wanted(args: &Bench, suites: Vec<Suite>, progress: &dyn Progress) -> Result<Wanted> {
    Ok(Wanted {
        command: command(args, &suites),
        suites,
        own: Own {
            subjects: args
                .inputs
                .iter()
                .map(|input| subject(args, input, progress))
                .collect::<Result<_>>()?,
            points: args.points.clone(),
            size: args.size.unwrap_or(Own::default().size),
        },
        device: Some(Device::open(&vulkan::options(&args.device)?)?),
        validated: args.device.validate,
        cache: cache_folder().filter(|_| !args.no_cache).map(|folder| folder.join("truth")),
    })
}

fn read(path: &Path) -> Result<Results> {
    let results: Results = read_json(path)?;
    match results.format == FORMAT {
        true => Ok(results),
        false => Err(Error::input(
            path.display().to_string(),
            format!("format {} of results, not {FORMAT}: measure anew", results.format),
        )),
    }
}

fn to_json(results: &Results) -> Result<String> {
    serde_json::to_string_pretty(results).map_err(|error| Error::Usage(format!("the results: {error}")))
}

/// Refuses places that cannot be written to.
fn check_outputs(args: &Bench) -> Result<()> {
    [&args.json, &args.csv].into_iter().flatten().try_for_each(files::check)?;
    match &args.report {
        Some(folder) if folder.exists() && !folder.is_dir() => {
            Err(Error::Usage(format!("--report {}: is no folder: name another", folder.display())))
        }
        Some(folder) if folder.is_dir() => atomic::check(&folder.join("index.html")),
        _ => Ok(()),
    }
}
