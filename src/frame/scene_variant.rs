//! Variants of scenes: the keys of pipelines over their surfels, lines and triangles.

use super::pass::Scope;
use super::variant::Variant;
use crate::scene::{ColourStream, PrimitiveKinds, Streams, SurfelLayout};
use crate::settings::splatting::Footprint;
use crate::vk::Constants;
use crate::vk::shaders::{Resource, constant, resource};

/// Key of the pipelines over a scene's surfels, lines and triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SceneVariant {
    /// Variant of the frame.
    pub frame: Variant,
    /// Surfels are ellipses.
    pub ellipses: bool,
    /// Curvatures are stored with the normals, and discs of the frame end where convex surfaces turn away.
    pub curvatures: bool,
    /// Curvatures are stored with the normals, and the frame sums normals of fields.
    pub normal_fields: bool,
    /// Some discs have clip lines.
    pub clips: bool,
    /// Some surfels are two-sided, so never culled as back faces.
    pub two_sided: bool,
    /// Some surfels are billboards.
    pub billboards: bool,
    /// Kernels are multiplied by the scene's normalization weights.
    pub weights: bool,
    /// Some weights are at the corners of surfels' squares.
    pub corners: bool,
    /// Format of the summed colours.
    pub colours: ColourStream,
    /// Optional streams of the scene, bound in all frames: its descriptor sets do not depend on the settings.
    pub stored: StoredStreams,
    /// Lines and triangles, and the format of their colours.
    pub primitives: PrimitiveKinds,
    /// Offsets and strides of surfel streams.
    pub layout: SurfelLayout,
    /// Colour format, if shaders validate surfels.
    pub unchecked: Option<ColourStream>,
    /// Scenes are instanced, each with its own axes and unit.
    pub instanced: bool,
    /// Splats are in another order than the scene's surfels, which are in arbitrary order.
    pub unordered: bool,
    /// The scene has bounds of its clusters, and the frame culls these.
    pub bounded: bool,
    /// Some surfels stand for others from afar.
    pub levels: bool,
}

/// Optional streams that a scene has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StoredStreams {
    /// Colours of surfels.
    pub colours: bool,
    /// Normalization weights.
    pub weights: bool,
    /// Colours of the vertices of lines and triangles.
    pub vertex_colours: bool,
}

impl SceneVariant {
    /// The variant of a scene with `streams`.
    pub fn new(frame: Variant, streams: Streams, instanced: bool) -> Self {
        let weights = streams.weights.filter(|_| frame.weights);
        let blended = |colours| if frame.blends_colours() { colours } else { ColourStream::None };
        let reads = frame.blends_colours() || frame.texture.is_some();
        let has = |colours| colours != ColourStream::None;
        Self {
            stored: StoredStreams {
                colours: has(streams.colours),
                weights: streams.weights.is_some(),
                vertex_colours: has(streams.primitives.colours),
            },
            frame,
            ellipses: streams.ellipses,
            curvatures: streams.curvatures && frame.curvatures,
            normal_fields: streams.curvatures && frame.normal_fields,
            clips: streams.clips && frame.footprint != Footprint::Point,
            two_sided: streams.two_sided,
            billboards: streams.billboards,
            weights: weights.is_some(),
            corners: weights == Some(true),
            colours: blended(streams.colours),
            primitives: PrimitiveKinds { colours: blended(streams.primitives.colours), ..streams.primitives },
            // Pipelines that read no colours do not depend on their layout.
            layout: match reads || streams.unchecked {
                true => streams.layout,
                false => SurfelLayout {
                    colours: SurfelLayout::side_by_side(ColourStream::None).colours,
                    ..streams.layout
                },
            },
            unchecked: streams.unchecked.then_some(streams.colours),
            instanced,
            unordered: streams.unordered && frame.is_tiled(),
            bounded: streams.clusters && frame.clusters,
            levels: streams.levels,
        }
    }

    /// Resources of descriptor set 0.
    pub fn resources(&self, scope: Scope) -> Vec<&'static Resource> {
        let frame = &self.frame;
        let splats = frame.pull_push.is_none();
        let clips = splats && self.clips;
        let optional: &[(&'static Resource, bool)] = match scope {
            Scope::View => return frame.view_resources(),
            Scope::Surfels => &[
                (&resource::POSITIONS, !self.layout.is_quantized()),
                (&resource::LATTICE_POSITIONS, self.layout.is_quantized()),
                (&resource::NORMALS, true),
                (&resource::RADII, !self.layout.is_quantized()),
                (&resource::LATTICES, self.layout.is_quantized()),
                (&resource::COLOURS, self.stored.colours),
                (&resource::ELLIPSES, self.ellipses),
                (&resource::WEIGHTS, self.stored.weights),
                (&resource::CLIPS, clips),
                (&resource::SCREEN_CLIPS, clips),
                (&resource::SPLATS, splats),
                (&resource::ORDER, self.unordered),
                (&resource::VISIBLE_CLUSTERS, frame.clusters),
                (&resource::SPLAT_BOXES, frame.is_tiled()),
                (&resource::SPLAT_ATTRIBUTES, frame.is_tiled()),
            ],
            Scope::Clusters => &[
                (&resource::CLUSTERS, self.bounded),
                (&resource::GROUPS, true),
                (&resource::VISIBLE_CLUSTERS, true),
                (&resource::HIDDEN_CLUSTERS, frame.occlusion_culling),
            ],
            Scope::Lines | Scope::Triangles => &[
                (&resource::VERTICES, true),
                (&resource::LINE_DIRECTIONS, self.primitives.lines),
                (&resource::VERTEX_COLOURS, self.stored.vertex_colours),
                (&resource::ELEMENTS, true),
                (&resource::LARGE_TRIANGLES, self.primitives.triangles),
            ],
        };
        let bound = optional.iter().filter(|(_, bound)| *bound).map(|(resource, _)| *resource);
        [&resource::FRAME, &resource::VIEWS].into_iter().chain(bound).collect()
    }

    /// Specialization constants, with those of the frame.
    pub fn constants(&self) -> Constants {
        self.layout
            .add_to(self.frame.constants())
            .with(constant::UNCHECKED, self.unchecked.is_some())
            .with(constant::STORED_COLOURS, self.unchecked.map_or(0, |colours| colours as u32))
            .with(constant::ELLIPSES, self.ellipses)
            .with(constant::TWO_SIDED, self.two_sided)
            .with(constant::BILLBOARDS, self.billboards)
            .with(constant::HAS_LEVELS, self.levels)
            .with(constant::CURVATURES, self.curvatures)
            .with(constant::NORMAL_FIELDS, self.normal_fields)
            .with(constant::CLIPS, self.clips)
            .with(constant::BEYOND_CLIPS, self.frame.coverage && self.clips)
            .with(constant::WEIGHTS, self.weights)
            .with(constant::CORNERS, self.corners)
            .with(constant::COLOURS, self.colours as u32)
            .with(constant::VERTEX_COLOURS, self.primitives.colours as u32)
            .with(constant::INSTANCED, self.instanced)
            .with(constant::UNORDERED, self.unordered)
    }
}
