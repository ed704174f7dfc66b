//! Real scans, from file to picture, against their meshes.

use crate::support::settings::splats_alone;
use crate::support::{gpu, if_whole, mesh, skipping};
use glam::{DVec3, Vec3};
use std::sync::Arc;
use surfel::estimate::Estimate;
use surfel::formats::{self, ReadOptions};
use surfel::geometry::srgb;
use surfel::geometry::{Bounds, Camera, Cloud, Surfels};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Picture, RenderOptions};

const SIDE: u32 = 1024;
/// From where scans are looked at: their directions from the middle.
const DIRECTIONS: [DVec3; 3] =
    [DVec3::new(0.0, 0.2, 1.0), DVec3::new(1.0, 0.5, -0.3), DVec3::new(-0.6, -0.4, -0.8)];

fn cameras(bounds: &Bounds) -> [Camera; 3] {
    let away = 2.6 * bounds.radius;
    DIRECTIONS.map(|direction| {
        let eye = bounds.centre() + away * direction.normalize();
        Camera::look_at(eye, bounds.centre(), DVec3::Y, 45f64.to_radians(), 1.0, 0.01 * away).unwrap()
    })
}

fn render(device: &Arc<Device>, surfels: &Surfels, camera: &Camera) -> Picture {
    gpu::render(
        device,
        surfels,
        camera,
        &splats_alone(),
        RenderOptions { size: [SIDE; 2], ..Default::default() },
    )
}

fn covered(picture: &Picture) -> Vec<bool> {
    picture.colour.iter().map(|pixel| pixel[3] > 0.0).collect()
}

#[test]
fn scans_have_their_meshes_outlines_and_no_holes() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    let names = ["stanford/bunny/bun_zipper.ply", "classic/igea.ply", "stanford/dragon/dragon_vrip.ply"];
    for name in &names[..if_whole(names.len(), 1)] {
        let Some(path) = skipping::data(name) else { return };
        let mesh = mesh::read(&path);
        let bare = Cloud { positions: mesh.positions.clone(), origin: mesh.origin, ..Default::default() };
        for (from, cloud) in [("faces", mesh.clone()), ("neighbours", bare)] {
            let (surfels, _) = cloud.into_surfels(&Estimate::default(), &()).unwrap();
            for (view, camera) in cameras(&surfels.bounds().unwrap()).iter().take(if_whole(3, 1)).enumerate()
            {
                let truth = mesh::silhouette(&mesh, camera, [SIDE; 2]);
                let coverage = mesh::compare(&truth, &covered(&render(&device, &surfels, camera)), SIDE);
                println!("{name}, radii from {from}, view {view}: {coverage:?}");
                let largest = coverage.holes.first().copied().unwrap_or(0);
                assert!(
                    coverage.iou >= 0.97 && largest < 3,
                    "{name}, radii from {from}, view {view}: {coverage:?}"
                );
            }
        }
    }
    gpu::assert_silent(&device);
}

/// A range scan is open: bare points have no mesh that says where it ends, nor where it is torn.
#[test]
fn bare_points_of_a_range_scan_end_with_it() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    for (name, least) in &[("bun000.ply", 0.973), ("bun090.ply", 0.955)][..if_whole(2, 1)] {
        let Some(path) = skipping::data(&format!("stanford/bunny/range/{name}")) else { return };
        let mesh = mesh::read(&path);
        let bare = Cloud { positions: mesh.positions.clone(), origin: mesh.origin, ..Default::default() };
        let (surfels, _) = bare.into_surfels(&Estimate::default(), &()).unwrap();
        let [camera, ..] = cameras(&surfels.bounds().unwrap());
        let truth = mesh::silhouette(&mesh, &camera, [SIDE; 2]);
        let coverage = mesh::compare(&truth, &covered(&render(&device, &surfels, &camera)), SIDE);
        println!("{name}: {coverage:?}");
        // The mesh spans gaps of more than a disc, where the scanner saw the surface at a steep angle.
        let largest = coverage.holes.first().copied().unwrap_or(0);
        assert!(coverage.iou >= *least && largest <= 25, "{name}: {coverage:?}");
    }
    gpu::assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn radii_are_within_half_again_of_the_least_without_holes() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    let Some(path) = skipping::data("stanford/bunny/bun_zipper.ply") else { return };
    let mesh = mesh::read(&path);
    let bare = Cloud { positions: mesh.positions.clone(), ..Default::default() };
    for (from, cloud) in [("faces", mesh.clone()), ("neighbours", bare)] {
        let holes = |radius_scale: f32| {
            let how = Estimate { radius_scale, ..Default::default() };
            let (surfels, _) = cloud.clone().into_surfels(&how, &()).unwrap();
            let coverage = cameras(&surfels.bounds().unwrap()).map(|camera| {
                let truth = mesh::silhouette(&mesh, &camera, [SIDE; 2]);
                mesh::compare(&truth, &covered(&render(&device, &surfels, &camera)), SIDE)
            });
            coverage.iter().map(|coverage| coverage.holes.iter().sum::<usize>()).sum::<usize>()
        };
        let pixels = [1.0, 1.0 / 1.5].map(holes);
        println!(
            "radii from {from}: {pixels:?} px of holes at the estimated radii and at two thirds of them"
        );
        assert!(pixels[0] == 0 && pixels[1] > 0, "radii from {from}: {pixels:?}");
    }
    gpu::assert_silent(&device);
}

/// A scan far from the origin, as a file with double coordinates, is the same picture: geodetic coordinates keep their millimetres.
#[test]
#[ignore = "takes long: tools/test --all"]
fn a_scan_far_away_is_the_same_picture() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    let Some(path) = skipping::data("stanford/dragon/dragon_vrip.ply") else { return };
    let offset = DVec3::new(500_000.0, 4_600_000.0, 100.0);
    let file = std::fs::read(&path).unwrap();
    let near = formats::read_bytes("near", &file, &ReadOptions::default()).unwrap().cloud;
    let far =
        formats::read_bytes("far", &moved(&file, near.len(), offset), &ReadOptions::default()).unwrap().cloud;
    assert!(
        far.origin.distance(offset) < 1.0 && near.origin == DVec3::ZERO,
        "{} {}",
        near.origin,
        far.origin
    );
    let pictures = [near, far].map(|cloud| {
        let (surfels, _) = cloud.into_surfels(&Estimate::default(), &()).unwrap();
        let [camera, ..] = cameras(&surfels.bounds().unwrap());
        let pixels = render(&device, &surfels, &camera).colour;
        pixels.iter().flat_map(|pixel| pixel.map(srgb::encode8)).collect::<Vec<u8>>()
    });
    let difference = |(a, b): (&u8, &u8)| a.abs_diff(*b);
    let largest = pictures[0].iter().zip(&pictures[1]).map(difference).max().unwrap();
    println!("largest difference {largest}/255");
    assert!(largest <= 2, "{largest}");
    gpu::assert_silent(&device);
}

/// A binary little-endian file whose vertices are three floats, moved by `offset` and written as doubles.
fn moved(file: &[u8], count: usize, offset: DVec3) -> Vec<u8> {
    let end = b"end_header\n";
    let payload = end.len() + file.windows(end.len()).position(|window| window == end).unwrap();
    let header = std::str::from_utf8(&file[..payload]).unwrap();
    assert_eq!(header.matches("property float ").count(), 3, "{header}");
    let mut out = header.replace("property float ", "property double ").into_bytes();
    let (vertices, rest) = file[payload..].split_at(12 * count);
    for vertex in vertices.chunks_exact(12) {
        let position: Vec3 = bytemuck::pod_read_unaligned(vertex);
        (position.as_dvec3() + offset).to_array().iter().for_each(|x| out.extend(x.to_le_bytes()));
    }
    out.extend(rest);
    out
}
