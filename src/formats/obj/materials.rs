//! Files of materials (MTL): colours and textures by name.
//!
//! | line | becomes |
//! |---|---|
//! | `newmtl NAME` | the material that the lines after it describe |
//! | `Kd r g b` | its colour, sRGB-encoded, as other programs show it |
//! | `map_Kd OPTION… FILE` | its texture, relative to the file of materials; options are left out |
//!
//! Source: Wavefront Technologies, Advanced Visualizer manual, MTL material format.

use super::survey::keyword;
use crate::formats::source::{Parsed, check_regular};
use crate::formats::table::text::number;
use crate::formats::text::lines;
use crate::geometry::srgb;
use glam::DVec3;
use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Size of the largest file of materials, bytes.
const LARGEST: u64 = 1 << 24;

/// A material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// Linear light.
    pub colour: Option<DVec3>,
    pub texture: Option<PathBuf>,
}

/// The materials of files, by name.
pub fn read(folder: &Path, files: &[Vec<u8>]) -> Parsed<HashMap<Vec<u8>, Material>> {
    let mut materials = HashMap::new();
    for path in files.iter().flat_map(|names| paths(folder, names)) {
        parse(&bytes(&path)?, path.parent().unwrap_or(folder), &mut materials);
    }
    Ok(materials)
}

/// The files that a line names: one whose name may have spaces, or several.
fn paths(folder: &Path, names: &[u8]) -> Vec<PathBuf> {
    let whole = folder.join(file_name(names));
    if whole.is_file() {
        return vec![whole];
    }
    let names = names.split(u8::is_ascii_whitespace).filter(|name| !name.is_empty());
    names.map(|name| folder.join(file_name(name))).collect()
}

/// A name with the separators of any system.
fn file_name(name: &[u8]) -> String {
    String::from_utf8_lossy(name.trim_ascii()).replace('\\', "/")
}

fn bytes(path: &Path) -> Parsed<Vec<u8>> {
    check_regular(path)?;
    let named = |cause: &str| format!("{}: {cause}", path.display());
    let mut bytes = Vec::new();
    let file = File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes));
    file.map_err(|error| named(&error.to_string()))?;
    match bytes.len() as u64 > LARGEST {
        true => Err(named("too large for materials: give one of 16 MiB at most").into()),
        false => Ok(bytes),
    }
}

fn parse(bytes: &[u8], folder: &Path, materials: &mut HashMap<Vec<u8>, Material>) {
    let mut name = Vec::new();
    for (word, values) in lines::of(bytes).filter_map(keyword) {
        let values = values.trim_ascii();
        match word {
            b"newmtl" => {
                name = values.to_vec();
                materials.insert(name.clone(), Material::default());
            }
            b"Kd" => {
                if let Some(material) = materials.get_mut(&name) {
                    material.colour = colour(values);
                }
            }
            b"map_Kd" => {
                if let Some((material, file)) = materials.get_mut(&name).zip(without_options(values)) {
                    material.texture = Some(folder.join(file_name(file)));
                }
            }
            _ => {}
        }
    }
}

/// A colour of three numbers, linear; as a spectrum or by other coordinates none.
fn colour(values: &[u8]) -> Option<DVec3> {
    let channels = values.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty());
    let channels: Vec<f64> = channels.map(number).collect::<Option<_>>()?;
    let [red, green, blue] = channels[..] else { return None };
    Some(DVec3::new(red, green, blue).clamp(DVec3::ZERO, DVec3::ONE).map(srgb::decode))
}

/// The name of the file after the options of a texture.
fn without_options(values: &[u8]) -> Option<&[u8]> {
    let mut rest = values.trim_ascii();
    while let Some((b'-', _)) = rest.split_first() {
        let end = |text: &[u8]| text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        let (option, mut after) = rest.split_at(end(rest));
        // -o, -s and -t have up to three numbers.
        let (least, most) = match option {
            b"-o" | b"-s" | b"-t" => (1, 3),
            b"-mm" => (2, 2),
            _ => (1, 1),
        };
        for k in 0..most {
            let (value, next) = after.trim_ascii_start().split_at(end(after.trim_ascii_start()));
            if k >= least && number(value).is_none() {
                break;
            }
            after = next;
        }
        rest = after.trim_ascii_start();
    }
    Some(rest).filter(|name| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_have_colours_and_textures() {
        let text = b"# a\nnewmtl two words\nKd 1 0.5 0\n\nnewmtl b\nKd spectral a.rfl\nmap_Kd -o 0.5 0 -bm 2 -clamp on maps\\a b.png\r\nmap_Ks c.png\n";
        let mut materials = HashMap::new();
        parse(text, Path::new("folder"), &mut materials);
        let half = srgb::decode(0.5);
        let plain = Material { colour: Some(DVec3::new(1.0, half, 0.0)), texture: None };
        let textured = Material { colour: None, texture: Some("folder/maps/a b.png".into()) };
        assert_eq!(materials, HashMap::from([(b"two words".to_vec(), plain), (b"b".to_vec(), textured)]));
    }

    #[test]
    fn options_of_textures_are_left_out() {
        let names = [("a.png", "a.png"), ("-s 1 1 1 a.png", "a.png"), ("-s 2 2.png", "2.png")];
        for (values, name) in names {
            assert_eq!(without_options(values.as_bytes()), Some(name.as_bytes()), "{values}");
        }
        assert_eq!([without_options(b"-mm 0 1"), without_options(b"")], [None, None]);
    }
}
