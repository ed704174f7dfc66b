//! Parts of an error.

use super::record::Terms;
use crate::picture::Picture;
use crate::verify::metrics::{Pair, colour, rmse};

/// Least α of a wholly covered pixel: allows for rounding of a filter's weights.
pub(super) const WHOLE: f32 = 1.0 - 1e-4;

/// Splits the error over black into the pixels on the outline and those inside.
pub fn split(pair: &Pair<'_>) -> Terms {
    let (picture, truth) = (pair.picture(), pair.truth());
    let [ours, exact] = [picture, truth].map(|picture| colour::over(picture, colour::BLACK));
    let (mut inside, mut silhouette) = (0.0, 0.0);
    for (i, (a, b)) in ours.iter().zip(&exact).enumerate() {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        let whole = [picture, truth].iter().all(|picture| picture.colour[i][3] >= WHOLE);
        *(if whole { &mut inside } else { &mut silhouette }) += square;
    }
    let mean = |squares: f64| (squares / (3 * ours.len()) as f64).sqrt();
    Terms { silhouette: mean(silhouette), inside: mean(inside), hidden: None, precision: None }
}

/// Difference of two pictures of one size: RMSE over black.
pub fn distance(a: &Picture, b: &Picture) -> f64 {
    rmse::rmse(&colour::over(a, colour::BLACK), &colour::over(b, colour::BLACK))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(pixels: [[f32; 4]; 4]) -> Picture {
        Picture { size: [4, 1], colour: pixels.to_vec(), ..Default::default() }
    }

    #[test]
    fn squares_of_the_parts_add_up_and_lie_where_the_outline_is() {
        let grey = |value: f32, alpha| [value, value, value, alpha];
        // Empty, half covered, missed, inside.
        let ours = picture([grey(0.0, 0.0), grey(0.5, 1.0), grey(0.0, 0.0), grey(0.75, 1.0)]);
        let truth = picture([grey(0.0, 0.0), grey(0.5, 0.5), grey(0.5, 1.0), grey(0.5, 1.0)]);
        let terms = split(&Pair::new(&ours, &truth).unwrap());
        assert_eq!(terms.inside, (0.25f64.powi(2) / 4.0).sqrt());
        assert_eq!(terms.silhouette, ((0.25f64.powi(2) + 0.5f64.powi(2)) / 4.0).sqrt());
        let whole = terms.inside.hypot(terms.silhouette);
        assert!((whole - distance(&ours, &truth)).abs() < 1e-15);
        assert_eq!(distance(&ours, &ours), 0.0);
    }
}
