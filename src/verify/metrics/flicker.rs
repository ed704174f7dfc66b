//! Temporal flicker: error that varies from frame to frame as the camera moves slowly.
//!
//! For each pixel and channel let `e_t = picture_t − truth_t` in linear light. Flicker is `√(mean (e_{t−1} − 2 e_t +
//! e_{t+1})² / 6)`, the mean over all pixels, channels and inner frames: the root of the residual variance estimated by
//! second differences (Gasser, Sroka, Jennen-Steinmetz: *Residual Variance and Residual Pattern in Nonlinear
//! Regression*, Biometrika 73(3), 1986). Motion of the truth is no error. An error that is constant or changes at a
//! constant rate, as a blur that moves past a pixel does, is no flicker. What remains is noise in time: the factor 1/6
//! makes it the standard deviation of noise that is independent from frame to frame. An error that alternates between
//! +a and −a, the fastest possible, gives `4a/√6`.
//!
//! Range: 0 and up, unit of linear colours (1 is white), less is better.

use super::path::PathValues;
use super::rmse::rmse;
use super::{Pair, colour};
use crate::error::{Error, Result};

/// Frames of a second difference.
const FEWEST: usize = 3;

/// Accumulates the flicker of a path, frame by frame; stores two frames.
///
/// ```
/// use surfel::Picture;
/// use surfel::verify::metrics::{Pair, flicker::Flicker};
///
/// # fn main() -> surfel::Result<()> {
/// let grey = |value: f32| Picture { size: [1, 1], colour: vec![[value, value, value, 1.0]], ..Default::default() };
/// // The truth brightens along the path; the pictures follow, but every other one is too bright by 0.1.
/// let mut flicker = Flicker::new([0.0; 3]);
/// for frame in 0..6u8 {
///     let truth = 0.1 * f32::from(frame);
///     let wrong = if frame % 2 == 0 { 0.0 } else { 0.1 };
///     flicker.add(&Pair::new(&grey(truth + wrong), &grey(truth))?)?;
/// }
/// assert!((flicker.value()? - 0.2 / 6f64.sqrt()).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Flicker {
    background: [f32; 3],
    size: [u32; 2],
    /// Errors of the frame before the last one.
    before: Vec<[f64; 3]>,
    /// Linear colours of the last frame: of the picture and of the truth.
    last: [Vec<[f64; 3]>; 2],
    values: PathValues,
}

impl Flicker {
    /// No frames yet; they will be composited over a linear `background`.
    pub fn new(background: [f32; 3]) -> Self {
        Self { background, ..Default::default() }
    }

    /// Adds the next frame of the path.
    ///
    /// # Errors
    /// [`Error::Usage`] if its size differs from the first frame's.
    pub fn add(&mut self, pair: &Pair<'_>) -> Result<()> {
        let frames = self.values.rmse.len();
        if frames > 0 && pair.size() != self.size {
            let ([a, b], [c, d]) = (pair.size(), self.size);
            return Err(Error::Usage(format!(
                "frame {frames} of the path is {a}x{b} px and the first {c}x{d}: render all in one size"
            )));
        }
        let present = [pair.picture(), pair.truth()].map(|picture| colour::over(picture, self.background));
        let last = std::mem::replace(&mut self.last, present);
        let [picture, truth] = &self.last;
        self.values.rmse.push(rmse(picture, truth));
        if frames > 0 {
            self.values.picture_change.push(rmse(picture, &last[0]));
            self.values.truth_change.push(rmse(truth, &last[1]));
        }
        let before = std::mem::replace(&mut self.before, difference(&last));
        if frames + 1 >= FEWEST {
            self.values.flicker.push(flicker(&before, &self.before, &difference(&self.last)));
        }
        self.size = pair.size();
        Ok(())
    }

    /// Flicker of the frames so far.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are fewer than three.
    pub fn value(&self) -> Result<f64> {
        let frames = self.values.rmse.len();
        if frames < FEWEST {
            let text = format!("flicker of {frames} frames: give {FEWEST} or more");
            return Err(Error::Usage(text));
        }
        let around = &self.values.flicker;
        let squares = around.iter().map(|flicker| flicker * flicker).sum::<f64>();
        Ok((squares / around.len() as f64).sqrt())
    }

    /// The values of each frame so far.
    pub fn path(&self) -> &PathValues {
        &self.values
    }
}

/// Errors of a frame: the picture's colours without the truth's.
fn difference([picture, truth]: &[Vec<[f64; 3]>; 2]) -> Vec<[f64; 3]> {
    picture.iter().zip(truth).map(|(a, b)| [0, 1, 2].map(|axis| a[axis] - b[axis])).collect()
}

/// Flicker around the second of three frames, by their errors.
fn flicker(first: &[[f64; 3]], second: &[[f64; 3]], third: &[[f64; 3]]) -> f64 {
    let frames = first.as_flattened().iter().zip(second.as_flattened()).zip(third.as_flattened());
    let sum = frames.map(|((a, b), c)| (a - 2.0 * b + c).powi(2)).sum::<f64>();
    (sum / (6 * third.as_flattened().len().max(1)) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    fn grey(value: f32) -> Picture {
        Picture { size: [3, 2], colour: vec![[value, value, value, 1.0]; 6], ..Default::default() }
    }

    /// Flicker of frames given as grey values of picture and truth.
    fn of(frames: &[(f32, f32)]) -> f64 {
        let mut flicker = Flicker::new(colour::BLACK);
        for &(ours, truth) in frames {
            let (ours, truth) = (grey(ours), grey(truth));
            flicker.add(&Pair::new(&ours, &truth).unwrap()).unwrap();
        }
        flicker.value().unwrap()
    }

    #[test]
    fn what_is_steady_does_not_flicker() {
        assert_eq!(of(&[(0.75, 0.25); 4]), 0.0);
        // An error that grows at a constant rate.
        assert_eq!(of(&[(0.25, 0.25), (0.375, 0.25), (0.5, 0.25), (0.625, 0.25)]), 0.0);
        // Flicker of the truth itself does not count.
        assert_eq!(of(&[(0.5, 0.25), (1.0, 0.75), (0.5, 0.25), (1.0, 0.75)]), 0.0);
    }

    #[test]
    fn an_alternating_error_has_a_closed_form() {
        for amplitude in [0.0625f32, 0.25] {
            let (high, low) = ((0.5 + amplitude, 0.5), (0.5 - amplitude, 0.5));
            let expected = 4.0 * f64::from(amplitude) / 6f64.sqrt();
            let found = of(&[high, low, high, low, high]);
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        // One frame of three is off by a: its second difference is 2a.
        assert!((of(&[(0.5, 0.5), (0.75, 0.5), (0.5, 0.5)]) - 0.5 / 6f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn every_frame_has_its_values() {
        let mut flicker = Flicker::new(colour::BLACK);
        for (ours, truth) in [(0.5, 0.5), (0.625, 0.625), (1.0, 0.75), (0.875, 0.875)] {
            let (ours, truth) = (grey(ours), grey(truth));
            flicker.add(&Pair::new(&ours, &truth).unwrap()).unwrap();
        }
        let PathValues { rmse, picture_change, truth_change, flicker } = flicker.path();
        assert_eq!((&rmse[..], &truth_change[..]), (&[0.0, 0.0, 0.25, 0.0][..], &[0.125; 3][..]));
        assert_eq!(picture_change[..], [0.125, 0.375, 0.125]);
        let expected = [0.25, 0.5].map(|second: f64| second / 6f64.sqrt());
        assert!(
            flicker.len() == 2 && (0..2).all(|i| (flicker[i] - expected[i]).abs() < 1e-12),
            "{flicker:?}"
        );
    }

    #[test]
    fn one_flickering_channel_of_many_counts_as_one() {
        let mut flicker = Flicker::new(colour::BLACK);
        let truth = grey(0.5);
        for value in [0.5, 0.75, 0.5] {
            let mut ours = grey(0.5);
            ours.colour[4][1] = value;
            flicker.add(&Pair::new(&ours, &truth).unwrap()).unwrap();
        }
        assert!((flicker.value().unwrap() - (0.25f64 / (6.0 * 18.0)).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn too_few_or_unlike_frames_are_refused() {
        let (a, b) = (grey(0.5), Picture { size: [2, 3], ..grey(0.5) });
        let mut flicker = Flicker::new(colour::BLACK);
        flicker.add(&Pair::new(&a, &a).unwrap()).unwrap();
        assert!(
            flicker
                .add(&Pair::new(&b, &b).unwrap())
                .unwrap_err()
                .to_string()
                .starts_with("frame 1 of the path is 2x3")
        );
        flicker.add(&Pair::new(&a, &a).unwrap()).unwrap();
        assert!(flicker.value().unwrap_err().to_string().starts_with("flicker of 2 frames"));
    }
}
