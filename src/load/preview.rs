//! What is shown of many points while they are loaded.

use super::{Colouring, Listener, Load, LoadOptions, LoadedModel, Part, Suggestion};
use crate::estimate::Estimate;
use crate::formats::WantedAttributes;
use crate::geometry::{Cloud, Model};
use crate::settings::Settings;
use crate::{Progress, formats};
use glam::DVec3;
use std::ffi::OsStr;
use std::path::Path;

/// Some of many points, with their own normals and radii.
#[derive(Clone, Debug)]
pub struct Preview {
    /// The points.
    pub model: Model,
    /// The up direction, as [`LoadedModel::up`].
    pub up: DVec3,
    /// What they can be coloured by, as [`LoadedModel::suggestion`].
    pub suggestion: Option<Suggestion>,
}

/// Number of points of a preview.
const PREVIEW: usize = 20_000;
/// Minimum number of points for a preview, as a multiple of its own: fewer points load as fast as a preview.
const WORTH_A_PREVIEW: usize = 5;

/// Cancels with another listener, which hears nothing else.
struct Silent<'a>(&'a dyn Listener);

impl Progress for Silent<'_> {
    fn at(&self, _: &'static str, _: u64, _: u64) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

impl Listener for Silent<'_> {}

impl Load<'_> {
    /// Shows the coarsest levels of files before all of them are read; returns whether each has some and they are worth it.
    pub(super) fn preview_levels(&self, inputs: &[&OsStr]) -> bool {
        let is_whole = self.options.points.is_none() && self.options.voxel.is_none();
        // A pipe can be read once.
        let are_files = inputs.iter().all(|input| Path::new(input).is_file());
        if !(self.listener.wants_preview() && is_whole && are_files) {
            return false;
        }
        // Errors are those of the whole files, too, which report them.
        let levels = |input: &&OsStr| {
            let levels = formats::levels(Path::new(input)).ok()?;
            (levels.len() > 1).then(|| levels.iter().sum())
        };
        let points: Option<Vec<u64>> = inputs.iter().map(levels).collect();
        if points.is_none_or(|points| points.iter().sum::<u64>() < (WORTH_A_PREVIEW * PREVIEW) as u64) {
            return false;
        }
        let options = LoadOptions {
            points: Some(PREVIEW.div_ceil(inputs.len()) as u64),
            estimate: self.quick(),
            attributes: WantedAttributes::None,
            ..self.options.clone()
        };
        let coarse = Load { options: &options, listener: &Silent(self.listener), warns: false };
        let Ok(LoadedModel { model, up, suggestion, .. }) = coarse.all(inputs) else { return false };
        self.listener.preview(Preview { model, up, suggestion });
        true
    }

    /// A preview of some points with their own normals and radii; `None` for few points, and if lines or faces are rendered.
    pub(super) fn preview(&self, parts: &[Part], colouring: Option<&Colouring>, up: DVec3) -> Option<Model> {
        let all: usize = parts.iter().map(|part| part.cloud.len()).sum();
        let faces = |part: &Part| {
            part.cloud.has_lines()
                || (part.draws_faces || self.draws_faces()) && !part.cloud.triangles.is_empty()
        };
        if all < WORTH_A_PREVIEW * PREVIEW || parts.iter().any(faces) {
            return None;
        }
        let some = |part: &Part| part.cloud.some((part.cloud.len() * PREVIEW).div_ceil(all));
        let clouds = parts.iter().map(some).collect();
        let cloud = Cloud::merge(clouds, Settings::default().lighting.albedo).ok()?;
        // Estimation may fail for few points and succeed for all: then there is no preview.
        let (mut model, _) = cloud.into_model(false, &self.quick(), &()).ok()?;
        if let Some(colouring) = colouring.filter(|colouring| colouring.property().is_none()) {
            colouring.colour_model(&mut model, up, &());
        }
        Some(model)
    }

    /// The estimation of a preview.
    fn quick(&self) -> Estimate {
        Estimate { outlines: false, outliers: None, sharp: None, ..self.options.estimate.clone() }
    }
}

#[cfg(all(test, feature = "las", feature = "scenes"))]
mod tests {
    use crate::Progress;
    use crate::formats::{self, Contents};
    use crate::load::{Listener, LoadOptions, Preview, load};
    use crate::verify::scenes;
    use std::path::Path;
    use std::sync::Mutex;

    /// What is heard, in its order.
    #[derive(Default)]
    struct Heard(Mutex<Vec<String>>);

    impl Heard {
        fn add(&self, what: String) {
            let mut all = self.0.lock().unwrap();
            if all.last() != Some(&what) {
                all.push(what);
            }
        }
    }

    impl Progress for Heard {
        fn at(&self, stage: &'static str, _: u64, _: u64) {
            self.add(stage.into());
        }

        fn is_cancelled(&self) -> bool {
            false
        }
    }

    impl Listener for Heard {
        fn wants_preview(&self) -> bool {
            true
        }

        fn preview(&self, Preview { model, .. }: Preview) {
            self.add(format!("preview of {}", model.surfels.len()));
        }
    }

    /// What is heard while files are loaded.
    fn heard(paths: &[&Path]) -> Vec<String> {
        let heard = Heard::default();
        let loaded = load(paths, &LoadOptions::default(), &heard).unwrap();
        assert_eq!((loaded.model.surfels.len(), loaded.dropped.total()), (150_000 * paths.len(), 0));
        heard.0.into_inner().unwrap()
    }

    #[test]
    fn coarse_levels_are_a_preview_before_a_file_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let surfels = scenes::open("scene:sphere?points=150000").unwrap();
        let contents = Contents::of(&surfels);
        let all = ["a.laz", "a.copc.laz"].map(|name| {
            let path = folder.path().join(name);
            formats::write(&path, &contents, &()).unwrap();
            path
        });
        let [plain, octree] = &all;
        let [both, two] = [heard(&[plain, octree]), heard(&[octree, octree])];
        let [plain, octree] = [heard(&[plain]), heard(&[octree])];
        assert_eq!(two[..2], ["preview of 20000", "reading"], "{two:?}");
        assert_eq!(both[0], "reading", "{both:?}");
        assert_eq!(plain[..2], ["reading", "preview of 20000"], "{plain:?}");
        assert_eq!(octree[..2], ["preview of 20000", "reading"], "{octree:?}");
        let previews = octree.iter().filter(|what| what.starts_with("preview"));
        assert_eq!(previews.count(), 1, "{octree:?}");
    }
}
