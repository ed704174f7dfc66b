//! `surfel render --hierarchy paper`: the surfels of the point octree that are drawn for a camera.

use std::time::{Duration, Instant};
use surfel::geometry::{Camera, Ellipses, PointOctree, Selected, Selection, Surfels};
use surfel::settings::Cull;
use surfel::{Error, Progress, Result, Settings};

/// The octree of the scene's points, and what is selected of it.
pub struct Cut {
    octree: PointOctree,
    selection: Selection,
    /// Time to build the octree.
    built: Duration,
}

/// Figures of the octree and of a selection, for the report.
#[derive(serde::Serialize)]
pub struct CutReport {
    /// Nodes of the octree.
    pub nodes: usize,
    /// Bytes of nodes and points.
    pub bytes: u64,
    /// Surfels that are selected.
    pub surfels: usize,
    /// Those of them that stand for nodes.
    pub selected_nodes: usize,
    /// Time to build the octree.
    pub build_ms: f64,
    /// Time to select.
    pub select_ms: f64,
}

impl Cut {
    /// Builds the octree for pictures of `size` px. Of the settings, the level of detail and the culling decide what is selected.
    pub fn new(
        surfels: Surfels,
        settings: &Settings,
        size: [u32; 2],
        progress: &dyn Progress,
    ) -> Result<Self> {
        let start = Instant::now();
        let octree = PointOctree::build(surfels, Ellipses::Bounding, progress)?;
        let selection = Selection { size, tolerance: settings.lod, back_faces: settings.cull != Cull::Back };
        Ok(Self { octree, selection, built: start.elapsed() })
    }

    /// The surfels for a camera.
    pub fn surfels(&self, camera: &Camera) -> Result<Surfels> {
        Ok(self.octree.surfels(&self.select(camera)?))
    }

    fn select(&self, camera: &Camera) -> Result<Selected> {
        self.octree.select(camera, &self.selection)
    }

    /// The figures of the selection for a camera.
    pub fn report(&self, camera: &Camera) -> Result<CutReport> {
        let start = Instant::now();
        let selected = self.select(camera)?;
        Ok(CutReport {
            select_ms: milliseconds(start.elapsed()),
            nodes: self.octree.node_count(),
            bytes: self.octree.bytes(),
            surfels: selected.len(),
            selected_nodes: selected.node_count(),
            build_ms: milliseconds(self.built),
        })
    }
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Fails if the settings need another hierarchy.
pub fn check(settings: &Settings) -> Result<()> {
    let refuse = |text: &str| Err(Error::Usage(text.into()));
    if settings.max_points.is_some() {
        refuse(
            "--max-points chooses a level of --hierarchy grid, and --hierarchy paper has none: give --lod alone",
        )
    } else if settings.draws_points() {
        refuse(
            "--hierarchy paper is of discs, and --method points estimates none: choose another method or --hierarchy grid",
        )
    } else {
        Ok(())
    }
}
