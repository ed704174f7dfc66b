//! Exact surface of the inputs of `surfel view`.

use crate::cli::mesh;
use crate::viewer::{ExactSurface, OpenSurface};
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use surfel::geometry::Model;
use surfel::load::{LoadOptions, LoadedModel, scene};
use surfel::verify::scenes;
use surfel::{Error, Progress};

/// The exact surface of inputs that were loaded: the triangles of `truth` if it is given; else their own, or the surface of the built-in scene.
/// Triangles are read when the surface is opened. `Err` tells the user in a sentence why there is none, and the remedy.
pub fn of_inputs(
    names: &[OsString],
    truth: Option<&Path>,
    options: &LoadOptions,
    loaded: &LoadedModel,
) -> Result<ExactSurface, String> {
    let open = match (truth, names) {
        (Some(truth), _) => triangles(vec![truth.into()], options, None),
        (None, [one]) if scene(one).is_some() => built_in(one),
        _ => {
            check(names, loaded)?;
            triangles(names.to_vec(), options, Some(loaded.read))
        }
    };
    Ok(ExactSurface::new(open))
}

/// Opens the surface of a built-in scene.
fn built_in(name: &OsString) -> OpenSurface {
    let name = scene(name).unwrap_or_default().to_owned();
    Arc::new(move |_: &dyn Progress| Ok(Arc::new(scenes::surface(&name)?)))
}

/// Reads the triangles of files, which must still declare this number of points, if one is given.
fn triangles(files: Vec<OsString>, options: &LoadOptions, points: Option<u64>) -> OpenSurface {
    let options = options.clone();
    Arc::new(move |progress: &dyn Progress| {
        let paths: Vec<&Path> = files.iter().map(Path::new).collect();
        let (mesh, read) = mesh::read(&paths, &options, progress)?;
        if points.is_some_and(|points| points != read) {
            return Err(Error::Usage("the file has changed since it was loaded: load it again".into()));
        }
        Ok(Arc::new(mesh))
    })
}

/// Fails with the reason if the triangles of the inputs are not all that their pictures show.
fn check(names: &[OsString], loaded: &LoadedModel) -> Result<(), String> {
    if names.iter().any(|name| scene(name).is_some()) {
        return Err("A built-in scene beside other inputs has no exact surface: open it alone.".into());
    }
    let Model { surfels, primitives } = &loaded.model;
    if !(primitives.ribbons.is_empty() && primitives.tubes.is_empty()) {
        return Err("Lines have no exact surface: compare with the float64 reference.".into());
    }
    if surfels.materials.is_some() || primitives.materials.is_some() {
        return Err("Exact pictures leave materials out: compare with the float64 reference.".into());
    }
    match names.iter().zip(&loaded.faces).find(|(_, faces)| **faces == 0) {
        None => Ok(()),
        Some((name, _)) => {
            let name = Path::new(name).file_name().unwrap_or(name).display();
            Err(format!(
                "{name} has no triangles, so its exact surface is unknown: open a mesh, or give one by --truth MESH."
            ))
        }
    }
}
