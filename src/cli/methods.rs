//! `surfel methods`.

use super::files::{print, print_json};
use super::{args, needs};
use serde_json::{Value, json};
use std::fmt::Write;
use surfel::frame::FramePlan;
use surfel::scene::{ColourStream, Streams};
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Filter, Splatting};
use surfel::settings::{Choice, Settings, Shading};
use surfel::{Rasterizer, RenderOptions, Result};

/// The rasterizers, with the names of their frames.
const RASTERIZERS: [(Rasterizer, &str); 2] = [(Rasterizer::Draw, "drawn"), (Rasterizer::Compute, "computed")];

/// Lists the methods: paper, axes, and the passes and targets of a lit frame of coloured circles, for each rasterizer.
pub fn run(args: &args::Methods) -> Result<()> {
    if args.needs {
        return print(&needs::table());
    }
    if args.json {
        return print_json(&Method::CHOICES.iter().map(value).collect());
    }
    let mut text = String::from("bytes are per pixel, for a lit frame of coloured circles\n");
    Method::CHOICES.iter().for_each(|method| describe(&mut text, method));
    print(&text)
}

fn value(method: &Method) -> Value {
    let Splatting { footprint, kernel, filter, visibility, normalization, shade } = method.splatting;
    let axes = method.pull_push.is_none().then(|| {
        json!({
            "footprint": footprint.name(), "kernel": kernel.to_string(), "filter": filter.name(), "visibility": visibility.name(),
            "normalization": normalization.name(), "shade": shade.name(),
        })
    });
    let frames: serde_json::Map<_, _> = RASTERIZERS
        .into_iter()
        .map(|(rasterizer, name)| {
            let FramePlan { passes, targets, .. } = plan(&method.settings(), rasterizer);
            let targets: Value = targets
                .iter()
                .map(|(name, bytes)| json!({ "name": name, "bytes_per_pixel": bytes }))
                .collect();
            (name.to_owned(), json!({ "passes": passes, "targets": targets }))
        })
        .collect();
    let settings = json!({
        "cutoff": method.cutoff, "lowpass": method.lowpass, "pixel_filter": method.pixel_filter, "widen": method.widen.name(), "cull": method.cull.name(),
        "alpha": method.alpha.name(), "edges": method.edges.name(),
    });
    json!({ "name": method.name, "paper": method.paper, "axes": axes, "settings": settings, "frames": frames })
}

fn describe(text: &mut String, method: &Method) {
    if method.pull_push.is_some() {
        // Here and below: writing to a String cannot fail.
        let _ = writeln!(text, "\n{}: {}", method.name, method.paper);
        let _ = writeln!(text, "  settings --cull {} {}", method.cull.name(), picture_options(method));
        describe_frames(text, method);
        return;
    }
    let Splatting { footprint, kernel, filter, visibility, normalization, shade } = method.splatting;
    let Method { cutoff, lowpass, widen, cull, .. } = method;
    let lowpass = match filter {
        Filter::None => String::new(),
        Filter::Screen | Filter::Object => format!(" --lowpass {lowpass} --widen {}", widen.name()),
    };
    let _ = writeln!(text, "\n{}: {}", method.name, method.paper);
    let _ = writeln!(
        text,
        "  axes     --footprint {} --kernel {kernel} --filter {} --visibility {} --normalization {} --shade {}",
        footprint.name(),
        filter.name(),
        visibility.name(),
        normalization.name(),
        shade.name()
    );
    let _ = writeln!(
        text,
        "  settings --cutoff {cutoff} --cull {} {}{lowpass}",
        cull.name(),
        picture_options(method)
    );
    describe_frames(text, method);
}

/// Options of α and of the filter of pixels.
fn picture_options(method: &Method) -> String {
    let filter = match method.pixel_filter {
        0.0 => "none".into(),
        variance => format!("gaussian:{variance}"),
    };
    format!("--alpha {} --edges {} --pixel-filter {filter}", method.alpha.name(), method.edges.name())
}

fn describe_frames(text: &mut String, method: &Method) {
    for (rasterizer, name) in RASTERIZERS {
        let FramePlan { passes, targets, .. } = plan(&method.settings(), rasterizer);
        let _ = writeln!(text, "  {name:<8} {}", passes.join(" → "));
        let _ = writeln!(text, "           {}", targets_text(&targets));
    }
}

fn plan(settings: &Settings, rasterizer: Rasterizer) -> FramePlan {
    let settings = Settings { shading: Shading::Lit, ..settings.clone() };
    let streams = Streams::circles(ColourStream::Srgb8);
    FramePlan::new(&[streams], true, &settings, &RenderOptions::default(), rasterizer)
}

/// Lists the targets with their bytes per pixel.
fn targets_text(targets: &[(&str, f64)]) -> String {
    let each: Vec<_> = targets.iter().map(|(name, bytes)| format!("{name} {bytes}")).collect();
    let sum: f64 = targets.iter().map(|(_, bytes)| bytes).sum();
    format!("{}: {sum} bytes", each.join(", "))
}
