//! Normalization weights: factors of the surfels' kernels that make their sum 1 without a division at every pixel (Ren, Pfister, Zwicker
//! 2002, section 7).

use crate::error::{Error, Result};
use glam::{DVec3, Vec3};

/// Factors of the surfels' kernels. They depend on the radii and on the neighbours: other radii, or fewer neighbours, need other weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights {
    /// One entry per surfel: its factor; for a surfel at a border the factor at its centre. Above 0; 0 if unknown, and then the surfel is
    /// not [valid](crate::geometry::Surfels::is_valid).
    pub of: Vec<f32>,
    /// Corner weights of surfels at borders, in index order.
    pub corners: Vec<Corners>,
}

/// Factors of a surfel at a border of the surface: bilinear over the square around its disc, constant beyond.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corners {
    /// Index of the surfel.
    pub surfel: u32,
    /// Factors at the square's corners −u −v, +u −v, −u +v, +u +v; u is [`first_axis`], or the longer axis of an ellipse, and v is normal ×
    /// u.
    pub weights: [f32; 4],
}

/// First axis of the square around a circular disc: orthogonal to the unit vector `normal` (Duff et al., *Building an Orthonormal Basis,
/// Revisited*, 2017).
pub fn first_axis(normal: DVec3) -> DVec3 {
    // A comparison, because −0 has the sign of 0.
    let s = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (s + normal.z);
    DVec3::new(1.0 + s * normal.x * normal.x * a, s * normal.x * normal.y * a, -s * normal.x)
}

/// First axis of the square around a disc, a unit vector orthogonal to its normal; `major` is that of an ellipse.
pub(crate) fn square_axis(normal: Vec3, major: Option<Vec3>) -> DVec3 {
    let normal = normal.as_dvec3().normalize_or_zero();
    match major {
        Some(major) => major.as_dvec3().reject_from_normalized(normal).normalize_or_zero(),
        None => first_axis(normal),
    }
}

impl Weights {
    /// Weights of consecutive surfels: the factor and, at a border, the corner factors.
    pub fn collect(each: impl IntoIterator<Item = (f32, Option<[f32; 4]>)>) -> Self {
        let mut all = Self::default();
        for (weight, corners) in each {
            let surfel = all.of.len() as u32;
            all.of.push(weight);
            all.corners.extend(corners.map(|weights| Corners { surfel, weights }));
        }
        all
    }

    /// Corner factors of a surfel, if it is at a border.
    pub fn corners_of(&self, surfel: usize) -> Option<[f32; 4]> {
        let place = self.corners.binary_search_by_key(&surfel, |corners| corners.surfel as usize).ok()?;
        Some(self.corners[place].weights)
    }

    /// Whether the surfel's factors are above 0 and at most `largest`.
    pub(super) fn is_valid(&self, surfel: usize, largest: f32) -> bool {
        let fits = |weight: f32| weight > 0.0 && weight <= largest;
        self.of.get(surfel).is_some_and(|&weight| fits(weight))
            && self.corners_of(surfel).is_none_or(|corners| corners.into_iter().all(fits))
    }

    /// Validates the indices of corner weights and their order.
    pub(super) fn check(&self) -> Result<()> {
        let count = self.of.len();
        let ascending = self.corners.windows(2).all(|pair| pair[0].surfel < pair[1].surfel);
        match self.corners.last() {
            Some(last) if !ascending || last.surfel as usize >= count => Err(Error::Usage(format!(
                "normalization weights at the corners of surfels up to {} of {count}: give those of each surfel once, in order",
                last.surfel
            ))),
            _ => Ok(()),
        }
    }

    /// Entry `i` of the result is entry `order[i]` of `self`.
    pub(super) fn permute(&mut self, order: &[u32]) {
        let each = order.iter().map(|&i| (self.of[i as usize], self.corners_of(i as usize)));
        *self = Self::collect(each);
    }

    /// Joins the weights of several sets of surfels; `None` unless every set has weights.
    pub(super) fn join(parts: impl IntoIterator<Item = Option<Self>>) -> Option<Self> {
        let mut all = Self::default();
        for part in parts {
            let (part, first) = (part?, all.of.len() as u32);
            all.of.extend(part.of);
            all.corners.extend(part.corners.iter().map(|c| Corners { surfel: first + c.surfel, ..*c }));
        }
        Some(all)
    }

    /// Replaces unknown factors, 0, by the median of the others; `None` if there are no others.
    pub(crate) fn filled(mut self) -> Option<Self> {
        let mut known: Vec<f32> = self.of.iter().copied().filter(|&weight| weight > 0.0).collect();
        let middle = known.len() / 2;
        let (_, &mut median, _) =
            (!known.is_empty()).then(|| known.select_nth_unstable_by(middle, f32::total_cmp))?;
        self.of.iter_mut().filter(|weight| **weight == 0.0).for_each(|weight| *weight = median);
        Some(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights() -> Weights {
        Weights::collect([
            (0.5, None),
            (0.25, Some([0.1, 0.2, 0.3, 0.4])),
            (2.0, None),
            (1.0, Some([1.0; 4])),
        ])
    }

    #[test]
    fn the_axis_is_a_unit_vector_in_the_plane_and_does_not_hang_on_the_sign_of_zero() {
        for normal in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Z, DVec3::new(0.6, -0.8, -0.0), DVec3::ONE] {
            let normal = normal.normalize();
            let axis = first_axis(normal);
            assert!((axis.length() - 1.0).abs() < 1e-12 && axis.dot(normal).abs() < 1e-12, "{normal}");
        }
        let [a, b] = [0.0, -0.0].map(|z| first_axis(DVec3::new(0.6, 0.8, z)));
        assert_eq!(a, b);
    }

    #[test]
    fn weights_follow_their_surfels() {
        let mut moved = weights();
        moved.permute(&[3, 0, 1]);
        assert_eq!(moved.of, [1.0, 0.5, 0.25]);
        assert_eq!(
            [0, 1, 2].map(|i| moved.corners_of(i)),
            [Some([1.0; 4]), None, Some([0.1, 0.2, 0.3, 0.4])]
        );
        let joined = Weights::join([Some(weights()), Some(moved.clone())]).unwrap();
        assert_eq!((joined.of.len(), joined.corners_of(4), joined.corners_of(5)), (7, Some([1.0; 4]), None));
        assert_eq!(Weights::join([Some(moved), None]), None);
    }

    #[test]
    fn corners_of_no_surfel_and_out_of_order_are_refused() {
        assert!(weights().check().is_ok());
        for surfels in [[1, 4], [1, 1], [3, 1]] {
            let mut wrong = weights();
            wrong.corners.iter_mut().zip(surfels).for_each(|(corners, surfel)| corners.surfel = surfel);
            let refused = wrong.check().unwrap_err().to_string();
            assert!(refused.contains("of 4: give those of each surfel once"), "{refused}");
        }
    }

    #[test]
    fn unknown_weights_become_the_median() {
        let filled = Weights { of: vec![0.0, 3.0, 1.0, 2.0, 0.0], corners: vec![] }.filled().unwrap();
        assert_eq!(filled.of, [2.0, 3.0, 1.0, 2.0, 2.0]);
        assert_eq!(Weights { of: vec![0.0; 3], corners: vec![] }.filled(), None);
    }
}
