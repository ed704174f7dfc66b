//! Scalar quantities of surfels, for display as colours.

use super::{ColourScale, Colours, Primitives, Surfels};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A scalar quantity of a surfel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// The coordinate along a unit vector, origin included.
    Along(DVec3),
    /// The radius.
    Radius,
}

impl Surfels {
    /// The quantity of every surfel.
    pub fn values(&self, quantity: Quantity) -> Vec<f64> {
        values(self.origin, &self.positions, &self.radii, quantity)
    }

    /// Colours every surfel by its entry in `values`.
    pub fn colour_by_values(&mut self, values: &[f64], scale: &ColourScale) {
        self.texture = None;
        self.colours = Some(scale.colours(values.par_iter().copied()));
    }

    /// Colours every surfel by its normal: x, y and z from −1 to 1 become red, green and blue.
    pub fn colour_by_normals(&mut self) {
        self.texture = None;
        self.colours = Some(colours_of(&self.normals));
    }
}

impl Primitives {
    /// The quantity of every vertex.
    pub fn values(&self, quantity: Quantity) -> Vec<f64> {
        values(self.origin, &self.positions, &self.radii, quantity)
    }

    /// Colours every vertex by its entry in `values`.
    pub fn colour_by_values(&mut self, values: &[f64], scale: &ColourScale) {
        self.texture = None;
        self.colours = Some(scale.colours(values.par_iter().copied()));
    }

    /// Colours every vertex by its direction, a normal or the tangent of a tube, as [`Surfels::colour_by_normals`].
    pub fn colour_by_directions(&mut self) {
        self.texture = None;
        self.colours = Some(colours_of(&self.directions));
    }
}

fn values(origin: DVec3, positions: &[Vec3], radii: &[f32], quantity: Quantity) -> Vec<f64> {
    match quantity {
        Quantity::Along(axis) => {
            let start = origin.dot(axis);
            positions.par_iter().map(|p| p.as_dvec3().dot(axis) + start).collect()
        }
        Quantity::Radius => radii.par_iter().map(|&radius| f64::from(radius)).collect(),
    }
}

fn colours_of(directions: &[Vec3]) -> Colours {
    let code = |coordinate: f32| ((0.5 * coordinate + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8;
    let colour = |n: &Vec3| [code(n.x), code(n.y), code(n.z), 0];
    Colours::Srgb8(directions.par_iter().map(colour).collect())
}

#[cfg(test)]
mod tests {
    use super::super::{ColourMap, ValueRange};
    use super::*;

    #[test]
    fn quantities_are_those_of_the_world() {
        let mut surfels = Surfels {
            origin: DVec3::new(0.0, 1e7, 0.0),
            positions: vec![Vec3::new(1.0, 0.25, 0.0), Vec3::ZERO],
            normals: vec![Vec3::Y, Vec3::NEG_Z],
            radii: vec![2.0, 3.0],
            ..Default::default()
        };
        assert_eq!(surfels.values(Quantity::Along(DVec3::Y)), [1e7 + 0.25, 1e7]);
        assert_eq!(surfels.values(Quantity::Along(DVec3::NEG_X)), [-1.0, 0.0]);
        assert_eq!(surfels.values(Quantity::Radius), [2.0, 3.0]);
        surfels.colour_by_normals();
        assert_eq!(surfels.colours, Some(Colours::Srgb8(vec![[128, 255, 128, 0], [128, 128, 0, 0]])));
        let range = ValueRange { min: 0.0, max: 1.0 };
        let scale = ColourScale { map: ColourMap::Magma, range };
        surfels.colour_by_values(&[0.0, f64::NAN], &scale);
        assert_eq!(surfels.colours, Some(Colours::Srgb8(vec![[0, 0, 4, 0], [128, 128, 128, 0]])));
    }
}
