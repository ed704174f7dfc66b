//! The resulting cloud.

use super::Lined;
use super::branch::Tubes;
use super::leaf::Row;
use super::weld::Welded;
use crate::error::Result;
use crate::geometry::srgb;
use crate::geometry::{Cloud, Colours};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// New vertices and the kept parts of a cloud.
pub(super) struct LineCloud<'a> {
    cloud: &'a Cloud,
    new: Cloud,
    /// The points from which each new vertex takes its colour and material.
    sources: Vec<Vec<u32>>,
    /// Kept triangles of [`Welded`], as points.
    kept: Vec<[u32; 3]>,
    welded: &'a Welded,
}

impl<'a> LineCloud<'a> {
    pub fn new(cloud: &'a Cloud, welded: &'a Welded) -> Self {
        let new = Cloud {
            origin: cloud.origin,
            view: cloud.view,
            normals: Some(vec![]),
            radii: Some(vec![]),
            ..Default::default()
        };
        Self { cloud, new, sources: Vec::new(), kept: Vec::new(), welded }
    }

    /// Adds a ribbon; returns the number of its segments.
    pub fn ribbon(&mut self, rows: &[Row], component: &[u32]) -> u64 {
        let first = self.new.len() as u32;
        let points = self.points(component);
        for row in rows {
            self.vertex(row.centre, row.normal.as_vec3(), row.radius, &row.places, &points);
        }
        let last = self.new.len() as u32 - 1;
        self.new.ribbons.extend((first..last).map(|i| [i, i + 1]));
        u64::from(last - first)
    }

    /// Adds tubes; returns the number of their segments.
    pub fn tubes(&mut self, tubes: &Tubes, component: &[u32]) -> u64 {
        let points = self.points(component);
        let mut place = HashMap::new();
        for ends in &tubes.segments {
            let ends = ends.map(|i| {
                *place.entry(i).or_insert_with(|| {
                    let ring = &tubes.rings[i as usize];
                    self.vertex(ring.centre, Vec3::ZERO, ring.radius, &ring.places, &points)
                })
            });
            self.new.tubes.push(ends);
        }
        tubes.segments.len() as u64
    }

    /// Keeps triangles.
    pub fn keep(&mut self, triangles: &[u32]) {
        self.kept.extend(triangles.iter().map(|&i| self.welded.points[i as usize]));
    }

    /// A point of the component at each of its places.
    fn points(&self, component: &[u32]) -> HashMap<u32, u32> {
        let corners = component.iter().flat_map(|&i| {
            let i = i as usize;
            self.welded.triangles[i].into_iter().zip(self.welded.points[i])
        });
        corners.collect()
    }

    fn vertex(
        &mut self,
        at: DVec3,
        normal: Vec3,
        radius: f64,
        places: &[u32],
        points: &HashMap<u32, u32>,
    ) -> u32 {
        self.new.positions.push(at.as_vec3());
        self.new.normals.get_or_insert_default().push(normal);
        self.new.radii.get_or_insert_default().push(radius as f32);
        self.sources.push(places.iter().filter_map(|place| points.get(place)).copied().collect());
        self.new.len() as u32 - 1
    }

    /// The kept points, followed by the new ones.
    pub fn finish(self, lined: &mut Lined) -> Result<Cloud> {
        let Self { cloud, mut new, sources, kept, .. } = self;
        new.colours = cloud.colours.as_ref().map(|colours| means(colours, &sources));
        let materials = cloud.materials.as_ref();
        new.materials =
            materials.map(|materials| materials.of_groups(sources.iter().map(|group| group.iter().copied())));
        let mut was = vec![false; cloud.len()];
        cloud.triangles.iter().flatten().for_each(|&i| was[i as usize] = true);
        lined.vertices[0] = was.iter().filter(|was| **was).count() as u64;
        let mut used: Vec<bool> = was.iter().map(|was| !was).collect();
        let lines = cloud.ribbons.iter().chain(&cloud.tubes).flatten();
        lines.chain(kept.iter().flatten()).for_each(|&i| used[i as usize] = true);
        let staying: Vec<u32> = (0..cloud.len() as u32).filter(|&i| used[i as usize]).collect();
        lined.vertices[1] = (0..cloud.len()).filter(|&i| used[i] && was[i]).count() as u64 + new.len() as u64;
        let old = Cloud { triangles: kept, face_textures: None, ..cloud.clone() }.part(&staying);
        // Both have colours, or neither has.
        Cloud::merge(vec![old, new], [0.0; 3])
    }
}

/// The mean colour of each group, in linear light.
fn means(colours: &Colours, groups: &[Vec<u32>]) -> Colours {
    let mean = |group: &Vec<u32>| {
        let sum: DVec3 = group.iter().map(|&i| colours.light(i as usize)).sum();
        (sum / group.len().max(1) as f64).to_array()
    };
    match colours {
        Colours::Linear(_) => {
            Colours::Linear(groups.iter().map(|group| mean(group).map(|value| value as f32)).collect())
        }
        Colours::Srgb8(_) => {
            let code = |group: &Vec<u32>| {
                let [r, g, b] = mean(group).map(|value| srgb::encode8(value as f32));
                [r, g, b, 0]
            };
            Colours::Srgb8(groups.iter().map(code).collect())
        }
    }
}
