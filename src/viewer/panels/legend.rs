//! On the picture: what its colours mean, with the numbers at both ends.

use super::UiState;
use super::raster::{paint_bar, short};
use crate::viewer::state::State;
use egui::{Align2, Color32, FontId, Rect, Ui, pos2, vec2};
use surfel::geometry::{ColourMap, ColourScale, ValueRange};
use surfel::settings::Shading;

/// Width of a bar at most, and its height with its numbers, points.
const SIZE: [f32; 2] = [200.0, 34.0];
/// Least width that anything can be said in, points.
const LEAST: f32 = 90.0;
/// How far it is from the edges, points.
const MARGIN: f32 = 8.0;
/// Colours of depths: the nearest surface is white, the farthest has a tenth of that.
const FARTHEST: u8 = 26;

/// What colours mean.
#[derive(PartialEq)]
struct Legend {
    name: String,
    /// What is told at the ends; of directions nothing.
    range: Option<ValueRange>,
    colours: Colours,
}

#[derive(PartialEq)]
enum Colours {
    Map(ColourMap),
    Greys,
    None,
}

/// Says what the colours of the picture, or of both pictures, mean: at the lower left of each, in what panels leave `free`.
pub fn show(ui: &Ui, free: Rect, picture: Rect, state: &State, ui_state: &UiState) {
    let right = ui_state.split(state).map(|(_, at)| at);
    let bottom = free.bottom().min(picture.bottom());
    let whole = Rect { max: pos2(picture.right(), bottom), ..picture };
    let [first, second] = ui_state.ranges.map(|range| legend_of(state, range));
    let Some(at) = right.map(|at| picture.left() + at as f32 * picture.width()) else {
        first.iter().for_each(|legend| legend.paint(ui, whole));
        return;
    };
    let (left, right) = whole.split_left_right_at_x(at);
    first.iter().for_each(|legend| legend.paint(ui, left));
    // What is the same on both sides is said once.
    second.iter().filter(|second| first.as_ref() != Some(second)).for_each(|legend| legend.paint(ui, right));
}

/// What the colours mean, if that is not what surfels look like.
fn legend_of(state: &State, range: Option<(Shading, ValueRange)>) -> Option<Legend> {
    let shading = state.settings()?.shading;
    // What is known may be of a picture before.
    let range = range.filter(|(of, _)| *of == shading).map(|(_, range)| range);
    let from_0 = |range: ValueRange| ValueRange { min: 0.0, max: range.max.max(1.0) };
    let (name, range, colours) = match shading {
        Shading::Lit | Shading::Colour => {
            let (name, ColourScale { map, range }) = state.colour_scale()?;
            return Some(Legend { name, range: Some(range), colours: Colours::Map(map) });
        }
        Shading::Normal => ("normal: x, y, z from −1 to 1 as red, green, blue", None, Colours::None),
        Shading::Depth => ("depth, the positions' unit", Some(range?), Colours::Greys),
        Shading::Overlap => ("overlap, splats", Some(from_0(range?)), Colours::Map(ColourMap::Viridis)),
        Shading::Weight => ("sum of weights", Some(from_0(range?)), Colours::Map(ColourMap::Viridis)),
    };
    Some(Legend { name: name.into(), range, colours })
}

impl Legend {
    /// Paints it at the lower left of a rectangle, no wider than that.
    fn paint(&self, ui: &Ui, side: Rect) {
        let painter = ui.painter().with_clip_rect(side);
        let room = side.width() - 2.0 * MARGIN;
        if room < LEAST {
            return;
        }
        let ink = Color32::WHITE;
        let name = painter.layout(self.name.clone(), FontId::proportional(13.0), ink, room);
        let bar = if self.range.is_some() { SIZE } else { [0.0; 2] };
        let size = vec2(name.size().x.max(bar[0].min(room)), name.size().y + bar[1]);
        let corner = side.left_bottom() + vec2(MARGIN, -MARGIN);
        let rect = Rect::from_min_size(corner - vec2(0.0, size.y), size);
        painter.rect_filled(rect.expand(5.0), 3.0, Color32::from_black_alpha(190));
        let below = rect.top() + name.size().y + 3.0;
        painter.galley(rect.min, name, ink);
        let Some(ValueRange { min, max }) = self.range else { return };
        let bar = Rect::from_min_size(pos2(rect.left(), below), vec2(bar[0].min(room), 12.0));
        match &self.colours {
            Colours::Map(map) => paint_bar(&painter, bar, |part| map.at(part)),
            // Nearest first.
            Colours::Greys => paint_bar(&painter, bar, |part| {
                [(255.0 + part * (f64::from(FARTHEST) - 255.0)).round() as u8; 3]
            }),
            Colours::None => {}
        }
        let font = FontId::proportional(12.0);
        for (at, align, value) in [
            (bar.left_bottom(), Align2::LEFT_TOP, min),
            (bar.center_bottom(), Align2::CENTER_TOP, 0.5 * (min + max)),
            (bar.right_bottom(), Align2::RIGHT_TOP, max),
        ] {
            painter.text(at + vec2(0.0, 2.0), align, short(value), font.clone(), ink);
        }
    }
}
