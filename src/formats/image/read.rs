//! Pictures from files.

use super::{READ, exr};
use crate::error::{Cause, Error, Result};
use crate::geometry::srgb;
use crate::picture::Picture;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

/// Maximum number of pixels of a picture: a gibibyte of colours.
pub const MOST_PIXELS: u64 = 1 << 26;

/// Maximum size of a picture's file that is named by another file, bytes.
#[cfg(feature = "gltf")]
pub const MOST_BYTES: u64 = 1 << 30;

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
const JPEG: &[u8] = &[0xff, 0xd8, 0xff];
const EXR: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// Reads a PNG, JPEG or EXR file, detected by content.
///
/// PNG of 8 or 16 bits and JPEG are decoded from sRGB to linear light; other colour spaces in the file are ignored. α is straight, as in
/// PNG, and 1 if absent. EXR is read as [`super::write_exr`] writes it, with depth and normals if present; α is straight there, too.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read, [`Error::Input`] if it has another format, is damaged, or has more than [`MOST_PIXELS`].
pub fn read(path: &Path) -> Result<Picture> {
    let bytes = beginning_as_picture(path).map_err(Error::io(path, "cannot read"))?;
    decode(&bytes).map_err(|cause: Cause| cause.in_input(path.display().to_string()))
}

/// The picture of the bytes of a file, as [`read`].
pub fn decode(bytes: &[u8]) -> Result<Picture, Cause> {
    match bytes {
        png if png.starts_with(PNG) => read_codes(png, ImageFormat::Png),
        jpeg if jpeg.starts_with(JPEG) => read_codes(jpeg, ImageFormat::Jpeg),
        exr if exr.starts_with(EXR) => exr::read(exr, MOST_PIXELS),
        _ => Err(format!("not a {READ} file: convert it to one of these").into()),
    }
}

/// The whole file if it begins as a picture; otherwise the beginning only, as the file may have no end.
fn beginning_as_picture(path: &Path) -> std::io::Result<Vec<u8>> {
    let (mut file, mut bytes) = (File::open(path)?, Vec::new());
    file.by_ref().take(PNG.len() as u64).read_to_end(&mut bytes)?;
    if [PNG, JPEG, EXR].iter().any(|beginning| bytes.starts_with(beginning)) {
        file.read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

fn read_codes(bytes: &[u8], format: ImageFormat) -> Result<Picture, Cause> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(Limits::no_limits());
    let decoder = reader.into_decoder().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!("{width}x{height} px: give a picture of at most {MOST_PIXELS} pixels").into());
    }
    let image = DynamicImage::from_decoder(decoder).map_err(|error| error.to_string())?;
    Ok(Picture { size: [width, height], colour: decoded(image), ..Default::default() })
}

/// Linear light; an 8-bit code is exactly a 16-bit one.
fn decoded(image: DynamicImage) -> Vec<[f32; 4]> {
    let share = |code: u16| f64::from(code) / f64::from(u16::MAX);
    let linear: Vec<f32> = (0..=u16::MAX).map(|code| srgb::decode(share(code)) as f32).collect();
    let light = |code: u16| linear[usize::from(code)];
    let pixel = |&[r, g, b, alpha]: &[u16; 4]| [light(r), light(g), light(b), share(alpha) as f32];
    image.into_rgba16().into_raw().as_chunks().0.iter().map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Output, write, write_exr};
    use super::*;
    use crate::settings::Shading;
    use image::{ImageBuffer, Luma, Rgba};

    fn in_folder<T>(run: impl FnOnce(&Path) -> T) -> T {
        run(tempfile::tempdir().unwrap().path())
    }

    fn picture() -> Picture {
        Picture {
            size: [2, 2],
            colour: vec![[0.1, -2.0, 1e9, 0.5], [1e-6, 3.5, 0.0, 1.0], [0.0; 4], [0.25, 0.5, 0.75, 1.0]],
            depth: Some(vec![1.5, 2.0, 0.0, 1e-3]),
            normal: Some(vec![[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0; 3], [-1.0, 0.0, 0.0]]),
            // Of which f32 would round two.
            id: Some(vec![0, 16_777_217, 4_000_000_001, Picture::NOBODY]),
        }
    }

    #[test]
    fn exr_comes_back_as_it_was_with_every_layer() {
        let whole = picture();
        let no_normal = Picture { normal: None, ..picture() };
        let bare = Picture { depth: None, id: None, ..no_normal.clone() };
        for picture in [whole, no_normal, bare] {
            in_folder(|folder| {
                let path = folder.join("a.exr");
                write_exr(&picture, &path).unwrap();
                assert_eq!(read(&path).unwrap(), picture);
            });
        }
    }

    #[test]
    fn values_that_are_not_finite_come_back() {
        let mut bad = picture();
        bad.colour[0] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1.0];
        let back = in_folder(|folder| {
            write_exr(&bad, &folder.join("a.exr")).unwrap();
            read(&folder.join("a.exr")).unwrap()
        });
        let bits = |picture: &Picture| picture.colour[0].map(f32::is_nan);
        assert_eq!((bits(&back), back.colour[0][1..3].to_vec()), (bits(&bad), bad.colour[0][1..3].to_vec()));
    }

    #[test]
    fn png_of_8_and_16_bits_is_decoded() {
        in_folder(|folder| {
            let path = folder.join("a.png");
            let colour = vec![[0.5, 0.0, 1.0, 0.5], [0.214_041, 0.18, 0.003, 1.0]];
            let lit = Picture { size: [2, 1], colour, ..Default::default() };
            write(&lit, Shading::Lit, &Output::File(path.clone())).unwrap();
            let back = read(&path).unwrap();
            for (a, b) in back.colour.as_flattened().iter().zip(lit.colour.as_flattened()) {
                // Half a code, where the transfer function is steepest.
                assert!((a - b).abs() < 0.5 / 255.0 * 2.3, "{a} {b}");
            }
            // Of 16 bits: linear 0.214041 is half way, to much less than a code of 8 bits.
            let deep = ImageBuffer::from_raw(1, 1, vec![32768u16, 0, 65535, 16384]).unwrap();
            let deep: ImageBuffer<Rgba<u16>, Vec<u16>> = deep;
            deep.save(&path).unwrap();
            let [r, g, b, alpha] = read(&path).unwrap().colour[0];
            assert!((r - 0.214_049).abs() < 2e-6 && (alpha - 0.250_004).abs() < 1e-6, "{r} {alpha}");
            assert_eq!((g, b), (0.0, 1.0));
            let grey: ImageBuffer<Luma<u8>, Vec<u8>> = ImageBuffer::from_raw(1, 1, vec![188]).unwrap();
            grey.save(&path).unwrap();
            let [r, g, b, alpha] = read(&path).unwrap().colour[0];
            assert!((r - 0.502_886).abs() < 1e-6 && r == g && g == b && alpha == 1.0, "{r} {alpha}");
        });
    }

    #[test]
    fn damaged_files_are_refused_without_a_panic() {
        in_folder(|folder| {
            let path = folder.join("a");
            let refused = |bytes: &[u8]| {
                std::fs::write(&path, bytes).unwrap();
                read(&path).unwrap_err().to_string()
            };
            for bytes in [&b""[..], b"P6 1 1 255 abc", b"\x89PNG"] {
                assert!(refused(bytes).contains("not a PNG, JPEG or EXR file"));
            }
            for name in ["a.png", "a.exr"] {
                let whole = folder.join(name);
                write(&picture(), Shading::Lit, &Output::File(whole.clone())).unwrap();
                let whole = std::fs::read(whole).unwrap();
                for length in (8..whole.len() - 12).step_by(7) {
                    assert!(!refused(&whole[..length]).contains('\n'), "{name} {length}");
                }
                // Whatever a wrong byte makes of it, it is a picture or an error.
                for at in 4..whole.len() {
                    for flip in [0x01, 0x80, 0xff] {
                        let mut wrong = whole.clone();
                        wrong[at] ^= flip;
                        std::fs::write(&path, wrong).unwrap();
                        let _ = read(&path);
                    }
                }
            }
            assert!(read(&folder.join("missing.png")).unwrap_err().to_string().contains("cannot read"));
        });
    }
}
