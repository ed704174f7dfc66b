//! Heads of SVG texts, for files and for embedding.

use super::Plot;

/// Use of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// A separate file, with namespace and size.
    File,
    /// Part of an HTML page, which implies the namespace and scales it to its width.
    Inline,
}

/// Replaces the head by one that suits its use, and adds title and description. `drawing` has `size` px times `scale`.
pub fn with_head(plot: &Plot, drawing: &str, size: [u32; 2], scale: u32, usage: Use) -> String {
    let body = drawing.split_once('>').map_or("", |(_, body)| body);
    let [width, height] = size;
    let [wide, high] = size.map(|length| length * scale);
    let place = match usage {
        Use::File => {
            format!(r#" xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}""#)
        }
        Use::Inline => String::new(),
    };
    let (name, title, description) = (escape(&plot.name), escape(&plot.title), escape(&plot.description));
    format!(
        "<svg{place} viewBox=\"0 0 {wide} {high}\" role=\"img\" aria-labelledby=\"{name}-title {name}-description\">\n\
         <title id=\"{name}-title\">{title}</title>\n<desc id=\"{name}-description\">{description}</desc>{body}"
    )
}

/// Escapes text for XML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
