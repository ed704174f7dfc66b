//! Times panel: GPU times of the passes of the last frames, and counts of culled surfels.

use crate::viewer::quality::{COARSEST_LOD, MIN_SCALE};
use crate::viewer::split_view::Reports;
use egui::{Align2, Color32, FontId, Grid, Pos2, Rect, Sense, Ui, vec2};
use std::collections::VecDeque;
use std::sync::Weak;
use surfel::settings::Choice;
use surfel::thousands;
use surfel::{FrameReport, Scene, Settings, SplatCounts};

/// Number of frames in the plot.
const FRAMES: usize = 120;
/// Height of the plot, points.
const HEIGHT: f32 = 96.0;
/// Colours of passes, in the order in which these first occur. The first seven are the palette of Okabe and Ito for colour-blind readers.
const COLOURS: [Color32; 26] = [
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
    Color32::from_rgb(255, 255, 255),
    Color32::from_rgb(75, 255, 30),
    Color32::from_rgb(255, 30, 255),
    Color32::from_rgb(255, 30, 105),
    Color32::from_rgb(30, 255, 150),
    Color32::from_rgb(135, 30, 150),
    Color32::from_rgb(150, 255, 180),
    Color32::from_rgb(30, 105, 30),
    Color32::from_rgb(255, 165, 255),
    Color32::from_rgb(30, 255, 255),
    Color32::from_rgb(135, 180, 30),
    Color32::from_rgb(30, 60, 255),
    Color32::from_rgb(180, 210, 255),
    Color32::from_rgb(60, 75, 120),
    Color32::from_rgb(180, 30, 45),
    Color32::from_rgb(30, 180, 30),
];

/// Times of the last frames.
#[derive(Default)]
pub struct Times {
    open: bool,
    frames: VecDeque<Frame>,
    /// Names of all passes so far, in the order in which they first occurred.
    passes: Vec<&'static str>,
    /// Report of the last frame's left or only picture.
    left: Option<FrameReport>,
    /// Report of its right picture.
    right: Option<FrameReport>,
    /// Scene and settings of the left and of the right picture.
    measured: [Option<(Weak<Scene>, Settings)>; 2],
}

/// Times of a frame.
struct Frame {
    /// Names and times of its passes, ms.
    passes: Vec<(&'static str, f64)>,
}

/// Resolution and level of detail of the last frame.
pub struct FrameDetail {
    /// Width and height of the picture, px.
    pub size: [u32; 2],
    /// Resolution scale of what was rendered.
    pub scale: f64,
    /// Number of surfels that were rendered.
    pub surfels: u64,
    /// Number of surfels of the scene.
    pub all_surfels: u64,
}

/// Sum of the times of a frame's passes, ms.
pub fn sum(report: &FrameReport) -> f64 {
    report.pass_times.iter().map(|pass| pass.milliseconds).sum()
}

/// Formats a time with at most two decimals: two significant digits, three or more from 100 ms.
pub fn ms(milliseconds: f64) -> String {
    let decimals = match milliseconds {
        large if large >= 9.95 => 0,
        middle if middle >= 0.995 => 1,
        _ => 2,
    };
    format!("{milliseconds:.decimals$} ms")
}

impl Times {
    /// Whether the panel is open.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// The last reports of the left and of the right picture.
    pub fn last(&self) -> [Option<&FrameReport>; 2] {
        [self.left.as_ref(), self.right.as_ref()]
    }

    /// Drops the reports of pictures of other scenes or settings than those of the left and of the right picture; `None` for a picture that is
    /// not visible.
    pub fn keep_reports_of(&mut self, scene: &Weak<Scene>, settings: [Option<&Settings>; 2]) {
        let reports = [&mut self.left, &mut self.right];
        for ((report, measured), settings) in reports.into_iter().zip(&mut self.measured).zip(settings) {
            let Some(settings) = settings else { continue };
            let is_same =
                |(before, own): &(Weak<Scene>, Settings)| Weak::ptr_eq(before, scene) && own == settings;
            if !measured.as_ref().is_some_and(is_same) {
                (*report, *measured) = (None, Some((scene.clone(), settings.clone())));
            }
        }
    }

    /// Takes the reports of a frame; returns whether there were any.
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
        self.left = Some(report);
        is_new
    }

    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, detail: &FrameDetail, settings: &Settings, frame: f64) {
        let header = ui.collapsing("Times", |ui| {
            show_detail(ui, detail, settings, frame);
            self.plot(ui);
            self.legend(ui);
            if let Some(counts) = self.left.as_ref().and_then(|report| report.counts) {
                ui.separator();
                show_counts(ui, &counts);
            }
        });
        header
            .header_response
            .on_hover_text("While this is open, each pass is timed, which makes frames slower.");
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
            let text = "no frame was timed yet";
            painter.text(
                rect.center(),
                Align2::CENTER_CENTER,
                text,
                FontId::default(),
                ui.visuals().weak_text_color(),
            );
            return;
        }
        let top = round_up(most);
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
            response.on_hover_ui_at_pointer(|ui| frame.show(ui));
        }
    }

    /// Shows the passes of the last frame with their colours and times.
    fn legend(&self, ui: &mut Ui) {
        let Some(last) = &self.left else { return };
        Grid::new("passes").num_columns(3).show(ui, |ui| {
            for pass in &last.pass_times {
                let (response, painter) = ui.allocate_painter(vec2(10.0, 10.0), Sense::hover());
                painter.rect_filled(response.rect, 1.0, self.colour(pass.label));
                ui.label(pass.label).on_hover_text(pass_text(pass.label));
                ui.monospace(format!("{:>9}", ms(pass.milliseconds)));
                ui.end_row();
            }
            ui.label("");
            ui.strong("all passes").on_hover_text("GPU time without the panels and without presenting.");
            ui.monospace(format!("{:>9}", ms(sum(last))));
            ui.end_row();
        });
    }
}

impl Frame {
    fn sum(&self) -> f64 {
        self.passes.iter().map(|(_, ms)| ms).sum()
    }

    fn show(&self, ui: &mut Ui) {
        for (label, time) in &self.passes {
            ui.monospace(format!("{label:<12}{:>9}", ms(*time)));
        }
        ui.monospace(format!("{:<12}{:>9}", "all", ms(self.sum())));
    }
}

/// The least of 1, 2, 5, 10, 20, … that is not below a number.
fn round_up(number: f64) -> f64 {
    let power = 10f64.powf(number.log10().floor());
    [1.0, 2.0, 5.0].map(|step| step * power).into_iter().find(|step| *step >= number).unwrap_or(10.0 * power)
}

/// Shows the resolution and the level of detail of the last frame.
fn show_detail(ui: &mut Ui, detail: &FrameDetail, settings: &Settings, frame: f64) {
    let size = detail.size.map(|side| (f64::from(side) * detail.scale).round());
    ui.label(format!("{} a frame, {:.0}x{:.0} px", ms(frame), size[0], size[1])).on_hover_text(format!(
        "Time from the frame's start until it is presented. While the camera moves, frames that would exceed the time budget have fewer pixels and \
         fewer surfels: at least {:.0} % of the pixels, and a surfel for every cell of {COARSEST_LOD} px.",
        100.0 * MIN_SCALE * MIN_SCALE,
    ));
    let part = if detail.scale < 1.0 {
        format!("{:.0} % of the picture's pixels", 100.0 * detail.scale * detail.scale)
    } else {
        "full resolution".into()
    };
    ui.label(part);
    let normalized = match settings.pull_push {
        Some(_) => "reconstructed from points".into(),
        None => format!("normalized by {}", settings.splatting.normalization.name()),
    };
    let surfels = match (detail.surfels, detail.all_surfels) {
        (fewer, of) if fewer < of => format!("{} of {} surfels", thousands(fewer), thousands(of)),
        (_, of) => format!("{} surfels", thousands(of)),
    };
    ui.label(format!("{surfels}, {normalized}"));
}

/// Shows the counts of drawn and culled surfels.
fn show_counts(ui: &mut Ui, counts: &SplatCounts) {
    let SplatCounts { drawn, behind, eye_plane, back, outside, invalid, other_level, hidden } = *counts;
    Grid::new("counts").num_columns(2).show(ui, |ui| {
        for (name, count, text) in [
            ("drawn", drawn, "Surfels that the picture shows."),
            ("behind", behind, "Culled: the centre is not in front of the eye."),
            ("eye plane", eye_plane, "Culled: the disc reaches the eye plane."),
            ("back", back, "Culled: the normal faces away from the eye."),
            ("outside", outside, "Culled: outside the picture, or without an area on it."),
            ("invalid", invalid, "Culled: a value is not finite or not valid."),
            ("other level", other_level, "Not drawn: another level of detail is drawn there."),
            (
                "hidden",
                hidden,
                "Culled: in a group of neighbours all behind what is seen, as in the frame before.",
            ),
        ] {
            ui.label(name).on_hover_text(text);
            ui.monospace(format!("{count:>10}"));
            ui.end_row();
        }
    });
}

/// Tooltip of a pass.
fn pass_text(label: &str) -> &'static str {
    match label {
        "clear" => "Clears counts, lists and targets.",
        "cull" => "Culls clusters of surfels by their bounds.",
        "footprint" => "Projects surfels to splats, culls and counts them.",
        "order" => "Sorts surfels in arbitrary order along a curve.",
        "occlusion" => "Measures how much of the light from all around is blocked.",
        "ambient" => "Darkens the picture by its ambient occlusion.",
        "edl" => "Darkens pixels behind their neighbours.",
        "filter" => "Filters the pixels of the lit picture.",
        "hidden" => "Finds groups of surfels that others hide.",
        "sides" => "Drops splats of the far side of closed surfaces.",
        "visibility" => "Renders the depth of the nearest surface from the splats.",
        "boxes" => "Bounds the splats of each node of the hierarchy.",
        "covered" => "Lists the tiles that splats may cover.",
        "open" => "Lists the tiles to be drawn again.",
        "behind" => "Mixes the surface behind into pixels at edges.",
        "surface" => "Rasterizes, blends and shades the splats tile by tile.",
        "attribute" => "Sums the splats within ε of the nearest surface, weighted.",
        "nearest" => "Finds the nearest splat of each pixel.",
        "normalize" => "Divides the sums by their weights.",
        "project" => "Finds the nearest point of each pixel.",
        "occupied" => "Lists the tiles that have points.",
        "fetch" => "Reads the attributes of the nearest points.",
        "pull" => "Builds the levels of the pyramid, fine to coarse.",
        "copy" => "Copies each pulled level to the pyramid of the coarser one.",
        "push" => "Fills holes from level to level, coarse to fine.",
        "filled" => "Lists the tiles that push may fill.",
        "shade" => "Shades level 0.",
        "read back" => "Reads the counts of this panel back.",
        "screen" => "Composites the picture over the background.",
        "clear range" => "Clears the range of values.",
        "read range" => "Reads the range of values back for the legend.",
        "range" => "Finds the range of the picture's values.",
        "colour map" => "Maps values to colours.",
        "depths" => "Reads the depths back, to find the surface under the cursor.",
        _ => "A pass of the frame.",
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
    fn a_report_is_kept_as_long_as_its_picture_has_the_same_settings() {
        let (scene, plain) = (Weak::new(), Settings::default());
        let other = Settings { cutoff: 2.0, ..Settings::default() };
        let mut times = Times::default();
        let both = || Reports { right: report(1.0).left, ..report(1.0) };
        let mut kept = |settings, reports| {
            times.keep_reports_of(&scene, settings);
            let kept = times.last().map(|report| report.is_some());
            times.push(reports);
            kept
        };
        let none = || Reports { left: None, right: None };
        assert_eq!(kept([Some(&plain), Some(&plain)], both()), [false; 2]);
        assert_eq!(kept([Some(&plain), Some(&plain)], none()), [true; 2]);
        // The view is not split for a while.
        assert_eq!(kept([Some(&plain), None], none()), [true; 2]);
        assert_eq!(kept([Some(&plain), Some(&plain)], none()), [true; 2]);
        assert_eq!(kept([Some(&other), Some(&plain)], none()), [false, true]);
        assert_eq!(kept([Some(&other), Some(&other)], both()), [false; 2]);
        assert_eq!(kept([Some(&other), Some(&other)], none()), [true; 2]);
    }

    #[test]
    fn all_passes_of_a_frame_have_different_colours() {
        let mut times = Times::default();
        let mut left = FrameReport::default();
        let labels: Vec<_> = (0..25).map(|number| &*format!("pass {number}").leak()).collect();
        left.pass_times.extend(labels.iter().map(|&label| PassTime { label, milliseconds: 1.0 }));
        times.push(Reports { left: Some(left), right: None });
        for (i, a) in labels.iter().enumerate() {
            for b in &labels[..i] {
                let [a, b] = [a, b].map(|label| times.colour(label));
                let apart = (0..3).map(|channel| a[channel].abs_diff(b[channel])).max().unwrap();
                assert!(apart >= 32, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn times_have_the_significant_digits() {
        let all = [123.456, 42.9, 9.96, 9.94, 1.04, 0.996, 0.994, 0.0123, 0.001].map(ms);
        let expected = ["123", "43", "10", "9.9", "1.0", "1.0", "0.99", "0.01", "0.00"];
        assert_eq!(all, expected.map(|text| format!("{text} ms")));
    }

    #[test]
    fn the_axis_ends_at_a_round_number() {
        let ends = [0.7, 1.0, 1.1, 3.0, 49.0, 51.0, 999.0].map(round_up);
        assert_eq!(ends, [1.0, 1.0, 2.0, 5.0, 50.0, 100.0, 1000.0]);
    }
}
