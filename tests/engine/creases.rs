//! Clip lines that are found at creases, against those of scenes whose edges are known.

use glam::Vec3;
use surfel::estimate::Estimate;
use surfel::geometry::{Clip, ClipLine, Cloud, Surfels};
use surfel::verify::scenes;

/// Creases are where normals turn by more than this, degrees.
const ANGLE: f32 = 40.0;

/// What `surfels` are with their creases clipped, instead of what they are clipped by.
fn sharp(surfels: &Surfels) -> Surfels {
    sharpen(Cloud::from(Surfels { clips: None, ..surfels.clone() }))
}

fn sharpen(cloud: Cloud) -> Surfels {
    let how = Estimate { sharp: Some(ANGLE.to_radians()), ..Default::default() };
    let given = cloud.clips.as_ref().map_or(0, |clips| clips.clips.len() as u64);
    let (surfels, estimated) = cloud.into_surfels(&how, &()).unwrap();
    let clipped = surfels.clips.as_ref().map_or(0, |clips| clips.clips.len() as u64);
    assert_eq!(estimated.clipped, clipped - given);
    assert_eq!(surfels.count_invalid(), 0);
    surfels
}

fn clip(surfels: &Surfels, index: usize) -> Option<&Clip> {
    surfels.clips.as_ref()?.get(index)
}

fn lines(clip: Option<&Clip>) -> impl Iterator<Item = &ClipLine> {
    clip.into_iter().flat_map(|clip| &clip.lines).filter(|line| line.is_some())
}

/// How far a line runs from another inside the surfel's disc.
fn apart(surfels: &Surfels, index: usize, found: &ClipLine, truth: &ClipLine) -> f64 {
    let [normal, outward] = [surfels.normals[index], truth.outward].map(|v| v.as_dvec3());
    let (radius, offset) = (f64::from(surfels.radii[index]), f64::from(truth.offset));
    let half = (radius * radius - offset * offset).max(0.0).sqrt();
    let end = |sign: f64| {
        let at = offset * outward + sign * half * normal.cross(outward);
        (found.outward.as_dvec3().dot(at) - f64::from(found.offset)).abs()
    };
    end(1.0).max(end(-1.0))
}

/// What was found of lines that are known.
#[derive(Debug, Default)]
struct Found {
    /// Lines that are there, those of them that were found, and corners of two of them that were found as what they are.
    lines: f64,
    found: f64,
    corners: f64,
    corners_found: f64,
    /// Lines that were found and are not there.
    wrong: f64,
    /// By how much the lines that were found are off at most, in radii.
    off: f64,
}

/// Compares clips with the true ones; a line is found if it is within `most` of the surfel's radii.
fn compare(found: &Surfels, truth: &Surfels, most: impl Fn(usize) -> f64) -> Found {
    let mut sum = Found::default();
    for index in 0..truth.len() {
        let (ours, theirs) = (clip(found, index), clip(truth, index));
        let off = |line: &ClipLine| {
            let each =
                lines(ours).map(|ours| apart(truth, index, ours, line) / f64::from(truth.radii[index]));
            each.fold(f64::INFINITY, f64::min)
        };
        let is_there = |ours: &ClipLine| {
            lines(theirs)
                .any(|line| apart(truth, index, ours, line) <= most(index) * f64::from(truth.radii[index]))
        };
        let offs: Vec<f64> = lines(theirs).map(off).collect();
        let near: Vec<f64> = offs.iter().copied().filter(|off| *off <= most(index)).collect();
        sum.lines += offs.len() as f64;
        sum.found += near.len() as f64;
        sum.wrong += lines(ours).filter(|ours| !is_there(ours)).count() as f64;
        sum.off = near.iter().copied().fold(sum.off, f64::max);
        if offs.len() == 2 {
            sum.corners += 1.0;
            let same = ours.zip(theirs).is_some_and(|(ours, theirs)| ours.concave == theirs.concave);
            sum.corners_found += f64::from(u8::from(same && near.len() == 2));
        }
    }
    println!("{sum:?}");
    sum
}

/// Where normals are exact, lines are off by rounding: of coordinates up to 1, three of each of two points, by 2⁻²⁴, over the radius of the
/// smallest disc, 0.02.
const ROUNDING: f64 = 6.0 * 6e-8 / 0.02;

/// A block with twelve convex edges; spacing 0.028.
const BLOCK: &str = "scene:slabs?slabs=1&thickness=1&points=20000";

#[test]
fn the_edges_of_a_block_are_found_and_nothing_else() {
    for sampler in ["jittered", "blue-noise", "grid"] {
        let truth = scenes::open(&format!("{BLOCK}&sampler={sampler}")).unwrap();
        let found = compare(&sharp(&truth), &truth, |_| ROUNDING);
        assert!(found.lines > 1000.0 && found.found >= 0.95 * found.lines, "{sampler}: {found:?}");
        assert!(found.corners_found >= 0.95 * found.corners, "{sampler}: {found:?}");
        assert_eq!(found.wrong, 0.0, "{sampler}");
    }
}

/// Concave edges, corners of a face that are concave, and the bore, whose wall bends away from the plane of its samples, up to two radii
/// away, by (2r)²/2R.
#[test]
fn the_edges_of_a_part_are_found() {
    let truth = scenes::open("scene:part?points=60000").unwrap();
    let (axis, bore) = (glam::Vec2::new(0.4, -0.2), 0.25);
    let most = |index: usize| {
        let reach = truth.positions[index].truncate().distance(axis) - truth.radii[index];
        if reach < bore { f64::from(2.0 * truth.radii[index] / bore) } else { ROUNDING }
    };
    let found = compare(&sharp(&truth), &truth, most);
    assert!(found.lines > 5000.0 && found.found >= 0.95 * found.lines, "{found:?}");
    assert!(found.corners > 100.0 && found.corners_found >= 0.9 * found.corners, "{found:?}");
    assert!(found.wrong <= 0.001 * found.lines, "{found:?}");
}

/// Noise of a tenth of the spacing is one of 0.067 radii. Lines are off by three times that at most; discs that miss an edge by no more may
/// be clipped.
#[test]
fn noise_moves_lines_no_further_than_points() {
    let truth = scenes::open(&format!("{BLOCK}&noise=0.1")).unwrap();
    let found = compare(&sharp(&truth), &truth, |_| 0.2);
    assert!(found.found >= 0.95 * found.lines && found.wrong <= 0.05 * found.lines, "{found:?}");
}

#[test]
fn normals_need_no_known_side() {
    let truth = scenes::open(BLOCK).unwrap();
    let mut either = truth.clone();
    for (i, normal) in either.normals.iter_mut().enumerate() {
        *normal = if i % 3 == 0 { -*normal } else { *normal };
    }
    either.two_sided = Some(vec![true; either.len()]);
    let found = compare(&sharp(&either), &truth, |_| ROUNDING);
    assert!(found.found >= 0.95 * found.lines && found.wrong <= 0.01 * found.lines, "{found:?}");
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn smooth_surfaces_are_left_alone() {
    for name in ["sphere?points=1000", "torus?points=2000", "torus?points=50000", "relief?points=20000"] {
        let surfels = scenes::open(&format!("scene:{name}")).unwrap();
        assert_eq!(sharp(&surfels).clips, None, "{name}");
        let bare = Cloud { positions: surfels.positions, ..Default::default() };
        assert_eq!(sharpen(bare).clips, None, "{name}, estimated normals");
    }
    // The bumpy sphere has tips at its poles, around which its normals turn as fast as the disc is near.
    let bumpy = sharp(&scenes::open("scene:bumpy-sphere?points=100000").unwrap());
    let tips = |p: &Vec3| p.x.hypot(p.z) < 0.2;
    let clipped = |i: &usize| clip(&bumpy, *i).is_some();
    let smooth = (0..bumpy.len()).filter(clipped).filter(|&i| !tips(&bumpy.positions[i])).count();
    assert_eq!(smooth, 0);
}

#[test]
fn clips_that_are_there_stay_and_flatter_edges_are_none() {
    let truth = scenes::open(BLOCK).unwrap();
    let kept = sharpen(truth.clone().into());
    assert_eq!(kept.clips, truth.clips);
    let how = |sharp| Estimate { sharp: Some(sharp), ..Default::default() };
    let open = || Cloud::from(Surfels { clips: None, ..truth.clone() });
    let (flat, estimated) = open().into_surfels(&how(100f32.to_radians()), &()).unwrap();
    assert_eq!((flat.clips, estimated.clipped), (None, 0));
    for wrong in [0.0, -1.0, 3.2, f32::NAN] {
        let cause = open().into_surfels(&how(wrong), &()).unwrap_err().to_string();
        assert!(cause.contains("give one between 0 and a half turn"), "{cause}");
    }
}
