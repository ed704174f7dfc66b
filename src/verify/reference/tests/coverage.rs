//! α as the covered fraction of a pixel.

use super::*;

fn coverage() -> Settings {
    Settings { alpha: Alpha::Coverage, edges: Edges::Nearest, ..plain() }
}

/// α of the discs in parallel projection, 16 px per unit.
fn alphas(discs: &[Surfel], settings: &Settings) -> Vec<f64> {
    let frame = render(&scene(discs), &parallel(), SIZE, settings, &()).unwrap();
    frame.colour.iter().map(|colour| colour[3]).collect()
}

/// World position of a point of the picture, px.
fn at(x: f64, y: f64) -> DVec3 {
    DVec3::new((x - 32.0) / 16.0, (y - 32.0) / 16.0, 2.0)
}

#[test]
fn coverage_is_the_area_of_the_discs_within_what_leaves_no_holes() {
    let (radius, centre) = (20.0, [31.3, 32.2]);
    let alphas = alphas(&[disc(at(centre[0], centre[1]), DVec3::NEG_Z, radius / 16.0)], &coverage());
    // The exact fraction, by 64 × 64 points per pixel.
    let exact = |i: usize| {
        let inside = |k: usize| {
            let [x, y] = [k % 64, k / 64].map(|k| (k as f64 + 0.5) / 64.0);
            (((i % 64) as f64 + x - centre[0]).hypot((i / 64) as f64 + y - centre[1]) <= 0.77 * radius) as u32
        };
        f64::from((0..64 * 64).map(inside).sum::<u32>()) / 4096.0
    };
    let errors: Vec<f64> = alphas.iter().enumerate().map(|(i, alpha)| alpha - exact(i)).collect();
    let boundary = (0..64 * 64).filter(|&i| exact(i) > 0.0 && exact(i) < 1.0).count() as f64;
    // 16 points with one in each row and column measure the area under a line to about 1/16.
    let mean: f64 = errors.iter().map(|e| e.abs()).sum::<f64>() / boundary;
    assert!(mean < 1.0 / 16.0 && errors.iter().all(|e| e.abs() < 2.5 / 16.0), "{mean} {errors:?}");
    assert!((errors.iter().sum::<f64>() / boundary).abs() < 0.02);
}

/// A convex surface has turned away below a quarter of its radius of curvature times the cosine of the angle at which it is seen.
#[test]
fn a_disc_of_a_convex_surface_ends_where_the_surface_turns_away() {
    let (radius, tilt) = (20.0, 60f64.to_radians());
    let normal = DVec3::new(tilt.sin(), 0.0, -tilt.cos());
    // Covered px of a row beyond the centre, where the disc recedes, and before it: means of the rows around the centre.
    let sides = |bend: f64| {
        let operator = DMat2::from_diagonal(DVec2::splat(16.0 * bend / radius));
        let curvatures = Some(vec![Curvature::of_shape_operator(operator)]);
        let surfels = Surfels { curvatures, ..scene(&[disc(at(32.0, 32.0), normal, radius / 16.0)]) };
        let colour = render(&surfels, &parallel(), SIZE, &coverage(), &()).unwrap().colour;
        let rows = |side: usize| {
            let row =
                |y: usize| colour[64 * y + 32 * side..][..32].iter().map(|colour| colour[3]).sum::<f64>();
            (24..40).map(row).sum::<f64>() / 16.0
        };
        [rows(1), rows(0)]
    };
    let [flat, concave] = [sides(0.0), sides(-0.3)];
    assert_eq!(flat, concave);
    assert!((flat[0] / flat[1] - 1.0).abs() < 0.02, "{flat:?}");
    for bend in [0.3, 0.4] {
        let [beyond, before] = sides(bend);
        let depth = 0.25 * tilt.cos() * radius / bend;
        assert!((beyond - depth / tilt.tan()).abs() < 0.1, "{bend}: {beyond} {}", depth / tilt.tan());
        assert_eq!(before, flat[1]);
    }
}

#[test]
fn neighbours_cover_together_and_hidden_ones_too() {
    let pair = [at(25.5, 31.5), at(37.5, 31.5)].map(|at| disc(at, DVec3::NEG_Z, 6.3 / 0.77 / 16.0));
    let behind = disc(at(31.5, 31.5) + DVec3::Z, DVec3::NEG_Z, 16.0 / 16.0);
    let middle = |discs: &[Surfel]| alphas(discs, &coverage())[31 * 64 + 31];
    let alone = middle(&pair[..1]);
    assert!(alone > 0.0 && alone < 1.0 && middle(&pair) == 1.0, "{alone}");
    let at_the_edge = alphas(&pair, &coverage())[28 * 64 + 31];
    let filled = alphas(&[pair[0], pair[1], behind], &coverage())[28 * 64 + 31];
    assert!(at_the_edge > 0.0 && at_the_edge < 1.0 && filled == 1.0, "{at_the_edge} {filled}");
}

#[test]
fn the_smallest_splat_shows() {
    for (x, y) in [(20.1, 20.4), (20.5, 20.5), (20.99, 20.01)] {
        let tiny = disc(at(x, y), DVec3::NEG_Z, 1e-4);
        let alphas = alphas(&[tiny], &coverage());
        let seen: Vec<_> = (0..64 * 64).filter(|&i| alphas[i] > 0.0).collect();
        assert_eq!(seen, [20 * 64 + 20]);
        assert_eq!(alphas[seen[0]], 1.0 / 16.0);
    }
}

#[test]
fn what_is_partly_covered_is_blended_with_the_background() {
    let mut half = disc(at(31.0, 32.5), DVec3::NEG_Z, 0.5);
    half.colour = Some(DVec3::new(0.2, 0.4, 0.8));
    let background = Some([0.5, 0.25, 1.0]);
    let with = |settings: Settings| render(&scene(&[half]), &parallel(), SIZE, &settings, &()).unwrap();
    let (clear, filled) = (with(coverage()), with(Settings { background, ..coverage() }));
    let number = Settings { shading: Shading::Depth, background, ..coverage() };
    let depths = with(number);
    let mut partial = 0;
    for (i, [r, _, b, alpha]) in clear.colour.iter().copied().enumerate() {
        let expected = [alpha * r + (1.0 - alpha) * 0.5, alpha * b + 1.0 - alpha];
        let [r, _, b, opaque] = filled.colour[i];
        assert!((r - expected[0]).abs() < 1e-12 && (b - expected[1]).abs() < 1e-12 && opaque == 1.0);
        // Quantities are not blended: α is a mask.
        let number = if depths.covered[i] { 2.0 } else { 0.5 };
        assert!((depths.colour[i][0] - number).abs() < 1e-6 && depths.colour[i][3] == 1.0);
        assert_eq!(clear.covered[i], alpha > 0.0);
        partial += usize::from(alpha > 0.0 && alpha < 1.0);
    }
    assert!(partial > 10, "{partial}");
}

#[test]
fn a_sample_on_the_limit_may_be_covered_or_not() {
    // The outline runs through sample (−13/32, 11/32) of the pixel left of the centre's by 10.
    let (x, y) = (10.0 + 13.0 / 32.0, 11.0 / 32.0);
    let radius = f64::hypot(x, y) / 0.77;
    let surfels = |scale: f64| scene(&[disc(at(32.5, 32.5), DVec3::NEG_Z, scale * radius / 16.0)]);
    let settings = coverage();
    let expected = Expected::new(&surfels(1.0), &parallel(), SIZE, &settings, &Tolerance::default()).unwrap();
    assert!(expected.bounds.ambiguous_pixels().any(|pixel| pixel == 32 * 64 + 22));
    let failed = |scale: f64| {
        let frame = render(&surfels(scale), &parallel(), SIZE, &settings, &()).unwrap();
        expected.compare(&frame.to_picture()).unwrap().failed
    };
    assert_eq!([1.0 - 2e-6, 1.0 + 2e-6].map(failed), [0, 0]);
    assert!([0.98, 1.02].into_iter().all(|scale| failed(scale) > 10));
    // Only that sample may change.
    let mut picture = expected.frame.to_picture();
    let alpha = picture.colour[32 * 64 + 22][3];
    let judged = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|by: f32| {
        picture.colour[32 * 64 + 22][3] = alpha + by / 16.0;
        expected.compare(&picture).unwrap().passed()
    });
    assert_eq!(judged.iter().filter(|passed| **passed).count(), 2, "{judged:?}");
}

/// A disc of 300 px in the middle, cut by a line at `offset` px from the centre; with or without the other half.
fn cut(angle: f64, offset: f64, other: bool) -> Surfels {
    let outward = DVec3::new(angle.cos(), angle.sin(), 0.0);
    let half = |sign: f64, colour| {
        let line = ClipLine { outward: (sign * outward).as_vec3(), offset: (sign * offset / 16.0) as f32 };
        Surfel {
            colour: Some(colour),
            clip: Some(Clip::line(line)),
            ..disc(at(32.0, 32.0), DVec3::NEG_Z, 300.0 / 16.0)
        }
    };
    let halves = [half(1.0, DVec3::X), half(-1.0, DVec3::Y)];
    let halves = if other { &halves[..] } else { &halves[..1] };
    Surfels { clips: Clips::collect(halves.iter().map(|half| half.clip)), ..scene(halves) }
}

#[test]
fn a_clip_line_parts_the_pixels_that_it_cuts() {
    let [frame, mask] = [coverage(), plain()]
        .map(|settings| render(&cut(0.4, 3.3, false), &parallel(), SIZE, &settings, &()).unwrap());
    let kept = |x: f64, y: f64| (x - 32.0) * 0.4f64.cos() + (y - 32.0) * 0.4f64.sin() <= 3.3;
    let (mut beyond, mut sum, mut cut) = (0, 0.0, 0.0);
    for (i, [red, green, _, alpha]) in frame.colour.iter().copied().enumerate() {
        let (x, y) = ((i % 64) as f64, (i / 64) as f64);
        let inside = |k: &usize| kept(x + ((k % 64) as f64 + 0.5) / 64.0, y + ((k / 64) as f64 + 0.5) / 64.0);
        let exact = (0..64 * 64).filter(inside).count() as f64 / 4096.0;
        assert!((alpha - exact).abs() < 2.5 / 16.0, "({x}, {y}): {alpha} for {exact}");
        (sum, cut) = (sum + alpha - exact, cut + f64::from(u8::from(exact > 0.0 && exact < 1.0)));
        assert_eq!([red, green], if alpha > 0.0 { [1.0, 0.0] } else { [0.0; 2] });
        beyond += usize::from(alpha > 0.0 && !mask.covered[i]);
        assert!(frame.covered[i] || !mask.covered[i]);
    }
    assert!(beyond > 20 && (sum / cut).abs() < 0.02, "{beyond} {sum} {cut}");
}

#[test]
fn both_sides_of_an_edge_cover_together_and_stay_apart() {
    for (angle, offset) in [(0.4, 3.3), (0.0, 0.5), (0.0, 1.0 / 32.0), (1.3, -7.0)] {
        let surfels = cut(angle, offset, true);
        let [frame, mask] = [coverage(), plain()]
            .map(|settings| render(&surfels, &parallel(), SIZE, &settings, &()).unwrap());
        assert_eq!((&frame.colour, &frame.depth), (&mask.colour, &mask.depth), "{angle} {offset}");
        assert!(frame.colour.iter().all(|colour| colour[3] == 1.0));
    }
}

#[test]
fn a_pixel_centre_on_a_clip_line_is_within_it_or_beyond() {
    // A line through the centres of column 40.
    let surfels = |offset: f64| cut(0.0, offset, true);
    let settings = Settings { background: Some([0.0; 3]), ..coverage() };
    let tolerance = Tolerance::default();
    let expected = Expected::new(&surfels(8.5), &parallel(), SIZE, &settings, &tolerance).unwrap();
    let failed = |offset: f64| {
        let frame = render(&surfels(offset), &parallel(), SIZE, &settings, &()).unwrap();
        expected.compare(&frame.to_picture()).unwrap().failed
    };
    assert_eq!([8.5 - 2e-4, 8.5 + 2e-4].map(failed), [0, 0]);
    assert_eq!([8.5 - 1.1, 8.5 + 1.1].map(failed), [64, 64]);
    // Either half or both: no pixel is empty, and none blends one disc beyond its line with the other within.
    let mut picture = expected.frame.to_picture();
    picture.colour[40] = [0.25, 0.75, 0.0, 1.0];
    assert_eq!(expected.compare(&picture).unwrap().failed, 1);
}
