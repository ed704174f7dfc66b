//! Axes panel: the method's choice along each axis.

use super::widgets::{choice, combo};
use egui::Ui;
use surfel::Result;
use surfel::settings::Choice;
use surfel::settings::splatting::{Filter, Footprint, Normalization, Shade, Splatting, Visibility};

/// A choice along an axis: its name, its tooltip, and the splatting with it.
type Alternative = (&'static str, &'static str, Splatting);

/// Shows a box for each axis. `weighted` is whether the scene has normalization weights.
pub fn show(ui: &mut Ui, splatting: &mut Splatting, weighted: bool) {
    let now = *splatting;
    let axes: [(&str, &str, &str, Vec<Alternative>); 5] = [
        ("footprint", "Shape of a surfel on the screen.", now.footprint.name(), footprints(now)),
        ("filter", "Anti-aliasing filter.", now.filter.name(), filters(now)),
        ("visibility", "Which splats of a pixel are blended.", now.visibility.name(), visibilities(now)),
        (
            "normalization",
            "What the blended sum is divided by.",
            now.normalization.name(),
            normalizations(now),
        ),
        ("shade", "Whether pixels or splats are lit.", now.shade.name(), shades(now)),
    ];
    for (axis, help, name, choices) in axes {
        let chosen = choices.iter().find(|(known, ..)| *known == name).map_or("", |(_, text, _)| text);
        combo(ui, axis, name, &format!("{help}\n{name}: {chosen}"), |ui| {
            for (name, text, new) in choices {
                let error = check(&new, weighted).err().map(|error| error.to_string());
                if choice(ui, *splatting == new, name, text, error.as_deref()) {
                    *splatting = new;
                }
            }
        });
    }
}

/// Whether the choices of all axes combine with each other and with the scene.
fn check(splatting: &Splatting, weighted: bool) -> Result<()> {
    splatting.check()?;
    splatting.normalization.check_weights(weighted)
}

/// All choices along an axis; `with` makes the splatting of each.
fn alternatives<T: Choice>(with: impl Fn(T) -> Splatting) -> Vec<Alternative> {
    T::ALL.iter().map(|one| (one.name(), one.about(), with(*one))).collect()
}

fn footprints(now: Splatting) -> Vec<Alternative> {
    alternatives(|footprint: Footprint| Splatting { footprint, ..now })
}

fn filters(now: Splatting) -> Vec<Alternative> {
    alternatives(|filter: Filter| Splatting { filter, ..now })
}

fn visibilities(now: Splatting) -> Vec<Alternative> {
    alternatives(|visibility: Visibility| {
        // A single splat is not normalized; several have to be.
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
    fn from_every_choice_the_first_method_can_be_reached() {
        let all = |now| {
            [footprints(now), filters(now), visibilities(now), normalizations(now), shades(now)].concat()
        };
        let next = |now| all(now).into_iter().map(|(.., new)| new).filter(|new| check(new, true).is_ok());
        let (mut reached, mut queue) = (vec![Splatting::default()], vec![Splatting::default()]);
        while let Some(now) = queue.pop() {
            for new in next(now) {
                if !reached.contains(&new) {
                    reached.push(new);
                    queue.push(new);
                }
            }
        }
        // Every footprint is reached, and from every combination there is a way back.
        for footprint in footprints(Splatting::default()) {
            assert!(reached.iter().any(|reached| reached.footprint.name() == footprint.0), "{}", footprint.0);
        }
        let mut back = vec![Splatting::default()];
        loop {
            let more: Vec<_> = reached
                .iter()
                .filter(|from| !back.contains(from) && next(**from).any(|new| back.contains(&new)))
                .copied()
                .collect();
            if more.is_empty() {
                break;
            }
            back.extend(more);
        }
        assert_eq!(back.len(), reached.len());
    }
}
