//! Puts the manual's figures together, for `tools/make-figures`:
//!
//! ```text
//! figures row OUT.png LABEL=IN.png[@X,Y,W,H,ZOOM] …    pictures side by side, or parts of them, magnified
//! figures kernels OUT.png                              weights of the kernels
//! figures epsilon OUT.png                              which discs are blended
//! figures pyramid OUT.png                              levels of a frame by pull–push
//! figures bare IN.ply OUT.xyz                          positions and colours of points alone, as text
//! figures lidar OUT.xyz                                what a lidar at 0, 0, 0 sees of balls and walls on a ground, as text
//! ```

use glam::{DVec2, DVec3, Vec3, dvec2, dvec3};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use std::collections::HashMap;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use surfel::formats::{self, ReadOptions};
use surfel::geometry::{Camera, Cloud, Colours, srgb};
use surfel::settings::methods::Method;
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceOptions};
use surfel::{PyramidLevel, RenderOptions, Renderer, Scene};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const WHITE: [u8; 3] = [255; 3];
const INK: [u8; 3] = [40, 40, 46];
const GREY: [u8; 3] = [170, 170, 176];
const BLUE: [u8; 3] = [0, 114, 178];
const ORANGE: [u8; 3] = [213, 94, 0];
const GREEN: [u8; 3] = [0, 158, 115];
const PURPLE: [u8; 3] = [204, 121, 167];
const SKY: [u8; 3] = [86, 180, 233];

/// Height of a line of text, px.
const LINE: usize = 22;
/// Width of a letter, px.
const LETTER: usize = get_raster_width(FontWeight::Bold, RasterHeight::Size16);
/// Between pictures, px.
const GAP: usize = 8;
/// Most bytes of a figure.
const MOST: usize = 95_000;

/// At most so many colours that stand for those of a picture: median cut (Heckbert, *Color Image Quantization for Frame Buffer Display*,
/// SIGGRAPH 1982).
fn palette(pixels: &[[u8; 3]], count: usize) -> Vec<[u8; 3]> {
    let mut boxes = vec![pixels.to_vec()];
    let extent = |colours: &[[u8; 3]], channel: usize| {
        let values = || colours.iter().map(|colour| colour[channel]);
        values().max().unwrap_or(0) - values().min().unwrap_or(0)
    };
    while boxes.len() < count {
        let widest =
            |colours: &[[u8; 3]]| (0..3).max_by_key(|channel| extent(colours, *channel)).unwrap_or(0);
        // Where the error is greatest: many pixels, far apart.
        let error = |colours: &Vec<[u8; 3]>| {
            let extent = f64::from(extent(colours, widest(colours)));
            (extent * extent * (colours.len() as f64).sqrt()) as u64
        };
        let Some(at) = (0..boxes.len()).max_by_key(|i| error(&boxes[*i])).filter(|i| error(&boxes[*i]) > 0)
        else {
            break;
        };
        let mut colours = boxes.swap_remove(at);
        let channel = widest(&colours);
        colours.sort_unstable_by_key(|colour| colour[channel]);
        // Equal colours stay together.
        let middle = colours[colours.len() / 2][channel].max(colours[0][channel] + 1);
        let cut = colours.partition_point(|colour| colour[channel] < middle);
        let above = colours.split_off(cut);
        boxes.extend([colours, above]);
    }
    let mean = |colours: &Vec<[u8; 3]>| {
        [0, 1, 2].map(|channel| {
            let sum: u64 = colours.iter().map(|colour| u64::from(colour[channel])).sum();
            (sum as f64 / colours.len() as f64).round() as u8
        })
    };
    boxes.iter().map(mean).collect()
}

/// The index of the colour nearest to this.
fn nearest(palette: &[[u8; 3]], colour: [u8; 3]) -> u8 {
    let distance = |other: &[u8; 3]| -> u32 {
        other.iter().zip(colour).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
    };
    (0..palette.len()).min_by_key(|i| distance(&palette[*i])).unwrap_or(0) as u8
}

/// A picture to draw on, sRGB.
struct Canvas {
    size: [usize; 2],
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    fn new(size: [usize; 2]) -> Self {
        Self { size, pixels: vec![WHITE; size[0] * size[1]] }
    }

    /// Lays a colour over a pixel; nothing happens outside.
    fn blend(&mut self, x: usize, y: usize, colour: [u8; 3], alpha: f64) {
        if x >= self.size[0] || y >= self.size[1] {
            return;
        }
        let pixel = &mut self.pixels[y * self.size[0] + x];
        for (under, over) in pixel.iter_mut().zip(colour) {
            *under = (f64::from(*under) * (1.0 - alpha) + f64::from(over) * alpha).round() as u8;
        }
    }

    /// A line of this width, px, with round ends.
    fn line(&mut self, [a, b]: [DVec2; 2], width: f64, colour: [u8; 3]) {
        let margin = DVec2::splat(0.5 * width + 1.0);
        let (low, high) = (a.min(b) - margin, a.max(b) + margin);
        for y in low.y.max(0.0) as usize..=high.y.max(0.0) as usize {
            for x in low.x.max(0.0) as usize..=high.x.max(0.0) as usize {
                let p = dvec2(x as f64 + 0.5, y as f64 + 0.5);
                let along = b - a;
                let t = ((p - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
                let outside = (p - a - t * along).length() - 0.5 * width;
                self.blend(x, y, colour, (0.5 - outside).clamp(0.0, 1.0));
            }
        }
    }

    /// A dashed line.
    fn dashes(&mut self, [a, b]: [DVec2; 2], width: f64, colour: [u8; 3]) {
        let count = ((b - a).length() / 12.0).ceil().max(1.0);
        for i in 0..count as usize {
            let at = |part: f64| a + (b - a) * ((i as f64 + part) / count);
            self.line([at(0.0), at(0.5)], width, colour);
        }
    }

    /// A line of text with its top left corner here.
    fn text(&mut self, [x, y]: [usize; 2], text: &str, colour: [u8; 3]) {
        for (letter, left) in text.chars().zip((x..).step_by(LETTER)) {
            let Some(glyph) = get_raster(letter, FontWeight::Bold, RasterHeight::Size16) else { continue };
            for (row, y) in glyph.rows().zip(y..) {
                for (ink, x) in row.iter().zip(left..) {
                    self.blend(x, y, colour, f64::from(*ink) / 255.0);
                }
            }
        }
    }

    fn paste(&mut self, [x, y]: [usize; 2], picture: &Canvas) {
        for (row, pixels) in picture.pixels.chunks(picture.size[0]).enumerate() {
            let start = (y + row) * self.size[0] + x;
            self.pixels[start..start + pixels.len()].copy_from_slice(pixels);
        }
    }

    /// Writes it with a palette of as many colours, 256 at most, as make a file of at most [`MOST`] bytes.
    fn write(&self, path: &str) -> Result<()> {
        for count in [256, 128, 64, 32] {
            let file = self.png(&palette(&self.pixels, count))?;
            if file.len() <= MOST {
                println!("{path}: {} bytes, {count} colours", file.len());
                return Ok(std::fs::write(path, file)?);
            }
        }
        Err(format!("{path}: more than {MOST} bytes: make it smaller").into())
    }

    fn png(&self, palette: &[[u8; 3]]) -> Result<Vec<u8>> {
        let mut known = HashMap::new();
        let indices: Vec<u8> = self
            .pixels
            .iter()
            .map(|pixel| *known.entry(*pixel).or_insert_with(|| nearest(palette, *pixel)))
            .collect();
        let mut file = Vec::new();
        let [width, height] = self.size.map(|side| side as u32);
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette.as_flattened().to_vec());
        encoder.set_compression(png::Compression::High);
        // Neighbours in a palette are no neighbours in colour.
        encoder.set_filter(png::Filter::NoFilter);
        encoder.write_header()?.write_image_data(&indices)?;
        Ok(file)
    }

    /// A file, over white.
    fn read(path: &str) -> Result<Self> {
        let image = image::open(path).map_err(|error| format!("{path}: {error}"))?.into_rgba8();
        let mut canvas = Self::new([image.width() as usize, image.height() as usize]);
        for (under, pixel) in canvas.pixels.iter_mut().zip(image.pixels()) {
            let [r, g, b, alpha] = pixel.0;
            *under = [r, g, b].map(|code| {
                let alpha = f64::from(alpha) / 255.0;
                let linear = alpha * srgb::decode(f64::from(code) / 255.0) + 1.0 - alpha;
                srgb::encode8(linear as f32)
            });
        }
        Ok(canvas)
    }

    /// A part of it, each pixel `zoom` wide.
    fn part(&self, [x, y, width, height, zoom]: [usize; 5]) -> Result<Self> {
        if x + width > self.size[0] || y + height > self.size[1] {
            return Err(format!("a part {width}x{height} at {x},{y} of a picture of {:?}", self.size).into());
        }
        let mut part = Self::new([width * zoom, height * zoom]);
        for (i, pixel) in part.pixels.iter_mut().enumerate() {
            let [column, row] = [i % (width * zoom) / zoom, i / (width * zoom) / zoom];
            *pixel = self.pixels[(y + row) * self.size[0] + x + column];
        }
        Ok(part)
    }
}

/// Most pictures in a row.
const COLUMNS: usize = 4;

/// Pictures of one size side by side, each above its label; more than fit into a row, in two.
fn row(pictures: &[(String, Canvas)]) -> Canvas {
    let columns = if pictures.len() > COLUMNS { pictures.len().div_ceil(2) } else { pictures.len() };
    let [width, height] = pictures[0].1.size;
    let label = if pictures.iter().all(|(label, _)| label.is_empty()) { 0 } else { LINE };
    let step = [width + GAP, height + label + GAP];
    let mut canvas = Canvas::new([columns * step[0] - GAP, pictures.len().div_ceil(columns) * step[1] - GAP]);
    for (i, (label, picture)) in pictures.iter().enumerate() {
        let [x, y] = [i % columns * step[0], i / columns * step[1]];
        canvas.paste([x, y], picture);
        let left = picture.size[0].saturating_sub(label.chars().count() * LETTER) / 2;
        canvas.text([x + left, y + height + 4], label, INK);
    }
    canvas
}

/// LABEL=IN.png, LABEL=IN.png@X,Y,W,H,ZOOM.
fn labelled(argument: &str) -> Result<(String, Canvas)> {
    let (label, file) = argument.split_once('=').ok_or("give LABEL=IN.png")?;
    let Some((file, part)) = file.split_once('@') else { return Ok((label.into(), Canvas::read(file)?)) };
    let numbers: Vec<usize> = part.split(',').map(str::parse).collect::<std::result::Result<_, _>>()?;
    let part = numbers.try_into().map_err(|_| "give X,Y,W,H,ZOOM")?;
    Ok((label.into(), Canvas::read(file)?.part(part)?))
}

/// Weights against the distance from the centre in disc radii.
fn kernels() -> Canvas {
    let (left, top, width, height) = (60.0, 16.0, 400.0, 260.0);
    let mut canvas = Canvas::new([720, 330]);
    let at = |x: f64, y: f64| dvec2(left + x / 1.1 * width, top + (1.0 - y) * height);
    for i in 0..=4 {
        let y = f64::from(i) / 4.0;
        canvas.line([at(0.0, y), at(1.1, y)], 1.0, if i == 0 { INK } else { [225; 3] });
        canvas.text([8, at(0.0, y).y as usize - 8], &format!("{y:.2}"), INK);
    }
    canvas.line([at(0.0, 0.0), at(0.0, 1.0)], 1.0, INK);
    for i in 0..=4 {
        let x = f64::from(i) / 4.0;
        canvas.line([at(x, 0.0), at(x, 0.0) + dvec2(0.0, 5.0)], 1.0, INK);
        canvas.text([at(x, 0.0).x as usize - 16, at(x, 0.0).y as usize + 8], &format!("{x:.2}"), INK);
    }
    canvas.text([at(0.0, 0.0).x as usize + 60, 306], "distance / disc radius", INK);
    let gaussian = |cutoff: f64| move |t: f64| (-0.5 * (cutoff * t).powi(2)).exp();
    let psi = |a: f64, n: f64| move |t: f64| (-a * t.powf(n) / (1.0 - t.powf(n)).max(1e-6)).exp();
    type Kernel = Box<dyn Fn(f64) -> f64>;
    let curves: [(&str, Kernel, [u8; 3]); 6] = [
        ("Gaussian, F = 1.41", Box::new(gaussian(2f64.sqrt())), SKY),
        ("Gaussian, F = 2", Box::new(gaussian(2.0)), BLUE),
        ("Gaussian, F = 2.5", Box::new(gaussian(2.5)), INK),
        ("psi, a = 1, n = 2", Box::new(psi(1.0, 2.0)), PURPLE),
        ("psi, a = 6, n = 3", Box::new(psi(6.0, 3.0)), ORANGE),
        ("psi, a = 4, n = 5", Box::new(psi(4.0, 5.0)), GREEN),
    ];
    for (i, (name, kernel, colour)) in curves.iter().enumerate() {
        let value = |k: u32| at(f64::from(k) / 200.0, kernel(f64::from(k) / 200.0));
        (0..200).for_each(|k| canvas.line([value(k), value(k + 1)], 2.5, *colour));
        // Where the disc ends, so does the kernel.
        canvas.line([value(200), at(1.0, 0.0)], 2.5, *colour);
        let y = 30 + 34 * i;
        canvas.line([dvec2(492.0, y as f64 + 8.0), dvec2(524.0, y as f64 + 8.0)], 3.0, *colour);
        canvas.text([536, y], name, INK);
    }
    canvas.line([at(1.0, 0.0), at(1.1, 0.0)], 2.5, INK);
    canvas
}

/// A cut through two surfaces of overlapping discs: those within ε behind the nearest disc on a ray are blended.
fn epsilon() -> Canvas {
    let mut canvas = Canvas::new([760, 330]);
    let eye = dvec2(40.0, 150.0);
    let (near, far) = (|y: f64| dvec2(400.0 + 22.0 * (y / 46.0).sin(), y), |y: f64| dvec2(610.0, y));
    // What the visibility pass leaves: the surface, moved back along the rays.
    for i in 0..10 {
        let moved = |y: f64| near(y) + (near(y) - eye).normalize() * 62.0;
        let y = 24.0 + 26.0 * f64::from(i);
        canvas.dashes([moved(y), moved(y + 26.0)], 2.0, GREY);
    }
    // Discs, seen edge-on, somewhat off the surface.
    let mut disc = |surface: &dyn Fn(f64) -> DVec2, i: u32, colour| {
        let y = 30.0 + 30.0 * f64::from(i);
        let off = dvec2(f64::from(i * 7 % 5) * 6.0 - 12.0, 0.0);
        let along = (surface(y + 1.0) - surface(y - 1.0)).normalize() * 26.0;
        canvas.line([surface(y) + off - along, surface(y) + off + along], 4.0, colour);
    };
    (0..9).for_each(|i| disc(&far, i, GREY));
    (0..9).for_each(|i| disc(&near, i, if [3, 4].contains(&i) { ORANGE } else { BLUE }));
    canvas.line([eye, dvec2(700.0, 133.0)], 1.5, INK);
    canvas.line([eye - dvec2(6.0, 6.0), eye + dvec2(6.0, 6.0)], 2.0, INK);
    canvas.line([eye - dvec2(6.0, -6.0), eye + dvec2(6.0, -6.0)], 2.0, INK);
    canvas.text([16, 168], "eye", INK);
    canvas.text([150, 112], "viewing ray", INK);
    canvas.text([90, 300], "discs of the surface", BLUE);
    canvas.text([310, 300], "blended here", ORANGE);
    canvas.text([452, 300], "depth + epsilon", [120; 3]);
    canvas.text([612, 300], "hidden", [120; 3]);
    canvas
}

/// The finest levels of a frame: above as they were pulled, below as they were pushed.
fn pyramid() -> Result<Canvas> {
    const SIDE: u32 = 224;
    let device = Device::open(&DeviceOptions::default())?;
    let scene = Scene::upload(&device, &scenes::open("scene:torus?points=3000&frequency=1")?)?;
    let options = RenderOptions { size: [SIDE; 2], split: true, ..Default::default() };
    let mut renderer = Renderer::new(&device, options)?;
    let eye = dvec3(1.7, 3.1, 2.9);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 38f64.to_radians(), 1.0, 0.1)?;
    let settings = Method::named("pull-push").ok_or("there is no pull-push")?.settings();
    renderer.render(&scene, &camera, &settings)?;
    let [pulled, pushed] = renderer.read_pyramids()?.ok_or("the frame has no pyramid")?;
    let to_eye = eye.normalize().as_vec3();
    let picture = |level: &PyramidLevel| {
        let [width, height] = level.size.map(|side| side as usize);
        let mut canvas = Canvas::new([width, height]);
        for (pixel, sample) in canvas.pixels.iter_mut().zip(&level.samples) {
            // Light from the eye, so that the shape is seen.
            *pixel = sample.as_ref().map_or(INK, |sample| {
                let light = 0.15 + 0.85 * Vec3::from(sample.normal).dot(to_eye).max(0.0);
                sample.colour.unwrap_or([0.6; 3]).map(|channel| srgb::encode8(channel * light))
            });
        }
        canvas.part([0, 0, width, height, SIDE as usize / width])
    };
    let mut pictures = Vec::new();
    for (levels, name) in [(&pulled, "pulled"), (&pushed, "pushed")] {
        for (l, level) in levels.iter().take(4).enumerate() {
            pictures.push((format!("level {l}, {name}"), picture(level)?));
        }
    }
    Ok(row(&pictures))
}

/// Positions and colours of a file's points as text, without normals and radii.
fn bare(file: &str) -> Result<String> {
    let Cloud { origin, positions, colours, .. } =
        formats::read(Path::new(file), &ReadOptions::default(), &())?.cloud;
    let codes = match colours {
        Some(Colours::Srgb8(codes)) => codes.into_iter().map(|[r, g, b, _]| [r, g, b]).collect(),
        Some(Colours::Linear(colours)) => {
            colours.into_iter().map(|colour| colour.map(srgb::encode8)).collect()
        }
        None => vec![GREY; positions.len()],
    };
    let mut text = String::from("x y z red green blue\n");
    for (position, [r, g, b]) in positions.iter().zip(codes) {
        let DVec3 { x, y, z } = origin + position.as_dvec3();
        writeln!(text, "{x} {y} {z} {r} {g} {b}")?;
    }
    Ok(text)
}

/// Distances from 0 along a beam to where it meets a ground, balls and upright walls of one x.
fn ranges(beam: DVec3) -> impl Iterator<Item = f64> {
    let ground = -1.7 / beam.z;
    let balls = [(dvec3(5.0, -3.0, -0.9), 0.8), (dvec3(9.0, 3.5, -0.5), 1.2), (dvec3(-4.0, 5.0, -0.7), 1.0)];
    let balls = balls.into_iter().filter_map(move |(centre, radius): (DVec3, f64)| {
        let middle = centre.dot(beam);
        let inside = radius * radius - (centre - middle * beam).length_squared();
        (inside >= 0.0).then(|| middle - inside.sqrt())
    });
    let walls = [(14.0, [-8.0, 2.0]), (-9.0, [-3.0, 9.0])];
    let walls = walls.into_iter().filter_map(move |(x, [from, to])| {
        let range = x / beam.x;
        let at = range * beam;
        ((from..to).contains(&at.y) && at.z < 1.0).then_some(range)
    });
    balls.chain(walls).chain([ground]).filter(|range| (0.5..40.0).contains(range))
}

/// The points that a lidar at 0 sees, with errors of up to 5 mm, as text.
fn lidar() -> Result<String> {
    let step = 0.35f64.to_radians();
    let mut text = String::from("x y z\n");
    for row in -110..40 {
        for column in 0..1028 {
            let (sin, cos) = (step * f64::from(column)).sin_cos();
            let (up, along) = (step * f64::from(row)).sin_cos();
            let beam = dvec3(along * cos, along * sin, up);
            let error = 0.01 * ((f64::from(1028 * row + column) * 0.754_877).rem_euclid(1.0) - 0.5);
            if let Some(range) = ranges(beam).reduce(f64::min) {
                let DVec3 { x, y, z } = (range + error) * beam;
                writeln!(text, "{x:.4} {y:.4} {z:.4}")?;
            }
        }
    }
    Ok(text)
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["row", out, ref pictures @ ..] if !pictures.is_empty() => {
            let pictures = pictures.iter().map(|argument| labelled(argument)).collect::<Result<Vec<_>>>()?;
            row(&pictures).write(out)
        }
        ["kernels", out] => kernels().write(out),
        ["epsilon", out] => epsilon().write(out),
        ["pyramid", out] => pyramid()?.write(out),
        ["bare", file, out] => Ok(std::fs::write(out, bare(file)?)?),
        ["lidar", out] => Ok(std::fs::write(out, lidar()?)?),
        _ => Err("give row, kernels, epsilon, pyramid, bare or lidar: see the beginning of tools/figures.rs"
            .into()),
    }
}
