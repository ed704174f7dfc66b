//! Runs by several kernels.

use crate::bench::plan::Plan;
use crate::settings::Settings;
use crate::settings::splatting::{Filter, Footprint, Kernel, Splatting};

/// The plan by kernels on discs in the tangent plane, each with its cut-off, σ.
pub fn kernels<const N: usize>(plan: &Plan, kernels: [(Kernel, f32); N]) -> Vec<Plan> {
    let one = |(kernel, cutoff)| {
        let splatting =
            Splatting { footprint: Footprint::Disc, kernel, filter: Filter::None, ..plan.settings.splatting };
        let settings = Settings { splatting, cutoff, ..plan.settings.clone() };
        Plan { settings, ..plan.clone() }
    };
    kernels.map(one).into()
}

/// ψ with these parameters.
pub const fn confetti(a: f32, n: f32) -> (Kernel, f32) {
    (Kernel::Confetti { a, n }, 2.0)
}

/// A Gaussian of this σ whose rim is at 1.5, as the paper's.
pub fn gaussian(sigma: f32) -> (Kernel, f32) {
    (Kernel::Gaussian, 1.5 / sigma)
}
