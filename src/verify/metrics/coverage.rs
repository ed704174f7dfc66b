//! Coverage of the silhouettes. A pixel is covered as [`covers`] defines.
//!
//! - Intersection over union of the silhouettes (Jaccard, *Étude comparative de la distribution florale*, 1901): 0 to
//!   1, no unit, more is better; 1 if neither picture covers anything.
//! - Holes: pixels that the truth covers and the picture does not, at the outline or inside.
//! - Bloat: pixels that the picture covers and the truth does not.
//!
//! Holes and bloat are given in px, as the number of connected regions, and as the px of the largest region; less is
//! better.

pub use super::regions::Regions;
use super::{Pair, covers};

/// Comparison of two silhouettes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Pixels that the picture covers.
    pub picture: u64,
    /// Pixels that the truth covers.
    pub truth: u64,
    /// Intersection over union.
    pub iou: f64,
    /// Pixels that only the truth covers.
    pub holes: Regions,
    /// Pixels that only the picture covers.
    pub bloat: Regions,
}

/// Compares the silhouettes.
pub fn coverage(pair: &Pair<'_>) -> Coverage {
    let masks = [pair.picture(), pair.truth()]
        .map(|picture| (0..pair.pixels()).map(|i| covers(picture, i)).collect::<Vec<_>>());
    let [ours, truth] = &masks;
    let count = |mask: &[bool]| mask.iter().filter(|covered| **covered).count() as u64;
    let only = |a: &[bool], b: &[bool]| {
        Regions::of(a.iter().zip(b).map(|(a, b)| *a && !b).collect(), pair.size()[0] as usize)
    };
    let (bloat, holes) = (only(ours, truth), only(truth, ours));
    let (ours, truth) = (count(ours), count(truth));
    let union = truth + bloat.pixels;
    let iou = if union == 0 { 1.0 } else { (truth - holes.pixels) as f64 / union as f64 };
    Coverage { picture: ours, truth, iou, holes, bloat }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    fn mask(rows: &[&str]) -> Picture {
        let alpha = |byte| if byte == b'#' { 1.0 } else { 0.0 };
        let colour = rows.concat().bytes().map(|byte| [0.0, 0.0, 0.0, alpha(byte)]).collect();
        Picture { size: [rows[0].len() as u32, rows.len() as u32], colour, ..Default::default() }
    }

    fn of(picture: &[&str], truth: &[&str]) -> Coverage {
        let (picture, truth) = (mask(picture), mask(truth));
        coverage(&Pair::new(&picture, &truth).unwrap())
    }

    #[test]
    fn silhouettes_are_compared() {
        let truth = [".####.", ".####.", ".####.", "......"];
        let same = of(&truth, &truth);
        assert_eq!((same.iou, same.holes, same.bloat), (1.0, Regions::default(), Regions::default()));
        let found = of(&["#.##..", ".####.", ".#.#..", "......"], &truth);
        let expected = Coverage {
            picture: 9,
            truth: 12,
            iou: 8.0 / 13.0,
            holes: Regions { pixels: 4, count: 4, largest: 1 },
            bloat: Regions { pixels: 1, count: 1, largest: 1 },
        };
        assert_eq!(found, expected);
        // With the pictures exchanged, holes become bloat.
        let back = of(&truth, &["#.##..", ".####.", ".#.#..", "......"]);
        assert_eq!((back.iou, back.holes, back.bloat), (found.iou, found.bloat, found.holes));
    }

    #[test]
    fn nothing_agrees_with_nothing_and_disagrees_with_something() {
        assert_eq!(of(&[".."], &[".."]).iou, 1.0);
        let missing = of(&[".."], &["##"]);
        assert_eq!((missing.iou, missing.holes.pixels, missing.holes.largest), (0.0, 2, 2));
        assert_eq!(of(&["#."], &[".#"]).iou, 0.0);
    }
}
