//! Plots as SVG: their content is defined here, their drawing in the submodules.

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
    /// File name without extension.
    pub name: String,
    /// Title above the plot.
    pub title: String,
    /// Text alternative.
    pub description: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// In the order of the legend; earlier ones are drawn on top.
    pub lines: Vec<Line>,
    /// Horizontal limits.
    pub limits: Vec<Limit>,
    /// Marks on the upper edge: faults and refusals.
    pub marks: Vec<Mark>,
}

/// A mark on the upper edge.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// Position on the horizontal axis.
    pub x: f64,
    /// Whether it is a fault; else a refusal.
    pub fault: bool,
}

/// A series of points.
#[derive(Clone, Debug)]
pub struct Line {
    /// Label in the legend; empty for none.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// In the order in which they are joined. Points with NaN are skipped.
    pub points: Vec<[f64; 2]>,
    /// Notes at the points of the same index; may be fewer, or empty.
    pub notes: Vec<String>,
}

/// A horizontal limit.
#[derive(Clone, Debug)]
pub struct Limit {
    /// Position on the vertical axis.
    pub y: f64,
    /// Label.
    pub label: String,
    /// Colour index of the line that it limits, if any.
    pub colour: Option<usize>,
}

impl Line {
    /// A line without notes.
    pub fn new(label: impl Into<String>, style: Style, points: Vec<[f64; 2]>) -> Self {
        Self { label: label.into(), style, points, notes: Vec::new() }
    }
}

impl Plot {
    /// A plot whose axes cover its lines.
    pub fn of(name: String, title: String, [x, y]: [(&str, Scale); 2], lines: Vec<Line>) -> Self {
        let description = description(&lines, x.0, y.0);
        let (limits, marks) = (Vec::new(), Vec::new());
        let axis = |(label, scale), i| Axis::over(label, scale, values(&lines, i));
        let (x, y) = (axis(x, 0), axis(y, 1));
        Self { name, title, description, x, y, lines, limits, marks }
    }

    /// Adds limits and marks, and extends the axes to cover them.
    pub fn with(mut self, limits: Vec<Limit>, marks: Vec<Mark>) -> Self {
        let places = values(&self.lines, 0).chain(marks.iter().map(|mark| mark.x));
        self.x = Axis::over(self.x.label.clone(), self.x.scale(), places);
        let heights = values(&self.lines, 1).chain(limits.iter().map(|limit| limit.y));
        self.y = Axis::over(self.y.label.clone(), self.y.scale(), heights);
        (self.limits, self.marks) = (limits, marks);
        self
    }

    /// Moves values below `floor` to the lower edge, so that the others have more room.
    pub fn above(mut self, floor: f64) -> Self {
        self.y = Axis::above(self.y.label.clone(), self.y.scale(), floor, values(&self.lines, 1));
        self
    }
}

/// One coordinate of all points.
fn values(lines: &[Line], i: usize) -> impl Iterator<Item = f64> + '_ {
    lines.iter().flat_map(move |line| line.points.iter().map(move |point| point[i]))
}

/// Text alternative: the quantities, and the range of each line.
fn description(lines: &[Line], x: &str, y: &str) -> String {
    let mut text = format!("{y} over {x}.");
    for line in lines.iter().filter(|line| !line.label.is_empty()) {
        if let (Some([x0, y0]), Some([x1, y1])) = (line.points.first(), line.points.last()) {
            let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(|value| crate::bench::format::significant(*value, 3));
            text += &format!(" {}: from {y0} at {x0} to {y1} at {x1}.", line.label);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texts of an SVG file, each with its horizontal position and its font size, px.
    fn texts(svg: &str) -> Vec<(String, f64, f64)> {
        let text = |element: &str| {
            let (head, text) = element.split_once('>')?;
            let value = |name: &str| {
                let value = head.split_once(&format!(" {name}=\""))?.1.split('"').next()?;
                value.parse::<f64>().ok().map(|value| value / f64::from(draw::FINE))
            };
            Some((text.split('<').next()?.trim().to_owned(), value("x")?, value("font-size")?))
        };
        svg.split("<text").skip(1).filter_map(text).collect()
    }

    fn plot(x: &str, y: &str, labels: &[&str]) -> Vec<(String, f64, f64)> {
        let line = |label: &&str| Line::new(*label, Style::nth(0), vec![[1.0, 2.0], [3.0, 4.0]]);
        let lines = labels.iter().map(line).collect();
        let axes = [(x, Scale::Linear), (y, Scale::Linear)];
        texts(&draw(&Plot::of("name".into(), "title".into(), axes, lines)).unwrap()[0])
    }

    #[test]
    fn long_labels_of_axes_fit() {
        let long = "distance of the eye from the plane of the discs, radii of the discs, where they are seen from the side";
        let found = plot(long, "y", &[]);
        let mine: Vec<_> = found.iter().filter(|(text, ..)| long.contains(text) && text.len() > 9).collect();
        assert!(!mine.is_empty());
        for (text, x, size) in mine {
            let half = 0.5 * f64::from(labels::width(text, *size));
            assert!(x - half >= 0.0 && x + half <= f64::from(draw::WIDTH), "{text} at {x}, {size} px");
        }
    }

    #[test]
    fn long_entries_of_the_legend_are_whole() {
        let long =
            "perspective-ewa --lowpass 0 --pixel-filter none --alpha mask --edges nearest --shading color";
        let found = plot("x", "y", &["sprites", long, "confetti"]);
        let rows: Vec<_> = found.iter().map(|(text, ..)| text.as_str()).collect();
        let start = rows.iter().position(|text| text.starts_with("perspective-ewa")).unwrap();
        let whole = rows[start..].iter().take_while(|text| **text != "confetti").copied().collect::<Vec<_>>();
        assert!(whole.len() > 1 && whole.join(" ") == long, "{rows:?}");
    }
}
