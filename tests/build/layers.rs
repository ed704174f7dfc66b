//! The layers of the crate: what imports what.

use std::path::{Path, PathBuf};

/// The modules, layer by layer: what is in one may use its own layer's module and those of layers before it.
const LAYERS: [&[&str]; 17] = [
    &["error"],
    &["progress", "picture"],
    &["vk"],
    &["geometry"],
    &["settings"],
    &["formats"],
    &["estimate"],
    &["scene"],
    &["verify"],
    &["load"],
    &["frame"],
    &["capture"],
    &["embed"],
    &["bench"],
    &["viewer"],
    &["cli"],
    &["guide"],
];

/// The layer of a module at the root of the crate; `None` of what is reexported there.
fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&module))
}

/// Every file below a folder, but for what Cargo builds there.
pub fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("the sources can be listed").path();
        if path.is_dir() {
            if !path.ends_with("target") {
                files(&path, found);
            }
        } else {
            found.push(path);
        }
    }
}

/// The modules at the root of the crate that a text names, but for comments, documentation and tests at its end.
fn named(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let lines = code.lines().map(|line| line.split("//").next().unwrap_or_default());
    let code = lines.collect::<Vec<_>>().join("\n");
    let mut modules = Vec::new();
    for root in ["crate::", "surfel::"] {
        for (at, _) in code.match_indices(root) {
            let whole = !code[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_');
            let rest = &code[at + root.len()..];
            let inner = rest.strip_prefix('{').map(|list| list.split('}').next().unwrap_or_default());
            let names = inner.map_or_else(|| vec![rest], |list| list.split(',').collect());
            let word = |name: &str| -> String {
                name.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
            };
            modules.extend(names.into_iter().filter(|_| whole).map(word));
        }
    }
    modules
}

/// What a module names that is of a layer above its own, or beside it.
fn upward(own: &str, text: &str) -> Vec<String> {
    let above = |module: &String| {
        let (Some(from), Some(to)) = (layer(own), layer(module)) else { return false };
        to > from || to == from && module != own
    };
    named(text).into_iter().filter(above).collect()
}

#[test]
fn every_use_goes_down() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../src");
    let mut all = Vec::new();
    files(&sources, &mut all);
    all.retain(|file| file.extension().is_some_and(|extension| extension == "rs"));
    assert!(all.len() > 300, "{} files", all.len());
    let mut wrong = Vec::new();
    for path in all {
        let inside = path.strip_prefix(&sources).expect("it is below the sources");
        let own = inside.iter().next().expect("a path has a part").to_string_lossy();
        let own = own.trim_end_matches(".rs");
        let is_test = inside.iter().any(|part| part == "tests" || part == "tests.rs");
        if is_test || ["lib", "main"].contains(&own) {
            continue;
        }
        assert!(layer(own).is_some(), "{} is in no layer: say which", inside.display());
        let text = std::fs::read_to_string(&path).expect("sources are text");
        wrong.extend(upward(own, &text).into_iter().map(|module| format!("{}: {module}", inside.display())));
    }
    assert!(wrong.is_empty(), "these are of a layer above: {wrong:#?}");
}

#[test]
fn a_use_that_goes_up_is_found() {
    assert_eq!(upward("geometry", "use crate::frame::Renderer;"), ["frame"]);
    assert_eq!(upward("geometry", "use crate::{error::Error, scene};"), ["scene"]);
    assert_eq!(upward("picture", "let text = crate::progress::of();"), ["progress"]);
    assert!(upward("frame", "use crate::scene::Scene;\n/// As [`crate::embed`].\n").is_empty());
    assert!(upward("cli", "use crate::viewer::run; use surfel::frame::Renderer;").is_empty());
    assert!(
        upward("scene", "use crate::error::Result;\n#[cfg(test)]\nmod tests { use crate::frame; }")
            .is_empty()
    );
}

/// What has handles of Vulkan that safe code could misuse is the crate's own: attacks on it do not compile.
#[test]
fn vk_shows_devices_and_windows_and_nothing_that_records() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../src/vk/mod.rs");
    let text = std::fs::read_to_string(file).expect("it is there");
    let statements = text.split(';').map(|statement| statement.trim_start());
    let shown = statements.filter_map(|statement| {
        let at = statement
            .find("pub use ")
            .filter(|at| statement[..*at].lines().all(|line| line.starts_with("#[")))?;
        statement[at..].split_once("::").map(|(_, names)| names)
    });
    let words = shown.flat_map(|names| names.split(|c: char| !c.is_alphanumeric() && c != '_'));
    let mut words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
    words.sort_unstable();
    let expected = [
        "ABILITIES",
        "API_VERSION",
        "Abilities",
        "Ability",
        "Capabilities",
        "CommandPool",
        "Device",
        "DeviceDescription",
        "DeviceLimits",
        "DeviceOptions",
        "ExternalDevice",
        "FRAMES_IN_FLIGHT",
        "Features",
        "HostMemory",
        "Location",
        "MemoryBlocks",
        "MemoryError",
        "MemoryRequest",
        "MemorySource",
        "PassTime",
        "Presented",
        "Presenter",
        "QUEUE",
        "Staging",
        "Surface",
        "Usage",
        "Window",
        "describe_devices",
        "preferred",
    ];
    assert_eq!(words, expected);
    assert!(!text.contains("pub mod "), "no module of it is public");
}
