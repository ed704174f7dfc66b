//! Every figure and table of the papers: what measures it here, or why nothing does.

mod botsch2003;
mod marroquim2008;
mod pajarola2004;
mod ren2002;
#[cfg(test)]
mod tests;
mod zwicker2004;

use super::quotation::{Paper, Passage, Quotation};

/// A figure or table.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Which.
    pub passage: Passage,
    /// What the paper says about it.
    pub says: Quotation,
    /// What measures it.
    pub coverage: Coverage,
}

/// What measures a figure or table.
#[derive(Clone, Copy, Debug)]
pub enum Coverage {
    /// Items of these names.
    Measured(&'static [&'static str]),
    /// An item that runs if one of its models is given, by `--models`.
    WithModels(&'static str),
    /// Nothing, for this reason.
    None(&'static str),
}

/// The figures and tables of a paper.
pub fn of(paper: Paper) -> &'static [Entry] {
    match paper {
        Paper::Zwicker2004 => &zwicker2004::ENTRIES,
        Paper::Ren2002 => &ren2002::ENTRIES,
        Paper::Botsch2003 => &botsch2003::ENTRIES,
        Paper::Pajarola2004 => &pajarola2004::ENTRIES,
        Paper::Marroquim2008 => &marroquim2008::ENTRIES,
    }
}

impl Coverage {
    /// Names of the items.
    pub fn items(&self) -> &[&'static str] {
        match self {
            Self::Measured(items) => items,
            Self::WithModels(item) => std::slice::from_ref(item),
            Self::None(_) => &[],
        }
    }
}

/// A figure or table that is quoted by its caption, or by a section that refers to it.
const fn entry(passage: Passage, says: Quotation, coverage: Coverage) -> Entry {
    Entry { passage, says, coverage }
}

const DIAGRAM: Coverage = Coverage::None("a diagram of the method: it shows no result");
