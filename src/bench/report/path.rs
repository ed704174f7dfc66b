//! Lines of plots along a camera path.

use super::plot::{Kind, Line, Scale, Style};
use crate::bench::record::Run;
use crate::verify::metrics::path::PathValues;

/// Labels of the vertical axes.
pub const RMSE: &str = "RMSE, linear light";
pub const FLICKER: &str = "flicker, linear light";

/// The axes of a plot over frames.
pub fn axes(y: &str) -> [(&str, Scale); 2] {
    [("frame", Scale::Linear), (y, Scale::Linear)]
}

/// A line of values of frames, the first of which is `first`.
pub fn line(label: impl Into<String>, style: Style, first: u32, values: &[f64]) -> Line {
    let points = (first..).zip(values).map(|(frame, value)| [f64::from(frame), *value]).collect();
    Line::new(label, style, points)
}

/// A ring around the point `index` of a line, with its frame as a note.
pub fn ring(label: &str, of: &Line, index: usize) -> Option<Line> {
    let point = *of.points.get(index)?;
    let style = Style { kind: Kind::Ring, ..of.style };
    Some(Line { notes: vec![format!("frame {}", point[0])], ..Line::new(label, style, vec![point]) })
}

/// Index of the largest value.
pub fn largest(values: &[f64]) -> Option<usize> {
    (0..values.len()).min_by(|a, b| values[*b].total_cmp(&values[*a]))
}

/// The runs that followed a camera path, with its values.
pub fn followed<'r>(runs: &[&'r Run]) -> Vec<(&'r Run, &'r PathValues)> {
    runs.iter().filter_map(|run| Some((*run, run.error.as_ref()?.path.as_ref()?))).collect()
}
