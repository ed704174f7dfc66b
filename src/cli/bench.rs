//! `surfel bench`.

use super::args::Bench;
use super::files::{self, cache_folder, read_json};
use super::{progress, vulkan};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use surfel::bench::record::FORMAT;
use surfel::bench::subject::Subject;
use surfel::bench::suites::Own;
use surfel::bench::{Results, Suite, Wanted, code, csv, measure, report, table};
use surfel::formats::atomic;
use surfel::load::scene;
use surfel::settings::Choice;
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
        let (session, ended) = measure(&wanted(args, suites, &*bars)?, &*bars);
        results.sessions.push(session);
        // What was measured before something went wrong is shown all the same.
        return show(args, &results).and(ended);
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
    if args.suite.is_empty() && args.from.is_empty() && own.is_none() {
        return vec![Suite::Quick];
    }
    let mut suites = Vec::new();
    for suite in args.suite.iter().copied().chain(own) {
        if !suites.contains(&suite) {
            suites.push(suite);
        }
    }
    suites
}

fn subject(args: &Bench, input: &OsString, progress: &dyn Progress) -> Result<Rc<Subject>> {
    Ok(Rc::new(match scene(input) {
        Some(scene) if args.truth.is_some() => {
            return Err(Error::Usage(format!("{scene} is its own truth: give --truth beside files alone")));
        }
        Some(scene) => Subject::scene(scene)?,
        None => Subject::scan(Path::new(input), args.truth.as_deref(), progress)?,
    }))
}

/// The command that repeats this, less where its results go.
fn command(args: &Bench, suites: &[Suite]) -> String {
    let mut words = vec!["surfel bench".to_owned()];
    words.extend(args.inputs.iter().map(|input| quoted(&input.to_string_lossy())));
    let mut option = |name: &str, value: Option<String>| {
        words.extend(value.map(|value| format!("--{name} {}", quoted(&value))));
    };
    let path = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
    let list = |words: Vec<String>| (!words.is_empty()).then(|| words.join(","));
    option("truth", path(&args.truth));
    option("points", list(args.points.iter().map(u64::to_string).collect()));
    option("size", args.size.map(|[width, height]| format!("{width}x{height}")));
    let named = suites.iter().filter(|suite| **suite != Suite::Own);
    option("suite", list(named.map(|suite| suite.name().to_owned()).collect()));
    option("device", args.device.device.clone());
    option("device-limits", path(&args.device.device_limits));
    words.extend(args.device.validate.then(|| "--validate".into()));
    words.join(" ")
}

/// As a shell takes it for one word.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// None, which is said, where there is none: the CPU baseline needs no device.
fn device(args: &Bench) -> Result<Option<Arc<Device>>> {
    match Device::open(&vulkan::options(&args.device)?) {
        Ok(device) => Ok(Some(device)),
        Err(error @ Error::NoDevice(_)) if args.device.device.is_none() && !args.device.validate => {
            log::warn!("{error}: what needs one is refused");
            Ok(None)
        }
        Err(error) => Err(error),
    }
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
        device: device(args)?,
        validated: args.device.validate,
        cache: cache_folder().filter(|_| !args.no_cache).map(|folder| folder.join("truth")),
    })
}

fn read(path: &Path) -> Result<Results> {
    #[derive(serde::Deserialize)]
    struct Head {
        format: u32,
    }
    match read_json(path)? {
        Head { format: FORMAT } => read_json(path),
        Head { format } => Err(Error::input(
            path.display().to_string(),
            format!("format {format} of results, not {FORMAT}: measure anew"),
        )),
    }
}

fn to_json(results: &Results) -> Result<String> {
    serde_json::to_string_pretty(results).map_err(|error| Error::Usage(format!("the results: {error}")))
}

/// Refuses places that cannot be written to, and makes the page's folder: what was measured for long should not be lost for want of one.
fn check_outputs(args: &Bench) -> Result<()> {
    [&args.json, &args.csv].into_iter().flatten().try_for_each(files::check)?;
    if let (Some(json), Some(csv)) = (&args.json, &args.csv)
        && files::is_same(json, csv)
    {
        return Err(Error::Usage("--json and --csv go to one place: name two".into()));
    }
    let Some(folder) = &args.report else { return Ok(()) };
    if folder.exists() && !folder.is_dir() {
        return Err(Error::Usage(format!("--report {}: is no folder: name another", folder.display())));
    }
    std::fs::create_dir_all(folder).map_err(Error::io(folder, "cannot make the folder"))?;
    atomic::check(&folder.join("index.html"))
}
