//! Summary of an estimation.

use super::Estimated;
use crate::thousands;

impl Estimated {
    /// One line on the estimated and removed attributes; `None` if there are none.
    pub fn summary(&self) -> Option<String> {
        let counts = self;
        let some = |count: u64| (count > 0).then(|| thousands(count));
        let normals = sources(counts.normals_from_faces, counts.normals_from_neighbours);
        let contradictory = some(counts.normals_contradictory);
        let radii = sources(counts.radii_from_faces, counts.radii_from_neighbours);
        let two_sided = some(counts.two_sided).filter(|_| normals.is_some());
        let scattered = some(counts.scattered);
        let billboards = some(counts.billboards);
        let found = some(counts.scanner_found);
        let turned = some(counts.triangles_turned);
        let replaced = some(counts.vertices_replaced);
        let outliers = some(counts.outliers);
        let unused = some(counts.unused);
        let bounded = some(counts.bounded);
        let clipped = some(counts.clipped);
        let along = some(counts.line_radii_from_lines);
        let thin = some(counts.line_radii_from_extent);
        let parts = [
            normals.map(|text| format!("normals of {text}")),
            contradictory.map(|count| {
                format!("{count} normals of the file replaced, as their sides contradict each other")
            }),
            radii.map(|text| format!("radii of {text}")),
            two_sided.map(|count| format!("{count} two-sided")),
            scattered.map(|count| format!("{count} normals unlike their neighbours'")),
            billboards.map(|count| format!("{count} on no surface, as discs that face the eye")),
            found.map(|count| {
                format!("0,0,0 taken for the scanner of {count}, as their directions are a grid")
            }),
            turned.map(|count| {
                format!("{count} triangles turned round, as their surface is wound inwards or inconsistently")
            }),
            replaced.map(|count| format!("ellipses on the triangles in the place of {count} vertices")),
            outliers.map(|count| format!("{count} outliers left out")),
            unused.map(|count| format!("{count} that no face uses left out")),
            bounded.map(|count| format!("{count} clipped at boundaries of the mesh")),
            clipped.map(|count| format!("{count} clipped at sharp edges")),
            along.map(|count| format!("radii of {count} vertices of lines from others of their line")),
            thin.map(|count| {
                format!(
                    "radii of {count} vertices of lines from the lines' extent, as no line radius is given"
                )
            }),
        ];
        let parts: Vec<_> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }
}

/// `5 points from faces, 3 from neighbours`.
fn sources(faces: u64, neighbours: u64) -> Option<String> {
    let [of_faces, of_neighbours] = [faces, neighbours].map(thousands);
    match (faces, neighbours) {
        (0, 0) => None,
        (_, 0) => Some(format!("{of_faces} points from faces")),
        (0, _) => Some(format!("{of_neighbours} points from neighbours")),
        _ => Some(format!("{of_faces} points from faces, {of_neighbours} from neighbours")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_estimated_is_one_line_and_nothing_is_none() {
        let given = Estimated { normals_given: 5, radii_given: 5, two_sided: 2, ..Default::default() };
        assert_eq!(given.summary(), None);
        let mixed = Estimated {
            normals_from_faces: 34_834,
            normals_from_neighbours: 1113,
            radii_from_neighbours: 35_947,
            two_sided: 210,
            billboards: 12,
            ..Default::default()
        };
        let line = "normals of 34,834 points from faces, 1,113 from neighbours; radii of 35,947 points from neighbours; 210 two-sided; \
                    12 on no surface, as discs that face the eye";
        assert_eq!(mixed.summary().as_deref(), Some(line));
        let replaced =
            Estimated { normals_from_neighbours: 9, normals_contradictory: 9, ..Default::default() };
        let line = "normals of 9 points from neighbours; 9 normals of the file replaced, as their sides contradict each other";
        assert_eq!(replaced.summary().as_deref(), Some(line));
        let lines = Estimated { line_radii_from_lines: 2, line_radii_from_extent: 4, ..given };
        let line = "radii of 2 vertices of lines from others of their line; radii of 4 vertices of lines from the lines' extent, \
                    as no line radius is given";
        assert_eq!(lines.summary().as_deref(), Some(line));
        let dropped =
            Estimated { radii_from_faces: 3, outliers: 1, clipped: 7, unused: 2, bounded: 5, ..given };
        let line = "radii of 3 points from faces; 1 outliers left out; 2 that no face uses left out; 5 clipped at boundaries of the mesh; \
                    7 clipped at sharp edges";
        assert_eq!(dropped.summary().as_deref(), Some(line));
    }
}
