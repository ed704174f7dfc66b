//! Colours of the panels. Text has a contrast of at least 4.5 : 1 (WCAG 2.1).

use egui::{Color32, Context, Theme, Visuals};

/// Sets the colours of the panels, independent of the system's theme.
pub fn apply(context: &Context) {
    context.set_theme(Theme::Dark);
    context.set_visuals_of(Theme::Dark, visuals());
}

fn visuals() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(200);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(220);
    visuals.weak_text_color = Some(Color32::from_gray(165));
    visuals.error_fg_color = Color32::from_rgb(255, 130, 120);
    visuals.disabled_alpha = 0.7;
    visuals
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Rgba;

    /// WCAG 2.1's contrast ratio.
    fn contrast(text: Color32, behind: Color32) -> f32 {
        let [a, b] = [text, behind].map(|colour| {
            let colour = Rgba::from(colour);
            0.2126 * colour.r() + 0.7152 * colour.g() + 0.0722 * colour.b() + 0.05
        });
        a.max(b) / a.min(b)
    }

    #[test]
    fn text_has_enough_contrast() {
        let visuals = visuals();
        let panels = [visuals.panel_fill, visuals.window_fill];
        let texts = [
            ("text", visuals.text_color()),
            ("weak", visuals.weak_text_color()),
            ("strong", visuals.strong_text_color()),
            ("error", visuals.error_fg_color),
            ("disabled", visuals.disable(visuals.widgets.inactive.fg_stroke.color)),
        ];
        for (name, text) in texts {
            for behind in panels {
                // Transparent text is blended with its background.
                let text = behind.blend(text);
                assert!(contrast(text, behind) >= 4.5, "{name}: {}", contrast(text, behind));
            }
        }
        let widgets = &visuals.widgets;
        for widget in [widgets.inactive, widgets.hovered, widgets.active, widgets.open] {
            let found = contrast(widget.fg_stroke.color, widget.weak_bg_fill);
            assert!(found >= 4.5, "{widget:?}: {found}");
        }
        let selection = visuals.selection;
        assert!(contrast(selection.stroke.color, selection.bg_fill) >= 4.5);
        assert!(contrast(visuals.text_color(), visuals.extreme_bg_color) >= 4.5);
    }
}
