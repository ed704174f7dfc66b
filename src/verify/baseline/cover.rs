//! The pixels of a tile that a splat covers, four at a time.

use super::shape::{Shape, half_box};
use super::splat::Splat;
use super::tile::{Frame, LANES, RAMP, SIDE};
use glam::{BVec4A, Vec2, Vec4};

/// The cut-off ellipse of a splat over one tile.
pub(super) struct Cover<'a> {
    splat: &'a Splat,
    /// Squared cut-off, σ².
    limit: f32,
    /// The tile's first pixel relative to the anchor, px.
    corner: Vec2,
    /// Rows of the map from px to σ.
    whitening: [Vec2; 2],
    /// Rows of the tile, first and last.
    rows: [u32; 2],
}

/// Four adjacent pixels of a row.
pub(super) struct Block {
    /// Index in the tile, row by row.
    pub index: usize,
    /// Squared distances to the centre, σ².
    pub distance: Vec4,
    /// Depth keys of the tangent plane.
    pub depth_key: Vec4,
    /// Which pixels are within the cut-off.
    pub inside: BVec4A,
}

impl<'a> Cover<'a> {
    /// The cover of a splat with the filtered `shape` on the tile whose first pixel is `corner`; `None` if it reaches
    /// no row of the tile.
    #[inline]
    pub fn new(splat: &'a Splat, shape: &Shape, frame: &Frame, corner: [u32; 2]) -> Option<Self> {
        let cutoff = frame.settings.cutoff;
        let corner = Vec2::new(
            corner[0] as f32 - f32::from(splat.anchor[0]),
            corner[1] as f32 - f32::from(splat.anchor[1]),
        );
        // More than the rounding error.
        let reach = 1.0001 * half_box(shape, cutoff).y + 0.01;
        let middle = splat.offset.y - corner.y;
        let (low, high) = (middle - reach, middle + reach);
        if !(low < SIDE as f32 && high >= 0.0) {
            return None;
        }
        let rows = [low.max(0.0) as u32, high.min(SIDE as f32 - 1.0) as u32];
        let (major, minor) = (1.0 / shape.variance.x.sqrt(), 1.0 / shape.variance.y.sqrt());
        let whitening = [major * shape.axis, minor * shape.axis.perp()];
        Some(Self { splat, limit: cutoff * cutoff, corner, whitening, rows })
    }

    /// Calls `visit` for all blocks with a covered pixel, and possibly for others.
    #[inline]
    pub fn each(&self, mut visit: impl FnMut(Block)) {
        let ([a, b], plane) = (self.whitening, self.splat.plane);
        let [first, last] = self.rows;
        for four in (first..=last).step_by(LANES) {
            let dy = RAMP + (four as f32 + self.corner.y);
            let [low, high] = self.spans(dy - self.splat.offset.y);
            for (lane, row) in (four..=last.min(four + LANES as u32 - 1)).enumerate() {
                if low[lane] > high[lane] {
                    continue;
                }
                let dy = row as f32 + self.corner.y;
                let y = dy - self.splat.offset.y;
                let (ay, by, depth_key) = (a.y * y, b.y * y, plane.x + plane.z * dy);
                for block in low[lane] as i32 as usize / LANES..=high[lane] as i32 as usize / LANES {
                    let dx = RAMP + ((block * LANES) as f32 + self.corner.x);
                    let x = dx - self.splat.offset.x;
                    let (along, across) = (a.x * x + ay, b.x * x + by);
                    let distance = along * along + across * across;
                    visit(Block {
                        index: row as usize * (SIDE / LANES) + block,
                        distance,
                        depth_key: plane.y * dx + depth_key,
                        inside: distance.cmple(Vec4::splat(self.limit)),
                    });
                }
            }
        }
    }

    /// The first and last pixels of four rows that may be covered; `y` is relative to the centre. The first is greater
    /// than the last for empty rows.
    #[inline]
    fn spans(&self, y: Vec4) -> [[f32; LANES]; 2] {
        let [a, b] = self.whitening;
        let inverse = 1.0 / (a.x * a.x + b.x * b.x);
        let determinant = a.x * b.y - b.x * a.y;
        let square = (self.limit - y * y * (determinant * determinant * inverse)) * inverse;
        // More than the rounding error.
        let half = 1.0001 * square.max(Vec4::ZERO).sqrt() + 0.02;
        let middle = (self.splat.offset.x - self.corner.x) - y * (inverse * (a.x * a.y + b.x * b.y));
        let tolerance = 1e-5 * (middle.abs() + y.abs());
        [
            (middle - half - tolerance).max(Vec4::ZERO).to_array(),
            (middle + half + tolerance).min(Vec4::splat(SIDE as f32 - 1.0)).to_array(),
        ]
    }
}
