//! Variants: the keys of pipelines and targets.

use super::renderer::RenderOptions;
use super::tile_workgroup::TileWorkgroup;
use crate::scene::{ColourStream, Streams};
use crate::settings::pull_push::{PullPush, Rules, Storage, Weights};
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use crate::settings::{Alpha, Cull, Outputs, Precision, Rasterizer, Settings, Shading, Widen};
use crate::vk::Constants;
use crate::vk::shaders::{Resource, constant, resource};

/// Largest number of [`Variant::attribute_rows`].
pub const MOST_ATTRIBUTE_ROWS: u64 = attribute_rows(true, true, true, true);

/// Rows of a splat's attributes: the first sums, the second ones, the normal field, and the weights at corners.
const fn attribute_rows(sums0: bool, sums1: bool, normal_field: bool, corners: bool) -> u64 {
    sums0 as u64 + sums1 as u64 + normal_field as u64 + 2 * corners as u64
}

/// Key of targets and of pipelines over pixels: properties of the scenes and the settings that select code and formats, without values that
/// change per frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Perspective or orthographic.
    pub perspective: bool,
    /// The camera is in perspective, and the scenes are far away in a narrow field of view: depths are relative to a plane near them.
    pub distant: bool,
    /// Back faces are culled.
    pub cull_back: bool,
    /// Pass sides culls some back faces.
    pub cull_auto: bool,
    /// Projection of a disc.
    pub footprint: Footprint,
    /// The kernel is Confetti's.
    pub confetti: bool,
    /// Which splats a pixel shows.
    pub visibility: Visibility,
    /// Pull–push, and its rules.
    pub pull_push: Option<PullPush>,
    /// Divisor of the sums.
    pub normalization: Normalization,
    /// Kernels are multiplied by normalization weights.
    pub weights: bool,
    /// Stage of lighting; [`Shade::Pixel`] unless lit, [`Shade::MeanNormal`] of normal fields.
    pub shade: Shade,
    /// Normals vary over discs: some scene has curvatures, and the frame sums normals of fields.
    pub normal_fields: bool,
    /// The low-pass filter widens only axes shorter than itself.
    pub widen_small: bool,
    /// Splats are counted by cull reason.
    pub count: bool,
    /// Normals are summed.
    pub normals: bool,
    /// Depths are summed.
    pub depth: bool,
    /// Colours are summed: of the scene, lit, or the albedo if sums are not divided.
    pub colours: bool,
    /// Some colours may be above 1.
    pub unbounded_colours: bool,
    /// Scenes have lines or triangles.
    pub primitives: bool,
    /// Format of the texels, if colours come from a texture.
    pub texture: Option<ColourStream>,
    /// Materials of points are looked up by id.
    pub materials: bool,
    /// α is the covered part of a pixel.
    pub coverage: bool,
    /// Pixels at edges show the surface behind, too.
    pub mixed: bool,
    /// Radius of the filter of pixels after shading, px; 0: none.
    pub filter_radius: u32,
    /// Passes `occlusion` and `ambient` darken the picture.
    pub ao: bool,
    /// Pass `edl` darkens the picture.
    pub edl: bool,
    /// Quantity that the picture shows.
    pub shading: Shading,
    /// Number of directional lights.
    pub lights: u32,
    /// Outputs in addition to colour.
    pub outputs: Outputs,
    /// Float width of the sums, or of the samples.
    pub precision: Precision,
    /// Rasterizer of splats and points; lines and triangles always take the compute path.
    pub rasterizer: Rasterizer,
    /// Visibility, attribute and normalize are separate passes on the tile path, and so are push and shade on all levels.
    pub split: bool,
    /// Tile path: dispatches are sliced, because a tile may have more splats than one dispatch visits.
    pub sliced: bool,
    /// Tile path: some discs have clip lines.
    pub clips: bool,
    /// Discs of convex surfaces cover samples down to a depth only: some scene has curvatures, and α is the coverage of discs in tangent planes.
    pub curvatures: bool,
    /// Tile path: some scene's surfels are in arbitrary order.
    pub unordered: bool,
    /// Compute path: some scene has bounds of its clusters of surfels, which are culled.
    pub clusters: bool,
    /// Tile path: clusters that were hidden in the last frame are drawn only where the others do not hide them (two-phase occlusion culling).
    pub occlusion_culling: bool,
    /// Tile path: some normalization weights are at the corners of surfels' squares.
    pub corners: bool,
    /// Tile path: workgroups of tile passes.
    pub workgroup: TileWorkgroup,
}

impl Variant {
    /// The variant of a frame of scenes with these `streams`.
    pub fn new(
        streams: &[Streams],
        perspective: bool,
        settings: &Settings,
        options: &RenderOptions,
        rasterizer: Rasterizer,
    ) -> Self {
        let edl = settings.shading == Shading::Edl;
        let shading = if edl { Shading::Colour } else { settings.shading };
        // Splatting axes have no effect on pull–push.
        let splatting = if settings.pull_push.is_some() { Splatting::default() } else { settings.splatting };
        let needs_colour = shading.is_coloured();
        let shade = match splatting.shade {
            _ if shading != Shading::Lit => Shade::Pixel,
            Shade::NormalField => Shade::MeanNormal,
            shade => shade,
        };
        let shade_splats = shade == Shade::Splat;
        let robust = settings.pull_push.is_some_and(|pull_push| pull_push.rules == Rules::Robust);
        let texture = streams.iter().find_map(|streams| streams.texture).filter(|_| robust && needs_colour);
        let colours: Vec<_> = if needs_colour && texture.is_none() {
            streams.iter().flat_map(|streams| [streams.colours, streams.primitives.colours]).collect()
        } else {
            Vec::new()
        };
        // Splat counts and weights are not divided.
        let normalization = match shading {
            Shading::Overlap | Shading::Weight => Normalization::Pixel,
            _ => splatting.normalization,
        };
        let undivided = normalization != Normalization::Pixel && splatting.visibility != Visibility::Nearest;
        let coloured = colours.iter().any(|colours| *colours != ColourStream::None);
        let floats = [ColourStream::Linear, ColourStream::Textured, ColourStream::Half];
        let tiled = settings.pull_push.is_none() && rasterizer == Rasterizer::Compute;
        let weights = splatting.normalization == Normalization::Surfel && shading != Shading::Overlap;
        let lit_pixels = shading == Shading::Lit && !shade_splats;
        let normals = lit_pixels || shading == Shading::Normal || options.outputs.normal;
        // Discs whose plane and kernel are the surface's.
        let on_surface = settings.pull_push.is_none()
            && splatting.has_gaussian_discs()
            && streams.iter().any(|streams| streams.curvatures);
        Self {
            perspective,
            distant: false,
            cull_back: settings.cull == Cull::Back,
            cull_auto: settings.finds_sides(),
            footprint: splatting.footprint,
            confetti: splatting.kernel != Kernel::Gaussian,
            visibility: splatting.visibility,
            pull_push: settings.pull_push,
            normalization,
            weights,
            shade,
            normal_fields: on_surface && normals && settings.has_normal_fields(),
            widen_small: settings.widen == Widen::Small && splatting.filter != Filter::None,
            count: options.count,
            normals,
            depth: shading == Shading::Depth || edl || settings.occludes() || options.outputs.depth,
            colours: needs_colour && (undivided || shade_splats || coloured),
            unbounded_colours: colours.iter().any(|colours| floats.contains(colours)),
            primitives: streams.iter().any(|streams| streams.primitives.any()),
            texture,
            materials: streams.iter().any(|streams| streams.materials)
                && settings.pull_push.is_some()
                && shading == Shading::Lit,
            coverage: settings.drawn_alpha() == Alpha::Coverage,
            mixed: settings.mixes_edges(),
            filter_radius: settings.filter_radius(),
            ao: settings.occludes(),
            edl,
            shading,
            lights: if shading == Shading::Lit { settings.lighting.directional.len() as u32 } else { 0 },
            outputs: options.outputs,
            precision: options.precision,
            rasterizer,
            split: options.split && (tiled || settings.pull_push.is_some())
                || tiled && splatting.visibility == Visibility::Axis,
            sliced: false,
            clips: tiled
                && splatting.footprint != Footprint::Point
                && streams.iter().any(|streams| streams.clips),
            curvatures: on_surface && settings.drawn_alpha() == Alpha::Coverage,
            unordered: tiled && streams.iter().any(|streams| streams.unordered),
            clusters: rasterizer == Rasterizer::Compute && streams.iter().any(|streams| streams.clusters),
            occlusion_culling: false,
            corners: tiled && weights && streams.iter().any(|streams| streams.weights == Some(true)),
            workgroup: TileWorkgroup::default(),
        }
    }

    /// The variant with sliced dispatches, on the tile path.
    pub fn with_slices(self, sliced: bool) -> Self {
        let sliced = sliced && self.is_tiled();
        Self { sliced, split: self.split || sliced, ..self }
    }

    /// The variant in frames of so many surfels in a picture of so many pixels: [`Variant::occlusion_culling`] costs as much as it saves where
    /// surfels are fewer than pixels. Where sums are not divided, planes may reach far in front of clusters: see [`Settings::most_rise`].
    pub fn with_occlusion_culling(self, surfels: u64, pixels: u64) -> Self {
        let is_bounded = self.footprint.is_in_tangent_plane() && self.normalization == Normalization::Pixel;
        let can = self.clusters && self.opens_tiles() && !self.distant && is_bounded;
        Self { occlusion_culling: can && surfels > pixels, ..self }
    }

    /// The variant in frames whose normal fields may differ from 0, or not: see [`super::normal_fields`].
    pub fn with_normal_fields(self, are_bent: bool) -> Self {
        Self { normal_fields: self.normal_fields && are_bent, ..self }
    }

    /// The variants that frames choose by camera, size and density alone, this one among them: of distant scenes or not, with normal fields or
    /// not, with occlusion culling or not, and with slices or not, if frames `may_slice`.
    pub fn choices(self, may_slice: bool) -> Vec<Self> {
        let mut list = vec![self];
        for (distant, bent) in [(false, true), (false, false), (true, true), (true, false)] {
            for (sliced, culled) in [(false, 0), (false, 1), (true, 0)] {
                let possible = (self.perspective || !distant) && (may_slice || !sliced);
                let variant = Self { distant, ..self }.with_normal_fields(bent);
                let variant = variant.with_slices(sliced).with_occlusion_culling(culled, 0);
                if possible && !list.contains(&variant) {
                    list.push(variant);
                }
            }
        }
        list
    }

    /// Whether passes after shading read depths.
    pub fn reads_depth(&self) -> bool {
        self.ao || self.edl
    }

    /// Whether depths are stored: as an output, or for passes after shading.
    pub fn stores_depth(&self) -> bool {
        self.outputs.depth || self.reads_depth()
    }

    /// Whether splats take the tile path.
    pub fn is_tiled(&self) -> bool {
        self.pull_push.is_none() && self.rasterizer == Rasterizer::Compute
    }

    /// Attribute rows of a splat, on the tile path: `lib/attributes.glsl`.
    pub fn attribute_rows(&self) -> u64 {
        attribute_rows(self.wide_sums0() || self.weights, self.wide_sums1(), self.normal_fields, self.corners)
    }

    /// Whether pull–push rasterizes surfels as points.
    pub fn has_raster_points(&self) -> bool {
        self.pull_push.is_some() && self.rasterizer == Rasterizer::Draw
    }

    /// Whether pull–push projects points by compute shaders: surfels on the compute path, lines, triangles.
    pub fn has_compute_points(&self) -> bool {
        self.pull_push.is_some() && (self.rasterizer == Rasterizer::Compute || self.primitives)
    }

    /// Whether the shade pass of pull–push does the last step of push: it reads no neighbours of the result, and the levels do not alternate.
    pub fn reconstructs_in_shade(&self) -> bool {
        let apart = self.pull_push.is_some_and(|pull_push| pull_push.storage == Storage::Apart);
        apart && !self.split && !self.coverage && self.texture.is_none()
    }

    /// Whether samples of pull–push have point ids.
    pub fn has_ids(&self) -> bool {
        self.outputs.id || self.materials
    }

    /// Resources of descriptor set 0 of passes over pixels.
    pub fn view_resources(&self) -> Vec<&'static Resource> {
        let texture = self.texture.map(|_| &resource::TEXTURE);
        let materials = self.materials.then_some(&resource::MATERIALS);
        let uniforms = [Some(&resource::FRAME), Some(&resource::VIEWS)];
        uniforms.into_iter().chain([texture, materials]).flatten().collect()
    }

    /// Whether colours of scenes are summed.
    pub fn blends_colours(&self) -> bool {
        self.shading.is_coloured() && self.texture.is_none()
    }

    /// Whether target 0 has a vector after Σw.
    pub fn wide_sums0(&self) -> bool {
        self.normals || self.colours
    }

    /// Whether the frame has target 1.
    pub fn has_sums1(&self) -> bool {
        self.depth || self.wide_sums1()
    }

    /// Whether target 1 sums colours beside the depth.
    pub fn wide_sums1(&self) -> bool {
        self.normals && self.colours
    }

    /// Specialization constants.
    pub fn constants(&self) -> Constants {
        Constants::default()
            .with(constant::PERSPECTIVE, self.perspective)
            .with(constant::DISTANT, self.distant)
            .with(constant::CULL_BACK, self.cull_back)
            .with(constant::CULL_AUTO, self.cull_auto)
            .with(constant::COVERAGE, self.coverage)
            .with(constant::COVERAGE_FOOTPRINT, self.coverage)
            .with(constant::TEXTURE, self.texture.is_some())
            .with(constant::TEXELS, self.texture.map_or(0, |texels| texels as u32))
            .with(constant::MATERIALS, self.materials)
            .with(constant::RECONSTRUCT, self.reconstructs_in_shade())
            .with(constant::IDS, self.has_ids())
            .with(constant::TUBES, self.primitives)
            .with(constant::FOOTPRINT, self.footprint as u32)
            .with(constant::CONFETTI, self.confetti)
            .with(constant::NORMALIZATION, self.normalization as u32)
            .with(constant::SHADE, self.shade as u32)
            .with(constant::PAPER, self.pull_push.is_some_and(|pull_push| pull_push.rules == Rules::Paper))
            .with(
                constant::BOX_WEIGHTS,
                self.pull_push.is_some_and(|pull_push| pull_push.weights == Weights::Box),
            )
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
            .with(constant::FILTER_RADIUS, self.filter_radius)
            .with(constant::LATE_BACKGROUND, self.filter_radius > 0 || self.reads_depth())
            .with(constant::EDL, self.edl)
            .with(constant::SHADING, self.shading as u32)
            .with(constant::LIGHTS, self.lights)
            .with(constant::OUT_NORMAL, self.outputs.normal)
            .with(constant::OUT_DEPTH, self.stores_depth())
            .with(constant::CLIPS, self.clips)
            .with(constant::BEYOND_CLIPS, self.coverage && self.clips)
            .with(constant::CURVATURES, self.curvatures)
            .with(constant::FRAME_NORMAL_FIELDS, self.normal_fields)
            .with(constant::SLICED, self.sliced)
            .with(constant::CLUSTERS, self.clusters)
            .with(constant::OCCLUSION_CULLING, self.occlusion_culling)
            .with(constant::FRAME_WEIGHTS, self.weights)
            .with(constant::FRAME_CORNERS, self.corners)
    }
}
