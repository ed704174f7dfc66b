//! Every scene, traced and sampled, against independent results.

mod edges;
mod names;
mod samplers;
mod shapes;
mod trace;

use super::random::Random;
use super::{Piece, Sample, Surface};
use glam::{DVec2, DVec3};

/// Every scene, small enough for many tests.
fn scenes() -> impl Iterator<Item = (&'static str, Box<dyn Surface>)> {
    super::list().iter().map(|scene| {
        let depth = if scene.name == "scene:tree" { "?depth=1" } else { "" };
        (scene.name, super::surface(&format!("{}{depth}", scene.name)).unwrap())
    })
}

/// Points of all pieces, by random parameters.
fn points<'a>(
    surface: &'a dyn Surface,
    random: &mut Random,
    count: usize,
) -> Vec<(&'a Piece, DVec2, Sample)> {
    let pieces = surface.pieces();
    (0..count)
        .map(|i| {
            let piece = &pieces[i % pieces.len()];
            // Away from the border, where a finite difference would leave the square, and from poles.
            let uv = 0.01 + 0.98 * DVec2::new(random.unit(), random.unit());
            (piece, uv, piece.shape.at(uv))
        })
        .collect()
}

/// A random vector in the cube from −1 to 1.
fn vector(random: &mut Random) -> DVec3 {
    2.0 * DVec3::new(random.unit(), random.unit(), random.unit()) - 1.0
}
