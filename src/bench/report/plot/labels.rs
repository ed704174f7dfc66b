//! Layout of texts by their estimated width: an SVG's viewer chooses the font.

/// A rectangle, px: left, top, right, bottom.
pub type Area = [i32; 4];

/// Mean width of a character relative to the font size, rounded up.
const CHARACTER: f64 = 0.56;

/// Estimated width of a text.
pub fn width(text: &str, font: f64) -> i32 {
    let wide = |c: char| match c {
        'i' | 'l' | 'j' | 'f' | 't' | '.' | ',' | ' ' | '(' | ')' | '|' => 0.35,
        '⁰'..='₉' | '¹' | '²' | '³' => 0.4,
        'm' | 'M' | 'W' | 'w' => 0.9,
        _ => CHARACTER,
    };
    (text.chars().map(wide).sum::<f64>() * font).ceil() as i32
}

/// Breaks a text at spaces into lines of at most `most` px; a longer word is a line of its own.
pub fn wrap(text: &str, font: f64, most: i32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), font) <= most => *line += &format!(" {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Occupied areas.
#[derive(Debug, Default)]
pub struct Occupied(Vec<Area>);

impl Occupied {
    /// Marks an area as occupied.
    pub fn add(&mut self, area: Area) {
        self.0.push(area);
    }

    /// Occupies the first area that is free and inside `within`, and returns it.
    pub fn first_free(&mut self, places: impl IntoIterator<Item = Area>, within: Area) -> Option<Area> {
        let inside =
            |a: &Area| a[0] >= within[0] && a[1] >= within[1] && a[2] <= within[2] && a[3] <= within[3];
        let apart = |a: &Area, b: &Area| a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
        let free = places.into_iter().find(|a| inside(a) && self.0.iter().all(|b| apart(a, b)))?;
        self.0.push(free);
        Some(free)
    }
}

/// Breaks entries into rows of at most `most`: row and left edge of each, and the number of rows.
pub fn rows(widths: &[i32], gap: i32, most: i32) -> (Vec<(i32, i32)>, i32) {
    let (mut row, mut left) = (0, 0);
    let mut places = Vec::new();
    for &width in widths {
        if left > 0 && left + width > most {
            (row, left) = (row + 1, 0);
        }
        places.push((row, left));
        left += width + gap;
    }
    let count = if widths.is_empty() { 0 } else { row + 1 };
    (places, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_do_not_collide() {
        let within = [0, 0, 100, 100];
        let mut occupied = Occupied::default();
        occupied.add([40, 40, 60, 60]);
        let places = [[50, 50, 70, 60], [60, 40, 80, 50], [0, 0, 5, 5]];
        assert_eq!(occupied.first_free(places, within), Some(places[1]));
        assert_eq!(occupied.first_free(places, within), Some(places[2]));
        assert_eq!(occupied.first_free([[90, 0, 101, 5]], within), None);
    }

    #[test]
    fn texts_break_at_spaces() {
        let all = width("one two", 10.0);
        assert_eq!(wrap("one two three", 10.0, all), ["one two", "three"]);
        assert_eq!(wrap("one two", 10.0, all - 1), ["one", "two"]);
        assert_eq!(wrap("incomprehensibilities", 10.0, 5), ["incomprehensibilities"]);
    }

    #[test]
    fn a_legend_breaks_where_it_is_too_wide() {
        let (places, count) = rows(&[40, 40, 40], 10, 95);
        assert_eq!((places, count), (vec![(0, 0), (0, 50), (1, 0)], 2));
        assert_eq!(rows(&[], 10, 95).1, 0);
        assert_eq!(rows(&[200], 10, 95), (vec![(0, 0)], 1));
    }
}
