//! A leaf, blades, branches and trunks whose lines are known.

use super::*;
use crate::estimate::Estimate;
use crate::geometry::{Colours, Model, Primitives};
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// A mesh whose triangles each bring their own corners, as plant modellers write them.
#[derive(Default)]
struct Soup {
    positions: Vec<Vec3>,
    codes: Vec<[u8; 4]>,
}

const GREEN: [u8; 4] = [10, 200, 20, 0];
const BROWN: [u8; 4] = [90, 60, 30, 0];

impl Soup {
    fn triangle(&mut self, corners: [Vec3; 3], code: [u8; 4]) {
        self.positions.extend(corners);
        self.codes.extend([code; 3]);
    }

    fn quad(&mut self, [a, b, c, d]: [Vec3; 4], code: [u8; 4]) {
        self.triangle([a, b, c], code);
        self.triangle([a, c, d], code);
    }

    /// The leaf of the paper's figure 12: four triangles between a tip, two pairs and a tip, along x from `base`.
    fn leaf(&mut self, base: Vec3) {
        let [tip, a, b, c, d, end] =
            [[0.0, 0.0], [1.0, -0.5], [1.0, 0.5], [2.0, -0.25], [2.0, 0.25], [3.0, 0.0]]
                .map(|[x, y]| base + Vec3::new(x, y, 0.0));
        self.triangle([tip, a, b], GREEN);
        self.quad([a, c, d, b], GREEN);
        self.triangle([c, end, d], GREEN);
    }

    /// Rings of so many corners about centres on the z axis, and the sides between them.
    fn tube(&mut self, at: Vec3, corners: u8, rings: &[[f32; 2]]) {
        let place = |[z, radius]: [f32; 2], i: u8| {
            let angle = TAU * f32::from(i % corners) / f32::from(corners);
            at + Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        for pair in rings.windows(2) {
            for i in 0..corners {
                let [a, b] = [pair[0], pair[1]];
                self.quad([place(a, i), place(a, i + 1), place(b, i + 1), place(b, i)], BROWN);
            }
        }
    }

    fn cloud(self) -> Cloud {
        Cloud {
            triangles: (0..self.positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            positions: self.positions,
            colours: Some(Colours::Srgb8(self.codes)),
            ..Default::default()
        }
    }

    fn lines(self, thickest: f32) -> (Primitives, Lined) {
        let (cloud, lined) = self.cloud().to_lines(&ToLines { thickest: Some(thickest) }).unwrap();
        let (Model { surfels, primitives }, _) = cloud.into_model(true, &Estimate::default(), &()).unwrap();
        assert!(surfels.is_empty());
        (primitives, lined)
    }
}

fn near(a: Vec3, b: Vec3) -> bool {
    a.distance(b) < 1e-5
}

/// Radius of a tube for a ring of so many corners.
fn mean(radius: f32, corners: u8) -> f32 {
    let angle = PI / f32::from(corners);
    radius * angle.sin() / angle
}

#[test]
fn a_leaf_is_a_ribbon_of_four_vertices() {
    let mut soup = Soup::default();
    soup.leaf(Vec3::new(0.0, 0.0, 7.0));
    let (leaf, lined) = soup.lines(1.0);
    assert_eq!((lined.leaves, lined.branches, lined.vertices), ([4, 3], [0, 0], [12, 4]));
    // From either tip.
    let mut rows: Vec<_> = leaf.positions.iter().zip(&leaf.radii).map(|(p, r)| (p.x, p.y, p.z, *r)).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(
        rows,
        [(0.0, 0.0, 7.0, 0.0005), (1.0, 0.0, 7.0, 0.5), (2.0, 0.0, 7.0, 0.25), (3.0, 0.0, 7.0, 0.0005)]
    );
    assert!(leaf.directions.iter().all(|n| near(*n, Vec3::Z)), "{leaf:?}");
    assert_eq!((leaf.ribbons, leaf.tubes.len(), leaf.triangles.len()), (vec![[0, 1], [1, 2], [2, 3]], 0, 0));
    assert_eq!(leaf.colours, Some(Colours::Srgb8(vec![GREEN; 4])));
}

#[test]
fn a_blade_has_blunt_ends_and_sides_need_not_have_as_many_vertices() {
    let at = |x: f32, y: f32| Vec3::new(x, 0.0, y);
    let mut soup = Soup::default();
    for x in [0.0, 1.0, 2.0] {
        soup.quad([at(x, 0.0), at(x + 1.0, 0.0), at(x + 1.0, 0.5), at(x, 0.5)], GREEN);
    }
    let (blade, lined) = soup.lines(1.0);
    assert_eq!(lined.leaves, [6, 3]);
    assert!(blade.radii.iter().all(|r| (r - 0.25).abs() < 1e-6), "{blade:?}");
    let mut xs: Vec<f32> = blade.positions.iter().map(|p| p.x).collect();
    xs.sort_by(f32::total_cmp);
    assert_eq!(xs, [0.0, 1.0, 2.0, 3.0]);
    assert!(blade.positions.iter().all(|p| p.z == 0.25 && p.y == 0.0), "{blade:?}");
    // A straight side and a bent one.
    let mut soup = Soup::default();
    let [tip, end, a, b] = [at(0.0, 0.0), at(4.0, 0.0), at(1.0, 1.0), at(3.0, 1.0)];
    soup.triangle([tip, at(2.0, 0.0), a], GREEN);
    soup.triangle([at(2.0, 0.0), b, a], GREEN);
    soup.triangle([at(2.0, 0.0), end, b], GREEN);
    let (half, lined) = soup.lines(1.0);
    assert_eq!((lined.leaves, half.len()), ([3, 3], 4));
    assert!(half.radii.iter().all(|r| *r < 0.6), "{half:?}");
}

#[test]
fn a_branch_is_a_tube_along_its_rings() {
    let rings = [[0.0, 0.5], [1.0, 0.4], [2.0, 0.3], [3.5, 0.2]];
    for corners in [3, 5] {
        let mut soup = Soup::default();
        soup.tube(Vec3::X, corners, &rings);
        let (branch, lined) = soup.lines(1.0);
        assert_eq!((lined.branches, lined.triangles), ([6 * u64::from(corners), 3], 6 * u64::from(corners)));
        assert_eq!(
            (branch.len(), branch.tubes.len(), branch.ribbons.len(), branch.triangles.len()),
            (4, 3, 0, 0)
        );
        for [z, radius] in rings {
            let at = branch.positions.iter().position(|p| near(*p, Vec3::new(1.0, 0.0, z))).unwrap();
            assert!((branch.radii[at] - mean(radius, corners)).abs() < 1e-5, "{branch:?}");
            assert!(near(branch.directions[at].abs(), Vec3::Z), "{branch:?}");
        }
        assert_eq!(branch.colours, Some(Colours::Srgb8(vec![BROWN; 4])));
    }
}

#[test]
fn corners_that_rounding_has_moved_are_one() {
    let mut soup = Soup::default();
    soup.tube(Vec3::X, 5, &[[0.0, 0.5], [1.0, 0.5], [2.0, 0.5]]);
    let ulps = |(i, p): (usize, &mut Vec3)| *p *= 1.0 + (i % 3) as f32 * f32::EPSILON;
    soup.positions.iter_mut().enumerate().for_each(ulps);
    assert_eq!(soup.lines(1.0).1.branches, [20, 2]);
}

#[test]
fn a_branch_ends_in_a_point_or_a_lid() {
    let rings = [[0.0, 0.0], [1.0, 0.25], [2.0, 0.25], [3.0, 0.25], [3.0, 0.0]];
    let mut soup = Soup::default();
    soup.tube(Vec3::ZERO, 6, &rings);
    let (branch, lined) = soup.lines(1.0);
    assert_eq!((lined.branches[1], branch.tubes.len()), (3, 3));
    let tip = branch.positions.iter().position(|p| near(*p, Vec3::ZERO)).unwrap();
    assert!(branch.radii[tip] > 0.0 && branch.radii[tip] < 0.001, "{branch:?}");
    assert_eq!(branch.triangles.len(), 0);
    let mut soup = Soup::default();
    soup.tube(Vec3::ZERO, 6, &[[0.0, 0.0], [0.0, 0.25], [2.0, 0.25], [3.0, 0.25], [3.0, 0.0]]);
    let (branch, lined) = soup.lines(1.0);
    assert_eq!((lined.branches, branch.tubes.len(), branch.triangles.len()), ([36, 2], 2, 0));
}

#[test]
fn trunks_balls_and_plates_stay() {
    let ball: Vec<_> =
        (0u8..=8).map(|i| PI / 8.0 * f32::from(i)).map(|a| [-a.cos(), a.sin().max(0.0)]).collect();
    let meshes: [(&[[f32; 2]], f32); 4] = [
        (&[[0.0, 0.5], [1.0, 0.5], [2.0, 0.5], [3.0, 0.5]], 0.4),
        (&[[0.0, 0.5], [0.5, 0.5], [1.0, 0.5]], 9.0),
        (&[[0.0, 0.5], [0.0, 0.4], [0.0, 0.3]], 9.0),
        (&ball, 9.0),
    ];
    for (rings, thickest) in meshes {
        let mut soup = Soup::default();
        soup.tube(Vec3::ZERO, 8, rings);
        let triangles = soup.positions.len();
        let (mesh, lined) = soup.lines(thickest);
        assert_eq!((lined.leaves, lined.branches, mesh.tubes.len()), ([0, 0], [0, 0], 0), "{rings:?}");
        assert!(mesh.triangles.len() == lined.triangles as usize && mesh.triangles.len() > 15, "{triangles}");
    }
}

#[test]
fn a_plant_becomes_all_three_and_thick_rings_keep_their_triangles() {
    let mut soup = Soup::default();
    // Thick for two segments, thin for four.
    let rings = [[0.0, 2.0], [3.0, 1.5], [6.0, 0.5], [9.0, 0.4], [12.0, 0.3], [15.0, 0.2]];
    soup.tube(Vec3::ZERO, 6, &rings);
    // Its stalk is at a corner of a ring.
    soup.leaf(Vec3::new(0.4, 0.0, 9.0));
    soup.leaf(Vec3::new(0.3, 0.0, 12.0));
    let (cloud, lined) = soup.cloud().to_lines(&ToLines { thickest: Some(1.0) }).unwrap();
    assert_eq!((lined.triangles, lined.leaves, lined.branches), (68, [8, 6], [36, 3]));
    assert_eq!((cloud.ribbons.len(), cloud.tubes.len(), cloud.triangles.len()), (6, 3, 24));
    assert_eq!(lined.vertices, [204, 72 + 8 + 4]);
    assert_eq!(cloud.len() as u64, lined.vertices[1]);
    // The trunk's corners are as they were.
    let highest =
        cloud.triangles.iter().flatten().map(|&i| cloud.positions[i as usize].z).fold(0.0, f32::max);
    assert_eq!(highest, 6.0);
    let unchanged = cloud.to_lines(&ToLines { thickest: Some(1.0) }).unwrap();
    assert_eq!((unchanged.0, unchanged.1.leaves), (cloud, [0, 0]));
}

#[test]
fn points_and_lines_stay_and_twins_go() {
    let mut soup = Soup::default();
    soup.leaf(Vec3::ZERO);
    soup.leaf(Vec3::ZERO);
    let mut cloud = soup.cloud();
    cloud.positions.extend([Vec3::splat(9.0), Vec3::splat(8.0), Vec3::splat(7.0)]);
    cloud.colours = None;
    cloud.tubes = vec![[24, 25]];
    let (lines, lined) = cloud.to_lines(&ToLines::default()).unwrap();
    assert_eq!((lined.triangles, lined.leaves, lines.len()), (4, [4, 3], 7));
    assert_eq!((lines.tubes, lines.positions[2]), (vec![[0, 1]], Vec3::splat(7.0)));
    let none = Cloud::default().to_lines(&ToLines::default()).unwrap();
    assert_eq!(none.1, Lined::default());
}
