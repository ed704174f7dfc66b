//! The language of names, comments and texts: words that `tests/words.txt` forbids.

use crate::layers::files;
use std::path::{Path, PathBuf};

/// A forbidden word.
struct Word<'a> {
    word: &'a str,
    instead: &'a str,
    /// Beginnings of the paths in which it is forbidden; everywhere if there are none.
    places: Vec<&'a str>,
}

fn forbidden(list: &str) -> Vec<Word<'_>> {
    let lines = list.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    let row = |line| {
        let cells: Vec<&str> = str::split(line, '|').map(str::trim).collect();
        let [word, instead, places] = cells[..] else { panic!("{line}: give word | instead | where") };
        Word { word, instead, places: places.split_whitespace().collect() }
    };
    lines.map(row).collect()
}

/// The words of a line in lower case, those of names like `OneTwo` and `one_two` apart.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for c in line.chars() {
        let begins = c.is_uppercase() && before.is_lowercase();
        if !c.is_alphabetic() || begins {
            words.push(String::new());
        }
        if c.is_alphabetic() {
            words.last_mut().expect("there is one").extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Where a text of this path uses which forbidden words.
fn found(path: &str, text: &str, list: &[Word<'_>]) -> Vec<String> {
    let here: Vec<_> = list
        .iter()
        .filter(|word| word.places.is_empty() || word.places.iter().any(|place| path.starts_with(place)))
        .collect();
    let of_line = |(i, line): (usize, &str)| {
        let used = words(line);
        let wrong = here.iter().filter(|word| used.iter().any(|used| used == word.word));
        wrong.map(|word| format!("{path}:{}: {}: say {}", i + 1, word.word, word.instead)).collect::<Vec<_>>()
    };
    text.lines().enumerate().flat_map(of_line).collect()
}

#[test]
fn no_forbidden_word_is_used() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let list = std::fs::read_to_string(root.join("tests/words.txt")).expect("the list is there");
    let list = forbidden(&list);
    assert!(!list.is_empty());
    let mut all: Vec<PathBuf> =
        ["README.md", "CONTRIBUTING.md", "build.rs"].map(|name| root.join(name)).into();
    for folder in ["src", "shaders-glsl", "tests", "benches", "tools"] {
        files(&root.join(folder), &mut all);
    }
    let mut wrong = Vec::new();
    for file in &all {
        let path = file.strip_prefix(&root).expect("it is below").to_string_lossy().replace('\\', "/");
        // What is compiled, and figures, are no texts.
        let Ok(text) = std::fs::read_to_string(file) else { continue };
        if path != "tests/words.txt" && path != "tests/build/words.rs" {
            wrong.extend(found(&path, &text, &list));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn words_are_found_in_names_and_in_their_places_alone() {
    let list = forbidden("# none\nfate | cull reason |\npane | offscreen view | src\n");
    assert_eq!(
        found("tests/a.rs", "let x = FateOf::new(pane);", &list),
        ["tests/a.rs:1: fate: say cull reason"]
    );
    assert_eq!(found("src/a.rs", "\nfn my_pane() {}", &list), ["src/a.rs:2: pane: say offscreen view"]);
    assert!(found("src/a.rs", "fated panels", &list).is_empty());
}
