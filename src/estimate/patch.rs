//! Local surface around a point: its plane, and the required radius of its disc.

use super::cell::Cell;
use super::scan::Around;
use super::scans::Scans;
use super::sites::Sites;
use crate::geometry::Ellipse;
use crate::geometry::eigen;
use glam::{DMat2, DMat3, DVec2, DVec3, Vec3};

/// Local surface around a site.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Patch {
    /// Unit normal with an arbitrary side.
    pub normal: Vec3,
    /// Radius of the disc that covers the region nearest to the site; 0 without neighbours. Of an ellipse, the longer semi-axis.
    pub reach: f32,
    /// From 0, the neighbours are not in a plane, to 1, they are.
    pub flatness: f32,
    /// Whether the neighbours lie in a plane and surround the site, so that they are a surface there.
    pub is_surface: bool,
    /// Median distance of the neighbours from the plane, relative to that from the site; 0 where they are thin.
    pub roughness: f32,
    /// Distance of the third neighbour.
    pub spacing: f32,
    /// Whether the neighbours are those in the site's scan: they tell how far the surface goes on.
    pub of_scan: bool,
    /// The ellipse that covers the region.
    pub ellipse: Option<Ellipse>,
}

/// Computes patches.
pub(super) struct Surveyor<'a> {
    sites: &'a Sites,
    scans: &'a Scans,
    /// Number of neighbours if they surround the site.
    neighbours: usize,
    elliptical: bool,
    cell: Cell,
    around: Around,
    near: Vec<u32>,
    /// The nearest sites in space, while those in a scan are tried.
    in_space: Vec<u32>,
    /// Neighbours relative to the site, and the ones in its plane.
    offsets: Vec<DVec3>,
    flat: Vec<DVec2>,
    distances: Vec<f64>,
}

/// Factor of the number of neighbours where they do not surround a site, for example in a single scan line, or do not lie in a plane.
const WIDER: usize = 4;
/// Largest ratio of the extents across and along a line, 1-σ.
const LINE: f64 = 0.1;
/// Typical number of neighbours around a site on a surface.
const AROUND: usize = 6;
/// Largest radius in distances of these neighbours: if they do not lie in a plane, and if they do.
const WIDEST: [f64; 2] = [1.0, 8.0];
/// Neighbours lie in a plane if their thickness, the extent across the plane divided by the lesser extent in it, 1-σ, is below [`THIN`],
/// and do not if it is above [`THICK`].
const THIN: f64 = 0.2;
const THICK: f64 = 0.4;
/// Neighbours of this thickness may be noise. They are if more neighbours are less than [`SMOOTHER`] times as thick: a crease has the same
/// thickness in any neighbourhood.
const NOISY: f64 = 0.15;
const SMOOTHER: f64 = 0.6;
/// Iterations of the robust plane through noise.
const SETTLING: usize = 3;
/// Factor of the size of an ellipse in a scan, because those beside it have other axes.
const BESIDE_OTHERS: f32 = 1.1;
/// Least aspect of an ellipse.
const LEAST_ASPECT: f64 = 0.125;

/// Plane through a site's neighbours.
struct Plane {
    /// Mean of the neighbours, relative to the site.
    mean: DVec3,
    normal: DVec3,
    /// The other eigenvectors, by increasing extent.
    tangents: [DVec3; 2],
    /// Extents along normal and tangents, 1-σ.
    extents: DVec3,
}

impl<'a> Surveyor<'a> {
    pub fn new(sites: &'a Sites, scans: &'a Scans, neighbours: usize, elliptical: bool) -> Self {
        Self {
            sites,
            scans,
            neighbours,
            elliptical,
            cell: Cell::new(),
            around: Around::new(),
            near: Vec::new(),
            in_space: Vec::new(),
            offsets: Vec::new(),
            flat: Vec::new(),
            distances: Vec::new(),
        }
    }

    /// The patch around `site`. Writes the nearest neighbours to `edges`, padded with `site`.
    pub fn survey(&mut self, site: u32, edges: &mut [u32]) -> Patch {
        let around = self.look(site, self.neighbours);
        let in_scan = self.look_in_scan(site, around.is_line());
        let of_scan = in_scan.is_some();
        for (i, edge) in edges.iter_mut().enumerate() {
            *edge = self.near.get(i).copied().unwrap_or(site);
        }
        let mut plane = in_scan.unwrap_or_else(|| self.widen(site, around));
        let mut roughness = 0.0;
        if plane.thickness() > NOISY && !self.offsets.is_empty() {
            plane = self.settle(plane);
            roughness = self.distance_from(&plane) / self.median(DVec3::length);
        }
        let (open, thin) = (self.cell.is_open(&self.flat), plane.thickness() <= NOISY);
        // A scan goes on to its borders, where the neighbours do not surround a site.
        let is_in_scan = of_scan || (self.scans.has(site) && open && thin);
        let surrounded = !open && !plane.is_line();
        let mut patch = Patch {
            normal: plane.normal.as_vec3(),
            reach: self.cell.reach(&self.flat) as f32,
            flatness: plane.flatness() as f32,
            is_surface: (is_in_scan || surrounded) && plane.thickness() < THICK,
            roughness: roughness as f32,
            spacing: self.distance(2) as f32,
            of_scan,
            ellipse: None,
        };
        if self.elliptical || is_in_scan {
            self.stretch(&plane, &mut patch);
            if is_in_scan {
                patch.reach *= BESIDE_OTHERS;
            }
        }
        self.limit(&mut patch);
        patch
    }

    /// The plane of more neighbours, where the nearest do not surround a site or are noisy and more of them are better.
    fn widen(&mut self, site: u32, plane: Plane) -> Plane {
        let (open, noisy) = (self.cell.is_open(&self.flat), plane.thickness() > NOISY);
        if !(plane.is_line() || open || noisy) {
            return plane;
        }
        let wider = self.look(site, WIDER * self.neighbours);
        let closes = open && !self.cell.is_open(&self.flat);
        let smooths = noisy && wider.thickness() < SMOOTHER * plane.thickness();
        if plane.is_line() || closes || smooths {
            wider
        } else {
            // An edge of the surface, or a crease: the nearer neighbours are more accurate, and do not bridge its bays.
            self.look(site, self.neighbours)
        }
    }

    /// Limits the radius at gaps that are wide relative to the distance of the nearest neighbours, the more so if these do not lie in a
    /// plane.
    fn limit(&self, patch: &mut Patch) {
        let most =
            self.distance(AROUND - 1) * (WIDEST[0] + f64::from(patch.flatness) * (WIDEST[1] - WIDEST[0]));
        patch.reach = match patch.reach {
            // In a line, or with a single neighbour: half-way to the second.
            0.0 => 0.5 * self.distance(1) as f32,
            reach => reach.min(most as f32),
        };
    }

    /// Distance of neighbour `i`, or of the last one; 0 without any.
    fn distance(&self, i: usize) -> f64 {
        self.offsets.get(i).or(self.offsets.last()).map_or(0.0, |offset| offset.length())
    }

    /// Median distance of the neighbours from a plane.
    fn distance_from(&mut self, plane: &Plane) -> f64 {
        self.median(|offset| plane.distance(offset))
    }

    /// Median of a measure of the neighbours, of which there are some.
    fn median(&mut self, measure: impl Fn(DVec3) -> f64) -> f64 {
        self.distances.clear();
        self.distances.extend(self.offsets.iter().map(|offset| measure(*offset)));
        let middle = self.distances.len() / 2;
        *self.distances.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// The plane of most neighbours if they lie in several: iteratively reweighted by distance from the plane.
    fn settle(&mut self, mut plane: Plane) -> Plane {
        for _ in 0..SETTLING {
            let typical = self.distance_from(&plane);
            if typical == 0.0 {
                break;
            }
            let weight = |offset: &DVec3| 1.0 / (1.0 + (plane.distance(*offset) / typical).powi(2));
            plane = Plane::through(self.offsets.iter().map(|offset| (*offset, weight(offset))));
        }
        self.flatten(&plane);
        plane
    }

    /// The plane of the neighbours in the site's scan, if they lie in a plane and surround the site as the scanner sees it; if those in space
    /// are a line, they need not surround it. Otherwise the neighbours stay those in space.
    fn look_in_scan(&mut self, site: u32, is_line: bool) -> Option<Plane> {
        self.in_space.clone_from(&self.near);
        let otherwise = if is_line { self.neighbours } else { 0 };
        if !self.scans.nearest(site, otherwise, &mut self.around, &mut self.near) {
            return None;
        }
        let plane = self.look_at_near(site);
        if plane.thickness() <= NOISY {
            return Some(plane);
        }
        std::mem::swap(&mut self.near, &mut self.in_space);
        self.look_at_near(site);
        None
    }

    /// Computes the plane of the `count` nearest sites and the Voronoi cell in it.
    fn look(&mut self, site: u32, count: usize) -> Plane {
        self.near.clear();
        self.near.extend(self.sites.nearest(site, count));
        self.look_at_near(site)
    }

    /// Computes the plane of the sites that are near and the Voronoi cell in it.
    fn look_at_near(&mut self, site: u32) -> Plane {
        let centre = self.sites.at(site).as_dvec3();
        self.offsets.clear();
        self.offsets.extend(self.near.iter().map(|&other| self.sites.at(other).as_dvec3() - centre));
        let plane = Plane::through(self.offsets.iter().map(|offset| (*offset, 1.0)));
        self.flatten(&plane);
        plane
    }

    /// Computes the Voronoi cell in a plane.
    fn flatten(&mut self, plane: &Plane) {
        self.flat.clear();
        for offset in &self.offsets {
            let flat = DVec2::from(plane.tangents.map(|tangent| tangent.dot(*offset)));
            // Neighbours above rather than beside the site belong to another sheet, or are noise.
            let above = offset.dot(plane.normal);
            if above * above <= flat.length_squared() {
                self.flat.push(flat);
            }
        }
        self.cell.build(&self.flat);
    }

    /// Makes the disc elliptical: stretches a circle in the plane so that the distances to the surrounding neighbours are equal in all
    /// directions.
    fn stretch(&mut self, plane: &Plane, patch: &mut Patch) {
        let around = self.cell.neighbours().map(|i| self.flat[i as usize]);
        let covariance = around.fold(DMat2::ZERO, |sum, e| sum + DMat2::from_cols(e * e.x, e * e.y));
        let (a, b, d) = (covariance.x_axis.x, covariance.x_axis.y, covariance.y_axis.y);
        let angle = 0.5 * (2.0 * b).atan2(a - d);
        let (major, minor) = (DVec2::from_angle(angle), DVec2::from_angle(angle).perp());
        let [long, short] = [major, minor].map(|axis| axis.dot(covariance * axis).max(0.0).sqrt());
        let aspect = if long > 0.0 { (short / long).clamp(LEAST_ASPECT, 1.0) } else { 1.0 };
        self.flat.iter_mut().for_each(|e| *e = DVec2::new(e.dot(major), e.dot(minor) / aspect));
        self.flat.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        self.cell.build(&self.flat);
        let direction = major.x * plane.tangents[0] + major.y * plane.tangents[1];
        patch.reach = self.cell.reach(&self.flat) as f32;
        patch.ellipse = Some(Ellipse { major: direction.normalize().as_vec3(), aspect: aspect as f32 });
    }
}

impl Plane {
    /// The weighted least-squares plane through points.
    fn through(points: impl Iterator<Item = (DVec3, f64)> + Clone) -> Self {
        let (sum, weight) =
            points.clone().fold((DVec3::ZERO, 0.0), |(sum, weight), (p, w)| (sum + w * p, weight + w));
        let mean = if weight > 0.0 { sum / weight } else { DVec3::ZERO };
        let outer = |d: DVec3| DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        let covariance = points.fold(DMat3::ZERO, |sum, (p, w)| sum + outer(p - mean) * w);
        let (values, [normal, a, b]) = eigen::symmetric(covariance);
        Self { mean, normal, tangents: [a, b], extents: values.max(DVec3::ZERO).map(f64::sqrt) }
    }

    /// Distance of an offset from the site.
    fn distance(&self, offset: DVec3) -> f64 {
        (offset - self.mean).dot(self.normal).abs()
    }

    /// Whether the neighbours lie in a line.
    fn is_line(&self) -> bool {
        self.extents.y <= LINE * self.extents.z
    }

    /// The extent across the plane divided by the lesser extent in it, from 0 to 1.
    fn thickness(&self) -> f64 {
        if self.extents.y > 0.0 { self.extents.x / self.extents.y } else { 1.0 }
    }

    /// From 0, the neighbours are not in a plane, to 1, they are.
    fn flatness(&self) -> f64 {
        ((THICK - self.thickness()) / (THICK - THIN)).clamp(0.0, 1.0)
    }
}
