//! What a scene was made of, and what is changed of it since: colours, radii.

use super::about::About;
use super::job::Job;
use super::{ColourBy, Loaded, Numbers};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;
use surfel::geometry::{ColourMap, ColourScale, Colours, Model, Quantity, Surfels, ValueRange};
use surfel::scene::{Changes, ColourStream};
use surfel::vk::Device;
use surfel::{Error, Progress, Result, Scene};

/// What a scene was made of.
pub struct Source {
    /// As it was loaded.
    model: Arc<Model>,
    /// The built-in scene that it is, if that is known exactly.
    surface: Option<String>,
    /// What else is known of its points; of a preview nothing is.
    numbers: Option<Numbers>,
    /// Those that were read, of surfels and of vertices, each with its number among the names.
    read: Vec<(usize, [Vec<f32>; 2])>,
    /// Those that are being read.
    reading: Option<Reading>,
    /// What colours should be made of, and is not there: numbers of this name, and the range that is chosen for them.
    missing: Option<(String, Option<ValueRange>)>,
    /// What it is to be.
    pub changed: Changed,
    /// What the scene is.
    applied: Changed,
    /// The usual range of each quantity that was looked at.
    usual: Vec<(By, Option<ValueRange>)>,
    about: About,
    /// What is up in the world, a unit vector.
    up: DVec3,
}

/// Numbers that are being read.
struct Reading {
    /// Which, by their place among the names.
    number: usize,
    job: Job<[Vec<f32>; 2]>,
    /// The range that hands have chosen for them.
    range: Option<ValueRange>,
}

/// What is changed of a scene, for another state of it to be changed alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    changed: Changed,
    /// The name of the file's numbers that surfels are coloured by.
    number: Option<String>,
    /// The range, where hands have chosen it.
    range: Option<ValueRange>,
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
    Height,
    Radius,
    Normal,
    /// Numbers of the file, by their place among the names.
    Number(usize),
}

impl By {
    /// All that every scene has, with what they are called and what they mean.
    pub const ALL: [(Self, &'static str, &'static str); 7] = [
        (Self::Own, "own", "the points' own colours; grey where they have none"),
        (Self::X, "x", "the place along x, in the positions' unit"),
        (Self::Y, "y", "the place along y, in the positions' unit"),
        (Self::Z, "z", "the place along z, in the positions' unit"),
        (Self::Height, "height", "the place along what --up says, y otherwise, in the positions' unit"),
        (Self::Radius, "radius", "the disc's radius, in the positions' unit"),
        (Self::Normal, "normal", "the normal: x, y, z from −1 to 1 as red, green, blue"),
    ];

    fn quantity(self, up: DVec3) -> Option<Quantity> {
        match self {
            Self::Height => Some(Quantity::Along(up)),
            Self::X => Some(Quantity::Along(DVec3::X)),
            Self::Y => Some(Quantity::Along(DVec3::Y)),
            Self::Z => Some(Quantity::Along(DVec3::Z)),
            Self::Radius => Some(Quantity::Radius),
            Self::Own | Self::Normal | Self::Number(_) => None,
        }
    }
}

impl Changed {
    /// The scale of the colours, where they show numbers.
    pub fn scale(&self) -> Option<ColourScale> {
        let shows = !matches!(self.by, By::Own | By::Normal);
        shows.then_some(ColourScale { map: self.map, range: self.range })
    }
}

impl Source {
    /// Of what was loaded.
    pub fn new(Loaded { model, surface, numbers, colour_by, about, up, method: _ }: Loaded) -> Self {
        let range = ValueRange { min: 0.0, max: 1.0 };
        let own = Changed { by: By::Own, map: ColourMap::default(), range, radii: 1.0 };
        let mut source = Self {
            model: Arc::new(model),
            surface,
            numbers,
            read: Vec::new(),
            reading: None,
            missing: None,
            changed: own,
            applied: own,
            usual: Vec::new(),
            about,
            up,
        };
        if let Some(colour_by) = colour_by {
            source.colour_as(colour_by);
        }
        source
    }

    /// Colours as is asked for: by numbers of the file where the name is none that every scene has.
    fn colour_as(&mut self, ColourBy { name, map, range }: ColourBy) {
        self.changed.map = map;
        let own = By::ALL.iter().find(|(_, own, _)| *own == name).map(|(by, ..)| *by);
        let by = match (own, &mut self.numbers) {
            (Some(by), _) => by,
            (None, None) => {
                self.missing = Some((name, range));
                return;
            }
            (None, Some(Numbers { names, .. })) => {
                let known = names.iter().position(|known| *known == name);
                By::Number(known.unwrap_or_else(|| {
                    // Something was made of them, or they are not there, which reading them says.
                    names.push(name);
                    names.len() - 1
                }))
            }
        };
        self.colour_within(by, range);
    }

    /// What is known of it.
    pub fn about(&self) -> &About {
        &self.about
    }

    /// The built-in scene whose surface the picture should show.
    pub fn surface(&self) -> Option<&str> {
        self.surface.as_deref().filter(|_| self.applied.by == By::Own)
    }

    /// Whether radii can be scaled: weights would stay those of the discs as they were.
    pub fn has_fixed_radii(&self) -> bool {
        self.model.surfels.weights.is_some() || self.model.surfels.is_empty()
    }

    /// Names of the file's numbers.
    pub fn names(&self) -> &[String] {
        self.numbers.as_ref().map_or(&[], |numbers| &numbers.names)
    }

    /// What colours are made of is called.
    pub fn name(&self, by: By) -> &str {
        match by {
            By::Number(number) => self.names().get(number).map_or("", String::as_str),
            _ => By::ALL.iter().find(|(known, ..)| *known == by).map_or("", |(_, name, _)| name),
        }
    }

    /// Colours by this from now on, in its usual range; by numbers of the file once they are read.
    pub fn colour_by(&mut self, by: By) {
        self.colour_within(by, None);
    }

    /// The same within a range, if one is chosen.
    fn colour_within(&mut self, by: By, range: Option<ValueRange>) {
        (self.reading, self.missing) = (None, None);
        if let By::Number(number) = by
            && !self.read.iter().any(|(known, _)| *known == number)
            && let Some(numbers) = &self.numbers
        {
            let (read, name) = (numbers.read.clone(), self.name(by).to_owned());
            let job = Job::start(move |progress: &dyn Progress| read(&name, progress));
            self.reading = Some(Reading { number, job, range });
            return;
        }
        self.changed.by = by;
        if let Some(range) = range.or_else(|| self.usual(by)) {
            self.changed.range = range;
        }
    }

    /// A stage of what is being read, and how much of it is done.
    pub fn reading(&self) -> Option<(&'static str, f32)> {
        self.reading.as_ref().map(|reading| reading.job.at())
    }

    /// Takes what was read, and colours by it.
    fn take(&mut self) -> Result<()> {
        let Some(Reading { number, job, range }) = &mut self.reading else { return Ok(()) };
        let (number, range, Some(outcome)) = (*number, *range, job.take()) else { return Ok(()) };
        self.reading = None;
        let read = match outcome {
            Ok(read) => read,
            Err(error) => {
                // A name that was asked for, and is none of the file's, is the last one.
                let last = self.numbers.as_mut().filter(|numbers| number + 1 == numbers.names.len());
                last.map(|numbers| numbers.names.pop());
                return Err(error);
            }
        };
        let (surfels, vertices) = (self.model.surfels.len(), self.model.primitives.positions.len());
        if read.each_ref().map(Vec::len) != [surfels, vertices] {
            return Err(Error::Usage("the file has changed since it was loaded: load it anew".into()));
        }
        self.read.push((number, read));
        self.colour_within(By::Number(number), range);
        Ok(())
    }

    /// The numbers that colours are made of, of surfels and of vertices; none where they are made of none.
    fn values(&self, by: By) -> Option<[Vec<f64>; 2]> {
        if let By::Number(number) = by {
            let (_, read) = self.read.iter().find(|(known, _)| *known == number)?;
            return Some(read.each_ref().map(|numbers| numbers.iter().copied().map(f64::from).collect()));
        }
        let quantity = by.quantity(self.up)?;
        Some([self.model.surfels.values(quantity), self.model.primitives.values(quantity)])
    }

    /// From the 1st to the 99th percentile of what colours are made of.
    pub fn usual(&mut self, by: By) -> Option<ValueRange> {
        if let Some((_, known)) = self.usual.iter().find(|(known, _)| *known == by) {
            return *known;
        }
        let [surfels, vertices] = self.values(by)?;
        let range = ValueRange::of(surfels.into_iter().chain(vertices)).map(|(range, _)| range);
        self.usual.push((by, range));
        range
    }

    /// What is changed of it, and is to be once it is read.
    pub fn wish(&self) -> Wish {
        if let Some((name, range)) = &self.missing {
            return Wish { changed: self.changed, number: Some(name.clone()), range: *range };
        }
        let (by, range) = match &self.reading {
            Some(Reading { number, range, .. }) => (By::Number(*number), *range),
            None => (self.changed.by, self.chosen_range()),
        };
        let number = matches!(by, By::Number(_)).then(|| self.name(by).to_owned());
        Wish { changed: Changed { by, ..self.changed }, number, range }
    }

    /// The range of the colours, where it is not the usual one.
    fn chosen_range(&self) -> Option<ValueRange> {
        let Changed { by, range, .. } = self.changed;
        let usual = self.usual.iter().find(|(known, _)| *known == by).and_then(|(_, usual)| *usual);
        (self.changed.scale().is_some() && usual != Some(range)).then_some(range)
    }

    /// Changes as much as another state of the scene was changed. Numbers of the file are read anew; where it has none of the name, as a preview
    /// has not, colours are the points' own.
    pub fn change_as(&mut self, Wish { changed, number, range }: &Wish) {
        self.changed = Changed { by: By::Own, ..*changed };
        let Some(name) = number else { return self.colour_within(changed.by, *range) };
        let number = self.names().iter().position(|known| known == name);
        match (number, &mut self.reading) {
            (Some(number), Some(reading)) if reading.number == number => reading.range = *range,
            (Some(number), _) => self.colour_within(By::Number(number), *range),
            (None, _) => (self.reading, self.missing) = (None, Some((name.clone(), *range))),
        }
    }

    /// As it is now, for another thread; nothing is being read.
    pub fn snapshot(&self) -> Self {
        Self {
            model: self.model.clone(),
            surface: self.surface.clone(),
            numbers: self.numbers.clone(),
            read: self.read.clone(),
            reading: None,
            missing: None,
            usual: self.usual.clone(),
            about: self.about.clone(),
            ..*self
        }
    }

    /// Makes the scene what it is to be; whether it was not. After an error all is as before.
    pub fn apply(&mut self, scene: &mut Arc<Scene>, device: &Arc<Device>) -> Result<bool> {
        self.take()?;
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
        if let Some((scale, [values, _])) = self.applied.scale().zip(self.values(self.applied.by)) {
            return Some(scale.colours(values.into_par_iter()));
        }
        if self.applied.by == By::Normal {
            let mut alone = Surfels { normals: surfels.normals.clone(), ..Default::default() };
            alone.colour_by_normals();
            return alone.colours;
        }
        surfels.colours.clone()
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
        match self.applied.scale().zip(self.values(by)) {
            Some((scale, [_, values])) => model.primitives.colour_by_values(&values, &scale),
            None if by == By::Normal => model.primitives.colour_by_directions(),
            None => {}
        }
        Arc::new(model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use surfel::settings::methods::Method;

    /// Three points in a row with numbers of the file.
    fn source(read: [Vec<f32>; 2]) -> Source {
        source_of("heat", read)
    }

    fn source_of(name: &str, read: [Vec<f32>; 2]) -> Source {
        let surfels = Surfels {
            positions: [0.0, 1.0, 2.0].map(|x| Vec3::new(x, 0.0, 0.0)).to_vec(),
            normals: vec![Vec3::Z; 3],
            radii: vec![0.5; 3],
            ..Default::default()
        };
        let model = Model { surfels, ..Default::default() };
        let read = Arc::new(move |_: &str, _: &dyn Progress| Ok(read.clone()));
        let numbers = Some(Numbers { names: vec![name.into()], read });
        Source::new(Loaded {
            surface: Some("scene:none".into()),
            numbers,
            ..Loaded::new(model, Method::ALL[0])
        })
    }

    fn wait(source: &mut Source) -> Result<()> {
        while source.reading.is_some() {
            source.take()?;
        }
        Ok(())
    }

    #[test]
    fn points_are_coloured_by_places_and_by_numbers_of_the_file() {
        let mut source = source([vec![5.0, f32::NAN, 7.0], vec![]]);
        source.colour_by(By::X);
        source.applied = source.changed;
        assert_eq!(source.changed.range, ValueRange { min: 0.0, max: 2.0 });
        let map = ColourMap::default();
        let codes = |parts: [Option<f64>; 3]| {
            let code = |part: Option<f64>| part.map_or([128; 3], |part| map.at(part));
            Some(Colours::Srgb8(parts.map(code).map(|[r, g, b]| [r, g, b, 0]).to_vec()))
        };
        assert_eq!(source.shown().surfels.colours, codes([Some(0.0), Some(0.5), Some(1.0)]));
        assert_eq!(source.surface(), None, "its colours are not the surface's");
        source.colour_by(By::Number(0));
        wait(&mut source).unwrap();
        source.applied = source.changed;
        assert_eq!(source.name(source.changed.by), "heat");
        assert_eq!(source.shown().surfels.colours, codes([Some(0.0), None, Some(1.0)]));
        source.colour_by(By::Own);
        source.applied = source.changed;
        assert_eq!(source.shown().surfels.colours, None);
        assert_eq!(source.surface(), Some("scene:none"));
    }

    #[test]
    fn numbers_of_another_file_are_refused() {
        let mut source = source([vec![1.0; 4], vec![]]);
        source.colour_by(By::Number(0));
        assert!(wait(&mut source).unwrap_err().to_string().contains("changed"));
        assert_eq!(source.changed.by, By::Own);
    }

    #[test]
    fn a_range_that_the_user_chose_applies_to_the_next_state() {
        let range = |min, max| ValueRange { min, max };
        let next = |wish: &Wish| {
            let mut next = source([vec![1.0, 2.0, 9.0], vec![]]);
            next.change_as(wish);
            wait(&mut next).unwrap();
            next.changed
        };
        for by in [By::Number(0), By::X] {
            let mut old = source([vec![5.0, 6.0, 7.0], vec![]]);
            old.colour_by(by);
            let reading = old.wish();
            wait(&mut old).unwrap();
            old.changed.map = ColourMap::Turbo;
            let usual = next(&old.wish());
            assert_eq!((usual.by, usual.map), (by, ColourMap::Turbo));
            let expected = if by == By::X { range(0.0, 2.0) } else { range(1.0, 9.0) };
            assert_eq!(usual.range, expected, "of the numbers as they are now");
            assert_eq!(next(&reading).by, by, "what was being read is read anew");
            old.changed.range = range(-3.0, 4.0);
            assert_eq!(next(&old.wish()).range, range(-3.0, 4.0));
            // Changed twice before it could be read, or with a state between that has no such numbers.
            for name in ["heat", "cold"] {
                let mut between = source_of(name, [vec![1.0, 2.0, 9.0], vec![]]);
                between.change_as(&old.wish());
                assert!(name == "heat" || by == By::X || between.changed.by == By::Own);
                assert_eq!(next(&between.wish()), Changed { by, ..old.changed });
            }
        }
    }

    #[test]
    fn what_is_chosen_last_is_what_colours_are_made_of() {
        let mut source = source([vec![5.0, 6.0, 7.0], vec![]]);
        source.colour_by(By::Number(0));
        source.colour_by(By::Y);
        wait(&mut source).unwrap();
        assert_eq!(source.changed.by, By::Y);
    }

    #[test]
    fn radii_are_scaled_of_what_is_shown_alone() {
        let mut source = source([vec![], vec![]]);
        source.changed.radii = 3.0;
        source.applied = source.changed;
        assert_eq!(source.shown().surfels.radii, [1.5; 3]);
        assert_eq!(source.model.surfels.radii, [0.5; 3]);
    }
}
