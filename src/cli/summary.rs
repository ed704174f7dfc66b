//! Summary of a model, as text.

use glam::DVec3;
use std::path::Path;
use surfel::geometry::{Camera, Model, Surfels};
use surfel::load::LoadedModel;
use surfel::settings::{Cull, Shading};
use surfel::{Settings, thousands};

/// Parts of a model: `5 surfels, 2 ribbons`.
pub fn parts(Model { surfels, primitives }: &Model) -> String {
    let others = [
        (&primitives.ribbons.len(), "ribbons"),
        (&primitives.tubes.len(), "tubes"),
        (&primitives.triangles.len(), "triangles"),
    ];
    let others: Vec<_> = others
        .iter()
        .filter(|(count, _)| **count > 0)
        .map(|(count, what)| format!("{} {what}", thousands(**count as u64)))
        .collect();
    match (surfels.len(), others.is_empty()) {
        (0, false) => others.join(", "),
        (count, _) => [vec![format!("{} surfels", thousands(count as u64))], others].concat().join(", "),
    }
}

/// What the user or a camera file sets, so that it is not assumed.
#[derive(Clone, Copy)]
pub struct Given {
    /// The up direction.
    pub up: bool,
    /// The shading.
    pub shading: bool,
    /// Ambient occlusion.
    pub ao: bool,
}

/// What was assumed of inputs that do not tell, a line each: the up direction, colours, and shading.
pub fn assumptions(input: &Path, given: Given, loaded: &LoadedModel) -> Vec<String> {
    let name = input.display();
    let axis = [(DVec3::Z, "z"), (DVec3::NEG_Y, "-y")].into_iter().find(|(up, _)| *up == loaded.up);
    let up =
        axis.filter(|_| !given.up).map(|(_, axis)| format!("{name}: {axis} is up: --up 0,1,0 makes it y"));
    let colours = loaded.suggestion.as_ref().map(|suggestion| {
        format!(
            "{name}: no colours, so coloured by {}: --color-by file leaves the points plain",
            suggestion.name
        )
    });
    let suggested = loaded.shading();
    let shading = (!given.shading && suggested.shading == Shading::Edl).then(|| {
        format!(
            "{name}: {:.0} % of the normals are unlike their neighbours', so shaded by eye-dome lighting: --shading lit lights them",
            100.0 * loaded.scattered()
        )
    });
    let ao = (!given.ao && suggested.ao > 0.0).then(|| {
        format!(
            "{name}: {:.0} % of the points are on no surface, so darkened by ambient occlusion: --ao=0 leaves it out",
            100.0 * loaded.billboards()
        )
    });
    up.into_iter().chain(colours).chain(shading).chain(ao).collect()
}

/// Part of the surfels above which their culling is reported.
const MANY: f64 = 0.9;

/// A line for the user, if nearly all surfels face away from the camera and are therefore not drawn.
pub fn culled_backs(surfels: &Surfels, camera: &Camera, settings: &Settings) -> Option<String> {
    let projection = camera.projection().ok().filter(|_| settings.cull == Cull::Back)?;
    let (eye, forward) =
        (camera.view.inverse().w_axis.truncate(), projection.forward * camera.view.row(2).truncate());
    let is_two_sided = |i: usize| surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
    let is_back = |&i: &usize| {
        let ray = if projection.perspective {
            surfels.positions[i].as_dvec3() + surfels.origin - eye
        } else {
            forward
        };
        ray.dot(surfels.normals[i].as_dvec3()) >= 0.0 && !is_two_sided(i) && !surfels.is_billboard(i)
    };
    let part = (0..surfels.len()).filter(is_back).count() as f64 / surfels.len().max(1) as f64;
    (part > MANY).then(|| {
        format!(
            "{:.0} % of the surfels face away from the camera and are not drawn: give --cull none, or an --eye on their other side",
            100.0 * part
        )
    })
}
