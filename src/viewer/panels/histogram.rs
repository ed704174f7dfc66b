//! Histogram of the values that colours show, with the ends of the range to drag.

use super::raster::short_in;
use crate::viewer::distribution::Distribution;
use egui::{Color32, CursorIcon, Painter, Rect, Response, Sense, Stroke, Ui, pos2, vec2};
use surfel::geometry::{ColourMap, ColourScale, ValueRange};
use surfel::thousands;

/// Height, points.
const HEIGHT: f32 = 48.0;
/// Distance from an end of the range within which the cursor changes, points.
const NEAR: f32 = 5.0;
/// Opacity of bars beyond the range.
const CLIPPED: f32 = 0.35;

/// Values along the width of a rectangle.
struct Axis {
    rect: Rect,
    values: ValueRange,
}

impl Axis {
    fn x(&self, value: f64) -> f32 {
        self.rect.left() + self.values.share(value).clamp(0.0, 1.0) as f32 * self.rect.width()
    }

    fn value(&self, x: f32) -> f64 {
        let part = f64::from(((x - self.rect.left()) / self.rect.width()).clamp(0.0, 1.0));
        self.values.min * (1.0 - part) + self.values.max * part
    }

    /// Whether the first or the last end of the range is nearer.
    fn nearer(&self, x: f32, range: &ValueRange) -> usize {
        let [min, max] = [range.min, range.max].map(|value| (self.x(value) - x).abs());
        // Of equal ends, the one on the side of the cursor can be dragged.
        usize::from(if min == max { x > self.x(range.max) } else { max < min })
    }
}

/// Shows numbers of values on a logarithmic scale, in the colours that they have. Dragging moves the nearer end of the range.
pub fn show(ui: &mut Ui, of: &Distribution, map: ColourMap, range: &mut ValueRange) {
    let width = ui.available_width().min(300.0);
    let (response, painter) = ui.allocate_painter(vec2(width, HEIGHT), Sense::drag());
    let values = ValueRange { min: of.domain.min.min(range.min), max: of.domain.max.max(range.max) };
    let axis = Axis { rect: response.rect, values };
    drag(ui, &response, &axis, range);
    painter.rect_filled(axis.rect, 2.0, ui.visuals().extreme_bg_color);
    bars(&painter, &axis, of, &ColourScale { map, range: *range });
    let stroke = Stroke::new(1.0, ui.visuals().strong_text_color());
    for end in [range.min, range.max] {
        painter.vline(axis.x(end), axis.rect.y_range(), stroke);
    }
    let [below, above] = of.clipped(range).map(|part| format!("{:.1} %", 100.0 * part));
    let text = tooltip(&response, &axis, of);
    response.on_hover_text(format!(
        "{text}Numbers of values, on a logarithmic scale. Drag the ends of the range.\n{below} are below the range and {above} above it."
    ));
}

fn drag(ui: &Ui, response: &Response, axis: &Axis, range: &mut ValueRange) {
    let id = response.id.with("end");
    if let Some(at) = response.hover_pos().filter(|_| !response.dragged()) {
        let is_near = [range.min, range.max].iter().any(|end| (axis.x(*end) - at.x).abs() < NEAR);
        if is_near {
            ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
    }
    // The last move and the release may come in one frame.
    let is_dragged = response.dragged() || response.drag_stopped();
    let Some(at) = response.interact_pointer_pos().filter(|_| is_dragged) else { return };
    if response.drag_started() {
        ui.data_mut(|data| data.insert_temp(id, axis.nearer(at.x, range)));
    }
    let Some(end) = ui.data(|data| data.get_temp::<usize>(id)) else { return };
    let value = axis.value(at.x);
    match end {
        0 => range.min = value.min(range.max),
        _ => range.max = value.max(range.min),
    }
}

/// Paints a bar for each bin; those beyond the range are faint.
fn bars(painter: &Painter, axis: &Axis, of: &Distribution, scale: &ColourScale) {
    let most = of.counts.iter().copied().max().unwrap_or(0);
    for (index, count) in of.counts.iter().enumerate() {
        let [start, end] = of.bin(index);
        let middle = 0.5 * start + 0.5 * end;
        let [r, g, b] = scale.at(middle);
        let is_inside = (scale.range.min..=scale.range.max).contains(&middle);
        let colour = Color32::from_rgb(r, g, b).gamma_multiply(if is_inside { 1.0 } else { CLIPPED });
        let top = axis.rect.bottom() - height(*count, most) * (axis.rect.height() - 2.0);
        let bar = Rect::from_min_max(pos2(axis.x(start), top), pos2(axis.x(end), axis.rect.bottom()));
        painter.rect_filled(bar, 0.0, colour);
    }
}

/// Height of a bar, from 0 for nothing to 1 for the most.
fn height(count: u64, most: u64) -> f32 {
    if count == 0 { 0.0 } else { ((1.0 + count as f64).ln() / (1.0 + most as f64).ln()) as f32 }
}

/// The bin under the cursor, as a line of text; none elsewhere.
fn tooltip(response: &Response, axis: &Axis, of: &Distribution) -> String {
    let Some(at) = response.hover_pos() else { return String::new() };
    let value = axis.value(at.x);
    let found = (0..of.counts.len()).find(|index| {
        let [start, end] = of.bin(*index);
        (start..end).contains(&value)
    });
    found.map_or(String::new(), |index| {
        let [start, end] = of.bin(index).map(|value| short_in(value, &of.domain));
        format!("{start} to {end}: {}\n", thousands(of.counts[index]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_rise_with_the_logarithm_of_their_counts() {
        assert_eq!([height(0, 1000), height(1000, 1000)], [0.0, 1.0]);
        // A single value among a million can be seen.
        assert!(height(1, 1_000_000) > 0.04);
        assert!((height(999, 999_999) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn the_nearer_end_is_dragged() {
        let rect = Rect::from_min_size(pos2(10.0, 0.0), vec2(100.0, 40.0));
        let axis = Axis { rect, values: ValueRange { min: -1.0, max: 1.0 } };
        assert_eq!([axis.x(-1.0), axis.x(0.0), axis.x(5.0)], [10.0, 60.0, 110.0]);
        assert_eq!([axis.value(0.0), axis.value(60.0), axis.value(110.0)], [-1.0, 0.0, 1.0]);
        let range = ValueRange { min: -0.5, max: 0.5 };
        assert_eq!([axis.nearer(20.0, &range), axis.nearer(100.0, &range)], [0, 1]);
        let point = ValueRange { min: 0.0, max: 0.0 };
        assert_eq!([axis.nearer(40.0, &point), axis.nearer(80.0, &point)], [0, 1], "both ends can leave");
    }
}
