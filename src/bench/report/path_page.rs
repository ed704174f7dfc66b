//! Page of `surfel compare --frames`: error and flicker of two sequences of frames along a camera path.

use super::page::document;
use super::path::{self, FLICKER, RMSE, largest, line, ring};
use super::plot::{Limit, Line, Plot, Style, draw};
use crate::bench::format::significant;
use crate::bench::images::png;
use crate::error::{Error, Result};
use crate::formats::atomic;
use crate::formats::image::Encoded;
use crate::geometry::ColourMap;
use crate::picture::Picture;
use crate::settings::Shading;
use crate::verify::metrics::colour;
use crate::verify::metrics::path::PathValues;
use maud::{Markup, PreEscaped, html};
use std::io::{self, Write};
use std::path::Path;

/// Largest side of a picture on the page, px: of larger ones, the part around the pixel that pops most.
const MOST: usize = 512;

/// A picture of each frame of a camera path, and its truth.
pub struct PathReport<'a> {
    /// Names of the pictures and of the truths, such as the pattern of their files.
    pub names: [String; 2],
    /// Number of the first frame.
    pub first: u32,
    /// Values of all frames.
    pub values: &'a PathValues,
    /// Flicker of the whole path.
    pub flicker: f64,
    /// What the colours are composited over, linear.
    pub background: [f32; 3],
    /// Picture and truth of the frame that pops most, of the one before and of the one after; all of one size.
    pub around: [[Picture; 2]; 3],
}

impl PathReport<'_> {
    /// Writes the page, one HTML file without external resources.
    ///
    /// # Errors
    /// [`Error::Usage`] for fewer than three frames, and for pictures of different sizes; [`Error::Io`] if the file cannot be written.
    pub fn write(&self, file: &Path) -> Result<()> {
        let Some((popping, pop)) = self.values.popping() else {
            let frames = self.values.rmse.len();
            return Err(Error::Usage(format!("a report of {frames} frames: give 3 or more")));
        };
        let plots = self.plots(popping).map_err(Error::io(file, "cannot draw a plot of"))?;
        let pictures = self.pictures(popping)?;
        let page =
            document("surfel: error along a camera path", &self.body(&plots, &pictures, (popping, pop)));
        atomic::write(file, |out| out.write_all(page.as_bytes()))
    }

    /// Number of the frame of this index.
    fn frame(&self, index: usize) -> u32 {
        self.first + index as u32
    }

    fn body(&self, plots: &[Markup], pictures: &Markup, (popping, pop): (usize, f64)) -> Markup {
        let [picture, truth] = &self.names;
        let Self { first, values, flicker, .. } = self;
        let number = |value: f64| significant(value, 3);
        let worst = largest(&values.rmse).unwrap_or_default();
        html! {
            header {
                h1 { "Error along a camera path" }
                p { "A is " code { (picture) } ", B is " code { (truth) } ", which counts as the truth. Frames " (first) " to "
                    (self.frame(values.rmse.len() - 1)) ", colours in linear light over " (background(self.background)) "; 1 is white." }
            }
            main {
                ul {
                    li { "Largest error: RMSE " (number(values.rmse[worst])) " in frame " (self.frame(worst)) "." }
                    li { "Flicker: " (number(*flicker)) " along the path." }
                    li { "Popping: " (number(pop)) " around frame " (self.frame(popping)) ", " (number(pop / flicker.max(f64::MIN_POSITIVE))) " times the flicker." }
                }
                div.plots { @for plot in plots { (plot) } }
                h2 { "Frames around the largest pop" }
                (pictures)
            }
        }
    }

    /// Error, change from frame to frame, and flicker, each over the frame.
    fn plots(&self, popping: usize) -> io::Result<Vec<Markup>> {
        let Self { first, values, flicker, .. } = self;
        let PathValues { rmse, picture_change, truth_change, flicker: around } = values;
        let error = line("A against B", Style::nth(0), *first, rmse);
        let worst = largest(rmse).and_then(|index| ring("largest", &error, index));
        let changes = [("A", 0, picture_change), ("B", 2, truth_change)]
            .map(|(label, nth, values)| line(label, Style::nth(nth), first + 1, values));
        let excess: Vec<f64> = picture_change.iter().zip(truth_change).map(|(a, b)| a - b).collect();
        let jump = largest(&excess).and_then(|index| ring("A exceeds B most", &changes[0], index));
        let flickers = line("flicker around the frame", Style::nth(1), first + 1, around);
        let pop = ring("popping", &flickers, popping - 1);
        let mean = Limit { y: *flicker, label: "flicker of the path".into(), colour: None };
        let drawn = [
            (
                plot("error", "Error of each frame", RMSE, vec![error], worst),
                "The root mean square error of A against B in every frame. The ring marks the largest.",
            ),
            (
                plot(
                    "change",
                    "Change from the frame before",
                    "RMS change, linear light",
                    changes.into(),
                    jump,
                ),
                "The root mean square difference of each frame from the one before, of A and of B. Motion changes both alike; where A changes by more than B, \
                 its error changes. The ring marks where A exceeds B most.",
            ),
            (
                plot("flicker", "Flicker around each frame", FLICKER, vec![flickers], pop)
                    .with(vec![mean], Vec::new()),
                "Second differences of the error over the frame before, the frame and the next: an error that stays or changes evenly does not \
                 count, and a step counts around the frame before it and the one after. The dashed line is the flicker of the whole path. The ring marks the popping, which is the largest value.",
            ),
        ];
        let figure = |(plot, caption): (Plot, &str)| {
            let [_, inline] = draw(&plot)?;
            Ok(html! { div { figure.plot { (PreEscaped(inline)) } p.caption { (caption) } } })
        };
        drawn.into_iter().map(figure).collect()
    }

    /// A, B and their difference in the frames around the one that pops most.
    fn pictures(&self, popping: usize) -> Result<Markup> {
        let size = self.around[0][0].size;
        let all = self.around.as_flattened();
        if all.iter().any(|picture| picture.size != size || picture.colour.len() != all[0].colour.len()) {
            return Err(Error::Usage("frames of different sizes: render all in one size".into()));
        }
        let colours = self
            .around
            .each_ref()
            .map(|pair| pair.each_ref().map(|side| colour::over(side, self.background)));
        let errors = colours.each_ref().map(|[picture, truth]| difference(picture, truth));
        let part = Part::around(size, worst_pixel(&colours));
        let most = errors.iter().flat_map(|errors| part.of(errors)).fold(0.0, f64::max);
        let magma = |error: f64| {
            let [r, g, b] = ColourMap::Magma.at(error / most.max(f64::MIN_POSITIVE));
            [r, g, b, 255]
        };
        let frames = [popping - 1, popping, popping + 1].map(|index| self.frame(index));
        let shown = |side: usize| -> Result<Vec<String>> {
            colours.iter().map(|pair| png(encoded(part.size(), part.of(&pair[side]))?)).collect()
        };
        let maps =
            errors.iter().map(|errors| png(Encoded::new(part.size(), part.of(errors).map(magma).collect())?));
        let rows = [("A", shown(0)?), ("B", shown(1)?), ("difference", maps.collect::<Result<_>>()?)];
        let cut =
            if part.size() == size { "" } else { " Only the part around the pixel that pops most is shown." };
        Ok(html! {
            @for (name, pictures) in &rows {
                figure.images {
                    div.row { @for (frame, png) in frames.iter().zip(pictures) {
                        img src={ "data:image/png;base64," (png) } alt={ (name) ", frame " (frame) };
                    } }
                    figcaption {
                        strong { (name) } ", frames " (frames[0]) ", " (frames[1]) " and " (frames[2]) "."
                        @if *name == "difference" {
                            " The largest difference of A from B of the channels red, green and blue, linear: black is 0, pale yellow is "
                            (significant(most, 3)) ", the largest here; the colours between are magma."
                        } @else if *name == "A" { (cut) }
                    }
                }
            }
        })
    }
}

/// A plot over frames; the peak is drawn on top.
fn plot(name: &str, title: &str, y: &str, mut lines: Vec<Line>, peak: Option<Line>) -> Plot {
    lines.extend(peak);
    Plot::of(format!("path-{name}"), title.into(), path::axes(y), lines)
}

/// A background as text.
fn background([r, g, b]: [f32; 3]) -> String {
    if [r, g, b] == colour::BLACK { "black".into() } else { format!("the background {r} {g} {b}") }
}

/// The largest difference of a channel in each pixel.
fn difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)).collect()
}

/// Index of the pixel with the largest second difference of the error.
fn worst_pixel(frames: &[[Vec<[f64; 3]>; 2]; 3]) -> usize {
    let error =
        |frame: usize, pixel: usize, i: usize| frames[frame][0][pixel][i] - frames[frame][1][pixel][i];
    let second = |pixel: usize| {
        let channel = |i| (error(0, pixel, i) - 2.0 * error(1, pixel, i) + error(2, pixel, i)).powi(2);
        (0..3).map(channel).sum::<f64>()
    };
    let values: Vec<f64> = (0..frames[0][0].len()).map(second).collect();
    largest(&values).unwrap_or_default()
}

/// Colours of opaque pixels as a PNG shows them.
fn encoded(size: [u32; 2], colours: impl Iterator<Item = [f64; 3]>) -> Result<Encoded> {
    let colour = colours.map(|[r, g, b]| [r as f32, g as f32, b as f32, 1.0]).collect();
    Encoded::of(&Picture { size, colour, ..Default::default() }, Shading::Colour)
}

/// A rectangle of a picture, px.
struct Part {
    /// Width of the whole picture.
    width: usize,
    left: usize,
    top: usize,
    size: [usize; 2],
}

impl Part {
    /// A part of at most [`MOST`] px a side with the pixel of this index as near its middle as it can be.
    fn around(size: [u32; 2], pixel: usize) -> Self {
        let whole = size.map(|side| side as usize);
        let size = whole.map(|side| side.min(MOST));
        let at = [pixel % whole[0], pixel / whole[0]];
        let [left, top] =
            [0, 1].map(|axis| at[axis].saturating_sub(size[axis] / 2).min(whole[axis] - size[axis]));
        Self { width: whole[0], left, top, size }
    }

    fn size(&self) -> [u32; 2] {
        self.size.map(|side| side as u32)
    }

    /// The values of its pixels, row by row.
    fn of<'v, T: Copy>(&self, values: &'v [T]) -> impl Iterator<Item = T> + use<'v, T> {
        let &Self { width, left, top, size } = self;
        let rows = values.chunks_exact(width).skip(top).take(size[1]);
        rows.flat_map(move |row| row[left..left + size[0]].iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_stays_in_the_picture() {
        let part = |pixel| {
            let Part { left, top, size, .. } = Part::around([MOST as u32 + 100, 2], pixel);
            (left, top, size)
        };
        assert_eq!(part(0), (0, 0, [MOST, 2]));
        assert_eq!(part(MOST / 2 + 7), (7, 0, [MOST, 2]));
        assert_eq!(part(2 * MOST + 199), (100, 0, [MOST, 2]));
        let values: Vec<usize> = (0..2 * (MOST + 100)).collect();
        let cut: Vec<usize> = Part::around([MOST as u32 + 100, 2], 2 * MOST + 199).of(&values).collect();
        assert_eq!((cut.len(), cut[0], cut[MOST]), (2 * MOST, 100, MOST + 200));
    }
}
