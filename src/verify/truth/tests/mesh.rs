//! Meshes against the surface that they approximate.

use super::centre;
use crate::geometry::{Camera, Cloud, Colours, FaceImage, FaceTexture, FaceTextures, MipMap, Texture};
use crate::picture::Picture;
use crate::settings::Settings;
use crate::verify::scenes;
use crate::verify::scenes::random::Random;
use crate::verify::truth::mesh::triangle::Ray;
use crate::verify::truth::{Eye, Mesh, Options, Traceable, render};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A unit sphere of 2n × n quads, without normals.
fn sphere(n: u32) -> Cloud {
    let point = |i: u32, j: u32| {
        let (theta, phi) = (PI * f64::from(j) / f64::from(n), TAU * f64::from(i) / f64::from(2 * n));
        // The poles are points.
        let around = if j == n { 0.0 } else { theta.sin() };
        DVec3::new(around * phi.sin(), theta.cos(), around * phi.cos()).as_vec3()
    };
    let index = |i: u32, j: u32| j * 2 * n + i % (2 * n);
    let positions = (0..=n).flat_map(|j| (0..2 * n).map(move |i| point(i, j))).collect();
    let field = |i, j| {
        [
            [index(i, j), index(i, j + 1), index(i + 1, j + 1)],
            [index(i, j), index(i + 1, j + 1), index(i + 1, j)],
        ]
    };
    let triangles = (0..n).flat_map(|j| (0..2 * n).flat_map(move |i| field(i, j))).collect();
    Cloud { positions, triangles, ..Default::default() }
}

#[test]
fn a_fine_mesh_is_the_sphere() {
    const SIZE: [u32; 2] = [48, 48];
    let n = 128;
    let mesh = Mesh::new("sphere", &sphere(n)).unwrap();
    let exact = scenes::surface("scene:sphere?albedo=plain").unwrap();
    let camera = Camera::look_at(DVec3::new(0.4, 0.9, 3.0), DVec3::ZERO, DVec3::Y, 0.75, 1.0, 0.01).unwrap();
    let settings = Settings::default();
    let mesh_eye = Eye::new(&mesh, &camera, &settings, SIZE).unwrap();
    let exact_eye = Eye::new(&*exact, &camera, &settings, SIZE).unwrap();
    // The greatest distance of a chord from its arc, twice for the two directions of a quad.
    let sagitta = 2.0 * (1.0 - (0.5 * PI / f64::from(n)).cos());
    let mut compared = 0;
    for at in (0..48 * 48).map(|i| centre(i, SIZE)) {
        let (Some(a), Some(b)) = (mesh_eye.hit(at), exact_eye.hit(at)) else { continue };
        let viewer = b.normal.dot(DVec3::new(0.4, 0.9, 3.0).normalize());
        if viewer < 0.5 {
            continue;
        }
        compared += 1;
        assert!((a.depth - b.depth).abs() < sagitta / 0.2, "{at}: {} {}", a.depth, b.depth);
        assert!(a.normal.angle_between(b.normal) < 2e-3, "{at}: {}", a.normal.angle_between(b.normal));
    }
    assert!(compared > 500, "{compared}");
    let alpha =
        |scene: &dyn Fn() -> Vec<[f32; 4]>| scene().iter().map(|pixel| f64::from(pixel[3])).sum::<f64>();
    let options = Options::default();
    let a = alpha(&|| render(&mesh, &camera, &settings, SIZE, &options, &()).unwrap().picture.colour);
    let b = alpha(&|| render(&*exact, &camera, &settings, SIZE, &options, &()).unwrap().picture.colour);
    assert!(a < b && (b - a) / b < 2.0 * sagitta, "{a} {b}");
}

#[test]
fn the_tree_finds_what_a_search_of_all_triangles_finds() {
    let cloud = Cloud { origin: DVec3::new(4e6, -2e6, 7.0), ..sphere(9) };
    let mesh = Mesh::new("mesh", &cloud).unwrap();
    let mut random = Random::new(5, 5);
    let mut point =
        |scale: f64| cloud.origin + scale * (DVec3::from_array(std::array::from_fn(|_| random.unit())) - 0.5);
    let mut hits = 0;
    for _ in 0..2000 {
        let (from, to) = (point(6.0), point(2.4));
        let ray = Ray::new(from, (to - from).normalize()).unwrap();
        let corners =
            |triangle: &[u32; 3]| triangle.map(|i| cloud.origin + cloud.positions[i as usize].as_dvec3());
        let all = cloud.triangles.iter().filter_map(|triangle| Some(ray.meet(corners(triangle))?.0));
        let nearest = all.reduce(f64::min).map(|t| t / (to - from).length());
        assert_eq!(mesh.trace(from, to - from).map(|hit| hit.t), nearest);
        hits += usize::from(nearest.is_some());
    }
    assert!((300..1900).contains(&hits), "{hits}");
}

#[test]
fn no_ray_slips_between_triangles() {
    let n = 12;
    let cloud = sphere(n);
    let mesh = Mesh::new("mesh", &cloud).unwrap();
    let at = |corner: u32| cloud.positions[corner as usize].as_dvec3();
    for triangle in &cloud.triangles {
        for k in 0..3 {
            let (a, b) = (at(triangle[k]), at(triangle[(k + 1) % 3]));
            for target in [a, 0.5 * (a + b), 0.3 * a + 0.7 * b] {
                assert!(mesh.trace(DVec3::ZERO, target).is_some(), "{target} from inside");
                // Beyond the outline there is nothing, and on it rounding decides.
                let eye = DVec3::new(0.1, 0.2, 5.0);
                assert!(target.z < 0.4 || mesh.trace(eye, target - eye).is_some(), "{target}");
            }
        }
    }
    for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
        assert!(mesh.trace(-3.0 * axis, axis).is_some(), "{axis}");
        assert!(mesh.trace(3.0 * axis, axis).is_none(), "{axis}: it lies behind");
    }
    assert!(mesh.trace(DVec3::ZERO, DVec3::ZERO).is_none());
}

#[test]
fn colours_and_normals_are_interpolated() {
    let mut cloud = Cloud {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
        colours: Some(Colours::Linear(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])),
        ..Default::default()
    };
    let look = |cloud: &Cloud| {
        Mesh::new("mesh", cloud)
            .unwrap()
            .trace(DVec3::new(0.2, 0.3, 4.0), DVec3::new(0.0, 0.0, -2.0))
            .unwrap()
    };
    let hit = look(&cloud);
    assert!((hit.t - 2.0).abs() < 1e-15 && hit.normal == DVec3::Z, "{hit:?}");
    assert!(DVec3::from(hit.albedo.unwrap()).abs_diff_eq(DVec3::new(0.5, 0.2, 0.3), 1e-15), "{hit:?}");
    cloud.normals = Some(vec![Vec3::Z, Vec3::X, Vec3::ZERO]);
    cloud.colours = Some(Colours::Srgb8(vec![[188, 0, 0, 0]; 3]));
    let hit = look(&cloud);
    assert!(hit.normal.abs_diff_eq(DVec3::new(0.2, 0.0, 0.8).normalize(), 1e-12), "the last has the plane's");
    assert!((hit.albedo.unwrap()[0] - 0.502_886).abs() < 1e-6);
    cloud.colours = None;
    assert_eq!(look(&cloud).albedo, None);
    cloud.triangles = vec![[0, 1, 3]];
    assert!(Mesh::new("mesh", &cloud).err().unwrap().to_string().contains("a point that does not exist"));
    cloud.triangles.clear();
    assert!(Mesh::new("mesh", &cloud).err().unwrap().to_string().contains("no triangles"));
}

/// A triangle with a texture of two columns, red and blue.
fn textured(coordinates: [Vec2; 3]) -> Cloud {
    let colour = [[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]].to_vec();
    let image = MipMap::new(&Picture { size: [2, 1], colour, ..Default::default() }).unwrap();
    Cloud {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
        texture: Some(Texture { image: Arc::new(image), coordinates: coordinates.to_vec() }),
        ..Default::default()
    }
}

#[test]
fn textures_are_sampled_between_the_corners() {
    let mesh = Mesh::new("mesh", &textured([Vec2::ZERO, Vec2::X, Vec2::Y])).unwrap();
    // Centres of both texels, and the middle between them.
    for (x, colour) in [(0.25, [1.0, 0.0, 0.0]), (0.75, [0.0, 0.0, 1.0]), (0.5, [0.5, 0.0, 0.5])] {
        let hit = mesh.trace(DVec3::new(x, 0.1, 4.0), DVec3::NEG_Z).unwrap();
        assert!(DVec3::from(hit.albedo.unwrap()).abs_diff_eq(DVec3::from(colour), 1e-6), "{x}: {hit:?}");
    }
}

/// Two triangles beside each other, of which the second shows the same image in half its colours, turned; and one without an image.
fn textured_faces() -> Cloud {
    let own = textured([Vec2::ZERO, Vec2::X, Vec2::Y]);
    let levels = own.texture.unwrap().image;
    let image = |factor| FaceImage { levels: levels.clone(), factor: Vec3::splat(factor) };
    let corners = [Vec2::ZERO, Vec2::X, Vec2::Y];
    let faces = vec![
        FaceTexture { image: 0, corners },
        FaceTexture { image: 1, corners: [Vec2::X, Vec2::ZERO, Vec2::Y] },
        FaceTexture::NONE,
    ];
    let of =
        |x: f32| [0.0, 1.0, 0.0].iter().zip([0.0, 0.0, 1.0]).map(move |(&dx, y)| Vec3::new(x + dx, y, 0.0));
    Cloud {
        positions: [0.0, 2.0, 4.0].into_iter().flat_map(of).collect(),
        triangles: (0..3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        colours: Some(Colours::Linear(vec![[0.1, 0.2, 0.3]; 9])),
        face_textures: Some(FaceTextures { images: vec![image(1.0), image(0.5)], faces }),
        ..Default::default()
    }
}

#[test]
fn triangles_have_textures_of_their_own() {
    let mesh = Mesh::new("mesh", &textured_faces()).unwrap();
    let expected = [(0.25, [1.0, 0.0, 0.0]), (2.15, [0.0, 0.0, 0.5]), (4.25, [0.1, 0.2, 0.3])];
    for (x, colour) in expected {
        let hit = mesh.trace(DVec3::new(x, 0.1, 4.0), DVec3::NEG_Z).unwrap();
        assert!(DVec3::from(hit.albedo.unwrap()).abs_diff_eq(DVec3::from(colour), 1e-6), "{x}: {hit:?}");
    }
}

/// Two triangles meet at a corner of the cube's horizontal face, and one at that of each vertical face.
#[test]
fn normals_weigh_triangles_by_their_angles() {
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]];
    let mesh = Mesh::new(
        "corner",
        &Cloud {
            positions: corners.map(|corner| Vec3::from(corner.map(|c| c as f32))).to_vec(),
            // Outwards: down, to the left and to the back.
            triangles: vec![[0, 2, 1], [0, 3, 2], [0, 4, 3], [4, 6, 3], [0, 1, 4], [1, 5, 4]],
            ..Default::default()
        },
    )
    .unwrap();
    let hit = mesh.trace(DVec3::new(-2.0, -2.0, -3.0), DVec3::new(2.0, 2.0, 3.0) + 1e-9).unwrap();
    assert!(hit.normal.abs_diff_eq(DVec3::splat(-1.0 / 3f64.sqrt()), 1e-6), "{}", hit.normal);
}

#[test]
fn digests_tell_meshes_apart() {
    let usual = Cloud {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: Some(vec![Vec3::Z; 3]),
        triangles: vec![[0, 1, 2]],
        colours: Some(Colours::Linear(vec![[0.5; 3]; 3])),
        ..Default::default()
    };
    let digest = |cloud: &Cloud| Mesh::new("mesh", cloud).unwrap().digest();
    assert_eq!(digest(&usual), digest(&usual.clone()));
    let mut other_faces = textured_faces();
    other_faces.face_textures.as_mut().unwrap().faces[0].corners[1].y = 0.5;
    let all = [
        usual.clone(),
        Cloud { origin: DVec3::X, ..usual.clone() },
        Cloud { normals: Some(vec![Vec3::Z, Vec3::Z, Vec3::X]), ..usual.clone() },
        Cloud { triangles: vec![[0, 2, 1]], normals: Some(vec![Vec3::Z; 3]), ..usual.clone() },
        Cloud { colours: Some(Colours::Linear(vec![[0.5, 0.5, 0.6]; 3])), ..usual.clone() },
        Cloud { colours: None, ..usual },
        textured([Vec2::ZERO, Vec2::X, Vec2::Y]),
        textured([Vec2::ZERO, Vec2::X, Vec2::ONE]),
        textured_faces(),
        Cloud { face_textures: None, ..textured_faces() },
        other_faces,
    ];
    let mut digests = all.each_ref().map(digest).to_vec();
    digests.sort();
    digests.dedup();
    assert_eq!(digests.len(), all.len());
}

#[test]
fn a_coarse_mesh_is_closed_and_has_the_corners_that_were_kept() {
    let cloud = sphere(64);
    let fine = Mesh::new("sphere", &cloud).unwrap();
    let kept = cloud.spread(600);
    let coarse = fine.coarse(&kept).unwrap();
    // A triangle between three cells has neighbours across all its edges.
    let mut edges = std::collections::HashMap::new();
    for [a, b, c] in coarse.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from, to)).or_insert(0) += 1;
        }
    }
    for ((from, to), count) in &edges {
        assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)), "{from} {to}");
    }
    // A closed surface of genus 0. Of corners that share a pole, some have no cell between them.
    let corners: std::collections::HashSet<u32> = coarse.triangles().iter().flatten().copied().collect();
    assert!(
        corners.len() > 550 && coarse.len() == 2 * corners.len() - 4,
        "{} {}",
        corners.len(),
        coarse.len()
    );
    // Rays from outside to the centre hit it from every side, near the sphere.
    let mut random = Random::new(5, 0);
    for _ in 0..500 {
        let from = 3.0 * DVec3::new(random.normal(), random.normal(), random.normal()).normalize();
        let hit = coarse.trace(from, -from).expect("a hole");
        let radius = 3.0 * (1.0 - hit.t);
        // 600 points leave cells of a radius of about 0.1: chords 0.02 inside.
        assert!((0.95..1.0 + 1e-6).contains(&radius), "{radius}");
    }
    assert!(fine.coarse(&kept[..2]).is_err_and(|error| error.to_string().contains("no triangle")));
    let again = fine.coarse(&(0..cloud.len() as u32).collect::<Vec<_>>()).unwrap();
    assert!(again.bounds() == fine.bounds());
}
