//! Tile lists: what workgroups of different widths load and do in the pass `surface`, counted by a replay of its walks on the CPU.
//!
//! The splats are those of a frame on the device, so that the counts need no GPU, and hold for any. A walk is that of `lib/walk.glsl`, with
//! fragments in float32 and without the stretch of the perspective kernel.
//!
//! usage: `cargo bench --bench tile_lists [-- FILE…]`: files beside the built-in scenes.

mod support;

use glam::DVec3;
use support::Result;
use surfel::bench::format;
use surfel::estimate::Estimate;
use surfel::formats::{ReadOptions, read};
use surfel::frame::Splat;
use surfel::geometry::{Camera, Extent, Surfels};
use surfel::settings::Settings;
use surfel::verify::scenes::bumpy_sphere;
use surfel::vk::Device;
use surfel::{Rasterizer, RenderOptions, Renderer, Scene};

/// Width and height of the picture, px.
const SIZE: usize = 1024;
const TILE: usize = 8;
/// Children of a node of the box hierarchy.
const FAN_OUT: usize = 8;
/// Level whose nodes are visited near to far.
const BLOCKS: usize = 3;
/// Most splats of a tile whose ids visibility records for attribute.
const MOST_VISITED: usize = 512;
const LANES: [usize; 3] = [8, 32, 64];

/// Bytes of a box, and of a splat with its attributes.
const BOX: usize = 16;
const SPLAT: usize = 64 + 32;

fn main() -> Result<()> {
    let Some(device) = support::device() else { return Ok(()) };
    let mut scenes = Vec::new();
    for points in [10_000, 100_000, 1_000_000] {
        let mut surfels = bumpy_sphere::sample(points, 1);
        surfels.sort_morton();
        scenes.push((format!("bumpy sphere, {}", format::count(points.into())), surfels));
    }
    for file in std::env::args().skip(1).filter(|argument| !argument.starts_with("--")) {
        let cloud = read(std::path::Path::new(&file), &ReadOptions::default(), &())?.cloud;
        let (surfels, _) = cloud.into_surfels(&Estimate::default(), &())?;
        scenes.push((file, surfels));
    }
    let about = format!("{SIZE}×{SIZE} px; means of the tiles of {TILE}×{TILE} px that have splats");
    support::machine(&about, Some(&device));
    support::head(&HEAD);
    for (name, surfels) in &scenes {
        let settings = Settings::default();
        let splats = splats(&device, surfels, &settings)?;
        let ellipses: Vec<_> = splats.iter().map(|splat| Ellipse::new(splat, &settings)).collect();
        let hierarchy = Hierarchy::new(&ellipses);
        for lanes in LANES {
            support::line(&row(name, lanes, &replay(&hierarchy, &ellipses, lanes)));
        }
    }
    Ok(())
}

/// The splats of a frame that shows all surfels.
fn splats(device: &std::sync::Arc<Device>, surfels: &Surfels, settings: &Settings) -> Result<Vec<Splat>> {
    let scene = Scene::upload(device, surfels)?;
    let camera = Camera::framing(&Extent::from(&scene.bounds()), DVec3::Y, 45f64.to_radians(), 1.0)?;
    let size = [SIZE as u32; 2];
    let options = RenderOptions { size, rasterizer: Rasterizer::Compute.into(), ..Default::default() };
    let mut renderer = Renderer::new(device, options)?;
    renderer.render(&scene, &camera, settings)?;
    Ok(renderer.read_splats()?.remove(0))
}

/// The visibility footprint of a splat, and its plane.
#[derive(Clone, Copy)]
struct Ellipse {
    centre: [f32; 2],
    /// Rows of the map from px to σ.
    rows: [[f32; 2]; 2],
    cutoff: f32,
    /// Half width and height of the attribute footprint, px.
    reach: [f32; 2],
    /// Inverse depth at the centre, and its derivatives.
    plane: [f32; 3],
    /// Factor of inverse depth by ε.
    epsilon: f32,
    key_disc: f32,
}

impl Ellipse {
    fn new(splat: &Splat, settings: &Settings) -> Option<Self> {
        if splat.anchor >> 30 != 1 {
            return None;
        }
        let anchor = [splat.anchor & 0x7fff, splat.anchor >> 15 & 0x7fff].map(|pixel| pixel as f32);
        let own = [splat.variance, splat.sqrt_det * (splat.sqrt_det / splat.variance)];
        let visible = own.map(|v| v + settings.least_lowpass());
        let wide = own.map(|v| v + settings.attribute_lowpass());
        let [x, y] = splat.axis;
        let deviation = visible.map(f32::sqrt);
        let reach = |a: f32, b: f32| settings.cutoff * (a * a * wide[0] + b * b * wide[1]).sqrt();
        let [hi, lo] = [splat.plane_hi, splat.plane_lo];
        let slope = [hi[1] + lo[1], hi[2] + lo[2]];
        Some(Self {
            centre: [0, 1].map(|i| anchor[i] + splat.offset[i]),
            rows: [[x / deviation[0], y / deviation[0]], [-y / deviation[1], x / deviation[1]]],
            cutoff: settings.cutoff,
            reach: [reach(x, y), reach(y, x)],
            plane: [hi[0] + slope[0] * splat.offset[0] + slope[1] * splat.offset[1], slope[0], slope[1]],
            epsilon: splat.epsilon.abs(),
            key_disc: splat.key_disc,
        })
    }

    /// Depth key of its fragment at a pixel, if it has one.
    fn fragment(&self, pixel: [usize; 2]) -> Option<f32> {
        let d = [0, 1].map(|i| pixel[i] as f32 - self.centre[i]);
        let m = self.rows.map(|row| row[0] * d[0] + row[1] * d[1]);
        let key = self.plane[0] + self.plane[1] * d[0] + self.plane[2] * d[1];
        let inside = m[0] * m[0] + m[1] * m[1] <= self.cutoff * self.cutoff && key > 0.0 && key <= 1.0;
        inside.then(|| key.min(self.key_disc) * self.epsilon)
    }

    fn bounds(&self) -> Bounds {
        let low = [0, 1].map(|i| (self.centre[i] - self.reach[i]).ceil().max(0.0) as i32);
        let high = [0, 1].map(|i| (self.centre[i] + self.reach[i]).floor().min(SIZE as f32 - 1.0) as i32);
        let rise = self.plane[1].abs() * self.reach[0] + self.plane[2].abs() * self.reach[1];
        Bounds { low, high, nearest: self.plane[0] + rise }
    }
}

/// A box of the hierarchy.
#[derive(Clone, Copy)]
struct Bounds {
    low: [i32; 2],
    high: [i32; 2],
    nearest: f32,
}

impl Bounds {
    const EMPTY: Self = Self { low: [i32::MAX; 2], high: [-1; 2], nearest: 0.0 };

    fn with(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1].map(|i| self.high[i].max(other.high[i])),
            nearest: self.nearest.max(other.nearest),
        }
    }

    fn overlaps(&self, origin: [usize; 2]) -> bool {
        (0..2).all(|i| self.low[i] < (origin[i] + TILE) as i32 && self.high[i] >= origin[i] as i32)
    }
}

/// Boxes level by level, from those of splats up.
struct Hierarchy {
    levels: Vec<Vec<Bounds>>,
}

impl Hierarchy {
    fn new(ellipses: &[Option<Ellipse>]) -> Self {
        let boxes = ellipses.iter().map(|ellipse| ellipse.as_ref().map_or(Bounds::EMPTY, Ellipse::bounds));
        let mut levels = vec![boxes.collect::<Vec<_>>()];
        while levels.len() <= BLOCKS || levels[levels.len() - 1].len() > FAN_OUT {
            let finer = &levels[levels.len() - 1];
            let union = |group: &[Bounds]| group.iter().copied().fold(Bounds::EMPTY, Bounds::with);
            levels.push(finer.chunks(FAN_OUT).map(union).collect());
        }
        Self { levels }
    }

    /// Nodes of a group of siblings that overlap the tile in front of `key`.
    fn hits(&self, level: usize, group: usize, origin: [usize; 2], key: f32) -> Vec<usize> {
        let all = &self.levels[level];
        let siblings = FAN_OUT * group..(FAN_OUT * (group + 1)).min(all.len());
        siblings.filter(|node| all[*node].overlaps(origin) && all[*node].nearest > key).collect()
    }
}

/// What a tile loads and does.
#[derive(Clone, Copy, Default)]
struct Counts {
    /// Groups of siblings whose boxes are loaded, by visibility.
    groups: usize,
    /// Splats that visibility visits.
    splats: usize,
    batches: usize,
    /// Pixels that these splats cover.
    covered: usize,
}

/// Visibility of a tile.
struct Walk<'a> {
    hierarchy: &'a Hierarchy,
    ellipses: &'a [Option<Ellipse>],
    origin: [usize; 2],
    lanes: usize,
    depths: [f32; TILE * TILE],
    cull_key: f32,
    pending: Vec<usize>,
    counts: Counts,
}

impl Walk<'_> {
    fn hits(&mut self, level: usize, group: usize) -> Vec<usize> {
        self.counts.groups += 1;
        self.hierarchy.hits(level, group, self.origin, self.cull_key)
    }

    /// Visits the nodes of a group from blocks up, near to far.
    fn visit(&mut self, level: usize, group: usize) {
        let mut hits = self.hits(level, group);
        let nearest = |node: &usize| self.hierarchy.levels[level][*node].nearest;
        hits.sort_by(|a, b| nearest(b).total_cmp(&nearest(a)));
        for node in hits {
            if level > BLOCKS {
                self.visit(level - 1, node);
            } else if self.hierarchy.levels[level][node].nearest > self.cull_key {
                self.visit_block(node);
            }
        }
    }

    fn visit_block(&mut self, block: usize) {
        for parent in self.hits(BLOCKS - 1, block) {
            for node in self.hits(BLOCKS - 2, parent) {
                let splats = self.hits(0, node);
                self.pending.extend(splats);
            }
        }
        while self.pending.len() >= self.lanes {
            self.rasterize(self.lanes);
        }
    }

    /// Rasterizes a batch.
    fn rasterize(&mut self, count: usize) {
        self.counts.batches += 1;
        for splat in self.pending.drain(..count).collect::<Vec<_>>() {
            self.counts.splats += 1;
            let Some(ellipse) = &self.ellipses[splat] else { continue };
            for (i, depth) in self.depths.iter_mut().enumerate() {
                let pixel = [self.origin[0] + i % TILE, self.origin[1] + i / TILE];
                if let Some(key) = ellipse.fragment(pixel) {
                    self.counts.covered += 1;
                    *depth = depth.max(key);
                }
            }
        }
        self.cull_key = self.depths.iter().copied().fold(f32::INFINITY, f32::min);
    }
}

/// Counts of every tile that has splats.
fn replay(hierarchy: &Hierarchy, ellipses: &[Option<Ellipse>], lanes: usize) -> Vec<Counts> {
    let tiles = SIZE / TILE;
    let mut all = Vec::new();
    for tile in 0..tiles * tiles {
        let mut walk = Walk {
            hierarchy,
            ellipses,
            origin: [TILE * (tile % tiles), TILE * (tile / tiles)],
            lanes,
            depths: [0.0; TILE * TILE],
            cull_key: 0.0,
            pending: Vec::new(),
            counts: Counts::default(),
        };
        walk.visit(hierarchy.levels.len() - 1, 0);
        while !walk.pending.is_empty() {
            walk.rasterize(walk.pending.len().min(lanes));
        }
        if walk.counts.splats > 0 {
            all.push(walk.counts);
        }
    }
    all
}

/// Columns of [`row`]: 99 % and most are of the splats of a tile; the hottest are 1 % of the tiles.
const HEAD: [&str; 11] = [
    "scene",
    "lanes",
    "tiles",
    "groups of 8 boxes",
    "splats",
    "99 % of tiles below; most",
    "lanes without a splat",
    "tested pixels that are covered",
    "loads of a frame",
    "work of the hottest tiles",
    "tiles that walk again for attribute",
];

fn row(name: &str, lanes: usize, all: &[Counts]) -> [String; HEAD.len()] {
    let sum = |of: fn(&Counts) -> usize| all.iter().map(of).sum::<usize>() as f64;
    let [groups, splats, batches, covered] =
        [sum(|c| c.groups), sum(|c| c.splats), sum(|c| c.batches), sum(|c| c.covered)];
    let mut sorted: Vec<_> = all.iter().map(|counts| counts.splats).collect();
    sorted.sort_unstable();
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share) as usize];
    let mut hot: Vec<_> = all.iter().map(|counts| counts.groups + counts.splats).collect();
    hot.sort_unstable_by(|a, b| b.cmp(a));
    let hottest = hot.iter().take(all.len().div_ceil(100)).sum::<usize>() as f64 / (groups + splats);
    let again = all.iter().filter(|counts| counts.splats > MOST_VISITED).count();
    let bytes = groups * (FAN_OUT * BOX) as f64 + splats * SPLAT as f64;
    let mean = |sum: f64| format::significant(sum / all.len() as f64, 3);
    [
        name.into(),
        lanes.to_string(),
        all.len().to_string(),
        mean(groups),
        mean(splats),
        format!("{}; {}", at(0.99), at(1.0)),
        format::percent(1.0 - splats / (batches * lanes as f64)),
        format::percent(covered / (splats * (TILE * TILE) as f64)),
        format::with_prefix(bytes) + "B",
        format::percent(hottest),
        again.to_string(),
    ]
}
