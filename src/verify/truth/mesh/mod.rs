//! Triangle meshes as exact surfaces.

mod albedo;
mod coarse;
mod normals;
pub(super) mod triangle;

use super::traceable::{Hit, Traceable};
use crate::error::{Error, Result};
use crate::geometry::{Bounds, Cloud};
use crate::verify::hierarchy::{Hierarchy, union};
use albedo::Albedo;
use glam::DVec3;
use rayon::prelude::*;
use xxhash_rust::xxh3::Xxh3;

/// A triangle mesh, visible from both sides. Normals, colours and texture coordinates are interpolated between the
/// corners. A point without a normal gets the mean of its triangles' normals, weighted by their angles. Materials and
/// lines of the cloud are left out.
pub struct Mesh {
    corners: Vec<DVec3>,
    normals: Vec<DVec3>,
    albedo: Albedo,
    triangles: Vec<[u32; 3]>,
    hierarchy: Hierarchy,
    bounds: Bounds,
}

impl Mesh {
    /// The triangles of a cloud: read it with [`ReadOptions::triangles`](crate::formats::ReadOptions).
    ///
    /// # Errors
    /// [`Error::Input`] with the name `name` if there are no triangles, or an index of a point that does not exist.
    pub fn new(name: &str, cloud: &Cloud) -> Result<Self> {
        let corners: Vec<_> = cloud.positions.par_iter().map(|p| cloud.origin + p.as_dvec3()).collect();
        let triangles = cloud.triangles.clone();
        if triangles.iter().flatten().any(|corner| *corner as usize >= corners.len()) {
            let cause = "a triangle has the index of a point that does not exist: export the mesh again";
            return Err(Error::input(name, cause));
        }
        let boxes = boxes(&corners, &triangles);
        let Some(bounds) = bounds(&boxes) else {
            return Err(Error::input(name, "no triangles: give a mesh, or a built-in scene"));
        };
        let normals = normals::fill(cloud, &corners);
        let albedo = Albedo::of(cloud);
        let hierarchy = Hierarchy::new(&boxes);
        Ok(Self { corners, normals, albedo, triangles, hierarchy, bounds })
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Always false: a mesh has triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The corners' indices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// A text that identifies the mesh.
    pub fn digest(&self) -> String {
        let mut hash = Xxh3::new();
        hash_vectors(&mut hash, &self.corners);
        hash_vectors(&mut hash, &self.normals);
        self.albedo.hash(&mut hash);
        self.triangles.iter().flatten().for_each(|corner| {
            hash.update(&corner.to_le_bytes());
        });
        format!("mesh:{:032x}", hash.digest128())
    }

    /// The plane's normal, for points where the corners' normals cancel.
    fn flat_normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.triangles[triangle].map(|corner| self.corners[corner as usize]);
        (b - a).cross(c - a).normalize_or(DVec3::Z)
    }
}

impl Traceable for Mesh {
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let length = direction.length();
        let direction = direction.try_normalize().filter(|_| origin.is_finite() && length.is_finite())?;
        let ray = triangle::Ray::new(origin, direction)?;
        let mut found = None;
        self.hierarchy.visit([origin, direction], f64::INFINITY, |index, limit| {
            let index = index as usize;
            let corners = self.triangles[index].map(|corner| self.corners[corner as usize]);
            match ray.meet(corners).filter(|(t, _)| *t < limit) {
                Some((t, weights)) => {
                    found = Some((t, index, weights));
                    t
                }
                None => limit,
            }
        });
        let (t, index, weights) = found?;
        let corners = self.triangles[index];
        let normal = mean(corners.map(|corner| self.normals[corner as usize]), weights).try_normalize();
        let normal = normal.unwrap_or_else(|| self.flat_normal(index));
        Some(Hit { t: t / length, normal, albedo: self.albedo.at(index, corners, weights) })
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }
}

/// Corners of the bounding box of each triangle.
fn boxes(corners: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[DVec3; 2]> {
    let of = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
        [a.min(b).min(c), a.max(b).max(c)]
    };
    triangles.par_iter().map(of).collect()
}

/// Bounds of all boxes; none without any.
fn bounds(boxes: &[[DVec3; 2]]) -> Option<Bounds> {
    boxes.iter().copied().reduce(union).map(|[min, max]| Bounds::of_box(min, max))
}

fn mean([a, b, c]: [DVec3; 3], weights: DVec3) -> DVec3 {
    weights.x * a + weights.y * b + weights.z * c
}

fn hash_vectors(hash: &mut Xxh3, all: &[DVec3]) {
    hash.update(&all.len().to_le_bytes());
    all.iter().flat_map(DVec3::to_array).for_each(|value| {
        hash.update(&value.to_le_bytes());
    });
}
