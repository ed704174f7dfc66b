//! A pair of comparable pictures.

use crate::error::{Error, Result};
use crate::picture::Picture;

/// Least α of a covered pixel.
const COVERED: f32 = 0.5;

/// A picture and the truth: equal in size, complete and finite.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    picture: &'a Picture,
    truth: &'a Picture,
}

/// One of the two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The picture under test.
    Picture,
    /// The truth.
    Truth,
}

/// Values of a picture that are NaN or infinite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NonFinite {
    /// Number of such values, in all channels of all images of the picture.
    pub values: u64,
    /// The first pixel with such a value, row by row: x and y, px.
    pub first: [u32; 2],
}

impl<'a> Pair<'a> {
    /// Checks both pictures.
    ///
    /// # Errors
    /// [`Error::Usage`] if the sizes differ, a picture has no pixels, or an image does not fit its size;
    /// [`Error::Input`] if a value is NaN or infinite.
    pub fn new(picture: &'a Picture, truth: &'a Picture) -> Result<Self> {
        check(picture, Side::Picture)?;
        check(truth, Side::Truth)?;
        let ([a, b], [c, d]) = (picture.size, truth.size);
        if picture.size == truth.size {
            Ok(Self { picture, truth })
        } else {
            Err(Error::Usage(format!(
                "the picture is {a}x{b} px and the truth {c}x{d}: compare pictures of one size"
            )))
        }
    }

    /// The picture under test.
    pub fn picture(&self) -> &'a Picture {
        self.picture
    }

    /// The truth.
    pub fn truth(&self) -> &'a Picture {
        self.truth
    }

    /// Width and height, px.
    pub fn size(&self) -> [u32; 2] {
        self.picture.size
    }

    /// Number of pixels; at least 1.
    pub fn pixels(&self) -> usize {
        self.picture.colour.len()
    }

    /// The pixels that both cover.
    pub(super) fn covered_in_both(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.pixels()).filter(|&i| covers(self.picture, i) && covers(self.truth, i))
    }
}

impl Side {
    /// Name for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Picture => "the picture",
            Self::Truth => "the truth",
        }
    }
}

impl NonFinite {
    /// The non-finite values of `picture`; `None` if all are finite.
    pub fn of(picture: &Picture) -> Option<Self> {
        let count = |values: &[f32]| values.iter().filter(|value| !value.is_finite()).count() as u64;
        let in_pixel = |i: usize| {
            let depth = picture.depth.as_ref().map_or(0, |depth| count(&depth[i..=i]));
            let normal = picture.normal.as_ref().map_or(0, |normal| count(&normal[i]));
            count(&picture.colour[i]) + depth + normal
        };
        let mut found: Option<Self> = None;
        for (i, values) in (0..picture.colour.len()).map(|i| (i, in_pixel(i))).filter(|(_, n)| *n > 0) {
            let width = picture.size[0] as usize;
            let first = [i % width, i / width].map(|side| side as u32);
            found.get_or_insert(Self { values: 0, first }).values += values;
        }
        found
    }
}

/// Whether pixel `i`, which must exist, shows a surface: α is at least ½ and, because an opaque background has α too,
/// depth and normal are not 0, if the picture has them.
pub fn covers(picture: &Picture, i: usize) -> bool {
    let no_depth = picture.depth.as_ref().is_some_and(|depth| depth[i] == 0.0);
    let no_normal = picture.normal.as_ref().is_some_and(|normal| normal[i] == [0.0; 3]);
    picture.colour[i][3] >= COVERED && !no_depth && !no_normal
}

fn check(picture: &Picture, side: Side) -> Result<()> {
    let name = side.name();
    let [width, height] = picture.size;
    let pixels = width as usize * height as usize;
    let depth = picture.depth.as_ref().map_or(pixels, Vec::len);
    let normal = picture.normal.as_ref().map_or(pixels, Vec::len);
    if pixels == 0 || [picture.colour.len(), depth, normal] != [pixels; 3] {
        return Err(Error::Usage(format!(
            "{name} claims to be {width}x{height} px and has {} colours, {depth} depths and {normal} normals: fill it",
            picture.colour.len()
        )));
    }
    match NonFinite::of(picture) {
        None => Ok(()),
        Some(NonFinite { values, first: [x, y] }) => Err(Error::input(
            name,
            format!("{values} values are NaN or infinite, the first in pixel {x},{y}: it cannot be compared"),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(size: [u32; 2]) -> Picture {
        let pixels = (size[0] * size[1]) as usize;
        Picture { size, colour: vec![[0.5, 0.5, 0.5, 1.0]; pixels], ..Default::default() }
    }

    #[test]
    fn pictures_that_do_not_fit_are_refused() {
        let text = |a: &Picture, b: &Picture| Pair::new(a, b).unwrap_err().to_string();
        let good = grey([4, 3]);
        assert!(Pair::new(&good, &good).is_ok());
        assert!(text(&good, &grey([3, 4])).starts_with("the picture is 4x3 px and the truth 3x4"));
        assert!(
            text(&good, &Picture { size: [4, 2], ..good.clone() }).starts_with("the truth claims to be 4x2")
        );
        assert!(text(&Picture { depth: Some(vec![]), ..good.clone() }, &good).contains("0 depths"));
        assert!(text(&grey([0, 5]), &grey([0, 5])).contains("0x5"));
    }

    #[test]
    fn every_value_that_is_not_finite_is_counted() {
        let good = Picture { depth: Some(vec![1.0; 12]), normal: Some(vec![[0.0; 3]; 12]), ..grey([4, 3]) };
        assert_eq!(NonFinite::of(&good), None);
        let mut bad = good.clone();
        bad.colour[9] = [f32::NAN, f32::INFINITY, 0.0, 1.0];
        bad.depth.as_mut().unwrap()[6] = f32::NEG_INFINITY;
        bad.normal.as_mut().unwrap()[11][2] = f32::NAN;
        assert_eq!(NonFinite::of(&bad), Some(NonFinite { values: 4, first: [2, 1] }));
        let text = Pair::new(&good, &bad).unwrap_err().to_string();
        assert!(
            text.starts_with("the truth: 4 values are NaN or infinite, the first in pixel 2,1"),
            "{text}"
        );
        assert!(Pair::new(&bad, &good).unwrap_err().to_string().starts_with("the picture: 4 values"));
    }

    #[test]
    fn a_background_is_not_covered() {
        let mut picture = grey([4, 1]);
        picture.colour[0][3] = 0.49;
        picture.depth = Some(vec![1.0, 0.0, 1.0, 1.0]);
        picture.normal = Some(vec![[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, 1.0]]);
        assert_eq!([0, 1, 2, 3].map(|i| covers(&picture, i)), [false, false, false, true]);
        (picture.depth, picture.normal) = (None, None);
        picture.colour[1][3] = 0.5;
        assert_eq!([0, 1, 2, 3].map(|i| covers(&picture, i)), [false, true, true, true]);
    }
}
