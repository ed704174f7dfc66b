//! `surfel convert`, and the options of estimation.

use crate::program::{Program, surfels, surfels_with};

const TWO: [&str; 2] = ["0.25 0 0 0 0 1 0.5", "0.75 0 0 0 1 0 0.25"];

/// Output of `surfel info` for a file.
fn info(program: &Program, name: &str) -> String {
    program.run(&format!("info {name} --estimate")).text().to_owned()
}

#[test]
fn inputs_become_one_binary_file_that_renders_the_same() {
    let program = Program::new();
    program.write("a.ply", surfels(&TWO)).write("b.ply", surfels(&["-1 0 0 0 0 1 0.5"]));
    let run = program.run("convert a.ply b.ply scene:bumpy-sphere?points=50 -o c.ply");
    assert_eq!((run.text(), run.err.as_str()), ("", "c.ply: 53 surfels\n"));
    let text = info(&program, "c.ply");
    for part in [
        "binary_little_endian",
        "element vertex: 53",
        "  float radius",
        "  uchar red",
        "for --color-by, beside x, y, z, height, radius and normal: none",
    ] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    program.run("convert c.ply -o d.ply --quiet").text();
    let points = |text: &str| text.split_once("understood").unwrap().1.to_owned();
    assert_eq!(points(&info(&program, "d.ply")), points(&text));
    for (inputs, picture) in [("a.ply b.ply scene:bumpy-sphere?points=50", "1.png"), ("c.ply", "2.png")] {
        // Without curvatures, which are estimated from the points of each input alone.
        let options = "--reference --alpha mask --shade mean-normal --size 64x64";
        program.run(&format!("render {inputs} -o {picture} {options}")).text();
    }
    let [one, two] = ["1.png", "2.png"].map(|name| program.png(name));
    // Normalizing a normal twice may change its last bit.
    assert!(one.iter().zip(two.iter()).all(|(a, b)| a.abs_diff(*b) <= 1));
    assert!(one.pixels().any(|pixel| pixel[3] == 255));
}

#[test]
fn bare_files_have_the_normals_and_radii_of_the_inputs_alone() {
    let program = Program::new();
    let rows = |with: &str| (0..50).map(|i| format!("{}.25 {} 7{with}\n", i % 7, i / 7)).collect::<String>();
    let ply = |properties: &str, with: &str| {
        let names: String = properties.split(' ').map(|name| format!("property float {name}\n")).collect();
        format!("ply\nformat ascii 1.0\nelement vertex 50\n{names}end_header\n{}", rows(with))
    };
    program.write("points.ply", ply("x y z quality", " 3"));
    program.write("normals.ply", ply("x y z nx ny nz", " 0 1 0"));
    program.write("discs.ply", ply("x y z nx ny nz radius", " 0 1 0 0.5"));
    let properties = |name: &str| {
        let text = info(&program, name);
        let has = |names: [&str; 2]| text.lines().any(|line| names.iter().any(|name| line.trim() == *name));
        let normals = has(["float nx", "float NormalX"]) || has(["float normalX", "float nor:normalX"]);
        (normals, has(["float radius", ""]), text.contains("points: 50\n"))
    };
    for (input, [normals, radii]) in
        [("points", [false; 2]), ("normals", [true, false]), ("discs", [true, true])]
    {
        for extension in ["ply", "las", "laz", "copc.laz", "e57"] {
            let out = format!("{input}_bare.{extension}");
            let run = program.run(&format!("convert {input}.ply -o {out} --bare"));
            assert!(run.err.contains(&format!("{out}: 50 points")), "{}", run.err);
            // E57 has no radii.
            let expected = (normals, radii && extension != "e57", true);
            assert_eq!(properties(&out), expected, "{out}: {}", info(&program, &out));
        }
    }
    // They are estimated when they are rendered.
    let text = info(&program, "points_bare.copc.laz");
    assert!(text.contains("normals: 50 from neighbours") && text.contains("quality"), "{text}");
    assert!(program.run("convert points.ply -o out.las --bare --sharp 30").error(2).contains("--bare"));
}

#[test]
fn far_coordinates_are_kept() {
    let program = Program::new();
    let far = surfels(&["500000.001 4600000.002 100 0 0 1 0.5", "500001 4600001 101 0 0 1 0.5"]);
    program.write("a.ply", far.replace("float x", "double x").replace("float y", "double y"));
    program.run("convert a.ply -o c.ply").text();
    let text = info(&program, "c.ply");
    assert!(text.contains("  double x") && text.contains("\norigin: ["), "{text}");
    let bytes = std::fs::read(program.path("c.ply")).unwrap();
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    let records = &bytes[bytes.len() - 2 * 40..];
    let [x, y] = [number(&records[..8]), number(&records[8..16])];
    assert!((x - 500000.001).abs() < 1e-6 && (y - 4600000.002).abs() < 1e-6, "{x} {y}");
}

#[test]
fn colours_are_written() {
    let program = Program::new();
    program.write("a.ply", surfels_with("q", &["0 0 0 0 0 1 1 0", "1 0 0 0 0 1 1 1"]));
    for (by, colours) in [
        ("q", [[68, 1, 84], [253, 231, 37]]),
        ("height --up -3,0,0", [[253, 231, 37], [68, 1, 84]]),
        ("normal", [[128, 128, 255]; 2]),
    ] {
        program.run(&format!("convert a.ply -o c.ply --color-by {by}")).text();
        let bytes = std::fs::read(program.path("c.ply")).unwrap();
        // The last four bytes of a record are those of q.
        let records = &bytes[bytes.len() - 2 * 35..];
        assert_eq!(
            [&records[28..31], &records[63..66]],
            colours.each_ref().map(|colour| &colour[..]),
            "{by}"
        );
    }
}

#[test]
fn weights_are_captured_once_and_render_by_surfel() {
    let Some(program) = Program::with_device("weights_are_captured_once_and_render_by_surfel") else {
        return;
    };
    let scene = "scene:bumpy-sphere?points=2000";
    let run = program.run(&format!("convert {scene} -o w.ply --weights=12"));
    assert!(run.err.contains("w.ply: 2,000 surfels\n"), "{}", run.err);
    let seen = run.err.split_once("weights of ").unwrap().1;
    let seen: u32 = seen.split_once(" surfels from 12 views").unwrap().0.replace(',', "").parse().unwrap();
    assert!(seen > 1900, "{}", run.err);
    assert!(info(&program, "w.ply").contains("  float surfel_weight"));
    let by_surfel = "--method object-ewa --normalization surfel --size 64x64 --quiet";
    program.run(&format!("render w.ply -o w.png {by_surfel}")).text();
    assert!(program.png("w.png").pixels().any(|pixel| pixel[3] == 255));
    let refused = program.run(&format!("render {scene} -o x.png {by_surfel}"));
    assert!(refused.code == 2 && refused.err.contains("surfel convert --weights"), "{}", refused.err);
    let none = program.run(&format!("convert {scene} -o x.ply --weights=0"));
    assert_eq!(none.code, 2, "{}", none.err);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn captured_weights_even_out_the_brightness() {
    let name = "captured_weights_even_out_the_brightness";
    let Some(program) = Program::with_device(name) else { return };
    let run = program.run("convert scene:relief?height=0&points=3000&albedo=plain -o w.ply --weights");
    let borders = run.err.split_once(" from 24 views, ").unwrap().1.split_once(" of them").unwrap().0;
    assert!((100..1000).contains(&borders.parse::<u32>().unwrap()), "{}", run.err);
    let text = info(&program, "w.ply");
    let properties = ["surfel_weight", "surfel_weight0", "surfel_weight3"];
    assert!(properties.iter().all(|name| text.contains(&format!("  float {name}\n"))), "{text}");
    // Converting again keeps every byte; with other radii the weights are dropped.
    program.run("convert w.ply -o again.ply").text();
    let [first, again] = ["w.ply", "again.ply"].map(|name| std::fs::read(program.path(name)).unwrap());
    assert!(first == again);
    program.run("convert w.ply -o wide.ply --radius-scale 2").text();
    assert!(!info(&program, "wide.ply").contains("surfel_weight"));
    let [pixel, surfel, none] = ["pixel", "surfel", "none"].map(|normalization| {
        let how = "--method object-ewa --shading color --size 128x128 --quiet --normalization";
        program.run(&format!("render w.ply -o {normalization}.png {how} {normalization}")).text();
        program.png(&format!("{normalization}.png"))
    });
    // With one colour, only the sum differs from normalization at every pixel.
    let off = |picture: &image::RgbaImage| {
        let pairs = picture.pixels().zip(pixel.pixels()).filter(|(_, exact)| exact[3] == 255);
        pairs.map(|(a, b)| f64::from(a[1].abs_diff(b[1]))).sum::<f64>()
    };
    assert!(off(&surfel) > 0.0 && off(&surfel) < 0.5 * off(&none), "{} {}", off(&surfel), off(&none));
}

#[test]
fn thinning_prints_the_number_of_points() {
    let program = Program::new();
    let bare = surfels(&["0 0 0 0 0 1 9", "0.25 0 0 0 0 1 9", "5 0 0 0 0 1 9"]);
    program.write("a.ply", bare);
    let run = program.run("convert a.ply -o c.ply --voxel 1 --radius 0.5");
    assert!(run.err.contains("a.ply: 3 points thinned to 2\n"), "{}", run.err);
    let text = info(&program, "c.ply");
    assert!(
        text.contains("\nsurfels: 2\n") && text.contains("\nbounds: [0.125, 0, 0] to [5, 0, 0]"),
        "{text}"
    );
    let run = program.run("convert a.ply -o c.ply --voxel 1e-12");
    assert!(run.error(1).contains("a.ply: voxels of side"), "{}", run.err);
    assert!(run.err.contains("too small for an extent of 5"), "{}", run.err);
}

#[test]
fn inputs_are_thinned_together() {
    let program = Program::new();
    program.write("a.ply", surfels(&TWO)).write("b.ply", surfels(&["0.5 0 0 0 0 1 9", "5 0 0 0 0 1 9"]));
    let run = program.run("convert a.ply b.ply -o c.ply --voxel 1 --radius 0.5");
    assert!(run.err.contains("2 inputs: 4 points thinned to 2\n"), "{}", run.err);
    assert!(
        info(&program, "c.ply").contains("\nbounds: [0.5, 0, 0] to [5, 0, 0]"),
        "{}",
        info(&program, "c.ply")
    );
    let run = program.run("convert a.ply b.ply -o c.ply --voxel 1e-12");
    assert!(run.error(1).contains("2 inputs: voxels of side"), "{}", run.err);
}

#[test]
fn options_apply_to_scenes() {
    let program = Program::new();
    let scene = "scene:bumpy-sphere?points=2000";
    let run = program.run(&format!("convert {scene} -o c.ply --radius 0.25 --radius-scale 2"));
    assert_eq!(run.err, "c.ply: 2,000 surfels\n");
    let radius = "\nradius: 0.5 to 0.5, median 0.5\n";
    assert!(info(&program, "c.ply").contains(radius), "{}", info(&program, "c.ply"));
    let text = info(&program, &format!("{scene} --radius 0.5"));
    assert!(text.contains(radius) && text.contains("\nnormals: 2,000 given\n"), "{text}");
    let text = info(&program, &format!("{scene} --drop-outliers 1"));
    assert!(!text.contains("\nsurfels: 2,000\n") && !text.contains(" 0 outliers"), "{text}");
    let run = program.run(&format!("convert {scene} -o c.ply --voxel 0.25 --elliptical"));
    assert!(run.err.contains(&format!("{scene}: 2,000 points thinned to ")), "{}", run.err);
    assert!(info(&program, "c.ply").contains("\n  float ux\n"), "{}", info(&program, "c.ply"));
}

#[test]
fn sharp_edges_are_found_and_written() {
    let program = Program::new();
    let scene = "scene:part?points=5000&clips=off";
    let run = program.run(&format!("convert {scene} -o c.ply --sharp 40"));
    assert!(run.err.contains(" clipped at sharp edges\nc.ply: 5,000 surfels\n"), "{}", run.err);
    let text = info(&program, "c.ply");
    assert!(text.contains("\n  float clip0x\n") && text.contains("\n  uchar clip_concave\n"), "{text}");
    assert!(text.contains("for --color-by, beside x, y, z, height, radius and normal: none"), "{text}");
    // Clip lines stay, with or without another search.
    program.run("convert c.ply -o d.ply").text();
    assert_eq!(program.run("convert c.ply -o e.ply --sharp 90").err, "e.ply: 5,000 surfels\n");
    let [c, d, e] = ["c.ply", "d.ply", "e.ply"].map(|name| std::fs::read(program.path(name)).unwrap());
    assert!(c.len() == d.len() && d == e);
    let run = program.run("convert scene:torus?points=5000 -o f.ply --sharp 40");
    assert_eq!(run.err, "f.ply: 5,000 surfels\n");
    assert!(!info(&program, "f.ply").contains("clip"));
    for angle in ["0", "-40", "180", "nan", "wide"] {
        let run = program.run(&format!("convert missing.ply -o out.ply --sharp {angle}"));
        assert!(run.error(2).contains("above 0 and below 180"), "{angle}: {}", run.err);
    }
}

#[test]
fn radii_are_set_and_scaled() {
    let program = Program::new();
    program.write("a.ply", surfels(&TWO));
    let radius = |arguments: &str| {
        let text = program.run(&format!("info a.ply {arguments}")).text().to_owned();
        text.lines().find(|line| line.starts_with("radius")).unwrap().to_owned()
    };
    assert_eq!(radius(""), "radius: 0.25 to 0.5, median 0.5");
    assert_eq!(radius("--radius-scale 2"), "radius: 0.5 to 1, median 1");
    assert_eq!(radius("--radius 3"), "radius: 3 to 3, median 3");
    assert_eq!(radius("--radius 3 --radius-scale 0.5"), "radius: 1.5 to 1.5, median 1.5");
}

#[test]
fn outputs_that_would_overwrite_inputs_are_refused() {
    let program = Program::new();
    program.write("a.ply", surfels(&TWO));
    let before = std::fs::read(program.path("a.ply")).unwrap();
    for output in ["a.ply", "./a.ply"] {
        let run = program.run(&format!("convert scene:bumpy-sphere a.ply -o {output}"));
        assert!(run.error(2).contains("it is an input"), "{}", run.err);
    }
    for output in ["-", "c.obj", "c"] {
        let run = program.run(&format!("convert a.ply -o {output}"));
        assert!(run.error(2).contains("name the file .ply"), "{}", run.err);
    }
    let run = program.run("convert missing.ply -o no/such/c.ply");
    assert!(run.error(1).contains("does not exist: create it"), "{}", run.err);
    // A failure keeps the old file, a success replaces it.
    program.write("c.ply", "old");
    program.run("convert missing.ply -o c.ply").error(1);
    assert_eq!(std::fs::read(program.path("c.ply")).unwrap(), b"old");
    program.run("convert a.ply -o c.ply").text();
    assert!(std::fs::read(program.path("c.ply")).unwrap().starts_with(b"ply\n"));
    assert_eq!(std::fs::read(program.path("a.ply")).unwrap(), before);
    assert_eq!(program.files(), ["a.ply", "c.ply"]);
}

#[test]
fn wrong_options_exit_with_2_before_anything_is_read() {
    let program = Program::new();
    for command in ["render missing.ply -o out.png", "info missing.ply", "convert missing.ply -o out.ply"] {
        for (arguments, cause) in [
            ("--radius 0", "above 0"),
            ("--radius -1", "above 0"),
            ("--radius nan", "above 0"),
            ("--radius-scale inf", "above 0"),
            ("--neighbours 5", "6 to 64"),
            ("--neighbours 65", "6 to 64"),
            ("--drop-outliers 0", "above 0"),
        ] {
            let run = program.run(&format!("{command} {arguments}"));
            assert!(run.error(2).contains(cause), "{command} {arguments}: {}", run.err);
        }
        let all = "--radius 1 --radius-scale 2 --neighbours 64 --elliptical --drop-outliers 2.5";
        let run = program.run(&format!("{command} {all}"));
        assert!(run.error(1).starts_with("missing.ply: "), "{}", run.err);
    }
    for (arguments, cause) in
        [("--voxel 0", "above 0"), ("--voxel -1", "above 0"), ("--up 0,0,0", "it is zero: give a direction")]
    {
        let run = program.run(&format!("convert missing.ply -o out.ply {arguments}"));
        assert!(run.error(2).contains(cause), "{arguments}: {}", run.err);
    }
    assert!(program.run("convert -o out.ply").error(2).contains("<INPUT>"));
    assert!(program.run("convert a.ply").error(2).contains("--output"));
    assert!(program.files().is_empty());
}

/// Pseudo-random points in a cube, no surface, beside a square.
#[test]
fn points_on_no_surface_face_the_eye_in_written_files_too() {
    let program = Program::new();
    let mut state = 1u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let points = (0..2000).map(|_| format!("{} {} {}\n", number(), number(), number()));
    let square = (0..400).map(|i| format!("{} {} 5\n", 0.05 * f64::from(i % 20), 0.05 * f64::from(i / 20)));
    program.write("a.xyz", points.chain(square).collect::<String>());
    let count = |name: &str| {
        let text = info(&program, name);
        let line = text.lines().find(|line| line.starts_with("normals: ")).unwrap_or_default().to_owned();
        let facing = line.split(", ").find_map(|part| part.strip_suffix(" facing the eye"));
        (facing.map_or(0, |count| count.replace(',', "").parse().unwrap()), line)
    };
    let (whole, _) = count("a.xyz");
    assert!((1501..=2000).contains(&whole), "{whole}");
    for file in ["b.ply", "b.las", "b.e57"] {
        assert!(
            program.run(&format!("convert a.xyz -o {file} --elliptical")).err.contains("that face the eye")
        );
        let (facing, line) = count(file);
        // E57 has no such flag: the points are found again.
        let is_kept = file == "b.e57" || line.starts_with("normals: 2,400 given");
        assert!(facing == whole && is_kept, "{file}: {line}");
    }
    assert_eq!(count("a.xyz --no-billboards").0, 0);
}
