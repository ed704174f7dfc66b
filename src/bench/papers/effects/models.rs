//! Pictures of the papers' models, of those that are given.

use super::{BLOAT, Effect, LARGEST_OVERLAP, OVERLAP, RMSE};
use crate::bench::papers::models::Given;
use crate::bench::papers::quotation::Paper;
use crate::bench::place::Place;
use crate::bench::plan::Plan;
use crate::settings::Shading;
use crate::verify::scenes::Viewpoint;

const SIZE: [u32; 2] = [512; 2];

pub const EFFECTS: [Effect; 4] = [
    Effect {
        name: "ren2002 models",
        title: "Models of ren2002, figure 12",
        description: "By object-ewa-paper. The paper compares nothing here.",
        metrics: &[RMSE, BLOAT],
        expected: &[],
        claims: &[],
        plans: |effect, models| {
            pictures(effect, models.of(Paper::Ren2002), "object-ewa-paper", |given| vec![given])
        },
    },
    Effect {
        name: "botsch2003 models",
        title: "Models of botsch2003, figures 7 and 9",
        description: "By sprites-paper. The paper compares nothing here.",
        metrics: &[RMSE, BLOAT],
        expected: &[],
        claims: &[],
        plans: |effect, models| {
            pictures(effect, models.of(Paper::Botsch2003), "sprites-paper", |given| vec![given])
        },
    },
    Effect {
        name: "pajarola2004 models",
        title: "Models of pajarola2004, figures 1 and 18",
        description: "By confetti-paper, without levels of detail: the picture, then the number of splats at each pixel, at figure 18's size.",
        metrics: &[OVERLAP, LARGEST_OVERLAP, RMSE, BLOAT],
        expected: &[],
        claims: &[],
        plans: |effect, models| {
            let both = |plan: Plan| {
                let mut overlap = Plan { size: [1280, 1024], ..plan.clone() };
                overlap.settings.shading = Shading::Overlap;
                overlap.measurements.error = false;
                vec![plan, overlap]
            };
            pictures(effect, models.of(Paper::Pajarola2004), "confetti-paper", both)
        },
    },
    Effect {
        name: "marroquim2008 models",
        title: "Models of marroquim2008, figures 4, 17 and 18",
        description: "By pull-push-paper, and a detail of each. The paper compares nothing here but the weights of figure 4.",
        metrics: &[RMSE, BLOAT],
        expected: &[],
        claims: &[],
        plans: |effect, models| {
            let both = |plan: Plan| {
                let Place::Given(whole) = plan.place else { return vec![plan] };
                let detail = Viewpoint { fov_y_deg: 0.25 * whole.fov_y_deg, ..whole };
                vec![plan.clone(), Plan { place: Place::Given(detail), ..plan }]
            };
            pictures(effect, models.of(Paper::Marroquim2008), "pull-push-paper", both)
        },
    },
];

/// Lit pictures of models, each with its own viewpoint.
fn pictures<'a>(
    effect: &Effect,
    given: impl Iterator<Item = &'a Given>,
    preset: &str,
    runs: impl Fn(Plan) -> Vec<Plan>,
) -> Vec<Plan> {
    let one = |given: &Given| {
        let subject = &given.subject;
        let mut plan = effect.plan(&subject.name, subject.most_points().unwrap_or(0), SIZE, preset);
        plan.settings.shading = Shading::Lit;
        plan.place = Place::Given(subject.viewpoint());
        // A model without triangles has nothing to compare with.
        plan.measurements.error = subject.surface().is_some();
        plan.measurements.details = false;
        runs(plan)
    };
    given.flat_map(one).collect()
}
