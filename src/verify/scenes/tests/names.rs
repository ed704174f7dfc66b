//! Names and parameters of scenes.

use crate::Error;
use crate::geometry::{Camera, Colours};
use crate::verify::scenes::query::Query;
use crate::verify::scenes::{SAMPLING, bumpy_sphere, camera, is_scene, list, model, open, surface};

#[test]
fn every_listed_scene_opens_in_morton_order() {
    for scene in list() {
        assert!(is_scene(scene.name));
        let surfels = open(&format!("{}?points=1000&seed=5", scene.name)).unwrap();
        let mut sorted = surfels.clone();
        sorted.sort_morton();
        assert_eq!((surfels.len(), &sorted), (1000, &surfels), "{}", scene.name);
    }
    assert!(!is_scene("bunny.ply"));
}

#[test]
fn defaults_are_values_that_may_be_given() {
    for scene in list() {
        let all: Vec<_> = scene.parameters().map(|p| format!("{}={}", p.name, p.default)).collect();
        let text = format!("{}?{}", scene.name, all.join("&"));
        let query = Query::parse(&text).unwrap();
        for parameter in SAMPLING.iter().chain(scene.surface_parameters) {
            assert_eq!(query.word(parameter.name), parameter.default);
        }
        assert!(Query::parse(scene.name).unwrap().whole("points") == 100_000);
    }
}

#[test]
fn the_comparison_scene_keeps_its_samples() {
    let mut expected = bumpy_sphere::sample(3000, 9);
    expected.sort_morton();
    assert_eq!(open("scene:bumpy-sphere?seed=9&points=3000").unwrap(), expected);
    assert_ne!(
        open("scene:bumpy-sphere?seed=9&points=3000&sampler=grid").unwrap().positions,
        expected.positions
    );
}

#[test]
fn parameters_change_the_surface() {
    let area = |text: &str| surface(text).unwrap().area();
    assert!(area("scene:torus?minor=0.2") < 0.6 * area("scene:torus"));
    assert!(area("scene:slabs?slabs=6") > 1.9 * area("scene:slabs"));
    let tree =
        |growth: u32| surface(&format!("scene:tree?depth=1&growth={growth}&points=5")).unwrap().bounds();
    assert_eq!(tree(3), tree(3));
    assert_ne!(tree(3), tree(4));
}

/// The recommended camera shows much of the surface, and almost all rays through the middle of the picture hit it or
/// pass near it.
#[test]
fn cameras_show_their_scenes() {
    for scene in list() {
        let (view, surface) = (camera(scene.name).unwrap(), surface(scene.name).unwrap());
        let camera: Camera = view.camera(1.0, &surface.bounds()).unwrap();
        let inverse = camera.view.inverse();
        let half = (0.5 * view.fov_y_deg.to_radians()).tan();
        let ray = |i: u32| {
            let across = |i: u32| half * (2.0 * (f64::from(i) + 0.5) / 32.0 - 1.0);
            inverse.transform_vector3(glam::DVec3::new(across(i % 32), across(i / 32), 1.0))
        };
        let met = (0..1024).filter(|i| surface.trace(view.eye.into(), ray(*i)).is_some()).count();
        assert!(met > 80, "{}: {met} of 1024 rays", scene.name);
        if scene.name == "scene:relief" {
            assert_eq!(met, 1024, "the relief fills the picture");
        }
    }
}

#[test]
fn mistakes_are_answered_with_what_exists() {
    for (text, expected) in [
        ("scene:teapot", "give scene:bumpy-sphere, scene:sphere, scene:disc, scene:torus"),
        (
            "scene:sphere?minor=0.3",
            "no parameter `minor`: give points, seed, sampler, noise, scans, outliers, albedo or frequency",
        ),
        ("scene:bumpy-sphere?points=1e5", "points is `1e5`: give a whole number from 1 to 100000000"),
        ("scene:bumpy-sphere?points", "points is ``"),
        ("scene:bumpy-sphere?seed=-1", "seed is `-1`: give a whole number, 0 or more"),
        ("scene:bumpy-sphere?points=0", "points is `0`: give a whole number from 1 to 100000000"),
        ("scene:bumpy-sphere?points=100000001", "points is `100000001`"),
        ("scene:bumpy-sphere?points=1&points=2", "points is given twice"),
        ("scene:torus?minor=nan", "minor is `nan`: give a number from 0.01 to 0.99"),
        ("scene:torus?sampler=random", "give jittered, blue-noise, grid or scanner"),
    ] {
        let error = open(text).unwrap_err();
        assert!(
            matches!(&error, Error::Usage(cause) if cause.starts_with(text) && cause.contains(expected)),
            "{error}"
        );
        assert_eq!(surface(text).err().unwrap().to_string(), error.to_string());
    }
}

#[test]
fn tubes_and_ribbons_are_lines_or_triangles() {
    let primitives =
        |value| model(&format!("scene:tree?depth=0&segments=12&primitives={value}")).unwrap().primitives;
    // A branch and six leaves.
    let lines = primitives("on");
    assert_eq!((lines.tubes.len(), lines.ribbons.len(), lines.triangles.len()), (12, 6 * 12, 0));
    let triangles = primitives("triangles");
    assert_eq!((triangles.tubes.len(), triangles.ribbons.len()), (0, 0));
    assert_eq!(triangles.triangles.len(), 12 * 3 * 2 + 6 * 12 * 2);
    // Scenes without the parameter have surfels alone.
    assert_eq!(model("scene:sphere?points=10").unwrap().surfels.len(), 10);
}

#[test]
fn a_single_surfel_of_the_disc_is_the_disc() {
    let disc = open("scene:disc?points=1").unwrap();
    assert_eq!((disc.len(), disc.radii[0], disc.colours), (1, 1.0, Some(Colours::Linear(vec![[1.0; 3]]))));
    assert_eq!(open("scene:disc?points=50").unwrap().len(), 50);
}
