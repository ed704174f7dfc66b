//! Plots as SVG: what they show is here, how it is drawn is in the files beside.

mod axis;
mod draw;
mod labels;
mod legend;
mod style;
mod svg;

pub use axis::{Axis, Scale};
pub use draw::draw;
pub use style::{Kind, Style};

/// A plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Name of its file, without the ending.
    pub name: String,
    /// Above it.
    pub title: String,
    /// For those who do not see it.
    pub about: String,
    /// From left to right.
    pub x: Axis,
    /// From below to above.
    pub y: Axis,
    /// In the order of the legend; earlier ones lie on top.
    pub lines: Vec<Line>,
    /// Limits.
    pub bars: Vec<Bar>,
    /// What is not as it should be, on the upper edge.
    pub alarms: Vec<Alarm>,
}

/// A cross on the upper edge.
#[derive(Clone, Copy, Debug)]
pub struct Alarm {
    /// Where, on the horizontal axis.
    pub x: f64,
    /// A fault, not a refusal.
    pub grave: bool,
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Line {
    /// In the legend; empty if it has no entry there.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// In the order in which they are joined. Those with NaN are left out.
    pub points: Vec<[f64; 2]>,
    /// Beside the points of the same index; may be fewer, or empty.
    pub notes: Vec<String>,
}

/// A horizontal limit.
#[derive(Clone, Debug)]
pub struct Bar {
    /// Where, on the vertical axis.
    pub y: f64,
    /// What it limits.
    pub label: String,
    /// Colour of the line that it limits, or none.
    pub colour: Option<usize>,
}

impl Line {
    /// Without notes.
    pub fn new(label: impl Into<String>, style: Style, points: Vec<[f64; 2]>) -> Self {
        Self { label: label.into(), style, points, notes: Vec::new() }
    }
}

impl Plot {
    /// Around its lines.
    pub fn of(name: String, title: String, [x, y]: [(&str, Scale); 2], lines: Vec<Line>) -> Self {
        let about = about(&lines, x.0, y.0);
        let (bars, alarms) = (Vec::new(), Vec::new());
        let axis = |(label, scale), i| Axis::over(label, scale, values(&lines, i));
        let (x, y) = (axis(x, 0), axis(y, 1));
        Self { name, title, about, x, y, lines, bars, alarms }
    }

    /// With limits and alarms, around these too.
    pub fn with(mut self, bars: Vec<Bar>, alarms: Vec<Alarm>) -> Self {
        let places = values(&self.lines, 0).chain(alarms.iter().map(|alarm| alarm.x));
        self.x = Axis::over(self.x.label.clone(), self.x.scale(), places);
        let heights = values(&self.lines, 1).chain(bars.iter().map(|bar| bar.y));
        self.y = Axis::over(self.y.label.clone(), self.y.scale(), heights);
        (self.bars, self.alarms) = (bars, alarms);
        self
    }

    /// With what is less than `floor` on the lower edge, so that the rest has room.
    pub fn above(mut self, floor: f64) -> Self {
        self.y = Axis::above(self.y.label.clone(), self.y.scale(), floor, values(&self.lines, 1));
        self
    }
}

/// One coordinate of all points.
fn values(lines: &[Line], i: usize) -> impl Iterator<Item = f64> + '_ {
    lines.iter().flat_map(move |line| line.points.iter().map(move |point| point[i]))
}

/// In words: what is drawn, and between which values each line runs.
fn about(lines: &[Line], x: &str, y: &str) -> String {
    let mut text = format!("{y} over {x}.");
    for line in lines.iter().filter(|line| !line.label.is_empty()) {
        if let (Some([x0, y0]), Some([x1, y1])) = (line.points.first(), line.points.last()) {
            let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(|value| crate::bench::show::significant(*value, 3));
            text += &format!(" {}: from {y0} at {x0} to {y1} at {x1}.", line.label);
        }
    }
    text
}
