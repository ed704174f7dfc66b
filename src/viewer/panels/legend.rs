//! Legend on the picture: what its colours mean, with the range of values.

use super::UiState;
use super::raster::{paint_bar, short_in};
use crate::viewer::state::ViewState;
use egui::{Align2, Color32, FontId, Rect, Ui, pos2, vec2};
use surfel::formats::colour_bar::ColourBar;
use surfel::geometry::{ColourMap, ColourScale, ValueRange};
use surfel::settings::Shading;

/// Maximum width of a bar, and its height with the values, points.
const SIZE: [f32; 2] = [200.0, 34.0];
/// Minimum width for a legend, points.
const MIN_WIDTH: f32 = 90.0;
/// Distance from the edges, points.
const MARGIN: f32 = 8.0;
/// Grey level of the farthest depth; the nearest is white.
const FARTHEST: u8 = 26;

/// A legend.
#[derive(PartialEq)]
struct Legend {
    name: String,
    /// The values at both ends of the bar; `None` for directions.
    range: Option<ValueRange>,
    colours: Colours,
}

#[derive(PartialEq)]
enum Colours {
    Map(ColourMap),
    Greys,
    None,
}

/// Paints the legend at the lower left of the picture, or of both pictures, in the rectangle `free` of panels, unless it is hidden.
pub fn show(ui: &Ui, free: Rect, picture: Rect, state: &ViewState, ui_state: &UiState) {
    if !state.legend {
        return;
    }
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
    // Equal legends are painted once.
    second.iter().filter(|second| first.as_ref() != Some(second)).for_each(|legend| legend.paint(ui, right));
}

/// The legend of a picture; `None` if surfels have their own colours.
fn legend_of(state: &ViewState, range: Option<(Shading, ValueRange)>) -> Option<Legend> {
    legend_of_shading(state.settings()?.shading, range, || state.colour_bar())
}

/// The legend of a shading, with the range of the last picture's values and the map of the surfels' colours.
fn legend_of_shading(
    shading: Shading,
    range: Option<(Shading, ValueRange)>,
    bar: impl FnOnce() -> Option<ColourBar>,
) -> Option<Legend> {
    // The range may belong to the picture before.
    let range = range.filter(|(of, _)| *of == shading).map(|(_, range)| range);
    let from_0 = |range: ValueRange| ValueRange { min: 0.0, max: range.max.max(1.0) };
    let (name, range, colours) = match shading {
        Shading::Lit | Shading::Colour | Shading::Edl => {
            let ColourBar { name, scale: ColourScale { map, range }, .. } = bar()?;
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
    /// Paints the legend at the lower left of a rectangle, within its width.
    fn paint(&self, ui: &Ui, within: Rect) {
        let painter = ui.painter().with_clip_rect(within);
        let room = within.width() - 2.0 * MARGIN;
        if room < MIN_WIDTH {
            return;
        }
        let ink = Color32::WHITE;
        let name = painter.layout(self.name.clone(), FontId::proportional(13.0), ink, room);
        let bar = if self.range.is_some() { SIZE } else { [0.0; 2] };
        let size = vec2(name.size().x.max(bar[0].min(room)), name.size().y + bar[1]);
        let corner = within.left_bottom() + vec2(MARGIN, -MARGIN);
        let rect = Rect::from_min_size(corner - vec2(0.0, size.y), size);
        painter.rect_filled(rect.expand(5.0), 3.0, Color32::from_black_alpha(190));
        let below = rect.top() + name.size().y + 3.0;
        painter.galley(rect.min, name, ink);
        let Some(range @ ValueRange { min, max }) = self.range else { return };
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
            painter.text(at + vec2(0.0, 2.0), align, short_in(value, &range), font.clone(), ink);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_begin_at_0_and_reach_1_at_least() {
        let range = |shading: Shading, of: Shading, [min, max]: [f64; 2]| {
            let legend = legend_of_shading(shading, Some((of, ValueRange { min, max })), || None)?;
            legend.range.map(|range| [range.min, range.max])
        };
        for sum in [Shading::Overlap, Shading::Weight] {
            assert_eq!(range(sum, sum, [3.0, 7.0]), Some([0.0, 7.0]));
            assert_eq!(range(sum, sum, [0.0, 0.2]), Some([0.0, 1.0]));
            assert_eq!(range(sum, Shading::Depth, [3.0, 7.0]), None, "the picture before");
        }
        assert_eq!(range(Shading::Depth, Shading::Depth, [3.0, 7.0]), Some([3.0, 7.0]));
        assert_eq!(range(Shading::Normal, Shading::Depth, [3.0, 7.0]), None);
        assert!(legend_of_shading(Shading::Lit, None, || None).is_none());
    }
}
