//! Pass `footprint`: projects surfels to screen-space splats.

use super::Projector;
use super::conic::clearance;
use super::ellipse::Ellipse;
use super::image::Disc;
use super::shading::{Shine, linear, lit};
use crate::error::Result;
use crate::geometry::{Camera, Clip, ClipLine, Colours, Curvature, Surfels, square_axis, tangents};
use crate::settings::splatting::{Normalization, Shade};
use crate::settings::{Alpha, Cull, Settings, Shading};
use glam::{DMat2, DMat3, DVec2, DVec3};

/// One surfel in float64, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surfel {
    /// Centre, origin included.
    pub position: DVec3,
    /// Unit normal; 0 of a billboard, which faces the eye ([`Surfels::is_billboard`]).
    pub normal: DVec3,
    /// Longer semi-axis of the covered disc, `F σ`.
    pub radius: f64,
    /// Direction of that semi-axis: a unit vector perpendicular to the normal, any for a circle.
    pub major: DVec3,
    /// The shorter semi-axis divided by the longer: 1 for a circle.
    pub aspect: f64,
    /// Normal curvatures of the surface, in the basis of `tangents`.
    pub curvature: Curvature,
    /// Whether both sides are fronts.
    pub two_sided: bool,
    /// Normalization weights at the corners −u −v, +u −v, −u +v, +u +v of the square around the disc, with u = `major`
    /// and v = normal × u. All four are equal inside a surface, and 1 if the scene has none.
    pub weights: [f64; 4],
    /// Linear RGB, if the scene has colours.
    pub colour: Option<DVec3>,
    /// Clip lines of the disc, if it has any.
    pub clip: Option<Clip>,
    /// Whether it is a billboard.
    pub billboard: bool,
}

impl Surfel {
    /// Entry `index` of `surfels`; panics beyond the end.
    pub fn of(surfels: &Surfels, index: usize) -> Self {
        let colour = surfels.colours.as_ref().map(|colours| match colours {
            Colours::Srgb8(c) => linear(c[index]),
            Colours::Linear(c) => DVec3::from_array(c[index].map(f64::from)),
        });
        let normal = surfels.normals[index].as_dvec3().normalize_or_zero();
        let ellipse = surfels.ellipses.as_ref().map(|ellipses| ellipses[index]);
        let weights = surfels
            .weights
            .as_ref()
            .map_or([1.0; 4], |weights| weights.corners_of(index).unwrap_or([weights.of[index]; 4]));
        Self {
            position: surfels.origin + surfels.positions[index].as_dvec3(),
            normal,
            billboard: normal == DVec3::ZERO,
            radius: surfels.radii[index].into(),
            // In the disc's plane; float32 computes it from the same values.
            major: square_axis(surfels.normals[index], ellipse.map(|ellipse| ellipse.major)),
            aspect: ellipse.map_or(1.0, |ellipse| ellipse.aspect.into()),
            weights: weights.map(f64::from),
            curvature: surfels.curvatures.as_ref().map(|curvatures| curvatures[index]).unwrap_or_default(),
            two_sided: surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[index]),
            colour,
            clip: surfels.clips.as_ref().and_then(|clips| clips.get(index)).copied(),
        }
    }
}

/// The screen-space splat of a surfel: an ellipse and a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splat {
    /// Centre of the ellipse, px. In perspective not the projection of the surfel's centre.
    pub centre: DVec2,
    /// Variance `V` of the projected kernel without any low-pass, px².
    pub variance: DMat2,
    /// `√|V|`, px²; the closed form where `V` is near singular.
    pub sqrt_det: f64,
    /// The plane at pixel position (x, y): `plane · (1, x, y)` is 1 / distance in perspective, and the distance in
    /// orthographic projection and for sprites. It is the tangent plane, except for sprites.
    pub plane: DVec3,
    /// Distance of the surfel's centre.
    pub distance: f64,
    /// Distance of the disc's nearest point.
    pub nearest: f64,
    /// Depth tolerance of the ε test behind this splat: a factor of the depth in perspective, a summand in orthographic
    /// projection.
    pub shift: f64,
    /// World-space unit normal, turned to the eye.
    pub normal: DVec3,
    /// Change of the normal per σ of the disc along the axes of its square, orthogonal to it; 0 without a normal field.
    pub bend: [DVec3; 2],
    /// Linear RGB; the lighting's albedo where the scene has no colours.
    pub colour: DVec3,
    /// 1 / cosine of the angle between the normal and the ray through the centre: the factor by which rounding errors
    /// of normal and centre grow in the plane's depth and in `√|V|`.
    pub secant: f64,
    /// Shorter semi-axis of the disc divided by the longer.
    pub aspect: f64,
    /// Normalization weights at the corners of the disc's square; all 1 if the frame asks for none.
    pub weights: [f64; 4],
    /// Images of the square's axes at the centre, px up to a common factor.
    pub square: DMat2,
    /// Whether the ellipse came from the dual form, because the inverse form is ill-conditioned.
    pub dual: bool,
    /// Clip lines on the screen, if the surfel has any.
    pub clip: Option<ScreenClip>,
    /// Line beyond which the surface has turned away from the eye: samples beyond it are not covered, and fragments end
    /// half a pixel beyond it. `None` where the surface does not turn away.
    pub turn: Option<TurnLine>,
    /// Whether its surfel faces away and is not two-sided.
    pub back: bool,
    /// Whether its surfel is a billboard: the sides of a parallelogram are parallel to the picture's.
    pub billboard: bool,
    /// Whether rounding does not decide if [`Cull::Auto`] drops it.
    pub certain: bool,
}

/// Clip lines on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenClip {
    /// Signed distances to the lines at pixel position (x, y), px: `line · (1, x, y)`, above 0 on the kept side;
    /// infinite for no line.
    pub lines: [DVec3; 2],
    /// Whether the kept part is the union of both sides, not the intersection.
    pub concave: bool,
}

impl ScreenClip {
    /// Signed distance at a pixel position, px; above 0 where the splat is kept.
    pub fn distance(&self, at: DVec2) -> f64 {
        let [a, b] = self
            .lines
            .map(|line| if line.is_finite() { line.dot(DVec3::new(1.0, at.x, at.y)) } else { f64::INFINITY });
        if self.concave { a.max(b) } else { a.min(b) }
    }
}

/// Line on the screen beyond which a convex surface has turned away from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnLine {
    /// Signed distance at pixel position (x, y), px: `line · (1, x, y)`, above 0 on the kept side.
    pub line: DVec3,
    /// Error of the distance by rounding, px.
    pub error: f64,
}

impl TurnLine {
    /// Signed distance at a pixel position, px; below 0 where the surface has turned away.
    pub fn distance(&self, at: DVec2) -> f64 {
        self.line.dot(DVec3::new(1.0, at.x, at.y))
    }
}

/// Error of positions, normals and directions by rounding to float32, relative.
const ROUNDING: f64 = 4.0 / (1 << 24) as f64;
/// Least `1 − (F |g| / w)²` of a drawn splat: closer to the eye plane, float32 cannot locate the ellipse.
const LEAST_CLEARANCE: f64 = 1e-3;
/// Least `√|V|` of a drawn splat, px²: the float32 weight of a smaller one may be 0.
const LEAST_AREA: f64 = 1e-30;
/// Largest variance along the major axis of a drawn splat, px²: float32 overflows beyond.
const LARGEST_VARIANCE: f64 = 1e30;

/// Depth of the turn line of circles, and of ellipses, in radii of curvature times the cosine of the angle between normal and viewing ray. At
/// grazing angles the tangent plane of a sphere leaves its outline at the depth of ellipses.
const TURN_DEPTH: [f64; 2] = [0.25, 0.5];

/// Largest turn of the normal at the rim of a disc, as a tangent: curvatures of noisy points may be anything.
const MOST_TURN: f64 = 1.0;

/// Cull reason of a surfel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Culled {
    /// Its centre is not in front of the eye (perspective only).
    Behind,
    /// Its disc reaches the eye plane, or comes within 1/2000 of its distance to it.
    EyePlane,
    /// It shows its back where [`Cull::Back`] is set, and is not two-sided.
    Back,
    /// Its bounding box misses the picture, or its image has no area: the disc is exactly edge-on, or so small that its
    /// weight is 0 in float32.
    Outside,
    /// It is not [valid](Surfels::is_valid), which is tested first, or its image is too large for float32.
    Invalid,
}

/// The splat of one surfel in a frame of `size` px, or its cull reason.
///
/// For many surfels of a frame, create one [`Projector`] and call [`Projector::footprint`].
pub fn footprint(
    surfel: &Surfel,
    camera: &Camera,
    size: [u32; 2],
    settings: &Settings,
) -> Result<Result<Splat, Culled>> {
    Ok(Projector::new(camera, size, settings)?.footprint(surfel))
}

impl Projector {
    /// The splat of one surfel, or its cull reason. The reasons are tested in the order of [`Culled`]; the surfel must
    /// be valid.
    pub fn footprint(&self, surfel: &Surfel) -> Result<Splat, Culled> {
        let surfel = &self.facing_eye(surfel);
        let centre = self.view.transform_point3(surfel.position);
        let normal = self.view.transform_vector3(surfel.normal);
        let distance = self.distance(centre);
        if self.depth.perspective && distance <= 0.0 {
            return Err(Culled::Behind);
        }
        let axes = self.semi_axes(surfel);
        let (projected, mapping) = self.tangent_plane(centre, axes);
        let clear = clearance(&mapping, self.cutoff()) / (mapping.z_axis.z / self.cutoff()).powi(2);
        // A point of a fixed size has no disc that could reach the eye, nor one that lines could clip.
        let is_point = self.settings.draws_points();
        if !is_point && (clear.is_nan() || clear <= LEAST_CLEARANCE) {
            return Err(Culled::EyePlane);
        }
        let facing = self.facing(centre, normal);
        if self.settings.cull == Cull::Back && facing >= 0.0 && !surfel.two_sided {
            return Err(Culled::Back);
        }
        let square = DMat2::from_cols(mapping.x_axis.truncate(), mapping.y_axis.truncate());
        let by_surfel = self.settings.splatting.normalization == Normalization::Surfel;
        let image = self.image(&Disc { surfel, centre, normal, axes, projected, mapping });
        let shown = surfel.colour.unwrap_or(DVec3::from_array(self.settings.lighting.albedo.map(f64::from)));
        let towards = if facing > 0.0 { -surfel.normal } else { surfel.normal };
        let secant = if is_point { 1.0 } else { self.secant(centre, facing) };
        let splat = Splat {
            centre: image.centre,
            variance: image.variance,
            sqrt_det: image.sqrt_det,
            plane: image.plane,
            distance,
            nearest: image.nearest,
            shift: self.shift(surfel.radius, distance),
            normal: towards,
            bend: self.bend(surfel, facing),
            colour: self.splat_colour(shown, towards, centre),
            secant,
            aspect: if is_point { 1.0 } else { surfel.aspect },
            weights: if by_surfel { surfel.weights } else { [1.0; 4] },
            square,
            dual: image.dual,
            clip: surfel.clip.filter(|_| !is_point).map(|clip| self.screen_clip(&clip, centre, normal)),
            turn: (facing < 0.0).then(|| self.turn_line(surfel, centre, image.plane)).flatten(),
            back: facing >= 0.0 && !surfel.two_sided,
            billboard: surfel.billboard,
            certain: true,
        };
        let attribute = Ellipse::attribute(&splat, self);
        // NaN fails the test, too.
        let visible = splat.sqrt_det >= LEAST_AREA && self.sees(&attribute);
        if visible && attribute.variance.x <= LARGEST_VARIANCE {
            Ok(splat)
        } else {
            Err(if visible { Culled::Invalid } else { Culled::Outside })
        }
    }

    /// The surfel itself; a billboard becomes a circle with the normal to the eye, of an unknown curvature. At the eye it has none.
    pub(crate) fn facing_eye(&self, surfel: &Surfel) -> Surfel {
        if surfel.normal != DVec3::ZERO {
            return *surfel;
        }
        let centre = self.view.transform_point3(surfel.position);
        let to_eye = match self.depth.perspective {
            true => self.eye() - centre,
            false => DVec3::new(0.0, 0.0, -self.depth.forward),
        };
        let normal = self.to_world(to_eye).normalize_or_zero();
        let major = normal.any_orthonormal_vector();
        Surfel { normal, major, aspect: 1.0, curvature: Curvature::default(), ..*surfel }
    }

    /// See [`Splat::bend`]: the shape operator applied to the square's axes (Botsch, Spernat and Kobbelt 2004, *Phong Splatting*).
    fn bend(&self, surfel: &Surfel, facing: f64) -> [DVec3; 2] {
        if !self.settings.has_normal_fields() {
            return [DVec3::ZERO; 2];
        }
        let curvature = surfel.curvature;
        let at_rim = curvature.largest().abs() * surfel.radius;
        let sigma = surfel.radius / self.cutoff() * (MOST_TURN / at_rim).min(1.0);
        let basis = tangents(surfel.normal);
        let minor = surfel.aspect * surfel.normal.cross(surfel.major);
        [surfel.major, minor].map(|axis| {
            let along = basis.map(|tangent| sigma * tangent.dot(axis));
            let turn = curvature.turn_along(along.into());
            let turned = turn.x * basis[0] + turn.y * basis[1];
            if facing > 0.0 { -turned } else { turned }
        })
    }

    /// Line on the screen beyond which the surface has turned away from the eye: where the tangent plane of a front-facing
    /// surfel is [`TURN_DEPTH`] below the centre. `centre` is in eye space, `plane` as in [`Splat`].
    fn turn_line(&self, surfel: &Surfel, centre: DVec3, plane: DVec3) -> Option<TurnLine> {
        let has_discs = self.settings.splatting.has_gaussian_discs();
        if self.settings.drawn_alpha() != Alpha::Coverage || !has_discs {
            return None;
        }
        let perspective = self.depth.perspective;
        let from_eye = (centre - self.eye()).length();
        let away = if perspective { (centre - self.eye()) / from_eye } else { DVec3::Z * self.depth.forward };
        let ray = self.to_world(away);
        let [x, y] = tangents(surfel.normal).map(|axis| axis.dot(ray));
        // Of the tangent; nearly frontal discs hardly determine its direction.
        let sine = DVec2::new(x, y).length();
        let tangent = DVec2::new(x, y).try_normalize()?;
        let curvature = surfel.curvature.along(tangent);
        if curvature <= 0.0 {
            return None;
        }
        let turn_depth = TURN_DEPTH[usize::from(surfel.aspect < 1.0)];
        let below = -turn_depth * surfel.normal.dot(ray) / curvature;
        let distance = self.distance(centre);
        let above = match perspective {
            true => plane - DVec3::X / (distance * (1.0 + below / from_eye)),
            false => DVec3::X * (distance + below) - plane,
        };
        let slope = DVec2::new(above.y, above.z).length();
        // Of the curvature: of its direction, and of its terms.
        let swing = 2.0 * (1.0 - surfel.curvature.ratio()) / sine;
        let error = ROUNDING * surfel.curvature.largest().abs() * (4.0 + swing);
        // Of the depth below the centre: below / (1 ± error) differs by less than twice that.
        let below_error = 2.0 * below * error / (curvature + error);
        let depth = if perspective { 1.0 / distance } else { distance };
        let relative = if perspective { below_error / (from_eye + below) } else { below_error / distance };
        (slope > 0.0).then(|| TurnLine { line: above / slope, error: depth * (ROUNDING + relative) / slope })
    }

    /// The splat of the surfel moved away by ε along the camera's axis (ren2002 §5.1), for the visibility pass of
    /// [`Visibility::Axis`](crate::settings::splatting::Visibility::Axis).
    pub(super) fn moved_footprint(&self, surfel: &Surfel) -> Result<Splat, Culled> {
        let epsilon = f64::from(self.settings.epsilon) * surfel.radius;
        let away = self.to_world(DVec3::new(0.0, 0.0, self.depth.forward));
        let moved = Surfel { position: surfel.position + epsilon * away, ..self.facing_eye(surfel) };
        let shift = if self.depth.perspective { 1.0 } else { 0.0 };
        self.footprint(&moved).map(|splat| Splat { shift, ..splat })
    }

    /// Clip lines on the screen (zwicker2004 §5), each through the images of two points in the tangent plane. `centre`
    /// and `normal` are in eye space.
    fn screen_clip(&self, clip: &Clip, centre: DVec3, normal: DVec3) -> ScreenClip {
        let line = |line: ClipLine| {
            if !line.is_some() {
                return DVec3::INFINITY;
            }
            let outward = self.view.transform_vector3(line.outward.as_dvec3());
            // The half-space's border meets the plane where `outward · (x − centre) = offset`.
            let across = outward.reject_from_normalized(normal);
            let nearest = across * (f64::from(line.offset) / outward.dot(across));
            let point =
                |from_centre: DVec3, w: f64| self.homogeneous_pixel((from_centre + w * centre).extend(w));
            let border = point(nearest, 1.0).cross(point(normal.cross(across), 0.0));
            // A point of the kept side; homogeneous, so that a point behind the eye gives the right sign, too.
            let inside = border.dot(point(nearest - across, 1.0));
            let unit = border.truncate().length() * inside.signum();
            DVec3::new(border.z, border.x, border.y) / unit
        };
        ScreenClip { lines: clip.lines.map(line), concave: clip.concave }
    }

    /// Colour that a splat contributes: shaded, if splats are lit.
    fn splat_colour(&self, albedo: DVec3, normal: DVec3, centre: DVec3) -> DVec3 {
        let Settings { shading, splatting, lighting, .. } = &self.settings;
        if *shading != Shading::Lit || splatting.shade != Shade::Splat {
            return albedo;
        }
        let away = if self.depth.perspective {
            centre - self.eye()
        } else {
            DVec3::new(0.0, 0.0, self.depth.forward)
        };
        lit(lighting, Shine::of_frame(lighting), albedo, normal, -self.to_world(away).normalize())
    }

    /// The semi-axes of the covered disc, eye space.
    pub(super) fn semi_axes(&self, surfel: &Surfel) -> [DVec3; 2] {
        let minor = surfel.aspect * surfel.normal.cross(surfel.major);
        [surfel.major, minor].map(|axis| self.view.transform_vector3(surfel.radius * axis))
    }

    /// The projected centre, px, and the mapping for [`super::conic`], from the semi-axes of the covered disc.
    pub(super) fn tangent_plane(&self, centre: DVec3, semi_axes: [DVec3; 2]) -> (DVec2, DMat3) {
        let [s, t] = semi_axes.map(|axis| axis / self.cutoff());
        let middle = self.project(centre.extend(1.0));
        let ndc = middle.truncate() / middle.z;
        let to_pixels = |v: DVec3| (0.5 * self.size * (v.truncate() - ndc * v.z)).extend(v.z);
        let axis = |v: DVec3| to_pixels(self.project(v.extend(0.0)));
        let mapping = DMat3::from_cols(axis(s), axis(t), DVec3::new(0.0, 0.0, middle.z));
        (0.5 * self.size * (ndc + 1.0), mapping)
    }

    fn shift(&self, radius: f64, distance: f64) -> f64 {
        let epsilon = f64::from(self.settings.epsilon) * radius;
        if self.depth.perspective { 1.0 + epsilon / distance } else { epsilon }
    }

    fn sees(&self, ellipse: &Ellipse) -> bool {
        let (low, high) = ellipse.bounds();
        high.cmpge(DVec2::ZERO).all() && low.cmple(self.size).all()
    }
}
