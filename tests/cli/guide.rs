//! The guide and the program's help agree: every option has its place in a chapter, and what a chapter types is understood.

use crate::program::Program;
use std::collections::BTreeSet;
use std::path::Path;

/// The commands, and the chapters that have their options.
const COMMANDS: [(&str, &[&str]); 12] = [
    ("render", &["render", "files", "methods"]),
    #[cfg(feature = "viewer")]
    ("view", &["view", "render", "files", "methods"]),
    ("convert", &["convert", "files", "render"]),
    ("info", &["files", "getting-started"]),
    ("compare", &["bench"]),
    ("truth", &["scenes", "render"]),
    ("bench", &["bench", "render"]),
    ("scenes", &["getting-started"]),
    ("methods", &["methods", "getting-started"]),
    ("devices", &["getting-started"]),
    ("completions", &["getting-started"]),
    ("man", &["getting-started"]),
    #[cfg(not(feature = "viewer"))]
    ("help", &[]),
];

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The long options in a text.
fn options(text: &str) -> BTreeSet<&str> {
    let words = text.split(|c: char| !c.is_ascii_lowercase() && !c.is_ascii_digit() && c != '-');
    words.filter(|word| word.starts_with("--") && word.len() > 2).collect()
}

fn help(program: &Program, command: &str) -> String {
    program.run(&format!("{command} --help")).text().to_owned()
}

#[test]
fn every_option_is_in_a_chapter() {
    let program = Program::new();
    let mut missing = Vec::new();
    for (command, chapters) in COMMANDS.iter().filter(|(_, chapters)| !chapters.is_empty()) {
        let guide: String = chapters.iter().map(|chapter| text(&format!("src/guide/{chapter}.md"))).collect();
        let known = options(&guide);
        let help = help(&program, command);
        // An option begins a line of the help.
        let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
        let own = lines.filter_map(|line| options(line.split("  ").next().unwrap_or_default()).pop_first());
        let own: Vec<_> = own.filter(|option| *option != "--help").collect();
        let lacking = own.iter().filter(|option| !known.contains(*option));
        missing.extend(lacking.map(|option| format!("{command} {option} is not in {chapters:?}")));
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

#[test]
fn formats_are_listed_alike() {
    let program = Program::new();
    let names = surfel::formats::names();
    assert!(names.contains("LAZ, COPC, ") && names.ends_with(" or text"), "{names}");
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for command in ["render", "convert", "info"] {
        assert!(one_line(&help(&program, command)).contains(&format!("{names} file")), "{command}");
    }
    assert!(text("src/guide/getting-started.md").contains(&format!("An input is a {names} file")));
    let unknown = program.write("a.dat", "Points:").run("info a.dat");
    assert!(unknown.error(1).ends_with(&format!("; give a {names} file")), "{}", unknown.err);
    let written = surfel::formats::writable_names();
    assert!(one_line(&help(&program, "convert")).contains(&format!("The file to write: {written}")));
    let refused = program.run("convert scene:sphere -o a.copc");
    assert_eq!(refused.error(2), format!("a.copc: name the file {written}"));
    let in_code = written.replace('.', "`.").replace(", ", "`, ").replace(" or", "` or") + "`";
    let in_code = in_code.replace("`.copc`.laz", "`.copc.laz");
    assert!(text("src/guide/convert.md").contains(&in_code), "{in_code}");
    let meshes = surfel::formats::mesh_names();
    assert!(text("src/guide/scenes.md").contains(&format!("a {meshes} file")), "{meshes}");
    #[cfg(feature = "truth")]
    assert!(one_line(&help(&program, "truth")).contains(&format!("a {meshes} file")));
    #[cfg(feature = "metrics")]
    assert!(help(&program, "compare").contains(surfel::formats::image::READ));
}

#[test]
fn what_the_manual_types_is_understood() {
    let program = Program::new();
    let helps: Vec<_> = COMMANDS.iter().map(|(command, _)| (*command, help(&program, command))).collect();
    let chapters = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide")).unwrap();
    let names = chapters.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let pages = names.filter(|name| name.ends_with(".md")).map(|name| format!("src/guide/{name}"));
    let (mut lines, mut wrong) = (0, Vec::new());
    for page in pages.chain(["README.md", "CONTRIBUTING.md"].map(String::from)) {
        let page_text = text(&page).replace("\\\n", " ");
        // Blocks of code are between fences.
        let shells = page_text.split("\n```").filter_map(|block| block.strip_prefix("sh\n"));
        for line in shells.flat_map(str::lines) {
            let line = line.split(" #").next().unwrap_or_default();
            let Some((_, typed)) =
                line.split_once("surfel ").filter(|(before, _)| !before.contains(['/', '"']))
            else {
                continue;
            };
            let command = typed.split_whitespace().next().unwrap_or_default();
            let Some((_, help)) = helps.iter().find(|(name, _)| *name == command) else {
                wrong.push(format!("{page}: {line}: there is no such command"));
                continue;
            };
            lines += 1;
            let known = options(help);
            let unknown = options(typed).into_iter().filter(|option| !known.contains(option));
            wrong.extend(unknown.map(|option| format!("{page}: {line}: there is no {option}")));
        }
    }
    assert!(lines > 20, "{lines} lines");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
