//! `surfel render` on a Vulkan device, always under the validation layers.

use crate::matrix::if_whole;
use crate::program::{Program, plain, scan};
use std::f64::consts::PI;

const SPHERE: &str = "scene:bumpy-sphere?points=20000";

/// Mean difference of two pictures, in codes.
fn difference(a: &image::RgbaImage, b: &image::RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let sum: u64 = a.iter().zip(b.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.len() as f64
}

#[test]
fn every_shading_matches_the_reference() {
    let Some(program) = Program::with_device("every_shading_matches_the_reference") else { return };
    for (i, shading) in ["lit", "color", "normal", "depth"].into_iter().enumerate() {
        let common = format!("render {SPHERE} --size 96x64 --background 20,40,80 --shading {shading}");
        program.run(&format!("{common} -o cpu.png --reference")).text();
        let cpu = program.png("cpu.png");
        assert!(cpu.get_pixel(48, 32) != cpu.get_pixel(0, 0), "{shading}: nothing in the middle");
        for rasterizer in &["compute", "draw"][if_whole(0..2, i % 2..i % 2 + 1)] {
            program.run(&format!("{common} -o gpu.png --validate --rasterizer {rasterizer}")).text();
            let apart = difference(&program.png("gpu.png"), &cpu);
            assert!(apart < 0.1, "{shading} {rasterizer}: {apart} codes");
        }
    }
}

#[test]
fn pull_push_matches_the_reference() {
    let Some(program) = Program::with_device("pull_push_matches_the_reference") else { return };
    // Under the paper's rules rounding flips more decisions: ellipses end between the centres of a few pixels.
    let cases = [("pull-push", "lit", 0.1), ("pull-push-paper", "normal", 0.3), ("pull-push", "depth", 0.1)];
    let mut seen = Vec::new();
    for (method, shading, most) in cases.into_iter().take(if_whole(3, 2)) {
        let common = format!(
            "render {SPHERE} --size 96x64 --background 20,40,80 --method {method} --shading {shading}"
        );
        program.run(&format!("{common} -o cpu.png --reference")).text();
        program.run(&format!("{common} -o gpu.png --validate")).text();
        let (cpu, gpu) = (program.png("cpu.png"), program.png("gpu.png"));
        assert!(cpu.get_pixel(48, 32) != cpu.get_pixel(0, 0), "{method} {shading}: nothing in the middle");
        let apart = difference(&gpu, &cpu);
        assert!(apart < most, "{method} {shading}: {apart} codes");
        seen.push(gpu);
    }
    let robust =
        format!("render {SPHERE} --size 96x64 --background 20,40,80 --method pull-push --shading normal");
    program.run(&format!("{robust} -o gpu.png --validate")).text();
    let between = difference(&program.png("gpu.png"), &seen[1]);
    assert!(between > 1.0, "both rules make one picture: {between} codes");
    let run = program.run(&format!("render {SPHERE} -o a.png --method pull-push --kernel confetti:6,3"));
    assert!(run.code == 2 && run.err.contains("pull-push has no splats"), "{} {}", run.code, run.err);
}

#[test]
fn points_of_a_fixed_size_need_no_estimation() {
    let Some(program) = Program::with_device("points_of_a_fixed_size_need_no_estimation") else { return };
    let rows = (0..40).flat_map(|y| (0..40).map(move |x| format!("{x} {y} 0 200 {x} {y}\n")));
    program.write("a.xyz", format!("//x y z red green blue\n{}", rows.collect::<String>()));
    // A point every 10 px; the others' rows are empty.
    let common = "render a.xyz --size 400x400 --eye 20,20,50 --target 20,20,0 --parallel 40";
    let run = program.run(&format!("{common} -o gpu.png --point-size 4 --validate --json report.json"));
    run.text();
    assert!(!run.err.contains("normals") && !run.err.contains("shaded"), "{}", run.err);
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(program.path("report.json")).unwrap()).unwrap();
    let settings = &report["settings"];
    assert_eq!((&report["method"], &settings["footprint"]), (&"points".into(), &"point".into()));
    assert_eq!((&settings["point_size"], &settings["shading"]), (&4.0.into(), &"edl".into()));
    assert_eq!(report["estimated"]["normals"]["from_neighbours"], 0);
    let covered = |name: &str| program.png(name).pixels().filter(|pixel| pixel[3] > 0).count() as f64;
    // Half of the points of the outermost rows are in the picture.
    let expected = std::f64::consts::PI * 4.0 * 39.5 * 39.5;
    assert!((covered("gpu.png") / expected - 1.0).abs() < 0.1, "{} for {expected}", covered("gpu.png"));
    program.run(&format!("{common} -o cpu.png --point-size 4 --reference")).text();
    assert!(difference(&program.png("gpu.png"), &program.png("cpu.png")) < 0.1);
    program.run(&format!("{common} -o two.png --method points --every 2")).text();
    assert!(covered("two.png") > 0.0 && 3.0 * covered("two.png") < covered("gpu.png"));
    let wrong = program.run(&format!("{common} -o a.png --point-size 3 --method sprites"));
    assert!(
        wrong.error(2).contains("--point-size 3 is of --method points, and sprites draws discs"),
        "{}",
        wrong.err
    );
    for size in ["0.5", "65", "nan"] {
        let wrong = program.run(&format!("{common} -o a.png --point-size {size}"));
        assert!(wrong.error(2).contains("from 1 to 64"), "{}", wrong.err);
    }
}

#[test]
fn standard_output_takes_a_png_and_nothing_else() {
    let Some(program) = Program::with_device("standard_output_takes_a_png_and_nothing_else") else { return };
    let plain = plain();
    let sphere = "scene:bumpy-sphere?points=1000";
    let run = program.run(&format!("render {sphere} {plain} -o - --size 17x9 --validate --times"));
    assert_eq!(run.code, 0, "{}", run.err);
    let picture = image::load_from_memory_with_format(&run.out, image::ImageFormat::Png).unwrap();
    assert_eq!((picture.width(), picture.height()), (17, 9));
    assert!(run.err.contains("\n-: 17x9, 1,000 surfels\n"), "{}", run.err);
    assert!(program.files().is_empty());
}

#[test]
fn a_summary_is_printed_unless_quiet() {
    let Some(program) = Program::with_device("a_summary_is_printed_unless_quiet") else { return };
    let plain = plain();
    let render = format!("render scene:bumpy-sphere?points=1000 {plain} -o a.png --size 8x8 --validate");
    let loud = program.run(&render);
    assert_eq!((loud.text(), loud.err.as_str()), ("", "a.png: 8x8, 1,000 surfels\n"));
    let quiet = program.run(&format!("{render} --quiet"));
    assert_eq!((quiet.text(), quiet.err.as_str()), ("", ""));
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_single_pixel_and_a_single_row_are_pictures() {
    let Some(program) = Program::with_device("a_single_pixel_and_a_single_row_are_pictures") else { return };
    for (size, width, height) in [("1x1", 1, 1), ("300x1", 300, 1), ("1x300", 1, 300)] {
        program.run(&format!("render {SPHERE} -o a.png --validate --size {size}")).text();
        let picture = program.png("a.png");
        assert_eq!(picture.dimensions(), (width, height));
        assert!(picture.get_pixel(width / 2, height / 2)[3] > 64, "{size}: nothing in the middle");
    }
}

/// lavapipe's subgroups are as wide as its vectors: 4, 8 or 16 lanes. Other devices ignore the variable.
#[test]
fn pictures_do_not_depend_on_the_width_of_vectors() {
    let Some(program) = Program::with_device("pictures_do_not_depend_on_the_width_of_vectors") else {
        return;
    };
    let all = [
        "--alpha mask",
        "--method sprites-unfiltered",
        "--alpha coverage",
        "--method confetti",
        "--visibility axis",
    ];
    // lavapipe takes 10 to 30 s to compile one of the others for another width.
    for options in &all[..if_whole(5, 1)] {
        let pictures = ["128", "256", "512"][..if_whole(3, 2)].iter().map(|width| {
            let name = format!("{width}.exr");
            let arguments = format!(
                "render {SPHERE} {options} --layers depth,normal --size 200x150 --validate -o {name}"
            );
            program.run_with(&arguments, &[("LP_NATIVE_VECTOR_WIDTH", width)]).text();
            std::fs::read(program.path(&name)).unwrap()
        });
        let pictures: Vec<_> = pictures.collect();
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "{options}");
    }
}

#[test]
fn a_size_over_the_limit_is_refused_with_the_limit() {
    let Some(program) = Program::with_device("a_size_over_the_limit_is_refused_with_the_limit") else {
        return;
    };
    program.write("limits.json", r#"{"max_image_side":64}"#);
    let plain = plain();
    let run = |size: &str| {
        let limited = format!("--device-limits limits.json --size {size}");
        program.run(&format!("render {SPHERE} {plain} -o a.png --validate {limited}"))
    };
    for size in ["65x1", "1x65", "4294967295x4294967295"] {
        assert!(run(size).error(2).contains("1x1 to 64x64"));
    }
    assert_eq!(program.files(), ["limits.json"]);
    run("64x64").text();
    let run = program.run(&format!("render {SPHERE} -o b.png --validate --size 1000000x1"));
    assert!(run.error(2).contains("1000000x1 px: "), "{}", run.err);
    program.write("limits.json", r#"{"max_side":64}"#);
    let run = program.run(&format!("render {SPHERE} -o b.png --device-limits limits.json"));
    assert!(run.error(1).contains("limits.json: unknown field `max_side`"), "{}", run.err);
}

#[test]
fn validation_messages_are_errors() {
    let Some(program) = Program::with_device("validation_messages_are_errors") else { return };
    let advice = [("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT")];
    let plain = plain();
    let arguments = format!("render scene:bumpy-sphere?points=1000 {plain} -o a.png --size 8x8");
    let run = program.run_with(&format!("{arguments} --validate"), &advice);
    assert_eq!(run.code, 70, "{}", run.err);
    assert!(run.err.contains("surfel: error: validation: "), "{}", run.err);
    // They are errors at any log level.
    let silent = program.run_with(&format!("{arguments} --validate"), &[advice[0], ("RUST_LOG", "off")]);
    assert_eq!(silent.code, 70, "{}", silent.err);
    assert_eq!(program.run_with(&arguments, &advice).code, 0);
}

#[test]
fn scans_are_rendered() {
    let Some(program) = Program::with_device("scans_are_rendered") else { return };
    for name in &["classic/bunny16k.ply", "classic/chameleon4k.ply"][..if_whole(2, 1)] {
        let Some(path) = scan(name) else { return };
        let run =
            program.run(&format!("render {} -o a.png --size 128x128 --validate --times", path.display()));
        assert!(run.text().is_empty() && run.err.contains(" surfels\n"), "{}", run.err);
        let covered = program.png("a.png").pixels().filter(|pixel| pixel[3] == 255).count();
        assert!((500..10_000).contains(&covered), "{name}: {covered} pixels");
    }
}

#[test]
fn point_ids_are_a_layer() {
    let Some(program) = Program::with_device("point_ids_are_a_layer") else { return };
    let render = |more: &str| program.run(&format!("render {SPHERE} --size 64x64 --layers id {more}"));
    let ids = |name: &str| surfel::formats::image::read(&program.path(name)).unwrap().id.unwrap();
    render("-o gpu.exr --method pull-push --validate").text();
    render("-o cpu.exr --method pull-push --reference").text();
    let [gpu, cpu] = ["gpu.exr", "cpu.exr"].map(ids);
    let differ = gpu.iter().zip(&cpu).filter(|(a, b)| a != b).count();
    assert!(differ < 10 && gpu[32 * 64 + 32] < 20_000 && gpu[0] == surfel::Picture::NOBODY, "{differ}");
    for more in ["-o a.exr", "-o a.exr --reference"] {
        assert!(render(more).error(2).contains("only pull-push and pull-push-paper have point ids"));
    }
    assert!(program.run(&format!("truth {SPHERE} -o a.exr --layers id")).error(2).contains("leave it out"));
}

#[test]
fn textures_come_from_the_file_or_the_command_line() {
    let Some(program) = Program::with_device("textures_come_from_the_file_or_the_command_line") else {
        return;
    };
    let picture =
        |red: u8| image::RgbImage::from_fn(4, 4, |x, _| image::Rgb([red, if x < 2 { 0 } else { 200 }, 0]));
    picture(0).save(program.path("own.png")).unwrap();
    picture(250).save(program.path("given.png")).unwrap();
    let corner =
        |i: i32, j: i32| format!("{i} {j} 0 0 0 1 0.2 {} {}\n", f64::from(i) / 16.0, f64::from(j) / 16.0);
    let points: String = (0..=16).flat_map(|j| (0..=16).map(move |i| corner(i, j))).collect();
    let properties: String = ["x", "y", "z", "nx", "ny", "nz", "radius", "u", "v"]
        .map(|p| format!("property float {p}\n"))
        .concat();
    let header = format!(
        "ply\nformat ascii 1.0\ncomment TextureFile own.png\nelement vertex 289\n{properties}end_header\n"
    );
    program.write("points.ply", header + &points);
    let common = "points.ply --radius-scale 5 --size 64x64 --shading color --eye 8,8,30 --target 8,8,0";
    for method in &["pull-push", "perspective-ewa", "pull-push-paper"][..if_whole(3, 1)] {
        for (texture, red) in [("", 0), ("--texture given.png", 250)] {
            program.run(&format!("render {common} --method {method} {texture} -o a.png --validate")).text();
            let picture = program.png("a.png");
            let [left, right] = [22, 42].map(|x| picture.get_pixel(x, 32).0);
            let near = |a: [u8; 4], b: [u8; 4]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 2);
            assert!(
                near(left, [red, 0, 0, 255]) && near(right, [red, 200, 0, 255]),
                "{method} {texture}: {left:?} {right:?}"
            );
        }
    }
    program.run("convert points.ply -o baked.ply").text();
    assert!(program.run("info baked.ply").text().contains("red"));
    std::fs::remove_file(program.path("own.png")).unwrap();
    assert!(program.run(&format!("render {common} -o a.png")).err.contains("drawn without its texture"));
    program.run(&format!("render {common} --texture given.png --color-by x -o a.png")).error(2);
}

/// An OBJ file of a sphere of few triangles, with an image of thin lines and discs.
fn write_globe(program: &Program) {
    let line = |i: u32| i % 64 < 3;
    let is_disc = |x: u32, y: u32| ((x % 96) as f32 - 50.0).hypot((y % 80) as f32 - 40.0) < 9.0;
    let pixel = |x, y| match (line(x) || line(y), is_disc(x, y)) {
        (true, _) => image::Rgb([20, 30, 60]),
        (_, true) => image::Rgb([200, 40, 30]),
        _ => image::Rgb([220, 200, 160]),
    };
    image::RgbImage::from_fn(1024, 512, pixel).save(program.path("skin.png")).unwrap();
    program.write("globe.mtl", "newmtl skin\nmap_Kd skin.png\n");
    const ROWS: u32 = 16;
    const COLUMNS: u32 = 32;
    let vertex = |i: u32| {
        let [u, v] = [(i % (COLUMNS + 1), COLUMNS), (i / (COLUMNS + 1), ROWS)]
            .map(|(k, of)| f64::from(k) / f64::from(of));
        let ((sin, cos), (x, z)) = ((PI * v).sin_cos(), (2.0 * PI * u).sin_cos());
        format!("v {} {cos} {}\nvt {u} {}\n", sin * x, sin * z, 1.0 - v)
    };
    let face = |i: u32| {
        let a = i / COLUMNS * (COLUMNS + 1) + i % COLUMNS + 1;
        let corners = [a, a + COLUMNS + 1, a + COLUMNS + 2, a + 1].map(|k| format!("{k}/{k}"));
        format!("f {}\n", corners.join(" "))
    };
    let vertices: String = (0..(ROWS + 1) * (COLUMNS + 1)).map(vertex).collect();
    let faces: String = (0..ROWS * COLUMNS).map(face).collect();
    program.write("globe.obj", format!("mtllib globe.mtl\nusemtl skin\n{vertices}{faces}"));
}

/// Against the exact picture of the textured triangles.
#[test]
#[ignore = "takes long: tools/test --all"]
fn textures_of_coarse_meshes_are_as_sharp_as_their_images() {
    let Some(program) = Program::with_device("textures_of_coarse_meshes_are_as_sharp_as_their_images") else {
        return;
    };
    write_globe(&program);
    let views = [(160, "color"), (96, "lit")];
    for (size, shading) in &views[if_whole(0..2, 1..2)] {
        let view = format!("--size {size}x{size} --shading {shading} --eye 1,1.2,3 --target 0,0,0 -q");
        program.run(&format!("truth globe.obj -o truth.exr --filter gaussian {view}")).text();
        let rmse = |options: &str| {
            program.run(&format!("render globe.obj -o made.exr {options} {view}")).text();
            let run = program.run("compare made.exr truth.exr --json -");
            let result: serde_json::Value = serde_json::from_str(run.text()).unwrap();
            result["metrics"]["rmse"].as_f64().unwrap()
        };
        let [own, vertices] = ["", "--mesh-sampling vertices"].map(rmse);
        println!("{size}², {shading}: {own:.4}, at the vertices {vertices:.4}");
        assert!(own < 0.008 && own < 0.15 * vertices, "{size}², {shading}: {own:.4}, {vertices:.4}");
    }
}

#[test]
fn a_turntable_begins_with_the_ordinary_picture_and_turns_around() {
    let Some(program) = Program::with_device("a_turntable_begins_with_the_ordinary_picture_and_turns_around")
    else {
        return;
    };
    // Of so many surfels on few pixels the reference alone shows two surfaces at edges.
    let common = "render scene:helix --size 64x48 --edges nearest --validate -q --eye 0,1,6 --target 0,0,0";
    program.run(&format!("{common} -o one.png")).text();
    program.run(&format!("{common} --turntable 4 -o turn-%02d.png")).text();
    let files = ["one.png", "turn-00.png", "turn-01.png", "turn-02.png", "turn-03.png"];
    assert_eq!(program.files(), files);
    assert_eq!(program.png("turn-00.png"), program.png("one.png"));
    // Half a turn about the centre of the scene's bounds, not the origin, gives another picture.
    let sides: Vec<_> = files[1..].iter().map(|file| program.png(file)).collect();
    for (i, a) in sides.iter().enumerate() {
        assert!(sides[..i].iter().all(|b| difference(a, b) > 1.0), "{i}");
    }
    let alone = common.replace("--validate ", "");
    program.run(&format!("{alone} --turntable 2 --reference -o cpu-%d.png")).text();
    assert!(difference(&program.png("cpu-1.png"), &program.png("turn-02.png")) < 0.2);
    let run = program.run(&format!("{common} --turntable 4 -o turn.png"));
    assert!(run.error(2).contains("frames/%04d.png"), "{}", run.err);
}

#[test]
fn a_strength_of_eye_dome_lighting_implies_it() {
    let Some(program) = Program::with_device("a_strength_of_eye_dome_lighting_implies_it") else { return };
    // The meaning of options does not depend on the device.
    let by = if_whole("", "--reference");
    let picture = |options: &str| {
        program.run(&format!("render {SPHERE} --size 48x32 -o a.png {by} {options}")).text();
        program.png("a.png")
    };
    let [implied, named, lit, chosen] =
        ["--edl 2", "--shading edl --edl 2", "", "--shading lit --edl 2"].map(picture);
    assert!(implied == named && implied != lit && chosen == lit);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn ambient_occlusion_has_a_strength() {
    let Some(program) = Program::with_device("ambient_occlusion_has_a_strength") else { return };
    let picture = |options: &str| {
        program.run(&format!("render {SPHERE} --size 48x32 -o a.png {options}")).text();
        program.png("a.png")
    };
    let [default, named, weaker, none, without] = ["--ao", "--ao=1", "--ao=0.5", "--ao=0", ""].map(picture);
    assert!(default == named && default != weaker && weaker != none && none == without);
    let run = program.run(&format!("render {SPHERE} --size 48x32 -o a.png --ao=-1"));
    assert!(run.error(2).contains("the strength of ambient occlusion is -1"), "{}", run.err);
}

#[test]
fn points_on_no_surface_are_shaded_by_eye_dome_lighting_or_ambient_occlusion() {
    let program = Program::new();
    let cloud = |header: &str, depth: f64, colour: &str| {
        let part = |i: usize, step: f64| (step * i as f64).fract();
        let points = (0..600).map(|i| {
            let [x, y, z] = [0.819_172_5, 0.671_043_6, depth * 0.549_700_5].map(|step| part(i, step));
            format!("{x:.6} {y:.6} {z:.6}{colour}\n")
        });
        format!("{header}\n{}", points.collect::<String>())
    };
    program.write("plain.xyz", cloud("x y z", 1.0, ""));
    program.write("cloud.xyz", cloud("x y z red green blue", 1.0, " 90 160 40"));
    program.write("flat.xyz", cloud("x y z red green blue", 0.0, " 90 160 40"));
    let render = |options: &str| {
        let run = program.run(&format!("render {options} --reference --up 0,1,0 --size 48x32 -o a.png"));
        let is_said = run.err.contains("so shaded by eye-dome lighting: --shading lit lights them");
        run.text();
        (program.png("a.png"), is_said)
    };
    let (edl, lit) = (render("cloud.xyz --shading edl"), render("cloud.xyz --shading lit"));
    assert!(edl.0 != lit.0 && !edl.1 && !lit.1);
    assert!(render("cloud.xyz") == (edl.0, true));
    assert!(render("flat.xyz") == render("flat.xyz --shading lit"));
    // Without colours, eye-dome lighting shows outlines alone.
    let plain = "plain.xyz --color-by file";
    let normals = format!("{plain} --no-billboards");
    assert!(render(&normals) == render(&format!("{normals} --shading lit")));
    let (lit, occluded) = (render(&format!("{plain} --shading lit")), render(&format!("{plain} --ao")));
    assert!(render(plain) == occluded && occluded != lit && render(&format!("{plain} --ao=0")) == lit);
    let run = program.run(&format!("render {plain} --reference --up 0,1,0 --size 48x32 -o a.png"));
    assert!(run.err.contains("so darkened by ambient occlusion: --ao=0 leaves it out"), "{}", run.err);
}
