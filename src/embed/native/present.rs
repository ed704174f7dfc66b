//! What frames are drawn with, made when scene, settings or attachments change.

use super::passes::{Passes, ScenePasses, SplatPair, Views};
use super::targets::Targets;
use super::{Plan, Renderer};
use crate::error::Result;
use crate::passes::{SplatLayout, Splats};
use crate::scene::Scene;
use crate::stage::{Numbers, Residents};
use crate::targets::coverage;
use crate::variant::{Rasterizer, SceneVariant, Variant};
use crate::vk::shaders::layout::Frame;
use crate::vk::{Buffer, Device};
use ash::vk;
use std::collections::HashMap;
use std::sync::Arc;

/// What lasts as long as the renderer.
pub(super) struct Made {
    pub(super) plan: Plan,
    pass: vk::RenderPass,
    passes: HashMap<Variant, Arc<Passes>>,
    scenes: HashMap<SceneVariant, Arc<ScenePasses>>,
    layout: SplatLayout,
    pub(super) frame: Arc<Buffer>,
}

/// What frames of a variant are drawn with.
pub(super) struct Present {
    // Fields are dropped in this order: views before what they view.
    pub(super) views: Views,
    variant: Variant,
    pub(super) passes: Arc<Passes>,
    /// What is drawn, scene by scene.
    pub(super) scenes: Vec<Arc<ScenePasses>>,
    pub(super) coverage: Option<Arc<Buffer>>,
    _targets: Arc<Targets>,
    _frame: Arc<Buffer>,
}

/// The splats of a scene.
pub(super) struct Resident {
    pub(super) splats: SplatPair,
    pub(super) frame: Numbers,
    _scene: Arc<Scene>,
}

impl Made {
    pub(super) fn new(device: &Arc<Device>, plan: Plan, pass: vk::RenderPass) -> Result<Self> {
        Ok(Self {
            plan,
            pass,
            passes: HashMap::new(),
            scenes: HashMap::new(),
            layout: SplatLayout::new(device)?,
            frame: Arc::new(Buffer::uniform(device, "frame", size_of::<Frame>() as u64)?),
        })
    }

    fn passes(&mut self, device: &Arc<Device>, variant: &Variant) -> Result<Arc<Passes>> {
        if let Some(made) = self.passes.get(variant) {
            return Ok(made.clone());
        }
        // SAFETY: whoever made the renderer answers for the render pass.
        let made = unsafe { Passes::new(device, variant, &self.plan, self.pass)? };
        Ok(self.passes.entry(*variant).or_insert(Arc::new(made)).clone())
    }

    /// Makes what frames of `variant` with such scenes are drawn with, if it is not there; what the scenes have.
    pub(super) fn make_pipelines(
        &mut self,
        device: &Arc<Device>,
        variant: Variant,
        scenes: &[SceneVariant],
    ) -> Result<Vec<Arc<ScenePasses>>> {
        self.passes(device, &variant)?;
        scenes.iter().map(|variant| self.scene(device, variant)).collect()
    }

    fn scene(&mut self, device: &Arc<Device>, variant: &SceneVariant) -> Result<Arc<ScenePasses>> {
        if let Some(made) = self.scenes.get(variant) {
            return Ok(made.clone());
        }
        // SAFETY: whoever made the renderer answers for the render pass.
        let made = unsafe { ScenePasses::new(device, &self.layout, variant, &self.plan, self.pass)? };
        Ok(self.scenes.entry(*variant).or_insert(Arc::new(made)).clone())
    }

    fn present(&mut self, device: &Arc<Device>, targets: &Arc<Targets>, variant: Variant) -> Result<Present> {
        let passes = self.passes(device, &variant)?;
        let coverage = coverage(device, &variant, targets.size)?.map(Arc::new);
        let views = passes.views(device, &self.frame, targets, coverage.as_deref())?;
        let (_targets, _frame) = (targets.clone(), self.frame.clone());
        Ok(Present { views, variant, passes, scenes: Vec::new(), coverage, _targets, _frame })
    }

    /// With numbers of the scene's `own`, or those of the view.
    fn resident(&self, device: &Arc<Device>, scene: &Arc<Scene>, moves: bool, own: bool) -> Result<Resident> {
        let frame = Numbers::new(device, &self.frame, own)?;
        let splats = || Splats::new(device, &self.layout, frame.buffer(), scene, Some(Rasterizer::Draw));
        let splats = SplatPair { splats: splats()?, moved: moves.then(splats).transpose()? };
        Ok(Resident { splats, frame, _scene: scene.clone() })
    }
}

impl Present {
    /// What is drawn, scene by scene, of these splats.
    pub(super) fn with<'a>(
        &'a self,
        residents: &'a Residents<Resident>,
    ) -> Vec<(&'a ScenePasses, &'a SplatPair)> {
        self.scenes
            .iter()
            .map(Arc::as_ref)
            .zip(residents.present().map(|resident| &resident.splats))
            .collect()
    }
}

impl Renderer {
    /// Makes the splats of these scenes that are not there, for as many surfels as each has now; with numbers of each scene's `own`, or those
    /// of the view.
    pub(super) fn make_residents(&mut self, scenes: &[&Arc<Scene>], moves: bool, own: bool) -> Result<()> {
        let Self { residents, held, made, device, .. } = self;
        let fits =
            |resident: &Resident| resident.splats.moved.is_some() == moves && resident.frame.is_own() == own;
        let list: Vec<&Scene> = scenes.iter().map(|scene| &***scene).collect();
        let make = |place: usize| made.resident(device, scenes[place], moves, own);
        residents.turn(&list, fits, make, |gone| held.hold(gone))?;
        for (resident, scene) in residents.present_mut().zip(scenes) {
            resident.splats.set_count(scene.count());
        }
        Ok(())
    }

    /// Makes what frames of `variant` with such scenes are drawn with, if it is not there.
    pub(super) fn make_present(
        &mut self,
        targets: &Arc<Targets>,
        variant: Variant,
        scenes: &[SceneVariant],
    ) -> Result<()> {
        let is_other =
            |present: &Option<Present>| present.as_ref().is_none_or(|present| present.variant != variant);
        if is_other(&self.present) {
            std::mem::swap(&mut self.present, &mut self.previous);
        }
        if is_other(&self.present) {
            let old = self.present.take();
            self.held.hold(old);
            self.present = Some(self.made.present(&self.device, targets, variant)?);
        }
        let scenes = self.made.make_pipelines(&self.device, variant, scenes)?;
        if let Some(present) = &mut self.present {
            present.scenes = scenes;
        }
        Ok(())
    }
}
