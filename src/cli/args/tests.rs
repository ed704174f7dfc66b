//! The help is made of whole sentences.

use super::*;
use clap::CommandFactory;

/// Words that end no sentence.
const JOINING: [&str; 20] = [
    "a", "an", "and", "as", "at", "by", "for", "from", "in", "into", "of", "on", "or", "than", "that", "the",
    "to", "where", "whose", "with",
];

fn is_whole(sentence: &str) -> bool {
    let count = |c: char| sentence.matches(c).count();
    let last = sentence.rsplit(' ').next().unwrap_or_default();
    let is_end = last.ends_with(|c: char| c.is_alphanumeric() || ")`²".contains(c));
    is_end && count('(') == count(')') && !JOINING.contains(&last)
}

#[test]
fn the_help_of_values_is_no_cut_sentence() {
    assert!(is_whole("Of a (whole) sentence") && !is_whole("at the vertices of") && !is_whole("a, "));
    let mut values = 0;
    for command in Surfel::command().get_subcommands() {
        for option in command.get_arguments() {
            for value in option.get_possible_values() {
                let help = value.get_help().map(ToString::to_string).unwrap_or_default();
                let value_of = format!("{} {} {}", command.get_name(), option.get_id(), value.get_name());
                assert!(help.is_empty() || is_whole(&help), "{value_of}: {help}");
                values += usize::from(!help.is_empty());
            }
        }
    }
    assert!(values > 100, "{values}");
}
