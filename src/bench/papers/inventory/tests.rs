//! The inventory is complete, and every quotation is the paper's.

use super::*;
use crate::bench::papers::models::Models;
use crate::bench::papers::{costs, effects, tables};
use std::path::Path;
use strum::VariantArray;

#[test]
fn every_figure_and_table_is_listed_once_in_order() {
    for paper in Paper::VARIANTS {
        let [figures, tables] = paper.counts();
        let expected = (1..=figures).map(Passage::Figure).chain((1..=tables).map(Passage::Table));
        let found: Vec<_> = of(*paper).iter().map(|entry| entry.passage).collect();
        assert_eq!(found, expected.collect::<Vec<_>>(), "{}", paper.name());
        assert!(of(*paper).iter().all(|entry| entry.says.paper == *paper));
    }
}

/// Names of all items, and whether they run without models.
fn items() -> Vec<(String, bool)> {
    let none = Models::default();
    let effects = effects::all().map(|effect| (effect.name.into(), !effect.plans(&none).is_empty()));
    let costs = costs::ALL.iter().map(|cost| (cost.name.into(), true));
    let tables = tables::all().map(|table| (table.source(), !table.plans(&none).is_empty()));
    effects.chain(costs).chain(tables).collect()
}

#[test]
fn whatever_is_measured_has_runs_and_every_item_is_listed_or_beyond() {
    let items = items();
    let mut listed = Vec::new();
    for entry in Paper::VARIANTS.iter().flat_map(|paper| of(*paper)) {
        for name in entry.coverage.items() {
            let (_, runs) = items.iter().find(|(item, _)| item == name).unwrap_or_else(|| panic!("{name}"));
            let with_models = name.ends_with(" models");
            assert!(*runs != with_models, "{name}");
            listed.push(*name);
        }
        if let Coverage::None(why) = entry.coverage {
            assert!(!why.is_empty());
        }
    }
    for effect in effects::of_papers() {
        assert!(listed.contains(&effect.name), "{} is in no paper's list", effect.name);
        assert!(!effect.expected.is_empty() || effect.name.ends_with(" models"), "{}", effect.name);
    }
    // What no paper claims has no expectation.
    assert!(effects::beyond().all(|effect| effect.expected.is_empty() && !effect.claims.is_empty()));
    let mut names: Vec<_> = items.into_iter().map(|(name, _)| name).collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
}

/// Every quotation.
fn quotations() -> Vec<Quotation> {
    let entries = Paper::VARIANTS.iter().flat_map(|paper| of(*paper)).map(|entry| entry.says);
    let expected = effects::all().flat_map(|effect| effect.expected).map(|expected| expected.says);
    let costs = costs::ALL.iter().filter_map(|cost| Some(cost.says?.quotation));
    let tables = tables::all().flat_map(|table| {
        std::iter::once(table.caption).chain(table.says.iter().map(|statement| statement.quotation))
    });
    entries.chain(expected).chain(costs).chain(tables).collect()
}

#[test]
fn quotations_are_short_and_not_empty() {
    for quotation in quotations() {
        let length = quotation.text.chars().count();
        assert!((12..=300).contains(&length), "{quotation}: {length} characters");
    }
}

/// Letters and digits alone: extracted text has its own white space, hyphens, markup and punctuation.
fn plain(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).collect()
}

#[test]
fn quotations_are_verbatim() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/papers");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        return crate::skipping::say_skipped(&format!("there is no {}", folder.display()));
    };
    let paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    for paper in Paper::VARIANTS {
        let is_it = |path: &&std::path::PathBuf| {
            path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(paper.name()))
        };
        let path = paths.iter().find(is_it).unwrap_or_else(|| panic!("{} has no text", paper.name()));
        let text = plain(&std::fs::read_to_string(path).unwrap());
        for quotation in quotations().into_iter().filter(|quotation| quotation.paper == *paper) {
            assert!(text.contains(&plain(quotation.text)), "{quotation} is not in {}", path.display());
        }
    }
}
