//! What is written reads back.

use super::*;
use crate::estimate::Estimate;
use crate::geometry::{Clip, ClipLine, Clips, Ellipse, Material, Model, Primitives, Surfels, Weights};
use crate::picture::Picture;
use glam::Vec2;

fn random_surfels(count: usize, origin: DVec3, colours: Option<Colours>) -> Surfels {
    let spread = |i: usize, k: f32| ((i as f32 * k).sin() * 1e3).fract();
    Surfels {
        origin,
        positions: (0..count).map(|i| Vec3::new(spread(i, 1.0), spread(i, 2.0), spread(i, 3.0))).collect(),
        normals: (0..count).map(|i| Vec3::new(spread(i, 4.0), 1.0, spread(i, 5.0)).normalize()).collect(),
        radii: (0..count).map(|i| 0.5 + 0.1 * spread(i, 6.0)).collect(),
        colours,
        ..Default::default()
    }
}

fn read_back(path: &Path) -> Cloud {
    read(path, &ReadOptions::default(), &()).unwrap().cloud
}

#[test]
fn what_is_written_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.ply");
    let srgb = Colours::Srgb8((0..100).map(|i| [i, 255 - i, 7, 0]).collect());
    let linear = Colours::Linear((0..100).map(|i| [i as f32 / 99.0, 0.5, 0.0]).collect());
    for colours in [None, Some(srgb), Some(linear)] {
        let surfels = random_surfels(100, DVec3::ZERO, colours);
        write(&path, &surfels).unwrap();
        let read = read_back(&path);
        assert_eq!(
            (read.positions, read.radii, read.colours),
            (surfels.positions, Some(surfels.radii), surfels.colours)
        );
        assert_eq!((read.ellipses, read.two_sided, read.clips), (None, None, None));
        assert!(read.normals.unwrap().iter().zip(&surfels.normals).all(|(a, b)| a.abs_diff_eq(*b, 2e-7)));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file was left");
    }
}

#[test]
fn the_origin_is_part_of_the_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("far.ply");
    let far = random_surfels(100, DVec3::new(5e6, -4e5, 120.25), None);
    write(&path, &far).unwrap();
    let read = read_back(&path);
    for (a, b) in read.positions.iter().zip(&far.positions) {
        let apart = (a.as_dvec3() + read.origin).distance(b.as_dvec3() + far.origin);
        assert!(apart < 1e-6, "{apart}");
    }
    let ragged = Surfels { radii: vec![], ..far };
    assert!(matches!(write(&path, &ragged), Err(Error::Usage(_))));
}

#[test]
fn clips_read_back_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("clips.ply");
    let mut surfels = random_surfels(100, DVec3::ZERO, None);
    let clip = |(i, normal): (usize, &Vec3)| {
        let outward = normal.any_orthonormal_vector();
        let line = ClipLine { outward, offset: 0.3 - 0.01 * i as f32 };
        let other = ClipLine { outward: normal.cross(outward).normalize(), offset: 0.01 * i as f32 - 0.7 };
        match i % 4 {
            0 => None,
            1 => Some(Clip::line(line)),
            turn => Some(Clip { lines: [line, other], concave: turn == 3 }),
        }
    };
    surfels.clips = Clips::collect(surfels.normals.iter().enumerate().map(clip));
    assert_eq!(surfels.count_invalid(), 0);
    write(&path, &surfels).unwrap();
    let Loaded { cloud, report, .. } = read(&path, &ReadOptions::default(), &()).unwrap();
    assert_eq!((&cloud.clips, report.clip_lines_dropped, report.skipped.len()), (&surfels.clips, 0, 0));
    let (estimated, _) = cloud.into_surfels(&Estimate::default(), &()).unwrap();
    surfels.sort_morton();
    assert_eq!(estimated.clips, surfels.clips);
}

#[test]
fn weights_read_back_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("weights.ply");
    let mut surfels = random_surfels(100, DVec3::ZERO, None);
    for at_corners in [false, true] {
        let weight = |i: usize| 0.1 + 0.013 * i as f32;
        let corners =
            |i: usize| (at_corners && i.is_multiple_of(3)).then(|| [1, 2, 3, 4].map(|k| weight(k * i)));
        surfels.weights = Some(Weights::collect((0..100).map(|i| (weight(i), corners(i)))));
        write(&path, &surfels).unwrap();
        let Loaded { cloud, report, .. } = read(&path, &ReadOptions::default(), &()).unwrap();
        assert_eq!((&cloud.weights, report.weights_dropped, report.skipped.len()), (&surfels.weights, 0, 0));
        let (estimated, _) = cloud.clone().into_surfels(&Estimate::default(), &()).unwrap();
        let mut sorted = surfels.clone();
        sorted.sort_morton();
        assert_eq!(estimated.weights, sorted.weights);
        let larger = Estimate { radius_scale: 1.5, ..Default::default() };
        assert_eq!(cloud.into_surfels(&larger, &()).unwrap().0.weights, None, "weights of other discs");
    }
}

/// A model of everything; every vertex is of one kind.
fn everything(origin: DVec3, colours: impl Fn(usize) -> Option<Colours>) -> Model {
    let mut surfels = random_surfels(100, origin, colours(100));
    surfels.two_sided = Some((0..100).map(|i| i % 3 == 0).collect());
    surfels.sort_morton();
    let vertices = random_surfels(50, origin, colours(50));
    let (ribbons, tubes) = ((0..9).map(|i| [i, i + 1]).collect(), (10..19).map(|i| [i + 1, i]).collect());
    let triangles = (20..48).map(|i| [i, i + 1, i + 2]).collect();
    let primitives = Primitives {
        origin,
        positions: vertices.positions,
        directions: vertices.normals,
        radii: (0..50).map(|i| if i < 40 { vertices.radii[i] } else { 0.0 }).collect(),
        colours: vertices.colours,
        texture: None,
        materials: None,
        ribbons,
        tubes,
        triangles,
    };
    Model { surfels, primitives }
}

/// Files have no curvatures.
fn without_outlines() -> Estimate {
    Estimate { outlines: false, ..Estimate::default() }
}

#[test]
fn models_read_back_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.ply");
    let srgb =
        |count: usize| Some(Colours::Srgb8((0..count).map(|i| [i as u8, 255 - i as u8, 7, 0]).collect()));
    let linear =
        |count: usize| Some(Colours::Linear((0..count).map(|i| [i as f32 / 99.0, 0.5, 0.0]).collect()));
    let kinds: [&dyn Fn(usize) -> Option<Colours>; 3] = [&|_| None, &srgb, &linear];
    for colours in kinds {
        let mut model = everything(DVec3::ZERO, colours);
        let other = model.primitives.clone();
        for part in [other, Primitives::default()] {
            model.primitives = part;
            write(&path, &model).unwrap();
            let Loaded { cloud, report, .. } = read(&path, &ReadOptions::default(), &()).unwrap();
            assert_eq!(
                (report.skipped.len(), report.skipped_elements.len(), report.lines.skipped),
                (0, 0, 0)
            );
            let (again, counts) = cloud.into_model(false, &without_outlines(), &()).unwrap();
            assert_eq!((counts.radii_from_neighbours, counts.line_radii_from_lines), (0, 0));
            assert!(again == model, "{again:?}\n{model:?}");
        }
    }
}

#[test]
fn materials_read_back_with_their_points() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.ply");
    let mut model = everything(DVec3::ZERO, |_| None);
    let material =
        |i: u16| Material { specular: [0.1 * f32::from(i), 0.5, 2.0], shininess: 4.0 + f32::from(i) };
    let table: Arc<[Material]> = (0..300).map(material).collect();
    let of = |i: usize| if i.is_multiple_of(3) { Materials::NONE } else { 299 - i as u16 };
    let materials = |count: usize| Some(Materials { table: table.clone(), of: (0..count).map(of).collect() });
    (model.surfels.materials, model.primitives.materials) = (materials(100), materials(50));
    write(&path, &model).unwrap();
    let Loaded { cloud, report, .. } = read(&path, &ReadOptions::default(), &()).unwrap();
    assert_eq!((report.skipped.len(), report.skipped_elements.len()), (0, 0));
    let (again, _) = cloud.into_model(false, &without_outlines(), &()).unwrap();
    assert!(again == model, "{again:?}\n{model:?}");
    // Only some of what is drawn has any.
    model.surfels.materials = None;
    write(&path, &model).unwrap();
    let (again, _) = read_back(&path).into_model(false, &Estimate::default(), &()).unwrap();
    assert_eq!(again.primitives.materials, model.primitives.materials);
    assert_eq!(again.surfels.materials.unwrap().of, [Materials::NONE; 100]);
}

#[test]
fn vertices_that_nothing_uses_are_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.ply");
    let mut model = everything(DVec3::new(5e6, -4e5, 120.25), |_| None);
    model.surfels = Surfels::default();
    model.primitives.tubes.clear();
    write(&path, &model).unwrap();
    let (again, _) = read_back(&path).into_model(false, &Estimate::default(), &()).unwrap();
    assert_eq!((again.surfels.len(), again.primitives.len()), (0, 40));
    let ([a, b], radii) = (again.primitives.ribbons[8], &model.primitives.radii);
    assert_eq!([a, b].map(|i| again.primitives.radii[i as usize]), [radii[8], radii[9]]);
    model.primitives.ribbons.push([0, 50]);
    assert!(matches!(write(&path, &model), Err(Error::Usage(_))));
}

#[test]
fn a_vertex_of_a_tube_and_a_ribbon_becomes_two() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shared.ply");
    let primitives = Primitives {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        directions: vec![Vec3::Z; 3],
        radii: vec![1.0; 3],
        ribbons: vec![[0, 1]],
        tubes: vec![[1, 2]],
        ..Default::default()
    };
    write(&path, &Model { surfels: Surfels::default(), primitives }).unwrap();
    let (Model { primitives, .. }, _) =
        read_back(&path).into_model(false, &Estimate::default(), &()).unwrap();
    assert_eq!((primitives.ribbons, primitives.tubes), (vec![[0, 1]], vec![[3, 2]]));
    assert_eq!((primitives.positions[3], primitives.directions), (Vec3::X, vec![Vec3::Z; 4]));
}

#[test]
fn ellipses_and_sides_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.ply");
    let mut surfels = random_surfels(100, DVec3::ZERO, None);
    let aspect = |i: usize| (i + 1) as f32 / 100.0;
    let ellipse = |(i, n): (usize, &Vec3)| Ellipse { major: n.any_orthonormal_vector(), aspect: aspect(i) };
    surfels.ellipses = Some(surfels.normals.iter().enumerate().map(ellipse).collect());
    surfels.two_sided = Some((0..100).map(|i| i % 3 == 0).collect());
    write(&path, &surfels).unwrap();
    let read = read_back(&path);
    assert_eq!((read.radii, read.two_sided), (Some(surfels.radii), surfels.two_sided));
    for (i, (a, b)) in read.ellipses.unwrap().iter().zip(&surfels.ellipses.unwrap()).enumerate() {
        assert!((a.aspect - b.aspect).abs() < 1e-6, "{i}: {a:?} {b:?}");
        // A circle has no direction.
        assert!(b.aspect == 1.0 || a.major.dot(b.major).abs() > 1.0 - 1e-5, "{i}: {a:?} {b:?}");
        assert!(a.major.dot(surfels.normals[i]).abs() < 1e-6);
    }
}

#[test]
fn a_texture_is_written_as_its_colours() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("baked.ply");
    let picture =
        Picture { size: [2, 1], colour: vec![[1.0; 4], [0.0, 0.0, 0.0, 1.0]], ..Default::default() };
    let image = Arc::new(MipMap::new(&picture).unwrap());
    let mut surfels = random_surfels(2, DVec3::ZERO, None);
    surfels.texture = Some(Texture { image, coordinates: vec![Vec2::new(0.25, 0.5), Vec2::new(0.75, 0.5)] });
    surfels.radii = vec![1e-6; 2];
    write(&path, &surfels).unwrap();
    let cloud = read_back(&path);
    assert_eq!(
        (cloud.texture, cloud.colours),
        (None, Some(Colours::Srgb8(vec![[255, 255, 255, 0], [0; 4]])))
    );
}

#[test]
fn properties_of_inputs_keep_their_types_and_names() {
    use crate::formats::round_trip::reversed;
    use crate::formats::{self, Contents, PointSource, Values, WantedAttributes};
    let others = || ReadOptions { attributes: WantedAttributes::Others, ..Default::default() };
    let text = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
                property float nx\nproperty float ny\nproperty float nz\nproperty char temperature\n\
                property ushort intensity\nproperty uint number\nproperty int change\nproperty short shift\n\
                property uchar class\nproperty float part\nproperty double gps_time\nproperty float tx\n\
                property int material_index\nproperty float clip0x\nproperty float surfel_weight0\n\
                property uchar red\nproperty double local_x\nproperty list uchar int near\nend_header\n\
                0 0 0 0 0 1 -7 40000 4000000000 -2000000000 -300 9 0.25 1e300 0.1 7 0.25 0.5 9 -3 1 5\n\
                1 0 0 0 0 1 7 2 3 4 5 6 nan 0.1 0.2 -8 0.75 0.125 8 1e9 0\n";
    let (surfels, source, _) = reversed(read_bytes("a.ply", text.as_bytes(), &others()).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.ply");
    let write = |source: &PointSource, surfels: &Surfels| {
        let inputs = std::slice::from_ref(source);
        formats::write(&path, &Contents { inputs, ..Contents::of(surfels) }, &()).unwrap()
    };
    let written = write(&source, &surfels);
    let unknown = "near: properties that are lists, or that thinned points and samples of meshes do not have";
    assert_eq!(written.left_out, [unknown]);
    let (again, kept, _) = reversed(read(&path, &others(), &()).unwrap());
    // The surfels are written in reverse order.
    assert_eq!(again.positions, [surfels.positions[1], surfels.positions[0]]);
    let numbers = |source: &PointSource| -> Vec<_> {
        let both = |values: &Values| [0, 1].map(|i| values.get(i).unwrap());
        let all = source.attributes.iter();
        all.map(|a| (a.name.clone(), a.values.scalar(), both(&a.values))).collect()
    };
    let expected: Vec<_> =
        numbers(&source).into_iter().map(|(name, scalar, [a, b])| (name, scalar, [b, a])).collect();
    assert_eq!(format!("{:?}", numbers(&kept)), format!("{expected:?}"));
    assert_eq!(expected.len(), 14);
    let mut odd = source.clone();
    (odd.attributes[0].name, odd.attributes[1].name) = ("radius".into(), "of scan".into());
    let written = write(&odd, &surfels);
    assert_eq!(
        written.left_out[1],
        "of scan radius: names that PLY does not hold, which are unique and without spaces"
    );
}

#[test]
fn discs_replace_the_parameters_of_gaussians() {
    use crate::formats::round_trip::{all, reversed};
    use crate::formats::{self, Contents, WantedAttributes};
    let names = "x y z f_dc_0 f_dc_1 f_dc_2 f_rest_0 f_rest_44 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3 scale_of_map";
    let names: String = names.split(' ').map(|name| format!("property float {name}\n")).collect();
    let rows = "0 0 0 1 1 1 2 2 9 0 0 -3 1 0 0 0 5\n1 0 0 1 1 1 2 2 9 0 0 -3 1 0 0 0 6\n";
    let text = format!("ply\nformat ascii 1.0\nelement vertex 2\n{names}end_header\n{rows}");
    let others = ReadOptions { attributes: WantedAttributes::Others, ..Default::default() };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.ply");
    for options in [others, all()] {
        let (surfels, source, _) = reversed(read_bytes("a.ply", text.as_bytes(), &options).unwrap());
        let contents = Contents { inputs: &[source], ..Contents::of(&surfels) };
        assert_eq!(formats::write(&path, &contents, &()).unwrap().left_out, [""; 0]);
        let report = read(&path, &ReadOptions::default(), &()).unwrap().report;
        assert_eq!((report.skipped, report.gaussians), (vec!["scale_of_map".to_owned()], false));
    }
}
