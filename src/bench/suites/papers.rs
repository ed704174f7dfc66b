//! Effects that the papers show, costs that they state, and times that they measured; beside them, what we claim beyond them.

use crate::bench::papers::models::Models;
use crate::bench::papers::{costs, effects, tables};
use crate::bench::plan::Plan;

/// All items. Of the papers' models, those that are given.
pub(super) fn plans(models: &Models) -> Vec<Plan> {
    let effects = effects::all().flat_map(|effect| effect.plans(models));
    let costs = costs::ALL.iter().flat_map(|cost| cost.plans());
    effects.chain(costs).chain(tables::all().flat_map(|table| table.plans(models))).collect()
}
