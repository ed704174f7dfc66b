//! Samples of all views, and their medians, which reduce noise as in the paper.

/// Sample of a surfel in one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub surfel: u32,
    /// Σw at the surfel's centre.
    pub sum: f32,
    /// Weights at the corners of its square, if the view shows a border.
    pub corners: Option<[f32; 4]>,
}

/// Samples of all views.
#[derive(Default)]
pub(super) struct Samples {
    sums: Vec<(u32, f32)>,
    corners: Vec<(u32, [f32; 4])>,
}

/// Weights of the surfels that some view shows.
pub(super) struct Medians(Vec<(u32, f32, Option<[f32; 4]>)>);

impl Samples {
    /// Adds the samples of a view.
    pub fn add(&mut self, samples: Vec<Sample>) {
        self.sums.extend(samples.iter().map(|sample| (sample.surfel, sample.sum)));
        self.corners.extend(samples.iter().filter_map(|sample| Some((sample.surfel, sample.corners?))));
    }

    /// The weights from the medians of the sums. A surfel is at a border if more than half of its views show one.
    pub fn medians(mut self) -> Medians {
        self.sums.sort_unstable_by(|a, b| {
            (a.0, a.1).partial_cmp(&(b.0, b.1)).unwrap_or(std::cmp::Ordering::Equal)
        });
        self.corners.sort_by_key(|(surfel, _)| *surfel);
        let mut borders = self.corners.chunk_by(|a, b| a.0 == b.0).peekable();
        let of_surfel = |seen: &[(u32, f32)]| {
            let (surfel, sum) = seen[seen.len() / 2];
            let border = borders.next_if(|border| border[0].0 == surfel);
            let border = border.filter(|border| 2 * border.len() > seen.len());
            let at =
                |border: &[(u32, [f32; 4])], i: usize| median(border.iter().map(|(_, all)| all[i]).collect());
            (surfel, 1.0 / sum, border.map(|border| [0, 1, 2, 3].map(|i| at(border, i))))
        };
        Medians(self.sums.chunk_by(|a, b| a.0 == b.0).map(of_surfel).collect())
    }
}

impl Medians {
    /// Number of surfels that some view shows.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The weight of a surfel, and at a border its weights at the corners.
    pub fn get(&self, surfel: usize) -> Option<(f32, Option<[f32; 4]>)> {
        let place = self.0.binary_search_by_key(&surfel, |entry| entry.0 as usize).ok()?;
        let (_, weight, corners) = self.0[place];
        Some((weight, corners))
    }
}

fn median(mut values: Vec<f32>) -> f32 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(surfel: u32, sum: f32, corners: Option<[f32; 4]>) -> Sample {
        Sample { surfel, sum, corners }
    }

    #[test]
    fn weights_are_by_the_median_and_borders_by_most_views() {
        let border = |first: f32| Some([first, 0.2, 0.3, 0.4]);
        let mut samples = Samples::default();
        samples.add(vec![sample(7, 2.0, border(0.1)), sample(3, 8.0, None), sample(5, 1.0, border(0.9))]);
        samples.add(vec![sample(3, 2.0, border(0.1)), sample(7, 1.0, border(0.7))]);
        samples.add(vec![sample(3, 4.0, None), sample(7, 50.0, border(0.3)), sample(7, 1.5, None)]);
        let medians = samples.medians();
        assert_eq!(medians.len(), 3);
        assert_eq!(medians.get(3), Some((0.25, None)), "one view of three");
        assert_eq!(medians.get(7), Some((0.5, border(0.3))), "three views of four");
        assert_eq!(medians.get(5), Some((1.0, border(0.9))));
        assert_eq!(medians.get(4), None);
    }
}
