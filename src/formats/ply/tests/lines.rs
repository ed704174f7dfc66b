//! Edges and polylines.

use super::*;

const EDGE: &str = "property int vertex1\nproperty int vertex2";

/// Four points one apart along x, with and without more in the header and behind the points.
fn line(more: &str, records: &str) -> Loaded {
    load(&text(
        &format!("element vertex 4\n{XYZ}\n{more}"),
        &format!("0 0 0\n1 0 0\n2 0 0\n3 0 0\n{records}"),
    ))
}

#[test]
fn edges_are_tubes_and_what_is_none_is_left_out() {
    let all = "0 1\n3 2\n1 1\n2 4\n-1 0\n2147483647 0\n1 0\n";
    let Loaded { cloud, report, .. } = line(&format!("element edge 7\n{EDGE}"), all);
    assert_eq!((cloud.tubes, cloud.ribbons.len()), (vec![[0, 1], [3, 2], [1, 0]], 0));
    assert_eq!(report.lines, Lines { understood: 3, skipped: 4, sides: 0 });
    assert!(report.skipped_elements.is_empty());
    let other = line("element edge 1\nproperty int vertex1\nproperty int end", "0 1").report;
    assert_eq!((other.lines, other.skipped_elements), (Lines::default(), vec!["edge".to_owned()]));
}

#[test]
fn edges_follow_when_points_are_dropped_and_those_without_length_are_none() {
    let (edge, vertex) = (format!("element edge 4\n{EDGE}"), format!("element vertex 4\n{XYZ}"));
    let (edges, points) = ("0 2\n0 1\n2 3\n0 3\n", "0 0 0\nnan 0 0\n1 1 0\n1 1 0\n");
    let after = load(&text(&format!("{vertex}\n{edge}"), &format!("{points}{edges}")));
    let before = load(&text(&format!("{edge}\n{vertex}"), &format!("{edges}{points}")));
    for Loaded { cloud, report, .. } in [after, before] {
        assert_eq!((cloud.len(), cloud.tubes), (3, vec![[0, 1], [0, 2]]));
        assert_eq!(report.lines, Lines { understood: 2, skipped: 2, sides: 0 });
    }
}

#[test]
fn two_normals_make_a_ribbon_unless_it_says_that_it_is_a_tube() {
    let points = "0 0 0 0 0 2 1\n1 0 0 0 0 1 1\n2 0 0 0 1 0 1\n3 0 0 0 0 0 1\n";
    let of = |more: &str, records: &str| {
        let header = format!("element vertex 4\n{FLOATS}element edge 3\n{EDGE}{more}");
        load(&text(&header, &format!("{points}{records}"))).cloud
    };
    let plain = of("", "0 1\n2 1\n2 3\n");
    assert_eq!((plain.ribbons, plain.tubes), (vec![[0, 1], [2, 1]], vec![[2, 3]]));
    let declared = of("\nproperty uchar tube", "0 1 1\n1 2 0\n2 3 0\n");
    assert_eq!((declared.ribbons, declared.tubes), (vec![[1, 2]], vec![[0, 1], [2, 3]]));
}

#[test]
fn polylines_restart() {
    for name in ["polyline", "linestrips"] {
        let lists = "5 0 1 2 -1 3\n4 3 2 9 0\n1 0\n0\n";
        let header = format!("element {name} 4\nproperty list uchar int vertex_indices");
        let Loaded { cloud, report, .. } = line(&header, lists);
        assert_eq!(cloud.tubes, [[0, 1], [1, 2], [3, 2]]);
        assert_eq!(report.lines, Lines { understood: 3, skipped: 2, sides: 0 });
    }
    let lists = line("element edge 2\nproperty list int int vertex_index", "2 0 1\n3 1 2 3");
    assert_eq!(lists.cloud.tubes, [[0, 1], [1, 2], [2, 3]]);
}

#[test]
fn edges_that_are_sides_of_faces_are_no_lines_unless_they_say_so() {
    let of = |kind: &str, edges: &str| {
        let header = format!(
            "element edge 3\n{EDGE}{kind}\nelement vertex 4\n{XYZ}\nelement face 1\nproperty list uchar int vertex_indices"
        );
        load(&text(&header, &format!("{edges}0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n")))
    };
    let hybrid = of("", "1 0\n0 3\n2 1\n");
    assert_eq!((hybrid.cloud.tubes, hybrid.report.lines.sides), (vec![[0, 3]], 2));
    assert_eq!(hybrid.cloud.triangles, [[0, 1, 2]]);
    let declared = of("\nproperty uchar tube", "1 0 1\n0 3 1\n2 1 1\n");
    assert_eq!((declared.cloud.tubes.len(), declared.report.lines.sides), (3, 0));
    let strip = "element polyline 1\nproperty list uchar int vertex_indices";
    let header =
        format!("element vertex 4\n{XYZ}\n{strip}\nelement face 1\nproperty list uchar int vertex_indices");
    let strip = load(&text(&header, &format!("{}3 0 1 2\n3 0 1 2\n", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n")));
    assert_eq!((strip.cloud.tubes.len(), strip.report.lines.sides), (2, 0));
}

#[test]
fn triangles_stay_beside_lines_alone() {
    let of = |edge: &str| {
        let face = "element face 1\nproperty list uchar int vertex_indices";
        let header = format!("element vertex 4\n{FLOATS}element edge 1\n{EDGE}\n{face}");
        let points = "0 0 0 0 0 1 1\n1 0 0 0 0 1 1\n0 1 0 0 0 1 1\n0 0 1 0 0 1 1\n";
        load(&text(&header, &format!("{points}{edge}\n3 0 1 2\n"))).cloud
    };
    assert_eq!((of("0 3").triangles.len(), of("0 1").triangles.len()), (1, 0));
}

#[test]
fn diameters_and_tangents_are_those_of_files_with_lines() {
    let of = |edges: usize, records: &str| {
        let more = "property double diameter\nproperty float tx\nproperty float ty\nproperty float tz";
        let header = format!("element vertex 2\n{XYZ}\n{more}\nelement edge {edges}\n{EDGE}");
        load(&text(&header, &format!("0 0 0 3 0 0 2\n1 0 0 -1 0 0 0\n{records}")))
    };
    let Loaded { cloud, report, .. } = of(1, "0 1");
    assert_eq!((cloud.radii, cloud.tangents), (Some(vec![1.5, 0.0]), Some(vec![Vec3::Z, Vec3::ZERO])));
    assert!(report.skipped.is_empty());
    let Loaded { cloud, report, .. } = of(0, "");
    assert_eq!((cloud.radii, cloud.tangents, report.skipped.len()), (None, None, 4));
}
