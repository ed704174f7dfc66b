//! The runs of each effect: scene, viewpoint and settings.

use super::Effect;
use crate::bench::papers::method;
use crate::bench::place::Place;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::suites::{Suite, plan};
use crate::settings::methods::Method;
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Splatting, Visibility};
use crate::settings::{Settings, Shading};
use crate::verify::scenes::Viewpoint;

impl Effect {
    /// A run with a square picture of `side` px, showing colours, by the default method.
    fn plan(&self, scene: &str, points: u64, side: u32) -> Plan {
        let measurements =
            Measurements { error: true, details: true, images: true, ..Measurements::default() };
        let plan = plan(Suite::Papers, Experiment::Effects, scene, points, [side; 2]);
        Plan { paper_item: self.name.into(), measurements, ..plan }
    }
}

/// The plan once per splatting, with its other settings unchanged.
fn each<const N: usize>(plan: &Plan, splattings: [Splatting; N]) -> Vec<Plan> {
    let one = |splatting| Settings { splatting, ..plan.settings.clone() };
    splattings.map(|splatting| Plan { settings: one(splatting), ..plan.clone() }).into()
}

/// A viewpoint with y up.
fn view(eye: [f64; 3], target: [f64; 3], fov_y_deg: f64) -> Place {
    Place::Given(Viewpoint { eye, target, up: [0.0, 1.0, 0.0], fov_y_deg })
}

pub fn axis_offset(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:slabs?slabs=2&gap=0.6&clips=off", 20_000, 192);
    plan.place = view([0.3, 3.0, 0.3], [3.2, 0.4, 0.3], 75.0);
    plan.settings.epsilon = 4.0;
    let along = |visibility| Splatting { visibility, ..Splatting::default() };
    each(&plan, [along(Visibility::Axis), along(Visibility::Ray)])
}

pub fn thickening(effect: &Effect) -> Vec<Plan> {
    let ellipses = effect.plan("scene:sphere", 3000, 128).by(&method("sprites-unfiltered"));
    let shaped = ellipses.settings.splatting;
    each(&ellipses, [Splatting { footprint: Footprint::Square, ..shaped }, shaped])
}

/// The affine approximation beside the exact image, then every other method.
pub fn perspective_holes(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:relief?height=0&sampler=grid", 100, 192);
    // Grids have discs of 1.5 spacings; half the diagonal between neighbours is 0.71, and samples are slightly
    // jittered.
    plan.radius_scale = 0.56;
    plan.place = view([-2.0, 0.6, 7.2], [-2.0, 3.0, -2.0], 125.0);
    let affine = Splatting { footprint: Footprint::Affine, ..Splatting::default() };
    let mut plans = each(&plan, [Splatting::default(), affine]);
    plans.extend(Method::SPLATTING[1..].iter().map(|method| plan.by(method)));
    plans
}

pub fn moire(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:plane?frequency=2", 300_000, 128);
    plan.measurements.flicker = true;
    let screen = Splatting::default();
    let object = Splatting { footprint: Footprint::Parallelogram, filter: Filter::Object, ..screen };
    let without = |splatting| Splatting { filter: Filter::None, ..splatting };
    each(&plan, [without(screen), screen, without(object), object])
}

/// The plan by kernels on discs in the tangent plane, each with its cut-off, σ.
fn kernels<const N: usize>(plan: &Plan, kernels: [(Kernel, f32); N]) -> Vec<Plan> {
    let one = |(kernel, cutoff)| {
        let splatting =
            Splatting { footprint: Footprint::Disc, kernel, filter: Filter::None, ..Splatting::default() };
        let settings = Settings { splatting, cutoff, ..plan.settings.clone() };
        Plan { settings, ..plan.clone() }
    };
    kernels.map(one).into()
}

const fn confetti(a: f32, n: f32) -> (Kernel, f32) {
    (Kernel::Confetti { a, n }, 2.5)
}

pub fn kernel_blur(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:relief?height=0&frequency=2", 20_000, 192);
    plan.place = view([0.0, 3.0, 0.5], [0.0; 3], 60.0);
    let gaussian = |sigma: f32| (Kernel::Gaussian, 1.5 / sigma);
    kernels(&plan, [confetti(1.0, 2.0), confetti(4.0, 5.0), confetti(6.0, 3.0), gaussian(0.5), gaussian(0.8)])
}

pub fn kernel_facets(effect: &Effect) -> Vec<Plan> {
    let plan = effect.plan("scene:sphere?albedo=plain", 3000, 256);
    kernels(&plan, [confetti(4.0, 5.0), confetti(6.0, 3.0), (Kernel::Gaussian, 1.5 / 0.3)])
}

pub fn clip_lines(effect: &Effect) -> Vec<Plan> {
    ["off", "on"].map(|clips| effect.plan(&format!("scene:part?clips={clips}"), 5000, 192)).into()
}

pub fn overlap(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:bumpy-sphere", 137_062, 256);
    plan.settings.shading = Shading::Overlap;
    // There is no exact value to compare with.
    plan.measurements.error = false;
    ["confetti", "object-ewa"].map(|name| plan.by(&method(name))).into()
}

pub fn no_normalization(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:torus?sampler=scanner&albedo=plain", 20_000, 192);
    plan.settings.shading = Shading::Colour;
    let object = plan.by(&method("object-ewa"));
    let normalized = |normalization| Splatting { normalization, ..object.settings.splatting };
    each(&object, [Normalization::None, Normalization::Surfel, Normalization::Pixel].map(normalized))
}

pub fn whole_sizes(effect: &Effect) -> Vec<Plan> {
    let sprites = effect.plan("scene:bumpy-sphere", 100_000, 192).by(&method("sprites"));
    let fractional = sprites.settings.splatting;
    each(&sprites, [Splatting { footprint: Footprint::WholeSprite, ..fractional }, fractional])
}

/// A scene as lines and polygons by both rules of pull–push, and as surfels.
pub fn drawn(effect: &Effect, scene: &str, points: u64) -> Vec<Plan> {
    let separator = if scene.contains('?') { '&' } else { '?' };
    let mut lines = effect.plan(&format!("{scene}{separator}primitives=on"), points, 512);
    lines.settings.shading = Shading::Lit;
    let surfels = Plan { scene: scene.into(), ..lines.clone() };
    let by_rules = ["pull-push-paper", "pull-push"].map(|name| lines.by(&method(name)));
    by_rules.into_iter().chain([surfels.by(&method("perspective-ewa"))]).collect()
}

pub fn layers(effect: &Effect) -> Vec<Plan> {
    let plan = effect.plan("scene:slabs?slabs=2&gap=0.1&clips=off", 100_000, 512);
    ["pull-push-paper", "pull-push", "perspective-ewa"].map(|name| plan.by(&method(name))).into()
}
