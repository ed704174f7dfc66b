//! Demos: what a host renders to a picture or a window.

use super::arguments::{Arguments, Mode};
use super::scene::{SIZE, STEP};
use super::under_way::UnderWay;
use super::{Host, Result, Validation};
use ash::vk;
use std::path::Path;
use std::time::Instant;

/// Number of frames in flight.
pub const FRAMES_IN_FLIGHT: u32 = 2;

/// Creates a demo, at first with frames of [`SIZE`].
pub type New<D> = fn(&Host, &Arguments) -> Result<D>;

/// Contents and frames of one size at a time.
pub trait Demo: Sized {
    /// Size of the frames, px.
    fn size(&self) -> [u32; 2];

    /// Changes the size. The GPU has finished the frames before.
    fn resize(&mut self, host: &Host, size: [u32; 2]) -> Result<()>;

    /// Shows other surfels from the next frame on, while earlier frames may be in flight.
    fn change(&mut self, host: &Host) -> Result<()>;

    /// Records the frame at a time in seconds, and leaves the picture as a transfer source. The GPU has finished all frames but the last.
    fn record(&mut self, host: &Host, cmd: vk::CommandBuffer, seconds: f64) -> Result<()>;

    /// The image of the picture.
    fn image(&self) -> vk::Image;

    /// The picture: sRGB and alpha, row by row.
    fn read(&self, host: &Host) -> Result<Vec<u8>>;

    /// Destroys the demo, once the GPU has finished using it.
    fn destroy(self, host: &Host);
}

/// Runs a demo according to the command line.
pub fn run<D: Demo>(new: New<D>) -> Result<()> {
    let arguments = Arguments::of_program()?;
    match &arguments.mode {
        Mode::Picture(file) => picture(new, &arguments, file),
        #[cfg(feature = "viewer")]
        Mode::Window | Mode::Soak => {
            let open = |window| super::window::InWindow::new(window, new, &arguments);
            super::event_loop::run("surfels in a host", &arguments, &open)
        }
        #[cfg(not(feature = "viewer"))]
        Mode::Window | Mode::Soak => Err("give FILE.png; for a window build with `--features viewer`".into()),
        Mode::Check => Err("there is no --check here: `cargo test --test embed` compares".into()),
    }
}

/// Renders frames, and writes the last one to `file`, a PNG; prints the median time of several.
fn picture<D: Demo>(new: New<D>, arguments: &Arguments, file: &Path) -> Result<()> {
    let host = Host::open_with(|all| all, Validation::WhereThere, &[], &[])?;
    let mut demo = new(&host, arguments)?;
    let bytes = frames(&host, &mut demo, arguments.frames.unwrap_or(1)).and_then(|milliseconds| {
        if arguments.frames.is_some_and(|frames| frames > 1) {
            println!("{}x{} px, {milliseconds:.1} ms a frame, the median", SIZE[0], SIZE[1]);
        }
        demo.read(&host)
    });
    demo.destroy(&host);
    host.close()?;
    let picture = image::RgbaImage::from_raw(SIZE[0], SIZE[1], bytes?).ok_or("the picture is too short")?;
    Ok(picture.save(file)?)
}

/// Renders frames; returns the median time of one, ms.
fn frames<D: Demo>(host: &Host, demo: &mut D, frames: u64) -> Result<f64> {
    let mut under_way = UnderWay::new(FRAMES_IN_FLIGHT);
    let mut ends = vec![Instant::now()];
    let mut draw = |number: u64, under_way: &mut UnderWay| -> Result<()> {
        if under_way.is_full() {
            under_way.wait(host)?;
            ends.push(Instant::now());
        }
        under_way.submit(host, |cmd| demo.record(host, cmd, STEP * number as f64))
    };
    let drawn = (0..frames).try_for_each(|number| draw(number, &mut under_way));
    while under_way.wait(host)? {
        ends.push(Instant::now());
    }
    drawn?;
    let mut times: Vec<_> = ends.windows(2).map(|pair| (pair[1] - pair[0]).as_secs_f64() * 1e3).collect();
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}
