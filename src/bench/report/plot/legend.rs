//! The legend, in rows between title and axes, where it covers no data.

use super::draw::{Drawn, FINE, FONT, LEFT, Root, WIDTH, fault, font, mark, shorten, write};
use super::labels::{rows, width, wrap};
use super::style::{GREY, INK};
use super::{Kind, Plot, Style};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Height of a row, px.
const ROW: i32 = 20;
/// Width of a line sample, px.
const SAMPLE: i32 = 28;
/// Gap between entries, px.
const GAP: i32 = 18;

/// Entries and their positions.
pub struct Legend {
    entries: Vec<Entry>,
    /// Row, and distance from the left of the axes, px.
    places: Vec<(i32, i32)>,
    /// Height of all rows, px.
    pub height: i32,
}

struct Entry {
    /// The label, broken into lines.
    lines: Vec<String>,
    /// Style of a line; for marks, whether they are faults.
    look: Result<Style, bool>,
}

/// Lays out the lines that have labels; one whose label is too wide for a row takes several, alone. A single line needs no legend.
pub fn lay_out(plot: &Plot) -> Legend {
    let most = WIDTH - LEFT - 10;
    let entry = |label: &str, look| {
        let lines = wrap(label, FONT, most - SAMPLE);
        Entry { lines: lines.iter().map(|line| shorten(line, FONT, most - SAMPLE)).collect(), look }
    };
    let labelled = plot.lines.iter().filter(|line| !line.label.is_empty());
    let mut entries: Vec<Entry> = labelled.map(|line| entry(&line.label, Ok(line.style))).collect();
    for (fault, label) in [(true, "fault"), (false, "refused")] {
        if plot.marks.iter().any(|mark| mark.fault == fault) {
            entries.push(entry(label, Err(fault)));
        }
    }
    if entries.len() == 1 {
        entries.clear();
    }
    let wide = |entry: &Entry| match entry.lines.as_slice() {
        [line] => SAMPLE + width(line, FONT),
        _ => most,
    };
    let (mut places, count) = rows(&entries.iter().map(wide).collect::<Vec<_>>(), GAP, most);
    let mut more = 0;
    for ((row, _), entry) in places.iter_mut().zip(&entries) {
        *row += more;
        more += entry.lines.len() as i32 - 1;
    }
    Legend { entries, places, height: (count + more) * ROW }
}

/// Draws the legend with its upper edge at `top` px.
pub fn draw(root: &Root<'_>, legend: &Legend, top: i32) -> Drawn {
    for (entry, (row, left)) in legend.entries.iter().zip(&legend.places) {
        let (x, y) = (LEFT + left, top + row * ROW + ROW / 2);
        sample(root, entry.look, [x, y])?;
        for (line, below) in entry.lines.iter().zip((0..).step_by(ROW as usize)) {
            write(root, line, [x + SAMPLE, y + below], &font(FONT, INK, HPos::Left, VPos::Center))?;
        }
    }
    Ok(())
}

fn sample(root: &Root<'_>, look: Result<Style, bool>, [x, y]: [i32; 2]) -> Drawn {
    let [left, right, y] = [x, x + SAMPLE - 7, y].map(|length| length * FINE);
    let fine = FINE as u32;
    let line = |ends: [i32; 2], style: ShapeStyle| root.draw(&PathElement::new(ends.map(|x| (x, y)), style));
    let middle = (left + right) / 2;
    let style = match look {
        Ok(style) => style,
        Err(is_fault) => return fault(root, [middle, y], is_fault),
    };
    match (style.kind, style.dashed) {
        (Kind::Band, _) => line([left, right], GREY.mix(0.28).stroke_width(9 * fine))?,
        (Kind::Faint | Kind::Loose | Kind::Ring | Kind::Whiskers | Kind::Crosses, _) => {}
        (Kind::Joined, false) => line([left, right], style.rgb().stroke_width(2 * fine))?,
        (Kind::Joined, true) => {
            for start in [left, right - 6 * FINE] {
                line([start, start + 6 * FINE], style.rgb().stroke_width(2 * fine))?;
            }
        }
    }
    mark(root, [middle, y], &style)
}
