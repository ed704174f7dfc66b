//! Files with lines, and faces that are rendered.

use crate::program::Program;

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const EDGES: &str = "property int vertex1\nproperty int vertex2\n";

/// A tube of three vertices, a triangle and a point.
fn hybrid() -> String {
    format!(
        "ply\nformat ascii 1.0\nelement vertex 7\n{XYZ}property float radius\nelement edge 3\n{EDGES}element face 1\n\
         property list uchar int vertex_indices\nend_header\n0 0 0 0.5\n0 1 0 0\n0 2 0 0.25\n1 0 0 0\n2 0 0 0\n1 1 0 0\n3 3 0 1\n\
         0 1\n1 2\n2 2\n3 3 4 5\n"
    )
}

/// The error of invalid arguments.
fn refused(program: &Program, arguments: &str) -> String {
    let run = program.run(arguments);
    assert_eq!(run.code, 2, "{}", run.err);
    run.err
}

#[test]
fn lines_are_described_counted_and_converted_exactly() {
    let program = Program::new();
    program.write("a.ply", hybrid());
    let text = program.run("info a.ply --estimate").text().to_owned();
    for part in [
        "lines: 2 understood, 1 skipped, 0 sides of faces\n",
        "surfels: 1\nribbons: 0\ntubes: 2\ndrawn triangles: 1\nvertices of these: 6, radius: 0 to 0.5, median 0.25\n",
        "radii of lines: 2 given, 1 from others of the line\n",
        "skipped elements: none\n",
    ] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    let run = program.run("convert a.ply -o b.ply");
    assert_eq!(run.text(), "");
    for part in [
        "1 of 3 segments",
        "radii of 1 vertices of lines from others",
        "b.ply: 1 surfels, 2 tubes, 1 triangles\n",
    ] {
        assert!(run.err.contains(part), "no `{part}` in\n{}", run.err);
    }
    assert_eq!(program.run("convert b.ply -o c.ply").err, "c.ply: 1 surfels, 2 tubes, 1 triangles\n");
    let bytes = |name: &str| std::fs::read(program.path(name)).unwrap();
    assert!(bytes("b.ply") == bytes("c.ply"));
    // The file twice, and a scene.
    program.run("convert a.ply b.ply scene:sphere?points=50 -o d.ply --quiet").text();
    let text = program.run("info d.ply --estimate").text().to_owned();
    assert!(text.contains("surfels: 52\nribbons: 0\ntubes: 4\ndrawn triangles: 2\n"), "{text}");
}

#[test]
fn radii_of_lines_can_be_given() {
    let program = Program::new();
    let header = format!("ply\nformat ascii 1.0\nelement vertex 2\n{XYZ}element edge 1\n{EDGES}end_header\n");
    program.write("a.ply", format!("{header}0 0 0\n3 4 0\n0 1\n"));
    let run = program.run("convert a.ply -o b.ply");
    assert!(
        run.err.contains("radii of 2 vertices of lines from the lines' extent, as no line radius is given"),
        "{}",
        run.err
    );
    let radius = |options: &str| {
        let text = program.run(&format!("info a.ply --estimate {options}")).text().to_owned();
        text.split_once("radius: ").unwrap().1.split(' ').next().unwrap().parse::<f32>().unwrap()
    };
    assert_eq!(radius(""), 0.0025);
    assert_eq!(radius("--radius-scale 2"), 0.005);
    assert_eq!(radius("--line-radius 0.5"), 0.5);
    refused(&program, "info a.ply --line-radius 0");
}

#[test]
fn polygons_renders_faces() {
    let program = Program::new();
    let mesh = format!(
        "ply\nformat ascii 1.0\nelement vertex 4\n{XYZ}element face 1\nproperty list uchar int vertex_indices\nend_header\n\
         0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
    );
    program.write("a.ply", mesh);
    assert!(program.run("info a.ply --estimate").text().contains("\nsurfels: 8\n"));
    let text = program.run("info a.ply --polygons").text().to_owned();
    assert!(text.contains("surfels: 0\nribbons: 0\ntubes: 0\ndrawn triangles: 2\n"), "{text}");
    program.run("convert a.ply -o b.ply --polygons --color-by x").text();
    let text = program.run("info b.ply --mesh-sampling vertices").text().to_owned();
    assert!(text.contains("surfels: 4") && text.contains("faces: 2 understood"), "{text}");
    refused(&program, "convert a.ply -o b.ply --polygons --voxel 1");
}

#[test]
fn methods_that_splat_refuse_lines() {
    let program = Program::new();
    program.write("a.ply", hybrid());
    let run = refused(&program, "render a.ply -o a.png --reference --method sprites");
    assert!(run.contains("2 tubes, 1 triangles") && run.contains("--method pull-push"), "{run}");
    let run = refused(&program, "convert a.ply -o b.ply --weights");
    assert!(run.contains("leave it out"), "{run}");
    program.run("render a.ply -o a.png --reference --size 32x32 --json a.json").text();
    let report = std::fs::read_to_string(program.path("a.json")).unwrap();
    assert!(report.contains("\"method\": \"pull-push\""), "{report}");
}

#[test]
fn meshes_become_lines_and_lines_simpler() {
    let program = Program::new();
    // A tube of triangles with three rings, the middle one in line with the others.
    let rings = (0..9).map(|i| {
        let angle = f64::from(i % 3) * std::f64::consts::TAU / 3.0;
        format!("{} {} {}\n", 0.1 * angle.cos(), 0.1 * angle.sin(), i / 3)
    });
    let faces = (0..6).map(|i| {
        let (ring, next) = (3 * (i / 3), (i + 1) % 3);
        format!("4 {i} {} {} {}\n", ring + next, ring + next + 3, i + 3)
    });
    let header = format!("element vertex 9\n{XYZ}element face 6\nproperty list uchar int vertex_indices");
    let records: String = rings.chain(faces).collect();
    program.write("a.ply", format!("ply\nformat ascii 1.0\n{header}\nend_header\n{records}"));
    let run = program.run("convert a.ply -o b.ply --lines=1");
    let said = "a.ply: of 12 triangles 0 are leaves and became 0 segments of ribbons, 12 are branches and became 2 segments of \
                tubes; of 9 vertices 3 are left\nb.ply: 2 tubes\n";
    assert_eq!(run.err, said);
    let run = program.run("convert b.ply -o c.ply --simplify-lines 0.001");
    assert_eq!(run.err, "2 segments of lines simplified to 1\nc.ply: 1 tubes\n");
    // Thicker than the default fraction of so small an extent.
    assert!(program.run("convert a.ply --lines -o d.ply").err.ends_with("d.ply: 12 triangles\n"));
    refused(&program, "convert a.ply -o b.ply --lines=0");
    refused(&program, "convert a.ply -o b.ply --lines=1 --voxel 1");
}
