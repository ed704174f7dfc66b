#![doc = include_str!("links.md")]
#![doc = include_str!("README.md")]
//!
//! The same chapters can be read in the repository, in `src/guide`.

/// A chapter: its text, the figures in it, of which `build.rs` makes data URLs, and the pages below it.
macro_rules! chapter {
    ($name:ident, $text:literal $(, $figure:literal)* $(; $($page:item)*)?) => {
        #[doc = include_str!("links.md")]
        $(#[cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/figures/", $figure, ".md")))])*
        #[doc = include_str!($text)]
        pub mod $name { $($($page)*)? }
    };
}

chapter!(getting_started, "getting-started.md", "demo");
chapter!(files, "files.md", "lidar", "scanner");
chapter!(render, "render.md");
chapter!(view, "view.md", "view");
chapter!(convert, "convert.md");
chapter!(scenes, "scenes.md");
chapter!(bench, "bench.md");
chapter!(methods, "methods.md", "epsilon", "footprints", "coverage", "edl", "ao";
    chapter!(zwicker2004, "methods/zwicker2004.md", "lowpass", "clips");
    chapter!(ren2002, "methods/ren2002.md");
    chapter!(botsch2003, "methods/botsch2003.md");
    chapter!(pajarola2004, "methods/pajarola2004.md", "kernels");
    chapter!(marroquim2008, "methods/marroquim2008.md", "pyramid", "lines");
);
chapter!(accuracy, "accuracy.md");
chapter!(cost, "cost.md");
chapter!(embedding, "embedding.md");
chapter!(architecture, "architecture.md";
    chapter!(measurements, "architecture/measurements.md");
);
chapter!(troubleshooting, "troubleshooting.md");
