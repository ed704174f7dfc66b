//! The primitives of a scene, with the transformations of their nodes.

use super::schema::{Document, Primitive};
use crate::formats::quoted::quoted;
use crate::formats::source::Parsed;
use glam::DMat4;

/// Beginnings of the names of extensions that change no geometry, or none that is read.
const HARMLESS: [&str; 6] = [
    "KHR_mesh_quantization",
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "EXT_texture_",
    "MSFT_texture_",
];

/// A primitive and its transformation to the coordinates of the scene.
pub struct Placed<'a> {
    pub primitive: &'a Primitive,
    /// The node, which is in the scene once.
    pub node: u32,
    pub matrix: DMat4,
}

/// Returns an error if a required extension is not supported.
pub fn check_extensions(document: &Document) -> Parsed<()> {
    let harmless = |name: &str| HARMLESS.iter().any(|known| name.starts_with(known));
    match document.extensions_required.iter().find(|name| !harmless(name)) {
        Some(name) => Err(unsupported(name).into()),
        None => Ok(()),
    }
}

/// The message about an extension.
pub fn unsupported(name: &str) -> String {
    let name = quoted(name.as_bytes());
    format!(
        "it needs the extension {name}, which is not supported: write it without compression and extensions"
    )
}

/// The primitives of the default scene; of all nodes without a parent, if the file has no scene.
pub fn primitives(document: &Document) -> Parsed<Vec<Placed<'_>>> {
    let mut open: Vec<(u32, DMat4)> =
        roots(document)?.into_iter().map(|node| (node, DMat4::IDENTITY)).collect();
    // In the order of the file.
    open.reverse();
    let mut reached = vec![false; document.nodes.len()];
    let mut placed = Vec::new();
    while let Some((index, parent)) = open.pop() {
        let node = document.nodes.get(index as usize).zip(reached.get_mut(index as usize));
        let (node, reached) = node.ok_or_else(|| missing("node", index))?;
        if std::mem::replace(reached, true) {
            return Err(format!(
                "node {index} is below itself or two nodes: write each node below one other"
            )
            .into());
        }
        let matrix = parent * node.matrix();
        if let Some(mesh) = node.mesh {
            let mesh = document.meshes.get(mesh as usize).ok_or_else(|| missing("mesh", mesh))?;
            placed.extend(mesh.primitives.iter().map(|primitive| Placed { primitive, node: index, matrix }));
        }
        open.extend(node.children.iter().rev().map(|child| (*child, matrix)));
    }
    Ok(placed)
}

fn roots(document: &Document) -> Parsed<Vec<u32>> {
    if let Some(scene) = document.scene {
        let scene = document.scenes.get(scene as usize).ok_or_else(|| missing("scene", scene))?;
        return Ok(scene.nodes.clone());
    }
    if let Some(scene) = document.scenes.first() {
        return Ok(scene.nodes.clone());
    }
    let mut has_parent = vec![false; document.nodes.len()];
    for child in document.nodes.iter().flat_map(|node| &node.children) {
        if let Some(flag) = has_parent.get_mut(*child as usize) {
            *flag = true;
        }
    }
    Ok((0..document.nodes.len() as u32).filter(|node| !has_parent[*node as usize]).collect())
}

pub fn missing(what: &str, index: u32) -> String {
    format!("it refers to {what} {index}, which it does not have: fetch or write it again")
}
