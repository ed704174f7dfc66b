//! What is not drawn of a scene, why, and what to do about it.

use super::render::Task;
use super::summary;
use glam::{DVec2, DVec3, DVec4};
use surfel::geometry::{Bounds, Camera, Model, Parts, Surfels};
use surfel::settings::Cull;
use surfel::{Error, Picture, Settings, thousands};

/// Part of the surfels above which their culling is reported.
const MANY: f64 = 0.9;
/// Part of the pixels below which a picture counts as empty.
const FEW: f64 = 1e-3;
/// Coverage, and difference from the background, above which a pixel counts as covered.
const COVERED: f32 = 2e-3;
/// Diameter below which surfels are too small to be seen, px.
const SMALL: f64 = 0.1;

/// The error for inputs of which nothing can be drawn.
pub fn nothing(name: &str, Model { surfels, primitives }: &Model) -> Error {
    let largest = Surfels::LARGEST;
    let far = surfels.positions.iter().filter(|at| at.abs().max_element() > largest).count();
    let large = surfels.radii.iter().filter(|radius| **radius > largest).count();
    let all = thousands(surfels.len() as u64);
    let why = match surfels.len() {
        0 if primitives.is_empty() => "it holds nothing that can be drawn: give a file with points".into(),
        0 => format!(
            "all {} are invalid: coordinates, directions or radii are not finite or exceed {largest:e}: scale the file",
            summary::parts(&Model { surfels: Surfels::default(), primitives: primitives.clone() })
        ),
        _ if 2 * far >= surfels.len() => {
            format!("all {all} surfels are invalid: coordinates exceed {largest:e}: scale the file")
        }
        _ if 2 * large >= surfels.len() => {
            format!(
                "all {all} surfels are invalid: radii exceed {largest:e}: give smaller ones, as by --radius"
            )
        }
        _ => format!(
            "all {all} surfels are invalid: a radius or a normal is 0 or not finite: write the file again"
        ),
    };
    Error::input(name, why)
}

/// A line for the user, if nearly all surfels face away from the camera and are therefore not drawn.
pub fn culled_backs(surfels: &Surfels, camera: &Camera, settings: &Settings) -> Option<String> {
    let projection = camera.projection().ok().filter(|_| settings.cull == Cull::Back)?;
    let (eye, forward) =
        (camera.view.inverse().w_axis.truncate(), projection.forward * camera.view.row(2).truncate());
    let is_two_sided = |i: usize| surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
    let is_back = |&i: &usize| {
        let ray = if projection.perspective {
            surfels.positions[i].as_dvec3() + surfels.origin - eye
        } else {
            forward
        };
        ray.dot(surfels.normals[i].as_dvec3()) >= 0.0 && !is_two_sided(i) && !surfels.is_billboard(i)
    };
    let part = (0..surfels.len()).filter(is_back).count() as f64 / surfels.len().max(1) as f64;
    (part > MANY).then(|| {
        format!(
            "{:.0} % of the surfels face away from the camera and are not drawn: give --cull none, or an --eye on their other side",
            100.0 * part
        )
    })
}

/// Options that may be the cause of an empty picture, as far as they are given.
pub struct Given {
    /// Those of the camera.
    pub camera: Vec<&'static str>,
    /// That of the radii.
    pub radius: Option<&'static str>,
    /// Whether there are several inputs.
    pub several: bool,
}

impl Given {
    /// What to do about a camera that does not see the scene.
    fn other_camera(&self, without: &str) -> String {
        let it = if self.camera.len() > 1 { "them" } else { "it" };
        match self.camera.join(" and ") {
            none if none.is_empty() => without.into(),
            options => format!("leave out {options}, or give {it} in the file's coordinates"),
        }
    }

    /// What to do about surfels that are too small.
    fn larger_surfels(&self) -> String {
        match self.radius {
            Some(option) => format!("leave out {option}, or give a larger one"),
            None if self.several => "give one input alone, or a larger --radius".into(),
            None => self.other_camera("give a larger --radius"),
        }
    }
}

/// A warning, if hardly anything is drawn in the picture of a task whose scene has these bounds.
pub fn empty_picture(picture: &Picture, task: &Task<'_>, bounds: &Bounds, given: &Given) -> Option<String> {
    let part = covered(picture, &task.settings);
    if part >= FEW {
        return None;
    }
    let Seen { inside, diameter, area } = seen(task.scene, &task.camera, task.size);
    let scene = described(bounds, &task.camera);
    let has_triangles = task.scene.primitives.is_some_and(|all| !all.triangles.is_empty());
    let is_sized = !has_triangles && !task.settings.draws_points();
    if inside == 0 {
        let remedy = given.other_camera("give a camera that sees it");
        Some(format!("no surfel is in the picture: {scene}: {remedy}"))
    } else if is_sized && diameter < SMALL {
        let remedy = given.larger_surfels();
        Some(format!("the surfels are at most {diameter:.1e} px wide in the picture: {scene}: {remedy}"))
    } else if area < FEW {
        let remedy = given.other_camera("give an --eye nearby");
        Some(format!("the scene has {:.1e} % of the picture: {scene}: {remedy}", 100.0 * area))
    } else {
        // A background may have the colour of the scene.
        let is_empty = part == 0.0 && task.settings.background.is_none();
        let inside = thousands(inside as u64);
        let text = format!(
            "nothing is drawn, though {inside} surfels are in the picture: give --cull none, or another --method"
        );
        is_empty.then_some(text)
    }
}

/// Part of the pixels that something is drawn on.
fn covered(picture: &Picture, settings: &Settings) -> f64 {
    let background = settings.background.filter(|_| settings.shading.is_coloured());
    let is_covered = |pixel: &&[f32; 4]| match background {
        Some(background) => pixel.iter().zip(background).any(|(a, b)| (a - b).abs() > COVERED),
        None => pixel[3] > COVERED,
    };
    picture.colour.iter().filter(is_covered).count() as f64 / picture.colour.len().max(1) as f64
}

/// What a camera sees of a scene.
struct Seen {
    /// Number of surfels and vertices of lines and triangles with a centre in the picture.
    inside: usize,
    /// The largest diameter of these, px.
    diameter: f64,
    /// Area of the box around them, as a part of the picture.
    area: f64,
}

fn seen(scene: Parts<'_>, camera: &Camera, size: [u32; 2]) -> Seen {
    let [width, height] = size.map(f64::from);
    let (to_clip, scale) = (camera.world_to_clip(), height * camera.projection.y_axis.y.abs());
    let (mut inside, mut diameter) = (0, 0.0f64);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let primitives = scene.primitives.map(|all| (all.origin, &all.positions, &all.radii));
    let surfels = (scene.surfels.origin, &scene.surfels.positions, &scene.surfels.radii);
    for (origin, positions, radii) in [surfels].into_iter().chain(primitives) {
        for (at, radius) in positions.iter().zip(radii) {
            let DVec4 { x, y, z, w } = to_clip * (origin + at.as_dvec3()).extend(1.0);
            if x.abs() <= w && y.abs() <= w && (0.0..=w).contains(&z) {
                let at = DVec2::new(x, y) / w;
                (low, high) = (low.min(at), high.max(at));
                inside += 1;
                diameter = diameter.max(scale * f64::from(*radius) / w);
            }
        }
    }
    // Clip space is 2 wide and high.
    let box_of = 0.5 * (high - low).max(DVec2::ZERO) + diameter / DVec2::new(width, height);
    Seen { inside, diameter, area: box_of.x * box_of.y }
}

/// Middle and width of a scene and the position of the eye, in words.
fn described(bounds: &Bounds, camera: &Camera) -> String {
    let width = (bounds.max - bounds.min).max_element();
    let eye = camera.view.inverse().w_axis.truncate();
    let [scene, eye] = [bounds.centre(), eye].map(|at| point(at, width));
    let wide = if (1e3..1e18).contains(&width) { thousands(width as u64) } else { short(width, width) };
    format!("the scene is around {scene} and {wide} wide, the eye is at {eye}")
}

/// Coordinates, as exact as the width of the scene needs.
fn point(at: DVec3, width: f64) -> String {
    at.to_array().map(|coordinate| short(coordinate, width)).join(", ")
}

/// A number in whole steps of about a hundredth of a width.
fn short(number: f64, width: f64) -> String {
    let exponent = if width > 0.0 { width.log10().floor() as i32 - 2 } else { -3 };
    let step = 10f64.powi(exponent);
    let rounded = (number / step).round() * step;
    let rounded = if rounded.is_finite() { rounded } else { number };
    let digits = (-exponent).clamp(0, 12) as usize;
    let text = format!("{:.digits$}", if rounded == 0.0 { 0.0 } else { rounded });
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_exact_as_the_scene_is_wide() {
        let far = [636_589.4, 849_219.0, 463.3, 1343.0].map(|number| short(number, 1343.0));
        assert_eq!(far, ["636590", "849220", "460", "1340"]);
        let near = [0.123_456, -0.000_01, 1e20, 2.0].map(|number| short(number, 0.5));
        assert_eq!(near, ["0.123", "0", "100000000000000000000", "2"]);
        assert_eq!(short(0.5, 0.0), "0.5");
    }

    #[test]
    fn pixels_that_differ_from_the_background_are_covered() {
        let white = Settings { background: Some([1.0; 3]), ..Default::default() };
        let colour = vec![[1.0; 4], [1.0; 4], [1.0, 0.9, 1.0, 1.0], [0.0; 4]];
        let picture = Picture { size: [4, 1], colour, ..Default::default() };
        assert_eq!(covered(&picture, &white), 0.5);
        assert_eq!(covered(&picture, &Settings { background: None, ..white }), 0.75);
    }

    #[test]
    fn a_model_that_cannot_be_drawn_has_its_cause() {
        let one = |at: f32, radius: f32| Surfels {
            positions: vec![glam::Vec3::splat(at)],
            normals: vec![glam::Vec3::Z],
            radii: vec![radius],
            ..Default::default()
        };
        let text = |surfels: Surfels| nothing("a.ply", &surfels.into()).to_string();
        assert!(
            text(one(1e20, 1.0))
                .starts_with("a.ply: all 1 surfels are invalid: coordinates exceed 1e15: scale")
        );
        assert!(text(one(1.0, f32::INFINITY)).contains("radii exceed 1e15"));
        assert!(text(one(1.0, 0.0)).contains("a radius or a normal is 0"));
        assert!(text(Surfels::default()).contains("nothing that can be drawn"));
    }
}
