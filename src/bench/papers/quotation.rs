//! Quotations: what the papers say, and where.

use std::fmt;

/// A paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "lowercase")]
pub enum Paper {
    /// Zwicker et al., Perspective Accurate Splatting, 2004.
    Zwicker2004,
    /// Ren et al., Object Space EWA Surface Splatting, 2002.
    Ren2002,
    /// Botsch, Kobbelt, High-Quality Point-Based Rendering on Modern GPUs, 2003.
    Botsch2003,
    /// Pajarola et al., Confetti, 2004.
    Pajarola2004,
    /// Marroquim, Kraus, Cavalcanti, Efficient Image Reconstruction, 2008.
    Marroquim2008,
}

/// Part of a paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Passage {
    /// A figure, with its caption.
    Figure(u32),
    /// A table, with its caption.
    Table(u32),
    /// A section, by its number.
    Section(&'static str),
}

/// What a paper says, in its own words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quotation {
    /// The paper.
    pub paper: Paper,
    /// Where.
    pub passage: Passage,
    /// The words.
    pub text: &'static str,
}

impl Paper {
    /// Authors and year, as in `zwicker2004`.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Numbers of figures and of tables.
    pub fn counts(self) -> [u32; 2] {
        match self {
            Self::Zwicker2004 => [8, 2],
            Self::Ren2002 => [12, 2],
            Self::Botsch2003 => [9, 1],
            Self::Pajarola2004 => [18, 2],
            Self::Marroquim2008 => [19, 1],
        }
    }

    /// A quotation.
    pub const fn says(self, passage: Passage, text: &'static str) -> Quotation {
        Quotation { paper: self, passage, text }
    }
}

impl Quotation {
    /// Paper and passage, as in `zwicker2004 figure 7`.
    pub fn source(&self) -> String {
        format!("{} {}", self.paper.name(), self.passage)
    }
}

impl fmt::Display for Passage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Figure(number) => write!(f, "figure {number}"),
            Self::Table(number) => write!(f, "table {number}"),
            Self::Section(number) => write!(f, "section {number}"),
        }
    }
}

impl fmt::Display for Quotation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "“{}” ({})", self.text, self.source())
    }
}
