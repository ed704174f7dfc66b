//! Runs of lines and triangles by pull–push.

use super::Effect;
use crate::bench::papers::method;
use crate::bench::plan::Plan;
use crate::settings::Shading;

/// A lit scene drawn as `primitives` tells: `off`, `on` or `triangles`.
pub fn drawn(effect: &Effect, scene: &str, primitives: &str, points: u64, side: u32, preset: &str) -> Plan {
    let separator = if scene.contains('?') { '&' } else { '?' };
    let scene = match primitives {
        "off" => scene.into(),
        _ => format!("{scene}{separator}primitives={primitives}"),
    };
    let mut plan = effect.plan(&scene, points, [side; 2], preset);
    plan.settings.shading = Shading::Lit;
    plan
}

/// A scene of lines and polygons by both rules of pull–push, and of surfels.
pub fn by_both_rules(effect: &Effect, scene: &str, points: u64) -> Vec<Plan> {
    let lines = drawn(effect, scene, "on", points, 512, "pull-push-paper");
    let surfels = drawn(effect, scene, "off", points, 512, "perspective-ewa");
    vec![lines.clone(), lines.by(&method("pull-push")), surfels]
}
