//! On the picture: what its colours mean, with the numbers at both ends.

use super::Told;
use super::raster::{paint_bar, short};
use crate::viewer::state::State;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Ui, pos2, vec2};
use surfel::geometry::{ColourMap, ColourScale, ValueRange};
use surfel::settings::Shading;

/// Width of a bar, and height of all that is said of it, points.
const SIZE: [f32; 2] = [200.0, 52.0];
/// How far it is from the edges, points.
const MARGIN: f32 = 8.0;
/// Colours of depths: the nearest surface is white, the farthest has a tenth of that.
const FARTHEST: u8 = 26;

/// What colours mean.
struct Legend {
    name: String,
    /// What is told at the ends; of directions nothing.
    range: Option<ValueRange>,
    colours: Colours,
}

enum Colours {
    Map(ColourMap),
    Greys,
    None,
}

/// Says what the colours of the picture, or of both pictures, mean: at its lower left, in what panels leave `free`.
pub fn show(ui: &Ui, free: Rect, picture: Rect, state: &State, told: &Told) {
    let painter = ui.painter().with_clip_rect(picture);
    let right = state.settings().and_then(|settings| told.split.asked(settings)).map(|(_, at)| at);
    let lefts = [Some(picture.left()), right.map(|at| picture.left() + at as f32 * picture.width())];
    for (left, range) in lefts.into_iter().zip(told.ranges) {
        let Some((left, legend)) = left.zip(legend_of(state, range)) else { continue };
        legend.paint(&painter, pos2(left + MARGIN, free.bottom().min(picture.bottom()) - MARGIN));
    }
}

/// What the colours mean, if that is not what surfels look like.
fn legend_of(state: &State, range: Option<ValueRange>) -> Option<Legend> {
    let numbers = |name: &str, colours| Some(Legend { name: name.into(), range: Some(range?), colours });
    let viridis = Colours::Map(ColourMap::Viridis);
    let from_0 = |range: ValueRange| ValueRange { min: 0.0, max: range.max.max(1.0) };
    match state.settings()?.shading {
        Shading::Lit | Shading::Colour => {
            let (name, ColourScale { map, range }) = state.colour_scale()?;
            Some(Legend { name, range: Some(range), colours: Colours::Map(map) })
        }
        Shading::Normal => {
            let name = "normal: x, y, z from −1 to 1 as red, green, blue".into();
            Some(Legend { name, range: None, colours: Colours::None })
        }
        Shading::Depth => numbers("depth, the positions' unit", Colours::Greys),
        Shading::Overlap => {
            Some(Legend { range: Some(from_0(range?)), ..numbers("overlap, splats", viridis)? })
        }
        Shading::Weight => {
            Some(Legend { range: Some(from_0(range?)), ..numbers("sum of weights", viridis)? })
        }
    }
}

impl Legend {
    /// Paints it with this lower left corner.
    fn paint(&self, painter: &Painter, corner: Pos2) {
        let ink = Color32::WHITE;
        let name = painter.layout_no_wrap(self.name.clone(), FontId::proportional(13.0), ink);
        let height = if self.range.is_some() { SIZE[1] } else { name.size().y };
        let width = name.size().x.max(if self.range.is_some() { SIZE[0] } else { 0.0 });
        let rect = Rect::from_min_size(corner - vec2(0.0, height), vec2(width, height));
        painter.rect_filled(rect.expand(5.0), 3.0, Color32::from_black_alpha(190));
        let below = rect.top() + name.size().y + 3.0;
        painter.galley(rect.min, name, ink);
        let Some(ValueRange { min, max }) = self.range else { return };
        let bar = Rect::from_min_size(pos2(rect.left(), below), vec2(SIZE[0], 12.0));
        match &self.colours {
            Colours::Map(map) => paint_bar(painter, bar, |part| map.at(part)),
            // Nearest first.
            Colours::Greys => paint_bar(painter, bar, |part| {
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
