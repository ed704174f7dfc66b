//! Images of a run beside the truth.

use super::plan::Plan;
use super::record::Images;
use crate::error::{Error, Result};
use crate::formats::image::Encoded;
use crate::picture::Picture;
use crate::verify::metrics::{Metric, Options, Pair, measure};
use base64::prelude::{BASE64_STANDARD, Engine};

/// Largest side of an image in the report, px; larger images are cropped to their middle.
pub const MOST: u32 = 768;

/// The images of a run: rendered, truth, and FLIP's difference map.
pub fn of(plan: &Plan, picture: &Picture, truth: &Picture) -> Result<Images> {
    let [picture, truth] = [picture, truth].map(middle);
    let measured = measure(&Pair::new(&picture, &truth)?, &Options::default())?;
    let flip = measured.value(Metric::Flip).unwrap_or_default();
    let shading = plan.settings.shading;
    let implementation = plan.engine.implementation(&plan.settings).label();
    Ok(Images {
        title: format!("{}, {} points, {implementation}: FLIP {flip:.3}", plan.scene, plan.points),
        rendered: png(Encoded::of(&picture, shading)?)?,
        truth: png(Encoded::of(&truth, shading)?)?,
        flip: png(measured.flip.coloured()?)?,
    })
}

/// A PNG in base64, for the page.
pub(super) fn png(image: Encoded) -> Result<String> {
    let mut bytes = Vec::new();
    image.png(&mut bytes).map_err(Error::io("a picture of the report".as_ref(), "cannot encode"))?;
    Ok(BASE64_STANDARD.encode(bytes))
}

/// Crops an image to its middle if it is too large for the report.
fn middle(picture: &Picture) -> Picture {
    let [width, height] = picture.size.map(|side| side as usize);
    let size = picture.size.map(|side| side.min(MOST));
    let [across, down] = size.map(|side| side as usize);
    let (left, top) = ((width - across) / 2, (height - down) / 2);
    let pixels = || (0..down).flat_map(|y| (0..across).map(move |x| (top + y) * width + left + x));
    Picture {
        size,
        colour: pixels().map(|i| picture.colour[i]).collect(),
        depth: picture.depth.as_ref().map(|depth| pixels().map(|i| depth[i]).collect()),
        normal: picture.normal.as_ref().map(|normal| pixels().map(|i| normal[i]).collect()),
        id: picture.id.as_ref().map(|id| pixels().map(|i| id[i]).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_large_picture_the_middle_is_left() {
        let (width, height) = (MOST + 2, 3);
        let colour = (0..width * height).map(|i| [i as f32, 0.0, 0.0, 1.0]).collect();
        let cut = middle(&Picture { size: [width, height], colour, ..Default::default() });
        assert_eq!(cut.size, [MOST, height]);
        assert_eq!(cut.colour[0][0], 1.0);
        assert_eq!(cut.colour[MOST as usize][0], (width + 1) as f32);
        assert_eq!(cut.colour.len(), (MOST * height) as usize);
    }
}
