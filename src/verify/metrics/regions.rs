//! Connected regions of pixels.

/// Number and size of connected regions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Regions {
    /// Number of pixels.
    pub pixels: u64,
    /// Number of connected regions; pixels that touch by a side or a corner are connected.
    pub count: u64,
    /// Pixels of the largest region.
    pub largest: u64,
}

impl Regions {
    /// The regions of the marked pixels of a picture that is `width` px wide.
    pub fn of(mut marked: Vec<bool>, width: usize) -> Self {
        let mut regions = Self::default();
        for start in 0..marked.len() {
            let pixels = erase(&mut marked, width, start);
            regions.pixels += pixels;
            regions.count += u64::from(pixels > 0);
            regions.largest = regions.largest.max(pixels);
        }
        regions
    }
}

/// Unmarks the region of pixel `start`, and returns the number of its pixels.
fn erase(marked: &mut [bool], width: usize, start: usize) -> u64 {
    let height = marked.len() / width;
    let mut pixels = 0;
    let mut open = vec![start];
    while let Some(at) = open.pop() {
        if !std::mem::take(&mut marked[at]) {
            continue;
        }
        pixels += 1;
        let (x, y) = (at % width, at / width);
        for row in y.saturating_sub(1)..(y + 2).min(height) {
            let columns = x.saturating_sub(1)..(x + 2).min(width);
            open.extend(columns.map(|column| row * width + column).filter(|&near| marked[near]));
        }
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: &[&str]) -> [u64; 3] {
        let marked = rows.concat().bytes().map(|byte| byte == b'#').collect();
        let Regions { pixels, count, largest } = Regions::of(marked, rows[0].len());
        [pixels, count, largest]
    }

    #[test]
    fn regions_are_counted() {
        assert_eq!(of(&["....", "...."]), [0, 0, 0]);
        assert_eq!(of(&["####", "####"]), [8, 1, 8]);
        // Pixels that share a corner are connected; the end of a row and the start of the next are not.
        assert_eq!(of(&["#..#", ".#..", "...#", "#..#"]), [6, 4, 2]);
        assert_eq!(of(&[".#", "#."]), [2, 1, 2]);
        assert_eq!(of(&["#.#.#"]), [3, 3, 1]);
        assert_eq!(of(&["#", "#", ".", "#"]), [3, 2, 2]);
        assert_eq!(of(&["###.", "#.#.", "###."]), [8, 1, 8]);
    }
}
