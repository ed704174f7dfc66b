//! `surfel bench`.

use super::args::{Bench, With};
use super::files::{self, cache_folder, read_json};
use super::interrupt::{self, Interruptible};
use super::{progress, rasterizers, vulkan};
use clap::ValueEnum;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::bench::command::quoted;
use surfel::bench::papers::models::Models;
use surfel::bench::record::{FORMAT, Provenance, Session, schema};
use surfel::bench::subject::Subject;
use surfel::bench::suites::UserInputs;
use surfel::bench::{Results, SessionOptions, Suite, code, csv, measure, report, table};
use surfel::formats::{self, atomic};
use surfel::load::scene;
use surfel::settings::Choice;
use surfel::settings::methods::Method;
use surfel::verify::truth;
use surfel::vk::Device;
use surfel::{Error, Progress, RasterizerChoice, Result, Settings};

/// Time after which results are written while more are measured.
const KEEP: Duration = Duration::from_secs(10);

/// Measures, and writes the results. Earlier results and output paths are checked first.
pub fn run(args: &Bench) -> Result<()> {
    if args.schema {
        return files::print_json(&schema().to_value());
    }
    check_outputs(args)?;
    let mut results = Results { format: FORMAT, sessions: Vec::new() };
    for path in &args.from {
        for file in files_of(path)? {
            results.sessions.extend(read(&file)?.sessions);
        }
    }
    let suites = suites(args);
    if !suites.is_empty() {
        let bars = progress::bars(args.quiet);
        let options = wanted(args, suites, &*bars)?;
        interrupt::catch()?;
        let mut kept = Instant::now();
        let mut keep = |session: &Session| match &args.json {
            Some(file) if file != "-" && kept.elapsed() > KEEP => {
                kept = Instant::now();
                let mut all = results.clone();
                all.sessions.push(session.clone());
                files::write_text(file, &(to_json(&all)? + "\n"))
            }
            _ => Ok(()),
        };
        let (session, ended) = measure(options, &Interruptible(&*bars), &mut keep);
        results.sessions.push(session);
        // The results before an error are written all the same.
        return write_results(args, &results).and(ended.map_err(|error| continued(args, error)));
    }
    write_results(args, &results)
}

/// What the user can do after an interruption.
fn continued(args: &Bench, error: Error) -> Error {
    match (error, args.json.as_ref().filter(|file| *file != "-")) {
        (Error::Cancelled, Some(file)) => Error::Usage(format!(
            "interrupted: the results so far are in {0}; the same command with --resume continues",
            Path::new(file).display()
        )),
        (Error::Cancelled, None) => {
            Error::Usage("interrupted: with --json FILE, --resume could continue".into())
        }
        (error, _) => error,
    }
}

/// The session of `--json` that `--resume` continues; none if there is no such file.
fn earlier(args: &Bench, command: &str, device: Option<&Device>) -> Result<Option<Session>> {
    let Some(file) = args.json.as_ref().filter(|_| args.resume) else { return Ok(None) };
    let path = Path::new(file);
    if file == "-" {
        return Err(Error::Usage("--resume: standard output cannot be continued: give --json a file".into()));
    }
    if !path.exists() {
        return Ok(None);
    }
    let name = path.display();
    let session = read(path)?.sessions.pop();
    let session = session.ok_or_else(|| Error::input(name.to_string(), "no results to continue"))?;
    let Provenance { code, command: own, device: with, .. } = &session.provenance;
    let with = with.as_ref().map(|gpu| (gpu.name.as_str(), gpu.driver.as_str()));
    let here = device.map(Device::description).map(|here| (here.name.as_str(), here.driver.as_str()));
    let other = match () {
        () if own != command => format!("by `{own}`, not `{command}`"),
        () if code != code::DIGEST => "by other code".into(),
        () if with != here => "on another device".into(),
        () => return Ok(Some(session)),
    };
    let cause =
        format!("measured {other}, and cannot be continued: leave out --resume, or name another file");
    Err(Error::input(name.to_string(), cause))
}

/// Writes the outputs of the options, and prints a table unless one of them goes to standard output.
fn write_results(args: &Bench, results: &Results) -> Result<()> {
    if let Some(output) = &args.json {
        files::write_text(output, &(to_json(results)? + "\n"))?;
    }
    if let Some(output) = &args.csv {
        write_csv(output, results)?;
    }
    if let Some(folder) = &args.report {
        let files = report::write(results, code::DIGEST, code::COMMIT, folder)?;
        if let (false, Some(page)) = (args.quiet, files.first()) {
            progress::say(&format!(
                "{}: the report, with {} plots beside it",
                page.display(),
                files.len() - 1
            ));
        }
    }
    let taken = [&args.json, &args.csv].into_iter().flatten().any(|output| output == "-");
    if args.quiet || taken { Ok(()) } else { files::print(&table(results, code::DIGEST, code::COMMIT)) }
}

/// Writes one line per run. The hard cases, whose columns differ, go to a second file with `-hard` behind its name; on standard output an empty
/// line separates both.
fn write_csv(output: &OsString, results: &Results) -> Result<()> {
    let (runs, sweeps) = (csv::runs(results, code::DIGEST)?, csv::sweeps(results, code::DIGEST)?);
    let any = results.sessions.iter().any(|session| !session.sweeps.is_empty());
    match (any, output == "-") {
        (false, _) => files::write_text(output, &runs),
        (true, true) => files::print(&format!("{runs}\n{sweeps}")),
        (true, false) => {
            files::write_text(output, &runs)?;
            files::write_text(&hard_file(Path::new(output)), &sweeps)
        }
    }
}

/// Path of the file of hard cases.
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

/// The suites of the options; `quick` unless there is something else to write.
fn suites(args: &Bench) -> Vec<Suite> {
    let own = (!args.inputs.is_empty()).then_some(Suite::Inputs);
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

/// The subject of an input.
fn subject(args: &Bench, input: &OsString, progress: &dyn Progress) -> Result<Rc<Subject>> {
    Ok(Rc::new(match scene(input) {
        Some(scene) if args.truth.is_some() => {
            return Err(Error::Usage(format!("{scene} is its own truth: give --truth with files only")));
        }
        Some(scene) => Subject::scene(scene)?,
        None => Subject::scan(Path::new(input), args.truth.as_deref(), progress)?,
    }))
}

/// The scans of `--scans` that the suites measure, by name.
fn scans(args: &Bench, suites: &[Suite], progress: &dyn Progress) -> Result<Vec<Rc<Subject>>> {
    let Some(folder) = &args.scans else { return Ok(Vec::new()) };
    let paths = scan_files(folder, suites)?;
    paths.iter().map(|path| Ok(Rc::new(Subject::scan(path, None, progress)?))).collect()
}

/// The files of a folder that the suites measure, by name.
fn scan_files(folder: &Path, suites: &[Suite]) -> Result<Vec<PathBuf>> {
    let most = match suites {
        _ if suites.contains(&Suite::Full) => usize::MAX,
        _ if suites.contains(&Suite::Quick) => 1,
        _ => return Err(Error::Usage("--scans: no suite measures them: give --suite quick or full".into())),
    };
    let entries = std::fs::read_dir(folder).map_err(Error::io(folder, "cannot read the folder"))?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<std::io::Result<Vec<_>>>();
    let mut paths = paths.map_err(Error::io(folder, "cannot read the folder"))?;
    let known = |path: &PathBuf| {
        path.extension().is_some_and(|own| formats::extensions().any(|other| own.eq_ignore_ascii_case(other)))
    };
    paths.retain(known);
    paths.sort();
    if paths.is_empty() {
        return Err(Error::input(folder.display().to_string(), "no scans: name a folder with PLY files"));
    }
    paths.truncate(most);
    Ok(paths)
}

/// The command that repeats the measurement, without its outputs.
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
    option("method", list(args.method.iter().map(|method| method.name.to_owned()).collect()));
    args.with.iter().for_each(|with| option("with", Some(with.text.clone())));
    option("size", args.size.map(|[width, height]| format!("{width}x{height}")));
    let named = suites.iter().filter(|suite| **suite != Suite::Inputs);
    option("suite", list(named.map(|suite| suite.name().to_owned()).collect()));
    option("filter", args.filter.and_then(|filter| Some(filter.to_possible_value()?.get_name().to_owned())));
    option("scans", path(&args.scans));
    // Without the last bits, which are not those of what was typed.
    let minutes = |limit: Duration| (limit.as_secs_f64() / 60.0 * 1e6).round() / 1e6;
    option("minutes", args.minutes.map(|limit| minutes(limit).to_string()));
    option("models", path(&args.models));
    option("device", args.device.device.clone());
    option("device-limits", path(&args.device.device_limits));
    words.extend(args.device.validate.then(|| "--validate".into()));
    words.join(" ")
}

/// Opens the device. Without any, logs a warning and returns `None`: the CPU baseline needs none.
fn device(args: &Bench) -> Result<Option<Arc<Device>>> {
    match Device::open(&vulkan::options(&args.device)?) {
        Ok(device) => Ok(Some(device)),
        Err(error @ Error::NoDevice(_)) if args.device.device.is_none() && !args.device.validate => {
            log::warn!("{error}: suites that need a device fail");
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// The settings of `--with`, of each method that can render so.
fn variants(args: &Bench) -> Result<Vec<(Method, Settings)>> {
    let methods = if args.method.is_empty() { &Method::OWN[..] } else { &args.method };
    let of = |with: &With| {
        let all = methods.iter().map(|method| Ok((*method, with.settings(method)?)));
        let (able, unable): (Vec<_>, Vec<_>) = all.partition(Result::is_ok);
        if able.is_empty() {
            return unable.into_iter().take(1).collect::<Result<Vec<_>>>();
        }
        unable.into_iter().filter_map(Result::err).for_each(|error| log::warn!("{error}"));
        able.into_iter().collect()
    };
    Ok(args.with.iter().map(of).collect::<Result<Vec<_>>>()?.concat())
}

/// What the options ask to measure.
fn wanted(args: &Bench, suites: Vec<Suite>, progress: &dyn Progress) -> Result<SessionOptions> {
    let models = match &args.models {
        Some(_) if !suites.contains(&Suite::Papers) => {
            return Err(Error::Usage("--models is of the suite papers: give --suite papers".into()));
        }
        Some(folder) => Models::open(folder, progress)?,
        None => Models::default(),
    };
    let device = device(args)?;
    let scans = scans(args, &suites, progress)?;
    Ok(SessionOptions {
        rasterizer: device
            .as_ref()
            .map_or(RasterizerChoice::Automatic, |device| rasterizers::choice(None, device)),
        earlier: earlier(args, &command(args, &suites), device.as_deref())?,
        command: command(args, &suites),
        suites,
        inputs: UserInputs {
            models,
            subjects: args
                .inputs
                .iter()
                .map(|input| subject(args, input, progress))
                .collect::<Result<_>>()?,
            points: args.points.clone(),
            size: args.size,
            methods: args.method.clone(),
            variants: variants(args)?,
            scans,
        },
        device,
        validated: args.device.validate,
        cache: cache_folder().filter(|_| !args.no_cache).map(|folder| folder.join("truth")),
        filter: args.filter.map_or(truth::Filter::DEFAULT, truth::Filter::from),
        limit: args.minutes,
    })
}

/// The file itself; of a folder, its JSON files in the order of their names.
fn files_of(path: &Path) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let entries = std::fs::read_dir(path).and_then(|entries| entries.collect::<std::io::Result<Vec<_>>>());
    let entries = entries.map_err(Error::io(path, "cannot list"))?;
    let mut files: Vec<PathBuf> = entries.iter().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    if files.is_empty() {
        let cause = "has no results, which are JSON files: name the folder that tools/measure wrote";
        return Err(Error::input(path.display().to_string(), cause));
    }
    Ok(files)
}

/// Reads the results of an earlier call.
fn read(path: &Path) -> Result<Results> {
    #[derive(serde::Deserialize)]
    struct Head {
        format: u32,
    }
    match read_json(path)? {
        Head { format: FORMAT } => read_json(path),
        Head { format } => Err(Error::input(
            path.display().to_string(),
            format!("format {format} of results, not {FORMAT}: measure again"),
        )),
    }
}

fn to_json(results: &Results) -> Result<String> {
    serde_json::to_string_pretty(results).map_err(|error| Error::Usage(format!("the results: {error}")))
}

/// Checks that the outputs can be written, and creates the report's folder, so that long measurements are not lost.
fn check_outputs(args: &Bench) -> Result<()> {
    [&args.json, &args.csv].into_iter().flatten().try_for_each(files::check)?;
    if let (Some(json), Some(csv)) = (&args.json, &args.csv)
        && files::is_same(json, csv)
    {
        return Err(Error::Usage("--json and --csv name one file: name two".into()));
    }
    let Some(folder) = &args.report else { return Ok(()) };
    if folder.exists() && !folder.is_dir() {
        return Err(Error::Usage(format!("--report {}: is no folder: name another", folder.display())));
    }
    std::fs::create_dir_all(folder).map_err(Error::io(folder, "cannot create the folder"))?;
    atomic::check(&folder.join("index.html"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suites_measure_the_first_scan_or_all() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.ply", "a.LAZ", "notes.txt.bak", "c.obj"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let names = |suites: &[Suite]| {
            let paths = scan_files(folder.path(), suites)?;
            Ok(paths.iter().map(|path| path.file_name().unwrap().to_string_lossy().into()).collect())
        };
        let text =
            |found: Result<Vec<String>>| found.map_or_else(|error| error.to_string(), |all| all.join(" "));
        assert_eq!(text(names(&[Suite::Full])), "a.LAZ b.ply c.obj");
        assert_eq!(text(names(&[Suite::Quick])), "a.LAZ");
        assert_eq!(text(names(&[Suite::Quick, Suite::Full])), "a.LAZ b.ply c.obj");
        assert!(text(names(&[Suite::Scaling])).contains("no suite measures them"));
        let empty = tempfile::tempdir().unwrap();
        assert!(text(scan_files(empty.path(), &[Suite::Quick]).map(|_| Vec::new())).contains("no scans"));
    }

    #[test]
    fn hard_cases_have_a_file_beside() {
        for (file, hard) in [("a/b.csv", "a/b-hard.csv"), ("b", "b-hard"), ("a.b/c", "a.b/c-hard")] {
            assert_eq!(hard_file(Path::new(file)), hard);
        }
    }
}
