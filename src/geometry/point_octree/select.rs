//! Selection of the nodes that are drawn for a camera (pajarola2004 section 6.2).

use super::PointOctree;
use super::node::{Node, angle};
use crate::error::{Error, Result};
use crate::geometry::{Camera, Surfels};
use glam::{DMat4, DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, PI};

/// Pixels around the picture within which discs are drawn: filters widen them.
const MARGIN: f64 = 4.0;

/// What is selected for a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Selection {
    /// Width and height of the picture, px.
    pub size: [u32; 2],
    /// Side of the square whose area the ellipse of a node has at most, px; 0 selects points alone.
    pub tolerance: f32,
    /// Whether surfels that face away from the eye are drawn, too.
    pub back_faces: bool,
}

/// Points and nodes that are drawn, by their indices in the octree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selected {
    pub(super) points: Vec<u32>,
    pub(super) nodes: Vec<u32>,
}

impl Selected {
    /// Number of surfels.
    pub fn len(&self) -> usize {
        self.points.len() + self.nodes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of nodes, each of which stands for its points.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }
}

impl PointOctree {
    /// Selects what is drawn for a camera. From the root on, a node ends the walk
    /// - if its sphere is outside the picture, or its cone of normals faces away;
    /// - if its ellipse, at the angle nearest to the eye's that its normals allow, is small enough: it stands for its points.
    ///
    /// Otherwise its children follow, in a leaf the points that face the eye.
    ///
    /// # Errors
    /// [`Error::Usage`] for a camera that cannot be rendered, an empty picture, and a tolerance that is not finite or negative.
    pub fn select(&self, camera: &Camera, selection: &Selection) -> Result<Selected> {
        let view = View::new(camera, selection, self.surfels.origin)?;
        let (mut selected, mut own) = (Selected::default(), 0);
        while let Some(node) = self.nodes.get(own) {
            let all = node.cell.subtree as usize;
            own += match () {
                () if view.culls(node) => all,
                () if node.cell.count > 1 && view.is_small(node) => {
                    selected.nodes.push(own as u32);
                    all
                }
                () => {
                    if node.is_leaf() {
                        let points = node.points().filter(|i| view.faces(&self.surfels, *i));
                        selected.points.extend(points.map(|i| i as u32));
                    }
                    1
                }
            };
        }
        Ok(selected)
    }

    /// The surfels of [`PointOctree::select`], which any renderer draws.
    ///
    /// # Errors
    /// As [`PointOctree::select`].
    pub fn cut(&self, camera: &Camera, selection: &Selection) -> Result<Surfels> {
        Ok(self.surfels(&self.select(camera, selection)?))
    }
}

/// A camera in the frame of the positions.
struct View {
    /// Frame of the positions to eye space.
    view: DMat4,
    eye: DVec3,
    /// Direction of view.
    ahead: DVec3,
    perspective: bool,
    /// Sign of z in front of the eye, and the near plane's distance.
    forward: f64,
    near: f64,
    /// Pixels of a unit area that faces the eye, at a distance of 1 or, with parallel rays, at any.
    area: f64,
    /// Of the sides of the picture: inward unit normals and offsets.
    sides: [DVec4; 4],
    tolerance: f64,
    back_faces: bool,
}

impl View {
    fn new(camera: &Camera, selection: &Selection, origin: DVec3) -> Result<Self> {
        let Selection { size, tolerance, back_faces } = *selection;
        let refuse = |text: String| Err(Error::Usage(text));
        if size.contains(&0) {
            return refuse(format!(
                "a picture of {}x{} px has no levels of detail: give a larger one",
                size[0], size[1]
            ));
        }
        if !(tolerance.is_finite() && tolerance >= 0.0) {
            return refuse(format!("a tolerance of {tolerance} px: give 0 or more"));
        }
        let projection = camera.projection()?;
        let view = camera.view * DMat4::from_translation(origin);
        let back = view.inverse();
        let [width, height] = size.map(f64::from);
        let rows = [0, 1, 3].map(|row| camera.projection.row(row));
        let unit = if projection.perspective { rows[2].z } else { rows[2].w };
        Ok(Self {
            view,
            eye: back.transform_point3(DVec3::ZERO),
            ahead: back.transform_vector3(DVec3::new(0.0, 0.0, projection.forward)).normalize_or_zero(),
            perspective: projection.perspective,
            forward: projection.forward,
            near: projection.near,
            area: 0.25 * width * height * (rows[0].x * rows[1].y - rows[0].y * rows[1].x).abs()
                / (unit * unit),
            sides: sides(camera.projection * view, [width, height]),
            tolerance: tolerance.into(),
            back_faces,
        })
    }

    /// Direction from the eye to a place.
    fn towards(&self, place: DVec3) -> DVec3 {
        if self.perspective { place - self.eye } else { self.ahead }
    }

    fn distance(&self, place: DVec3) -> f64 {
        self.forward * self.view.transform_point3(place).z
    }

    /// Whether no point of a node is drawn.
    fn culls(&self, node: &Node) -> bool {
        let (centre, radius) = (node.disc.position.as_dvec3(), f64::from(node.sphere));
        let outside = |side: &DVec4| side.dot(centre.extend(1.0)) < -radius;
        self.distance(centre) + radius < self.near
            || self.sides.iter().any(outside)
            || !self.back_faces && self.faces_away(node, centre, radius)
    }

    /// Whether all normals face away (figure 11b), from every place in the sphere, which the paper takes for its centre.
    fn faces_away(&self, node: &Node, centre: DVec3, radius: f64) -> bool {
        let to = self.towards(centre);
        let sphere = if self.perspective { (radius / to.length()).clamp(0.0, 1.0).asin() } else { 0.0 };
        angle(node.disc.normal.as_dvec3(), to) + f64::from(node.cone) + sphere < FRAC_PI_2
    }

    /// Whether the ellipse of a node is small enough. The paper's factor cos(γ − θ) is 1 where the cone holds the direction to the eye.
    fn is_small(&self, node: &Node) -> bool {
        let (centre, disc) = (node.disc.position.as_dvec3(), &node.disc);
        let distance = self.distance(centre);
        if self.perspective && distance <= self.near.max(f64::from(node.sphere)) {
            return false;
        }
        let tilt = angle(disc.normal.as_dvec3(), -self.towards(centre));
        let tilt = if self.back_faces { tilt.min(PI - tilt) } else { tilt };
        let cosine = (tilt - f64::from(node.cone)).clamp(0.0, FRAC_PI_2).cos();
        let ellipse = PI * f64::from(disc.radius).powi(2) * f64::from(disc.ellipse.aspect);
        let scale = if self.perspective { distance.powi(-2) } else { 1.0 };
        ellipse * cosine * self.area * scale < self.tolerance * self.tolerance
    }

    /// Whether a point is drawn by its normal.
    fn faces(&self, surfels: &Surfels, i: usize) -> bool {
        let two_sided = || surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
        let towards = self.towards(surfels.positions[i].as_dvec3());
        self.back_faces || surfels.normals[i].as_dvec3().dot(towards) <= 0.0 || two_sided()
    }
}

/// The sides of a picture of `size` px, [`MARGIN`] beyond it.
fn sides(to_clip: DMat4, size: [f64; 2]) -> [DVec4; 4] {
    let [x, y, w] = [0, 1, 3].map(|row| to_clip.row(row));
    let [wide, high] = size.map(|length| (1.0 + 2.0 * MARGIN / length) * w);
    [wide + x, wide - x, high + y, high - y]
        .map(|side| side / side.truncate().length().max(f64::MIN_POSITIVE))
}
