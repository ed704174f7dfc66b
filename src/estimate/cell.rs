//! Voronoi cell of a point among its neighbours in the tangent plane: its adjacent points, and the required radius of its disc.

use super::reach::reach;
use glam::DVec2;

/// The neighbours whose cells are adjacent to that of the point at 0, in counter-clockwise order.
pub(super) struct Cell {
    /// Corners, each with the neighbour behind the side that starts there; `None` is the bounding frame.
    corners: Vec<(DVec2, Option<u32>)>,
    spare: Vec<(DVec2, Option<u32>)>,
}

impl Cell {
    /// A cell without neighbours.
    pub fn new() -> Self {
        Self { corners: Vec::new(), spare: Vec::new() }
    }

    /// Computes the cell among `neighbours`, which are best sorted by distance.
    pub fn build(&mut self, neighbours: &[DVec2]) {
        let farthest = neighbours.iter().map(|q| q.length_squared()).fold(0.0, f64::max).sqrt();
        let frame = 4.0 * farthest;
        let corner = |x: f64, y: f64| (DVec2::new(x * frame, y * frame), None);
        self.corners.clear();
        self.corners.extend([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
        for (index, &q) in neighbours.iter().enumerate() {
            self.cut(q, index as u32);
        }
    }

    /// Removes the half-plane that is nearer to `q` than to 0.
    fn cut(&mut self, q: DVec2, index: u32) {
        let half = 0.5 * q.length_squared();
        let excess = |x: DVec2| x.dot(q) - half;
        if half == 0.0 || self.corners.iter().all(|&(x, _)| excess(x) <= 0.0) {
            return;
        }
        self.spare.clear();
        for (i, &(x, side)) in self.corners.iter().enumerate() {
            let next = self.corners[(i + 1) % self.corners.len()].0;
            let (here, there) = (excess(x), excess(next));
            let crossing = || x + (next - x) * (here / (here - there));
            if here <= 0.0 {
                self.spare.push((x, side));
                if there > 0.0 {
                    self.spare.push((crossing(), Some(index)));
                }
            } else if there <= 0.0 {
                self.spare.push((crossing(), side));
            }
        }
        std::mem::swap(&mut self.corners, &mut self.spare);
    }

    /// The adjacent neighbours in order, each with the next; `None` is the frame.
    fn pairs(&self) -> impl Iterator<Item = (Option<u32>, Option<u32>)> {
        let sides = self.corners.iter().map(|&(_, side)| side);
        sides.clone().zip(sides.cycle().skip(1))
    }

    /// The adjacent neighbours in order.
    pub fn neighbours(&self) -> impl Iterator<Item = u32> {
        self.corners.iter().filter_map(|&(_, side)| side)
    }

    /// Whether two consecutive neighbours are more than 120° apart: the surface may end there, or more neighbours are needed.
    pub fn is_open(&self, neighbours: &[DVec2]) -> bool {
        let wide = |a: DVec2, b: DVec2| a.perp_dot(b) <= 0.0 || a.dot(b) < -0.5 * a.length() * b.length();
        self.pairs().any(|pair| match pair {
            (Some(a), Some(b)) => wide(neighbours[a as usize], neighbours[b as usize]),
            _ => true,
        })
    }

    /// Radius at which the point's disc and its neighbours' cover the triangles between them.
    pub fn reach(&self, neighbours: &[DVec2]) -> f64 {
        let triangles =
            self.pairs().filter_map(|(a, b)| Some((neighbours[a? as usize], neighbours[b? as usize])));
        triangles
            .filter(|(a, b)| a.perp_dot(*b) > 0.0)
            .map(|(a, b)| reach(a.length_squared(), b.length_squared(), a.distance_squared(b)))
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(neighbours: &[DVec2]) -> Cell {
        let mut cell = Cell::new();
        cell.build(neighbours);
        cell
    }

    #[test]
    fn a_square_grid_reaches_to_the_middle_of_its_squares() {
        let around = (-2..=2).flat_map(|y| (-2..=2).map(move |x| DVec2::new(x.into(), y.into())));
        let mut neighbours: Vec<DVec2> = around.filter(|q| *q != DVec2::ZERO).collect();
        neighbours.sort_by(|a, b| a.length().total_cmp(&b.length()));
        let cell = cell(&neighbours);
        assert!(!cell.is_open(&neighbours));
        assert!((cell.reach(&neighbours) - 0.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn at_an_edge_the_cell_is_open_and_reaches_no_further() {
        let around = (0..=2).flat_map(|y| (-2..=2).map(move |x| DVec2::new(x.into(), y.into())));
        let mut neighbours: Vec<DVec2> = around.filter(|q| *q != DVec2::ZERO).collect();
        neighbours.sort_by(|a, b| a.length().total_cmp(&b.length()));
        // A jagged edge, whose far-off Voronoi corners need no cover.
        for q in &mut neighbours {
            q.y += 0.03 * q.x * q.x;
        }
        let cell = cell(&neighbours);
        assert!(cell.is_open(&neighbours));
        assert!(cell.reach(&neighbours) < 0.8, "{}", cell.reach(&neighbours));
    }

    #[test]
    fn scan_lines_reach_half_way_to_the_next_line() {
        let around = (-2..=2).flat_map(|y| (-3..=3).map(move |x| DVec2::new(0.1 * f64::from(x), y.into())));
        let neighbours: Vec<DVec2> = around.filter(|q| *q != DVec2::ZERO).collect();
        assert!((cell(&neighbours).reach(&neighbours) - 0.5_f64.hypot(0.05)).abs() < 1e-12);
        assert!(!cell(&neighbours).is_open(&neighbours));
    }

    #[test]
    fn neighbours_at_the_point_or_none_at_all_do_no_harm() {
        for neighbours in [vec![], vec![DVec2::ZERO], vec![DVec2::X], vec![DVec2::X, -DVec2::X]] {
            let cell = cell(&neighbours);
            assert!(cell.is_open(&neighbours));
            assert_eq!(cell.reach(&neighbours), 0.0);
        }
    }
}
