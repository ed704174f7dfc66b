//! Viewpoints of a subject, relative to its own.

use crate::geometry::Bounds;
use crate::settings::Choice;
use crate::verify::scenes::Viewpoint;
use glam::{DQuat, DVec3};

/// Where a picture is taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Place {
    /// The subject's own: that of `surfel render` without options, or of `surfel scenes`.
    #[default]
    Own,
    /// The subject's own, moved.
    Moved(Move),
    /// Another.
    Given(Viewpoint),
}

/// A move away from the subject's own viewpoint.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    strum::EnumMessage,
    strum::IntoStaticStr,
    strum::VariantArray,
    strum::EnumString,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Move {
    /// Turned by 90° to the right about the up axis through the centre of the bounds.
    Right,
    /// Turned by 180° about the same axis.
    Behind,
    /// Turned by 90° to the left about the same axis.
    Left,
    /// From 75° above the horizon, at the same distance from the centre of the bounds.
    Above,
    /// At a third of the distance from the point looked at.
    Near,
    /// At eight times the distance from the point looked at.
    Far,
    /// From the centre of the bounds, in the same direction.
    Inside,
}

/// Elevation of [`Move::Above`], degrees.
const ELEVATION: f64 = 75.0;

impl Place {
    /// Its name in results.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Own => OWN,
            Self::Moved(how) => how.name(),
            Self::Given(_) => "given",
        }
    }

    /// The viewpoint, for a subject with this viewpoint and these bounds.
    pub fn viewpoint(&self, own: &Viewpoint, bounds: &Bounds) -> Viewpoint {
        match self {
            Self::Own => *own,
            Self::Moved(how) => how.apply(own, bounds.centre()),
            Self::Given(viewpoint) => *viewpoint,
        }
    }
}

/// Name of [`Place::Own`].
pub const OWN: &str = "own";

impl Move {
    fn apply(self, own: &Viewpoint, centre: DVec3) -> Viewpoint {
        let [eye, target, up] = [own.eye, own.target, own.up].map(DVec3::from);
        let up = up.normalize_or(DVec3::Y);
        let along = target - eye;
        let turned = |degrees: f64| {
            let turn = DQuat::from_axis_angle(up, degrees.to_radians());
            [eye, target].map(|point| centre + turn * (point - centre))
        };
        let [eye, target] = match self {
            Self::Right => turned(90.0),
            Self::Behind => turned(180.0),
            Self::Left => turned(-90.0),
            Self::Above => {
                let from = eye - centre;
                let level = from.reject_from_normalized(up).normalize_or(up.any_orthonormal_vector());
                let (sin, cos) = ELEVATION.to_radians().sin_cos();
                [centre + from.length() * (sin * up + cos * level), centre]
            }
            Self::Near => [target - along / 3.0, target],
            Self::Far => [target - 8.0 * along, target],
            Self::Inside => [centre, centre + along],
        };
        Viewpoint { eye: eye.to_array(), target: target.to_array(), ..*own }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::VariantArray;

    const OWN: Viewpoint =
        Viewpoint { eye: [1.0, 2.0, 5.0], target: [1.0, 2.0, 3.0], up: [0.0, 1.0, 0.0], fov_y_deg: 45.0 };

    fn moved(how: Move) -> [DVec3; 2] {
        let bounds = Bounds::of_box(DVec3::new(0.0, 1.0, 2.0), DVec3::new(2.0, 3.0, 4.0));
        let found = Place::Moved(how).viewpoint(&OWN, &bounds);
        [found.eye, found.target].map(DVec3::from)
    }

    #[test]
    fn moves_go_where_they_say() {
        let centre = DVec3::new(1.0, 2.0, 3.0);
        let expected = [
            (Move::Right, DVec3::new(2.0, 0.0, 0.0)),
            (Move::Behind, DVec3::new(0.0, 0.0, -2.0)),
            (Move::Left, DVec3::new(-2.0, 0.0, 0.0)),
            (Move::Near, DVec3::new(0.0, 0.0, 2.0 / 3.0)),
            (Move::Far, DVec3::new(0.0, 0.0, 16.0)),
            (Move::Inside, DVec3::ZERO),
        ];
        for (how, offset) in expected {
            assert!((moved(how)[0] - centre).abs_diff_eq(offset, 1e-12), "{how:?} {:?}", moved(how));
        }
        let [above, target] = moved(Move::Above);
        assert!((above.distance(centre) - 2.0).abs() < 1e-12 && target == centre);
        assert!((above - centre).angle_between(DVec3::Y).to_degrees() - 15.0 < 1e-9);
        // Every move but the one inside looks at the centre, as the own viewpoint does.
        for how in Move::VARIANTS.iter().filter(|how| **how != Move::Inside) {
            assert!(moved(*how)[1].abs_diff_eq(centre, 1e-12), "{how:?}");
        }
        assert_eq!(moved(Move::Inside)[1], centre + DVec3::new(0.0, 0.0, -2.0));
    }
}
