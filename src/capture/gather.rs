//! What the views saw, and the weights that it makes: medians, as the paper has it, against the noise.

/// What one view says of a surfel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub surfel: u32,
    /// Σw at its centre.
    pub sum: f32,
    /// Where it looks like a border: Σw at the corners of its square, 0 where the surface has ended, `None` where that is not seen.
    pub corners: Option<[Option<f32>; 4]>,
}

/// What all views say.
#[derive(Default)]
pub(super) struct Samples {
    sums: Vec<(u32, f32)>,
    corners: Vec<(u32, [Option<f32>; 4])>,
}

/// Weights of the surfels that were seen.
pub(super) struct Medians(Vec<(u32, f32, Option<[f32; 4]>)>);

impl Samples {
    /// Adds a view's.
    pub fn add(&mut self, samples: Vec<Sample>) {
        self.sums.extend(samples.iter().map(|sample| (sample.surfel, sample.sum)));
        self.corners.extend(samples.iter().filter_map(|sample| Some((sample.surfel, sample.corners?))));
    }

    /// The weights by the medians of the sums. A surfel is at a border if most of its views say so.
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
            (surfel, 1.0 / sum, border.map(|border| corner_weights(1.0 / sum, border)))
        };
        Medians(self.sums.chunk_by(|a, b| a.0 == b.0).map(of_surfel).collect())
    }
}

impl Medians {
    /// How many surfels were seen.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The weight of a surfel, and at a border those at its corners.
    pub fn get(&self, surfel: usize) -> Option<(f32, Option<[f32; 4]>)> {
        let place = self.0.binary_search_by_key(&surfel, |entry| entry.0 as usize).ok()?;
        let (_, weight, corners) = self.0[place];
        Some((weight, corners))
    }
}

/// From the centre of a surfel's square to a corner the weight may grow by this factor; beyond, kernels run out there, and the inverse of
/// what they leave is steeper than anything bilinear.
const MOST_GROWTH: f32 = 2.0;

/// Weights at the corners of a surfel whose weight at the centre is `centre`. Where the surface has ended, or all but, there is no sum to go
/// by: such corners share what makes the mean of all four, which is the bilinear value at the centre, right there.
fn corner_weights(centre: f32, views: &[(u32, [Option<f32>; 4])]) -> [f32; 4] {
    let sums = [0, 1, 2, 3].map(|corner: usize| median(views.iter().filter_map(|(_, sums)| sums[corner])));
    let known = sums.map(|sum| match sum {
        Some(sum) if sum * MOST_GROWTH * centre >= 1.0 => Some(1.0 / sum),
        Some(_) => None,
        None => Some(centre),
    });
    let ended = known.iter().filter(|weight| weight.is_none()).count() as f32;
    let rest = 4.0 * centre - known.iter().flatten().sum::<f32>();
    known.map(|weight| weight.unwrap_or((rest / ended).max(centre)))
}

fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut values: Vec<f32> = values.collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(surfel: u32, sum: f32, corners: Option<[Option<f32>; 4]>) -> Sample {
        Sample { surfel, sum, corners }
    }

    #[test]
    fn weights_are_by_the_median_and_borders_by_most_views() {
        let ended = Some([Some(4.0), Some(4.0), Some(0.0), Some(0.0)]);
        let mut samples = Samples::default();
        samples.add(vec![sample(7, 2.0, ended), sample(3, 8.0, None), sample(5, 1.0, ended)]);
        samples.add(vec![sample(3, 2.0, ended), sample(7, 1.0, ended)]);
        samples.add(vec![sample(3, 4.0, None), sample(7, 50.0, None)]);
        let medians = samples.medians();
        assert_eq!(medians.len(), 3);
        assert_eq!(medians.get(3), Some((0.25, None)), "one view of three");
        assert_eq!(medians.get(7), Some((0.5, Some([0.25, 0.25, 0.75, 0.75]))));
        assert_eq!(medians.get(5), Some((1.0, Some([0.25, 0.25, 1.75, 1.75]))));
        assert_eq!(medians.get(4), None);
    }

    #[test]
    fn corners_that_are_not_seen_are_as_the_centre() {
        let views = [(0, [Some(8.0), None, Some(0.0), None]), (0, [Some(2.0), None, Some(0.0), None])];
        assert_eq!(corner_weights(0.5, &views), [0.125, 0.5, 0.875, 0.5]);
        // Never less than the centre's.
        assert_eq!(corner_weights(0.5, &[(0, [Some(1.0), Some(1.0), Some(1.0), Some(0.0)])])[3], 0.5);
        // Where hardly anything is left, as where nothing is.
        assert_eq!(
            corner_weights(0.5, &[(0, [Some(4.0), Some(4.0), Some(0.5), Some(0.0)])]),
            [0.25, 0.25, 0.75, 0.75]
        );
    }
}
