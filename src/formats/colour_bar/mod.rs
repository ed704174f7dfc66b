//! Colour bar: a legend of the colours in a picture.

mod canvas;
mod ticks;

use super::image::{Encoded, Output, write};
use crate::error::{Error, Result};
use crate::geometry::ColourScale;
use crate::picture::Picture;
use crate::settings::Shading;
use canvas::{Font, Rectangle};
use ticks::{Tick, ticks};

/// The colours of a scale with some labelled values.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBar {
    /// Colour map and range.
    pub scale: ColourScale,
    /// Name of the quantity, above the bar.
    pub name: String,
    /// Kind of the values.
    pub values: BarValues,
}

/// Kind of the values of a colour bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BarValues {
    /// Any numbers.
    #[default]
    Numbers,
    /// Whole numbers, without labels between them.
    Integers,
    /// Classes of the ASPRS LAS specification, with their names ([`class_name`](super::class_name)) where there is room.
    Classes,
}

/// Width and height of the smallest picture with a bar, px.
const LEAST_SIZE: [u32; 2] = [160, 128];
/// Lines of text that fit the shorter side of the picture.
const LINES: u32 = 45;
/// Height of the bar, as a part of the picture's.
const HEIGHT: f64 = 0.6;
/// Theme for light pictures. In linear light, a little white is enough behind dark letters.
const LIGHT: Theme = Theme { panel: [255; 3], ink: [16; 3], opacity: 0.65 };
/// Theme for dark pictures.
const DARK: Theme = Theme { panel: [16; 3], ink: [240; 3], opacity: 0.8 };
/// Opacity of the panel's edge.
const EDGE: f64 = 0.4;

/// Writes a picture as [`write()`] does; as PNG with a colour bar, if one is given.
///
/// # Errors
/// As [`write()`] and [`ColourBar::check`].
pub fn write_with(picture: &Picture, shading: Shading, bar: Option<&ColourBar>, out: &Output) -> Result<()> {
    let Some(bar) = bar else { return write(picture, shading, out) };
    let mut encoded = Encoded::of(picture, shading)?;
    bar.draw(&mut encoded)?;
    encoded.write_png(out)
}

/// Colours, sRGB-encoded.
struct Theme {
    panel: [u8; 3],
    ink: [u8; 3],
    /// Opacity of the panel, in linear light.
    opacity: f64,
}

/// Positions of all parts, px.
struct Layout {
    font: Font,
    panel: Rectangle,
    bar: Rectangle,
    title: [u32; 2],
}

impl ColourBar {
    /// Returns an error for a picture that is too small for a bar.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub fn check(size: [u32; 2]) -> Result<()> {
        let ([width, height], [least_width, least_height]) = (size, LEAST_SIZE);
        if width >= least_width && height >= least_height {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "a picture of {width}x{height} px has no room for a colour bar: make it {least_width}x{least_height} or larger"
        )))
    }

    /// Draws the bar inside the right edge, on a translucent panel that is light on a light picture and dark on a dark one.
    ///
    /// # Errors
    /// As [`ColourBar::check`].
    pub fn draw(&self, picture: &mut Encoded) -> Result<()> {
        Self::check(picture.size())?;
        let (layout, name, ticks) = self.layout(picture.size());
        let Theme { panel, ink, opacity } = if picture.lightness(layout.panel) > 0.2 { LIGHT } else { DARK };
        picture.fill(layout.panel, panel, opacity);
        // Without an edge, a panel of the background's colour would look like the end of the object.
        layout.panel.edges().into_iter().for_each(|edge| picture.fill(edge, ink, EDGE));
        picture.text(layout.title, &name, layout.font, ink);
        self.draw_bar(picture, layout.bar, ink);
        ticks.iter().for_each(|tick| layout.draw_tick(picture, tick, ink));
        Ok(())
    }

    /// Width of the part of a picture of this size at its right edge that the bar covers, px; 0 if it is too small for a bar.
    pub fn width(&self, size: [u32; 2]) -> u32 {
        if Self::check(size).is_err() {
            return 0;
        }
        size[0] - self.layout(size).0.panel.x
    }

    /// Positions of all parts, the name and the ticks, in a picture of this size.
    fn layout(&self, size: [u32; 2]) -> (Layout, String, Vec<Tick>) {
        let named = self.layout_of(size, self.values);
        let is_wide = named.0.panel.width > size[0] / 3;
        if self.values == BarValues::Classes && is_wide {
            self.layout_of(size, BarValues::Integers)
        } else {
            named
        }
    }

    fn layout_of(&self, size: [u32; 2], values: BarValues) -> (Layout, String, Vec<Tick>) {
        let font = Font::of_height(size[0].min(size[1]) / LINES);
        let height = (f64::from(size[1]) * HEIGHT) as u32 - 2 * font.height();
        let ticks = ticks(&self.scale.range, 1.1 * f64::from(font.height()) / f64::from(height), values);
        let name = self.title(font, size[0] / 2);
        (Layout::of(size, font, height, &name, &ticks), name, ticks)
    }

    /// The name, truncated to `width` px.
    fn title(&self, font: Font, width: u32) -> String {
        let most = (width / font.advance()) as usize;
        if self.name.chars().count() > most {
            self.name.chars().take(most.saturating_sub(2)).chain("..".chars()).collect()
        } else {
            self.name.clone()
        }
    }

    fn draw_bar(&self, picture: &mut Encoded, bar: Rectangle, ink: [u8; 3]) {
        let frame = Rectangle { x: bar.x - 1, y: bar.y - 1, width: bar.width + 2, height: bar.height + 2 };
        picture.fill(frame, ink, 1.0);
        for row in 0..bar.height {
            let share = 1.0 - (f64::from(row) + 0.5) / f64::from(bar.height);
            let line = Rectangle { y: bar.y + row, height: 1, ..bar };
            picture.fill(line, self.scale.map.at(share), 1.0);
        }
    }
}

impl Layout {
    /// A panel as wide as its widest line, in the middle of the right edge.
    fn of(size: [u32; 2], font: Font, height: u32, name: &str, ticks: &[Tick]) -> Self {
        let line = font.height();
        let gap = line / 2;
        let labels = ticks.iter().map(|tick| font.width(&tick.label)).max().unwrap_or_default();
        let inner = (line + gap + labels).max(font.width(name)).min(size[0] - 4 * gap);
        let (width, tall) = (inner + 2 * gap, height + 2 * line + 2 * gap);
        let panel = Rectangle { x: size[0] - width - gap, y: (size[1] - tall) / 2, width, height: tall };
        let title = [panel.x + gap, panel.y + gap];
        // Half a line more than the title needs, for the upper half of the maximum's label.
        let bar = Rectangle { x: title[0], y: title[1] + line + line / 2, width: line, height };
        Self { font, panel, bar, title }
    }

    fn draw_tick(&self, picture: &mut Encoded, tick: &Tick, ink: [u8; 3]) {
        let (line, bar) = (self.font.height(), self.bar);
        let y = bar.y + ((1.0 - tick.share) * f64::from(bar.height - 1)).round() as u32;
        let thickness = (line / 16).max(1);
        let mark =
            Rectangle { x: bar.x + bar.width, y: y - thickness / 2, width: line / 4, height: thickness };
        picture.fill(mark, ink, 1.0);
        picture.text([bar.x + bar.width + line / 2, y - line / 2], &tick.label, self.font, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{ColourMap, ValueRange};

    fn bar(name: &str, min: f64, max: f64) -> ColourBar {
        let scale = ColourScale { map: ColourMap::Viridis, range: ValueRange { min, max } };
        ColourBar { scale, name: name.into(), values: BarValues::Numbers }
    }

    fn drawn(bar: &ColourBar, [width, height]: [u32; 2], background: [u8; 4]) -> Encoded {
        let pixels = vec![background; width as usize * height as usize];
        let mut picture = Encoded::new([width, height], pixels).unwrap();
        bar.draw(&mut picture).unwrap();
        picture
    }

    #[test]
    fn every_colour_is_shown_from_the_greatest_value_to_the_least() {
        let picture = drawn(&bar("height", 0.0, 1.0), [256, 256], [255; 4]);
        let row_of = |share| {
            let colour = ColourMap::Viridis.at(share);
            let apart =
                |pixel: &[u8; 4]| (0..3).map(|i| u32::from(pixel[i].abs_diff(colour[i]))).sum::<u32>();
            let nearest = (0..).zip(picture.pixels()).min_by_key(|(_, pixel)| apart(pixel)).unwrap();
            assert!(apart(nearest.1) <= 6, "{share}: {nearest:?}");
            nearest.0 / 256
        };
        let rows = [0.95, 0.75, 0.5, 0.25, 0.05].map(row_of);
        // 0.6 of the height is the bar with its name.
        assert!(rows.is_sorted() && rows[4] - rows[0] > 100, "{rows:?}");
    }

    #[test]
    fn names_of_classes_take_at_most_a_third_of_the_width() {
        let classes = ColourBar { values: BarValues::Classes, ..bar("classes", 1.0, 2.0) };
        let integers = ColourBar { values: BarValues::Integers, ..classes.clone() };
        assert_eq!(classes.width([256, 256]), integers.width([256, 256]));
        assert!(classes.width([512, 256]) > integers.width([512, 256]) && classes.width([512, 256]) < 180);
        assert_eq!(classes.width([100, 100]), 0);
    }

    #[test]
    fn ink_stands_out_of_every_background() {
        let light = |[r, g, b, _]: [u8; 4]| u32::from(r) + u32::from(g) + u32::from(b);
        for background in [[255; 4], [0, 0, 0, 255], [0; 4], [120, 120, 120, 255], [250, 0, 0, 255]] {
            let bar = bar("x", -3.0, 3.0);
            let picture = drawn(&bar, [200, 200], background);
            let changed = || picture.pixels().iter().filter(|pixel| **pixel != background).copied();
            // The panel is the commonest of the new colours.
            let mut counts = std::collections::BTreeMap::new();
            changed().for_each(|pixel| *counts.entry(pixel).or_insert(0) += 1);
            let panel = counts.iter().max_by_key(|(_, count)| **count).map_or([0; 4], |(pixel, _)| *pixel);
            let grey = changed().filter(|[r, g, b, _]| r == g && g == b);
            let furthest = grey.map(|pixel| light(pixel).abs_diff(light(panel))).max();
            assert!(furthest > Some(3 * 120), "{background:?}: {panel:?} {furthest:?}");
        }
    }

    #[test]
    fn any_name_and_range_fit_any_picture_that_has_room() {
        let sizes = [LEAST_SIZE, [160, 4000], [4000, 128], [1024, 1024]];
        for size in sizes {
            for name in ["", "x", "scalar_a_very_long_name_that_no_panel_could_ever_hold_in_full", "é漢"] {
                for (min, max) in
                    [(0.0, 1.0), (5.0, 5.0), (-1e30, 1e-30), (-f64::MAX, f64::MAX), (4600000.1, 4600000.2)]
                {
                    let picture = drawn(&bar(name, min, max), size, [7, 7, 7, 255]);
                    let left = picture.pixels().chunks(size[0] as usize).all(|row| row[0] == [7, 7, 7, 255]);
                    assert!(left, "{size:?} {name} {min} {max}: it covers the left edge");
                }
            }
        }
        for size in [[159, 500], [500, 127], [1, 1]] {
            let refused = ColourBar::check(size).unwrap_err().to_string();
            assert!(refused.contains("160x128"), "{refused}");
        }
    }
}
