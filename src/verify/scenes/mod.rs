//! Built-in scenes with exact surfaces, named like `scene:torus?points=100000&sampler=blue-noise&seed=1`.
//!
//! A scene is a [`Surface`]: pieces of [shapes](Shape) with one definition each. [`surface`] returns it for ray
//! tracing, [`open`] samples it.

pub mod bumpy_sphere;
mod catalogue;
mod edges;
mod models;
mod primitives;
mod query;
pub(crate) mod random;
mod samplers;
mod shapes;
mod surface;
#[cfg(test)]
mod tests;
mod texture;

pub use catalogue::{SAMPLING, SceneInfo, Viewpoint, list};
pub use primitives::CentrelinePoint;
pub use query::{Parameter, Values};
pub use shapes::{Ray, Sample, Shape, SurfacePoint};
pub use surface::{Hit, Kind, Piece, Surface};
pub use texture::{Pattern, Rgb, Texture};

use crate::error::{Error, Result};
use crate::geometry::{Colours, Model, Surfels};
use glam::{DVec2, Vec3};
use query::{PREFIX, Query};
use surface::Assembly;

/// Whether `text` names a built-in scene rather than a file.
pub fn is_scene(text: &str) -> bool {
    text.starts_with(PREFIX)
}

/// The surface of a scene: `scene:<name>`, optionally followed by `?` and `parameter=value` pairs separated by `&`;
/// sampling parameters are allowed, too.
///
/// # Errors
/// [`Error::Usage`] if the scene, a parameter or a value does not exist; the message lists those that do.
pub fn surface(text: &str) -> Result<Box<dyn Surface>> {
    Ok(Box::new(assemble(&Query::parse(text)?)))
}

/// The recommended viewpoint of a scene.
///
/// # Errors
/// Like [`surface`].
pub fn camera(text: &str) -> Result<Viewpoint> {
    Ok(Query::parse(text)?.scene.viewpoint)
}

/// Whether a scene has a texture; without one, only shading shows its shape.
///
/// # Errors
/// Like [`surface`].
pub fn is_textured(text: &str) -> Result<bool> {
    Ok(Query::parse(text)?.pattern() != Pattern::Plain)
}

/// Samples a scene: surfels in Morton order, and its lines and triangles, if the text asks for them.
///
/// # Errors
/// Like [`surface`].
pub fn model(text: &str) -> Result<Model> {
    let query = Query::parse(text)?;
    if !has_primitives(&query) {
        return open(text).map(Model::from);
    }
    let (points, others): (Vec<_>, Vec<_>) =
        (query.scene.build)(&query).into_iter().partition(|piece| piece.kind == Kind::Surface);
    let mut surfels = if points.is_empty() {
        Surfels::default()
    } else {
        samplers::sample(&query, &Assembly::new(points))?
    };
    surfels.sort_morton();
    Ok(Model { surfels, primitives: primitives::primitives(&query, &others) })
}

/// Samples the surfels of a scene, in Morton order.
///
/// # Errors
/// Like [`surface`]; also if the text asks for lines and triangles.
pub fn open(text: &str) -> Result<Surfels> {
    let query = Query::parse(text)?;
    if has_primitives(&query) {
        let text = format!("{text}: lines and triangles are no surfels: leave `primitives` off");
        return Err(Error::Usage(text));
    }
    let mut surfels = if is_comparison(&query) {
        bumpy_sphere::sample(query.whole("points") as u32, query.whole("seed"))
    } else if query.scene.name == "scene:disc" && query.whole("points") == 1 {
        whole_disc(&query)
    } else {
        samplers::sample(&query, &assemble(&query))?
    };
    surfels.sort_morton();
    Ok(surfels)
}

/// Whether the text asks for lines and triangles.
fn has_primitives(query: &Query) -> bool {
    ["on", "triangles"].contains(&query.word(catalogue::PRIMITIVES_NAME))
}

/// The disc as its only surfel.
fn whole_disc(query: &Query) -> Surfels {
    let pieces = (query.scene.build)(query);
    let albedo =
        |piece: &Piece| piece.texture.at(&piece.shape.at(DVec2::ZERO).point).map(|channel| channel as f32);
    Surfels {
        positions: vec![Vec3::ZERO],
        normals: vec![Vec3::Y],
        radii: vec![1.0],
        colours: Some(Colours::Linear(pieces.iter().map(albedo).collect())),
        ..Default::default()
    }
}

fn assemble(query: &Query) -> Assembly {
    Assembly::new((query.scene.build)(query))
}

/// Whether the samples are those of the comparison scene, which have a lattice of their own.
fn is_comparison(query: &Query) -> bool {
    let usual = ["sampler", "albedo", "frequency", "noise"].iter().all(|name| !query.is_given(name));
    query.scene.name == "scene:bumpy-sphere" && usual
}
