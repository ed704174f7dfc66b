//! Drawing of plots.

use super::labels::{Area, Occupied, width, wrap};
use super::legend::{self, Legend};
use super::style::{FAULT, GREY, GRID, INK};
use super::{Axis, Kind, Limit, Line, Plot, Style, svg};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Units per px: the backend has integer coordinates.
pub(super) const FINE: i32 = 4;
/// Width, px.
pub(super) const WIDTH: i32 = 540;
/// Height of axes and their labels, px.
const BODY: i32 = 340;
/// Height of the title, px.
const HEAD: i32 = 30;
/// Sizes of fonts, px.
pub(super) const FONT: f64 = 14.0;
const SMALL: f64 = 12.5;
const TITLE: f64 = 16.0;
/// Margins left, right, above and below the axes, px.
pub(super) const LEFT: i32 = 78;
const RIGHT: i32 = 18;
const ABOVE: i32 = 10;
const BELOW: i32 = 50;
/// Height of a further line of a label, px.
const LINE: i32 = 17;
/// Half the height of the caps of intervals, px.
const CAP: i32 = 6;
/// Width and height of the arms of a cross that shows behind a marker, px.
const BEHIND: i32 = 7;
/// Radius of a marker, px.
const RADIUS: f64 = 4.2;

pub(super) type Root<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;
pub(super) type Drawn<T = ()> = Result<T, DrawingAreaErrorKind<std::io::Error>>;

/// A plot as two SVG texts: for a separate file, and to embed in a page.
///
/// # Errors
/// Those of the backend, which writes to memory and so has none in practice.
pub fn draw(plot: &Plot) -> std::io::Result<[String; 2]> {
    let mut drawing = String::new();
    let legend = legend::lay_out(plot);
    let across = across(plot);
    let size = [WIDTH, HEAD + legend.height + BODY + more_below(&across)].map(|length| length as u32);
    let fine = size.map(|length| length * FINE as u32);
    paint(plot, &legend, &across, SVGBackend::with_string(&mut drawing, fine.into()))
        .map_err(|error| std::io::Error::other(error.to_string()))?;
    Ok([svg::Use::File, svg::Use::Inline]
        .map(|usage| svg::with_head(plot, &drawing, size, FINE as u32, usage)))
}

/// The label of the horizontal axis, in lines about as long as the axis: fonts may be wider.
fn across(plot: &Plot) -> Vec<String> {
    wrap(&plot.x.label, FONT, WIDTH - LEFT - RIGHT)
}

/// Height of all lines but the first, px.
fn more_below(across: &[String]) -> i32 {
    LINE * (across.len() as i32 - 1)
}

fn paint(plot: &Plot, legend: &Legend, across: &[String], backend: SVGBackend<'_>) -> Drawn {
    let root = backend.into_drawing_area();
    root.fill(&WHITE)?;
    let title = shorten(&plot.title, TITLE * 1.08, WIDTH - LEFT - RIGHT);
    write(&root, &title, [LEFT, 5], &bold(font(TITLE, INK, HPos::Left, VPos::Top)))?;
    legend::draw(&root, legend, HEAD)?;
    let top = HEAD + legend.height;
    let area = root.clone().shrink((0, top * FINE), (WIDTH * FINE, BODY * FINE));
    let mut chart = axes(plot, &area)?;
    names(&root, plot, across, top)?;
    let mut occupied = Occupied::default();
    for limit in &plot.limits {
        draw_limit(&mut chart, &root, limit)?;
    }
    for line in plot.lines.iter().filter(|line| line.style.kind == Kind::Whiskers) {
        whiskers(&chart, &root, line)?;
    }
    for kind in [Kind::Band, Kind::Crosses, Kind::Faint, Kind::Joined, Kind::Loose, Kind::Ring] {
        for line in plot.lines.iter().rev().filter(|line| line.style.kind == kind) {
            join(&mut chart, line)?;
            for (x, y) in known(line).map(|point| chart.backend_coord(&point)) {
                mark(&root, [x, y], &line.style)?;
                let reach = (RADIUS * if kind == Kind::Ring { 2.0 } else { 1.2 }) as i32 * FINE;
                occupied.add([x - reach, y - reach, x + reach, y + reach]);
            }
        }
    }
    let within = [LEFT, top + ABOVE, WIDTH - RIGHT, top + BODY - BELOW].map(|length| length * FINE);
    notes(&chart, &root, plot, &mut occupied, within)?;
    marks(&chart, &root, plot, within)?;
    root.present()
}

/// Grid, axes and their ticks.
fn axes<'a, 'b>(plot: &Plot, area: &'a Root<'b>) -> Drawn<Chart<'a, 'b>> {
    let mut chart = ChartBuilder::on(area)
        .margin_top(ABOVE * FINE)
        .margin_right(RIGHT * FINE)
        .x_label_area_size(BELOW * FINE)
        .y_label_area_size(LEFT * FINE)
        .build_cartesian_2d(plot.x.clone(), plot.y.clone())?;
    let [bold, light] = GRID.map(|colour| colour.stroke_width(FINE as u32));
    chart
        .configure_mesh()
        .bold_line_style(bold)
        .light_line_style(light)
        .axis_style(GREY.stroke_width(FINE as u32))
        .label_style(font(FONT, INK, HPos::Center, VPos::Center))
        .set_all_tick_mark_size(4 * FINE)
        .draw()?;
    Ok(chart)
}

/// Labels of the axes; the vertical one is smaller if it is too long.
fn names(root: &Root<'_>, plot: &Plot, across: &[String], top: i32) -> Drawn {
    for (line, below) in across.iter().zip((0..).step_by(LINE as usize)) {
        let place = [LEFT + (WIDTH - LEFT - RIGHT) / 2, top + BODY - 6 + below];
        write(root, line, place, &font(FONT, INK, HPos::Center, VPos::Bottom))?;
    }
    let fits = f64::from(BODY) / f64::from(width(&plot.y.label, FONT).max(1));
    let mut style = font(FONT * fits.min(1.0), INK, HPos::Center, VPos::Top);
    style.font = style.font.transform(FontTransform::Rotate270);
    let middle = top + ABOVE + (BODY - ABOVE - BELOW) / 2;
    write(root, &plot.y.label, [2, middle], &style)
}

/// A text style. `size` is in px as displayed: the backend divides by 1.24.
pub(super) fn font(size: f64, colour: RGBColor, across: HPos, up: VPos) -> TextStyle<'static> {
    let font = FontDesc::new(FontFamily::SansSerif, size * 1.24 * f64::from(FINE), FontStyle::Normal);
    font.color(&colour).pos(Pos::new(across, up))
}

fn bold(mut style: TextStyle<'static>) -> TextStyle<'static> {
    style.font = style.font.style(FontStyle::Bold);
    style
}

/// Writes text at a position in px.
pub(super) fn write(root: &Root<'_>, text: &str, [x, y]: [i32; 2], style: &TextStyle<'_>) -> Drawn {
    root.draw_text(text, style, (x * FINE, y * FINE))
}

/// Shortens a text to a width of about `most` px.
pub(super) fn shorten(text: &str, size: f64, most: i32) -> String {
    let mut short = text.to_owned();
    while width(&short, size) > most && short.pop().is_some() {}
    if short.len() < text.len() { short.trim_end().to_owned() + "…" } else { short }
}

/// The points without NaN.
fn known(line: &Line) -> impl Iterator<Item = (f64, f64)> + Clone + '_ {
    line.points.iter().filter(|point| point.iter().all(|value| !value.is_nan())).map(|&[x, y]| (x, y))
}

fn join(chart: &mut Chart<'_, '_>, line: &Line) -> Drawn {
    let colour = line.style.rgb();
    let fine = FINE as u32;
    match (line.style.kind, line.style.dashed) {
        (Kind::Faint | Kind::Loose | Kind::Ring | Kind::Whiskers | Kind::Crosses, _) => Ok(()),
        (Kind::Band, _) => {
            let style = GREY.mix(0.28).stroke_width(9 * fine);
            chart.draw_series(LineSeries::new(known(line), style)).map(drop)
        }
        (Kind::Joined, false) => {
            chart.draw_series(LineSeries::new(known(line), colour.stroke_width(2 * fine))).map(drop)
        }
        (Kind::Joined, true) => {
            let style = colour.stroke_width(2 * fine);
            chart.draw_series(DashedLineSeries::new(known(line), 6 * FINE, 4 * FINE, style)).map(drop)
        }
    }
}

/// Draws horizontal intervals with caps.
fn whiskers(chart: &Chart<'_, '_>, root: &Root<'_>, line: &Line) -> Drawn {
    let style = line.style.rgb().stroke_width(FINE as u32);
    for ends in line.points.chunks_exact(2).filter(|ends| !ends.as_flattened().iter().any(|x| x.is_nan())) {
        let [(low, y), (high, _)] = [ends[0], ends[1]].map(|[x, y]| chart.backend_coord(&(x, y)));
        root.draw(&PathElement::new([(low, y), (high, y)], style))?;
        for x in [low, high] {
            root.draw(&PathElement::new([(x, y - CAP * FINE), (x, y + CAP * FINE)], style))?;
        }
    }
    Ok(())
}

/// Draws a marker at a position in fine units, with a white rim.
pub(super) fn mark(root: &Root<'_>, [x, y]: [i32; 2], style: &Style) -> Drawn {
    let shape = |radius: f64, colour: RGBAColor| {
        let size = radius * f64::from(FINE);
        let corner = |(dx, dy): (f64, f64)| (x + (dx * size).round() as i32, y + (dy * size).round() as i32);
        Polygon::new(style.outline().into_iter().map(corner).collect::<Vec<_>>(), colour.filled())
    };
    match style.kind {
        Kind::Band | Kind::Whiskers => Ok(()),
        Kind::Crosses => cross(root, [x, y], BEHIND, FAULT),
        Kind::Ring => {
            let circle =
                Circle::new((x, y), 2.0 * RADIUS * f64::from(FINE), INK.stroke_width(2 * FINE as u32));
            root.draw(&circle)
        }
        Kind::Faint => root.draw(&shape(0.7 * RADIUS, style.rgb().mix(0.4))),
        Kind::Joined | Kind::Loose => {
            root.draw(&shape(1.3 * RADIUS, WHITE.mix(1.0)))?;
            root.draw(&shape(RADIUS, style.rgb().mix(1.0)))?;
            if style.hollow { root.draw(&shape(0.55 * RADIUS, WHITE.mix(1.0))) } else { Ok(()) }
        }
    }
}

/// Draws a dashed horizontal line, with its label above the right end.
fn draw_limit(chart: &mut Chart<'_, '_>, root: &Root<'_>, limit: &Limit) -> Drawn {
    let ends = chart.x_range();
    let colour = limit.colour.map_or(GREY, |colour| Style::nth(colour).rgb());
    let style = colour.stroke_width(FINE as u32 * 3 / 2);
    let points = [(ends.start, limit.y), (ends.end, limit.y)];
    chart.draw_series(DashedLineSeries::new(points, 3 * FINE, 3 * FINE, style))?;
    let (x, y) = chart.backend_coord(&points[1]);
    let style = font(SMALL, colour, HPos::Right, VPos::Bottom);
    root.draw_text(&limit.label, &style, (x - 4 * FINE, y - FINE))
}

/// Notes beside points, where there is room.
fn notes(
    chart: &Chart<'_, '_>,
    root: &Root<'_>,
    plot: &Plot,
    occupied: &mut Occupied,
    within: Area,
) -> Drawn {
    for line in &plot.lines {
        for (point, note) in line.points.iter().zip(&line.notes) {
            if note.is_empty() || point.iter().any(|value| value.is_nan()) {
                continue;
            }
            let at = chart.backend_coord(&(point[0], point[1]));
            let size = [width(note, SMALL) * FINE, SMALL as i32 * FINE];
            if let Some([left, top, ..]) = occupied.first_free(beside(at, size), within) {
                let style = font(SMALL, INK, HPos::Left, VPos::Top);
                let ground = [(left, top), (left + size[0], top + size[1])];
                root.draw(&Rectangle::new(ground, WHITE.mix(0.8).filled()))?;
                root.draw_text(note, &style, (left, top))?;
            }
        }
    }
    Ok(())
}

/// Candidate positions of a text beside a point.
fn beside((x, y): (i32, i32), [wide, high]: [i32; 2]) -> [Area; 9] {
    let gap = 7 * FINE;
    let at = |left: i32, top: i32| [left, top, left + wide, top + high];
    [
        at(x + gap, y - gap - high / 2),
        at(x - gap - wide, y + gap - high / 2),
        at(x - wide / 2, y - gap - high),
        at(x - wide / 2, y + gap),
        at(x + gap, y + gap - high / 2),
        at(x - gap - wide, y - gap - high / 2),
        at(x - wide / 2, y + 2 * gap),
        at(x + 2 * gap, y - high / 2),
        at(x - 2 * gap - wide, y - high / 2),
    ]
}

/// Crosses on the upper edge.
fn marks(chart: &Chart<'_, '_>, root: &Root<'_>, plot: &Plot, within: Area) -> Drawn {
    let y = within[1] + 5 * FINE;
    for mark in plot.marks.iter().filter(|mark| !mark.x.is_nan()) {
        let (x, _) = chart.backend_coord(&(mark.x, chart.y_range().end));
        fault(root, [x, y], mark.fault)?;
    }
    Ok(())
}

/// Draws the mark of a fault or of a refusal at a position in fine units.
pub(super) fn fault(root: &Root<'_>, place: [i32; 2], fault: bool) -> Drawn {
    cross(root, place, 4, if fault { FAULT } else { GREY })
}

/// Draws a cross at a position in fine units, with arms of this width and height, px.
fn cross(root: &Root<'_>, [x, y]: [i32; 2], arm: i32, colour: RGBColor) -> Drawn {
    let arm = arm * FINE;
    for slope in [-arm, arm] {
        let ends = [(x - arm, y - slope), (x + arm, y + slope)];
        root.draw(&PathElement::new(ends, colour.stroke_width(2 * FINE as u32)))?;
    }
    Ok(())
}
