//! Errors of pictures.

use crate::verify::metrics::path::PathValues;
use crate::verify::reference::Comparison;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;

/// What the error of a picture is against.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Against {
    /// The exact picture of the surface.
    #[default]
    Surface,
    /// The method's own float64 reference of all points, with 64 rays a pixel: the error is of aliasing and missing points only. Errors of
    /// different methods cannot be compared.
    OwnReference,
}

/// Error of a picture against the truth, or what serves as such.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Error {
    /// What it is against.
    #[serde(default)]
    pub against: Against,
    /// The pixel filter of the truth: `gaussian`, of a variance of 1 px², or `box`.
    pub filter: String,
    /// The scene or file that `surfel truth` traces; empty where the surface is unknown.
    #[serde(default)]
    pub surface: String,
    /// Standard error that the truth was to meet at every pixel.
    #[serde(default)]
    pub target: f64,
    /// Greatest number of rays per pixel.
    #[serde(default)]
    pub most_samples: u32,
    /// Root mean square of the truth's own standard error.
    pub truth_rms: f64,
    /// Metrics by name; infinite ones and those that could not be computed are absent.
    pub metrics: BTreeMap<String, f64>,
    /// Parts of the RMSE.
    pub terms: Terms,
    /// Values of each frame of the camera path; none without flicker.
    #[serde(default)]
    pub path: Option<PathValues>,
}

/// Parts of an RMSE, in its unit: linear light, white is 1.
///
/// `silhouette² + inside² = rmse²`. The others are the change of the picture without their cause.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Terms {
    /// Pixels that the truth or the picture covers in part, or only one of both covers.
    pub silhouette: f64,
    /// Pixels that both cover wholly: loss of texture and shading by sampling and filtering.
    pub inside: f64,
    /// Change of the picture by surfels of hidden sheets: those that ε admits, and those that visibility misses.
    pub hidden: Option<f64>,
    /// Change of the picture by rounding to float32: its difference from the float64 reference.
    pub precision: Option<f64>,
}

/// Error of a float32 picture against the float64 reference, pixel by pixel; see [`Comparison`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Float64Error {
    /// Pixels that the reference covers.
    pub object_pixels: u64,
    /// Ambiguous pixels: rounding can flip one of their decisions.
    pub ambiguous_pixels: u64,
    /// Pixels out of tolerance.
    pub failed_pixels: u64,
    /// Largest difference of linear colour and α over the unambiguous pixels. NaN, in JSON null, if a value is not
    /// finite.
    #[serde(deserialize_with = "nan_of_null")]
    #[schemars(with = "Option<f64>")]
    pub colour: f64,
    /// Largest difference of the normals' coordinates.
    #[serde(deserialize_with = "nan_of_null")]
    #[schemars(with = "Option<f64>")]
    pub normal: f64,
    /// Largest relative difference of the depth.
    #[serde(deserialize_with = "nan_of_null")]
    #[schemars(with = "Option<f64>")]
    pub depth: f64,
}

/// JSON has neither NaN nor infinity: serde writes null for both.
fn nan_of_null<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

impl Float64Error {
    /// The results of a comparison with the reference.
    pub fn of(found: &Comparison) -> Self {
        Self {
            object_pixels: found.object_pixels as u64,
            ambiguous_pixels: found.ambiguous as u64,
            failed_pixels: found.failed as u64,
            colour: found.worst.colour,
            normal: found.worst.normal,
            depth: found.worst.depth,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_null_and_comes_back_as_nan() {
        let float64_error =
            Float64Error { colour: f64::NAN, normal: f64::INFINITY, depth: 0.5, ..Default::default() };
        let text = serde_json::to_string(&float64_error).unwrap();
        assert!(text.contains(r#""colour":null,"normal":null,"depth":0.5"#), "{text}");
        let read: Float64Error = serde_json::from_str(&text).unwrap();
        assert!(read.colour.is_nan() && read.normal.is_nan() && read.depth == 0.5);
    }
}
