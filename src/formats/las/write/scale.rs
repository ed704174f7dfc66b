//! Scale and offset of written coordinates.

use crate::formats::point_table::PointTable;
use crate::formats::writer::PointSource;
use glam::DVec3;
use rayon::prelude::*;

/// Scale and offset of each axis: a coordinate is the stored integer times the scale, plus the offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    pub factors: DVec3,
    pub summands: DVec3,
}

/// Part of the extent that a step of chosen scales is at most: that of float32.
const STEP: f64 = 1.0 / (1 << 24) as f64;

/// Least factor that is chosen: a multiple and the inverse of it are finite.
const LEAST: f64 = 1e-300;

/// The bounds of stored coordinates, and the largest rounding error of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Stored {
    pub min: DVec3,
    pub max: DVec3,
    pub error: f64,
}

impl Scale {
    /// The scale of the inputs that have one, the finest if they differ, with the first's offset; otherwise, and if that cannot hold all
    /// coordinates, the power of ten that is at most 2⁻²⁴ of the extent, about the middle of the bounds.
    pub fn of(table: &PointTable, [min, max]: [DVec3; 2]) -> Self {
        let own = Self::of_inputs(table.contents.inputs).filter(|own| own.holds(min) && own.holds(max));
        own.unwrap_or_else(|| Self::of_bounds(min, max))
    }

    fn of_inputs(inputs: &[PointSource]) -> Option<Self> {
        let all = inputs.iter().filter_map(|input| input.survey.las.as_ref());
        let all = all.map(|survey| {
            let [x, y, z] = survey.scale();
            Self { factors: DVec3::new(x[0], y[0], z[0]), summands: DVec3::new(x[1], y[1], z[1]) }
        });
        let usable = all.filter(|own| {
            own.factors.is_finite() && own.factors.cmpgt(DVec3::ZERO).all() && own.summands.is_finite()
        });
        usable.reduce(|a, b| Self { factors: a.factors.min(b.factors), summands: a.summands })
    }

    fn of_bounds(min: DVec3, max: DVec3) -> Self {
        let extent = (max - min).max_element();
        if extent == 0.0 {
            return Self { factors: DVec3::splat(0.001), summands: min };
        }
        let factor = 10f64.powf((extent * STEP).log10().floor()).max(LEAST);
        // A round number, so that the offset is short and whole steps stay whole.
        let step = 1e3 * factor;
        let middle = (0.5 * min + 0.5 * max) / step;
        let summands = if middle.is_finite() { middle.round() * step } else { min };
        Self { factors: DVec3::splat(factor), summands }
    }

    /// The stored numbers of a position.
    pub fn stored(&self, position: DVec3) -> DVec3 {
        ((position - self.summands) / self.factors).round()
    }

    /// The position of stored numbers.
    pub fn position(&self, stored: DVec3) -> DVec3 {
        stored * self.factors + self.summands
    }

    fn holds(&self, position: DVec3) -> bool {
        let stored = self.stored(position);
        stored.cmpge(DVec3::splat(f64::from(i32::MIN))).all()
            && stored.cmple(DVec3::splat(f64::from(i32::MAX))).all()
    }

    /// The coordinates as they are stored; `None` without points.
    pub fn bounds(&self, table: &PointTable) -> Option<Stored> {
        let of = |row: usize| {
            let exact = table.position(row);
            let stored = self.position(self.stored(exact));
            Stored { min: stored, max: stored, error: (stored - exact).abs().max_element() }
        };
        (0..table.len()).into_par_iter().map(of).reduce_with(|a, b| Stored {
            min: a.min.min(b.min),
            max: a.max.max(b.max),
            error: a.error.max(b.error),
        })
    }
}

/// The bounds of all positions; 0 without points.
pub fn bounds(table: &PointTable) -> [DVec3; 2] {
    let each = (0..table.len()).into_par_iter().map(|row| [table.position(row); 2]);
    each.reduce_with(|[a, b], [c, d]| [a.min(c), b.max(d)]).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chosen_scales_hold_all_extents() {
        for extent in [1e-30, 1e-9, 0.3, 1.0, 123.0, 9.99e5, 1e30] {
            for middle in [0.0, 4.6e6, -1e9] {
                let at = |part: f64| DVec3::splat(middle + part * extent);
                let scale = Scale::of_bounds(at(-0.5), at(0.5));
                assert!(scale.holds(at(-0.5)) && scale.holds(at(0.5)), "{extent} {middle}: {scale:?}");
                // Without an extent that float64 has, the only coordinate is exact.
                assert!(
                    at(-0.5) == at(0.5) || scale.factors.x <= extent.max(1e-6) * STEP,
                    "{extent} {middle}: {scale:?}"
                );
            }
        }
        let one = Scale::of_bounds(DVec3::splat(0.1), DVec3::splat(0.1));
        assert_eq!(one.position(one.stored(DVec3::splat(0.1))), DVec3::splat(0.1));
        let scale = Scale::of_bounds(DVec3::ZERO, DVec3::new(1.0, 2.0, 100.0));
        assert_eq!(scale, Scale { factors: DVec3::splat(1e-6), summands: DVec3::new(0.5, 1.0, 50.0) });
    }
}
