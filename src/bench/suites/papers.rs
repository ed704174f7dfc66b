//! Effects that the papers show, costs that they state, and times that they measured.

use crate::bench::papers::{claims, effects, tables};
use crate::bench::plan::Plan;

pub(super) fn plans() -> Vec<Plan> {
    let effects = effects::ALL.iter().flat_map(|effect| effect.plans());
    let claims = claims::ALL.iter().flat_map(|claim| claim.plans());
    effects.chain(claims).chain(tables::ALL.iter().flat_map(|table| table.plans())).collect()
}
