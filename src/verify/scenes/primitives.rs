//! Lines and polygons of scenes: the pieces that can be drawn so.

use super::catalogue::PRIMITIVES_NAME;
use super::query::Query;
use super::surface::{Kind, Piece};
use crate::geometry::{Colours, Primitives};
use glam::{DVec2, DVec3, Vec3};

/// A point of a centre line.
#[derive(Clone, Copy, Debug)]
pub struct CentrelinePoint {
    /// Where it is.
    pub position: DVec3,
    /// Unit normal of a ribbon, unit tangent of a tube.
    pub direction: DVec3,
    /// Half the width, or the radius.
    pub radius: f64,
}

/// Sides of a tube of triangles: a ring of vertices, "usually three" (marroquim2008 section 4.3).
const RING: usize = 3;

/// The lines and triangles of `pieces`. A tube's caps have no centre line: its lines have round ends.
pub fn primitives(query: &Query, pieces: &[Piece]) -> Primitives {
    let steps = query.whole("segments") as usize;
    let has_lines = query.word(PRIMITIVES_NAME) == "on";
    let mut drawn = Primitives { colours: Some(Colours::Linear(Vec::new())), ..Default::default() };
    for piece in pieces {
        match piece.kind {
            Kind::Surface => {}
            Kind::Tube | Kind::Ribbon if has_lines => line(&mut drawn, piece, steps),
            // What has no centre line is no line either.
            Kind::Tube | Kind::Ribbon if piece.shape.centreline(0.0).is_none() => {}
            Kind::Tube => polygons(&mut drawn, piece, [steps, RING]),
            Kind::Ribbon => polygons(&mut drawn, piece, [steps, 1]),
            Kind::Polygon => polygons(&mut drawn, piece, [steps; 2]),
        }
    }
    drawn
}

fn line(drawn: &mut Primitives, piece: &Piece, steps: usize) {
    let first = drawn.positions.len() as u32;
    for i in 0..=steps {
        let u = i as f64 / steps as f64;
        let Some(middle) = piece.shape.centreline(u) else { return };
        let point = piece.shape.at(DVec2::new(u, 0.5)).point;
        vertex(drawn, middle, piece.texture.at(&point));
    }
    let segments = (first..first + steps as u32).map(|i| [i, i + 1]);
    match piece.kind {
        Kind::Tube => drawn.tubes.extend(segments),
        _ => drawn.ribbons.extend(segments),
    }
}

/// Two triangles for each of `steps` along u and v.
fn polygons(drawn: &mut Primitives, piece: &Piece, steps: [usize; 2]) {
    let (first, side, rows) = (drawn.positions.len() as u32, steps[0] as u32 + 1, steps[1] as u32 + 1);
    for i in 0..side * rows {
        let uv = DVec2::new(f64::from(i % side), f64::from(i / side))
            / DVec2::new(steps[0] as f64, steps[1] as f64);
        let point = piece.shape.at(uv).point;
        let radius = if uv.x == 1.0 { piece.seam } else { 0.0 };
        let corner = CentrelinePoint { position: point.position, direction: point.normal, radius };
        vertex(drawn, corner, piece.texture.at(&point));
    }
    let corners = (0..side * (rows - 1)).filter(|i| i % side + 1 < side).map(|i| first + i);
    drawn.triangles.extend(corners.flat_map(|a| [[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]));
}

fn vertex(drawn: &mut Primitives, vertex: CentrelinePoint, albedo: [f64; 3]) {
    drawn.positions.push(vertex.position.as_vec3());
    drawn.directions.push(Vec3::normalize(vertex.direction.as_vec3()));
    drawn.radii.push(vertex.radius as f32);
    if let Some(Colours::Linear(colours)) = &mut drawn.colours {
        colours.push(albedo.map(|channel| channel as f32));
    }
}
