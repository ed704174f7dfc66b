//! A host's frames of several scenes and of many instances, against one scene with the same surfels.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

#[path = "../tools/hosts/host/mod.rs"]
mod host;
#[path = "support/stand.rs"]
mod stand;
mod support;

use glam::{DMat4, DQuat, DVec3};
use host::scene::{camera, sphere};
use stand::Stand;
use std::ops::Range;
use support::{Result, Row, Table, whole};
use surfel::embed::View;
use surfel::geometry::{Camera, Colours, Surfels};
use surfel::settings::Choice;
use surfel::settings::methods::Method;
use surfel::verify::scenes::bumpy_sphere;
use surfel::{Instance, Rasterizer, Settings};

/// Surfels, and number of scenes that they are divided into.
const POINTS: usize = 200_000;
const PARTS: usize = 8;
/// Many instances, and surfels of each.
const INSTANCES: usize = 1024;
const SURFELS: u32 = 50;
const LARGE: [u32; 2] = [1024; 2];
const SMALL: [u32; 2] = [64; 2];

/// A name, and instances that are rendered together.
type Kind = (String, Vec<Instance>);

fn main() -> Result<()> {
    let Some(stand) = Stand::open(LARGE)? else { return Ok(()) };
    let about = format!(
        "a frame of {POINTS} surfels in 1024×1024 px, and of {INSTANCES} instances of {SURFELS} surfels in 64×64 px"
    );
    let table = Table::new(&about, Some(&stand.device));
    let (kinds, view) = (divided(&stand)?, View::whole(camera(0.0, LARGE)?, LARGE));
    for name in ["perspective-ewa", "sprites", "sprites-unfiltered", "pull-push"] {
        let settings = Method::named(name).ok_or("no such method")?.settings();
        compare(&table, &stand, name, &kinds, (&view, &settings))?;
    }
    drop(kinds);
    stand.close();

    let Some(stand) = Stand::open(SMALL)? else { return Ok(()) };
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, 60.0), DVec3::ZERO, DVec3::Y, 0.9, 1.0, 1.0)?;
    let (kinds, view) = (many(&stand)?, View::whole(camera, SMALL));
    compare(&table, &stand, "perspective-ewa", &kinds, (&view, &Settings::default()))?;
    drop(kinds);
    stand.close();
    Ok(())
}

/// Times each kind by both rasterizers, relative to the first.
fn compare(
    table: &Table,
    stand: &Stand,
    name: &str,
    kinds: &[Kind],
    (view, settings): (&View, &Settings),
) -> Result<()> {
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let row = |(kind, instances): &Kind| {
            let (mut renderer, instances) = (stand.renderer(rasterizer)?, instances.clone());
            let frame =
                move || stand.host.run(|cmd| stand.record(cmd, &mut renderer, &instances, view, settings));
            Ok(Row::new(format!("{name}, {}, {kind}", rasterizer.name()), whole(frame)))
        };
        table.compare(kinds.iter().map(row).collect::<Result<_>>()?)?;
    }
    Ok(())
}

/// The same surfels as one scene, as one instance, as several scenes, and as several instances.
fn divided(stand: &Stand) -> Result<Vec<Kind>> {
    let all = sphere(POINTS as u32);
    let part = |k: usize| subset(&all, k * POINTS / PARTS..(k + 1) * POINTS / PARTS);
    let placement = DMat4::from_scale_rotation_translation(
        DVec3::splat(2.0),
        DQuat::from_rotation_y(1.0),
        DVec3::new(3.0, 0.0, -1.0),
    );
    let plain = |surfels: &Surfels| Ok(Instance::new(&stand.upload(surfels)?, DMat4::IDENTITY));
    let placed = |surfels: &Surfels| {
        let moved = transformed(surfels, placement.inverse());
        Ok(Instance::new(&stand.upload(&moved)?, placement))
    };
    let several = |make: &dyn Fn(&Surfels) -> Result<Instance>| {
        (0..PARTS).map(|k| make(&part(k))).collect::<Result<Vec<_>>>()
    };
    Ok(vec![
        ("one".into(), vec![plain(&all)?]),
        ("one, placed".into(), vec![placed(&all)?]),
        (format!("{PARTS}"), several(&plain)?),
        (format!("{PARTS}, placed"), several(&placed)?),
    ])
}

/// Instances on a grid, each with another rotation, and the same surfels as one scene.
fn many(stand: &Stand) -> Result<Vec<Kind>> {
    let placement = |i: usize| {
        let [x, y] = [i % 32, i / 32].map(|k| 1.7 * (k as f64 - 15.5));
        DMat4::from_rotation_translation(DQuat::from_rotation_y(i as f64), DVec3::new(x, y, 0.0))
    };
    let surfels = bumpy_sphere::sample(SURFELS, 1);
    let all: Vec<_> = (0..INSTANCES).map(|i| transformed(&surfels, placement(i))).collect();
    let merged = stand.upload(&Surfels::merge(all, [1.0; 3])?)?;
    let scene = stand.upload(&surfels)?;
    let instances = (0..INSTANCES).map(|i| Instance::new(&scene, placement(i)));
    Ok(vec![
        ("merged".into(), vec![Instance::new(&merged, DMat4::IDENTITY)]),
        (format!("{INSTANCES} instances"), instances.collect()),
    ])
}

fn subset(surfels: &Surfels, range: Range<usize>) -> Surfels {
    let colours = surfels.colours.as_ref().map(|colours| match colours {
        Colours::Srgb8(all) => Colours::Srgb8(all[range.clone()].to_vec()),
        Colours::Linear(all) => Colours::Linear(all[range.clone()].to_vec()),
    });
    Surfels {
        positions: surfels.positions[range.clone()].to_vec(),
        normals: surfels.normals[range.clone()].to_vec(),
        radii: surfels.radii[range].to_vec(),
        colours,
        ..Default::default()
    }
}

/// Surfels moved, turned and scaled.
fn transformed(surfels: &Surfels, by: DMat4) -> Surfels {
    let mut surfels = surfels.clone();
    for position in &mut surfels.positions {
        *position = by.transform_point3(position.as_dvec3()).as_vec3();
    }
    for normal in &mut surfels.normals {
        *normal = by.transform_vector3(normal.as_dvec3()).normalize().as_vec3();
    }
    let scale = by.determinant().cbrt() as f32;
    surfels.radii.iter_mut().for_each(|radius| *radius *= scale);
    surfels
}
