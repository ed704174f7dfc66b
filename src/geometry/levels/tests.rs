use super::cells::{FEW, LEAST_SHARE};
use super::*;
use crate::geometry::{Bounds, Camera, Colours, Ellipse, Weights, srgb};
use crate::settings::Settings;
use crate::verify::reference::levels::LevelOfDetail;
use crate::verify::scenes;
use glam::{DVec3, Vec3};
use std::collections::HashMap;

fn bumpy(points: u32) -> Surfels {
    scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap()
}

/// Cells of a level of all points, with the points in them.
fn cells(points: &Surfels, side: f32) -> HashMap<IVec3, Vec<usize>> {
    let mut cells: HashMap<IVec3, Vec<usize>> = HashMap::new();
    (0..points.len()).for_each(|i| cells.entry(cell_of(points.positions[i], side)).or_default().push(i));
    cells
}

#[test]
fn every_surfel_is_the_mean_of_the_points_in_its_cell() {
    let points = bumpy(30_000);
    let levels = Levels::of(points.clone()).unwrap();
    assert_eq!(levels.points(), 0..points.len());
    levels.surfels.check().unwrap();
    assert_eq!(levels.surfels.count_invalid(), 0);
    let Some(Colours::Srgb8(codes)) = &points.colours else { panic!("the scene has colours") };
    let light = |i: usize| DVec3::from_array([0, 1, 2].map(|c| srgb::decode(f64::from(codes[i][c]) / 255.0)));
    for (number, start) in levels.table.starts().iter().enumerate() {
        let side = levels.table.cell_side(number + 1).unwrap();
        let end = levels.table.starts().get(number + 1).map_or(levels.surfels.len(), |end| *end as usize);
        let mut cells = cells(&points, side);
        let level = *start as usize..end;
        let mut sides: HashMap<IVec3, usize> = HashMap::new();
        level
            .clone()
            .for_each(|i| *sides.entry(cell_of(levels.surfels.positions[i], side)).or_default() += 1);
        let (mut tested, count) = (0, level.len());
        for i in level {
            assert_eq!(levels.table.level_of(i), number + 1);
            let (position, normal) = (levels.surfels.positions[i], levels.surfels.normals[i]);
            let cell = cell_of(position, side);
            // Each of two surfels in a cell is of some of its points.
            let own = &cells[&cell];
            if sides[&cell] > 1 {
                continue;
            }
            tested += 1;
            let area = |i: usize| f64::from(points.radii[i]).powi(2);
            let total: f64 = own.iter().map(|&i| area(i)).sum();
            let mean =
                |of: &dyn Fn(usize) -> DVec3| own.iter().map(|&i| area(i) * of(i)).sum::<DVec3>() / total;
            let exact = mean(&|i| points.positions[i].as_dvec3());
            assert!(position.as_dvec3().distance(exact) < 1e-6, "{position} {exact}");
            let exact = mean(&|i| points.normals[i].as_dvec3()).normalize();
            assert!(normal.as_dvec3().distance(exact) < 1e-5);
            let Some(Colours::Srgb8(merged)) = &levels.surfels.colours else { panic!("no colours") };
            let exact = mean(&light).to_array().map(|c| srgb::encode8(c as f32));
            assert_eq!(merged[i][..3], exact[..]);
            // A disc of uniform density has variances of a quarter of its squared radius, one and a half of which are the surfel's.
            let variance = |i: usize| {
                let offset = points.positions[i].as_dvec3() - position.as_dvec3();
                let lean = points.normals[i].dot(normal);
                offset.reject_from(normal.as_dvec3()).length_squared()
                    + 0.25 * area(i) * (1.0 + f64::from(lean * lean))
            };
            let variances = own.iter().map(|&i| area(i) * variance(i)).sum::<f64>() / total;
            let radius = 1.5 * (2.0 * variances).sqrt();
            assert!(
                (f64::from(levels.surfels.radii[i]) / radius - 1.0).abs() < 1e-4,
                "{} {radius}",
                levels.surfels.radii[i]
            );
        }
        assert!(2 * tested >= count || count < 2 * FEW, "level {}: {tested} of {count}", number + 1);
        // Every point is in the cell of a surfel.
        (*start as usize..end).for_each(|i| {
            cells.remove(&cell_of(levels.surfels.positions[i], side));
        });
        assert!(cells.is_empty(), "level {}: {} cells lack a surfel", number + 1, cells.len());
    }
}

#[test]
fn levels_are_of_ever_fewer_and_larger_surfels() {
    let points = bumpy(50_000);
    let levels = Levels::of(points.clone()).unwrap();
    let starts = levels.table.starts();
    let mut ends: Vec<usize> = starts.iter().skip(1).map(|start| *start as usize).collect();
    ends.push(levels.surfels.len());
    let counts: Vec<usize> = starts.iter().zip(&ends).map(|(start, end)| end - *start as usize).collect();
    assert!(
        LEAST_SHARE * counts[0] <= points.len() && counts.windows(2).all(|pair| 2 * pair[1] < pair[0]),
        "{counts:?}"
    );
    assert!(counts.len() >= 4 && *counts.last().unwrap() <= FEW, "{counts:?}");
    // All together they add less than half of the points.
    assert!(2 * counts.iter().sum::<usize>() < points.len());
    // Discs overlap: their areas exceed the sphere's, and do not grow with the level.
    for (start, end) in starts.iter().zip(&ends).take(counts.len() - 1) {
        let radii = &levels.surfels.radii[*start as usize..*end];
        let area: f32 = radii.iter().map(|r| std::f32::consts::PI * r * r).sum();
        let sphere = 4.0 * std::f32::consts::PI;
        assert!(area > 1.5 * sphere && area < 6.0 * sphere, "{}", area / sphere);
    }
    let bounds = Bounds::of(&points.positions).unwrap();
    let all = Bounds::of(&levels.surfels.positions).unwrap();
    assert!(bounds.min.cmple(all.min).all() && bounds.max.cmpge(all.max).all());
}

#[test]
fn both_sides_of_a_sheet_stay_and_streams_are_as_long_as_the_surfels() {
    let mut sheet = scenes::open("scene:plane?points=5000").unwrap();
    let back = Surfels { normals: sheet.normals.iter().map(|n| -*n).collect(), ..sheet.clone() };
    sheet.positions.extend(&back.positions);
    sheet.normals.extend(&back.normals);
    sheet.radii.extend(&back.radii);
    sheet.colours = None;
    sheet.ellipses = Some(sheet.normals.iter().map(|n| Ellipse::circle(*n)).collect());
    sheet.curvatures = Some(vec![Default::default(); sheet.len()]);
    sheet.two_sided = Some(vec![false; sheet.len()]);
    sheet.point_indices = Some((0..sheet.len() as u32).collect());
    let levels = Levels::of(sheet).unwrap();
    levels.surfels.check().unwrap();
    let aggregated = levels.points().end..levels.surfels.len();
    let front =
        levels.surfels.normals[aggregated.clone()].iter().filter(|n| n.dot(back.normals[0]) < 0.0).count();
    assert_eq!(2 * front, aggregated.len());
}

/// Billboards above a plane: their levels are billboards of at most the area of all, and the plane's are surfels of its normal.
#[test]
fn billboards_become_billboards_of_their_area() {
    let mut points = scenes::open("scene:plane?points=5000").unwrap();
    let normal = points.normals[0];
    let raised = Surfels {
        positions: points.positions.iter().map(|p| *p + 0.1 * normal * p.x).collect(),
        normals: vec![Vec3::ZERO; points.len()],
        radii: points.radii.iter().map(|radius| 0.1 * radius).collect(),
        ..Surfels::default()
    };
    points.positions.extend(&raised.positions);
    points.normals.extend(&raised.normals);
    points.radii.extend(&raised.radii);
    points.colours = None;
    let levels = Levels::of(points.clone()).unwrap();
    assert_eq!(levels.surfels.count_invalid(), 0);
    let area = |surfels: &Surfels, range: Range<usize>| {
        let own = range.filter(|&i| surfels.is_billboard(i)).map(|i| f64::from(surfels.radii[i]).powi(2));
        own.fold((0, 0.0), |(count, sum), area| (count + 1, sum + area))
    };
    let (_, whole) = area(&points, 0..points.len());
    let starts = levels.table.starts();
    for (number, start) in starts.iter().enumerate() {
        let end = starts.get(number + 1).map_or(levels.surfels.len(), |end| *end as usize);
        let (count, sum) = area(&levels.surfels, *start as usize..end);
        assert!(
            count > 0 && (sum / whole - 1.0).abs() < 1e-3,
            "level {}: {count}, {}",
            number + 1,
            sum / whole
        );
        let others = (*start as usize..end).filter(|&i| !levels.surfels.is_billboard(i));
        assert!(others.map(|i| levels.surfels.normals[i]).all(|n| n.dot(normal) > 0.999));
    }
}

/// A heap of billboards that hide each other is no larger than its extent.
#[test]
fn billboards_in_a_heap_become_no_larger_than_the_heap() {
    let mut heap = bumpy(5_000);
    (heap.normals, heap.colours) = (vec![Vec3::ZERO; heap.len()], None);
    heap.radii.fill(0.5);
    let levels = Levels::of(heap).unwrap();
    let largest = levels.surfels.radii.iter().copied().fold(0.0, f32::max);
    assert!((1.0..3.0).contains(&largest), "{largest}");
}

#[test]
fn few_points_have_no_levels_and_weights_are_refused() {
    let few = bumpy(100);
    let levels = Levels::of(few.clone()).unwrap();
    assert_eq!((levels.surfels, levels.table), (few.clone(), LevelTable::default()));
    let mut coincident = bumpy(1_000);
    coincident.positions.fill(Vec3::new(0.3, 2.0, -1.0));
    let levels = Levels::of(coincident).unwrap();
    assert!(levels.table.starts().len() <= 1 && levels.surfels.len() <= 1_002);
    let weights = Some(Weights::collect((0..100).map(|_| (1.0, None))));
    let error = Levels::of(Surfels { weights, ..few }).unwrap_err().to_string();
    assert!(error.contains("weights"), "{error}");
    let mut broken = bumpy(1_000);
    (broken.positions[3].x, broken.radii[7]) = (f32::NAN, 0.0);
    let levels = Levels::of(broken).unwrap();
    assert_eq!(levels.surfels.count_invalid(), 2);
}

#[test]
fn scenes_of_any_size_and_far_from_the_origin_have_levels() {
    for (scale, offset) in [(1e-25, Vec3::ZERO), (1e12, Vec3::ZERO), (1.0, Vec3::new(1e5, -3e4, 2e5))] {
        let mut points = bumpy(20_000);
        points.positions.iter_mut().for_each(|p| *p = *p * scale + offset);
        points.radii.iter_mut().for_each(|r| *r *= scale);
        let levels = Levels::of(points).unwrap();
        levels.surfels.check().unwrap();
        assert_eq!(levels.surfels.count_invalid(), 0, "{scale}");
        let starts = levels.table.starts();
        assert!(starts.len() >= 3, "{scale}: {starts:?}");
        for (number, start) in starts.iter().enumerate() {
            let side = levels.table.cell_side(number + 1).unwrap();
            let end = starts.get(number + 1).map_or(levels.surfels.len(), |end| *end as usize);
            let mut cells: HashMap<IVec3, usize> = HashMap::new();
            let positions = &levels.surfels.positions[*start as usize..end];
            positions.iter().for_each(|p| *cells.entry(cell_of(*p, side)).or_default() += 1);
            // Rounding takes no surfel out of its cell.
            assert!(cells.values().all(|count| *count <= 2), "{scale}, level {}", number + 1);
        }
    }
}

#[test]
fn no_more_are_drawn_than_the_bound_says() {
    let levels = Levels::of(bumpy(100_000)).unwrap();
    let size = [640, 480];
    let looking =
        |eye| Camera::look_at(eye, DVec3::new(0.2, 0.1, 0.0), DVec3::Y, 0.8, 4.0 / 3.0, 1e-3).unwrap();
    let side = [DVec3::new(2.0, 1.6, 3.2), DVec3::ZERO, DVec3::Y];
    let cameras = [
        looking(side[0]),
        looking(DVec3::new(0.9, 0.55, 0.8)),
        looking(DVec3::new(0.2, 0.1, 0.3)),
        looking(20.0 * side[0]),
        Camera::orthographic(side, 2.6, 4.0 / 3.0, [0.1, 9.0]).unwrap(),
    ];
    for (view, camera) in cameras.iter().enumerate() {
        let bound = levels.table.most_drawn(levels.surfels.len() as u64, DVec3::ZERO, camera, size);
        assert_eq!(MostDrawn::lods().next(), Some(0.0));
        let mut before = u64::MAX;
        for lod in MostDrawn::lods().step_by(3).chain([0.3, 5.1]) {
            let settings = Settings { lod, ..Settings::default() };
            let detail = LevelOfDetail::new(camera, size, &settings).unwrap();
            let clip = camera.world_to_clip();
            let is_seen = |i: &usize| {
                let at = clip * levels.surfels.positions[*i].as_dvec3().extend(1.0);
                at.w > 0.0 && at.x.abs() < at.w && at.y.abs() < at.w
            };
            let is_drawn = |i: &usize| detail.decision(&levels.surfels, &levels.table, *i).0;
            let all = (0..levels.surfels.len()).filter(is_drawn);
            let drawn = all.filter(is_seen).count() as u64;
            let most = bound.at(lod);
            assert!(drawn <= most, "view {view}, {lod} px: {drawn} of at most {most}");
            // Boxes at the border count as a whole.
            assert!(most <= 3 * drawn + 2_000, "view {view}, {lod} px: {drawn} of at most {most}");
            if lod != 0.3 && lod != 5.1 {
                assert!(most <= before, "view {view}, {lod} px: {most} after {before}");
                assert!(bound.least_lod(most) <= lod);
                before = most;
            }
        }
        assert_eq!(bound.clone().with(&MostDrawn::all(7)).at(2.0), bound.at(2.0) + 7);
        assert_eq!(bound.least_lod(0), MostDrawn::lods().last().unwrap());
    }
}

#[test]
fn building_reports_every_point_and_can_be_cancelled() {
    use std::sync::atomic::{AtomicU64, Ordering};

    struct Until(AtomicU64, u64);

    impl crate::Progress for Until {
        fn at(&self, stage: &'static str, done: u64, total: u64) {
            assert_eq!((stage, total), ("building levels of detail", 30_000));
            self.0.fetch_max(done, Ordering::Relaxed);
        }

        fn is_cancelled(&self) -> bool {
            self.0.load(Ordering::Relaxed) >= self.1
        }
    }

    let whole = Until(AtomicU64::new(0), u64::MAX);
    assert_eq!(Levels::build(bumpy(30_000), &whole).unwrap(), Levels::of(bumpy(30_000)).unwrap());
    assert_eq!(whole.0.load(Ordering::Relaxed), 30_000);
    let some = Until(AtomicU64::new(0), 3_000);
    assert!(matches!(Levels::build(bumpy(30_000), &some), Err(Error::Cancelled)));
    assert!(some.0.load(Ordering::Relaxed) < 30_000);
}
