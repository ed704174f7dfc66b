//! Tables of points: named columns of numbers, which become a [`Cloud`](crate::geometry::Cloud) whatever format they come from.
//!
//! A format declares its columns as an [`Element`](super::declared::Element); [`Layout`] finds those that are supported, by the names of
//! [PLY's properties](super::ply); the format [fills](fill) blocks of their numbers, which are converted to [`Arrays`] and collected as
//! [`Points`].

mod arrays;
pub mod binary;
mod block;
pub mod columns;
pub mod convert;
mod faces;
mod fill;
mod layout;
pub mod points;
mod shape;
pub mod text;

pub use arrays::Arrays;
pub use block::{Block, ROWS};
pub use convert::{Tally, linear};
pub use faces::Collector;
pub use fill::{Records, Rows, convert_next, fields, fill};
pub use layout::{Layout, Shape, is_colour};
pub use points::Points;
pub use shape::unit;
