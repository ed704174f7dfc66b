//! Comparison of a picture with the float64 reference, and faults that no tolerance excuses.

use super::super::record::{Faults, Float64Error};
use crate::error::Result;
use crate::picture::Picture;
use crate::verify::reference::{Admissible, Expected};

/// Compares a picture that has depth and normals with `expected`. A pixel with a value that is not finite counts as a
/// fault and is treated as empty otherwise.
///
/// # Errors
/// The picture has another size, or lacks depth or normals.
pub fn compare(expected: &Expected, picture: &Picture) -> Result<(Float64Error, Faults)> {
    let (picture, non_finite) = finite(picture);
    let found = expected.compare(&picture)?;
    let mut faults = Faults { non_finite, ..Default::default() };
    for (i, &depth) in picture.depth.iter().flatten().enumerate() {
        let covered = expected.frame.covered[i];
        if (depth != 0.0) == covered || !is_sure(expected, i) {
            continue;
        }
        *(if covered { &mut faults.uncovered } else { &mut faults.overcovered }) += 1;
    }
    Ok((Float64Error::of(&found), faults))
}

/// The picture without its pixels that hold NaN or infinity, and their number.
fn finite(picture: &Picture) -> (Picture, u64) {
    let mut cleared = picture.clone();
    let mut count = 0;
    for i in 0..picture.colour.len() {
        let mut depth = cleared.depth.as_mut().and_then(|depths| depths.get_mut(i));
        let mut normal = cleared.normal.as_mut().and_then(|normals| normals.get_mut(i));
        let values =
            cleared.colour[i].iter().chain(depth.as_deref()).chain(normal.as_deref().into_iter().flatten());
        if values.into_iter().all(|value| value.is_finite()) {
            continue;
        }
        count += 1;
        cleared.colour[i] = [0.0; 4];
        depth.iter_mut().for_each(|depth| **depth = 0.0);
        normal.iter_mut().for_each(|normal| **normal = [0.0; 3]);
    }
    (cleared, count)
}

/// Whether all admissible values of pixel `index` agree on its coverage.
fn is_sure(expected: &Expected, index: usize) -> bool {
    match expected.bounds.admissible(index) {
        Admissible::Definite => true,
        Admissible::Unresolvable => false,
        Admissible::Values(mut values) => {
            values.all(|(value, _)| value.covered == expected.frame.covered[index])
        }
    }
}
