//! Tests of the view state.

use super::*;
use crate::viewer::directions::ViewDirection;
use crate::viewer::tests::device;
use crate::viewer::{Events, Loaded, SaveFolder};
use glam::Vec3;
use std::collections::HashSet;
use std::time::Instant;
use surfel::frame::faster::FasterRasterizers;
use surfel::geometry::{Model, Primitives, Surfels};
use surfel::verify::scenes;
use surfel::vk::DeviceOptions;

/// The state of an empty window.
pub fn state() -> ViewState {
    let options = Options {
        inputs: Vec::new(),
        filter: Filter::default(),
        size: [640, 480],
        device: DeviceOptions::default(),
        rasterizer: None,
        faster: FasterRasterizers::default(),
        budget: 60.0,
        fov_y_deg: 45.0,
        initial_camera: Box::new(|_, _, _| None),
        watch: false,
        events: Events::new(Instant::now(), false),
        save_folder: SaveFolder { path: ".".into(), print_names: false },
        remedy: |_| "",
        settings_file: None,
        method_chosen: false,
    };
    ViewState::new(&options, Box::new(Method::settings), SavedSettings::default())
}

/// The origin of a scene that is no reload.
pub fn origin(load: u64, preview: bool) -> SceneOrigin {
    SceneOrigin { load, preview, reload: false }
}

/// A method and a source without a model, for scenes of any.
pub fn loaded(method: Method) -> (Method, Source) {
    (method, Source::new(Loaded::new(Surfels::default().into(), method)))
}

/// A sphere of points.
pub fn sphere(device: &Arc<Device>, points: u32) -> Arc<Scene> {
    let sphere = scenes::open(&format!("scene:sphere?points={points}")).unwrap();
    Arc::new(Scene::upload(device, &sphere).unwrap())
}

/// A line.
pub fn lines(device: &Arc<Device>) -> Arc<Scene> {
    let primitives = Primitives {
        positions: vec![Vec3::ZERO, Vec3::X],
        directions: vec![Vec3::X; 2],
        radii: vec![0.1; 2],
        tubes: vec![[0, 1]],
        ..Default::default()
    };
    let model = Model { surfels: Surfels::default(), primitives };
    Arc::new(Scene::upload(device, &model).unwrap())
}

#[test]
fn methods_that_cannot_render_the_scene_are_skipped() {
    let Some(device) = device("methods_that_cannot_render_the_scene_are_skipped") else { return };
    let pull_push = Method::named("pull-push").unwrap();
    for (scene, reached) in [(lines(&device), 2), (sphere(&device, 10), Method::ALL.len())] {
        for action in [Action::NextMethod, Action::PreviousMethod] {
            let mut state = state();
            state.set_scene(scene.clone(), loaded(pull_push), origin(1, false));
            let names = (0..Method::ALL.len()).map(|_| {
                state.act(action);
                let choices = state.choices().unwrap();
                assert!(choices.can_render(choices.settings), "{}", choices.method.name);
                choices.method.name
            });
            assert_eq!(names.collect::<HashSet<_>>().len(), reached);
        }
    }
}

#[test]
fn equal_pictures_have_equal_content() {
    let Some(device) = device("equal_pictures_have_equal_content") else { return };
    let mut state = state();
    let scenes = [sphere(&device, 10), sphere(&device, 10)];
    state.set_scene(scenes[0].clone(), loaded(Method::ALL[0]), origin(1, false));
    let content = |state: &mut ViewState| state.choices().unwrap().content().unwrap();
    let first = content(&mut state);
    assert!(first == content(&mut state));
    assert_eq!(first.settings.lod, 1.0, "that of the window at rest");
    state.version += 1;
    assert!(first != content(&mut state), "another appearance");
    state.version -= 1;
    state.set_levels(scenes[1].clone());
    assert!(first != content(&mut state), "another scene");
    state.set_levels(scenes[0].clone());
    assert!(first == content(&mut state));
    state.act(Action::NextShading);
    assert!(first != content(&mut state), "other settings");
}

#[test]
fn a_preview_gives_way_to_the_scene_before_or_to_the_whole_scene() {
    let Some(device) = device("a_preview_gives_way_to_the_scene_before_or_to_the_whole_scene") else {
        return;
    };
    let scene = |points: u32| sphere(&device, points);
    let loaded = || loaded(Method::ALL[0]);
    let surfels = |state: &ViewState| state.scene_and_settings().map(|(scene, _)| scene.count());
    let mut state = state();
    state.set_scene(scene(10), loaded(), origin(1, true));
    assert_eq!((surfels(&state), state.is_preview()), (Some(10), true));
    assert!(state.title().starts_with("preview of "), "{}", state.title());
    state.leave_preview();
    assert_eq!(surfels(&state), None, "nothing was shown before");
    state.set_scene(scene(10), loaded(), origin(2, true));
    let eye = |state: &mut ViewState| state.orbit_mut().unwrap().0.eye;
    // The whole scene keeps the camera that was moved before its preview.
    let (orbit, ..) = state.orbit_mut().unwrap();
    orbit.view_from(ViewDirection::Top);
    let above = eye(&mut state);
    state.set_scene(scene(100), loaded(), origin(2, false));
    assert_eq!((surfels(&state), state.is_preview(), eye(&mut state)), (Some(100), false, above));
    assert!(!state.title().contains("preview"), "{}", state.title());
    state.set_scene(scene(10), loaded(), origin(3, true));
    state.set_scene(scene(20), loaded(), origin(4, true));
    assert_ne!(eye(&mut state), above);
    state.leave_preview();
    assert_eq!((surfels(&state), eye(&mut state)), (Some(100), above));
    // A reloaded scene keeps the camera.
    state.set_scene(scene(50), loaded(), SceneOrigin { load: 5, preview: false, reload: true });
    assert_eq!((surfels(&state), eye(&mut state)), (Some(50), above));
    state.set_levels(scene(40));
    assert_eq!((surfels(&state), eye(&mut state)), (Some(40), above));
    state.set_scene(scene(30), loaded(), origin(6, false));
    assert_eq!(surfels(&state), Some(30));
    assert_ne!(eye(&mut state), above);
}
