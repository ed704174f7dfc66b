//! What decides which pipelines and targets a frame needs.

use super::pass::Scope;
use super::renderer::RenderOptions;
use crate::scene::{ColourStream, PrimitiveKinds, Streams, SurfelLayout};
use crate::settings::pull_push::{PullPush, Rules, Storage};
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use crate::settings::{Alpha, Cull, Outputs, Precision, Rasterizer, Settings, Shading, Widen};
use crate::vk::Constants;
use crate::vk::shaders::{Resource, constant, resource};

/// The key of targets, and of the pipelines that visit pixels: what the scenes of a frame have together and what the frame wants, and nothing
/// that changes from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Perspective or orthographic.
    pub perspective: bool,
    /// Splats whose normal faces away are dropped.
    pub cull_back: bool,
    /// The image of a disc.
    pub footprint: Footprint,
    /// The kernel is Confetti's.
    pub confetti: bool,
    /// Which splats a pixel sees.
    pub visibility: Visibility,
    /// Points, pyramids of them, and their rules.
    pub pull_push: Option<PullPush>,
    /// What the sums are divided by.
    pub normalization: Normalization,
    /// Kernels are multiplied by normalization weights.
    pub weights: bool,
    /// Splats are lit, not pixels.
    pub shade_splats: bool,
    /// Only axes that are shorter than the low-pass filter are widened by it.
    pub widen_small: bool,
    /// Splats are counted by cull reason.
    pub count: bool,
    /// Normals are summed.
    pub normals: bool,
    /// Depths are summed.
    pub depth: bool,
    /// Colours are summed: a scene's, light, or what stands in for them, where what is summed is not divided.
    pub colours: bool,
    /// Some of the colours may be beyond 1.
    pub unbounded_colours: bool,
    /// There are lines or triangles.
    pub primitives: bool,
    /// Colours are looked up in a texture; how the scene holds its texels.
    pub texture: Option<ColourStream>,
    /// Points shine in their own way, which is looked up by their numbers.
    pub materials: bool,
    /// α is the part of a pixel that is covered.
    pub coverage: bool,
    /// What the picture shows.
    pub shading: Shading,
    /// Directional lights.
    pub lights: u32,
    /// Images beside the picture.
    pub outputs: Outputs,
    /// Float width of the sums, or of the samples.
    pub precision: Precision,
    /// What visits the pixels of splats and points; lines and triangles are always computed.
    pub rasterizer: Rasterizer,
    /// For tiles: visibility, attribute and normalize are passes of their own.
    pub split: bool,
    /// For tiles: their splats are taken in several dispatches, as more may be on a tile than one dispatch takes.
    pub sliced: bool,
    /// For tiles: some discs end at clip lines.
    pub clips: bool,
    /// For tiles: some normalization weights are at the corners of surfels' squares.
    pub corners: bool,
    /// Who rasterizes a tile.
    pub team: Team,
}

/// The invocations that rasterize a tile together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Team {
    /// How many they are: a power of two from 8 to 64.
    pub lanes: u32,
    /// They are a subgroup; otherwise they pass values on by shared memory.
    pub subgroups: bool,
}

impl Team {
    /// The team of devices whose subgroups have so many invocations that can shuffle.
    pub fn of(subgroup_size: u32) -> Self {
        let fits = (8..=64).contains(&subgroup_size) && subgroup_size.is_power_of_two();
        if fits { Self { lanes: subgroup_size, subgroups: true } } else { Self::default() }
    }
}

impl Default for Team {
    /// What every device has.
    fn default() -> Self {
        Self { lanes: 8, subgroups: false }
    }
}

/// The key of the pipelines that visit a scene's own surfels, lines and triangles: what it has and what the frame wants of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SceneVariant {
    /// That of the frame.
    pub frame: Variant,
    /// Discs are ellipses.
    pub ellipses: bool,
    /// Some discs end at clip lines.
    pub clips: bool,
    /// Some surfels are never dropped for facing away.
    pub two_sided: bool,
    /// Kernels are multiplied by the scene's normalization weights.
    pub weights: bool,
    /// Some of these are at the corners of surfels' squares.
    pub corners: bool,
    /// The colours that are summed, in the form in which the scene holds them.
    pub colours: ColourStream,
    /// What its passes see, whether the frame wants it or not: its descriptor sets are the same in all frames.
    pub held: Held,
    /// Lines and triangles, with their colours in the same way.
    pub primitives: PrimitiveKinds,
    /// Where the scene has its surfels' values.
    pub layout: SurfelLayout,
    /// How it holds colours that the shaders have to look at to know what is valid, and whether they have to look at anything.
    pub unchecked: Option<ColourStream>,
    /// There are instances, each seen in its own axes and unit.
    pub instanced: bool,
}

/// Which of the streams that it may lack a scene has, beside those that decide more than what is bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Held {
    /// Colours of surfels.
    pub colours: bool,
    /// Normalization weights.
    pub weights: bool,
    /// Colours of the vertices of lines and triangles.
    pub vertex_colours: bool,
}

impl Variant {
    /// What a frame of scenes that have these `streams` needs.
    pub fn new(
        streams: &[Streams],
        perspective: bool,
        settings: &Settings,
        options: &RenderOptions,
        rasterizer: Rasterizer,
    ) -> Self {
        let shading = settings.shading;
        // Points are none of the splats that could be chosen.
        let splatting = if settings.pull_push.is_some() { Splatting::default() } else { settings.splatting };
        let wants_colour = matches!(shading, Shading::Lit | Shading::Colour);
        let shade_splats = shading == Shading::Lit && splatting.shade == Shade::Splat;
        let robust = settings.pull_push.is_some_and(|pull_push| pull_push.rules == Rules::Robust);
        let texture = streams.iter().find_map(|streams| streams.texture).filter(|_| robust && wants_colour);
        let held: Vec<_> = match wants_colour && texture.is_none() {
            true => streams.iter().flat_map(|own| [own.colours, own.primitives.colours]).collect(),
            false => Vec::new(),
        };
        // How many there are, or what they weigh, is never divided.
        let normalization = match shading {
            Shading::Overlap | Shading::Weight => Normalization::Pixel,
            _ => splatting.normalization,
        };
        let undivided = normalization != Normalization::Pixel && splatting.visibility != Visibility::Nearest;
        let coloured = held.iter().any(|colours| *colours != ColourStream::None);
        let floats = [ColourStream::Linear, ColourStream::Textured, ColourStream::Half];
        let tiled = settings.pull_push.is_none() && rasterizer == Rasterizer::Compute;
        let weights = splatting.normalization == Normalization::Surfel && shading != Shading::Overlap;
        let lit_pixels = shading == Shading::Lit && !shade_splats;
        Self {
            perspective,
            cull_back: settings.cull == Cull::Back,
            footprint: splatting.footprint,
            confetti: splatting.kernel != Kernel::Gaussian,
            visibility: splatting.visibility,
            pull_push: settings.pull_push,
            normalization,
            weights,
            shade_splats,
            widen_small: settings.widen == Widen::Small && splatting.filter != Filter::None,
            count: options.count,
            normals: lit_pixels || shading == Shading::Normal || options.outputs.normal,
            depth: shading == Shading::Depth || options.outputs.depth,
            colours: wants_colour && (undivided || shade_splats || coloured),
            unbounded_colours: held.iter().any(|colours| floats.contains(colours)),
            primitives: streams.iter().any(|streams| streams.primitives.any()),
            texture,
            materials: streams.iter().any(|streams| streams.materials)
                && settings.pull_push.is_some()
                && shading == Shading::Lit,
            coverage: settings.alpha == Alpha::Coverage,
            shading,
            lights: if shading == Shading::Lit { settings.lighting.directional.len() as u32 } else { 0 },
            outputs: options.outputs,
            precision: options.precision,
            rasterizer,
            split: tiled && (options.split || splatting.visibility == Visibility::Axis),
            sliced: false,
            clips: tiled && streams.iter().any(|streams| streams.clips),
            corners: tiled && weights && streams.iter().any(|streams| streams.weights == Some(true)),
            team: Team::default(),
        }
    }

    /// The same with splats that crowd on the picture, or not.
    pub fn crowded(self, crowded: bool) -> Self {
        let sliced = crowded && self.is_tiled();
        Self { sliced, split: self.split || sliced, ..self }
    }

    /// Whether splats are rasterized by tiles.
    pub fn is_tiled(&self) -> bool {
        self.pull_push.is_none() && self.rasterizer == Rasterizer::Compute
    }

    /// Rows of four words that a splat has beside, for tiles: `lib/attributes.glsl`.
    pub fn attribute_rows(&self) -> u64 {
        u64::from(self.wide_sums0() || self.weights)
            + u64::from(self.wide_sums1())
            + 2 * u64::from(self.corners)
    }

    /// Whether pull–push draws surfels as points.
    pub fn draws_points(&self) -> bool {
        self.pull_push.is_some() && self.rasterizer == Rasterizer::Draw
    }

    /// Whether pull–push computes what is nearest: points that are not drawn, lines, triangles.
    pub fn computes_points(&self) -> bool {
        self.pull_push.is_some() && (self.rasterizer == Rasterizer::Compute || self.primitives)
    }

    /// Whether samples of pull–push have the numbers of points.
    pub fn has_ids(&self) -> bool {
        self.outputs.id || self.materials
    }

    /// What passes over pixels see at descriptor set 0.
    pub fn view_resources(&self) -> Vec<&'static Resource> {
        let texture = self.texture.map(|_| &resource::TEXTURE);
        let materials = self.materials.then_some(&resource::MATERIALS);
        let blocks = [Some(&resource::FRAME), Some(&resource::VIEWS)];
        blocks.into_iter().chain([texture, materials]).flatten().collect()
    }

    /// Whether scenes' own colours are summed.
    fn blends_colours(&self) -> bool {
        matches!(self.shading, Shading::Lit | Shading::Colour) && self.texture.is_none()
    }

    /// Whether target 0 sums a vector beside Σw.
    pub fn wide_sums0(&self) -> bool {
        self.normals || self.colours
    }

    /// Whether there is a target 1.
    pub fn has_sums1(&self) -> bool {
        self.depth || self.wide_sums1()
    }

    /// Whether target 1 sums colours beside the depth.
    pub fn wide_sums1(&self) -> bool {
        self.normals && self.colours
    }

    /// The same as specialization constants.
    pub fn constants(&self) -> Constants {
        Constants::default()
            .with(constant::PERSPECTIVE, self.perspective)
            .with(constant::CULL_BACK, self.cull_back)
            .with(constant::COVERAGE, self.coverage)
            .with(constant::TEXTURE, self.texture.is_some())
            .with(constant::TEXELS, self.texture.map_or(0, |texels| texels as u32))
            .with(constant::MATERIALS, self.materials)
            .with(constant::IDS, self.has_ids())
            .with(constant::FOOTPRINT, self.footprint as u32)
            .with(constant::CONFETTI, self.confetti)
            .with(constant::NORMALIZATION, self.normalization as u32)
            .with(constant::SHADE_SPLATS, self.shade_splats)
            .with(constant::PAPER, self.pull_push.is_some_and(|pull_push| pull_push.rules == Rules::Paper))
            .with(
                constant::PING_PONG,
                self.pull_push.is_some_and(|pull_push| pull_push.storage == Storage::PingPong),
            )
            .with(constant::COMPACT, self.pull_push.is_some() && self.precision == Precision::Half)
            .with(constant::UNBOUNDED_COLOURS, self.unbounded_colours)
            .with(constant::OVERLAP, self.shading == Shading::Overlap)
            .with(constant::WIDEN_SMALL, self.widen_small)
            .with(constant::COUNT, self.count)
            .with(constant::SUM_NORMALS, self.normals)
            .with(constant::SUM_DEPTH, self.depth)
            .with(constant::SUM_COLOURS, self.colours)
            .with(constant::SHADING, self.shading as u32)
            .with(constant::LIGHTS, self.lights)
            .with(constant::OUT_NORMAL, self.outputs.normal)
            .with(constant::OUT_DEPTH, self.outputs.depth)
            .with(constant::CLIPS, self.clips)
            .with(constant::BEYOND_CLIPS, self.coverage && self.clips)
            .with(constant::SLICED, self.sliced)
            .with(constant::FRAME_WEIGHTS, self.weights)
            .with(constant::FRAME_CORNERS, self.corners)
    }
}

impl SceneVariant {
    /// What a frame needs of a scene that has `streams`, and may be `instanced`.
    pub fn new(frame: Variant, streams: Streams, instanced: bool) -> Self {
        let weights = streams.weights.filter(|_| frame.weights);
        let blended = |colours| if frame.blends_colours() { colours } else { ColourStream::None };
        let reads = frame.blends_colours() || frame.texture.is_some();
        let has = |colours| colours != ColourStream::None;
        Self {
            held: Held {
                colours: has(streams.colours),
                weights: streams.weights.is_some(),
                vertex_colours: has(streams.primitives.colours),
            },
            frame,
            ellipses: streams.ellipses,
            clips: streams.clips,
            two_sided: streams.two_sided,
            weights: weights.is_some(),
            corners: weights == Some(true),
            colours: blended(streams.colours),
            primitives: PrimitiveKinds { colours: blended(streams.primitives.colours), ..streams.primitives },
            // Where colours are is no matter to who does not read them.
            layout: match reads || streams.unchecked {
                true => streams.layout,
                false => SurfelLayout {
                    colours: SurfelLayout::side_by_side(ColourStream::None).colours,
                    ..streams.layout
                },
            },
            unchecked: streams.unchecked.then_some(streams.colours),
            instanced,
        }
    }

    /// What its passes see at descriptor set 0.
    pub fn resources(&self, scope: Scope) -> Vec<&'static Resource> {
        let frame = &self.frame;
        let splats = frame.pull_push.is_none();
        let clips = splats && self.clips;
        let wanted: &[(&'static Resource, bool)] = match scope {
            Scope::View => return frame.view_resources(),
            Scope::Surfels => &[
                (&resource::POSITIONS, true),
                (&resource::NORMALS, true),
                (&resource::RADII, true),
                (&resource::COLOURS, self.held.colours),
                (&resource::ELLIPSES, self.ellipses),
                (&resource::WEIGHTS, self.held.weights),
                (&resource::CLIPS, clips),
                (&resource::SCREEN_CLIPS, clips),
                (&resource::SPLATS, splats),
                (&resource::SPLAT_BOXES, frame.is_tiled()),
                (&resource::SPLAT_ATTRIBUTES, frame.is_tiled()),
            ],
            Scope::Lines | Scope::Triangles => &[
                (&resource::VERTICES, true),
                (&resource::LINE_DIRECTIONS, self.primitives.lines),
                (&resource::VERTEX_COLOURS, self.held.vertex_colours),
                (&resource::ELEMENTS, true),
                (&resource::LARGE_TRIANGLES, self.primitives.triangles),
            ],
        };
        let there = wanted.iter().filter(|(_, there)| *there).map(|(resource, _)| *resource);
        [&resource::FRAME, &resource::VIEWS].into_iter().chain(there).collect()
    }

    /// The same as specialization constants, with the frame's.
    pub fn constants(&self) -> Constants {
        self.layout
            .add_to(self.frame.constants())
            .with(constant::UNCHECKED, self.unchecked.is_some())
            .with(constant::STORED_COLOURS, self.unchecked.map_or(0, |colours| colours as u32))
            .with(constant::ELLIPSES, self.ellipses)
            .with(constant::TWO_SIDED, self.two_sided)
            .with(constant::CLIPS, self.clips)
            .with(constant::BEYOND_CLIPS, self.frame.coverage && self.clips)
            .with(constant::WEIGHTS, self.weights)
            .with(constant::CORNERS, self.corners)
            .with(constant::COLOURS, self.colours as u32)
            .with(constant::VERTEX_COLOURS, self.primitives.colours as u32)
            .with(constant::INSTANCED, self.instanced)
    }
}
