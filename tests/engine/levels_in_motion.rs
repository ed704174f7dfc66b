//! Levels of detail while the camera moves: pictures flicker no more than those of all points, and do not jump where levels change.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use glam::{DMat3, DVec3};
use surfel::geometry::{Camera, Levels};
use surfel::settings::methods::{confetti, perspective_ewa, pull_push};
use surfel::settings::{Settings, Shading};
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{Picture, RenderOptions, Renderer, Scene};

const FRAMES: usize = 5;
/// A turn in each frame, rad, and a dolly relative to the distance.
const TURN: f64 = 0.1 * std::f64::consts::PI / 180.0;
const DOLLY: f64 = 1e-3;
/// Change of a channel, linear, above which a pixel jumps.
const JUMP: f64 = 0.02;

/// How pictures of a moving camera differ from steady change: from the mean of those before and after.
#[derive(Clone, Copy, Debug)]
struct Unsteady {
    /// Root mean square over all pixels.
    flicker: f64,
    /// Pixels a frame of which a channel differs by more than [`JUMP`].
    jumps: f64,
}

impl Unsteady {
    fn of(pictures: &[Picture]) -> Self {
        let (mut squares, mut jumps, mut pixels) = (0.0, 0_u32, 0_u32);
        for of in pictures.windows(3) {
            for ((before, now), after) in of[0].colour.iter().zip(&of[1].colour).zip(&of[2].colour) {
                let differs =
                    [0, 1, 2].map(|k| f64::from(before[k]) - 2.0 * f64::from(now[k]) + f64::from(after[k]));
                squares += differs.iter().map(|d| d * d).sum::<f64>() / 3.0;
                jumps += u32::from(differs.iter().any(|d| d.abs() > JUMP));
                pixels += 1;
            }
        }
        let frames = pictures.len() - 2;
        Self { flicker: (squares / f64::from(pixels)).sqrt(), jumps: f64::from(jumps) / frames as f64 }
    }
}

/// Where the eye is in each frame of a slow turn, and of a slow dolly.
fn paths() -> [Vec<DVec3>; 2] {
    let eye = DVec3::new(1.7, 1.37, 2.73);
    let turned = |frame| DMat3::from_rotation_y(TURN * frame as f64) * eye;
    let nearer = |frame| eye * (1.0 - DOLLY).powi(frame as i32);
    [(0..FRAMES).map(turned).collect(), (0..FRAMES).map(nearer).collect()]
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn pictures_are_as_steady_as_those_of_all_points() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let points = if_whole(2_000_000, 100_000);
    let size = [if_whole(512, 80); 2];
    let levels = Levels::of(scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap()).unwrap();
    let scene = Scene::upload(&device, &levels).unwrap();
    let mut renderer = Renderer::new(&device, RenderOptions { size, ..Default::default() }).unwrap();
    println!(
        "{points} points at {}²: flicker of a turn, linear; px that jump in a frame of a dolly",
        size[0]
    );
    println!("| method | all points | 2 px | 6 px |");
    let methods = [perspective_ewa::METHOD, confetti::METHOD, pull_push::METHOD];
    for method in methods.into_iter().step_by(if_whole(1, 2)) {
        let [all, two, six] = [0.0, 2.0, 6.0].map(|lod| {
            let settings =
                Settings { lod, shading: Shading::Lit, background: Some([0.0; 3]), ..method.settings() };
            paths().map(|path| {
                let picture = |eye| {
                    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), 1.0, 0.1);
                    renderer.render_picture(&scene, &camera.unwrap(), &settings).unwrap().0
                };
                Unsteady::of(&path.into_iter().map(picture).collect::<Vec<_>>())
            })
        });
        let cell = |[turn, dolly]: [Unsteady; 2]| format!("{:.4}, {:.0}", turn.flicker, dolly.jumps);
        println!("| {} | {} |", method.name, [all, two, six].map(cell).join(" | "));
        assert!(two[0].flicker <= 1.5 * all[0].flicker, "{}: {two:?}, all points {all:?}", method.name);
        assert!(six[1].jumps <= 3.0 * all[1].jumps, "{}: {six:?}, all points {all:?}", method.name);
    }
    assert_silent(&device);
}
