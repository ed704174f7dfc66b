//! The list of built-in scenes, with their parameters and viewpoints.

use super::edges::Edge;
use super::models;
use super::query::{Parameter, Query, Values};
use super::surface::Piece;
use crate::error::Result;
use crate::geometry::{Bounds, Camera};
use glam::DVec3;

/// Most points of a scene: the memory of a large machine.
const MOST_POINTS: u64 = 100_000_000;

/// A built-in scene.
#[derive(Clone, Copy)]
pub struct SceneInfo {
    /// Name, including `scene:`.
    pub name: &'static str,
    /// Description.
    pub summary: &'static str,
    /// Recommended viewpoint.
    pub viewpoint: Viewpoint,
    /// Parameters of its surface.
    pub surface_parameters: &'static [Parameter],
    pub(super) build: fn(&Query) -> Vec<Piece>,
    /// Sharp edges and boundaries for clip lines, if the scene has any.
    pub(super) edges: Option<fn(&Query) -> Vec<Edge>>,
}

/// Position and direction of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Position.
    pub eye: [f64; 3],
    /// Point looked at.
    pub target: [f64; 3],
    /// Up vector.
    pub up: [f64; 3],
    /// Vertical field of view, degrees.
    pub fov_y_deg: f64,
}

impl Viewpoint {
    /// The camera of a picture with this aspect ratio that shows `bounds`.
    pub fn camera(&self, aspect: f64, bounds: &Bounds) -> Result<Camera> {
        let [eye, target, up] = [self.eye, self.target, self.up].map(DVec3::from);
        let near = Camera::near_for(eye, bounds);
        Camera::look_at(eye, target, up, self.fov_y_deg.to_radians(), aspect, near)
    }
}

impl SceneInfo {
    /// The parameters: those of the samples, then those of the surface.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> + use<> {
        SAMPLING.iter().chain(self.surface_parameters)
    }

    /// The sharp edges and boundaries at which discs end, if `query` asks for them.
    pub(super) fn edges(&self, query: &Query) -> Vec<Edge> {
        self.edges.filter(|_| query.word(CLIPS_NAME) == "on").map_or_else(Vec::new, |edges| edges(query))
    }
}

/// Sampling parameters, common to all scenes.
pub const SAMPLING: &[Parameter] = &[
    Parameter {
        name: "points",
        default: "100000",
        values: Values::Whole(1, MOST_POINTS),
        meaning: "number of surfels",
    },
    Parameter {
        name: "seed",
        default: "1",
        values: Values::Whole(0, u64::MAX),
        meaning: "seed of the samples",
    },
    Parameter {
        name: "sampler",
        default: "jittered",
        values: Values::Choice(&["jittered", "blue-noise", "grid", "scanner"]),
        meaning: "how the surface is sampled",
    },
    Parameter {
        name: "noise",
        default: "0",
        values: Values::Number(0.0, 100.0),
        meaning: "standard deviation by which surfels are moved along their normals (scanner: along the rays), spacings",
    },
    Parameter {
        name: "scans",
        default: "3",
        values: Values::Whole(1, 64),
        meaning: "scanner: number of places from which it scans",
    },
    Parameter {
        name: "outliers",
        default: "0",
        values: Values::Number(0.0, 0.5),
        meaning: "scanner: part of the surfels that float in front of the surface",
    },
];

/// Parameter of scenes with sharp edges or a boundary.
const CLIPS: Parameter = Parameter {
    name: CLIPS_NAME,
    default: "on",
    values: Values::Choice(&["on", "off"]),
    meaning: "whether discs end at sharp edges and boundaries",
};
/// Name of the parameter for clip lines.
const CLIPS_NAME: &str = "clips";

/// Parameter of scenes that have lines or polygons.
const PRIMITIVES: Parameter = Parameter {
    name: PRIMITIVES_NAME,
    default: "off",
    values: Values::Choice(&["on", "off", "triangles"]),
    meaning: "whether tubes and ribbons are lines or triangles, and boxes and floors triangles, rather than surfels",
};
/// Name of the parameter for lines and polygons.
pub(super) const PRIMITIVES_NAME: &str = "primitives";
/// Number of segments of lines and polygons.
const SEGMENTS: Parameter = Parameter {
    name: "segments",
    default: "32",
    values: Values::Whole(1, 4096),
    meaning: "segments of each line, and of each side of a polygon",
};

const fn albedo(default: &'static str) -> Parameter {
    let values = Values::Choice(&["checker", "stripes", "zone", "gaussian", "noise", "plain"]);
    Parameter { name: "albedo", default, values, meaning: "texture" }
}

const fn frequency(default: &'static str) -> Parameter {
    let meaning =
        "periods of the texture in a unit of length; of the zone plate at distance 1; of the Gaussian 1 / σ";
    Parameter { name: "frequency", default, values: Values::Number(0.0, 1e6), meaning }
}

const fn number(
    name: &'static str,
    default: &'static str,
    range: [f64; 2],
    meaning: &'static str,
) -> Parameter {
    Parameter { name, default, values: Values::Number(range[0], range[1]), meaning }
}

const fn whole(
    name: &'static str,
    default: &'static str,
    range: [u64; 2],
    meaning: &'static str,
) -> Parameter {
    Parameter { name, default, values: Values::Whole(range[0], range[1]), meaning }
}

const fn view(eye: [f64; 3], target: [f64; 3], fov_y_deg: f64) -> Viewpoint {
    Viewpoint { eye, target, up: [0.0, 1.0, 0.0], fov_y_deg }
}

/// 3.5 normalize(1, 0.8, 1.6), the viewpoint of comparisons with the bumpy sphere.
const COMPARISON: [f64; 3] = [1.707_825_127_659_933, 1.366_260_102_127_946_3, 2.732_520_204_255_892_7];

/// Every built-in scene.
pub fn list() -> &'static [SceneInfo] {
    SCENES
}

const SCENES: &[SceneInfo] = &[
    SceneInfo {
        name: "scene:bumpy-sphere",
        summary: "a sphere of radius 1 with bumps",
        viewpoint: view(COMPARISON, [0.0; 3], 45.0),
        // 8 / π: 16 squares from pole to pole.
        surface_parameters: &[albedo("checker"), frequency("2.5464790894703255")],
        build: models::bumpy_sphere,
        edges: None,
    },
    SceneInfo {
        name: "scene:sphere",
        summary: "a sphere of radius 1",
        viewpoint: view(COMPARISON, [0.0; 3], 45.0),
        surface_parameters: &[albedo("checker"), frequency("2.5464790894703255")],
        build: models::sphere,
        edges: None,
    },
    SceneInfo {
        name: "scene:disc",
        summary: "a flat disc of radius 1, seen at a flat angle from nearby; a single surfel is the disc itself",
        viewpoint: view([0.0, 0.45, 1.35], [0.0, -0.15, 0.3], 100.0),
        surface_parameters: &[albedo("gaussian"), frequency("2"), CLIPS],
        build: models::disc,
        edges: Some(models::disc_edges),
    },
    SceneInfo {
        name: "scene:torus",
        summary: "a torus of radius 1",
        viewpoint: view([1.4, 2.6, 2.4], [0.0; 3], 45.0),
        surface_parameters: &[
            albedo("checker"),
            // 15 / 2π: 15 periods around the axis, 6 around the tube.
            frequency("2.3873241463784303"),
            number("minor", "0.4", [0.01, 0.99], "radius of its tube"),
        ],
        build: models::torus,
        edges: None,
    },
    SceneInfo {
        name: "scene:plane",
        summary: "a checkerboard to the horizon, for an eye at height 1 above its middle; denser near that",
        viewpoint: view([0.0, 1.0, 0.0], [0.0, 0.7, -1.0], 60.0),
        surface_parameters: &[
            albedo("checker"),
            frequency("0.5"),
            number("radius", "1000", [1.0, 1e6], "where it ends"),
        ],
        build: models::plane,
        edges: None,
    },
    SceneInfo {
        name: "scene:part",
        summary: "a block with a step, a slot and a bore: sharp edges and corners, convex and concave",
        viewpoint: view([1.9, 2.0, 3.2], [0.0; 3], 40.0),
        surface_parameters: &[albedo("plain"), frequency("4"), CLIPS],
        build: models::part,
        edges: Some(models::part_edges),
    },
    SceneInfo {
        name: "scene:ribbon",
        summary: "a twisted ribbon of length 3, open",
        viewpoint: view([0.8, 1.2, 3.6], [0.0; 3], 45.0),
        surface_parameters: &[
            albedo("checker"),
            frequency("4"),
            number("twists", "1.5", [0.0, 20.0], "turns from end to end"),
            number("width", "0.8", [0.001, 2.0], "width"),
            PRIMITIVES,
            SEGMENTS,
        ],
        build: models::ribbon,
        edges: None,
    },
    SceneInfo {
        name: "scene:helix",
        summary: "a tapered tube along a helix",
        viewpoint: view([1.4, 1.6, 3.0], [0.0; 3], 45.0),
        surface_parameters: &[
            albedo("stripes"),
            frequency("4"),
            number("turns", "3", [1.0, 20.0], "turns; the tube is as thick as they allow"),
            PRIMITIVES,
            SEGMENTS,
        ],
        build: models::helix,
        edges: None,
    },
    SceneInfo {
        name: "scene:slabs",
        summary: "thin level squares of side 2, close together, each in another colour",
        viewpoint: view([2.6, 1.4, 3.0], [0.3, -0.05, 0.3], 48.0),
        surface_parameters: &[
            albedo("plain"),
            frequency("4"),
            whole("slabs", "3", [1, 32], "how many"),
            number("gap", "0.02", [1e-6, 1.0], "distance between them"),
            number("thickness", "0.01", [1e-6, 1.0], "thickness of each"),
            CLIPS,
        ],
        build: models::slabs,
        edges: Some(models::slabs_edges),
    },
    SceneInfo {
        name: "scene:relief",
        summary: "a relief, 12 wide, that fills the picture at a grazing angle",
        viewpoint: view([0.0, 2.07, 7.73], [0.0; 3], 12.0),
        surface_parameters: &[
            albedo("checker"),
            frequency("2"),
            number("height", "0.15", [0.0, 0.5], "greatest height above its middle plane"),
        ],
        build: models::relief,
        edges: None,
    },
    SceneInfo {
        name: "scene:tree",
        summary: "a tree of tubes with ribbons for leaves",
        viewpoint: view([1.8, 2.2, 4.6], [0.0, 1.15, 0.0], 32.0),
        surface_parameters: &[
            albedo("plain"),
            frequency("20"),
            whole("depth", "3", [0, 5], "how often it forks"),
            whole("growth", "1", [0, u64::MAX], "seed of its shape"),
            whole("trees", "1", [1, 25], "how many, in rows of five"),
            PRIMITIVES,
            SEGMENTS,
        ],
        build: models::tree,
        edges: None,
    },
    SceneInfo {
        name: "scene:hybrid",
        summary: "a bent horn, the lower half of which may be triangles",
        viewpoint: view([1.2, 1.0, 3.2], [0.15, 0.0, 0.0], 42.0),
        surface_parameters: &[
            albedo("checker"),
            frequency("3"),
            number(
                "seam",
                "0.04",
                [0.0, 1.0],
                "radius of the triangles' vertices where they meet the points",
            ),
            PRIMITIVES,
            SEGMENTS,
        ],
        build: models::hybrid,
        edges: None,
    },
    SceneInfo {
        name: "scene:mixed",
        summary: "a torus for points, a spring and a ribbon for lines, a floor and a box for polygons",
        viewpoint: view([1.2, 1.9, 3.6], [-0.1, 0.4, 0.0], 43.0),
        surface_parameters: &[albedo("checker"), frequency("5"), PRIMITIVES, SEGMENTS],
        build: models::mixed,
        edges: None,
    },
];
