//! Built-in scenes, named like `scene:bumpy-sphere?points=100000&seed=1`.

pub mod bumpy_sphere;

use crate::error::{Error, Result};
use crate::geometry::Surfels;

/// What a scene's name begins with.
const PREFIX: &str = "scene:";
/// Most points of a scene: what a large machine's memory holds.
const MOST_POINTS: u32 = 100_000_000;

/// A built-in scene, for help texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene {
    /// Name, `scene:` included.
    pub name: &'static str,
    /// What it shows.
    pub summary: &'static str,
    /// Its parameters, as they stand after `?`, with their defaults.
    pub parameters: &'static str,
}

/// Every built-in scene.
pub fn list() -> &'static [Scene] {
    &[Scene {
        name: "scene:bumpy-sphere",
        summary: "a sphere of radius 1 with bumps, in checker colours",
        parameters: "points=100000&seed=1",
    }]
}

/// Whether `text` is meant as a built-in scene rather than a file.
pub fn is_scene(text: &str) -> bool {
    text.starts_with(PREFIX)
}

/// Makes the surfels of a scene, in Morton order: `scene:<name>`, then optionally `?` and `parameter=value` pairs between `&`.
///
/// # Errors
/// [`Error::Usage`], which lists what exists, if the scene, a parameter or a value is none.
pub fn open(text: &str) -> Result<Surfels> {
    let (name, query) = text.split_once('?').unwrap_or((text, ""));
    if name != "scene:bumpy-sphere" {
        let all: Vec<_> = list().iter().map(|scene| format!("{}?{}", scene.name, scene.parameters)).collect();
        return Err(Error::Usage(format!("{text}: there is no such scene: give {}", all.join(" or "))));
    }
    let (points, seed) = parameters(text, query)?;
    let mut surfels = bumpy_sphere::sample(points, seed);
    surfels.sort_morton();
    Ok(surfels)
}

/// `points` and `seed`.
fn parameters(text: &str, query: &str) -> Result<(u32, u64)> {
    let usage = |cause: String| Error::Usage(format!("{text}: {cause}"));
    let (mut points, mut seed) = (None, None);
    for pair in query.split('&').filter(|pair| !pair.is_empty()) {
        let (key, value) = pair.split_once('=').unwrap_or((pair, ""));
        let slot = match key {
            "points" => &mut points,
            "seed" => &mut seed,
            _ => return Err(usage(format!("there is no parameter `{key}`: give points or seed"))),
        };
        let number: u64 = value
            .parse()
            .map_err(|_| usage(format!("{key} is `{value}`: give a whole number, 0 or more")))?;
        if slot.replace(number).is_some() {
            return Err(usage(format!("{key} is given twice: give it once")));
        }
    }
    let points = points.unwrap_or(100_000);
    match u32::try_from(points) {
        Ok(points @ 1..=MOST_POINTS) => Ok((points, seed.unwrap_or(1))),
        _ => Err(usage(format!("{points} points: give 1 to {MOST_POINTS}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_scene_opens_in_morton_order() {
        for scene in list() {
            assert!(is_scene(scene.name));
            let surfels = open(&format!("{}?points=1000&seed=5", scene.name)).unwrap();
            let mut sorted = surfels.clone();
            sorted.sort_morton();
            assert_eq!((surfels.len(), &sorted), (1000, &surfels));
            assert!(parameters("", scene.parameters).is_ok());
        }
        assert_eq!(parameters("", "").unwrap(), (100_000, 1));
        assert_eq!(parameters("", "seed=9&points=100000000").unwrap(), (100_000_000, 9));
        assert!(!is_scene("bunny.ply"));
    }

    #[test]
    fn mistakes_are_answered_with_what_exists() {
        for (text, expected) in [
            ("scene:teapot", "give scene:bumpy-sphere?points=100000&seed=1"),
            ("scene:bumpy-sphere?size=3", "no parameter `size`: give points or seed"),
            ("scene:bumpy-sphere?points=1e5", "points is `1e5`: give a whole number"),
            ("scene:bumpy-sphere?points", "points is ``"),
            ("scene:bumpy-sphere?seed=-1", "seed is `-1`"),
            ("scene:bumpy-sphere?points=0", "0 points: give 1 to 100000000"),
            ("scene:bumpy-sphere?points=100000001", "100000001 points"),
            ("scene:bumpy-sphere?points=1&points=2", "points is given twice"),
        ] {
            let error = open(text).unwrap_err();
            assert!(
                matches!(&error, Error::Usage(cause) if cause.starts_with(text) && cause.contains(expected)),
                "{error}"
            );
        }
    }
}
