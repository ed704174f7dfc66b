//! Line styles: lines differ in colour and in marker, either of which is enough to tell them apart.

use plotters::style::RGBColor;

/// Colours for colour-blind readers: Okabe and Ito, *Color Universal Design*, 2008; with a dark colour and a grey in
/// place of yellow, which has no contrast on white.
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
/// Text and axes.
pub const INK: RGBColor = RGBColor(40, 44, 52);
/// Secondary text.
pub const GREY: RGBColor = RGBColor(110, 116, 126);
/// Grid lines at ticks, and between them.
pub const GRID: [RGBColor; 2] = [RGBColor(222, 225, 230), RGBColor(241, 242, 245)];
/// Faults.
pub const FAULT: RGBColor = RGBColor(190, 20, 40);

/// Style of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// Index of the colour, modulo their number.
    pub colour: usize,
    /// Index of the marker, modulo their number.
    pub marker: usize,
    /// Whether markers are outlines.
    pub hollow: bool,
    /// Whether the line is dashed.
    pub dashed: bool,
    /// Kind of the line.
    pub kind: Kind,
}

/// Kind of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Joined markers.
    #[default]
    Joined,
    /// Single markers.
    Loose,
    /// Pale single markers in the background.
    Faint,
    /// A broad pale band without markers, behind all else.
    Band,
    /// Rings around markers of other lines.
    Ring,
    /// Pairs of points, which are the ends of horizontal intervals: thin lines with caps.
    Whiskers,
    /// Crosses behind markers of other lines.
    Crosses,
}

impl Style {
    /// The style of index `number`: each has another colour and another marker.
    pub fn nth(number: usize) -> Self {
        Self { colour: number, marker: number, ..Self::default() }
    }

    /// The colour.
    pub fn rgb(&self) -> RGBColor {
        COLOURS[self.colour % COLOURS.len()]
    }

    /// Corners of the marker, of about unit radius, y down.
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
