//! Updates of uploaded surfels: visible in later frames, and not in earlier ones.

use crate::compare::{ALONE, NARROW, alone, differing, refused, settings};
use crate::fixture::{assert_silent, open, upload};
use crate::host::frame::Frame;
use crate::inputs::{ellipses, moved, sphere, spoil};
use crate::rig::{KIND, Rig, SIZE};
use crate::support::sampling::{Random, narrow, paint_linear, paint_srgb};
use glam::Vec3;
use surfel::embed::{self, Changes};
use surfel::geometry::{Clip, Clips, Colours, Surfels, Weights};
use surfel::settings::methods::Method;
use surfel::vk::DeviceLimits;
use surfel::{Rasterizer, Scene};

/// Surfels `range` of `surfels` as changes of all streams.
fn changes<'a>(surfels: &'a Surfels, range: std::ops::Range<usize>, colours: &'a Colours) -> Changes<'a> {
    Changes {
        positions: Some(&surfels.positions[range.clone()]),
        normals: Some(&surfels.normals[range.clone()]),
        curvatures: surfels.curvatures.as_ref().map(|curvatures| &curvatures[range.clone()]),
        radii: Some(&surfels.radii[range.clone()]),
        two_sided: surfels.two_sided.as_ref().map(|two_sided| &two_sided[range.clone()]),
        ellipses: surfels.ellipses.as_ref().map(|ellipses| &ellipses[range.clone()]),
        colours: Some(colours),
        bounds: None,
    }
}

fn part(colours: Option<&Colours>, range: std::ops::Range<usize>) -> Colours {
    match colours {
        Some(Colours::Srgb8(colours)) => Colours::Srgb8(colours[range].to_vec()),
        Some(Colours::Linear(colours)) => Colours::Linear(colours[range].to_vec()),
        None => panic!("there are colours"),
    }
}

/// `old` with a range of `new`.
fn mixed(old: &Surfels, new: &Surfels, range: std::ops::Range<usize>) -> Surfels {
    let mut mixed = old.clone();
    mixed.positions[range.clone()].copy_from_slice(&new.positions[range.clone()]);
    mixed.normals[range.clone()].copy_from_slice(&new.normals[range.clone()]);
    mixed.radii[range.clone()].copy_from_slice(&new.radii[range.clone()]);
    if let (Some(mixed), Some(new)) = (&mut mixed.two_sided, &new.two_sided) {
        mixed[range.clone()].copy_from_slice(&new[range.clone()]);
    }
    if let (Some(mixed), Some(new)) = (&mut mixed.ellipses, &new.ellipses) {
        mixed[range.clone()].copy_from_slice(&new[range.clone()]);
    }
    match (&mut mixed.colours, &new.colours) {
        (Some(Colours::Srgb8(mixed)), Some(Colours::Srgb8(new))) => {
            mixed[range.clone()].copy_from_slice(&new[range])
        }
        (Some(Colours::Linear(mixed)), Some(Colours::Linear(new))) => {
            mixed[range.clone()].copy_from_slice(&new[range])
        }
        _ => panic!("colours are of one kind"),
    }
    mixed
}

/// Other values of all streams for the same surfels.
fn others(surfels: &Surfels) -> Surfels {
    let mut other = moved(surfels, 4);
    other.radii.iter_mut().for_each(|radius| *radius *= 1.25);
    other.two_sided.iter_mut().flatten().for_each(|two_sided| *two_sided = !*two_sided);
    let random = &mut Random(99);
    if other.ellipses.is_some() {
        narrow(&mut other, random);
    }
    match other.colours {
        Some(Colours::Linear(_)) => paint_linear(&mut other, random),
        _ => paint_srgb(&mut other, random),
    }
    other
}

#[test]
fn an_update_is_seen_by_the_frames_after_it_and_by_none_before() {
    let Some(host) = open(|all| all) else { return };
    for (surfels, rasterizer) in [(sphere(20_000), Rasterizer::Draw), (ellipses(20_000), Rasterizer::Compute)]
    {
        let new = others(&surfels);
        let mut rig = Rig::new(&host, Some(rasterizer), NARROW);
        let border = upload(&host, &rig.device, &surfels).chunks()[0].end as usize;
        for range in [border - 3..border + 5, 0..border, border..20_000, 0..20_000, 7..8] {
            let settings = settings(Method::named("sprites-unfiltered").unwrap());
            let scene = upload(&host, &rig.device, &surfels);
            let [before, after] = [(); 2].map(|()| Frame::new(&host, KIND, SIZE).unwrap());
            let colours = part(new.colours.as_ref(), range.clone());
            let changes = changes(&new, range.clone(), &colours);
            let (submitted, staging) = host
                .submit(|cmd| {
                    rig.record(&host, cmd, Some(&before), &scene, &settings);
                    // SAFETY: recorded outside a render pass, between frames of the same queue.
                    let staging =
                        unsafe { embed::update(cmd, &scene, range.start as u64, &changes) }.unwrap();
                    rig.record(&host, cmd, Some(&after), &scene, &settings);
                    Ok(staging)
                })
                .unwrap();
            assert!(staging.bytes() > 0);
            host.wait(submitted).unwrap();
            drop(staging);
            let old = upload(&host, &rig.device, &surfels);
            let later = mixed(&surfels, &new, range.clone());
            for (frame, surfels, like) in [(before, &surfels, &old), (after, &later, &scene)] {
                let found = frame.read(&host).unwrap();
                let expected = rig.render_uploaded(&host, surfels, like, &settings);
                assert_eq!(differing(&found, &expected, 0.0), 0, "{rasterizer:?} {range:?}");
                frame.destroy(&host);
            }
        }
        rig.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn what_an_update_makes_invalid_is_culled_and_what_it_mends_is_drawn() {
    let Some(device) = crate::support::gpu::device(DeviceLimits::default()) else { return };
    let good = ellipses(6_000);
    let mut bad = good.clone();
    spoil(&mut bad);
    for (from, to) in [(&good, &bad), (&bad, &good)] {
        let scene = Scene::upload(&device, from).unwrap();
        let colours = part(to.colours.as_ref(), 100..5_900);
        scene.update(100, &changes(to, 100..5_900, &colours)).unwrap();
        let expected = Scene::upload(&device, &mixed(from, to, 100..5_900)).unwrap();
        for (name, rasterizer) in ALONE {
            let [found, expected] = [&scene, &expected].map(|scene| alone(&device, scene, name, rasterizer));
            assert!(expected.1.invalid > 50);
            assert_eq!(found.1, expected.1, "{name} {rasterizer:?}");
            assert!(found.0 == expected.0, "{name} {rasterizer:?}");
        }
    }
    // A new radius enables a surfel that was disabled for another reason.
    let mut circles = sphere(500);
    circles.colours = Some(Colours::Linear(vec![[0.5; 3]; 500]));
    if let Some(Colours::Linear(colours)) = &mut circles.colours {
        colours[5][1] = f32::NAN;
    }
    circles.normals[7] = Vec3::NAN;
    let scene = Scene::upload(&device, &circles).unwrap();
    scene.update(4, &Changes { radii: Some(&[0.1; 4]), ..Default::default() }).unwrap();
    for (name, rasterizer) in ALONE {
        let (picture, counts) = alone(&device, &scene, name, rasterizer);
        assert_eq!(counts.invalid, 2, "{name} {rasterizer:?}");
        assert!(picture.colour.iter().flatten().all(|value| value.is_finite()));
    }
    // A single stream.
    let scene = Scene::upload(&device, &good).unwrap();
    scene.update(0, &Changes { positions: Some(&[Vec3::NAN, Vec3::ZERO]), ..Default::default() }).unwrap();
    let (_, counts) = alone(&device, &scene, "pull-push", Rasterizer::Compute);
    assert_eq!(counts.invalid, 1);
    crate::support::gpu::assert_silent(&device);
}

#[test]
fn updates_that_cannot_be_made_are_refused_and_change_nothing() {
    let Some(device) = crate::support::gpu::device(DeviceLimits::default()) else { return };
    let surfels = sphere(500);
    let scene = |change: fn(&mut Surfels)| {
        let mut surfels = surfels.clone();
        change(&mut surfels);
        Scene::upload(&device, &surfels).unwrap()
    };
    let none = Changes::default();
    let (here, up, radius) = ([Vec3::ZERO; 2], [Vec3::Y; 2], [0.1f32; 2]);
    let linear = Colours::Linear(vec![[0.0; 3]; 2]);
    let plain = scene(|_| {});
    refused(
        plain.update(499, &Changes { positions: Some(&here), ..none }),
        "surfels 499..501 cannot be updated",
    );
    refused(plain.update(u64::MAX, &Changes { positions: Some(&here), ..none }), "room for 500");
    refused(
        plain.update(0, &Changes { positions: Some(&here), radii: Some(&radius[..1]), ..none }),
        "unequal",
    );
    refused(plain.update(0, &Changes { colours: Some(&linear), ..none }), "Srgb8");
    refused(plain.update(0, &Changes { ellipses: Some(&[]), ..none }), "circles");
    refused(plain.update(0, &Changes { curvatures: Some(&[]), ..none }), "curvatures need normals");
    refused(plain.update(0, &Changes { two_sided: Some(&[true]), ..none }), "two_sided needs radii");
    let sides = scene(|s| s.two_sided = Some(vec![true; 500]));
    refused(sides.update(0, &Changes { radii: Some(&radius), ..none }), "two_sided");
    let clipped = scene(|s| {
        s.clips =
            Clips::collect(vec![
                Some(Clip { lines: [surfel::geometry::ClipLine::NONE; 2], concave: false });
                500
            ])
    });
    refused(clipped.update(0, &Changes { normals: Some(&up), ..none }), "clip lines");
    refused(clipped.set_count(3), "clip lines");
    let weighted = scene(|s| s.weights = Some(Weights::collect(vec![(1.0, Some([1.0; 4])); 500])));
    refused(weighted.update(0, &Changes { normals: Some(&up), ..none }), "corner weights");
    let spoiled = scene(|s| {
        s.weights = Some(Weights::collect(vec![(1.0, None); 500]));
        s.radii[3] = f32::NAN;
    });
    refused(spoiled.update(0, &Changes { radii: Some(&radius), ..none }), "Surfels::valid");
    let untouched = alone(&device, &plain, "pull-push", Rasterizer::Compute);
    assert!(untouched == alone(&device, &scene(|_| {}), "pull-push", Rasterizer::Compute));
    assert!(plain.update(3, &none).is_ok());
    crate::support::gpu::assert_silent(&device);
}

#[test]
fn a_scene_that_is_uploaded_piece_by_piece_is_the_same() {
    let Some(host) = open(|all| all) else { return };
    let mut rig = Rig::new(&host, Some(Rasterizer::Draw), DeviceLimits::default());
    let surfels = sphere(3_000);
    let whole = upload(&host, &rig.device, &surfels);
    for most in [1, 4_096, 50_000, u64::MAX] {
        // Four bytes at a time are slow.
        let surfels = if most == 1 { sphere(30) } else { surfels.clone() };
        let mut upload = embed::Upload::new(&rig.device, &surfels).unwrap();
        let all = upload.left();
        let mut pieces = 0;
        while upload.left() > 0 {
            let before = upload.left();
            upload = *upload.finish().err().expect("something is left");
            // SAFETY: recorded outside a render pass, and waited for.
            let staging = host.run(|cmd| Ok(unsafe { upload.record(cmd, most) })).unwrap().unwrap();
            assert_eq!(staging.bytes(), before - upload.left());
            assert!(staging.bytes() <= most.max(4));
            pieces += 1;
        }
        assert_eq!(pieces, all.div_ceil(most.max(4).min(all)));
        let scene = upload.finish().ok().expect("nothing is left");
        let settings = settings(Method::ALL[0]);
        if most > 1 {
            let [expected, shown] =
                [&whole, &std::sync::Arc::new(scene)].map(|scene| rig.render(&host, scene, &settings));
            assert!(expected == shown, "{most} bytes at a time");
        }
    }
    drop(whole);
    rig.destroy(&host);
    assert_silent(&host);
}
