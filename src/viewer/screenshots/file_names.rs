//! Names of new files.

use jiff::Zoned;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Generates names from the time, each of them once.
#[derive(Default)]
pub struct FileNames {
    given: HashSet<PathBuf>,
}

impl FileNames {
    /// The path of a file in `folder` that does not exist.
    pub fn next(&mut self, folder: &Path, extension: &str) -> PathBuf {
        self.at(folder, extension, &Zoned::now().strftime("%Y%m%d-%H%M%S").to_string())
    }

    fn at(&mut self, folder: &Path, extension: &str, time: &str) -> PathBuf {
        let folder = folder.strip_prefix(".").unwrap_or(folder);
        let name = |number: u32| match number {
            1 => folder.join(format!("surfel-{time}.{extension}")),
            _ => folder.join(format!("surfel-{time}-{number}.{extension}")),
        };
        // A file that is being written may not exist yet, but its name is taken.
        let free = |path: &PathBuf| !self.given.contains(path) && !path.exists();
        let path = (1..).map(name).find(free).unwrap_or_else(|| name(1));
        self.given.insert(path.clone());
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_is_given_twice_and_no_file_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let there = folder.path().join("surfel-T-2.png");
        std::fs::write(&there, "").unwrap();
        let mut names = FileNames::default();
        let mut next = |extension| names.at(folder.path(), extension, "T");
        let found = [next("png"), next("png"), next("json"), next("png")];
        let expected = ["surfel-T.png", "surfel-T-3.png", "surfel-T.json", "surfel-T-4.png"];
        assert_eq!(found, expected.map(|name| folder.path().join(name)));
        assert_eq!(names.at(Path::new("."), "png", "T"), Path::new("surfel-T.png"));
    }
}
