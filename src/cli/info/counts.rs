//! Numbers of points by class and by return.

use std::collections::BTreeMap;
use surfel::formats::{Attribute, WantedAttributes, class_name};
use surfel::thousands;

/// Name of the class of a point.
const CLASS: &str = "classification";
/// Name of the number of a point's return.
const RETURN: &str = "return_number";

/// Points by number.
pub type Counts = BTreeMap<i64, u64>;

/// The attributes that are counted.
pub fn wanted() -> WantedAttributes {
    WantedAttributes::Named([CLASS, RETURN].map(str::to_owned).into())
}

/// Points by class; `None` if they have none.
pub fn of_classes(attributes: &[Attribute]) -> Option<Counts> {
    of(attributes, CLASS)
}

/// Points by the number of their return; `None` if they have none.
pub fn of_returns(attributes: &[Attribute]) -> Option<Counts> {
    of(attributes, RETURN)
}

fn of(attributes: &[Attribute], name: &str) -> Option<Counts> {
    let values = &attributes.iter().find(|attribute| attribute.name == name)?.values;
    let mut counts = Counts::new();
    for value in (0..values.len()).filter_map(|point| values.get(point)) {
        *counts.entry(value as i64).or_default() += 1;
    }
    Some(counts)
}

/// A line for each kind of counts.
pub fn text(attributes: &[Attribute]) -> String {
    let class = |(class, count): (i64, u64)| match class_name(class) {
        Some(name) => format!("{} of {class} ({name})", thousands(count)),
        None => format!("{} of {class}", thousands(count)),
    };
    let line = |what: &str, counts: Option<Counts>, each: &dyn Fn((i64, u64)) -> String| {
        let all: Vec<_> = counts?.into_iter().map(each).collect();
        Some(format!("{what}: {}\n", all.join(", ")))
    };
    let number = |(number, count): (i64, u64)| format!("{} of {number}", thousands(count));
    let lines = [
        line("points by class", of_classes(attributes), &class),
        line("points by return that are read", of_returns(attributes), &number),
    ];
    lines.into_iter().flatten().collect()
}
