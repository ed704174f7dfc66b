//! Source of a scene: the model that it was uploaded from, and the appearance that the user gives it.

use super::appearance::{Appearance, ColourAttribute, SavedAppearance};
use super::distribution::Distribution;
use super::exact_surface::ExactSurface;
use super::job::Job;
use super::scene_info::SceneInfo;
use super::{ColourBy, Loaded, PointProperties};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;
use surfel::geometry::{Colours, Extent, Model, Parts, SurfelFormat, Surfels, ValueRange};
use surfel::scene::{Changes, ColourStream};
use surfel::settings::Shading;
use surfel::vk::Device;
use surfel::{Error, Progress, Result, Scene, Settings};

/// The model of a scene, and its appearance.
pub struct Source {
    /// The model as it was loaded.
    model: Arc<Model>,
    /// What a camera frames.
    extent: Extent,
    /// The exact surface, or why there is none.
    surface: std::result::Result<ExactSurface, String>,
    /// Further properties of the points; `None` for a preview.
    properties: Option<PointProperties>,
    /// Properties that were read: index among the names, values of surfels and of vertices.
    read: Vec<(usize, [Vec<f32>; 2])>,
    /// The property that is being read.
    reading: Option<Reading>,
    /// A property that the scene should be coloured by but does not have, and the range that the user chose for it.
    missing: Option<(String, Option<ValueRange>)>,
    /// The appearance that the user wants.
    pub wanted: Appearance,
    /// The appearance of the scene on the device.
    applied: Appearance,
    /// The distribution of each attribute that was needed so far.
    distributions: Vec<(ColourAttribute, Option<Arc<Distribution>>)>,
    /// Format in which the device stores the surfels.
    pub format: SurfelFormat,
    info: SceneInfo,
    /// The up axis of the world, a unit vector.
    up: DVec3,
    /// The first shading, instead of the usual one; `None` for that.
    shading: Option<Shading>,
    /// The first strength of ambient occlusion, likewise.
    ao: Option<f32>,
}

/// A property that is being read.
struct Reading {
    /// Index of the property among the names.
    property: usize,
    job: Job<[Vec<f32>; 2]>,
    /// The range that the user chose for it.
    range: Option<ValueRange>,
}

impl Source {
    /// The source of what was loaded.
    pub fn new(
        Loaded { model, surface, properties, colour_by, format, info, up, shading, ao, method: _ }: Loaded,
    ) -> Self {
        let mut source = Self {
            extent: Extent::of(&model).unwrap_or_default(),
            model: Arc::new(model),
            surface,
            properties,
            read: Vec::new(),
            reading: None,
            missing: None,
            wanted: Appearance::own(),
            applied: Appearance::own(),
            distributions: Vec::new(),
            format,
            info,
            up,
            shading,
            ao,
        };
        if let Some(colour_by) = colour_by {
            source.colour_by_name(colour_by);
        }
        source
    }

    /// Colours by the attribute of this name, or else by the files' property.
    fn colour_by_name(&mut self, ColourBy { name, map, range }: ColourBy) {
        self.wanted.map = map;
        let built_in = ColourAttribute::ALL.iter().find(|(_, known, _)| *known == name);
        let attribute = match (built_in, &mut self.properties) {
            (Some((attribute, ..)), _) => *attribute,
            (None, None) => {
                self.missing = Some((name, range));
                return;
            }
            (None, Some(PointProperties { names, .. })) => {
                let known = names.iter().position(|known| *known == name);
                ColourAttribute::Property(known.unwrap_or_else(|| {
                    // The scene uses the property itself, or there is no such property, which is an error of reading it.
                    names.push(name);
                    names.len() - 1
                }))
            }
        };
        self.set_attribute(attribute, range);
    }

    /// The up direction of the world, a unit vector.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// The scene's first shading and ambient occlusion instead of the usual ones.
    pub fn shaded(&self, settings: Settings) -> Settings {
        let usual = Settings::default();
        let shading = self.shading.filter(|_| settings.shading == usual.shading);
        let ao = self.ao.filter(|_| settings.ao == usual.ao);
        Settings { shading: shading.unwrap_or(settings.shading), ao: ao.unwrap_or(settings.ao), ..settings }
    }

    /// What a camera frames.
    pub fn extent(&self) -> &Extent {
        &self.extent
    }

    /// What is known of the scene.
    pub fn info(&self) -> &SceneInfo {
        &self.info
    }

    /// The exact surface that the picture shows; or why there is none, and the remedy.
    pub fn surface(&self) -> std::result::Result<&ExactSurface, &str> {
        match self.applied.attribute {
            ColourAttribute::Own => self.surface.as_ref().map_err(String::as_str),
            _ => Err("No exact surface under these colours: choose the points' own."),
        }
    }

    /// Whether radii cannot be scaled: normalization weights are those of the discs as they are.
    pub fn has_fixed_radii(&self) -> bool {
        self.model.surfels.weights.is_some() || self.model.surfels.is_empty()
    }

    /// Names of the files' properties.
    pub fn property_names(&self) -> &[String] {
        self.properties.as_ref().map_or(&[], |properties| &properties.names)
    }

    /// Name of an attribute.
    pub fn name(&self, attribute: ColourAttribute) -> &str {
        match attribute {
            ColourAttribute::Property(property) => {
                self.property_names().get(property).map_or("", String::as_str)
            }
            _ => ColourAttribute::ALL
                .iter()
                .find(|(known, ..)| *known == attribute)
                .map_or("", |(_, name, _)| name),
        }
    }

    /// Colours by an attribute in its default range; by a property of the files once that is read.
    pub fn colour_by(&mut self, attribute: ColourAttribute) {
        self.set_attribute(attribute, None);
    }

    /// Colours by an attribute; in its default range unless one is given.
    fn set_attribute(&mut self, attribute: ColourAttribute, range: Option<ValueRange>) {
        (self.reading, self.missing) = (None, None);
        if let ColourAttribute::Property(property) = attribute
            && !self.read.iter().any(|(known, _)| *known == property)
            && let Some(properties) = &self.properties
        {
            let (read, name) = (properties.read.clone(), self.name(attribute).to_owned());
            let job = Job::start(move |progress: &dyn Progress| read(&name, progress));
            self.reading = Some(Reading { property, job, range });
            return;
        }
        self.wanted.attribute = attribute;
        if let Some(range) = range.or_else(|| self.default_range(attribute)) {
            self.wanted.range = range;
        }
    }

    /// Stage and progress, from 0 to 1, of the property that is being read.
    pub fn reading_progress(&self) -> Option<(&'static str, f32)> {
        self.reading.as_ref().map(|reading| reading.job.at())
    }

    /// Colours by the property that was being read, once it is.
    fn take_property(&mut self) -> Result<()> {
        let Some(Reading { property, job, range }) = &mut self.reading else { return Ok(()) };
        let (property, range, Some(outcome)) = (*property, *range, job.take()) else { return Ok(()) };
        self.reading = None;
        let read = match outcome {
            Ok(read) => read,
            Err(error) => {
                // A property that was asked for by name and does not exist is the last one.
                let last = self.properties.as_mut().filter(|all| property + 1 == all.names.len());
                last.map(|properties| properties.names.pop());
                return Err(error);
            }
        };
        let (surfels, vertices) = (self.model.surfels.len(), self.model.primitives.positions.len());
        if read.each_ref().map(Vec::len) != [surfels, vertices] {
            return Err(Error::Usage("the file has changed since it was loaded: load it again".into()));
        }
        self.read.push((property, read));
        self.set_attribute(ColourAttribute::Property(property), range);
        Ok(())
    }

    /// Values of an attribute, of surfels and of vertices; `None` if it has none or they are not read yet.
    fn values(&self, attribute: ColourAttribute) -> Option<[Vec<f64>; 2]> {
        if let ColourAttribute::Property(property) = attribute {
            let (_, read) = self.read.iter().find(|(known, _)| *known == property)?;
            return Some(read.each_ref().map(|values| values.iter().copied().map(f64::from).collect()));
        }
        let quantity = attribute.quantity(self.up)?;
        Some([self.model.surfels.values(quantity), self.model.primitives.values(quantity)])
    }

    /// The distribution of an attribute's values; `None` if it has none or they are not read yet.
    pub fn distribution(&mut self, attribute: ColourAttribute) -> Option<Arc<Distribution>> {
        if let Some((_, known)) = self.distributions.iter().find(|(known, _)| *known == attribute) {
            return known.clone();
        }
        let [surfels, vertices] = self.values(attribute)?;
        let found = Distribution::of(surfels.iter().chain(&vertices).copied()).map(Arc::new);
        self.distributions.push((attribute, found.clone()));
        found
    }

    /// The default range of an attribute.
    fn default_range(&mut self, attribute: ColourAttribute) -> Option<ValueRange> {
        self.distribution(attribute).map(|distribution| distribution.range)
    }

    /// The appearance that the user wants, for [`Source::restore`].
    pub fn saved_appearance(&self) -> SavedAppearance {
        let appearance = self.wanted;
        if let Some((name, range)) = &self.missing {
            return SavedAppearance { appearance, property: Some(name.clone()), range: *range };
        }
        let (attribute, range) = match &self.reading {
            Some(Reading { property, range, .. }) => (ColourAttribute::Property(*property), *range),
            None => (self.wanted.attribute, self.chosen_range()),
        };
        let is_property = matches!(attribute, ColourAttribute::Property(_));
        let property = is_property.then(|| self.name(attribute).to_owned());
        SavedAppearance { appearance: Appearance { attribute, ..appearance }, property, range }
    }

    /// The range of the colours, if it is not the default one.
    fn chosen_range(&self) -> Option<ValueRange> {
        let Appearance { attribute, range, .. } = self.wanted;
        let known = self.distributions.iter().find(|(known, _)| *known == attribute);
        let default = known.and_then(|(_, known)| known.as_ref()).map(|known| known.range);
        (self.wanted.scale().is_some() && default != Some(range)).then_some(range)
    }

    /// Restores the appearance of another state of the scene. Properties of the files are read again; a state that lacks the property, such as a
    /// preview, has the points' own colours.
    pub fn restore(&mut self, SavedAppearance { appearance, property, range }: &SavedAppearance) {
        self.wanted = Appearance { attribute: ColourAttribute::Own, ..*appearance };
        let Some(name) = property else { return self.set_attribute(appearance.attribute, *range) };
        let property = self.property_names().iter().position(|known| known == name);
        match (property, &mut self.reading) {
            (Some(property), Some(reading)) if reading.property == property => reading.range = *range,
            (Some(property), _) => self.set_attribute(ColourAttribute::Property(property), *range),
            (None, _) => (self.reading, self.missing) = (None, Some((name.clone(), *range))),
        }
    }

    /// A copy for another thread, without the property that is being read.
    pub fn snapshot(&self) -> Self {
        Self {
            extent: self.extent.clone(),
            model: self.model.clone(),
            surface: self.surface.clone(),
            properties: self.properties.clone(),
            read: self.read.clone(),
            reading: None,
            missing: None,
            distributions: self.distributions.clone(),
            info: self.info.clone(),
            ..*self
        }
    }

    /// The model of a first scene, in the wanted appearance.
    pub fn begin(&mut self) -> Arc<Model> {
        self.applied = self.wanted;
        self.visible_model()
    }

    /// Applies the wanted appearance to the scene; returns whether that changed it. After an error scene and appearance are as before.
    pub fn apply(&mut self, scene: &mut Arc<Scene>, device: &Arc<Device>) -> Result<bool> {
        self.take_property()?;
        let (old, new) = (self.applied, self.wanted);
        if new == old {
            return Ok(false);
        }
        self.applied = new;
        let applied = self.update(scene, device, old);
        if applied.is_err() {
            (self.applied, self.wanted) = (old, old);
        }
        applied.map(|()| true)
    }

    /// Updates the scene from the appearance `old` to the applied one.
    fn update(&self, scene: &mut Arc<Scene>, device: &Arc<Device>, old: Appearance) -> Result<()> {
        let new = self.applied;
        if scene.level_table().is_some() || scene.streams().layout.is_quantized() {
            // Its levels of detail would not follow, and quantized surfels do not change.
            *scene = Arc::new(self.upload(device)?);
            return Ok(());
        }
        if (Appearance { radius_scale: old.radius_scale, ..new }) != old {
            let colours = self.colours();
            let same = scene.colour_stream() == ColourStream::Srgb8 && !scene.streams().primitives.any();
            if !(same && matches!(colours, Some(Colours::Srgb8(_)))) {
                // Colours of another format need another scene.
                *scene = Arc::new(self.upload(device)?);
                return Ok(());
            }
            scene.update(0, &Changes { colours: colours.as_ref(), ..Default::default() })?;
        }
        if new.radius_scale != old.radius_scale {
            let radii = self.radii();
            let two_sided = self.model.surfels.two_sided.as_deref();
            scene.update(0, &Changes { radii: Some(&radii), two_sided, ..Default::default() })?;
        }
        Ok(())
    }

    /// A new scene without levels of detail under the applied appearance.
    fn upload(&self, device: &Arc<Device>) -> Result<Scene> {
        Scene::upload(device, Parts { format: self.format, ..(&*self.visible_model()).into() })
    }

    /// Radii of the surfels under the applied appearance.
    fn radii(&self) -> Vec<f32> {
        self.model.surfels.radii.par_iter().map(|radius| radius * self.applied.radius_scale).collect()
    }

    /// Colours of the surfels under the applied appearance.
    fn colours(&self) -> Option<Colours> {
        let surfels = &self.model.surfels;
        if let Some((scale, [values, _])) = self.applied.scale().zip(self.values(self.applied.attribute)) {
            return Some(scale.colours(values.into_par_iter()));
        }
        if self.applied.attribute == ColourAttribute::Normal {
            let mut alone = Surfels { normals: surfels.normals.clone(), ..Default::default() };
            alone.colour_by_normals();
            return alone.colours;
        }
        surfels.colours.clone()
    }

    /// The model with the applied appearance.
    pub fn visible_model(&self) -> Arc<Model> {
        let Appearance { attribute, radius_scale, .. } = self.applied;
        if attribute == ColourAttribute::Own && radius_scale == 1.0 {
            return self.model.clone();
        }
        let mut model = Model::clone(&self.model);
        model.surfels.radii = self.radii();
        if attribute != ColourAttribute::Own {
            model.surfels.texture = None;
            model.surfels.colours = self.colours();
        }
        match self.applied.scale().zip(self.values(attribute)) {
            Some((scale, [_, values])) => model.primitives.colour_by_values(&values, &scale),
            None if attribute == ColourAttribute::Normal => model.primitives.colour_by_directions(),
            None => {}
        }
        Arc::new(model)
    }
}

#[cfg(test)]
mod tests;
