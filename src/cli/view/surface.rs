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
            let name = files.first().map(|file| Path::new(file).display().to_string()).unwrap_or_default();
            return Err(Error::input(name, "the file has changed since it was loaded: load it again"));
        }
        Ok(Arc::new(mesh))
    })
}

/// Fails with the reason if the triangles of the inputs are not all that their pictures show.
fn check(names: &[OsString], loaded: &LoadedModel) -> Result<(), String> {
    if names.iter().any(|name| scene(name).is_some()) {
        return Err("No exact surface of a built-in scene beside other inputs: open it alone.".into());
    }
    let Model { surfels, primitives } = &loaded.model;
    if !(primitives.ribbons.is_empty() && primitives.tubes.is_empty()) {
        return Err("No exact surface of lines: compare with the float64 reference.".into());
    }
    if surfels.materials.is_some() || primitives.materials.is_some() {
        return Err("No exact surface with materials: compare with the float64 reference.".into());
    }
    match names.iter().zip(&loaded.faces).find(|(_, faces)| **faces == 0) {
        None => Ok(()),
        Some((name, _)) => {
            let name = Path::new(name).file_name().unwrap_or(name).display();
            Err(format!(
                "No exact surface: {name} has no triangles. Open a mesh, or give one by --truth MESH."
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use surfel::load::load;

    const TRIANGLE: &str = "element face 1\nproperty list uchar int vertex_indices\n";
    const RIBBON: &str = "element edge 1\nproperty int vertex1\nproperty int vertex2\n";

    /// A file of four points with further elements.
    fn file(folder: &Path, name: &str, elements: &str, records: &str) -> OsString {
        let path = folder.join(name);
        let header =
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
        let points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
        std::fs::write(&path, format!("{header}{elements}end_header\n{points}{records}")).unwrap();
        path.into()
    }

    /// The exact surface of inputs, or the reason.
    fn surface(names: &[OsString], truth: Option<&OsString>) -> Result<ExactSurface, String> {
        let options = LoadOptions::default();
        let loaded = load(names, &options, &()).unwrap();
        of_inputs(names, truth.map(Path::new), &options, &loaded)
    }

    #[test]
    fn what_has_no_exact_surface_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let of = |name, elements, records| file(folder.path(), name, elements, records);
        let (mesh, points) = (of("mesh.ply", TRIANGLE, "3 0 1 2\n"), of("points.ply", "", ""));
        let lines = of("lines.ply", &format!("{TRIANGLE}{RIBBON}"), "3 0 1 2\n2 3\n");
        let scene = OsString::from("scene:sphere?points=100");
        for known in [vec![mesh.clone()], vec![mesh.clone(), mesh.clone()], vec![scene.clone()]] {
            surface(&known, None).map(drop).unwrap();
        }
        for (names, cause) in [
            (
                &[points.clone()][..],
                "No exact surface: points.ply has no triangles. Open a mesh, or give one by --truth MESH.",
            ),
            (&[mesh.clone(), points.clone()], "No exact surface: points.ply has no triangles"),
            (&[lines], "No exact surface of lines: compare with the float64 reference."),
            (
                &[scene, mesh.clone()],
                "No exact surface of a built-in scene beside other inputs: open it alone.",
            ),
        ] {
            let reason = surface(names, None).err().unwrap();
            assert!(reason.starts_with(cause), "{reason}");
        }
        // Given triangles serve any points.
        let surface = surface(&[points], Some(&mesh)).unwrap().get(&()).unwrap();
        assert!(surface.trace([0.2, 0.2, 4.0].into(), [0.0, 0.0, -1.0].into()).is_some());
    }
}
