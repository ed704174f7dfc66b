//! Raster: values of pixels, shown as a picture with a colour map and a range.

use super::render_settings;
use crate::viewer::distribution::Distribution;
use egui::{
    Align2, Color32, ColorImage, Context, FontId, Image, Painter, Rect, Sense, TextureHandle, TextureOptions,
    Ui, Window, pos2, vec2,
};
use surfel::geometry::{ColourMap, ColourScale, ValueRange};

/// Number of columns of a colour bar.
const COLUMNS: usize = 64;

/// Values of all pixels.
pub struct Raster {
    /// What the values are, with their unit.
    name: String,
    /// Width and height, px.
    size: [u32; 2],
    values: Values,
    map: ColourMap,
    range: ValueRange,
    /// Of the numbers, if there are any.
    distribution: Option<Distribution>,
    /// The texture, and the scale that it was made with.
    texture: Option<(TextureHandle, ColourScale)>,
}

/// Values, row by row from the top left.
pub enum Values {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f32>),
    /// Unit vectors, shown as red, green and blue; 0 where there is none.
    Directions(Vec<[f32; 3]>),
}

impl Raster {
    /// A raster with the default colour map, in its default range.
    pub fn new(name: impl Into<String>, size: [u32; 2], values: Values) -> Self {
        let distribution = match &values {
            Values::Numbers(numbers) => Distribution::of(numbers.iter().copied().map(f64::from)),
            Values::Directions(_) => None,
        };
        let range = distribution.as_ref().map_or(ValueRange { min: 0.0, max: 1.0 }, |known| known.range);
        Self {
            name: name.into(),
            size,
            values,
            map: ColourMap::default(),
            range,
            distribution,
            texture: None,
        }
    }

    /// The raster with another colour map, and with a range from `min`.
    pub fn with(mut self, map: ColourMap, min: f64) -> Self {
        self.map = map;
        self.range.min = min;
        self
    }

    /// Shows a window with the picture; `open` becomes false when it is closed.
    fn show(&mut self, context: &Context, id: &str, open: &mut bool) {
        let title = format!("{}, {}x{}", self.name, self.size[0], self.size[1]);
        Window::new(title)
            .id(egui::Id::new(id))
            .open(open)
            .resizable(true)
            .default_size([520.0, 460.0])
            .show(context, |ui| {
                if let Values::Numbers(_) = self.values {
                    render_settings::map(ui, &mut self.map);
                    render_settings::range(ui, &mut self.range, self.map, self.distribution.as_ref());
                    colour_bar(ui, &self.scale());
                }
                self.picture(ui);
            });
    }

    fn scale(&self) -> ColourScale {
        ColourScale { map: self.map, range: self.range }
    }

    fn picture(&mut self, ui: &mut Ui) {
        let scale = self.scale();
        if self.texture.as_ref().is_none_or(|(_, known)| *known != scale) {
            let image = ColorImage::from_rgb(self.size.map(|side| side as usize), &self.pixels(&scale));
            let texture = ui.ctx().load_texture("raster", image, TextureOptions::NEAREST);
            self.texture = Some((texture, scale));
        }
        let Some((texture, _)) = &self.texture else { return };
        let own = vec2(self.size[0] as f32, self.size[1] as f32);
        let room = vec2(ui.available_width(), (ui.available_height() - 20.0).max(64.0));
        let size = own * (room.x / own.x).min(room.y / own.y);
        let response = ui.add(Image::new(texture).fit_to_exact_size(size).sense(Sense::hover()));
        let at = response.hover_pos().map(|at| (at - response.rect.min) / size * own);
        let text = at.and_then(|at| self.pixel_text([at.x as u32, at.y as u32]));
        ui.monospace(
            text.unwrap_or_else(|| "Move the cursor over the picture to see a pixel's value.".into()),
        );
    }

    fn pixels(&self, scale: &ColourScale) -> Vec<u8> {
        let code = |coordinate: f32| ((0.5 * coordinate + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8;
        match &self.values {
            Values::Numbers(numbers) => numbers
                .iter()
                .flat_map(|number| if number.is_nan() { [0; 3] } else { scale.at((*number).into()) })
                .collect(),
            Values::Directions(all) => {
                all.iter().flat_map(|v| if *v == [0.0; 3] { [0; 3] } else { v.map(code) }).collect()
            }
        }
    }

    /// The value of a pixel, as text.
    fn pixel_text(&self, [x, y]: [u32; 2]) -> Option<String> {
        let [width, height] = self.size;
        let index = (x < width && y < height).then_some((y * width + x) as usize)?;
        Some(match &self.values {
            Values::Numbers(numbers) if numbers[index].is_nan() => format!("({x}, {y})  nothing"),
            Values::Numbers(numbers) => format!("({x}, {y})  {}", numbers[index]),
            Values::Directions(all) if all[index] == [0.0; 3] => format!("({x}, {y})  nothing"),
            Values::Directions(all) => {
                let [a, b, c] = all[index];
                format!("({x}, {y})  {a:.5} {b:.5} {c:.5}")
            }
        })
    }
}

/// A window with a raster, once there is one.
#[derive(Default)]
pub struct RasterWindow {
    pub raster: Option<Raster>,
    pub open: bool,
}

impl RasterWindow {
    /// Drops the texture of an egui context before the context itself is dropped.
    pub fn release_texture(&mut self) {
        self.raster.iter_mut().for_each(|raster| raster.texture = None);
    }

    /// Closes the window; returns whether it was open.
    pub fn close(&mut self) -> bool {
        self.raster.is_some() && std::mem::take(&mut self.open)
    }

    /// Shows the window, if it is open.
    pub fn show(&mut self, context: &Context, id: &str) {
        if let Some(raster) = self.raster.as_mut().filter(|_| self.open) {
            raster.show(context, id, &mut self.open);
        }
    }
}

/// Shows the colours of a scale, with the values at both ends and in the middle.
pub fn colour_bar(ui: &mut Ui, scale: &ColourScale) {
    let (response, painter) =
        ui.allocate_painter(vec2(ui.available_width().min(300.0), 26.0), Sense::hover());
    let rect = response.rect;
    paint_bar(&painter, Rect { max: pos2(rect.right(), rect.top() + 12.0), ..rect }, |part| {
        scale.map.at(part)
    });
    let (ink, font) = (ui.visuals().text_color(), FontId::proportional(10.0));
    let ValueRange { min, max } = scale.range;
    let ends = [
        (0.0, Align2::LEFT_BOTTOM, min),
        (0.5, Align2::CENTER_BOTTOM, 0.5 * (min + max)),
        (1.0, Align2::RIGHT_BOTTOM, max),
    ];
    for (part, align, value) in ends {
        let at = pos2(rect.left() + part * rect.width(), rect.bottom());
        painter.text(at, align, short_in(value, &scale.range), font.clone(), ink);
    }
}

/// Fills a rectangle from left to right with the sRGB colours of the fractions from 0 to 1.
pub fn paint_bar(painter: &Painter, rect: Rect, colour: impl Fn(f64) -> [u8; 3]) {
    let width = rect.width() / COLUMNS as f32;
    for column in 0..COLUMNS {
        let [r, g, b] = colour((column as f64 + 0.5) / COLUMNS as f64);
        let left = rect.left() + column as f32 * width;
        let bar = Rect::from_min_max(pos2(left, rect.top()), pos2(left + width + 0.5, rect.bottom()));
        painter.rect_filled(bar, 0.0, Color32::from_rgb(r, g, b));
    }
}

/// Formats a value with four significant digits.
pub fn short(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e5).contains(&size) => {
            let digits = (3 - size.log10().floor() as i32).max(0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.3e}"),
    }
}

/// Formats a value of a range with as many digits as tell thousandths of the range apart.
pub fn short_in(value: f64, range: &ValueRange) -> String {
    let width = range.max - range.min;
    let size = range.min.abs().max(range.max.abs());
    if !(width > 1e-9 * size && size < 1e9) {
        return short(value);
    }
    match 2 - width.log10().floor() as i32 {
        digits @ 0..=6 => format!("{value:.*}", digits as usize),
        ..0 => format!("{value:.0}"),
        _ => short(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_their_colours_and_missing_ones_are_black() {
        let values = vec![0.0, 1.0, f32::NAN, 2.0];
        let raster = Raster::new("x", [2, 2], Values::Numbers(values)).with(ColourMap::Magma, 0.0);
        let pixels =
            raster.pixels(&ColourScale { map: ColourMap::Magma, range: ValueRange { min: 0.0, max: 2.0 } });
        assert_eq!(pixels[..3], ColourMap::Magma.at(0.0));
        assert_eq!(pixels[3..6], ColourMap::Magma.at(0.5));
        assert_eq!(pixels[6..9], [0; 3]);
        assert_eq!(pixels[9..], ColourMap::Magma.at(1.0));
        assert_eq!(raster.pixel_text([0, 1]).unwrap(), "(0, 1)  nothing");
        assert_eq!(raster.pixel_text([1, 1]).unwrap(), "(1, 1)  2");
        assert_eq!(raster.pixel_text([2, 0]), None);
    }

    #[test]
    fn values_of_a_narrow_range_differ() {
        let text = |min, max| short_in(min, &ValueRange { min, max });
        assert_eq!(
            [text(245_380.25, 245_500.0), text(407.03, 432.2), text(-0.5, 0.5)],
            ["245380", "407.0", "-0.50"]
        );
        assert_eq!([text(0.0, 1e-12), text(0.0, 1e12), text(5.0, 5.0)], ["0", "0", "5.000"]);
        assert_eq!([text(0.0, 65_535.0), text(1e7, 1e7 + 0.5)], ["0", "10000000.000"]);
    }

    #[test]
    fn values_have_four_digits() {
        assert_eq!(
            [0.0, 1.0, 0.012342, 123456.0, -2.5].map(short),
            ["0", "1.000", "0.01234", "1.235e5", "-2.500"]
        );
    }
}
