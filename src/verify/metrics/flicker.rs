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

use super::{Pair, colour};
use crate::error::{Error, Result};

/// Frames of a second difference.
const FEWEST: usize = 3;

/// Accumulates the flicker of a path, frame by frame; stores the errors of two frames.
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
    /// Errors of the last two frames, the older one first.
    last: [Vec<[f64; 3]>; 2],
    frames: usize,
    /// Mean squared second difference around each inner frame.
    squares: Vec<f64>,
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
        if self.frames > 0 && pair.size() != self.size {
            let ([a, b], [c, d]) = (pair.size(), self.size);
            return Err(Error::Usage(format!(
                "frame {} of the path is {a}x{b} px and the first {c}x{d}: render all in one size",
                self.frames
            )));
        }
        let error = self.error(pair);
        let [before, last] = std::mem::take(&mut self.last);
        if self.frames + 1 >= FEWEST {
            let frames = before.as_flattened().iter().zip(last.as_flattened()).zip(error.as_flattened());
            let sum = frames.map(|((a, b), c)| (a - 2.0 * b + c).powi(2)).sum::<f64>();
            self.squares.push(sum / error.as_flattened().len().max(1) as f64);
        }
        self.last = [last, error];
        self.size = pair.size();
        self.frames += 1;
        Ok(())
    }

    /// Flicker of the frames so far.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are fewer than three.
    pub fn value(&self) -> Result<f64> {
        if self.frames < FEWEST {
            let text = format!("flicker of {} frames: give {FEWEST} or more", self.frames);
            return Err(Error::Usage(text));
        }
        Ok((self.squares.iter().sum::<f64>() / (6 * self.squares.len()) as f64).sqrt())
    }

    /// Flicker around each inner frame, from the second to the last but one: the largest is where the picture pops.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.squares.iter().map(|square| (square / 6.0).sqrt())
    }

    fn error(&self, pair: &Pair<'_>) -> Vec<[f64; 3]> {
        let [ours, truth] =
            [pair.picture(), pair.truth()].map(|picture| colour::over(picture, self.background));
        ours.iter().zip(&truth).map(|(a, b)| [0, 1, 2].map(|axis| a[axis] - b[axis])).collect()
    }
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
