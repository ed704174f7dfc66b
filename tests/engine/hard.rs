//! The hard cases: float32 against float64 where numbers get difficult, and what holds one against the other.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::sampling::push;
use crate::support::settings::splats_alone;
use glam::DVec3;
use surfel::Picture;
use surfel::bench::hard::{Options, compare, names, run};
use surfel::bench::record::{Faults, Sweep, SweepPoint};
use surfel::geometry::{Camera, Surfels};
use surfel::settings::methods::Method;
use surfel::verify::reference::{Admissible, Expected, Tolerance};
use surfel::vk::DeviceLimits;

/// Whether a case is of angles, where other methods are held to more values than elsewhere; of perspective alone in the short run.
fn is_of_angles(name: &str) -> bool {
    if_whole(name.starts_with("grazing"), name == "grazing")
}

/// Prints a line per point.
fn print(sweep: &Sweep) {
    println!("\n{}: {}", sweep.name, sweep.description);
    println!(
        "{:<50} {:>8} {:>7} {:>7} {:>8} {:>8} {:>8}",
        sweep.parameter, "object", "ambig.", "failed", "colour", "normal", "depth"
    );
    for point in &sweep.points {
        let a = point.float64_error;
        let of = format!("{:.6} {}", point.value, point.implementation.label());
        print!("{of:<50} {:>8} {:>7} {:>7}", a.object_pixels, a.ambiguous_pixels, a.failed_pixels);
        println!(" {:>8.1e} {:>8.1e} {:>8.1e}  {}", a.colour, a.normal, a.depth, point.note);
    }
}

/// Prints the sweep's line of a method's table; that of the first method is in the guide, Accuracy. It has the largest errors where
/// float32 suffices, then those beyond float32.
fn summarize(sweep: &Sweep, method: &Method) {
    let own = || sweep.points.iter().filter(|point| point.implementation.method == method.name);
    let largest = |beyond_float32: bool| {
        let points = || own().filter(move |point| point.is_beyond_float32() == beyond_float32);
        let worst = |of: fn(&SweepPoint) -> f64| points().map(of).fold(0.0, f64::max);
        let errors = [
            worst(|point| point.float64_error.colour),
            worst(|point| point.float64_error.normal),
            worst(|point| point.float64_error.depth),
        ];
        (points().count(), errors.map(|error| format!("{error:.1e}")))
    };
    let values = || own().map(|point| point.value);
    let (from, to) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let short = |value: f64| {
        if (0.1..1e4).contains(&value.abs()) { format!("{value:.0}") } else { format!("{value:.0e}") }
    };
    let range = format!("{} to {}", short(from), short(to));
    let beyond = match largest(true) {
        (0, _) => String::new(),
        (count, errors) => format!("{count} of {}: {}", own().count(), errors.join(", ")),
    };
    println!(
        "| `{}` | {}: {range} | {} | {beyond} |",
        sweep.name,
        sweep.parameter,
        largest(false).1.join(" | ")
    );
}

fn check(sweep: &Sweep, point: &SweepPoint) {
    let at = format!("{} at {}: {point:?}", sweep.name, point.value);
    let (bars, a) = (Tolerance::default(), point.float64_error);
    assert_eq!(point.refused, None, "{at}");
    assert!([a.colour, a.normal, a.depth, point.value].into_iter().all(f64::is_finite), "{at}");
    assert!(point.faults.is_none() && a.object_pixels > 0, "{at}");
    assert!(a.failed_pixels == 0 || point.is_beyond_float32(), "{at}");
    // A limit of float32 is noted only where some method fails at that value.
    let float32_limit = |point: &SweepPoint| point.note.split("; ").next().map(str::to_owned);
    let same =
        |other: &&SweepPoint| other.value == point.value && float32_limit(other) == float32_limit(point);
    let fails = sweep.points.iter().filter(same).any(|other| other.float64_error.failed_pixels > 0);
    let by_all = sweep.points.iter().any(|point| point.implementation.method != Method::SPLATTING[0].name);
    assert!(fails || !point.is_beyond_float32() || !by_all, "{at}");
    let within = a.colour <= bars.colour && a.normal <= bars.normal && a.depth <= bars.depth_relative;
    assert!(within || point.is_beyond_float32(), "{at}");
    let unusable = ["NaN", "infinity", "3e38"].iter().any(|value| point.note.contains(value));
    assert_eq!(unusable && sweep.name == "attributes", point.note.contains("50 invalid") && unusable, "{at}");
}

#[test]
fn every_case_agrees_or_says_why_not() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    // Angles are where footprints differ: there other methods are held to more values than elsewhere, or to some at all.
    let (angles, rest): (Vec<_>, Vec<_>) =
        names().into_iter().map(str::to_owned).partition(|name| is_of_angles(name));
    // Attributes are a list, of which the ends say nothing of the middle: all of it, or a value of each attribute.
    let (listed, rest): (Vec<_>, Vec<_>) = rest.into_iter().partition(|name| name == "attributes");
    // The short run has half of the others, with the only one of 16-bit sums.
    let is_taken = |i: usize, name: &str| if_whole(true, i.is_multiple_of(2) || name == "accumulator");
    let rest = rest.into_iter().enumerate().filter(|(i, name)| is_taken(*i, name));
    let rest: Vec<_> = rest.map(|(_, name)| name).collect();
    let count = angles.len() + rest.len() + listed.len();
    let few = if_whole(usize::MAX, 2);
    let sweeps = [
        (angles, few, if_whole(5, 2)),
        (rest, few, if_whole(2, 0)),
        (listed, if_whole(usize::MAX, 6), if_whole(2, 0)),
    ];
    let sweeps = sweeps.map(|(only, values, others)| {
        let options = Options { only, others, values, until: None };
        run(&device, &options, &()).unwrap()
    });
    let sweeps = sweeps.concat();
    sweeps.iter().for_each(print);
    for method in &Method::SPLATTING {
        println!("\n{}\n| case | parameter | colour | normal | depth | beyond float32 |", method.name);
        println!("|---|---|---|---|---|---|");
        sweeps.iter().for_each(|sweep| summarize(sweep, method));
    }
    for sweep in &sweeps {
        sweep.points.iter().for_each(|point| check(sweep, point));
        for method in Method::SPLATTING {
            let [values, others] = ["draw", "compute"].map(|variant| {
                let own = |point: &&SweepPoint| point.implementation.method == method.name;
                let by =
                    sweep.points.iter().filter(own).filter(|point| point.implementation.variant == variant);
                by.map(|point| point.value).collect::<Vec<_>>()
            });
            let of_others = if is_of_angles(&sweep.name) { 2 } else { if_whole(2, 0) };
            let least = if method == Method::SPLATTING[0] { if_whole(7, 2) } else { of_others };
            let ascending = values.is_sorted_by(|a, b| a < b);
            assert!(values.len() >= least && ascending, "{} {}: {values:?}", sweep.name, method.name);
            assert_eq!(values, others, "{} {}", sweep.name, method.name);
        }
    }
    assert_eq!((sweeps.len(), names().len()), (count, 18));
    let halves =
        |sweep: &Sweep| sweep.points.iter().any(|point| point.implementation.variant.contains("16-bit"));
    assert!(sweeps.iter().all(|sweep| halves(sweep) == (sweep.name == "accumulator")));
    assert_silent(&device);
}

#[test]
fn refusals_of_a_device_are_reported() {
    let limits = DeviceLimits { blend_float32: Some(false), max_image_side: Some(300), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let unknown = Options { only: vec!["sizes".into()], ..Default::default() };
    assert!(run(&device, &unknown, &()).unwrap_err().to_string().contains("sizes: give one of grazing, "));
    // Reasons are those of the first method.
    let others = if_whole(2, 0);
    let options = Options { values: 2, others, only: vec!["accumulator".into(), "size".into()], until: None };
    let sweeps = run(&device, &options, &()).unwrap();
    let [accumulator, size] = &sweeps[..] else { panic!("{} sweeps", sweeps.len()) };
    let reasons = |sweep: &Sweep| {
        let first =
            sweep.points.iter().filter(|point| point.implementation.method == Method::SPLATTING[0].name);
        first.map(|point| point.refused.clone()).collect::<Vec<_>>()
    };
    let says =
        |reason: &Option<String>, text: &str| reason.as_ref().is_some_and(|reason| reason.contains(text));
    let found = reasons(accumulator);
    assert!(found[..2].iter().all(|reason| says(reason, "blend")), "{found:?}");
    // By tiles nothing is blended, and half floats can be.
    assert!(found[2..].iter().all(Option::is_none) && found.len() == 6, "{found:?}");
    let found = reasons(size);
    assert!(found.iter().all(|reason| says(reason, "640")) && found.len() == 4, "{found:?}");
}

/// A picture by the reference itself, and what it is held against: a disc of so many pixels, between four of them.
fn disc(radius: f64) -> (Expected, Picture) {
    let mut surfels = Surfels::default();
    push(&mut surfels, DVec3::ZERO, DVec3::Z, radius);
    // A pixel is a unit wide.
    let camera =
        Camera::orthographic([5.0 * DVec3::Z, DVec3::ZERO, DVec3::Y], 64.0, 1.0, [1.0, 10.0]).unwrap();
    let expected =
        Expected::new(&surfels, &camera, [64, 64], &splats_alone(), &Tolerance::default()).unwrap();
    let picture = expected.frame.to_picture();
    (expected, picture)
}

#[test]
fn faults_are_found() {
    let (expected, own) = disc(20.0);
    let found = |tamper: &dyn Fn(&mut Picture)| {
        let mut picture = own.clone();
        tamper(&mut picture);
        compare(&expected, &picture).unwrap()
    };
    let (float64_error, faults) = found(&|_| {});
    assert!(
        faults.is_none() && float64_error.failed_pixels == 0 && float64_error.object_pixels > 1000,
        "{float64_error:?} {faults:?}"
    );

    let sure = |covered: bool| {
        let definite = |i: &usize| matches!(expected.bounds.admissible(*i), Admissible::Definite);
        (0..own.colour.len()).filter(definite).find(|&i| expected.frame.covered[i] == covered).unwrap()
    };
    let (inside, outside) = (sure(true), sure(false));
    let one = |faults: Faults| [faults.non_finite, faults.uncovered, faults.overcovered];
    // Pixels that are no number count as holes too.
    let broken: [&dyn Fn(&mut Picture); 3] =
        [&|p| p.colour[inside][1] = f32::NAN, &|p| p.depth.as_mut().unwrap()[inside] = f32::INFINITY, &|p| {
            p.normal.as_mut().unwrap()[inside][2] = f32::NEG_INFINITY
        }];
    for tamper in broken {
        let (float64_error, faults) = found(tamper);
        assert_eq!((one(faults), float64_error.failed_pixels), ([1, 1, 0], 1));
        assert!(float64_error.colour.is_finite() && float64_error.depth.is_finite(), "{float64_error:?}");
    }
    let (float64_error, faults) = found(&|p| p.colour[outside][3] = f32::NAN);
    assert_eq!((one(faults), float64_error.failed_pixels), ([1, 0, 0], 0));
    let (float64_error, faults) = found(&|p| {
        p.colour[inside] = [0.0; 4];
        p.depth.as_mut().unwrap()[inside] = 0.0;
        p.normal.as_mut().unwrap()[inside] = [0.0; 3];
    });
    assert_eq!((one(faults), float64_error.failed_pixels), ([0, 1, 0], 1));
    let (float64_error, faults) = found(&|p| {
        p.colour[outside] = p.colour[inside];
        p.depth.as_mut().unwrap()[outside] = p.depth.as_ref().unwrap()[inside];
    });
    assert_eq!((one(faults), float64_error.failed_pixels), ([0, 0, 1], 1));
    let (float64_error, faults) = found(&|p| p.colour[inside][0] += 1e-3);
    assert!(
        faults.is_none() && float64_error.failed_pixels == 1 && float64_error.colour > 9e-4,
        "{float64_error:?}"
    );
}

#[test]
fn what_may_be_either_is_no_fault() {
    // What visibility sees is larger than the disc by the least low-pass, and ends at the centres of pixels.
    let lowpass = f64::from(splats_alone().least_lowpass().sqrt() * splats_alone().cutoff);
    let (expected, own) = disc((10.5f64.powi(2) + 5.5f64.powi(2) - lowpass.powi(2)).sqrt());
    let is_open = |i: &usize| match expected.bounds.admissible(*i) {
        Admissible::Values(values) => {
            values.map(|(value, _)| value.covered).any(|c| c != expected.frame.covered[*i])
        }
        _ => false,
    };
    let mut open = (0..own.colour.len()).filter(is_open).peekable();
    assert!(open.peek().is_some(), "no pixel is ambiguous");
    for i in open {
        let mut picture = own.clone();
        let depth = &mut picture.depth.as_mut().unwrap()[i];
        *depth = if *depth == 0.0 { 5.0 } else { 0.0 };
        assert!(compare(&expected, &picture).unwrap().1.is_none());
    }
}
