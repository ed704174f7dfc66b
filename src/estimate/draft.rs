//! Surfels with missing attributes.

use super::{Estimate, Estimated, NormalSource, Scanner, given_normals};
use crate::error::{Error, Result};
use crate::geometry::{Clips, Cloud, Ellipse, FaceTextures, Surfels, View, Viewpoints, Weights, morton};
use glam::Vec3;

/// Surfels whose missing normals and radii are 0, with the data to estimate them.
pub(super) struct Draft {
    pub surfels: Surfels,
    /// Triangles between the surfels.
    pub triangles: Vec<[u32; 3]>,
    /// Textures of the triangles.
    pub face_textures: Option<FaceTextures>,
    view: View,
    viewpoints: Option<Viewpoints>,
    pub estimated: Estimated,
}

impl Draft {
    /// A draft of the cloud; `how` may set the radius.
    pub fn new(cloud: Cloud, how: &Estimate) -> Result<Self> {
        let count = cloud.len();
        let surfels = Surfels {
            origin: cloud.origin,
            positions: cloud.positions,
            normals: cloud.normals.unwrap_or_else(|| vec![Vec3::ZERO; count]),
            radii: match how.radius {
                Some(radius) => vec![radius; count],
                None => cloud.radii.unwrap_or_else(|| vec![0.0; count]),
            },
            ellipses: cloud.ellipses,
            curvatures: cloud.curvatures,
            two_sided: cloud.two_sided,
            clips: cloud.clips,
            weights: cloud.weights,
            colours: cloud.colours,
            texture: cloud.texture,
            materials: cloud.materials,
            point_indices: cloud.point_indices,
        };
        surfels.check()?;
        if let Some(i) = surfels.positions.iter().position(|position| !position.is_finite()) {
            return Err(Error::Usage(format!(
                "point {i} is at {}: leave out points whose coordinates are not finite",
                surfels.positions[i]
            )));
        }
        if u32::try_from(count).is_err() {
            return Err(Error::Usage(format!("{count} points: give at most 2³² − 1")));
        }
        if let Some(triangle) =
            cloud.triangles.iter().find(|corners| corners.iter().any(|&i| i as usize >= count))
        {
            return Err(Error::Usage(format!(
                "triangle {triangle:?} has a corner that is none of the {count} points: count from 0"
            )));
        }
        if let Some(textures) = &cloud.face_textures {
            textures.check(cloud.triangles.len())?;
            if surfels.colours.is_none() {
                let text = "textures of triangles without colours of the points: give those of triangles that have none";
                return Err(Error::Usage(text.into()));
            }
        }
        let (view, viewpoints) = match how.scanner {
            Scanner::At(position) => (View::From((position - surfels.origin).as_vec3()), None),
            Scanner::Auto | Scanner::OfFile => (cloud.view, cloud.viewpoints),
        };
        Ok(Self {
            surfels,
            triangles: cloud.triangles,
            face_textures: cloud.face_textures,
            view,
            viewpoints: viewpoints.filter(|viewpoints| viewpoints.scans.len() == count),
            estimated: Estimated::default(),
        })
    }

    /// Where a surfel was seen from.
    pub fn view(&self, surfel: usize) -> View {
        self.viewpoints.as_ref().map_or(self.view, |viewpoints| viewpoints.view(surfel))
    }

    /// The views of all scans.
    pub fn views(&self) -> &[View] {
        self.viewpoints.as_ref().map_or(std::slice::from_ref(&self.view), |viewpoints| &viewpoints.views)
    }

    /// The scan of a surfel: an index of [`Draft::views`].
    pub fn scan(&self, surfel: usize) -> usize {
        self.viewpoints.as_ref().map_or(0, |viewpoints| usize::from(viewpoints.scans[surfel]))
    }

    /// Sets where all points were seen from.
    pub fn set_view(&mut self, view: View) {
        self.view = view;
    }

    /// Replaces the surfels by others, which have normals and radii.
    pub fn replace(&mut self, surfels: Surfels) {
        (self.surfels, self.triangles, self.viewpoints) = (surfels, Vec::new(), None);
        self.face_textures = None;
        self.sort_morton();
    }

    /// Sorts neighbours in space next to each other in memory.
    pub fn sort_morton(&mut self) {
        let order = morton::order(&self.surfels.positions);
        self.arrange(&order);
    }

    /// Removes all surfels but `kept`.
    pub fn keep(&mut self, kept: &[u32]) {
        self.estimated.outliers = (self.surfels.len() - kept.len()) as u64;
        if self.estimated.outliers > 0 {
            self.arrange(kept);
        }
    }

    /// Surfel `order[i]` becomes surfel `i`. Triangles with a removed corner are removed.
    fn arrange(&mut self, order: &[u32]) {
        if !self.triangles.is_empty() {
            let mut place = vec![None; self.surfels.len()];
            order.iter().zip(0..).for_each(|(&from, to)| place[from as usize] = Some(to));
            let moved = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|i| place[i as usize]);
                Some([a?, b?, c?])
            };
            if let Some(textures) = &mut self.face_textures {
                textures.keep(|i| moved(&self.triangles[i]).is_some());
            }
            self.triangles = self.triangles.iter().filter_map(moved).collect();
        }
        self.surfels.permute(order);
        let kept = || order.iter().map(|&from| from as usize);
        self.viewpoints = self.viewpoints.take().map(|viewpoints| viewpoints.gather(kept()));
    }

    /// Removes the given normals that are not wanted.
    pub fn reject_normals(&mut self, wanted: NormalSource) {
        match wanted {
            NormalSource::File => {}
            NormalSource::Estimate => drop(given_normals::remove(&mut self.surfels)),
            NormalSource::Auto if given_normals::contradict(&self.surfels) => {
                self.estimated.normals_contradictory = given_normals::remove(&mut self.surfels);
            }
            NormalSource::Auto => {}
        }
    }

    /// Counts the present normals and radii as given.
    pub fn count_given(&mut self) {
        let [normals, radii] = self.lacking();
        let count = self.surfels.len() as u64;
        (self.estimated.normals_given, self.estimated.radii_given) = (count - normals, count - radii);
    }

    /// Number of missing normals and radii.
    fn lacking(&self) -> [u64; 2] {
        let normals = (0..self.surfels.len()).filter(|&i| lacks_normal(&self.surfels, i)).count();
        let radii = self.surfels.radii.iter().filter(|radius| **radius == 0.0).count();
        [normals as u64, radii as u64]
    }

    /// Whether a normal or a radius is missing.
    pub fn lacks_anything(&self) -> bool {
        self.lacking() != [0; 2]
    }

    /// The surfels without any estimation: those without a normal become billboards, and all without a radius get the same one.
    pub fn finish_bare(mut self, how: &Estimate) -> Result<(Surfels, Estimated)> {
        let radius = rough_spacing(&self.surfels.positions).unwrap_or(1.0);
        self.surfels.radii.iter_mut().filter(|own| **own == 0.0).for_each(|own| *own = radius);
        self.triangles.clear();
        let (surfels, estimated) = self.finish(how)?;
        Ok((surfels, Estimated { billboards: 0, ..estimated }))
    }

    /// The surfels; an error if a radius is invalid.
    pub fn finish(self, how: &Estimate) -> Result<(Surfels, Estimated)> {
        let Self { mut surfels, mut estimated, .. } = self;
        if surfels.radii.contains(&0.0) {
            let all = if surfels.len() == 1 { "it has one point" } else { "all points coincide" };
            return Err(Error::Usage(format!("{all}, so there is no spacing: give a radius")));
        }
        surfels.radii.iter_mut().for_each(|radius| *radius *= how.radius_scale);
        if let Some(radius) = surfels.radii.iter().find(|radius| !(radius.is_finite() && **radius > 0.0)) {
            return Err(Error::Usage(format!(
                "a surfel would have the radius {radius}: give another radius or scale"
            )));
        }
        // Weights depend on the kernels and on the neighbours.
        let changed = how.radius.is_some() || how.radius_scale != 1.0 || how.sharp.is_some();
        let changed = changed || estimated.outliers > 0;
        surfels.weights = surfels.weights.take().filter(|_| !changed).and_then(Weights::filled);
        // Ellipses and clips may be older than the normal to which they must be orthogonal.
        for (ellipse, normal) in surfels.ellipses.iter_mut().flatten().zip(&surfels.normals) {
            *ellipse = within(*ellipse, *normal);
        }
        if let Some(clips) = surfels.clips.take() {
            let within =
                |(i, normal): (usize, &Vec3)| clips.get(i).filter(|_| *normal != Vec3::ZERO)?.within(*normal);
            surfels.clips = Clips::collect(surfels.normals.iter().enumerate().map(within));
        }
        let is_billboard = |&i: &usize| surfels.is_billboard(i);
        estimated.billboards = (0..surfels.len()).filter(is_billboard).count() as u64;
        let two_sided = surfels.two_sided.iter().flatten().zip(&surfels.normals);
        let two_sided = two_sided.filter(|(two_sided, normal)| **two_sided && **normal != Vec3::ZERO);
        estimated.two_sided = two_sided.count() as u64;
        Ok((surfels, estimated))
    }
}

/// Number of pairs of points for the rough spacing.
const PAIRS: usize = 1 << 12;

/// Median distance of some points from the next one in Morton order, which is near; `None` if all of them coincide.
fn rough_spacing(positions: &[Vec3]) -> Option<f32> {
    let step = positions.len().div_ceil(PAIRS).max(1);
    let pairs = positions.windows(2).step_by(step);
    let mut distances: Vec<f32> =
        pairs.map(|pair| pair[0].distance(pair[1])).filter(|distance| *distance > 0.0).collect();
    let middle = distances.len() / 2;
    let median = (!distances.is_empty()).then(|| *distances.select_nth_unstable_by(middle, f32::total_cmp).1);
    median.filter(|distance| distance.is_finite())
}

/// Whether a surfel has no normal and is no declared billboard: those have a radius and are two-sided.
pub(super) fn lacks_normal(surfels: &Surfels, i: usize) -> bool {
    let two_sided = || surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
    surfels.normals[i] == Vec3::ZERO && !(surfels.radii[i] > 0.0 && two_sided())
}

/// The ellipse projected to the plane of a disc with a unit normal; a circle if its axis is orthogonal to the plane, or without a normal.
fn within(ellipse: Ellipse, normal: Vec3) -> Ellipse {
    let major = ellipse.major - ellipse.major.dot(normal) * normal;
    // Shorter vectors are rounding errors.
    if normal != Vec3::ZERO && major.length() > 1e-3 {
        Ellipse { major: major.normalize(), ..ellipse }
    } else {
        Ellipse::circle(normal)
    }
}
