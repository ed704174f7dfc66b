//! The command that repeats a picture of the results.

use super::format;
use super::record::{Error, Implementation, Run, Viewpoint};
use crate::settings::Choice;
use crate::settings::splatting::Normalization;

/// The commands that render the picture of a run, `out.png`, and its exact picture, `truth.png`. None without a viewpoint, and for what no option
/// chooses: the baselines, box weights of pull–push, and weights of surfels, which are captured beforehand. No exact picture where the surface is
/// unknown.
pub fn commands(run: &Run) -> Option<[Option<String>; 2]> {
    let Implementation { variant, .. } = &run.implementation;
    let by_options = variant.is_empty() || variant.starts_with("--");
    let captured = run.settings.axes.normalization == Normalization::Surfel.name();
    if run.implementation.is_baseline() || !by_options || captured {
        return None;
    }
    let viewpoint = run.viewpoint.as_ref()?;
    let exact = run.error.as_ref().filter(|_| run.has_truth());
    Some([Some(render(run, viewpoint)), exact.map(|error| truth(run, error, viewpoint))])
}

fn render(run: &Run, viewpoint: &Viewpoint) -> String {
    let Implementation { method, variant } = &run.implementation;
    let is_scene = run.scene.starts_with("scene:");
    let mut words = vec!["surfel render".to_owned()];
    if is_scene {
        let separator = if run.scene.contains('?') { '&' } else { '?' };
        words.push(quoted(&format!("{}{separator}points={}", run.scene, run.points)));
    } else {
        words.push(format!("{} --points {}", quoted(&run.scene), run.points));
    }
    words.extend((run.radius_scale != 1.0).then(|| format!("--radius-scale {}", run.radius_scale)));
    words.extend([format!("--method {method}"), variant.clone(), format::options(run)]);
    words.extend([seen(run, viewpoint), "--output out.png".into()]);
    words.retain(|word| !word.is_empty());
    words.join(" ")
}

fn truth(
    run: &Run,
    Error { surface, filter, target, most_samples, .. }: &Error,
    viewpoint: &Viewpoint,
) -> String {
    let (input, seen) = (quoted(surface), seen(run, viewpoint));
    format!(
        "surfel truth {input} --filter {filter} --error {target} --most-samples {most_samples} {seen} --output truth.png"
    )
}

/// Options of both commands: size, shading and camera.
fn seen(run: &Run, viewpoint: &Viewpoint) -> String {
    let Viewpoint { place: _, eye, target, up, fov_y_deg } = viewpoint;
    let [eye, target, up] = [eye, target, up].map(|[x, y, z]| format!("{x},{y},{z}"));
    let ([width, height], shading) = (run.size, &run.settings.shading);
    format!(
        "--size {width}x{height} --shading {shading} --eye {eye} --target {target} --up {up} --fov {fov_y_deg}"
    )
}

/// Quotes a word for a shell, if needed.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
