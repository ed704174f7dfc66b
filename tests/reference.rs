//! The float64 reference judges pictures rightly: it passes its own and lets no small mutation through. Needs no GPU.

mod support;

use glam::DVec3;
use std::time::Instant;
use support::scenes::{Case, Random, cases};
use surfel::geometry::{Camera, Surfels};
use surfel::reference::{Comparison, Expected, Frame, Projector, Surfel, Tolerance, render};
use surfel::{Picture, Settings};

/// Share of the object's pixels that may be in doubt.
const MOST_DOUBT: f64 = 0.02;

struct View<'a> {
    case: &'a Case,
    camera: &'a Camera,
    expected: Expected,
}

impl View<'_> {
    fn judge(&self, picture: &Picture) -> Comparison {
        self.expected.compare(picture).unwrap()
    }

    fn render(&self, surfels: &Surfels, settings: &Settings) -> Comparison {
        self.judge(&render(surfels, self.camera, self.case.size, settings).unwrap().to_picture())
    }
}

#[test]
fn explore() {
    let mut random = Random(99);
    let tol = if std::env::var("STRICT").is_ok() { Tolerance::default() } else { Tolerance::float32() };
    for case in cases() {
        for (i, camera) in case.cameras.iter().enumerate() {
            let start = Instant::now();
            let expected = Expected::new(&case.surfels, camera, case.size, &case.settings, &tol).unwrap();
            let seconds = start.elapsed().as_secs_f64();
            let view = View { case: &case, camera, expected };
            let own = view.judge(&view.expected.frame.to_picture());
            let doubt = own.doubtful as f64 / own.object_pixels as f64;
            let noisy = |amount: f64, random: &mut Random| {
                let mut s = case.surfels.clone();
                let eye = camera.view.inverse().w_axis.truncate();
                for (p, n) in s.positions.iter_mut().zip(&mut s.normals) {
                    let world = s.origin + p.as_dvec3();
                    *p = (p.as_dvec3() + amount * world.distance(eye) * random.vector()).as_vec3();
                    *n = (n.as_dvec3() + amount * random.vector()).as_vec3();
                }
                s
            };
            println!(
                "{} {i}: {:.2}s {:?} dual {} object {:.2} doubt {:.4} unres {} own-failed {} {:?}",
                case.name,
                seconds,
                view.expected.frame.counts,
                view.expected.frame.dual_form,
                own.object_pixels as f64 / own.pixels as f64,
                doubt,
                own.unresolvable,
                own.failed,
                own.worst
            );
            let h = Settings { lowpass: case.settings.lowpass * 1.01, ..case.settings.clone() };
            let e = Settings { epsilon: case.settings.epsilon * 0.5, ..case.settings.clone() };
            let a = view.render(&case.surfels, &h);
            let b = view.render(&case.surfels, &e);
            let n = view.render(&noisy(6e-8, &mut random), &case.settings);
            println!(
                "    H {} eps {} noise {} {:?} {:?}",
                a.failed, b.failed, n.failed, n.worst, n.worst_of_all
            );
            for f in n.failures.iter().take(3) {
                println!("        {f:?}");
                let i = (f.y * case.size[0] + f.x) as usize;
                println!("           {:?}", view.expected.doubt.slack(i));
                if let surfel::reference::Admissible::Values(v) = view.expected.doubt.admissible(i) {
                    for v in v.take(6) {
                        println!("           {v:?}");
                    }
                }
                let pr = Projector::new(camera, case.size, &case.settings).unwrap();
                for k in 0..case.surfels.len() {
                    if let Ok(s) = pr.footprint(&Surfel::of(&case.surfels, k)) {
                        let e = glam::DVec2::new(f.x as f64 + 0.5, f.y as f64 + 0.5) - s.centre;
                        let h = f64::from(case.settings.attribute_lowpass());
                        let m = (e.dot((s.variance + glam::DMat2::IDENTITY * h).inverse() * e)).sqrt();
                        if m < f64::from(case.settings.cutoff) + 1e-3 {
                            let v = s.plane.dot(DVec3::new(1.0, f.x as f64 + 0.5, f.y as f64 + 0.5));
                            println!(
                                "            m {m:.5} v {v} 1/v {} sec {} dist {} shift {} amp {}",
                                1.0 / v,
                                s.secant,
                                s.distance,
                                s.shift,
                                s.sqrt_det
                            );
                        }
                    }
                }
            }
        }
    }
}
