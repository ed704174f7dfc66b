//! Surfels as hosts lay them out in buffers.

use ash::vk::{self, Format};
use glam::{DVec3, Vec3};
use surfel::embed::{Buffers, Radii, Values};
use surfel::geometry::{Bounds, Colours, Surfels};
use surfel::scene::Order;

/// Where a stream begins, bytes; from one value to the next, bytes; the format.
pub type Place = (u64, u64, Format);

/// How a buffer holds surfels.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    pub positions: Place,
    pub normals: Place,
    /// None: all have the radius of the first.
    pub radii: Option<Place>,
    pub ellipses: Option<Place>,
    pub colours: Option<Place>,
}

impl Layout {
    /// The streams of `count` surfels one behind the other, each side by side.
    pub fn apart(count: usize) -> Self {
        let n = count as u64;
        Self {
            positions: (0, 12, Format::R32G32B32_SFLOAT),
            normals: (12 * n, 12, Format::R32G32B32_SFLOAT),
            radii: Some((24 * n, 4, Format::R32_SFLOAT)),
            ellipses: None,
            colours: Some((28 * n, 4, Format::R8G8B8A8_SRGB)),
        }
    }

    /// Vertices of position, colour, normal and radius, from an odd place on.
    pub fn vertices() -> Self {
        Self {
            positions: (12, 36, Format::R32G32B32_SFLOAT),
            colours: Some((24, 36, Format::R8G8B8A8_SRGB)),
            normals: (28, 36, Format::R32G32B32_SFLOAT),
            radii: Some((40, 36, Format::R32_SFLOAT)),
            ellipses: None,
        }
    }

    /// Vertices of position with the radius behind it, normal with a gap, linear colour, ellipse.
    pub fn wide() -> Self {
        Self {
            positions: (20, 72, Format::R32G32B32A32_SFLOAT),
            radii: Some((32, 72, Format::R32_SFLOAT)),
            normals: (36, 72, Format::R32G32B32A32_SFLOAT),
            colours: Some((52, 72, Format::R32G32B32_SFLOAT)),
            ellipses: Some((64, 72, Format::R32G32B32A32_SFLOAT)),
        }
    }

    fn end(&self, count: usize) -> usize {
        let streams = [Some(self.positions), Some(self.normals), self.radii, self.ellipses, self.colours];
        let end = |(offset, stride, _): Place| offset + (count as u64 - 1) * stride + 16;
        streams.into_iter().flatten().map(end).max().unwrap_or(0) as usize
    }

    /// The bytes of `surfels`.
    pub fn bytes(&self, surfels: &Surfels) -> Vec<u8> {
        // What is between the values is no number.
        let mut bytes = vec![0xff; self.end(surfels.len())];
        for i in 0..surfels.len() {
            let mut put = |(offset, stride, _): Place, value: &[u8]| {
                let at = offset as usize + i * stride as usize;
                bytes[at..at + value.len()].copy_from_slice(value);
            };
            put(self.positions, bytemuck::bytes_of(&surfels.positions[i]));
            put(self.normals, &packed(surfels.normals[i], self.normals.2));
            let two_sided = surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
            let radius = if two_sided { -surfels.radii[i] } else { surfels.radii[i] };
            self.radii.into_iter().for_each(|place| put(place, &radius.to_ne_bytes()));
            if let (Some(place), Some(ellipses)) = (self.ellipses, &surfels.ellipses) {
                put(place, bytemuck::bytes_of(&ellipses[i]));
            }
            if let Some(place) = self.colours {
                match &surfels.colours {
                    Some(Colours::Srgb8(colours)) => put(place, &colours[i]),
                    Some(Colours::Linear(colours)) => put(place, &packed(colours[i].into(), place.2)),
                    None => {}
                }
            }
        }
        bytes
    }

    /// Description of `surfels` in `buffer` for a scene.
    pub fn buffers(&self, surfels: &Surfels, buffer: vk::Buffer) -> Buffers {
        let values = |(offset, stride, format): Place| Values {
            buffer,
            size: self.end(surfels.len()) as u64,
            offset,
            stride,
            format,
        };
        let count = surfels.len() as u64;
        Buffers {
            positions: values(self.positions),
            normals: values(self.normals),
            radii: self.radii.map_or(Radii::All(surfels.radii[0]), |place| Radii::Each(values(place))),
            billboards: surfels.normals.contains(&Vec3::ZERO),
            two_sided: surfels.two_sided.is_some(),
            ellipses: self.ellipses.map(values),
            colours: self.colours.map(values),
            capacity: count,
            count,
            origin: surfels.origin,
            order: Order::Coherent,
            bounds: surfels.bounds().unwrap_or(Bounds::of_box(DVec3::ZERO, DVec3::ONE)),
        }
    }

    /// Surfels whose values are those that the buffer holds of `surfels`.
    pub fn held(&self, mut surfels: Surfels) -> Surfels {
        let unit = |n: &Vec3| unpacked(&packed(*n, self.normals.2), self.normals.2).normalize_or_zero();
        if !is_float(self.normals.2) {
            surfels.normals = surfels.normals.iter().map(unit).collect();
        }
        if let (Some(Colours::Linear(colours)), Some((.., format))) = (&mut surfels.colours, self.colours) {
            colours.iter_mut().for_each(|c| *c = unpacked(&packed((*c).into(), format), format).into());
        }
        if self.radii.is_none() {
            let radius = surfels.radii[0];
            surfels.radii.fill(radius);
        }
        surfels
    }
}

fn is_float(format: Format) -> bool {
    matches!(format, Format::R32G32B32_SFLOAT | Format::R32G32B32A32_SFLOAT)
}

/// The nearest half float.
fn half(x: f32) -> u16 {
    let bits = (x.abs() * 2f32.powi(-112)).to_bits();
    let rounded = (bits + 0xfff + (bits >> 13 & 1)) >> 13;
    rounded as u16 | u16::from(x.is_sign_negative()) << 15
}

fn packed(v: Vec3, format: Format) -> Vec<u8> {
    let [x, y, z] = v.to_array();
    match format {
        Format::R8G8B8A8_SNORM => [x, y, z].map(|v| (127.0 * v).round() as i8 as u8).to_vec(),
        Format::R8G8B8A8_UNORM => [x, y, z].map(|v| (255.0 * v).round() as u8).to_vec(),
        Format::R16G16B16A16_SNORM => {
            [x, y, z].iter().flat_map(|v| ((32_767.0 * v).round() as i16).to_ne_bytes()).collect()
        }
        Format::R16G16B16A16_SFLOAT => [x, y, z].iter().flat_map(|v| half(*v).to_ne_bytes()).collect(),
        _ => bytemuck::bytes_of(&v).to_vec(),
    }
}

fn unpacked(bytes: &[u8], format: Format) -> Vec3 {
    let short = |i: usize| u16::from_ne_bytes([bytes[2 * i], bytes[2 * i + 1]]);
    let unhalf = |bits: u16| {
        let size = f32::from_bits(u32::from(bits & 0x7fff) << 13) * 2f32.powi(112);
        if bits >> 15 == 0 { size } else { -size }
    };
    let number = |i: usize| match format {
        Format::R8G8B8A8_SNORM => f32::from(bytes[i] as i8) / 127.0,
        Format::R8G8B8A8_UNORM => f32::from(bytes[i]) / 255.0,
        Format::R16G16B16A16_SNORM => f32::from(short(i) as i16) / 32_767.0,
        Format::R16G16B16A16_SFLOAT => unhalf(short(i)),
        _ => f32::from_ne_bytes(std::array::from_fn(|k| bytes[4 * i + k])),
    };
    Vec3::from_array(std::array::from_fn(number))
}
