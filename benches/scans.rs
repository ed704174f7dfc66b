//! Estimation of oriented normals and radii of unordered points without attributes.

mod support;

use support::{Result, Row, Table};
use surfel::bench::format;
use surfel::bench::stopwatch::timed;
use surfel::estimate::Estimate;
use surfel::geometry::Cloud;
use surfel::verify::scenes::bumpy_sphere;

fn main() -> Result<()> {
    let table = Table::new("normals and radii of bare points", None);
    for count in [100_000, 1_000_000] {
        let mut positions = bumpy_sphere::sample(count, 1).positions;
        // The sampler's order is a spiral.
        (1..positions.len()).rev().for_each(|i| positions.swap(i, i * 7919 % (i + 1)));
        let estimate = || {
            let bare = Cloud { positions: positions.clone(), ..Default::default() };
            Ok(timed(|| bare.into_surfels(&Estimate::default(), &()))?.1)
        };
        let what = format!("{} points", format::count(count.into()));
        table.compare(vec![Row::new(what, estimate).of(count as usize, " points/s")])?;
    }
    Ok(())
}
