//! Summary of a model, as text.

use glam::DVec3;
use std::path::Path;
use surfel::geometry::Model;
use surfel::load::LoadedModel;
use surfel::settings::Shading;
use surfel::thousands;

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
        let (part, what) = match loaded.scattered >= loaded.billboards() {
            true => (loaded.scattered, "normals are unlike their neighbours'"),
            false => (loaded.billboards(), "points are on no surface"),
        };
        let part = 100.0 * part;
        format!(
            "{name}: {part:.0} % of the {what}, so shaded by eye-dome lighting: --shading lit lights them"
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
