//! Outlines of the points of meshes against those of the triangles, from six sides: scans, decimated and stretched ones, shapes of CAD programs.

use crate::support::{gpu, if_whole, mesh, skipping};
use glam::{DVec3, Vec3};
use std::f32::consts::TAU;
use std::sync::Arc;
use surfel::estimate::Estimate;
use surfel::geometry::{Bounds, Camera, Cloud};
use surfel::vk::{Device, DeviceLimits};
use surfel::{RenderOptions, Settings};

const SIDE: u32 = 1024;
/// Least px that both cover, over those that either covers.
const LEAST_IOU: f64 = 0.985;
/// Most connected px beyond the neighbours of the mesh's, and in a hole.
const MOST_TOGETHER: usize = 20;

fn cameras(bounds: &Bounds) -> [Camera; 6] {
    let away = 2.6 * bounds.radius;
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    [0, 1, 2, 3, 4, 5].map(|i| {
        let (axis, side) = (i % 3, if i < 3 { 1.0 } else { -1.0 });
        let (eye, up) = (bounds.centre() + side * away * axes[axis], axes[(axis + 1) % 3]);
        Camera::look_at(eye, bounds.centre(), up, 45f64.to_radians(), 1.0, 0.01 * away).unwrap()
    })
}

/// Checks one mesh, and adds what fails: an IoU that is too small, or a bloated region or a hole of more than `most` px.
fn check(device: &Arc<Device>, name: &str, mesh: &Cloud, most: [usize; 2], failed: &mut Vec<String>) {
    let (surfels, _) = mesh.clone().into_surfels(&Estimate::default(), &()).unwrap();
    let mut worst = (1.0_f64, 0, 0);
    for camera in &cameras(&surfels.bounds().unwrap())[..if_whole(6, 3)] {
        let options = RenderOptions { size: [SIDE; 2], ..Default::default() };
        let picture = gpu::render(device, &surfels, camera, &Settings::default(), options);
        let covered: Vec<bool> = picture.colour.iter().map(|pixel| pixel[3] >= 0.5).collect();
        let truth = mesh::silhouette(mesh, camera, [SIDE; 2]);
        let empty = |mask: &[bool]| -> Vec<bool> { mask.iter().map(|covered| !covered).collect() };
        let coverage = mesh::compare(&truth, &covered, SIDE);
        let bloated = mesh::compare(&empty(&truth), &empty(&covered), SIDE).holes;
        let first = |sizes: &[usize]| sizes.first().copied().unwrap_or(0);
        worst =
            (worst.0.min(coverage.iou), worst.1.max(first(&bloated)), worst.2.max(first(&coverage.holes)));
    }
    let (iou, bloated, hole) = worst;
    let line = format!("{name}: IoU {iou:.4}, largest bloated region {bloated} px, largest hole {hole} px");
    println!("{line}");
    if iou < LEAST_IOU || bloated > most[0] || hole > most[1] {
        failed.push(line);
    }
}

/// The mesh without the points that no triangle uses, which loading a file leaves out.
fn used(mesh: &Cloud) -> Cloud {
    let mut places = vec![None; mesh.len()];
    let mut positions = Vec::new();
    let place = |&i: &u32| {
        *places[i as usize].get_or_insert_with(|| {
            positions.push(mesh.positions[i as usize]);
            positions.len() as u32 - 1
        })
    };
    let corners: Vec<u32> = mesh.triangles.iter().flatten().map(place).collect();
    let triangles = corners.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
    Cloud { positions, triangles, origin: mesh.origin, ..Cloud::default() }
}

/// Meshes, and the most px together by which they may be bloated and have holes, where these are more than [`MOST_TOGETHER`]: at rims of open
/// meshes that are seen from below, at sharply curved outlines between vertices far apart, and in the coarsest mesh.
const SCANS: [(&str, [usize; 2]); 16] = [
    ("stanford/bunny/bun_zipper_res2.ply", [MOST_TOGETHER; 2]),
    ("stanford/bunny/bun_zipper_res3.ply", [MOST_TOGETHER, 40]),
    ("stanford/bunny/bun_zipper_res4.ply", [100, 160]),
    ("stanford/bunny/bun_zipper.ply", [130, 65]),
    ("stanford/buddha/buddha_50k.ply", [MOST_TOGETHER; 2]),
    ("stanford/buddha/happy_vrip_res3.ply", [35, MOST_TOGETHER]),
    ("stanford/dragon/dragon_vrip_res2.ply", [MOST_TOGETHER; 2]),
    ("stanford/dragon/dragon_vrip_res3.ply", [50, MOST_TOGETHER]),
    ("stanford/dragon/dragon_vrip_res4.ply", [MOST_TOGETHER, 45]),
    ("stanford/dragon/stanford_dragon_v40k_f80k.ply", [MOST_TOGETHER; 2]),
    ("stanford/dragon/dragon_vrip.ply", [MOST_TOGETHER; 2]),
    ("classic/screwdriver.ply", [MOST_TOGETHER; 2]),
    ("classic/igea.ply", [70, MOST_TOGETHER]),
    ("classic/feline_50k.ply", [MOST_TOGETHER; 2]),
    ("classic/laurana50k.ply", [MOST_TOGETHER; 2]),
    ("classic/chinese_dragon_10k.ply", [MOST_TOGETHER; 2]),
];

#[test]
#[ignore = "takes long: tools/test --all"]
fn meshes_keep_their_outlines() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    let mut failed = Vec::new();
    for (name, most) in SCANS {
        let Some(path) = skipping::data(name) else { continue };
        let mesh = used(&mesh::read(&path));
        check(&device, name, &mesh, most, &mut failed);
        if name.ends_with("res2.ply") {
            for stretch in [Vec3::new(1.0, 3.0, 1.0), Vec3::new(0.2, 1.0, 1.0)] {
                let positions = mesh.positions.iter().map(|position| stretch * *position).collect();
                let stretched = Cloud { positions, ..mesh.clone() };
                check(
                    &device,
                    &format!("{name} × {stretch}"),
                    &stretched,
                    [MOST_TOGETHER + 5, 2 * MOST_TOGETHER + 5],
                    &mut failed,
                );
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
    gpu::assert_silent(&device);
}

#[test]
fn shapes_of_cad_programs_keep_their_outlines() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    let shapes: [(&str, Cloud); 6] = [
        ("box", extruded(&polygon(4), 0.3)),
        ("hexagonal prism", extruded(&polygon(6), 2.0)),
        ("cylinder with fans", extruded(&polygon(64), 1.5)),
        ("gear", extruded(&gear(), 0.4)),
        ("torus", torus(24, 12)),
        ("globe of a sphere", globe(32, 16)),
    ];
    let mut failed = Vec::new();
    for (name, mesh) in &shapes[..if_whole(shapes.len(), 2)] {
        check(&device, name, mesh, [MOST_TOGETHER; 2], &mut failed);
    }
    assert!(failed.is_empty(), "{failed:#?}");
    gpu::assert_silent(&device);
}

/// A regular polygon in a unit circle.
fn polygon(corners: u32) -> Vec<Vec3> {
    (0..corners)
        .map(|i| (TAU * i as f32 / corners as f32).sin_cos())
        .map(|(sin, cos)| Vec3::new(cos, sin, 0.0))
        .collect()
}

/// Twelve teeth.
fn gear() -> Vec<Vec3> {
    let corner = |(i, at): (usize, Vec3)| if i / 2 % 2 == 0 { at } else { 0.8 * at };
    polygon(48).into_iter().enumerate().map(corner).collect()
}

/// A prism, whose ends are fans of triangles about their middles.
fn extruded(outline: &[Vec3], height: f32) -> Cloud {
    let count = outline.len() as u32;
    let end = |z: f32| outline.iter().map(move |at| *at + z * Vec3::Z).chain([z * Vec3::Z]);
    let (top, middle) = (count + 1, count);
    let triangles = (0..count).flat_map(|i| {
        let j = (i + 1) % count;
        [[i, j, top + j], [i, top + j, top + i], [middle, j, i], [top + middle, top + i, top + j]]
    });
    Cloud {
        positions: end(-0.5 * height).chain(end(0.5 * height)).collect(),
        triangles: triangles.collect(),
        ..Cloud::default()
    }
}

/// Quads around a ring, each of two triangles.
fn lattice(rows: u32, columns: u32, at: impl Fn(f32, f32) -> Vec3) -> Cloud {
    let angle = |i: u32, of: u32| TAU * i as f32 / of as f32;
    let positions = (0..rows * columns).map(|i| at(angle(i / columns, rows), angle(i % columns, columns)));
    let triangles = (0..rows * columns).flat_map(|i| {
        let (row, column) = (i / columns, i % columns);
        let place = |row: u32, column: u32| row % rows * columns + column % columns;
        let corners = [(row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1)];
        let [a, b, c, d] = corners.map(|(row, column)| place(row, column));
        [[a, b, c], [a, c, d]]
    });
    Cloud { positions: positions.collect(), triangles: triangles.collect(), ..Cloud::default() }
}

fn torus(rows: u32, columns: u32) -> Cloud {
    lattice(rows, columns, |around, across| {
        let (out, up) = (1.0 + 0.35 * across.cos(), 0.35 * across.sin());
        Vec3::new(out * around.cos(), out * around.sin(), up)
    })
}

/// A sphere of meridians, whose triangles grow thin towards its poles.
fn globe(columns: u32, rows: u32) -> Cloud {
    let mut outline: Vec<Vec3> = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..=rows {
        let polar = 0.5 * TAU * row as f32 / rows as f32;
        let ring = polygon(columns);
        outline.extend(ring.iter().map(|at| polar.sin() * *at + polar.cos() * Vec3::Z));
    }
    for i in 0..rows * columns {
        let (row, column) = (i / columns, i % columns);
        let next = (column + 1) % columns;
        let [a, b, c, d] = [(row, column), (row + 1, column), (row + 1, next), (row, next)]
            .map(|(row, column)| row * columns + column);
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    Cloud { positions: outline, triangles, ..Cloud::default() }
}
