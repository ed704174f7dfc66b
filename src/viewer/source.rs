//! What a scene was made of, and what is changed of it since: colours, radii.

use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;
use surfel::geometry::{ColourMap, ColourScale, Colours, Model, Quantity, Surfels, ValueRange};
use surfel::scene::{Changes, ColourStream};
use surfel::vk::Device;
use surfel::{Result, Scene};

/// What a scene was made of.
#[derive(Clone)]
pub struct Source {
    /// As it was loaded.
    model: Arc<Model>,
    /// The built-in scene that it is, if that is known exactly.
    surface: Option<String>,
    /// What it is to be.
    pub changed: Changed,
    /// What the scene is.
    applied: Changed,
    /// The usual range of each quantity that was looked at.
    usual: Vec<(By, Option<ValueRange>)>,
}

/// What is changed of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Changed {
    pub by: By,
    pub map: ColourMap,
    /// The numbers at both ends of the colours.
    pub range: ValueRange,
    /// Factor of every surfel's radius.
    pub radii: f32,
}

/// What surfels are coloured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    Own,
    X,
    Y,
    Z,
    Radius,
    Normal,
}

impl By {
    /// All of them, with what they are called and what they mean.
    pub const ALL: [(Self, &'static str, &'static str); 6] = [
        (Self::Own, "own", "the points' own colours; grey where they have none"),
        (Self::X, "x", "the place along x, in the positions' unit"),
        (Self::Y, "y", "the place along y, in the positions' unit"),
        (Self::Z, "z", "the place along z, in the positions' unit"),
        (Self::Radius, "radius", "the disc's radius, in the positions' unit"),
        (Self::Normal, "normal", "the normal: x, y, z from −1 to 1 as red, green, blue"),
    ];

    fn quantity(self) -> Option<Quantity> {
        match self {
            Self::X => Some(Quantity::Along(DVec3::X)),
            Self::Y => Some(Quantity::Along(DVec3::Y)),
            Self::Z => Some(Quantity::Along(DVec3::Z)),
            Self::Radius => Some(Quantity::Radius),
            Self::Own | Self::Normal => None,
        }
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(by, ..)| *by == self).map_or("", |(_, name, _)| name)
    }
}

impl Changed {
    /// The scale of the colours, where they show numbers.
    pub fn scale(&self) -> Option<ColourScale> {
        self.by.quantity().map(|_| ColourScale { map: self.map, range: self.range })
    }
}

impl Source {
    /// Of a model as it was loaded.
    pub fn new(model: Model, surface: Option<String>) -> Self {
        let range = ValueRange { min: 0.0, max: 1.0 };
        let own = Changed { by: By::Own, map: ColourMap::default(), range, radii: 1.0 };
        Self { model: Arc::new(model), surface, changed: own, applied: own, usual: Vec::new() }
    }

    /// The built-in scene whose surface the picture should show.
    pub fn surface(&self) -> Option<&str> {
        self.surface.as_deref().filter(|_| self.applied.by == By::Own)
    }

    /// Whether radii can be scaled: weights and clip lines would stay those of the discs as they were.
    pub fn has_fixed_radii(&self) -> bool {
        self.model.surfels.weights.is_some() || self.model.surfels.is_empty()
    }

    /// Colours by this from now on, in its usual range.
    pub fn colour_by(&mut self, by: By) {
        self.changed.by = by;
        if let Some(range) = self.usual(by) {
            self.changed.range = range;
        }
    }

    /// From the 1st to the 99th percentile of a quantity.
    pub fn usual(&mut self, by: By) -> Option<ValueRange> {
        let quantity = by.quantity()?;
        if let Some((_, known)) = self.usual.iter().find(|(known, _)| *known == by) {
            return *known;
        }
        let (surfels, primitives) = (&self.model.surfels, &self.model.primitives);
        let values = surfels.values(quantity).into_iter().chain(primitives.values(quantity));
        let range = ValueRange::of(values).map(|(range, _)| range);
        self.usual.push((by, range));
        range
    }

    /// Makes the scene what it is to be; whether it was not. After an error all is as before.
    pub fn apply(&mut self, scene: &mut Arc<Scene>, device: &Arc<Device>) -> Result<bool> {
        let (old, new) = (self.applied, self.changed);
        if new == old {
            return Ok(false);
        }
        self.applied = new;
        let applied = self.write(scene, device, old);
        if applied.is_err() {
            (self.applied, self.changed) = (old, old);
        }
        applied.map(|()| true)
    }

    fn write(&self, scene: &mut Arc<Scene>, device: &Arc<Device>, old: Changed) -> Result<()> {
        let new = self.applied;
        if (Changed { radii: old.radii, ..new }) != old {
            let colours = self.colours();
            let same = scene.colour_stream() == ColourStream::Srgb8 && !scene.streams().primitives.any();
            if !(same && matches!(colours, Some(Colours::Srgb8(_)))) {
                // Another kind of colours makes another scene.
                *scene = Arc::new(Scene::upload(device, &*self.shown())?);
                return Ok(());
            }
            scene.update(0, &Changes { colours: colours.as_ref(), ..Default::default() })?;
        }
        if new.radii != old.radii {
            let radii = self.radii();
            let two_sided = self.model.surfels.two_sided.as_deref();
            scene.update(0, &Changes { radii: Some(&radii), two_sided, ..Default::default() })?;
        }
        Ok(())
    }

    fn radii(&self) -> Vec<f32> {
        self.model.surfels.radii.par_iter().map(|radius| radius * self.applied.radii).collect()
    }

    /// The surfels' colours.
    fn colours(&self) -> Option<Colours> {
        let surfels = &self.model.surfels;
        match (self.applied.by.quantity(), self.applied.by) {
            (Some(quantity), _) => {
                let scale = ColourScale { map: self.applied.map, range: self.applied.range };
                Some(scale.colours(surfels.values(quantity).into_par_iter()))
            }
            (None, By::Normal) => {
                let mut alone = Surfels { normals: surfels.normals.clone(), ..Default::default() };
                alone.colour_by_normals();
                alone.colours
            }
            (None, _) => surfels.colours.clone(),
        }
    }

    /// The model as the scene shows it.
    pub fn shown(&self) -> Arc<Model> {
        let Changed { by, radii, .. } = self.applied;
        if by == By::Own && radii == 1.0 {
            return self.model.clone();
        }
        let mut model = Model::clone(&self.model);
        model.surfels.radii = self.radii();
        if by != By::Own {
            model.surfels.texture = None;
            model.surfels.colours = self.colours();
        }
        match self.applied.scale().zip(by.quantity()) {
            Some((scale, quantity)) => {
                let values = model.primitives.values(quantity);
                model.primitives.colour_by_values(&values, &scale);
            }
            None if by == By::Normal => model.primitives.colour_by_directions(),
            None => {}
        }
        Arc::new(model)
    }
}
