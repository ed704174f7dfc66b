//! Measurements tell when their times may not be those of the work.

use crate::support::results::{run, session, time};
use glam::DVec3;
use std::process::{Child, Command};
use std::time::Duration;
use surfel::bench::disturbance::{Disturbance, disturbances};
use surfel::bench::engine::LoadedEngine;
use surfel::bench::frame_times::{Side, time_frames};
use surfel::bench::recommendations::{Recommendations, within_error};
use surfel::bench::record::{Clock, Experiment, Memory, Run, Session, Time};
use surfel::bench::stopwatch::Effort;
use surfel::geometry::Camera;
use surfel::picture::Picture;
use surfel::settings::Settings;
use surfel::vk::PassTime;
use surfel::{Error, Result};

/// A frame of arithmetic on one thread, and a sleep.
struct Work {
    steps: u32,
    sleep: Duration,
    sum: u64,
}

impl LoadedEngine for Work {
    fn frame(&mut self, _: &Camera, _: &Settings, _: bool) -> Result<Vec<PassTime>> {
        for step in 0..self.steps {
            self.sum = std::hint::black_box(self.sum.wrapping_mul(6364136223846793005) ^ u64::from(step));
        }
        std::thread::sleep(self.sleep);
        Ok(Vec::new())
    }

    fn picture(&mut self, _: &Camera, _: &Settings) -> Result<Picture> {
        Err(Error::Usage("work has no picture".into()))
    }

    fn clock(&self) -> Clock {
        Clock::Cpu
    }

    fn memory(&self) -> Memory {
        Memory::default()
    }
}

fn work(steps: u32, sleep: u64) -> Work {
    Work { steps, sleep: Duration::from_millis(sleep), sum: 1 }
}

/// Times of engines that take turns for half a second.
fn times<const N: usize>(mut all: [Work; N]) -> [Time; N] {
    let effort = Effort { warmup: 1, least: 31, most: 1000, budget: Duration::from_millis(500), until: None };
    let camera =
        Camera::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.8, 1.0, 0.1).expect("it looks at something");
    let settings = Settings::default();
    let mut sides: Vec<Side<'_>> = all.iter_mut().map(|work| (work as _, &camera, &settings)).collect();
    let times = time_frames(&mut sides, &effort).into_iter().map(|time| time.expect("work never fails"));
    times.collect::<Vec<_>>().try_into().expect("one time per engine")
}

/// A session with runs of these times, all of one method.
fn with(times: impl IntoIterator<Item = Time>) -> Session {
    let mut session = session();
    let one = |time| Run { time: Some(time), ..run(Experiment::Budget, "scene:a", 1000, 10.0, 0.01) };
    session.runs = times.into_iter().map(one).collect();
    session
}

fn of_first(session: &Session) -> Vec<Disturbance> {
    disturbances(session, &session.runs[0])
}

/// Runs a test of this program in a process of its own, where other tests take no processor time; `true` there.
fn is_alone(name: &str) -> bool {
    const ALONE: &str = "SURFEL_TEST_ALONE";
    if std::env::var_os(ALONE).is_some() {
        return true;
    }
    let program = std::env::current_exe().expect("a test knows its program");
    let child = Command::new(program).args(["--exact", name, "--nocapture"]).env(ALONE, "1").output();
    let child = child.expect("a test can start itself");
    let text = String::from_utf8_lossy(&child.stdout);
    assert!(
        child.status.success() && text.contains("1 passed"),
        "{text}{}",
        String::from_utf8_lossy(&child.stderr)
    );
    false
}

/// Another program that uses a processor, until it is dropped.
struct BusyLoop(Child);

impl BusyLoop {
    fn start() -> Self {
        let child = Command::new("sh").args(["-c", "while :; do :; done"]).spawn();
        Self(child.expect("there is a shell"))
    }
}

impl Drop for BusyLoop {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

const STEPS: u32 = 2_000_000;

#[test]
fn a_sleep_in_a_frame_is_marked() {
    if is_alone("disturbance::a_sleep_in_a_frame_is_marked") {
        let session = with(times([work(STEPS, 4)]));
        let found = of_first(&session);
        let waited =
            found.iter().any(|found| matches!(found, Disturbance::Waited([wall, work]) if wall > work));
        assert!(waited, "{found:?} of {:?}", session.runs[0].time);
    }
}

#[cfg(unix)]
#[test]
fn a_busy_loop_beside_is_marked() {
    if is_alone("disturbance::a_busy_loop_beside_is_marked") {
        let beside = BusyLoop::start();
        let session = with(times([work(STEPS, 0)]));
        drop(beside);
        let found = of_first(&session);
        let busy = found.iter().any(|found| matches!(found, Disturbance::Busy(others) if *others > 0.3));
        assert!(busy, "{found:?} of {:?}", session.runs[0].time);
    }
}

#[test]
fn ten_per_cent_of_work_are_seen() {
    if is_alone("disturbance::ten_per_cent_of_work_are_seen") {
        let [less, more] = times([work(STEPS, 0), work(STEPS / 10 * 11, 0)]);
        assert!(more.cpu.median > less.cpu.median, "{less:?} {more:?}");
        assert!(more.work() == more.cpu && less.frames >= 31);
        // The advice names both exactly where the intervals overlap.
        let mut session = with([less.clone(), more.clone()]);
        session.runs[0].implementation.method = "perspective-ewa".into();
        session.runs[1].implementation.method = "sprites".into();
        let overlap = less.cpu.interval.unwrap()[1] >= more.cpu.interval.unwrap()[0];
        let recommendations = Recommendations::of(&session).unwrap();
        let column = &recommendations.columns[0];
        let best = within_error(&column.front, 0.05).unwrap();
        assert_eq!(best.run.implementation.method, "perspective-ewa");
        assert_eq!(!column.as_fast(best, 0.05).is_empty(), overlap);
    }
}

#[test]
fn the_advice_follows_the_labels() {
    let mut session = with([time(5.0), time(9.0)]);
    session.runs[0].implementation.method = "perspective-ewa".into();
    session.runs[1].implementation.method = "sprites".into();
    let advice = |session: &Session| {
        let recommendations = Recommendations::of(session).unwrap();
        within_error(&recommendations.columns[0].front, 0.05).unwrap().run.implementation.method.clone()
    };
    assert_eq!(advice(&session), "perspective-ewa");
    let [first, second] = &mut session.runs[..] else { unreachable!("there are two runs") };
    std::mem::swap(&mut first.implementation, &mut second.implementation);
    assert_eq!(advice(&session), "sprites");
}

/// Runs in line with each other are not marked; one that takes longer than its work is, if there are enough to compare it with.
#[test]
fn what_is_out_of_line_is_marked() {
    let concurrent = |threads: f64| {
        let mut time = time(10.0);
        time.wall.median = time.cpu.median / threads;
        time
    };
    let found = |threads: &[f64]| of_first(&with(threads.iter().copied().map(concurrent)));
    assert_eq!(found(&[1.9, 1.95, 1.8, 1.92]), []);
    assert_eq!(found(&[1.6, 1.95, 1.8, 1.92]), []);
    assert!(matches!(found(&[1.4, 1.95, 1.8, 1.92])[..], [Disturbance::Waited(_)]));
    assert_eq!(found(&[1.4, 1.95, 1.8]), [], "three runs do not tell what is usual");
    assert!(matches!(found(&[0.7])[..], [Disturbance::Waited(_)]), "a thread is always at work");
    let mut on_gpu = with([0.7, 0.7, 0.7, 0.3].map(concurrent));
    on_gpu.runs.iter_mut().for_each(|run| {
        let time = run.time.as_mut().unwrap();
        (time.clock, time.device) = (Clock::Gpu, Some(time.cpu));
    });
    assert_eq!(of_first(&on_gpu), [], "the caller of a GPU waits");
    assert!(matches!(disturbances(&on_gpu, &on_gpu.runs[3])[..], [Disturbance::Waited(_)]));
}

#[test]
fn a_busy_machine_is_marked_by_its_share_of_processors() {
    let found = |others: Option<f64>, cores: usize| {
        let mut session = with([Time { others, ..time(10.0) }]);
        session.provenance.host.cores = cores;
        of_first(&session)
    };
    assert_eq!(found(Some(0.08), 2), []);
    assert_eq!(found(Some(0.4), 2), [Disturbance::Busy(0.4)]);
    assert_eq!(found(Some(0.4), 16), []);
    assert_eq!(found(None, 2), []);
}
