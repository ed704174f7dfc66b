//! Formats other than PLY, and what their points look like without options, tested with the reference, which needs no device.

use crate::program::Program;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

/// A camera from above whose picture is 4 units high at the origin.
const ABOVE: &str =
    "--reference --size 40x40 --eye 0,0,5 --target 0,0,0 --fov 43.6028 --alpha mask --shading color";

/// Points of a plane at z = 0, `columns` of each.
fn plane(columns: impl Fn(i32, i32) -> String) -> String {
    let rows = (-10..=10).flat_map(|y| (-10..=10).map(move |x| (x, y)));
    rows.map(|(x, y)| format!("{} {} 0 {}\n", f64::from(x) / 10.0, f64::from(y) / 10.0, columns(x, y)))
        .collect()
}

fn sample(name: &str) -> String {
    format!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/{}"), name)
}

#[test]
fn every_format_becomes_a_picture() {
    let program = Program::new();
    for name in ["format3.las", "format7.laz", "scans.e57", "binary.pcd", "compressed.pcd", "open3d.pts"] {
        let run = program.run(&format!("render {} -o out.png --reference --size 32x32", sample(name)));
        run.text();
        assert!(program.png("out.png").pixels().any(|pixel| pixel[3] > 0), "{name}");
    }
}

/// A glTF square in the plane z = 0, as a strip.
fn square() -> String {
    let corners = [[-1f32, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let buffer = json!({"byteLength": 48, "uri": format!("data:;base64,{}", STANDARD.encode(bytes))});
    let accessor = json!({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"});
    let document = json!({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "buffers": [buffer], "accessors": [accessor],
        "bufferViews": [{"buffer": 0, "byteLength": 48}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}],
    });
    document.to_string()
}

/// The same square as STL text.
const SQUARE: &str = "solid\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 -1 0\nvertex 1 1 0\nendloop\nendfacet\n\
    facet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 1 0\nvertex -1 1 0\nendloop\nendfacet\nendsolid\n";

/// A Gaussian of SPLAT in the plane z = 0.
fn gaussian(x: f32, y: f32, opacity: u8) -> Vec<u8> {
    let floats = [x, y, 0.0, 0.1, 0.1, 0.001].into_iter().flat_map(f32::to_le_bytes);
    floats.chain([200, 100, 50, opacity, 255, 128, 128, 128]).collect()
}

#[test]
fn scans_models_and_gaussians_become_pictures() {
    let program = Program::new();
    let header = "21\n21\n0 0 9\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    program.write("a.ptx", header.to_owned() + &plane(|_, _| "0.5".into()));
    program.write(
        "a.obj",
        plane(|_, _| "1 0.5 0".into()).lines().map(|row| format!("v {row}\n")).collect::<String>(),
    );
    program.write("a.gltf", square()).write("a.stl", SQUARE);
    let row =
        |y: i16| (-10..=10i16).flat_map(move |x| gaussian(f32::from(x) / 10.0, f32::from(y) / 10.0, 255));
    program.write("a.splat", (-10..=10).flat_map(row).chain(gaussian(9.0, 0.0, 10)).collect::<Vec<u8>>());
    let render = |name: &str| {
        let run = program.run(&format!("render {name} -o out.png {ABOVE}"));
        run.text();
        assert!(program.png("out.png").get_pixel(15, 20).0[3] > 0, "{name}");
        run.err
    };
    // The scanner's own position is no point.
    let text = render("a.ptx");
    assert!(text.contains("1 of 441 points have no finite position") && text.contains("z is up"), "{text}");
    let text = render("a.splat");
    assert!(
        text.contains("1 of 442 points are less than a tenth opaque") && text.contains("-y is up"),
        "{text}"
    );
    assert!(render("a.obj").contains("z is up"), "wide and flat");
    assert!(!render("a.gltf").contains("is up"), "the format tells");
    render("a.stl");
    for (file, start) in [("a.gltf", "a.gltf: glTF, "), ("a.stl", "a.stl: STL, ")] {
        let info = program.run(&format!("info {file}"));
        let text = info.text();
        assert!(text.starts_with(start) && text.contains("faces: 2 understood"), "{text}");
    }
    program.run("convert a.splat -o b.ply").text();
    assert!(program.run("info b.ply --estimate").text().contains("surfels: 441\n"));
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn the_scanner_of_a_lidar_is_found_given_or_refused() {
    let program = Program::new();
    // Ground 2 below a lidar, whose ranges have errors.
    let rings = (8..80).flat_map(|row| {
        (0..720).map(move |column| {
            let [down, around] = [row, column].map(|half| (f64::from(half) / 2.0).to_radians());
            let error = 1.0 + 0.002 * (f64::from(720 * row + column) * 0.754_877).fract();
            let range = 2.0 / down.tan() * error;
            format!("{} {} {}\n", range * around.cos(), range * around.sin(), -2.0 * error)
        })
    });
    program.write("a.xyz", rings.collect::<String>());
    let camera = "--reference --size 40x40 --eye 0,-26,6 --target 0,-18,-2 --fov 60 --alpha mask";
    let covered = |arguments: &str| {
        let run = program.run(&format!("render a.xyz -o out.png {camera} {arguments}"));
        run.text();
        let text = "0,0,0 taken for the scanner of 51,840, as their directions are a grid";
        (program.png("out.png").pixels().filter(|pixel| pixel[3] > 0).count(), run.err.contains(text))
    };
    let (found, refused) = (covered(""), covered("--scanner file"));
    assert!(found.1 && !refused.1);
    assert!(found.0 as f64 > 1.3 * refused.0 as f64, "{found:?} {refused:?}");
    assert_eq!(covered("--scanner 0,0,0"), (found.0, false));
    let run = program.run(&format!("render a.xyz -o out.png {camera} --scanner there"));
    assert!(run.error(2).contains("give auto, file or X,Y,Z"), "{}", run.err);
    let text = program.run("info a.xyz --estimate").text().to_owned();
    assert!(
        text.contains("scanner: 0,0,0, as the directions of 51,840 points from there are a grid"),
        "{text}"
    );
}

#[test]
fn bare_points_have_the_colours_of_their_intensity_unless_those_of_the_file_are_asked_for() {
    let program = Program::new();
    program.write("a.xyz", plane(|x, _| x.to_string()));
    let colours = |arguments: &str| {
        let run = program.run(&format!("render a.xyz -o out.png {ABOVE} {arguments}"));
        run.text();
        let picture = program.png("out.png");
        ([12, 20, 28].map(|x| picture.get_pixel(x, 20).0), run.err)
    };
    let (grey, text) = colours("");
    assert!(grey.iter().all(|[r, g, b, _]| r == g && g == b), "{grey:?}");
    assert!(grey[0][0] < grey[1][0] && grey[1][0] < grey[2][0], "{grey:?}");
    assert!(
        text.contains("a.xyz: no colours, so coloured by intensity: --color-by file leaves the points plain"),
        "{text}"
    );
    let (plain, text) = colours("--color-by file");
    assert!(plain[0] == plain[1] && plain[1] == plain[2] && !text.contains("intensity"), "{plain:?} {text}");
    let (viridis, _) = colours("--color-by intensity");
    assert!(viridis[0] != grey[0] && viridis[2] != grey[2]);
    // Without another column there is only the height, and equal intensities tell nothing.
    for row in ["", "7"] {
        program.write("a.xyz", plane(|_, _| row.into()));
        let (_, text) = colours("");
        assert!(text.contains("coloured by height"), "{text}");
    }
    // Colours of the file stay.
    program.write("a.xyz", plane(|_, _| "200 0 0".into()));
    assert_eq!(colours("").0[1], [200, 0, 0, 255]);
}

#[test]
fn z_is_up_for_surveys_and_a_line_says_so() {
    let program = Program::new();
    program.write("a.xyz", plane(|_, _| String::new()));
    let said = |arguments: &str| {
        let run = program.run(&format!("render {arguments} -o out.png --reference --size 16x16"));
        run.text();
        run.err.contains("z is up")
    };
    assert!(said("a.xyz") && !said("a.xyz --up 0,1,0") && !said("a.xyz --quiet"));
    assert!(said(&sample("format1.las")) && said(&sample("scans.e57")) && !said(&sample("binary.pcd")));
    // From straight above, y is up in the picture.
    program.write("a.xyz", plane(|x, y| if x == 0 && y == 10 { "200 0 0".into() } else { "0 200 0".into() }));
    program.run(&format!("render a.xyz -o out.png {ABOVE}")).text();
    let picture = program.png("out.png");
    let top =
        (0..40).flat_map(|x| (0..20).map(move |y| (x, y))).any(|(x, y)| picture.get_pixel(x, y).0[0] > 100);
    let bottom =
        (0..40).flat_map(|x| (20..40).map(move |y| (x, y))).any(|(x, y)| picture.get_pixel(x, y).0[0] > 100);
    assert!(top && !bottom);
}

#[test]
fn what_a_file_states_is_printed() {
    let program = Program::new();
    let run = program.run(&format!("info {}", sample("format7.laz")));
    for line in
        ["version: 1.4", "scale: 0.001 0.001 0.0005", "points by return: 12 12 12 12 12", "element point: 60"]
    {
        assert!(run.text().lines().any(|have| have == line), "no `{line}` in\n{}", run.text());
    }
    let json = program.run(&format!("info {} --json", sample("scans.e57")));
    let json: serde_json::Value = serde_json::from_str(json.text()).unwrap();
    assert_eq!(json["details"]["scan 1"], "scan 1, 60 points, from [100, 2, 3]");
}

#[test]
fn columns_can_be_named() {
    let program = Program::new();
    program.write("a.txt", plane(|x, y| format!("{x} {y}")));
    let run = program.run("info a.txt --columns y,x,z,c,d");
    assert!(
        run.text()
            .contains("understood: y x z\nfor --color-by, beside x, y, z, height, radius and normal: c, d\n"),
        "{}",
        run.text()
    );
    let wrong = program.run("info a.txt --columns x,y,z");
    assert!(wrong.error(1).contains("5 values, and 3 columns are named"), "{}", wrong.err);
    program.write("b.csv", "Tree,Foo,Bar,Baz\noak,1,2,3\nash,4,5,6\n");
    let unnamed = program.run("info b.csv");
    let cause = "x, y and z are not all among its columns (`Tree`, `Foo`, `Bar`, `Baz`)";
    let remedy = "name the columns, for example `-,x,y,z` with --columns";
    assert_eq!(unnamed.error(1), format!("b.csv: {cause}: {remedy}"));
    assert!(
        program
            .run("info b.csv --columns -,x,y,z")
            .text()
            .contains("points: 2\nbounds: [1, 2, 3] to [4, 5, 6]")
    );
}

#[test]
fn classes_and_returns_can_be_selected() {
    let program = Program::new();
    let render = |options: &str| {
        program
            .run(&format!("render {} -o out.png --reference --size 16x16 {options}", sample("format7.laz")))
    };
    let run = render("--class ground,building --returns last");
    assert!(run.err.contains("59 of 60 points left out by the filter"), "{}", run.err);
    let run = render("--returns first");
    assert!(run.err.contains("48 of 60 points left out by the filter"), "{}", run.err);
    run.text();
    assert!(render("--class 300").error(2).contains("300"));
    let info = program.run(&format!("info {} --returns last --estimate", sample("format7.laz")));
    assert!(info.text().contains("outliers, 48 by the filter\n"), "{}", info.text());
}

#[test]
fn points_in_a_box_can_be_read() {
    let program = Program::new();
    program.write("a.txt", plane(|_, _| String::new()));
    let info = |options: &str| program.run(&format!("info a.txt --estimate {options}"));
    for (bounds, surfels) in [("", 441), ("--bounds=0.1,-5,0.3,0.2", 39), ("--bounds 0.1,0,-1,0.3,0.2,1", 9)]
    {
        let run = info(bounds);
        assert!(run.text().contains(&format!("\nsurfels: {surfels}\n")), "{bounds}: {}", run.text());
    }
    let rendered = program.run("render a.txt -o out.png --reference --size 16x16 --bounds 0,0,4,4");
    assert!(rendered.err.contains("320 of 441 points left out by the filter"), "{}", rendered.err);
    assert!(info("--bounds 1,2,3").error(2).contains("XMIN,YMIN,XMAX,YMAX"));
    let none = info("--bounds 0,0,1,1,1,2");
    assert!(none.error(1).contains("choose other bounds"), "{}", none.err);
    for command in ["render -o a.png --reference", "info", "info --json"] {
        let scene = program.run(&format!("{command} --bounds 0,0,1,1 scene:sphere?points=100"));
        assert!(scene.error(2).contains("a built-in scene is whole"), "{}", scene.err);
    }
}

#[test]
fn one_point_in_n_can_be_read() {
    let program = Program::new();
    let run = |command: &str| program.run(&format!("{command} {}", sample("format7.laz")));
    let rendered = run("render -o out.png --reference --size 16x16 --every 7 --class 0,7");
    rendered.text();
    for line in ["51 of 60 points left out: one in 7 is read", "7 of 60 points left out by the filter"] {
        assert!(rendered.err.contains(line), "{}", rendered.err);
    }
    let info = run("info --estimate --every 7");
    assert!(info.text().contains("\nsurfels: 9\n"), "{}", info.text());
    assert!(info.text().contains("outliers, 51 by thinning\n"), "{}", info.text());
    assert!(info.text().contains("radii: 9 from neighbours\n"), "{}", info.text());
    assert!(run("convert -o a.ply --every 7").err.ends_with("a.ply: 9 surfels\n"));
    assert!(run("info --every 0").error(2).contains('0'));
}

#[test]
fn points_by_class_and_return_are_counted() {
    let program = Program::new();
    let run = program.run(&format!("info {}", sample("format7.laz")));
    let classes = "points by class: 2 of 0 (never classified), 2 of 1 (unclassified), 2 of 2 (ground), ";
    assert!(run.text().lines().any(|have| have.starts_with(classes)), "{}", run.text());
    let returns = "points by return that are read: 12 of 1, 12 of 2, 12 of 3, 12 of 4, 12 of 5";
    assert!(run.text().lines().any(|have| have == returns), "{}", run.text());
    let json = |arguments: &str| -> serde_json::Value {
        serde_json::from_str(program.run(arguments).text()).unwrap()
    };
    let info = json(&format!("info {} --json --class 2,31", sample("format7.laz")));
    assert_eq!(info["points_by_class"], serde_json::json!({ "2": 2, "31": 1 }));
    assert_eq!(info["points_by_return"], serde_json::json!({ "2": 1, "3": 1, "5": 1 }));
    program.write("a.xyz", plane(|_, _| String::new()));
    let info = json("info a.xyz --json");
    assert!(info["points_by_class"].is_null() && info["points_by_return"].is_null());
}

#[test]
fn points_are_converted_to_las_laz_and_e57() {
    let program = Program::new();
    let run = program.run(&format!("convert {} -o a.laz", sample("format3.las")));
    run.text();
    assert!(run.err.ends_with("a.laz: 60 surfels\n") && !run.err.contains("warning"), "{}", run.err);
    let text = program.run("info a.laz").text().to_owned();
    for line in
        ["scale: 0.001 0.001 0.0005", "point format: 3, 68 bytes", "  double gps_time", "  float NormalZ"]
    {
        assert!(text.lines().any(|have| have == line), "no `{line}` in\n{text}");
    }
    // With its own normals and radii nothing changes any more.
    program.run("convert a.laz -o b.laz --quiet").text();
    let [a, b] = ["a.laz", "b.laz"].map(|name| std::fs::read(program.path(name)).unwrap());
    assert!(a == b);
    let run = program.run("convert a.laz -o c.e57");
    assert!(run.err.contains("surfel: warning: c.e57: left out: big classification "), "{}", run.err);
    assert!(program.run("info c.e57").text().contains("\nscans: 1\n"));
    let run = program.run("convert a.laz -o d.ply");
    assert!(run.err.ends_with("d.ply: 60 surfels\n") && !run.err.contains("warning"), "{}", run.err);
    let render = "--color-by classification --reference --size 16x16 -o d.png";
    let run = program.run(&format!("render d.ply {render}"));
    assert!(run.err.contains("d.ply: z is up") && run.err.contains("classification: "), "{}", run.err);
    let run = program.run("convert a.laz -o e.laz --voxel 5");
    assert!(run.err.contains("surfel: warning: e.laz: left out: "), "{}", run.err);
    let run = program.run("convert a.laz -o f.copc.laz");
    assert!(run.err.contains("f.copc.laz: 60 surfels"), "{}", run.err);
    let run = program.run(&format!("convert {} -o g.las --color-by user_data", sample("format3.las")));
    run.text();
    assert!(program.run("info g.las").text().contains("colours: linear, float"));
}
