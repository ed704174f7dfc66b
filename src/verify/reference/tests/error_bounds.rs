//! Splats at a threshold.

use super::*;

#[test]
fn a_splat_on_the_limit_of_epsilon_may_blend_or_not() {
    // 2 (1 + 0.5 · 0.5 / 2) = 2.25, exactly.
    let mut discs = [2.0, 2.25].map(|z| disc(DVec3::Z * z, DVec3::NEG_Z, 0.5));
    (discs[0].colour, discs[1].colour) = (Some(DVec3::X), Some(DVec3::Y));
    let surfels = scene(&discs);
    let settings = |epsilon| Settings { epsilon, ..plain() };
    let tolerance = Tolerance::default();
    let expected = Expected::new(&surfels, &perspective(), SIZE, &settings(0.5), &tolerance).unwrap();
    assert!(expected.bounds.ambiguous_pixels().len() > 0);
    let passes = |surfels: &Surfels, epsilon| {
        let frame = render(surfels, &perspective(), SIZE, &settings(epsilon), &()).unwrap();
        expected.compare(&frame.to_picture()).unwrap().passed()
    };
    assert!([0.4, 0.5, 0.6].into_iter().all(|epsilon| passes(&surfels, epsilon)));
    discs[1].colour = Some(DVec3::Z);
    assert!(!passes(&scene(&discs), 0.6));
}

#[test]
fn a_pixel_on_the_cut_off_may_be_there_or_not() {
    // A cut-off radius of 5 px about a pixel centre, for visibility.
    let settings = plain();
    let sigma = (25.0 / 4.0 - f64::from(settings.least_lowpass())).sqrt();
    let (z, at) = (2.0, 0.5 / 64.0 * 2.0);
    let surfels = scene(&[disc(DVec3::new(at, at, z), DVec3::NEG_Z, sigma * 2.0 * z / 64.0)]);
    let expected = Expected::new(&surfels, &perspective(), SIZE, &settings, &Tolerance::default()).unwrap();
    let pixels: Vec<usize> = expected.bounds.ambiguous_pixels().collect();
    let offsets = [
        (0, -5),
        (-3, -4),
        (3, -4),
        (-4, -3),
        (4, -3),
        (-5, 0),
        (5, 0),
        (-4, 3),
        (4, 3),
        (-3, 4),
        (3, 4),
        (0, 5),
    ];
    let on_the_circle = offsets.map(|(x, y): (i32, i32)| ((32 + y) * 64 + 32 + x) as usize);
    assert_eq!(pixels, on_the_circle);

    let flipped = |pixel: usize| {
        let mut picture = expected.frame.to_picture();
        let (from, to) = if expected.frame.covered[pixel] { (0, pixel) } else { (32 * 64 + 32, pixel) };
        picture.colour[to] = picture.colour[from];
        picture.depth.iter_mut().for_each(|d| d[to] = d[from]);
        picture.normal.iter_mut().for_each(|n| n[to] = n[from]);
        expected.compare(&picture).unwrap().failed
    };
    assert!(pixels.iter().all(|&p| flipped(p) == 0));
    assert_eq!([32 * 64 + 28, 32 * 64 + 38].map(flipped), [1, 1]);
}

/// Turning a far centre by 2⁻²⁴ moves the near end of a long ellipse, and so the weights.
#[test]
fn rounding_of_a_long_axis_is_forgiven_only_where_rounding_is() {
    let surfels = |major: DVec3| {
        let mut discs = [
            disc(DVec3::Z * 2.0, DVec3::NEG_Z, 4.0),
            Surfel { major, aspect: 2e-5, ..disc(DVec3::new(7e4, 0.0, 2.0), DVec3::NEG_Z, 1e5) },
        ];
        (discs[0].colour, discs[1].colour) = (Some(DVec3::X), Some(DVec3::Y));
        scene(&discs)
    };
    let picture = |surfels: &Surfels| render(surfels, &parallel(), SIZE, &plain(), &()).unwrap().to_picture();
    let failed = |tolerance: Tolerance| {
        let expected = Expected::new(&surfels(DVec3::X), &parallel(), SIZE, &plain(), &tolerance).unwrap();
        expected.compare(&picture(&surfels(DVec3::new(1.0, 2f64.powi(-24), 0.0)))).unwrap().failed
    };
    assert!(failed(Tolerance::default()) > 1000);
    assert_eq!(failed(Tolerance::float32()), 0);
}

#[test]
fn a_splat_that_ends_at_a_pixel_centre_may_colour_it_or_not() {
    // A cut-off radius of 5 px about a pixel centre, for the attributes, on a ground that covers the picture.
    let sigma = (25.0 / 4.0 - f64::from(plain().attribute_lowpass())).sqrt();
    let (z, at) = (2.0, 0.5 / 64.0 * 2.0);
    let surfels = |scale: f64| {
        let mut discs = [
            disc(DVec3::Z * z, DVec3::NEG_Z, 4.0),
            disc(DVec3::new(at, at, z), DVec3::NEG_Z, scale * sigma * 2.0 * z / 64.0),
        ];
        (discs[0].colour, discs[1].colour) = (Some(DVec3::X), Some(DVec3::Y));
        scene(&discs)
    };
    let tolerance = Tolerance::default();
    let expected = Expected::new(&surfels(1.0), &perspective(), SIZE, &plain(), &tolerance).unwrap();
    assert_eq!(expected.bounds.ambiguous_pixels().len(), 12);
    let failed = |scale: f64| {
        let frame = render(&surfels(scale), &perspective(), SIZE, &plain(), &()).unwrap();
        expected.compare(&frame.to_picture()).unwrap().failed
    };
    assert_eq!([1.0 - 1e-5, 1.0 + 1e-5].map(failed), [0, 0]);
    assert!([0.99, 1.01].into_iter().all(|scale| failed(scale) > 12));
}
