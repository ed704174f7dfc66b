//! Information about a scene, as text.

use std::path::Path;
use surfel::formats::FilterCounts;

/// Information about a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneInfo {
    /// Files and built-in scenes, as the user named them.
    pub names: Vec<String>,
    /// Number of points of all inputs; 0 while it is not known.
    pub points: u64,
    /// Number of points that were left out.
    pub dropped: u64,
    /// Description of what was estimated, if anything was.
    pub estimated: Option<String>,
    /// Numbers of points by class and return, filtered or not.
    pub counts: FilterCounts,
}

impl SceneInfo {
    /// Short form of the names: `bunny.ply`, `a.ply, b.ply`, `a.ply and 3 more`.
    pub fn title(&self) -> String {
        match &self.names[..] {
            [] => "surfels".into(),
            [first, second] => format!("{}, {}", short_name(first), short_name(second)),
            [one] => short_name(one).into(),
            [first, others @ ..] => format!("{} and {} more", short_name(first), others.len()),
        }
    }
}

/// A file's name without its folders.
pub fn short_name(name: &str) -> &str {
    Path::new(name).file_name().and_then(|name| name.to_str()).unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_short() {
        let title = |names: &[&str]| {
            SceneInfo { names: names.iter().map(|&name| name.to_owned()).collect(), ..Default::default() }
                .title()
        };
        assert_eq!(title(&["/scans/bunny.ply"]), "bunny.ply");
        assert_eq!(title(&["a/b.ply", "scene:sphere?points=5"]), "b.ply, scene:sphere?points=5");
        assert_eq!(title(&["b.ply", "c.ply", "d.ply"]), "b.ply and 2 more");
    }
}
