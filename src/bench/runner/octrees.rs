//! Point octrees of the models of runs, and their cuts.

use crate::bench::plan::Plan;
use crate::bench::record;
use crate::error::Result;
use crate::geometry::{Camera, Ellipses, Model, PointOctree, Selection};
use crate::settings::Cull;
use std::rc::Rc;
use std::time::Instant;

/// Selections that are timed, of which the median counts.
const SELECTIONS: usize = 3;

/// The octree of the last model.
#[derive(Default)]
pub struct Octrees(Option<Built>);

struct Built {
    model: Rc<Model>,
    octree: PointOctree,
    ms: f64,
}

impl Octrees {
    /// What is selected of a model's octree for a plan, and its figures.
    ///
    /// # Errors
    /// As [`PointOctree::build`] and [`PointOctree::select`].
    pub fn cut(
        &mut self,
        model: &Rc<Model>,
        camera: &Camera,
        plan: &Plan,
    ) -> Result<(Rc<Model>, Option<record::Octree>)> {
        let built = match self.0.take().filter(|built| Rc::ptr_eq(&built.model, model)) {
            Some(built) => built,
            None => Built::new(model)?,
        };
        let Built { octree, ms, .. } = self.0.insert(built);
        let back_faces = plan.settings.cull != Cull::Back;
        let selection = Selection { size: plan.size, tolerance: plan.settings.lod, back_faces };
        let mut times = Vec::new();
        let mut selected = octree.select(camera, &selection)?;
        for _ in 0..SELECTIONS {
            let start = Instant::now();
            selected = octree.select(camera, &selection)?;
            times.push(milliseconds(start));
        }
        times.sort_by(f64::total_cmp);
        let figures = record::Octree {
            nodes: octree.node_count() as u64,
            bytes: octree.bytes(),
            build_ms: *ms,
            surfels: selected.len() as u64,
            select_ms: times[SELECTIONS / 2],
        };
        let model = Model { surfels: octree.surfels(&selected), primitives: model.primitives.clone() };
        Ok((Rc::new(model), Some(figures)))
    }
}

impl Built {
    fn new(model: &Rc<Model>) -> Result<Self> {
        let (surfels, start) = (model.surfels.clone(), Instant::now());
        let octree = PointOctree::build(surfels, Ellipses::Bounding, &())?;
        Ok(Self { model: model.clone(), octree, ms: milliseconds(start) })
    }
}

fn milliseconds(start: Instant) -> f64 {
    1e3 * start.elapsed().as_secs_f64()
}
