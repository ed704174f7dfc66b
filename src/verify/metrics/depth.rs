//! Difference of the eye-space depths over the object's size, `|z_a − z_b| / size`, for pixels that both pictures
//! cover.
//!
//! Range: 0 and up; less is better; no unit. Division by the size, in the positions' unit, such as the diagonal of the
//! bounding box, makes it independent of the object's scale and distance.

use super::Pair;
use super::statistics::Sorted;
use crate::error::{Error, Result};

/// Differences over the pixels that both cover, relative to the object's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthError {
    /// Root mean square.
    pub rms: f64,
    /// 99th percentile, by the nearest-rank definition.
    pub p99: f64,
    /// Maximum.
    pub max: f64,
}

/// Compares the depths; `None` if a picture has none, or if no pixel is covered in both.
///
/// # Errors
/// [`Error::Usage`] if the size is not a finite number above 0.
pub fn depth(pair: &Pair<'_>, object_size: f64) -> Result<Option<DepthError>> {
    if !(object_size > 0.0 && object_size.is_finite()) {
        return Err(Error::Usage(format!("the object's size is {object_size}: give a number above 0")));
    }
    let (Some(ours), Some(truth)) = (&pair.picture().depth, &pair.truth().depth) else { return Ok(None) };
    let difference = |i: usize| (f64::from(ours[i]) - f64::from(truth[i])).abs() / object_size;
    let summary =
        |errors: Sorted| DepthError { rms: errors.rms(), p99: errors.percentile(0.99), max: errors.max() };
    Ok(Sorted::new(pair.covered_in_both().map(difference)).map(summary))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    fn picture(depths: Vec<f32>) -> Picture {
        let colour = vec![[1.0; 4]; depths.len()];
        Picture { size: [depths.len() as u32, 1], colour, depth: Some(depths), ..Default::default() }
    }

    fn of(picture: &Picture, truth: &Picture, size: f64) -> DepthError {
        depth(&Pair::new(picture, truth).unwrap(), size).unwrap().unwrap()
    }

    #[test]
    fn a_scaled_depth_is_off_by_the_scale() {
        let truth = picture((1..=200).map(|z| z as f32).collect());
        assert_eq!(of(&truth, &truth, 7.0), DepthError { rms: 0.0, p99: 0.0, max: 0.0 });
        // Depth z is off by z/8, so relative to 10 by z/80; Σ z² of 1 to n is n (n+1) (2n+1) / 6.
        let scaled = picture((1..=200).map(|z| z as f32 * 1.125).collect());
        let found = of(&scaled, &truth, 10.0);
        let mean_square: f64 = 201.0 * 401.0 / 6.0;
        assert!((found.rms - mean_square.sqrt() / 80.0).abs() < 1e-12, "{found:?}");
        assert_eq!((found.p99, found.max), (198.0 / 80.0, 2.5));
        assert_eq!(of(&scaled, &truth, 20.0).max, 1.25);
        assert_eq!(of(&truth, &scaled, 20.0).max, 1.25);
    }

    #[test]
    fn only_pixels_that_both_cover_count() {
        let (ours, truth) = (picture(vec![0.0, 2.0, 3.0]), picture(vec![1.0, 0.0, 3.5]));
        assert_eq!(of(&ours, &truth, 1.0).rms, 0.5);
        let none = picture(vec![0.0; 3]);
        let pair = Pair::new(&none, &truth).unwrap();
        assert_eq!(depth(&pair, 1.0).unwrap(), None);
        for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(depth(&pair, size).unwrap_err().to_string().contains("above 0"));
        }
        let bare = Picture { depth: None, ..none };
        assert_eq!(depth(&Pair::new(&bare, &truth).unwrap(), 1.0).unwrap(), None);
    }
}
