//! Estimation: from a point cloud to surfels.

mod boundary;
mod boundary_points;
mod cell;
mod creases;
mod curvature;
mod draft;
mod face;
mod face_colours;
mod face_edges;
mod face_samples;
mod faces;
mod facets;
mod forest;
mod given_normals;
mod lines;
mod model;
mod neighbours;
mod orient;
mod outliers;
mod patch;
mod reach;
mod scan;
mod scans;
mod scatter;
mod sheet;
mod sites;
mod spacing;
mod summary;
mod winding;

pub use given_normals::NormalSource;
pub use spacing::spacing;

use crate::Progress;
use crate::error::{Error, Result};
use crate::geometry::{Cloud, Surfels};
use draft::Draft;
use glam::DVec3;
use scans::Scans;
use sites::Sites;
use std::f32::consts::PI;
use std::ops::Add;

/// Factor of estimated radii beyond the least that covers the surface between flat neighbours.
const MARGIN: f64 = 1.3;

/// Where the surfels of a mesh are.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum MeshSampling {
    /// On the triangles of coarse, uneven, angular and textured meshes, otherwise at the vertices.
    #[default]
    Auto,
    /// At the vertices.
    Vertices,
    /// On the triangles, unless the vertices have radii or other attributes of surfels.
    Triangles,
}

/// Where the scanner was that saw the points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scanner {
    /// Where the file says; otherwise at 0, 0, 0, if the directions of the points from there are a grid, as of lidars.
    #[default]
    Auto,
    /// Where the file says, or unknown.
    OfFile,
    /// At a position, in the coordinates of the file.
    At(DVec3),
}

/// Options of an estimation.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Number of nearest points for the estimation of a normal and radius.
    pub neighbours: usize,
    /// Radius of every surfel, in the positions' unit, in place of given and estimated ones.
    pub radius: Option<f32>,
    /// Factor of all radii.
    pub radius_scale: f32,
    /// Whether discs with an estimated radius are ellipses, longer where points are sparser; those on the triangles of a mesh stay.
    pub elliptical: bool,
    /// Whether outlines are estimated, too: [`Surfels::curvatures`], and clips at the boundaries of open meshes.
    pub outlines: bool,
    /// Whether points on no surface, as in vegetation, become billboards ([`Surfels::is_billboard`]) instead of discs with a normal that means
    /// nothing. Their discs are small, so that leaves stay separate.
    pub billboards: bool,
    /// Where the scanner was. Normals face it, and the points next to each other as it sees them give radii and normals where the lines of a
    /// scan are far apart.
    pub scanner: Scanner,
    /// Which normals the surfels get.
    pub normals: NormalSource,
    /// Where the surfels of meshes are.
    pub mesh_sampling: MeshSampling,
    /// Removes points whose mean distance from their neighbours is more than this number of standard deviations above the average.
    pub outliers: Option<f32>,
    /// Clips discs at creases where normals turn by more than this angle, radians.
    pub sharp: Option<f32>,
    /// Radius of ribbons and tubes without one, in the positions' unit.
    pub line_radius: Option<f32>,
    /// Whether nothing is estimated of points, for [`Footprint::Point`](crate::settings::splatting::Footprint::Point): those without a normal become
    /// billboards, and those without a radius get a rough one, the same for all. Faces are left out.
    pub bare: bool,
}

impl Default for Estimate {
    fn default() -> Self {
        Self {
            neighbours: 16,
            radius: None,
            radius_scale: 1.0,
            elliptical: false,
            outlines: true,
            billboards: true,
            scanner: Scanner::Auto,
            normals: NormalSource::Auto,
            mesh_sampling: MeshSampling::Auto,
            outliers: None,
            sharp: None,
            line_radius: None,
            bare: false,
        }
    }
}

impl Estimate {
    /// Range of [`Estimate::neighbours`]: fewer do not determine a plane, more are not local.
    pub const NEIGHBOURS: [usize; 2] = [6, 64];

    /// Validates the options.
    fn check(&self) -> Result<()> {
        let positive = |name: &str, value: f32| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(Error::Usage(format!("{name} is {value}: give a finite number above 0")))
            }
        };
        let ([least, most], given) = (Self::NEIGHBOURS, self.neighbours);
        if !(least..=most).contains(&given) {
            return Err(Error::Usage(format!("{given} neighbours to estimate from: give {least} to {most}")));
        }
        self.radius.map_or(Ok(()), |radius| positive("the radius", radius))?;
        self.line_radius.map_or(Ok(()), |radius| positive("the radius of lines", radius))?;
        self.outliers
            .map_or(Ok(()), |deviations| positive("the outliers' standard deviations", deviations))?;
        if let Some(angle) = self.sharp.filter(|angle| !(*angle > 0.0 && *angle < PI)) {
            return Err(Error::Usage(format!(
                "the angle of a sharp edge is {angle} radians: give one between 0 and a half turn"
            )));
        }
        if let Scanner::At(position) = self.scanner
            && !position.is_finite()
        {
            return Err(Error::Usage(format!("the scanner is at {position}: give finite coordinates")));
        }
        positive("the factor of the radii", self.radius_scale)
    }
}

/// Number of points by the source of their normals and radii.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Estimated {
    /// Normals from the file.
    pub normals_given: u64,
    /// Normals of the file whose sides contradict each other ([`NormalSource::Auto`]), in whose place others are estimated.
    pub normals_contradictory: u64,
    /// Normals from the faces around the point.
    pub normals_from_faces: u64,
    /// Normals from the nearest points.
    pub normals_from_neighbours: u64,
    /// Points whose estimated normals have little in common with those of their neighbours, as in vegetation and in the noise of depth
    /// cameras: they mean nothing. Most billboards are among them.
    pub scattered: u64,
    /// Billboards: points on no surface, or declared by the file; none of those of [`Estimate::bare`].
    pub billboards: u64,
    /// Other two-sided surfels: the side of the normal is unknown, or the file declares it.
    pub two_sided: u64,
    /// Radii from the file, or from [`Estimate::radius`].
    pub radii_given: u64,
    /// Radii from the faces around the point.
    pub radii_from_faces: u64,
    /// Radii from the nearest points.
    pub radii_from_neighbours: u64,
    /// Points removed because no face of their mesh uses them.
    pub unused: u64,
    /// Triangles turned round: their neighbours are wound the other way, or their closed surface is wound inwards.
    pub triangles_turned: u64,
    /// Points whose scanner was found at 0, 0, 0 ([`Scanner::Auto`]).
    pub scanner_found: u64,
    /// Vertices of meshes that ellipses on their triangles replace ([`MeshSampling`]).
    pub vertices_replaced: u64,
    /// Points removed as outliers.
    pub outliers: u64,
    /// Surfels clipped at detected creases.
    pub clipped: u64,
    /// Surfels clipped at the boundaries of open meshes.
    pub bounded: u64,
    /// Radii of line vertices from the file, or from [`Estimate::line_radius`].
    pub line_radii_given: u64,
    /// Radii of line vertices from the nearest vertex along the line.
    pub line_radii_from_lines: u64,
    /// Radii of line vertices from the lines' extent.
    pub line_radii_from_extent: u64,
}

impl Add for Estimated {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            normals_given: self.normals_given + other.normals_given,
            normals_contradictory: self.normals_contradictory + other.normals_contradictory,
            normals_from_faces: self.normals_from_faces + other.normals_from_faces,
            normals_from_neighbours: self.normals_from_neighbours + other.normals_from_neighbours,
            scattered: self.scattered + other.scattered,
            billboards: self.billboards + other.billboards,
            two_sided: self.two_sided + other.two_sided,
            radii_given: self.radii_given + other.radii_given,
            radii_from_faces: self.radii_from_faces + other.radii_from_faces,
            radii_from_neighbours: self.radii_from_neighbours + other.radii_from_neighbours,
            unused: self.unused + other.unused,
            triangles_turned: self.triangles_turned + other.triangles_turned,
            scanner_found: self.scanner_found + other.scanner_found,
            vertices_replaced: self.vertices_replaced + other.vertices_replaced,
            outliers: self.outliers + other.outliers,
            clipped: self.clipped + other.clipped,
            bounded: self.bounded + other.bounded,
            line_radii_given: self.line_radii_given + other.line_radii_given,
            line_radii_from_lines: self.line_radii_from_lines + other.line_radii_from_lines,
            line_radii_from_extent: self.line_radii_from_extent + other.line_radii_from_extent,
        }
    }
}

impl Cloud {
    /// Converts the cloud to surfels, one per point, in Morton order. [`Cloud::into_model`] includes lines and triangles.
    ///
    /// Given normals are removed if [`Estimate::normals`] says so.
    /// A missing normal is that of the faces around the point, outwards on a closed surface; without faces, that of the least-squares plane through its neighbours. Such
    /// a normal points to where the cloud was seen from, or agrees with known normals and with its neighbours', outwards on a closed
    /// surface. If its side is still unknown, the surfel is two-sided. A point whose neighbours are no surface, as in vegetation, becomes
    /// a billboard ([`Estimate::billboards`]); so is a two-sided one with a radius and without a normal, as `convert` writes it.
    ///
    /// A missing radius is just large enough that the discs of a smooth surface leave no gap, according to the triangles between the
    /// points: faces, or the Delaunay triangulation of the neighbours in the tangent plane. At the boundary of a mesh it is at most what reaches
    /// the next vertices there, and half as large at that of a surface of points. Normalization weights are kept unless radii, number or edges of
    /// the discs change; a missing one is the median.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::Error::Usage) if what is missing cannot be estimated.
    pub fn into_surfels(self, how: &Estimate, progress: &dyn Progress) -> Result<(Surfels, Estimated)> {
        how.check()?;
        let mut draft = Draft::new(self, how)?;
        draft.sort_morton();
        if let Some(deviations) = how.outliers {
            let kept = outliers::kept(&draft.surfels.positions, deviations, how, progress)?;
            draft.keep(&kept);
        }
        if !how.bare {
            draft.reject_normals(how.normals);
        }
        draft.count_given();
        if how.bare {
            return draft.finish_bare(how);
        }
        progress.check_cancelled()?;
        winding::turn(&mut draft);
        fill_from_faces(&mut draft, how);
        progress.check_cancelled()?;
        let lacks_anything = draft.lacks_anything();
        let sites = (lacks_anything || how.outlines)
            .then(|| Sites::new(&draft.surfels.positions, progress))
            .transpose()?;
        if let Some(sites) = sites.as_ref().filter(|_| lacks_anything) {
            let scans = Scans::new(&mut draft, sites, how);
            neighbours::fill(&mut draft, sites, &scans, how, progress)?;
        }
        let triangles = std::mem::take(&mut draft.triangles);
        let (mut surfels, mut estimated) = draft.finish(how)?;
        if let Some(sites) = sites.filter(|_| how.outlines) {
            let bend = match estimated.vertices_replaced {
                0 => curvature::Bend::Positions,
                _ => curvature::Bend::Normals,
            };
            surfels.curvatures = Some(curvature::curvatures(&surfels, &sites, bend, progress)?);
            // Circles whose radii are the mesh's.
            let is_own = estimated.radii_given == 0 && surfels.ellipses.is_none();
            let scale = is_own.then_some(how.radius_scale);
            estimated.bounded = boundary::clip(&mut surfels, &triangles, &sites, scale);
        }
        if let Some(angle) = how.sharp {
            estimated.clipped = creases::clip(&mut surfels, angle, how, progress)?;
        }
        Ok((surfels, estimated))
    }
}

/// Fills normals and radii from the triangles, at the vertices or, by ellipses, on the triangles. Discs at the vertices that are to be
/// elliptical keep no radius.
fn fill_from_faces(draft: &mut Draft, how: &Estimate) {
    if draft.triangles.is_empty() || !draft.lacks_anything() {
        return;
    }
    faces::fill_normals(draft);
    let before = how.elliptical.then(|| (draft.surfels.radii.clone(), draft.estimated));
    faces::fill_radii(draft);
    let is_sampled = face_samples::replace(draft, how);
    if let Some(before) = before.filter(|_| !is_sampled) {
        (draft.surfels.radii, draft.estimated) = before;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_that_is_no_place_is_named() {
        use glam::Vec3;
        let positions = vec![Vec3::ZERO, Vec3::new(0.0, f32::NAN, 0.0), Vec3::ONE, Vec3::X];
        let cloud = Cloud { positions, ..Default::default() };
        let refused = cloud.into_surfels(&Estimate::default(), &()).unwrap_err().to_string();
        assert!(refused.starts_with("point 1 is at [0, NaN, 0]"), "{refused}");
    }

    #[test]
    fn every_count_is_added() {
        let one = Estimated {
            normals_given: 1,
            normals_contradictory: 20,
            normals_from_faces: 2,
            normals_from_neighbours: 3,
            scattered: 17,
            billboards: 18,
            two_sided: 4,
            radii_given: 5,
            radii_from_faces: 6,
            radii_from_neighbours: 7,
            triangles_turned: 16,
            vertices_replaced: 15,
            scanner_found: 19,
            outliers: 8,
            clipped: 9,
            unused: 14,
            bounded: 13,
            line_radii_given: 10,
            line_radii_from_lines: 11,
            line_radii_from_extent: 12,
        };
        let two = Estimated {
            normals_given: 2,
            normals_contradictory: 40,
            normals_from_faces: 4,
            normals_from_neighbours: 6,
            scattered: 34,
            billboards: 36,
            two_sided: 8,
            radii_given: 10,
            radii_from_faces: 12,
            radii_from_neighbours: 14,
            triangles_turned: 32,
            vertices_replaced: 30,
            scanner_found: 38,
            outliers: 16,
            clipped: 18,
            unused: 28,
            bounded: 26,
            line_radii_given: 20,
            line_radii_from_lines: 22,
            line_radii_from_extent: 24,
        };
        assert_eq!(one + one, two);
    }
}
