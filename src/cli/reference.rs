//! Rendering with the float64 reference, without Vulkan.

use super::render::{Outcome, Task};
use super::turntable;
use std::time::Instant;
use surfel::frame::times::Times;
use surfel::geometry::{Camera, Parts};
use surfel::verify::reference;
use surfel::{Error, Picture, Result, SplatCounts};

/// Maximum number of pixels: they take about 5 GiB in float64, and running out of memory would abort the process.
const MOST_PIXELS: u64 = 1 << 26;

/// Renders the frames of `task` with the float64 reference.
pub fn render(task: &Task<'_>) -> Result<Outcome> {
    let [width, height] = task.size;
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        let text =
            format!("a picture of {width}x{height} px: the reference renders at most {MOST_PIXELS} pixels");
        return Err(Error::Usage(text));
    }
    let mut times = Times::default();
    let mut frame = None;
    for _ in 0..task.frames {
        let start = Instant::now();
        frame = Some(reference::render(task.scene, &task.camera, task.size, &task.settings, task.progress)?);
        times.add(start.elapsed(), &[]);
    }
    let picture = frame.as_ref().map(reference::Frame::to_picture).unwrap_or_default();
    let counts = frame.map(|frame| counts(&frame.counts));
    Ok(Outcome { picture, counts, times, split: None, gpu: None })
}

/// Renders `task` from other cameras; calls `save` with the index of the camera and the picture.
pub fn turn(
    task: &Task<'_>,
    cameras: &[Camera],
    mut save: impl FnMut(usize, Picture) -> Result<()>,
) -> Result<()> {
    for (number, camera) in cameras.iter().enumerate() {
        turntable::report_progress(task, number, cameras.len());
        let cut = task.cut.map(|cut| cut.surfels(camera)).transpose()?;
        let scene = cut.as_ref().map_or(task.scene, |surfels| Parts { surfels, ..task.scene });
        let frame = reference::render(scene, camera, task.size, &task.settings, &())?;
        save(number, frame.to_picture())?;
    }
    turntable::report_progress(task, cameras.len(), cameras.len());
    Ok(())
}

fn counts(counts: &reference::Counts) -> SplatCounts {
    // Surfels are numbered in 32 bits.
    let [drawn, behind, eye_plane] = [counts.drawn, counts.behind, counts.eye_plane].map(|n| n as u32);
    let [back, outside, invalid] = [counts.back, counts.outside, counts.invalid].map(|n| n as u32);
    SplatCounts {
        drawn,
        behind,
        eye_plane,
        back,
        outside,
        invalid,
        other_level: counts.other_level as u32,
        hidden: 0,
    }
}
