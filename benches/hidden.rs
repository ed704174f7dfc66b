//! Frames inside one of many rooms, whose walls hide all others: two-phase occlusion culling on the compute path.

mod support;

use glam::{DVec3, Vec3};
use std::rc::Rc;
use support::{Result, Row, Table, frames};
use surfel::bench::engine::DeviceEngine;
use surfel::bench::format;
use surfel::geometry::{Camera, Surfels};
use surfel::{Rasterizer, RenderOptions, Scene, Settings};

/// Points along a room's sides.
const STEPS: usize = 100;
/// Thickness of walls, in sides of a room.
const WALL: f32 = 0.06;

fn main() -> Result<()> {
    let Some(device) = support::device() else { return Ok(()) };
    let table = Table::new("a frame inside a closed room, 512×384 px", Some(&device));
    let row = |rooms: usize| {
        let surfels = building(rooms);
        let scene = Scene::upload(&device, &surfels)?;
        let eye = DVec3::new(0.2, 0.5, 0.2);
        let camera = Camera::look_at(eye, DVec3::new(1.0, 0.45, 0.9), DVec3::Y, 1.2, 4.0 / 3.0, 1e-3)?;
        let options =
            RenderOptions { size: [512, 384], rasterizer: Rasterizer::Compute.into(), ..Default::default() };
        let engine = DeviceEngine::new(&device, Rc::new(scene), options)?;
        let what = format!("{} rooms, {} points", rooms * rooms, format::count(surfels.len() as u64));
        Ok(Row::new(what, frames(engine, camera, Settings::default())))
    };
    table.compare([1, 2, 4, 8].into_iter().map(row).collect::<Result<_>>()?)
}

/// Square of rooms that face inwards, in Morton order.
fn building(rooms: usize) -> Surfels {
    let mut surfels = Surfels::default();
    let spacing = 1.0 / STEPS as f32;
    let inset = |x: f32| x.clamp(0.5 * WALL, 1.0 - 0.5 * WALL);
    for (i, k) in (0..rooms * rooms).map(|room| (room % rooms, room / rooms)) {
        let corner = Vec3::new(i as f32, 0.0, k as f32);
        for point in 0..6 * STEPS * STEPS {
            let (face, u, v) = (point / (STEPS * STEPS), point / STEPS % STEPS, point % STEPS);
            let (axis, side) = (face / 2, (face % 2) as f32);
            let mut at = [0.0; 3];
            at[axis] = inset(side);
            at[(axis + 1) % 3] = inset((u as f32 + 0.5) * spacing);
            at[(axis + 2) % 3] = inset((v as f32 + 0.5) * spacing);
            let mut normal = [0.0; 3];
            normal[axis] = 1.0 - 2.0 * side;
            surfels.positions.push(corner + Vec3::from(at));
            surfels.normals.push(Vec3::from(normal));
            surfels.radii.push(1.2 * spacing);
        }
    }
    surfels.sort_morton();
    surfels
}
