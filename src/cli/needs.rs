//! `surfel methods --needs`: streams, passes and targets that frames of different scenes need.

use std::fmt::Write;
use surfel::frame::FramePlan;
use surfel::scene::{ColourStream, PrimitiveKinds, Streams};
use surfel::settings::methods::{Method, confetti, object_ewa, perspective_ewa, pull_push, sprites};
use surfel::settings::splatting::{Normalization, Splatting};
use surfel::settings::{Alpha, Cull, Edges, Shading};
use surfel::{Outputs, Rasterizer, RenderOptions, Settings};

/// A row of the table: a frame of a scene.
struct Case {
    method: Method,
    scene: &'static str,
    streams: Streams,
    asked: &'static str,
    settings: Settings,
    outputs: Outputs,
}

impl Case {
    /// A lit frame of circles.
    fn lit(method: Method, scene: &'static str, colours: ColourStream) -> Self {
        let streams = Streams::circles(colours);
        let settings = Settings { shading: Shading::Lit, ..method.settings() };
        Self { method, scene, streams, asked: "lit", settings, outputs: Outputs::default() }
    }

    /// The same frame of another scene.
    fn of(self, scene: &'static str, change: impl FnOnce(&mut Streams)) -> Self {
        let mut streams = self.streams;
        change(&mut streams);
        Self { scene, streams, ..self }
    }

    /// The same scene with another frame.
    fn asking(self, asked: &'static str, change: impl FnOnce(&mut Settings, &mut Outputs)) -> Self {
        let (mut settings, mut outputs) = (self.settings, self.outputs);
        change(&mut settings, &mut outputs);
        Self { asked, settings, outputs, ..self }
    }

    fn plan(&self, rasterizer: Rasterizer) -> FramePlan {
        let options = RenderOptions { outputs: self.outputs, ..Default::default() };
        FramePlan::new(&[self.streams], true, &self.settings, &options, rasterizer)
    }
}

fn cases() -> Vec<Case> {
    let ewa = || Case::lit(perspective_ewa::METHOD, "circles", ColourStream::None);
    let coloured = |method| Case::lit(method, "coloured circles", ColourStream::Srgb8);
    let by_surfel = Splatting { normalization: Normalization::Surfel, ..object_ewa::METHOD.splatting };
    let kinds = PrimitiveKinds { lines: true, triangles: false, colours: ColourStream::Srgb8 };
    vec![
        ewa(),
        ewa().asking("depths", |settings, _| settings.shading = Shading::Depth),
        ewa().of("circles, some without sides", |streams| streams.two_sided = true),
        ewa().of("circles with curvatures", |streams| streams.curvatures = true),
        ewa().of("ellipses", |streams| streams.ellipses = true),
        ewa().of("circles, some clipped", |streams| streams.clips = true),
        coloured(perspective_ewa::METHOD),
        coloured(perspective_ewa::METHOD)
            .asking("own colours", |settings, _| settings.shading = Shading::Colour),
        coloured(perspective_ewa::METHOD)
            .asking("own colours, eye-dome lighting", |settings, _| settings.shading = Shading::Edl),
        coloured(perspective_ewa::METHOD).asking("lit, ambient occlusion", |settings, _| settings.ao = 1.0),
        coloured(perspective_ewa::METHOD).asking("lit, a mask", |settings, _| settings.alpha = Alpha::Mask),
        coloured(perspective_ewa::METHOD)
            .asking("lit, nearest surface alone", |settings, _| settings.edges = Edges::Nearest),
        coloured(perspective_ewa::METHOD).asking("lit, unfiltered, both sides", |settings, _| {
            (settings.pixel_filter, settings.cull) = (0.0, Cull::None);
        }),
        coloured(perspective_ewa::METHOD).asking("lit, normals, depths", |_, outputs| {
            *outputs = Outputs { normal: true, depth: true, id: false };
        }),
        coloured(perspective_ewa::METHOD).of("coloured circles in arbitrary order", |streams| {
            streams.unordered = true;
            streams.clusters = false;
        }),
        coloured(perspective_ewa::METHOD)
            .of("coloured circles, quantized", |streams| *streams = streams.quantized()),
        coloured(object_ewa::METHOD),
        coloured(object_ewa::METHOD)
            .of("coloured circles with weights", |streams| streams.weights = Some(false))
            .asking("lit, normalized by surfel", |settings, _| settings.splatting = by_surfel),
        coloured(sprites::UNFILTERED),
        coloured(confetti::METHOD),
        coloured(pull_push::METHOD),
        coloured(pull_push::METHOD).of("coloured circles and lines", |streams| streams.primitives = kinds),
    ]
}

/// The table in Markdown.
pub fn table() -> String {
    let mut text = String::from(
        "| method | scene | asked for | streams, B a surfel | passes, drawn | splats, B a surfel | targets, B a px | passes, computed | splats, B a surfel | targets, B a px |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for case in cases() {
        let [drawn, computed] =
            [Rasterizer::Draw, Rasterizer::Compute].map(|rasterizer| case.plan(rasterizer));
        let streams = case.streams.per_surfel();
        let sum: u64 = streams.iter().map(|(_, bytes)| bytes).sum();
        let names: Vec<_> = streams.iter().map(|(name, bytes)| format!("{name} {bytes}")).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {sum}: {} | {} | {} | {} | {} | {} | {} |",
            case.method.name,
            case.scene,
            case.asked,
            names.join(", "),
            drawn.passes.join(", "),
            drawn.splat,
            targets(&drawn),
            computed.passes.join(", "),
            computed.splat,
            targets(&computed),
        );
    }
    text
}

/// Lists the targets with their bytes per pixel: `52: visibility 4, image 16`.
fn targets(FramePlan { targets, .. }: &FramePlan) -> String {
    let short = |bytes: f64| format!("{}", (100.0 * bytes).round() / 100.0);
    let sum: f64 = targets.iter().map(|(_, bytes)| bytes).sum();
    let each: Vec<_> = targets.iter().map(|(name, bytes)| format!("{name} {}", short(*bytes))).collect();
    format!("{}: {}", short(sum), each.join(", "))
}
