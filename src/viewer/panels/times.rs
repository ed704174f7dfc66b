//! What frames cost: times of their passes on the GPU, as they went by, and what became of the surfels.

use crate::viewer::about::thousands;
use crate::viewer::load::LEAST_SURFELS;
use crate::viewer::quality::MIN_SCALE;
use crate::viewer::split_view::Reports;
use egui::{Align2, Color32, FontId, Grid, Pos2, Rect, Sense, Ui, vec2};
use std::collections::VecDeque;
use surfel::settings::Choice;
use surfel::{FrameReport, Settings, SplatCounts};

/// Frames that are shown.
const FRAMES: usize = 120;
/// Height of the plot, points.
const HEIGHT: f32 = 96.0;
/// Colours of passes, in the order in which they are first seen; told apart also by the colour-blind (Okabe, Ito), as far as there are such.
const COLOURS: [Color32; 10] = [
    Color32::from_rgb(86, 180, 233),
    Color32::from_rgb(230, 159, 0),
    Color32::from_rgb(0, 158, 115),
    Color32::from_rgb(240, 228, 66),
    Color32::from_rgb(204, 121, 167),
    Color32::from_rgb(213, 94, 0),
    Color32::from_rgb(0, 114, 178),
    Color32::from_rgb(160, 160, 160),
    Color32::from_rgb(120, 94, 240),
    Color32::from_rgb(150, 100, 60),
];

/// What frames told.
#[derive(Default)]
pub struct Times {
    open: bool,
    frames: VecDeque<Frame>,
    /// Every pass there was, in the order in which they were first seen.
    passes: Vec<&'static str>,
    last: Option<FrameReport>,
    right: Option<FrameReport>,
}

/// A frame that is over.
struct Frame {
    passes: Vec<(&'static str, f64)>,
}

/// How good the picture is that one looks at.
pub struct Quality {
    /// Width and height of the whole picture, px.
    pub size: [u32; 2],
    /// Side of what is rendered, as part of that.
    pub side: f64,
    /// Surfels that are rendered, of how many.
    pub surfels: u64,
    pub of: u64,
}

/// The sum of a frame's passes, ms.
pub fn sum(report: &FrameReport) -> f64 {
    report.pass_times.iter().map(|pass| pass.milliseconds).sum()
}

/// A time with as many digits as mean something: two, and none below 10 µs.
pub fn ms(milliseconds: f64) -> String {
    let decimals = match milliseconds {
        large if large >= 9.95 => 0,
        middle if middle >= 0.995 => 1,
        _ => 2,
    };
    format!("{milliseconds:.decimals$} ms")
}

impl Times {
    /// Whether somebody looks, so that frames are measured.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// What the pictures told last, left and right.
    pub fn last(&self) -> [Option<&FrameReport>; 2] {
        [self.last.as_ref(), self.right.as_ref()]
    }

    /// Takes what pictures tell that were drawn; whether they told something.
    pub fn push(&mut self, Reports { left, right }: Reports) -> bool {
        let is_new = left.is_some() || right.is_some();
        if right.is_some() {
            self.right = right;
        }
        let Some(report) = left else { return is_new };
        let passes: Vec<_> = report.pass_times.iter().map(|pass| (pass.label, pass.milliseconds)).collect();
        for (label, _) in &passes {
            if !self.passes.contains(label) {
                self.passes.push(label);
            }
        }
        self.frames.push_back(Frame { passes });
        if self.frames.len() > FRAMES {
            self.frames.pop_front();
        }
        self.last = Some(report);
        is_new
    }

    /// A section that can be opened.
    pub fn show(&mut self, ui: &mut Ui, quality: &Quality, settings: &Settings, frame: f64) {
        let header = ui.collapsing("Times", |ui| {
            tell_quality(ui, quality, settings, frame);
            self.plot(ui);
            self.legend(ui);
            if let Some(counts) = self.last.as_ref().and_then(|report| report.counts) {
                ui.separator();
                tell_counts(ui, &counts);
            }
        });
        header
            .header_response
            .on_hover_text("Frames are measured while this is open, pass by pass, which makes them slower.");
        self.open = header.body_returned.is_some();
    }

    fn colour(&self, label: &str) -> Color32 {
        let number = self.passes.iter().position(|pass| *pass == label).unwrap_or_default();
        COLOURS[number % COLOURS.len()]
    }

    fn plot(&self, ui: &mut Ui) {
        let (response, painter) = ui.allocate_painter(vec2(ui.available_width(), HEIGHT), Sense::hover());
        let rect = response.rect;
        painter.rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
        let most = self.frames.iter().map(Frame::sum).fold(0.0, f64::max);
        if most == 0.0 {
            let text = "no frame with times yet";
            painter.text(
                rect.center(),
                Align2::CENTER_CENTER,
                text,
                FontId::default(),
                ui.visuals().weak_text_color(),
            );
            return;
        }
        let top = nice(most);
        let width = rect.width() / FRAMES as f32;
        for (number, frame) in (FRAMES - self.frames.len()..).zip(&self.frames) {
            let left = rect.left() + number as f32 * width;
            let mut y = rect.bottom();
            for (label, ms) in &frame.passes {
                let height = (ms / top) as f32 * rect.height();
                let bar = Rect::from_min_max(Pos2::new(left, y - height), Pos2::new(left + width, y));
                painter.rect_filled(bar, 0.0, self.colour(label));
                y -= height;
            }
        }
        let ink = ui.visuals().strong_text_color();
        painter.text(
            rect.left_top() + vec2(3.0, 2.0),
            Align2::LEFT_TOP,
            format!("{top} ms"),
            FontId::proportional(10.0),
            ink,
        );
        let under = response.hover_pos().map(|at| ((at.x - rect.left()) / width) as usize);
        let frame = under.and_then(|column| (column + self.frames.len()).checked_sub(FRAMES));
        if let Some(frame) = frame.and_then(|frame| self.frames.get(frame)) {
            response.on_hover_ui_at_pointer(|ui| frame.tell(ui));
        }
    }

    /// The last frame's passes, in their order.
    fn legend(&self, ui: &mut Ui) {
        let Some(last) = &self.last else { return };
        Grid::new("passes").num_columns(3).show(ui, |ui| {
            for pass in &last.pass_times {
                let (response, painter) = ui.allocate_painter(vec2(10.0, 10.0), Sense::hover());
                painter.rect_filled(response.rect, 1.0, self.colour(pass.label));
                ui.label(pass.label).on_hover_text(pass_text(pass.label));
                ui.monospace(format!("{:>9}", ms(pass.milliseconds)));
                ui.end_row();
            }
            ui.label("");
            ui.strong("all passes").on_hover_text("on the GPU's clock; panels and presenting are not in it");
            ui.monospace(format!("{:>9}", ms(sum(last))));
            ui.end_row();
        });
    }
}

impl Frame {
    fn sum(&self) -> f64 {
        self.passes.iter().map(|(_, ms)| ms).sum()
    }

    fn tell(&self, ui: &mut Ui) {
        for (label, time) in &self.passes {
            ui.monospace(format!("{label:<12}{:>9}", ms(*time)));
        }
        ui.monospace(format!("{:<12}{:>9}", "all", ms(self.sum())));
    }
}

/// The next of 1, 2, 5, 10, 20, … above a number.
fn nice(number: f64) -> f64 {
    let power = 10f64.powf(number.log10().floor());
    [1.0, 2.0, 5.0].map(|step| step * power).into_iter().find(|step| *step >= number).unwrap_or(10.0 * power)
}

fn tell_quality(ui: &mut Ui, quality: &Quality, settings: &Settings, frame: f64) {
    let size = quality.size.map(|side| (f64::from(side) * quality.scale).round());
    ui.label(format!("{} a frame, {:.0}x{:.0} px", ms(frame), size[0], size[1])).on_hover_text(format!(
        "From the frame's start until it is handed over. While the camera moves, pictures have fewer pixels, and surfels, where whole ones \
         would take longer than they may: never less than {:.0} % of the pixels, nor fewer than {} surfels, or all.",
        100.0 * MIN_SCALE * MIN_SCALE,
        thousands(LEAST_SURFELS as u64)
    ));
    let part = if quality.scale < 1.0 {
        format!("{:.0} % of the picture's pixels", 100.0 * quality.scale * quality.scale)
    } else {
        "all of the picture's pixels".into()
    };
    ui.label(part);
    let normalized = match settings.pull_push {
        Some(_) => "reconstructed from points".into(),
        None => format!("normalized by {}", settings.splatting.normalization.name()),
    };
    let surfels = match (quality.surfels, quality.of) {
        (fewer, of) if fewer < of => format!("{} of {} surfels", thousands(fewer), thousands(of)),
        (_, of) => format!("{} surfels", thousands(of)),
    };
    ui.label(format!("{surfels}, {normalized}"));
}

fn tell_counts(ui: &mut Ui, counts: &SplatCounts) {
    let SplatCounts { drawn, behind, eye_plane, back, outside, invalid } = *counts;
    Grid::new("counts").num_columns(2).show(ui, |ui| {
        for (name, count, text) in [
            ("drawn", drawn, "surfels of which the picture is made"),
            ("behind", behind, "left out: the centre is not in front of the eye"),
            ("eye plane", eye_plane, "left out: the disc reaches the eye plane"),
            ("back", back, "left out: the normal faces away, and such are left out"),
            ("outside", outside, "left out: off the picture, or without an area on it"),
            ("invalid", invalid, "left out: a value is not a number, or not one that can be drawn"),
        ] {
            ui.label(name).on_hover_text(text);
            ui.monospace(format!("{count:>10}"));
            ui.end_row();
        }
    });
}

/// What a pass does.
fn pass_text(label: &str) -> &'static str {
    match label {
        "clear" => "empties counts and lists",
        "footprint" => "surfels to splats, culled and counted",
        "visibility" => "splats to the depth of the nearest surface",
        "tiles" => "the least depth of each tile, by which hidden splats are left out",
        "attribute" => "splats within ε of the nearest surface to weighted sums",
        "nearest" => "the nearest splat of each pixel",
        "resolve" => "what the nearest splat is",
        "normalize" => "sums to the picture",
        "project" => "points to the nearest one of each pixel",
        "fetch" => "what the nearest points are",
        "pull" => "levels of the pyramid, fine to coarse",
        "copy" => "what was pulled of a level, beside the coarser one",
        "push" => "levels, coarse to fine: holes are filled",
        "shade" => "level 0 to the picture",
        "read back" => "the counts for this panel",
        "screen" => "the picture over the background",
        "clear range" => "nothing is the least and the greatest yet",
        "read range" => "both for the legend",
        "range" => "the least and the greatest of the picture's numbers",
        "colour map" => "numbers to colours",
        "depths" => "depths, by which the cursor finds the surface",
        _ => "a pass of the frame",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use surfel::vk::PassTime;

    fn report(milliseconds: f64) -> Reports {
        let pass_times = ["a", "b", "a"].map(|label| PassTime { label, milliseconds }).to_vec();
        let mut left = FrameReport::default();
        left.pass_times.extend(pass_times);
        Reports { left: Some(left), right: None }
    }

    #[test]
    fn the_last_frames_are_kept_and_passes_keep_their_colours() {
        let mut times = Times::default();
        assert!(!times.push(Reports { left: None, right: None }));
        for number in 0..FRAMES + 7 {
            assert!(times.push(report(number as f64)));
        }
        assert_eq!((times.frames.len(), &times.passes[..]), (FRAMES, &["a", "b"][..]));
        assert_eq!(times.frames[0].sum(), 21.0);
        assert_ne!(times.colour("a"), times.colour("b"));
    }

    #[test]
    fn times_have_the_digits_that_mean_something() {
        let all = [123.456, 42.9, 9.96, 9.94, 1.04, 0.996, 0.994, 0.0123, 0.001].map(ms);
        let expected = ["123", "43", "10", "9.9", "1.0", "1.0", "0.99", "0.01", "0.00"];
        assert_eq!(all, expected.map(|text| format!("{text} ms")));
    }

    #[test]
    fn the_scale_ends_at_a_round_number() {
        let ends = [0.7, 1.0, 1.1, 3.0, 49.0, 51.0, 999.0].map(nice);
        assert_eq!(ends, [1.0, 1.0, 2.0, 5.0, 50.0, 100.0, 1000.0]);
    }
}
