//! Drawing into a finished picture: rectangles and text, blended in linear light.

use crate::formats::image::Encoded;
use crate::geometry::srgb;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster, get_raster_width};

/// A rectangle in a picture, px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

impl Rectangle {
    /// The four sides, 1 px thick, inside it, without overlap.
    pub fn edges(self) -> [Self; 4] {
        let Self { x, y, width, height } = self;
        let (level, upright) =
            (Self { height: 1, ..self }, Self { y: y + 1, width: 1, height: height - 2, x });
        [level, Self { y: y + height - 1, ..level }, upright, Self { x: x + width - 1, ..upright }]
    }
}

/// A bold font size: thin dark letters fade when they are blended in linear light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Font {
    raster: RasterHeight,
    /// Scale of the raster font, px per raster pixel.
    zoom: u32,
}

impl Font {
    /// The largest font with lines of at most `height` px; at least 16.
    pub fn of_height(height: u32) -> Self {
        let rasters =
            [RasterHeight::Size32, RasterHeight::Size24, RasterHeight::Size20, RasterHeight::Size16];
        let zoom = (height / 32).max(1);
        let raster = rasters.into_iter().find(|raster| raster.val() as u32 * zoom <= height);
        Self { raster: raster.unwrap_or(RasterHeight::Size16), zoom }
    }

    /// Height of a line, px.
    pub fn height(self) -> u32 {
        self.raster.val() as u32 * self.zoom
    }

    /// Width of a letter, px.
    pub fn advance(self) -> u32 {
        get_raster_width(FontWeight::Bold, self.raster) as u32 * self.zoom
    }

    /// Width of `text`, px.
    pub fn width(self, text: &str) -> u32 {
        self.advance() * text.chars().count() as u32
    }

    fn glyph(self, letter: char) -> Option<RasterizedChar> {
        let raster = |letter| get_raster(letter, FontWeight::Bold, self.raster);
        raster(letter).or_else(|| raster('\u{fffd}')).or_else(|| raster('?'))
    }
}

impl Encoded {
    /// Blends an sRGB-encoded colour over a pixel; pixels outside the picture are ignored.
    fn blend(&mut self, x: u32, y: u32, colour: [u8; 3], alpha: f64) {
        let [width, height] = self.size();
        if x >= width || y >= height {
            return;
        }
        let pixel = &mut self.pixels_mut()[y as usize * width as usize + x as usize];
        let below = f64::from(pixel[3]) / 255.0 * (1.0 - alpha);
        let sum = alpha + below;
        if sum > 0.0 {
            let linear = |code: u8| srgb::decode(f64::from(code) / 255.0);
            for (under, over) in pixel.iter_mut().zip(colour) {
                *under = srgb::encode8(((alpha * linear(over) + below * linear(*under)) / sum) as f32);
            }
        }
        pixel[3] = (sum * 255.0).round() as u8;
    }

    /// Fills a rectangle.
    pub(super) fn fill(&mut self, area: Rectangle, colour: [u8; 3], alpha: f64) {
        for y in area.y..area.y + area.height {
            (area.x..area.x + area.width).for_each(|x| self.blend(x, y, colour, alpha));
        }
    }

    /// Writes a line of text with its top left corner at `x`, `y`.
    pub(super) fn text(&mut self, [x, y]: [u32; 2], text: &str, font: Font, colour: [u8; 3]) {
        for (letter, left) in text.chars().zip((x..).step_by(font.advance() as usize)) {
            let Some(glyph) = font.glyph(letter) else { continue };
            for (row, top) in glyph.rows().zip((y..).step_by(font.zoom as usize)) {
                for (&ink, left) in
                    row.iter().zip((left..).step_by(font.zoom as usize)).filter(|(ink, _)| **ink > 0)
                {
                    let area = Rectangle { x: left, y: top, width: font.zoom, height: font.zoom };
                    self.fill(area, colour, f64::from(ink) / 255.0);
                }
            }
        }
    }

    /// Mean linear lightness of a rectangle inside the picture, over white.
    pub(super) fn lightness(&self, area: Rectangle) -> f64 {
        let row = |y: u32| {
            let start = y as usize * self.size()[0] as usize + area.x as usize;
            &self.pixels()[start..start + area.width as usize]
        };
        let over_white = |&[r, g, b, a]: &[u8; 4]| {
            let [r, g, b] = [r, g, b].map(|code| srgb::decode(f64::from(code) / 255.0));
            let alpha = f64::from(a) / 255.0;
            alpha * (0.2126 * r + 0.7152 * g + 0.0722 * b) + 1.0 - alpha
        };
        let sum: f64 = (area.y..area.y + area.height).flat_map(row).map(over_white).sum();
        sum / (f64::from(area.width) * f64::from(area.height))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_is_blended_in_linear_light() {
        let mut picture = Encoded::new([3, 1], vec![[0, 0, 0, 255], [9, 9, 9, 0], [0, 0, 0, 255]]).unwrap();
        let area = Rectangle { x: 0, y: 0, width: 2, height: 1 };
        picture.fill(area, [255; 3], 0.5);
        assert_eq!(picture.pixels(), [[188, 188, 188, 255], [255, 255, 255, 128], [0, 0, 0, 255]]);
        assert_eq!(picture.lightness(Rectangle { x: 2, y: 0, width: 1, height: 1 }), 0.0);
        assert_eq!(picture.lightness(Rectangle { x: 1, y: 0, width: 1, height: 1 }), 1.0);
        // Code 188 is half of linear light, 137 a quarter.
        picture.fill(Rectangle { width: 1, ..area }, [0; 3], 0.5);
        assert_eq!(picture.pixels()[0], [137, 137, 137, 255]);
        // Nothing happens beyond the edge.
        picture.fill(Rectangle { x: 2, y: 0, width: 5, height: 5 }, [255; 3], 1.0);
        assert_eq!(picture.pixels()[2], [255; 4]);
    }

    #[test]
    fn fonts_grow_with_the_height_and_any_letter_is_drawn() {
        let heights = [0, 16, 22, 31, 47, 48, 64, 100].map(|height| Font::of_height(height).height());
        assert_eq!(heights, [16, 16, 20, 24, 32, 32, 64, 96]);
        for text in ["0", "é", "漢", "\u{7}"] {
            let font = Font::of_height(20);
            let mut picture = Encoded::new([20, 20], vec![[255; 4]; 400]).unwrap();
            picture.text([0, 0], text, font, [0; 3]);
            assert!(picture.pixels().iter().any(|pixel| pixel[0] < 64), "{text}");
            let beside =
                |(i, pixel): (usize, &[u8; 4])| i % 20 >= font.width(text) as usize && *pixel != [255; 4];
            assert!(!picture.pixels().iter().enumerate().any(beside), "{text}");
        }
    }
}
