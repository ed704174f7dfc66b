//! Distinct scenes of a frame: a scene that is placed several times has its resources once.

use crate::scene::Scene;
use crate::scene::instance::Placed;
use std::collections::HashMap;

/// The distinct scenes of a frame, in the order of their first instances.
#[derive(Default)]
pub struct Distinct<'a> {
    /// The scenes.
    pub scenes: Vec<&'a Scene>,
    /// Of each scene, the frame's indices of its instances.
    pub instances: Vec<Vec<usize>>,
    /// Of each instance of the frame: index of its scene, and its index among that scene's instances.
    pub placements: Vec<[usize; 2]>,
}

impl<'a> Distinct<'a> {
    /// The distinct ones of these scenes.
    pub fn new(placed: &[Placed<'a>]) -> Self {
        let mut all = Self::default();
        let mut known = HashMap::new();
        for (i, Placed { scene, .. }) in placed.iter().enumerate() {
            let index = *known.entry(scene.id).or_insert(all.scenes.len());
            if index == all.scenes.len() {
                all.scenes.push(scene);
                all.instances.push(Vec::new());
            }
            all.placements.push([index, all.instances[index].len()]);
            all.instances[index].push(i);
        }
        all
    }
}
