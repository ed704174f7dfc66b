//! Values of every frame along a camera path, for plots: [`Flicker`](super::flicker::Flicker) computes them.

/// Values along a path, over all pixels and channels, in the unit of linear colours: 1 is white.
///
/// ```
/// let values = surfel::verify::metrics::path::PathValues { flicker: vec![0.01, 0.03, 0.02], ..Default::default() };
/// // Flicker begins at the second frame.
/// assert_eq!(values.popping(), Some((2, 0.03)));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bench", derive(schemars::JsonSchema))]
pub struct PathValues {
    /// Root mean square error of each frame.
    pub rmse: Vec<f64>,
    /// Root mean square difference of the picture of each frame but the first from that of the frame before.
    pub picture_change: Vec<f64>,
    /// The same of the truth. Where the picture changes by more, its error changes.
    pub truth_change: Vec<f64>,
    /// [Flicker](super::flicker) around each frame but the first and the last.
    pub flicker: Vec<f64>,
}

impl PathValues {
    /// The frame around which the picture flickers most, counted from 0, and the flicker; of equal ones the first. `None` for fewer than three
    /// frames.
    pub fn popping(&self) -> Option<(usize, f64)> {
        let around = (1..).zip(self.flicker.iter().copied());
        around.min_by(|a, b| b.1.total_cmp(&a.1))
    }
}
