//! Kernel panel: the choice of the kernel, and a plot of it.

use super::widgets::{choice, combo};
use egui::{Align2, Color32, FontId, Pos2, Sense, Shape, Slider, SliderClamping, Stroke, Ui, vec2};
use surfel::settings::splatting::{Kernel, Splatting};

/// Maximum width and height of the plot, points.
const SIZE: [f32; 2] = [240.0, 90.0];
/// Number of segments of the curve.
const STEPS: u32 = 100;
/// The kernel of figure 18 of the confetti paper.
const CONFETTI: Kernel = Kernel::Confetti { a: 6.0, n: 3.0 };

/// Shows the choice and the plot; `cutoff` is in standard deviations.
pub fn show(ui: &mut Ui, splatting: &mut Splatting, cutoff: f32) {
    let name = match splatting.kernel {
        Kernel::Gaussian => "gaussian",
        Kernel::Confetti { .. } => "confetti",
    };
    combo(ui, "kernel", name, "Falloff of a splat's weight from its centre to its rim.", |ui| {
        for (name, kernel, text) in [
            ("gaussian", Kernel::Gaussian, "exp(−½ m²), m σ from the centre, up to the cut-off"),
            ("confetti", CONFETTI, "exp(−a tⁿ / (1 − tⁿ)), t from 0 at the centre to 1 at the rim"),
        ] {
            let error = Splatting { kernel, ..*splatting }.check().err().map(|error| error.to_string());
            let same = std::mem::discriminant(&kernel) == std::mem::discriminant(&splatting.kernel);
            if choice(ui, same, name, text, error.as_deref()) && !same {
                splatting.kernel = kernel;
            }
        }
    });
    if let Kernel::Confetti { a, n } = &mut splatting.kernel {
        ui.add(Slider::new(a, 0.1..=20.0).logarithmic(true).clamping(SliderClamping::Edits).text("a"))
            .on_hover_text("Larger values make the kernel narrower.");
        ui.add(Slider::new(n, 0.5..=12.0).clamping(SliderClamping::Edits).text("n"))
            .on_hover_text("Larger values flatten the top of the kernel.");
    }
    curve(ui, splatting.kernel, cutoff);
}

/// The weight at a fraction of the distance from the centre to the rim.
fn weight(kernel: Kernel, cutoff: f32, fraction: f32) -> f32 {
    match kernel {
        Kernel::Gaussian => (-0.5 * (cutoff * fraction).powi(2)).exp(),
        Kernel::Confetti { .. } if fraction >= 1.0 => 0.0,
        Kernel::Confetti { a, n } => (-a * fraction.powf(n) / (1.0 - fraction.powf(n))).exp(),
    }
}

fn curve(ui: &mut Ui, kernel: Kernel, cutoff: f32) {
    let (response, painter) =
        ui.allocate_painter(vec2(ui.available_width().min(SIZE[0]), SIZE[1]), Sense::hover());
    let (ink, font) = (ui.visuals().weak_text_color(), FontId::proportional(10.0));
    let rect = response.rect.shrink2(vec2(14.0, 12.0));
    let point = |fraction: f32, weight: f32| -> Pos2 {
        rect.left_bottom() + vec2(fraction * rect.width(), -weight * rect.height())
    };
    let axis = Stroke::new(1.0, ink);
    painter.line_segment([point(0.0, 0.0), point(1.0, 0.0)], axis);
    painter.line_segment([point(0.0, 0.0), point(0.0, 1.0)], axis);
    painter.text(point(0.0, 1.0), Align2::RIGHT_CENTER, "1 ", font.clone(), ink);
    painter.text(point(0.0, 0.0), Align2::CENTER_TOP, "centre", font.clone(), ink);
    let rim = match kernel {
        Kernel::Gaussian => format!("rim, {cutoff:.2} σ"),
        Kernel::Confetti { .. } => "rim".into(),
    };
    painter.text(point(1.0, 0.0), Align2::RIGHT_TOP, rim, font, ink);
    let points = (0..=STEPS).map(|step| step as f32 / STEPS as f32);
    let points: Vec<_> = points.map(|fraction| point(fraction, weight(kernel, cutoff, fraction))).collect();
    painter.add(Shape::line(points, Stroke::new(1.5, Color32::from_rgb(90, 170, 250))));
    response.on_hover_text("Weight of a splat from its centre to its rim, before the filter.");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_fall_from_one_to_the_rim() {
        for (kernel, rim) in [(Kernel::Gaussian, (-3.125f32).exp()), (CONFETTI, 0.0)] {
            let curve: Vec<_> = (0..=STEPS).map(|i| weight(kernel, 2.5, i as f32 / STEPS as f32)).collect();
            assert_eq!(curve[0], 1.0);
            assert!((curve[STEPS as usize] - rim).abs() < 1e-6);
            assert!(curve.windows(2).all(|pair| pair[1] <= pair[0]));
        }
    }
}
