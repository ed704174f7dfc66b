//! What the user brings.

use super::{Suite, plan};
use crate::bench::plan::{Plan, Wants};
use crate::bench::record::Figure;
use crate::bench::subject::Subject;
use crate::settings::Shading;
use std::rc::Rc;

const SIZE: [u32; 2] = [768, 768];
const POINTS: [u64; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];

/// Time against error of each subject, at every density that it has and with all of its points.
pub fn plans(subjects: &[Rc<Subject>]) -> Vec<Plan> {
    subjects
        .iter()
        .flat_map(|subject| densities(subject).into_iter().flat_map(|points| budget(subject, points)))
        .collect()
}

fn densities(subject: &Subject) -> Vec<u64> {
    let most = subject.most_points();
    let fewer = POINTS.into_iter().filter(|&points| most.is_none_or(|most| points < most));
    fewer.chain(most).collect()
}

fn budget(subject: &Subject, points: u64) -> Vec<Plan> {
    let mut smooth = plan(Suite::Own, Figure::Budget, &subject.name, points, SIZE);
    if !subject.is_coloured() {
        smooth.settings.shading = Shading::Lit;
    }
    let mut sharp = smooth.clone();
    sharp.settings.lowpass = 0.0;
    let wants = Wants { terms: true, agreement: points <= 100_000, exhibit: true, ..Wants::BOTH };
    vec![Plan { wants, ..smooth }, sharp]
}
