//! How lines are told apart: by colour and by marker, so that either is enough.

use plotters::style::RGBColor;

/// Colours that the colour-blind can tell apart: Okabe and Ito, *Color Universal Design*, 2008; a dark one and a grey in the place of yellow,
/// which white swallows.
pub const COLOURS: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(120, 60, 20),
    RGBColor(150, 150, 150),
];
/// Text, and what is no data.
pub const INK: RGBColor = RGBColor(40, 44, 52);
/// Text of less weight.
pub const GREY: RGBColor = RGBColor(110, 116, 126);
/// Grid lines at ticks, and between them.
pub const GRID: [RGBColor; 2] = [RGBColor(222, 225, 230), RGBColor(241, 242, 245)];
/// What is wrong.
pub const ALARM: RGBColor = RGBColor(190, 20, 40);

/// How a line is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// Which colour; they repeat.
    pub colour: usize,
    /// Which marker; they repeat.
    pub marker: usize,
    /// Markers are outlines.
    pub hollow: bool,
    /// Dashes instead of a line.
    pub dashed: bool,
    /// What the line is.
    pub kind: Kind,
}

/// What a line is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Markers, joined.
    #[default]
    Joined,
    /// Markers, not joined.
    Loose,
    /// Markers that stay in the background, not joined.
    Faint,
    /// A broad pale band without markers, behind all else.
    Band,
}

impl Style {
    /// The one of this number: another colour and another marker each.
    pub fn nth(number: usize) -> Self {
        Self { colour: number, marker: number, ..Self::default() }
    }

    /// Its colour.
    pub fn rgb(&self) -> RGBColor {
        COLOURS[self.colour % COLOURS.len()]
    }

    /// Corners of its marker, of about unit radius, y down.
    pub fn outline(&self) -> Vec<(f64, f64)> {
        let regular = |corners: u32, start: f64, radius: f64| {
            let angle = move |i| (start + 360.0 * f64::from(i) / f64::from(corners)).to_radians();
            (0..corners).map(|i| (radius * angle(i).cos(), radius * angle(i).sin())).collect()
        };
        let mirrored = |corners: Vec<(f64, f64)>| corners.into_iter().map(|(x, y)| (x, -y)).collect();
        match self.marker % 6 {
            0 => regular(24, 0.0, 1.0),
            1 => regular(4, 45.0, 1.25),
            2 => regular(3, -90.0, 1.35),
            3 => regular(4, 0.0, 1.35),
            4 => mirrored(regular(3, -90.0, 1.35)),
            _ => cross(),
        }
    }
}

/// An upright cross.
fn cross() -> Vec<(f64, f64)> {
    let (long, wide) = (1.25, 0.45);
    let arm = [(wide, -wide), (long, -wide), (long, wide)];
    let turn = |(x, y): (f64, f64), times: usize| (0..times).fold((x, y), |(x, y), _| (-y, x));
    (0..4).flat_map(|times| arm.map(|corner| turn(corner, times))).collect()
}
