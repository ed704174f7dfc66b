//! What has a texture: a checkerboard by longitude and latitude about the y axis.

use glam::{DVec2, Vec2, Vec3};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;
use surfel::Picture;
use surfel::geometry::{MipMap, Model, Texture};

/// Squares along the equator, and from pole to pole.
pub const SQUARES: [u32; 2] = [32, 16];

/// Texels along the side of a square.
const SIDE: u32 = 16;

/// Linear colours of the two kinds of squares.
pub const COLOURS: [[f32; 3]; 2] = [[0.8, 0.1, 0.05], [0.75, 0.75, 0.7]];

/// Where a direction is in the texture.
pub fn coordinates(p: Vec3) -> Vec2 {
    let n = p.normalize_or(Vec3::Y);
    Vec2::new(n.x.atan2(n.z) / TAU, 0.5 + n.y.asin() / PI)
}

/// The colour of the texture, as if it had any number of texels.
pub fn exact(at: DVec2) -> [f32; 3] {
    let [x, y] = [at.x * f64::from(SQUARES[0]), at.y * f64::from(SQUARES[1])].map(|at| at.floor() as i64);
    COLOURS[(x + y).rem_euclid(2) as usize]
}

pub fn picture() -> Picture {
    let [width, height] = SQUARES.map(|count| count * SIDE);
    let pixel = |i: u32| {
        let at = DVec2::new(f64::from(i % width) + 0.5, f64::from(height - 1 - i / width) + 0.5);
        let [r, g, b] = exact(at / DVec2::new(width.into(), height.into()));
        [r, g, b, 1.0]
    };
    Picture { size: [width, height], colour: (0..width * height).map(pixel).collect(), ..Default::default() }
}

/// The same with the texture, and without colours.
pub fn textured(model: impl Into<Model>) -> Model {
    let mut model = model.into();
    let image = Arc::new(MipMap::new(&picture()).unwrap());
    let texture = |positions: &[Vec3]| {
        let coordinates = positions.iter().map(|&p| coordinates(p)).collect();
        Some(Texture { image: image.clone(), coordinates })
    };
    (model.surfels.colours, model.primitives.colours) = (None, None);
    model.surfels.texture = texture(&model.surfels.positions);
    model.primitives.texture = texture(&model.primitives.positions);
    model
}
