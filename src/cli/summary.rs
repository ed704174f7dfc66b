//! Summary of a model, as text.

use surfel::geometry::Model;

/// Parts of a model: `5 surfels, 2 ribbons`.
pub fn parts(Model { surfels, primitives }: &Model) -> String {
    let others = [
        (&primitives.ribbons.len(), "ribbons"),
        (&primitives.tubes.len(), "tubes"),
        (&primitives.triangles.len(), "triangles"),
    ];
    let others: Vec<_> = others
        .iter()
        .filter(|(count, _)| **count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    match (surfels.len(), others.is_empty()) {
        (0, false) => others.join(", "),
        (count, _) => [vec![format!("{count} surfels")], others].concat().join(", "),
    }
}
