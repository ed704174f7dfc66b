//! Image files: PNG for display, EXR for values.

mod exr;
mod read;

#[cfg(feature = "gltf")]
pub(crate) use read::{MOST_BYTES, decode};
pub use read::{MOST_PIXELS, read};

use super::atomic;
use crate::error::{Error, Result};
use crate::geometry::ColourMap;
use crate::geometry::srgb;
use crate::picture::Picture;
use crate::settings::Shading;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};
use rayon::prelude::*;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Formats of pictures that are read.
pub const READ: &str = "PNG, JPEG or EXR";

/// Destination of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// A file, which appears complete or not at all.
    File(PathBuf),
    /// Standard output, as PNG.
    Stdout,
}

impl Output {
    /// `-` is standard output, anything else a file.
    pub fn parse(text: &OsStr) -> Self {
        if text == "-" { Self::Stdout } else { Self::File(text.into()) }
    }

    /// Whether it has 8 bits per channel, for display, instead of values.
    pub fn is_png(&self) -> bool {
        match self {
            Self::File(path) => matches!(Kind::of(path), Ok(Kind::Png)),
            Self::Stdout => true,
        }
    }

    /// Validates the destination before the picture exists, with the errors of [`write()`].
    ///
    /// # Errors
    /// [`Error::Usage`] if the extension is neither png nor exr, [`Error::Io`] if no file can be written there.
    pub fn check(&self) -> Result<()> {
        self.check_name()?;
        match self {
            Self::File(path) => atomic::check(path),
            Self::Stdout => Ok(()),
        }
    }

    /// Validates the name alone.
    ///
    /// # Errors
    /// [`Error::Usage`] if the extension is neither png nor exr.
    pub fn check_name(&self) -> Result<()> {
        match self {
            Self::File(path) => Kind::of(path).map(drop),
            Self::Stdout => Ok(()),
        }
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Png,
    Exr,
}

impl Kind {
    fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(Error::Usage(format!(
                "{}: unknown image format: name the file .png or .exr",
                path.display()
            ))),
        }
    }
}

/// Writes a picture in the format of the extension; PNG to standard output.
///
/// # Errors
/// [`Error::Usage`] if the extension is neither png nor exr; otherwise as [`write_png`] and [`write_exr`].
pub fn write(picture: &Picture, shading: Shading, out: &Output) -> Result<()> {
    match out {
        Output::Stdout => write_png(picture, shading, out),
        Output::File(path) => match Kind::of(path)? {
            Kind::Png => write_png(picture, shading, out),
            Kind::Exr => write_exr(picture, path),
        },
    }
}

/// Writes a picture as 8-bit PNG, encoded by [`Encoded`].
///
/// # Errors
/// [`Error::Usage`] if the picture's arrays do not match its size, [`Error::Io`] if `out` cannot be written.
pub fn write_png(picture: &Picture, shading: Shading, out: &Output) -> Result<()> {
    Encoded::of(picture, shading)?.write_png(out)
}

/// An encoded picture as in a PNG: RGBA, 8 bits per channel, straight α.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Encoded {
    /// `size` pixels, row by row.
    pixels: Vec<[u8; 4]>,
    size: [u32; 2],
}

impl Encoded {
    /// Encodes a picture.
    ///
    /// `Lit` and `Colour` are sRGB-encoded. `Normal` maps −1…1 to 0…255 without a transfer function, in world space. `Depth` is grey, white
    /// at the nearest covered pixel and a tenth of that at the farthest, linear in depth, without a transfer function. Overlaps are viridis
    /// from 0 to their maximum. Pixels without a surface have the background's colour, black for `Depth`.
    ///
    /// # Errors
    /// [`Error::Usage`] if the picture's arrays do not match its size.
    pub fn of(picture: &Picture, shading: Shading) -> Result<Self> {
        check(picture)?;
        Self::new(picture.size, encode(picture, shading))
    }

    /// A picture of pixels row by row from the top left.
    ///
    /// # Errors
    /// [`Error::Usage`] if the number of pixels is 0 or differs from `size`, px.
    pub fn new(size: [u32; 2], pixels: Vec<[u8; 4]>) -> Result<Self> {
        let [width, height] = size;
        if !pixels.is_empty() && pixels.len() as u64 == u64::from(width) * u64::from(height) {
            Ok(Self { pixels, size })
        } else {
            Err(Error::Usage(format!(
                "{} pixels for a picture of {width} × {height}: give that many, at least one",
                pixels.len()
            )))
        }
    }

    /// Width and height, px.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Row by row from the top left.
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// Like [`Encoded::pixels`], for drawing.
    pub fn pixels_mut(&mut self) -> &mut [[u8; 4]] {
        &mut self.pixels
    }

    /// Writes a PNG to a file or to standard output, as [`Encoded::png`].
    ///
    /// # Errors
    /// [`Error::Io`] if `out` cannot be written.
    pub fn write_png(self, out: &Output) -> Result<()> {
        match out {
            Output::File(path) => atomic::write(path, |mut out| self.png(&mut out)),
            Output::Stdout => {
                let mut out = io::stdout().lock();
                self.png(&mut out)
                    .and_then(|()| out.flush())
                    .map_err(Error::io(Path::new("-"), "cannot write to standard output"))
            }
        }
    }

    /// Writes PNG data: RGBA, or RGB if every pixel is opaque.
    ///
    /// # Errors
    /// Errors of `out`.
    pub fn png(mut self, out: &mut dyn Write) -> io::Result<()> {
        let opaque = self.pixels.iter().all(|pixel| pixel[3] == 255);
        let (bytes, kind) = if opaque {
            (self.pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect(), ExtendedColorType::Rgb8)
        } else {
            // Invisible pixels compress better as 0.
            self.pixels.iter_mut().filter(|pixel| pixel[3] == 0).for_each(|pixel| *pixel = [0; 4]);
            (self.pixels.into_flattened(), ExtendedColorType::Rgba8)
        };
        let [width, height] = self.size;
        PngEncoder::new(out).write_image(&bytes, width, height, kind).map_err(io_error)
    }
}

/// Writes a picture as float OpenEXR without conversion: [`Picture::colour`] as R, G, B and straight A (linear light, unit normals or
/// depths); [`Picture::depth`] as Z and [`Picture::normal`] as N.X, N.Y, N.Z if present.
///
/// # Errors
/// As [`write_png`].
pub fn write_exr(picture: &Picture, path: &Path) -> Result<()> {
    check(picture)?;
    atomic::write(path, |out| exr::write(picture, out))
}

fn io_error(error: ImageError) -> io::Error {
    match error {
        ImageError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

fn check(picture: &Picture) -> Result<()> {
    let [width, height] = picture.size;
    let pixels = width as usize * height as usize;
    let fits = |len: Option<usize>| len.is_none_or(|len| len == pixels);
    let images = [
        Some(picture.colour.len()),
        picture.depth.as_ref().map(Vec::len),
        picture.normal.as_ref().map(Vec::len),
        picture.id.as_ref().map(Vec::len),
    ];
    if pixels > 0 && images.into_iter().all(fits) {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "a picture of {width} × {height} pixels has images of another size: give one value per pixel"
        )))
    }
}

fn encode(picture: &Picture, shading: Shading) -> Vec<[u8; 4]> {
    let alpha = |pixel: &[f32; 4]| unit(pixel[3]);
    let colour = |pixel: &[f32; 4]| {
        [srgb::encode8(pixel[0]), srgb::encode8(pixel[1]), srgb::encode8(pixel[2]), alpha(pixel)]
    };
    let pixels = picture.colour.iter().enumerate();
    match shading {
        Shading::Lit | Shading::Colour | Shading::Edl => picture.colour.par_iter().map(colour).collect(),
        Shading::Normal => {
            let normal = |pixel: &[f32; 4]| {
                let [x, y, z] = [0, 1, 2].map(|axis: usize| unit(0.5 * pixel[axis] + 0.5));
                [x, y, z, alpha(pixel)]
            };
            pixels.map(|(i, pixel)| if covered(picture, i) { normal(pixel) } else { colour(pixel) }).collect()
        }
        Shading::Depth => {
            let [near, far] = depth_range(picture);
            // The farthest surface must differ from the background.
            let scale = if far > near { 0.9 / (far - near) } else { 0.0 };
            let grey =
                |i, depth: f32| if covered(picture, i) { unit(1.0 - (depth - near) * scale) } else { 0 };
            let pixel = |(i, pixel): (usize, &[f32; 4])| {
                let grey = grey(i, pixel[0]);
                [grey, grey, grey, alpha(pixel)]
            };
            pixels.map(pixel).collect()
        }
        Shading::Overlap | Shading::Weight => {
            let most =
                (0..picture.colour.len()).filter(|&i| covered(picture, i)).map(|i| picture.colour[i][0]);
            let most = most.fold(1.0, f32::max);
            let coloured = |pixel: &[f32; 4]| {
                let [r, g, b] = ColourMap::Viridis.at((pixel[0] / most).into());
                [r, g, b, alpha(pixel)]
            };
            pixels
                .map(|(i, pixel)| if covered(picture, i) { coloured(pixel) } else { colour(pixel) })
                .collect()
        }
    }
}

/// 8-bit code of a value from 0 to 1.
fn unit(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Whether pixel `i` shows a surface. With an opaque background α does not tell, so other images are used if present.
fn covered(picture: &Picture, i: usize) -> bool {
    let no_depth = picture.depth.as_ref().is_some_and(|depth| depth[i] == 0.0);
    let no_normal = picture.normal.as_ref().is_some_and(|normal| normal[i] == [0.0; 3]);
    picture.colour[i][3] > 0.0 && !no_depth && !no_normal
}

/// Smallest and largest depth of the covered pixels; infinite and reversed without any.
fn depth_range(picture: &Picture) -> [f32; 2] {
    let depths =
        picture.colour.iter().enumerate().filter(|(i, _)| covered(picture, *i)).map(|(_, pixel)| pixel[0]);
    depths.fold([f32::INFINITY, f32::NEG_INFINITY], |[near, far], depth| [near.min(depth), far.max(depth)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageReader};

    fn picture(colour: &[[f32; 4]]) -> Picture {
        Picture { size: [colour.len() as u32, 1], colour: colour.to_vec(), ..Default::default() }
    }

    fn round_trip(picture: &Picture, shading: Shading, name: &str) -> DynamicImage {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        write(picture, shading, &Output::File(path.clone())).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        ImageReader::open(path).unwrap().decode().unwrap()
    }

    #[test]
    fn colours_are_srgb_encoded_and_alpha_is_straight() {
        let pixels =
            [[0.0, 0.214_041, 1.0, 0.5], [0.5, 2.0, -1.0, 1.0], [0.3, 0.3, 0.3, 0.0], [0.18, 0.0, 0.0, 0.25]];
        let DynamicImage::ImageRgba8(read) = round_trip(&picture(&pixels), Shading::Lit, "a.png") else {
            panic!()
        };
        assert_eq!(read.into_raw(), [0, 127, 255, 128, 188, 255, 0, 255, 0, 0, 0, 0, 118, 0, 0, 64]);
        let opaque = [[0.0, 0.5, 1.0, 1.0]; 2];
        let DynamicImage::ImageRgb8(read) = round_trip(&picture(&opaque), Shading::Colour, "a.PNG") else {
            panic!()
        };
        assert_eq!((read.dimensions(), read.into_raw()), ((2, 1), vec![0, 188, 255, 0, 188, 255]));
    }

    #[test]
    fn normals_are_mapped_without_a_transfer_function() {
        let mut normals = picture(&[[-1.0, 0.0, 1.0, 1.0], [0.5, 0.5, 0.5, 1.0]]);
        assert_eq!(encode(&normals, Shading::Normal), [[0, 128, 255, 255], [191, 191, 191, 255]]);
        // The second pixel is background.
        normals.normal = Some(vec![[-1.0, 0.0, 1.0], [0.0; 3]]);
        assert_eq!(encode(&normals, Shading::Normal)[1], [188, 188, 188, 255]);
    }

    #[test]
    fn depths_run_from_white_to_dark() {
        let mut depths = picture(&[
            [2.0, 2.0, 2.0, 1.0],
            [4.0, 4.0, 4.0, 1.0],
            [3.0, 3.0, 3.0, 0.5],
            [0.0; 4],
            [9.0, 9.0, 9.0, 1.0],
        ]);
        depths.depth = Some(vec![2.0, 4.0, 3.0, 0.0, 0.0]);
        let grey: Vec<_> = encode(&depths, Shading::Depth).iter().map(|pixel| (pixel[0], pixel[3])).collect();
        assert_eq!(grey, [(255, 255), (26, 255), (140, 128), (0, 0), (0, 255)]);
        assert_eq!(encode(&picture(&[[5.0, 5.0, 5.0, 1.0]]), Shading::Depth), [[255; 4]]);
        assert_eq!(encode(&picture(&[[0.0; 4]]), Shading::Depth), [[0; 4]]);
    }

    #[test]
    fn exr_keeps_every_value() {
        let pixels = [[0.1, -2.0, 1e9, 0.5], [1e-6, 3.5, 0.0, 1.0]];
        let DynamicImage::ImageRgba32F(read) = round_trip(&picture(&pixels), Shading::Lit, "a.exr") else {
            panic!()
        };
        assert_eq!(read.into_raw(), pixels.as_flattened());
    }

    #[test]
    fn errors_name_the_file_and_the_cause() {
        let one = picture(&[[0.0; 4]]);
        let out = Output::parse(OsStr::new("a/b.jpg"));
        for text in
            [write(&one, Shading::Lit, &out), out.check()].map(|result| result.unwrap_err().to_string())
        {
            assert_eq!(text, "a/b.jpg: unknown image format: name the file .png or .exr");
        }
        for name in ["no/such/a.png", "no/such/a.exr"] {
            let text = write(&one, Shading::Lit, &Output::File(name.into())).unwrap_err().to_string();
            assert!(
                text.starts_with(name) && text.contains("the folder no/such does not exist: create it"),
                "{text}"
            );
        }
        assert_eq!(Output::parse(OsStr::new("-")), Output::Stdout);
        let ragged = Picture { size: [2, 1], ..one };
        assert!(matches!(write_png(&ragged, Shading::Lit, &Output::Stdout), Err(Error::Usage(_))));
        for (size, count) in [([2, 1], 1), ([0, 0], 0), ([u32::MAX; 2], 1)] {
            assert!(matches!(Encoded::new(size, vec![[0; 4]; count]), Err(Error::Usage(_))), "{size:?}");
        }
    }
}
