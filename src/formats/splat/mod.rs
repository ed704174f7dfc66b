//! SPLAT reader (antimatter15): 3D Gaussians of 32 bytes each.
//!
//! | bytes | content |
//! |---|---|
//! | 0 to 11 | position, 3 × float32 |
//! | 12 to 23 | standard deviations along the axes, 3 × float32 |
//! | 24 to 27 | red, green, blue, sRGB-encoded; opacity: 255 is 1 |
//! | 28 to 31 | rotation, real part first: (byte − 128) / 128 |
//!
//! They become discs like those of PLY files: see [`ply`](super::ply). −y is up, as in the training data of 3D Gaussians. The format has
//! neither header nor signature: the file's extension tells it.

#[cfg(test)]
mod tests;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::gaussians::{OPACITY, ROTATION, SCALES, logit};
use super::meter::Meter;
use super::reader::{Input, Reader};
use super::source::{Parsed, Source};
use super::table::{Arrays, Layout, Points, Records, fields};
use super::{Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;

/// The SPLAT format.
pub(super) struct Splat;

/// Size of a Gaussian, bytes.
const SIZE: u64 = 32;

impl Reader for Splat {
    fn name(&self) -> &'static str {
        "SPLAT"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["splat"]
    }

    fn knows(&self, _: &[u8]) -> Option<bool> {
        None
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let size = input.source.size();
        if size == 0 {
            return Err("the file is empty: fetch or write it again".into());
        }
        if !size.is_multiple_of(SIZE) {
            return Err(format!(
                "its {size} bytes are no multiple of {SIZE}, the size of a Gaussian: it is truncated or another format; fetch it again"
            )
            .into());
        }
        let element = Element { name: "point".into(), count: size / SIZE, properties: properties() };
        let loaded = load(&input.source, &element, options, progress);
        let encoding = Encoding::BinaryLittleEndian;
        Ok(Inspected { format: self.name(), encoding, elements: vec![element], loaded })
    }
}

/// The properties, in the order of their bytes.
fn properties() -> Vec<Property> {
    let floats = ["x", "y", "z"].into_iter().chain(SCALES).map(|name| (name, Scalar::F32));
    let bytes = ["red", "green", "blue", OPACITY].into_iter().chain(ROTATION).map(|name| (name, Scalar::U8));
    let property =
        |(name, scalar): (&str, Scalar)| Property { name: name.into(), kind: Kind::Scalar(scalar) };
    floats.chain(bytes).map(property).collect()
}

fn load(
    source: &Source,
    element: &Element,
    options: &ReadOptions,
    progress: &dyn Progress,
) -> Parsed<Loaded> {
    let layout = Layout::of(element, options, false)?;
    let meter = Meter::new(progress, source.size());
    let mut arrays = Arrays::new(element.count, &layout)?;
    let records = Records { source, start: 0, big_endian: false };
    let names: Vec<&str> =
        layout.used().iter().map(|(_, index)| element.properties[*index].name.as_str()).collect();
    let finish = |field: usize, values: &mut [f64]| decode(names[field], values);
    let sizes = [element.count as usize, SIZE as usize];
    let tally = records.fill(&mut arrays, &layout, sizes, &fields(element, &layout), finish, &meter)?;
    meter.finish();
    let mut points = Points::new(arrays, tally, &layout)?;
    let attributes = points.take_attributes(element, &layout);
    let report = Report::of_points(Encoding::BinaryLittleEndian, element, &layout, &points);
    Ok(Loaded { cloud: points.cloud, report, attributes })
}

/// Converts stored values of a property to those of PLY files.
fn decode(name: &str, values: &mut [f64]) {
    let convert: fn(f64) -> f64 = match name {
        OPACITY => |code| logit(code / 255.0),
        _ if SCALES.contains(&name) => f64::ln,
        _ if ROTATION.contains(&name) => |code| (code - 128.0) / 128.0,
        _ => return,
    };
    values.iter_mut().for_each(|value| *value = convert(*value));
}
