//! Triangle meshes of files.

use std::path::Path;
use surfel::formats::{self, ReadOptions};
use surfel::geometry::Cloud;
use surfel::load::LoadOptions;
use surfel::verify::truth::Mesh;
use surfel::{Error, Progress, Result, Settings};

/// Reads the triangles of files as one mesh; returns also the number of points that the files declare.
pub fn read(
    paths: &[impl AsRef<Path>],
    options: &LoadOptions,
    progress: &dyn Progress,
) -> Result<(Mesh, u64)> {
    let options = ReadOptions { triangles: true, texture: options.texture.clone(), ..Default::default() };
    let (mut clouds, mut points) = (Vec::new(), 0);
    for path in paths {
        let loaded = formats::read(path.as_ref(), &options, progress)?;
        points += loaded.report.points;
        clouds.push(loaded.cloud);
    }
    let names: Vec<_> = paths.iter().map(|path| path.as_ref().display().to_string()).collect();
    let cloud = Cloud::merge(clouds, Settings::default().lighting.albedo)?;
    if progress.is_cancelled() {
        return Err(Error::Cancelled);
    }
    Ok((Mesh::new(&names.join(", "), &cloud)?, points))
}
