//! The error panel: comparison with the triangles of files.

use crate::display::{PATIENCE, key};
use crate::matrix::if_whole;
use crate::program::Program;
use crate::view::View;
use crate::{DRAW, setup};
use serde_json::Value;
use std::f32::consts::{PI, TAU};
use std::fmt::Write;
use std::time::{Duration, Instant};

/// Sides of a triangle mesh of the unit sphere: from pole to pole, and around.
const SIDES: [u32; 2] = [24, 48];

/// Positions of controls in a window of this size whose folds above the error are closed, px.
const SIZE: &str = "500x300";
const METHOD: [i16; 2] = [298, 69];
const RENDER_SETTINGS: [i16; 2] = [298, 90];
const ERROR: [i16; 2] = [298, 153];
const AGAINST: [i16; 2] = [350, 174];
const SURFACE: [i16; 2] = [330, 220];
const COMPARE: [i16; 2] = [350, 195];
/// The same below the three lines that say why there is no exact surface.
const COMPARE_WITHOUT_SURFACE: [i16; 2] = [350, 243];

/// A sphere with normals, radii and colours: every `step`th point; triangles only of all.
fn sphere(step: usize) -> String {
    let [rows, columns] = SIDES;
    let point = |i: u32| {
        let (row, column) = (i / columns, i % columns);
        let (down, around) = (PI * (row as f32 + 0.5) / rows as f32, TAU * column as f32 / columns as f32);
        [down.sin() * around.sin(), down.cos(), down.sin() * around.cos()]
    };
    let corner = |row: u32, column: u32| row * columns + column % columns;
    let quads = (0..rows - 1).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let triangles: Vec<[u32; 3]> = quads
        .flat_map(|(r, c)| {
            [
                [corner(r, c), corner(r + 1, c), corner(r + 1, c + 1)],
                [corner(r, c), corner(r + 1, c + 1), corner(r, c + 1)],
            ]
        })
        .collect();
    let points: Vec<_> = (0..rows * columns).step_by(step).collect();
    let triangles = if step == 1 { &triangles[..] } else { &[] };
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", points.len());
    for name in ["x", "y", "z", "nx", "ny", "nz", "radius"] {
        writeln!(text, "property float {name}").unwrap();
    }
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    writeln!(text, "element face {}\nproperty list uchar int vertex_indices\nend_header", triangles.len())
        .unwrap();
    for [x, y, z] in points.into_iter().map(point) {
        let red = (127.0 + 120.0 * y) as u8;
        writeln!(text, "{x} {y} {z} {x} {y} {z} {} {red} 100 50", 0.15 * step as f32).unwrap();
    }
    for [a, b, c] in triangles {
        writeln!(text, "3 {a} {b} {c}").unwrap();
    }
    text
}

/// Opens the error panel and compares the picture with the exact surface, or with what the panel has instead.
fn compare(view: &View<'_>, button: [i16; 2]) {
    for at in [METHOD, RENDER_SETTINGS, ERROR, AGAINST, SURFACE] {
        view.display.click(view.window, at, 1, 1);
        settle(view);
    }
    // A choice that is grey leaves the list open.
    view.display.press(&[], key::ESCAPE);
    settle(view);
    view.display.click(view.window, button, 1, 1);
}

/// Waits until the window rests: folds open over several frames.
fn settle(view: &View<'_>) {
    let start = Instant::now();
    let mut before = view.display.pixels(view.window);
    loop {
        std::thread::sleep(Duration::from_millis(250));
        let now = view.display.pixels(view.window);
        if now == before {
            return;
        }
        before = now;
        assert!(start.elapsed() < PATIENCE, "the window never rests");
    }
}

/// The root mean square error that `surfel compare` finds between `surfel render` and `surfel truth` from a camera.
fn rmse(program: &Program, [points, mesh]: [&str; 2], size: &Value, camera: &str) -> f64 {
    let view = format!("--size {}x{} --camera {camera}", size[0], size[1]);
    program.run(&format!("render {points} {DRAW} {view} -o picture.exr")).text();
    program.run(&format!("truth {mesh} {view} -o truth.exr --no-cache")).text();
    let report: Value =
        serde_json::from_str(program.run("compare picture.exr truth.exr --json -").text()).unwrap();
    report["metrics"]["rmse"].as_f64().unwrap()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_file_with_triangles_is_compared_with_them() {
    let Some((display, program)) = setup("a_file_with_triangles_is_compared_with_them") else { return };
    program.write("mesh.ply", sphere(1)).write("some.ply", sphere(3));
    // The triangles of the mesh that a file's points are a part of, and a file's own.
    let both = [("some.ply --truth mesh.ply", "some.ply"), ("mesh.ply", "mesh.ply")];
    // That a file's own triangles are found, the next test says, too.
    for &(input, points) in &both[..if_whole(2, 1)] {
        let mut view =
            View::open(&display, &program, &format!("{input} --size {SIZE} {DRAW} --fresh --quiet"));
        view.picture(|_| true);
        display.press(&[key::CONTROL], u32::from('s'));
        let camera = view.wrote();
        compare(&view, COMPARE);
        let found = view.next(&["compared", "wrong"], |_| true);
        assert_eq!(found["against"], "exact surface", "{found}");
        let expected = rmse(&program, [points, "mesh.ply"], &found["picture"], &camera);
        let found = found["rmse"].as_f64().unwrap();
        assert!(expected > 1e-3 && (found / expected - 1.0).abs() < 1e-4, "{input}: {found} {expected}");
        view.close();
    }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn triangles_are_read_when_they_are_needed() {
    let Some((display, program)) = setup("triangles_are_read_when_they_are_needed") else { return };
    program.write("mesh.ply", sphere(1));
    let mut view = View::open(&display, &program, &format!("mesh.ply --size {SIZE} {DRAW} --fresh --quiet"));
    view.picture(|_| true);
    // A file that is not that of the points any more.
    program.write("mesh.ply", sphere(3));
    compare(&view, COMPARE);
    let found = view.next(&["compared", "wrong"], |_| true);
    assert!(found["error"].as_str().is_some_and(|error| error.contains("mesh.ply")), "{found}");
    program.write("mesh.ply", sphere(1));
    display.click(view.window, COMPARE, 1, 1);
    let found = view.next(&["compared", "wrong"], |_| true);
    assert_eq!(found["against"], "exact surface", "{found}");
    // The mesh is kept.
    std::fs::remove_file(program.path("mesh.ply")).unwrap();
    display.click(view.window, COMPARE, 1, 1);
    let found = view.next(&["compared", "wrong"], |_| true);
    assert_eq!(found["against"], "exact surface", "{found}");
    view.close();
}

#[test]
fn points_without_triangles_are_compared_with_the_reference_alone() {
    let Some((display, program)) = setup("points_without_triangles_are_compared_with_the_reference_alone")
    else {
        return;
    };
    program.write("p.ply", sphere(3));
    let mut view = View::open(&display, &program, &format!("p.ply --size {SIZE} {DRAW} --fresh --quiet"));
    view.picture(|_| true);
    compare(&view, COMPARE_WITHOUT_SURFACE);
    let found = view.next(&["compared", "wrong"], |_| true);
    assert_eq!(found["against"], "float64 reference", "{found}");
    view.close();
}
