//! One rendered picture of Σw and depth, and its samples of surfels.

use super::corner_fit::CornerFit;
use super::overlap::kernel;
use super::samples::Sample;
use crate::error::Result;
use crate::frame::Renderer;
use crate::geometry::{Camera, Surfels};
use crate::picture::Picture;
use crate::scene::Scene;
use crate::settings::{Cull, Settings};
use crate::verify::reference::{Projector, Surfel};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Least cosine of the angle between ray and normal: at a larger angle the surface hides parts of itself.
const LEAST_COSINE: f64 = 0.5;
/// Least extent of a disc from its centre, px: smaller ones are narrower than the interpolation between pixels.
const LEAST_RADIUS: f64 = 2.0;
/// Factor by which the sum may change from the centre of a surfel's square to a corner; beyond, each corner gets its
/// own weight.
const STEADY: f64 = 2.0;
/// Samples along either side of such a square: one or two pixels apart.
const SAMPLES: u32 = 7;

/// A rendered view.
pub(super) struct WeightView {
    projector: Projector,
    picture: Picture,
    settings: Settings,
}

/// A surfel's square: its centre, and the vectors from there to its sides.
struct Square {
    centre: DVec3,
    u: DVec3,
    v: DVec3,
    /// Tolerance of the distance of its surface.
    tolerance: f64,
}

/// The visible surface at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Visible {
    /// The expected surface, with this Σw.
    Sum(f64),
    /// The surface has ended: nothing, or a surface behind.
    Gap,
    /// A surface in front, or a point outside of the picture.
    Hidden,
}

impl WeightView {
    /// Renders `scene` with settings that show Σw.
    pub fn new(renderer: &mut Renderer, scene: &Scene, camera: &Camera, settings: &Settings) -> Result<Self> {
        let (picture, _) = renderer.render_picture(scene, camera, settings)?;
        let projector = Projector::new(camera, picture.size, settings)?;
        Ok(Self { projector, picture, settings: settings.clone() })
    }

    /// Samples of the surfels with visible centres. `surfels` are the scene's.
    pub fn samples(&self, surfels: &Surfels) -> Vec<Sample> {
        let sample = |i: usize| surfels.is_valid(i).then(|| self.sample(i, &Surfel::of(surfels, i)))?;
        (0..surfels.len()).into_par_iter().filter_map(sample).collect()
    }

    fn sample(&self, index: usize, surfel: &Surfel) -> Option<Sample> {
        let billboard = surfel.normal == DVec3::ZERO;
        let surfel = &self.projector.facing_eye(surfel);
        let u = surfel.radius * surfel.major;
        let v = surfel.aspect * surfel.normal.cross(u);
        let tolerance = f64::from(self.settings.epsilon) * surfel.radius;
        let square = Square { centre: surfel.position, u, v, tolerance };
        let (centre, _) = self.projector.locate(surfel.position)?;
        let (_, step) = self.projector.ray(centre);
        let facing = -step.normalize().dot(surfel.normal);
        let culled = self.settings.cull != Cull::None && facing < 0.0 && !surfel.two_sided;
        if culled || facing.abs() < LEAST_COSINE {
            return None;
        }
        let Visible::Sum(sum) = self.seen(&square, DVec2::ZERO) else { return None };
        let extent = |axis: DVec3| Some(self.projector.locate(surfel.position + axis)?.0.distance(centre));
        if extent(u)?.min(extent(v)?) < LEAST_RADIUS {
            return None;
        }
        // The square of a billboard turns with the eye.
        let has_corners = !billboard && self.is_border(&square, sum);
        let corners = has_corners.then(|| self.corners(&square, sum).map(|w| w as f32));
        Some(Sample { surfel: index as u32, sum: sum as f32, corners })
    }

    /// Whether a surface ends within the square, or its sum varies strongly there.
    fn is_border(&self, square: &Square, sum: f64) -> bool {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        corners.into_iter().any(|at| match self.seen(square, at.into()) {
            Visible::Sum(other) => (other / sum).max(sum / other) > STEADY,
            Visible::Gap => true,
            Visible::Hidden => false,
        })
    }

    /// Weights at the square's corners, from the visible samples within the kernel.
    fn corners(&self, square: &Square, sum: f64) -> [f64; 4] {
        let mut fit = CornerFit::new(1.0 / sum);
        let place = |i: u32| f64::from(2 * i + 1) / f64::from(SAMPLES) - 1.0;
        for at in (0..SAMPLES * SAMPLES).map(|i| DVec2::new(place(i % SAMPLES), place(i / SAMPLES))) {
            if let (Some(kernel), Visible::Sum(sum)) = (kernel(&self.settings, at), self.seen(square, at)) {
                fit.add(at, kernel, 1.0 / sum);
            }
        }
        fit.corners()
    }

    /// The visible surface at a position in a square, in its axes.
    fn seen(&self, square: &Square, place: DVec2) -> Visible {
        let located = self.projector.locate(square.centre + place.x * square.u + place.y * square.v);
        located.map_or(Visible::Hidden, |(at, distance)| self.at(at, distance, square.tolerance))
    }

    /// The visible surface at a pixel position, px, whose depth is `distance` ± `tolerance`: Σw interpolated between
    /// the four pixels around it, or those of them that show the surface.
    fn at(&self, at: DVec2, distance: f64, tolerance: f64) -> Visible {
        let first = (at - 0.5).floor();
        let part = at - 0.5 - first;
        let (mut total, mut share, mut in_front) = (0.0, 0.0, false);
        for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let offset = DVec2::new(f64::from(x), f64::from(y));
            let Some((sum, depth)) = self.pixel(first + offset) else { return Visible::Hidden };
            in_front |= depth > 0.0 && depth < distance - tolerance;
            if depth > 0.0 && (depth - distance).abs() <= tolerance {
                let [near_x, near_y] = (1.0 - (offset - part).abs()).to_array();
                total += near_x * near_y * sum;
                share += near_x * near_y;
            }
        }
        match (share > 0.0 && total > 0.0, in_front) {
            (true, _) => Visible::Sum(total / share),
            (false, true) => Visible::Hidden,
            (false, false) => Visible::Gap,
        }
    }

    /// Σw and depth of a pixel; `None` outside of the picture.
    fn pixel(&self, at: DVec2) -> Option<(f64, f64)> {
        let size = DVec2::new(self.picture.size[0].into(), self.picture.size[1].into());
        let inside = at.cmpge(DVec2::ZERO).all() && at.cmplt(size).all();
        let index = inside.then_some(at.y as usize * self.picture.size[0] as usize + at.x as usize)?;
        let depth = self.picture.depth.as_ref()?[index];
        Some((self.picture.colour[index][0].into(), depth.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::methods::object_ewa;
    use glam::Vec3;

    const SIDE: u32 = 32;
    const DISTANCE: f64 = 10.0;

    /// The view from 10 above the plane z = 0 along −z, a unit per pixel, with the first row at y = 32: Σw and distance
    /// of each pixel.
    fn view(cull: Cull, seen: impl Fn(u32, u32) -> (f32, f64)) -> WeightView {
        let middle = DVec3::new(16.0, 16.0, 0.0);
        let eye = [middle + DISTANCE * DVec3::Z, middle, DVec3::Y];
        let camera = Camera::orthographic(eye, SIDE.into(), 1.0, [1.0, 100.0]).unwrap();
        let settings = Settings { cull, epsilon: 0.5, ..object_ewa::METHOD.settings() };
        let (sums, depths): (Vec<f32>, Vec<f64>) = (0..SIDE * SIDE).map(|i| seen(i % SIDE, i / SIDE)).unzip();
        let picture = Picture {
            size: [SIDE; 2],
            colour: sums.into_iter().map(|sum| [sum, sum, sum, 1.0]).collect(),
            depth: Some(depths.into_iter().map(|depth| depth as f32).collect()),
            ..Default::default()
        };
        WeightView { projector: Projector::new(&camera, [SIDE; 2], &settings).unwrap(), picture, settings }
    }

    #[test]
    fn sums_are_interpolated_between_the_pixels_of_the_surface() {
        let ramp = view(Cull::Back, |x, y| ((x + 10 * y) as f32, DISTANCE));
        assert_eq!(ramp.at(DVec2::new(4.0, 5.25), DISTANCE, 0.5), Visible::Sum(3.5 + 47.5));
        let half = view(Cull::Back, |x, _| (x as f32, if x < 8 { DISTANCE } else { 12.0 }));
        assert_eq!(half.at(DVec2::new(8.25, 8.0), DISTANCE, 0.5), Visible::Sum(7.0), "of those that show it");
    }

    #[test]
    fn a_surface_ends_at_nothing_and_what_is_behind_and_is_hidden_by_what_is_in_front() {
        let depths = [0.0, DISTANCE + 1.0, DISTANCE - 1.0, DISTANCE + 0.4];
        let strips = view(Cull::Back, |x, _| (2.0, depths[x as usize / 8]));
        let seen = [4.0, 12.0, 20.0, 28.0].map(|x| strips.at(DVec2::new(x, 16.0), DISTANCE, 0.5));
        assert_eq!(seen, [Visible::Gap, Visible::Gap, Visible::Hidden, Visible::Sum(2.0)]);
        assert_eq!(strips.at(DVec2::new(31.9, 16.0), DISTANCE, 0.5), Visible::Hidden, "beyond the picture");
    }

    /// A disc of radius 3 in the plane, at x = 12, turned by `degrees`.
    fn disc(degrees: f32, radius: f32) -> Surfels {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Surfels {
            positions: vec![Vec3::new(12.0, 16.0, 0.0)],
            normals: vec![Vec3::new(sin, 0.0, cos)],
            radii: vec![radius],
            ..Default::default()
        }
    }

    #[test]
    fn surfels_that_are_small_or_steep_or_culled_are_left_to_other_views() {
        let all = |cull| view(cull, |_, _| (4.0, DISTANCE));
        let [both, front] = [all(Cull::None), all(Cull::Back)];
        let whole = vec![Sample { surfel: 0, sum: 4.0, corners: None }];
        assert_eq!(front.samples(&disc(0.0, 3.0)), whole);
        for (degrees, radius) in [(0.0, 1.9), (61.0, 5.0)] {
            assert!(both.samples(&disc(degrees, radius)).is_empty(), "{degrees} {radius}");
        }
        assert_eq!((both.samples(&disc(180.0, 3.0)), front.samples(&disc(180.0, 3.0))), (whole, Vec::new()));
        let turned = Surfels { two_sided: Some(vec![true]), ..disc(180.0, 3.0) };
        assert_eq!(front.samples(&turned).len(), 1);
    }

    #[test]
    fn a_surfel_at_a_border_has_a_weight_at_each_corner() {
        // The sum falls from 4 to 1 over the disc, and the surface ends at 14.
        let sum = |x: u32| 4.0 - (x as f32 - 9.0).clamp(0.0, 3.0);
        let border = view(Cull::Back, |x, _| (sum(x), if x < 14 { DISTANCE } else { 0.0 }));
        let [found] = border.samples(&disc(0.0, 3.0))[..] else { panic!("not seen") };
        let corners = found.corners.unwrap();
        // The first axis is ±x: two corners are beyond the end, with larger weights than the centre; two are inside,
        // with smaller ones.
        let mut sorted = corners;
        sorted.sort_by(f32::total_cmp);
        let centre = 1.0 / found.sum;
        assert!(sorted[1] < centre && sorted[2] > 1.5 * centre, "{corners:?} {centre}");
        assert_eq!(corners[0] > centre, corners[2] > centre, "{corners:?}");
    }
}
