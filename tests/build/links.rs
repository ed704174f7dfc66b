//! The manual: front page, guide, contributing, changelog. Every link leads somewhere, in the repository and in rustdoc; figures are small.

use crate::layers::files;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Most lines of the front page.
const FRONT_PAGE: usize = 200;
/// Most bytes of a figure, and of all of them.
const FIGURE: u64 = 100_000;
const FIGURES: u64 = 1_000_000;

/// A text in Markdown.
#[derive(Default)]
struct Page {
    /// Targets of links that name them: `[text](target)`.
    targets: Vec<String>,
    /// Targets by label: `[label]: target`.
    definitions: BTreeMap<String, String>,
    /// Labels that links use: `[text][label]`, `[label][]` or `[label]`.
    labels: BTreeSet<String>,
    anchors: BTreeSet<String>,
}

/// The anchor of a heading, as GitHub and rustdoc make it.
fn anchor(heading: &str) -> String {
    let letter = |c: char| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c.to_ascii_lowercase()),
        _ => None,
    };
    heading.trim().chars().filter_map(letter).collect()
}

/// A line without its inline code.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join("``")
}

/// What follows an opening bracket, up to the one that closes it, and the rest.
fn bracket(text: &str, [open, close]: [char; 2]) -> Option<(&str, &str)> {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == open) - i32::from(c == close);
        if depth == 0 {
            return text
                .starts_with(open)
                .then(|| (&text[open.len_utf8()..at], &text[at + close.len_utf8()..]));
        }
    }
    None
}

impl Page {
    fn of(text: &str) -> Self {
        let mut page = Self::default();
        let mut code = false;
        for line in text.lines() {
            code ^= line.starts_with("```");
            if code {
                continue;
            }
            if line.starts_with('#') {
                page.anchors.insert(anchor(line.trim_start_matches('#')));
                continue;
            }
            let definition = line.strip_prefix('[').and_then(|line| line.split_once("]: "));
            match definition {
                Some((label, target)) => _ = page.definitions.insert(label.to_lowercase(), target.to_owned()),
                None => page.read_links(&without_code(line)),
            }
        }
        page
    }

    fn read_links(&mut self, line: &str) {
        let mut left = line;
        while let Some(at) = left.find('[') {
            let Some((text, after)) = bracket(&left[at..], ['[', ']']) else { return };
            // A picture may be the text of a link.
            self.read_links(text);
            left = after;
            if let Some((target, after)) = bracket(after, ['(', ')']) {
                self.targets.push(target.to_owned());
                left = after;
            } else if let Some((label, after)) = bracket(after, ['[', ']']) {
                self.labels.insert(if label.is_empty() { text } else { label }.to_lowercase());
                left = after;
            } else if text != " " && text != "x" {
                self.labels.insert(text.to_lowercase());
            }
        }
    }

    /// Every target in the repository.
    fn inner_targets(&self) -> impl Iterator<Item = &str> {
        let all = self.targets.iter().chain(self.definitions.values()).map(String::as_str);
        all.filter(|target| !target.starts_with("https://"))
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository is there")
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Pages of the guide, below its folder, with the front page of it.
fn chapters(root: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    files(&root.join("src/guide"), &mut all);
    all.retain(|path| path.extension().is_some_and(|kind| kind == "md") && !path.ends_with("links.md"));
    assert!(all.len() > 15, "{} chapters", all.len());
    all
}

/// What is wrong with the links of a page.
fn broken(path: &Path, page: &Page) -> Vec<String> {
    let folder = path.parent().expect("a file is in a folder");
    let mut wrong = Vec::new();
    for target in page.inner_targets() {
        let (file, anchor) = target.split_once('#').map_or((target, None), |(file, at)| (file, Some(at)));
        let file = if file.is_empty() { path.to_owned() } else { folder.join(file) };
        if !file.exists() {
            wrong.push(format!("{target}: there is no such file"));
        } else if let Some(anchor) = anchor
            && !Page::of(&read(&file)).anchors.contains(anchor)
        {
            wrong.push(format!("{target}: there is no such heading"));
        }
    }
    let defined: BTreeSet<_> = page.definitions.keys().cloned().collect();
    wrong.extend(page.labels.difference(&defined).map(|label| format!("[{label}] is not defined")));
    wrong.extend(defined.difference(&page.labels).map(|label| format!("[{label}] is defined and not used")));
    wrong
}

/// What rustdoc calls a page of the guide, as a path that `folder` leads to.
fn module(root: &Path, folder: &Path, target: &str) -> Option<String> {
    let (file, anchor) = target.split_once('#').map_or((target, None), |(file, at)| (file, Some(at)));
    let file = folder.join(file).canonicalize().ok()?;
    let inside = file.strip_prefix(root.join("src/guide")).ok()?.with_extension("");
    let names = inside.iter().map(|name| name.to_string_lossy().replace('-', "_"));
    let path = ["crate", "guide"].into_iter().map(str::to_owned).chain(names).collect::<Vec<_>>().join("::");
    Some(anchor.map_or(path.clone(), |anchor| format!("{path}#{anchor}")))
}

#[test]
fn every_link_of_the_manual_leads_somewhere() {
    let root = root();
    let mut pages = chapters(&root);
    pages.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root.join(name)));
    let wrong = pages.iter().flat_map(|path| {
        let name = path.strip_prefix(&root).expect("it is below").display().to_string();
        broken(path, &Page::of(&read(path))).into_iter().map(move |fault| format!("{name}: {fault}"))
    });
    let wrong: Vec<_> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// rustdoc takes links from `links.md`, which comes before each chapter and its own definitions.
#[test]
fn links_lead_to_the_same_place_in_rustdoc() {
    let root = root();
    let known = Page::of(&read(&root.join("src/guide/links.md"))).definitions;
    let text = read(&root.join("src/guide/mod.rs"));
    let (mut wrong, mut used) = (Vec::new(), BTreeSet::new());
    for path in chapters(&root) {
        let inside = path.strip_prefix(root.join("src/guide")).expect("it is below").display().to_string();
        let call = text.lines().find(|line| line.contains(&format!("\"{inside}\""))).unwrap_or_default();
        if call.is_empty() {
            wrong.push(format!("{inside} is not in mod.rs"));
        }
        let folder = path.parent().expect("a file is in a folder");
        for (label, target) in Page::of(&read(&path)).definitions {
            used.insert(label.clone());
            if let Some(figure) = label.strip_prefix("fig ") {
                if !call.contains(&format!("\"{figure}\"")) {
                    wrong.push(format!("{inside}: mod.rs does not give it the figure {figure}"));
                }
                continue;
            }
            let there = known.get(&label);
            let expected = module(&root, folder, &target).or_else(|| there.cloned());
            if there.is_none() || there != expected.as_ref() {
                wrong.push(format!("{inside}: [{label}] is {there:?} in links.md, not {expected:?}"));
            }
        }
    }
    wrong.extend(
        known.keys().filter(|label| !used.contains(*label)).map(|label| format!("[{label}] is not used")),
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_front_page_is_short_and_figures_are_small_and_shown() {
    let root = root();
    let front = read(&root.join("README.md"));
    assert!(front.lines().count() <= FRONT_PAGE, "{} lines", front.lines().count());
    let shown: Vec<_> = chapters(&root).iter().map(|path| read(path)).chain([front]).collect();
    let mut total = 0;
    for entry in std::fs::read_dir(root.join("tools/figures")).expect("there are figures") {
        let entry = entry.expect("they can be listed");
        let (name, bytes) = (entry.file_name(), entry.metadata().expect("it has a size").len());
        let name = name.to_string_lossy();
        assert!(bytes <= FIGURE, "{name} has {bytes} bytes");
        assert!(
            shown.iter().any(|text| text.contains(&format!("tools/figures/{name}"))),
            "{name} is not shown"
        );
        total += bytes;
    }
    assert!(total > 0 && total <= FIGURES, "figures have {total} bytes");
}

#[test]
fn links_are_found_and_code_is_no_link() {
    let text = "# One – two: `three`\n[a](b.md#c) ![d][fig e] [F][] [g] `[h]`\n```\n[i]\n```\n[g]: j.md\n";
    let page = Page::of(text);
    assert_eq!(page.targets, ["b.md#c"]);
    assert_eq!(page.labels.iter().collect::<Vec<_>>(), ["f", "fig e", "g"]);
    assert_eq!(page.definitions["g"], "j.md");
    assert!(page.anchors.contains("one--two-three"));
    let faults = broken(&root().join("README.md"), &page);
    for fault in ["b.md#c: there is no such file", "[f] is not defined"] {
        assert!(faults.iter().any(|found| found == fault), "{faults:?}");
    }
    let heading = Page::of("[a](#b)\n");
    assert_eq!(broken(&root().join("README.md"), &heading), ["#b: there is no such heading"]);
}
