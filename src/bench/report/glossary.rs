//! Glossary of the report.

use crate::bench::csv::metrics;
use crate::bench::record::Results;
use crate::settings::Choice;
use crate::verify::metrics::Metric;
use maud::{Markup, html};

/// Terms, and the metrics of the results; none without sessions.
pub fn section(results: &Results) -> Option<Markup> {
    (!results.sessions.is_empty()).then(|| html! { (terms()) (definitions(results)) })
}

fn terms() -> Markup {
    let terms = [
        (
            "RMSE",
            "root mean square difference from the truth over all pixels and channels, linear light, white is 1",
        ),
        (
            "silhouette",
            "part of the RMSE: pixels that the truth or the picture covers in part, or only one of both covers",
        ),
        (
            "inside",
            "part of the RMSE: pixels that both cover wholly, where sampling and filtering lose texture or shading; silhouette² + inside² = RMSE²",
        ),
        (
            "hidden surfels (ε)",
            "change of the picture by surfels of hidden sheets: those that ε admits, and those that visibility misses",
        ),
        (
            "precision",
            "change of the picture by rounding to float32: its difference from the float64 reference",
        ),
        ("truth's own error", "root mean square of the truth's standard error, a conservative estimate"),
        ("overlap", "discs over a point of the surface, on average, before any filter widens them"),
        (
            "float64 error",
            "largest difference of linear colour and α from the float64 reference, without pixels whose decisions rounding can flip",
        ),
        ("baseline-splats", "the CPU baseline: surfels as EWA splats by a plain native renderer"),
        ("baseline-pixels", "the CPU baseline: points of one pixel with a depth test"),
        (
            "baseline-traced",
            "16 rays a pixel, traced in float64 on the CPU with the truth's filter: the exact surface of a built-in scene; of a scan the triangles between the same points",
        ),
        (
            "× baseline",
            "median time relative to the CPU baseline, a plain native renderer, for the same points and picture (scene, size, shading and viewpoint) with its own settings, in the same session: of processor time, or of wall time on a GPU",
        ),
    ];
    html! { dl { @for (term, meaning) in terms { dt { (term) } dd { (meaning) } } } }
}

/// Definitions of the metrics of the results.
fn definitions(results: &Results) -> Markup {
    let names = metrics(results.sessions.iter().flat_map(|session| &session.runs));
    html! { @if !names.is_empty() {
        h3 { "Metrics" }
        dl { @for name in &names {
            @let metric = Metric::named(name);
            dt { (name) @if let Some(unit) = metric.map(Metric::unit).filter(|unit| !unit.is_empty()) { ", " (unit) } }
            dd { (meaning(name)) }
        } }
    } }
}

fn meaning(name: &str) -> &str {
    match name {
        "rmse" => "root mean square difference of linear colours over black; 0 is best",
        "rmse-srgb" => "root mean square difference of sRGB-encoded colours over black; 0 is best",
        "psnr" => "RMSE as peak signal-to-noise ratio: −20 log₁₀ RMSE; more is better",
        "psnr-srgb" => "RMSE of sRGB-encoded colours as peak signal-to-noise ratio",
        "ssim" => {
            "structural similarity of sRGB luma (Wang, Bovik, Sheikh, Simoncelli 2004), 11×11 Gaussian window; 1 is best"
        }
        "flip" => {
            "mean of the difference perceived when flipping between both (Andersson et al. 2020); 0 is best"
        }
        "flip-max" => "largest difference perceived when flipping between both",
        "iou" => "intersection over union of the silhouettes, where α is ½ or more; 1 is best",
        "holes" => "pixels that the truth covers and the picture does not",
        "hole-regions" => "connected regions of holes",
        "largest-hole" => "pixels of the largest connected region of holes",
        "bloat" => "pixels that the picture covers and the truth does not",
        "bloat-regions" => "connected regions of bloat",
        "largest-bloat" => "pixels of the largest connected region of bloat",
        "normal-median" => "median angle between normals, where both cover",
        "normal-mean" => "mean angle between normals, where both cover",
        "normal-p95" => "95th percentile of the angles between normals, where both cover",
        "normal-max" => "largest angle between normals, where both cover",
        "depth-rms" => "root mean square difference of depths over the object's size",
        "depth-p99" => "99th percentile of the differences of depths over the object's size",
        "depth-max" => "largest difference of depths over the object's size",
        name if name.starts_with("flicker") => {
            "error that varies along a slow camera path: its standard deviation as noise in time, by second differences \
             (Gasser, Sroka, Jennen-Steinmetz 1986)"
        }
        _ => "see the library's metrics",
    }
}
