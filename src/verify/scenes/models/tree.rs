//! A tree: forking tapered tubes, with ribbons as leaves.

use super::{piece, tinted};
use crate::verify::scenes::query::Query;
use crate::verify::scenes::random::Random;
use crate::verify::scenes::shapes::{Curve, Patch, Ribbon, Sphere, Tube};
use crate::verify::scenes::surface::{Kind, Piece};
use crate::verify::scenes::texture::Texture;
use glam::DVec3;
use std::f64::consts::TAU;

/// Branches that start at the end of a branch.
const FORKS: u32 = 3;
/// Trees in a row.
const ROW: u64 = 5;
/// Distance between trees.
const APART: f64 = 1.8;
/// Leaves per last branch.
const LEAVES: u32 = 6;

struct Growth {
    random: Random,
    bark: Texture,
    leaf: Texture,
    pieces: Vec<Piece>,
}

/// Start of a branch.
struct Bud {
    at: DVec3,
    direction: DVec3,
    length: f64,
    radius: f64,
    /// Remaining forks.
    forks: u64,
}

/// Trees with `depth` levels of forks, in rows of [`ROW`], each with its own random numbers.
pub fn tree(query: &Query) -> Vec<Piece> {
    let mut growth = Growth {
        random: Random::new(query.whole("growth"), 0),
        bark: tinted(query, [110, 75, 45]),
        leaf: tinted(query, [60, 140, 40]),
        pieces: Vec::new(),
    };
    let forks = query.whole("depth");
    for i in 0..query.whole("trees") {
        // The first is in the middle of the first row, others to its right, to its left, and behind.
        let side = [0.0, 1.0, -1.0, 2.0, -2.0][(i % ROW) as usize];
        let at = DVec3::new(APART * side, 0.0, -APART * (i / ROW) as f64);
        growth.branch(Bud { at, direction: DVec3::Y, length: 0.9, radius: 0.09, forks });
    }
    growth.pieces
}

impl Growth {
    /// Adds a piece as a separate sheet.
    fn add(&mut self, kind: Kind, piece: Piece) {
        let sheet = self.pieces.len() as u32;
        self.pieces.push(Piece { kind, sheet, ..piece });
    }

    fn branch(&mut self, bud: Bud) {
        let bend = self.aside(bud.direction);
        let middle = bud.at + 0.5 * bud.length * bud.direction + 0.08 * bud.length * bend;
        let tip = bud.at + bud.length * bud.direction;
        let (curve, radii) = (Curve::Bezier([bud.at, middle, tip]), [bud.radius, 0.65 * bud.radius]);
        let reference = bud.direction.cross(bend);
        self.add(Kind::Tube, piece(Patch::new(Tube { curve, radii, reference }, [6, 10]), self.bark));
        self.add(Kind::Tube, piece(Sphere { centre: tip, radius: radii[1] }, self.bark));
        if bud.forks == 0 {
            return self.leaves(&curve, reference, bud.length);
        }
        let direction = (tip - middle).normalize();
        let first = TAU * self.random.unit();
        for i in 0..FORKS {
            let around = first + TAU * (f64::from(i) + 0.3 * self.random.unit()) / f64::from(FORKS);
            let side = across(direction, around);
            let lean = 0.55 + 0.25 * self.random.unit();
            let part = 0.62 + 0.16 * self.random.unit();
            self.branch(Bud {
                at: tip,
                direction: (lean.cos() * direction + lean.sin() * side).normalize(),
                length: part * bud.length,
                radius: radii[1],
                forks: bud.forks - 1,
            });
        }
    }

    fn leaves(&mut self, branch: &Curve, reference: DVec3, length: f64) {
        for i in 0..LEAVES {
            let frame = branch.frame((f64::from(i) + 1.0) / f64::from(LEAVES), reference);
            let side = self.aside(frame.tangent);
            let direction = (0.6 * frame.tangent + side).normalize();
            let size = length * (0.5 + 0.2 * self.random.unit());
            let droop = DVec3::new(0.0, -0.15 * size, 0.0);
            let (from, to) = (frame.point[0], frame.point[0] + size * direction);
            let curve = Curve::Bezier([from, 0.5 * (from + to), to + droop]);
            let reference = frame.tangent.cross(side);
            let ribbon = Ribbon { curve, half: 0.2 * size, ends: 0.05, twist: 0.8, reference };
            self.add(Kind::Ribbon, piece(Patch::new(ribbon, [8, 4]), self.leaf));
        }
    }

    /// A random unit vector perpendicular to `direction`.
    fn aside(&mut self, direction: DVec3) -> DVec3 {
        across(direction, TAU * self.random.unit())
    }
}

/// The unit vector perpendicular to another, at an angle around it.
fn across(direction: DVec3, around: f64) -> DVec3 {
    let (a, b) = direction.any_orthonormal_pair();
    around.cos() * a + around.sin() * b
}
