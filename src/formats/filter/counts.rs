//! Numbers of points by class and by return.

#[cfg(doc)]
use super::Filter;
use super::Returns;
use crate::settings::Choice;
use std::collections::BTreeMap;

/// Names of the standard classes from 0 on (ASPRS LAS specification 1.4 R15, table 17).
const CLASSES: [&str; 23] = [
    "never classified",
    "unclassified",
    "ground",
    "low vegetation",
    "medium vegetation",
    "high vegetation",
    "building",
    "low noise",
    "reserved",
    "water",
    "rail",
    "road surface",
    "reserved",
    "wire guard",
    "wire conductor",
    "transmission tower",
    "wire connector",
    "bridge deck",
    "high noise",
    "overhead structure",
    "ignored ground",
    "snow",
    "temporal exclusion",
];

/// Name of a standard class of the ASPRS LAS specification; `None` for others.
pub fn class_name(class: i64) -> Option<&'static str> {
    CLASSES.get(usize::try_from(class).ok()?).copied()
}

/// Numbers of points that each of these conditions of a [`Filter`] keeps by itself, of the points within [`Filter::bounds`] that
/// [`Filter::every`] does not leave out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilterCounts {
    /// Points by class; `None` if they have no property `classification`.
    pub classes: Option<BTreeMap<u8, u64>>,
    /// Points of each of the [`Returns`], in their order; `None` if they lack `return_number` or `number_of_returns`.
    pub returns: Option<[u64; 3]>,
}

impl FilterCounts {
    /// Counts of the points of two files together: a filter by what one of them lacks cannot read it.
    pub fn merge(self, other: Self) -> Self {
        let classes = self.classes.zip(other.classes).map(|(mut all, others)| {
            others.into_iter().for_each(|(class, count)| *all.entry(class).or_default() += count);
            all
        });
        let returns = self.returns.zip(other.returns);
        Self { classes, returns: returns.map(|(a, b)| [0, 1, 2].map(|i| a[i] + b[i])) }
    }
}

/// Running counts of rows.
#[derive(Clone)]
pub(in crate::formats) struct RowCounts {
    classes: [u64; 256],
    returns: [u64; 3],
}

impl RowCounts {
    /// Counts rows by their columns of the [`PROPERTIES`](super::PROPERTIES): those that `is_counted` accepts by their indices.
    pub fn of([classes, numbers, counts]: [&[f64]; 3], is_counted: impl Fn(usize) -> bool) -> Self {
        let mut all = Self { classes: [0; 256], returns: [0; 3] };
        for (_, class) in classes.iter().enumerate().filter(|(row, _)| is_counted(*row)) {
            // Only whole numbers in range are classes that a filter can choose.
            let code = *class as u8;
            all.classes[usize::from(code)] += u64::from(f64::from(code) == *class);
        }
        let pulses = numbers.iter().zip(counts).enumerate();
        for (_, (number, count)) in pulses.filter(|(row, _)| is_counted(*row)) {
            for (kept, returns) in all.returns.iter_mut().zip(Returns::ALL) {
                *kept += u64::from(returns.keeps(*number, *count));
            }
        }
        all
    }

    /// Adds other counts.
    pub fn add(&mut self, other: &Self) {
        let add = |(to, count): (&mut u64, &u64)| *to += count;
        self.classes.iter_mut().zip(&other.classes).for_each(add);
        self.returns.iter_mut().zip(&other.returns).for_each(add);
    }

    /// The counts of points that have some of the [`PROPERTIES`](super::PROPERTIES).
    pub fn of_points(&self, [classes, number, count]: [bool; 3]) -> FilterCounts {
        let some = (0..=u8::MAX).zip(self.classes).filter(|(_, count)| *count > 0);
        FilterCounts {
            classes: classes.then(|| some.collect()),
            returns: (number && count).then_some(self.returns),
        }
    }
}
