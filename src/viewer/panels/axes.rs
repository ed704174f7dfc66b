//! What is changed of a method along the axes.

use egui::{ComboBox, Ui};
use surfel::Result;
use surfel::settings::Choice;
use surfel::settings::splatting::{Filter, Footprint, Normalization, Shade, Splatting, Visibility};

/// A choice along an axis: its name, what it means, and what it makes of the others.
type Alternative = (&'static str, &'static str, Splatting);

/// A box for each axis; `weighted` tells whether the scene has normalization weights.
pub fn show(ui: &mut Ui, splatting: &mut Splatting, weighted: bool) {
    let now = *splatting;
    let axes: [(&str, &str, &str, Vec<Alternative>); 5] = [
        ("footprint", "What a surfel becomes on the screen.", now.footprint.name(), footprints(now)),
        ("filter", "What is done against aliasing.", now.filter.name(), filters(now)),
        (
            "visibility",
            "Which of the splats at a pixel are blended.",
            now.visibility.name(),
            visibilities(now),
        ),
        (
            "normalization",
            "What the blended sum is divided by.",
            now.normalization.name(),
            normalizations(now),
        ),
        ("shade", "What is lit: pixels or splats.", now.shade.name(), shades(now)),
    ];
    for (axis, means, name, choices) in axes {
        let chosen = choices.iter().find(|(choice, ..)| *choice == name).map_or("", |(_, text, _)| text);
        let shown = ComboBox::from_label(axis).selected_text(name).show_ui(ui, |ui| {
            for (name, text, made) in choices {
                choice(ui, splatting, (name, text, made), weighted);
            }
        });
        shown.response.on_hover_text(format!("{means}\n{name}: {chosen}"));
    }
}

/// What makes no sense with the rest is grey and says why.
fn choice(ui: &mut Ui, splatting: &mut Splatting, (name, text, made): Alternative, weighted: bool) {
    let refused = check(&made, weighted).err();
    ui.add_enabled_ui(refused.is_none(), |ui| {
        let label = ui.selectable_label(*splatting == made, name).on_hover_text(text);
        if let Some(cause) = refused {
            label.on_disabled_hover_text(cause.to_string());
        } else if label.clicked() {
            *splatting = made;
        }
    });
}

fn check(splatting: &Splatting, weighted: bool) -> Result<()> {
    splatting.check()?;
    splatting.normalization.check_weights(weighted)
}

/// What each of an axis makes of the others.
fn alternatives<T: Choice>(made: impl Fn(T) -> Splatting) -> Vec<Alternative> {
    T::ALL.iter().map(|one| (one.name(), one.about(), made(*one))).collect()
}

fn footprints(now: Splatting) -> Vec<Alternative> {
    alternatives(|footprint: Footprint| Splatting { footprint, ..now })
}

fn filters(now: Splatting) -> Vec<Alternative> {
    alternatives(|filter: Filter| Splatting { filter, ..now })
}

fn visibilities(now: Splatting) -> Vec<Alternative> {
    alternatives(|visibility: Visibility| {
        // One splat alone has nothing to normalize; several have.
        let normalization = match (visibility, now.visibility) {
            (Visibility::Nearest, _) => Normalization::None,
            (_, Visibility::Nearest) => Normalization::Pixel,
            _ => now.normalization,
        };
        Splatting { visibility, normalization, ..now }
    })
}

fn normalizations(now: Splatting) -> Vec<Alternative> {
    alternatives(|normalization: Normalization| Splatting { normalization, ..now })
}

fn shades(now: Splatting) -> Vec<Alternative> {
    alternatives(|shade: Shade| Splatting { shade, ..now })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_every_choice_the_first_method_can_be_reached_again() {
        let all = |now| {
            [footprints(now), filters(now), visibilities(now), normalizations(now), shades(now)].concat()
        };
        let next = |now| all(now).into_iter().map(|(.., made)| made).filter(|made| check(made, true).is_ok());
        let (mut seen, mut new) = (vec![Splatting::default()], vec![Splatting::default()]);
        while let Some(now) = new.pop() {
            for made in next(now) {
                if !seen.contains(&made) {
                    seen.push(made);
                    new.push(made);
                }
            }
        }
        // Every choice that makes sense with the Gaussian is among them, and from each there is a way back.
        for footprint in footprints(Splatting::default()) {
            assert!(seen.iter().any(|seen| seen.footprint.name() == footprint.0), "{}", footprint.0);
        }
        let mut back = vec![Splatting::default()];
        loop {
            let more: Vec<_> = seen
                .iter()
                .filter(|from| !back.contains(from) && next(**from).any(|made| back.contains(&made)))
                .copied()
                .collect();
            if more.is_empty() {
                break;
            }
            back.extend(more);
        }
        assert_eq!(back.len(), seen.len());
    }
}
