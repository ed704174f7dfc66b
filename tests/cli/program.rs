//! Runs the program, and writes its input files.

#[path = "../support/skipping.rs"]
mod skipping;

use crate::matrix::if_whole;
pub use skipping::{data, say_skipped};
use std::path::PathBuf;
use std::process::{Command, Output};
use std::sync::OnceLock;
use tempfile::TempDir;

/// Mesa's cache of compiled shaders, shared by all runs of the program and of the tests.
pub const SHADER_CACHE: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/shaders");

/// Options of the frame with the fewest pipelines in the short run, for tests of something else.
pub fn plain() -> &'static str {
    if_whole("", "--alpha mask --cull none --pixel-filter none")
}

/// Exit code and output of a run.
pub struct Run {
    pub code: i32,
    pub out: Vec<u8>,
    pub err: String,
}

impl Run {
    /// The error line without its prefix. Checks that it is the only line, and the exit code.
    pub fn error(&self, code: i32) -> &str {
        assert_eq!(self.code, code, "{}", self.err);
        let line = self.err.strip_suffix('\n').and_then(|text| text.strip_prefix("surfel: error: "));
        let line = line.unwrap_or_else(|| panic!("no error line: {}", self.err));
        assert!(!line.contains('\n'), "more than a line: {}", self.err);
        line
    }

    /// Standard output of a run that must succeed.
    pub fn text(&self) -> &str {
        assert_eq!(self.code, 0, "{}", self.err);
        std::str::from_utf8(&self.out).unwrap()
    }
}

/// The program, in a temporary folder.
pub struct Program {
    folder: TempDir,
}

impl Program {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// The program, if there is a Vulkan device. Otherwise the test is skipped with a note, or fails if `SURFEL_REQUIRE_GPU` is 1.
    pub fn with_device(test: &str) -> Option<Self> {
        // All tests have the same devices.
        static DEVICES: OnceLock<Run> = OnceLock::new();
        let program = Self::new();
        let devices = DEVICES.get_or_init(|| program.run("devices"));
        if devices.code == 0 {
            return Some(program);
        }
        assert_ne!(std::env::var("SURFEL_REQUIRE_GPU").as_deref(), Ok("1"), "{test}: {}", devices.err);
        say_skipped("no Vulkan device");
        None
    }

    /// Runs the program in its folder with arguments separated by spaces.
    pub fn run(&self, arguments: &str) -> Run {
        self.run_with(arguments, &[])
    }

    /// The program in its folder, with arguments separated by spaces.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_surfel"));
        command
            .args(arguments.split_whitespace())
            .current_dir(self.folder.path())
            .env_remove("RUST_LOG")
            .env("XDG_CACHE_HOME", self.folder.path().join(".cache"))
            .env("MESA_SHADER_CACHE_DIR", SHADER_CACHE);
        command
    }

    /// [`Program::run`] with environment variables.
    pub fn run_with(&self, arguments: &str, variables: &[(&str, &str)]) -> Run {
        let mut command = self.command(arguments);
        let Output { status, stdout, stderr } = command.envs(variables.iter().copied()).output().unwrap();
        Run { code: status.code().unwrap(), out: stdout, err: String::from_utf8(stderr).unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.path(name), contents).unwrap();
        self
    }

    /// Names of the files in the folder.
    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.filter(|name| name != ".cache").collect();
        names.sort();
        names
    }

    /// Pixels of a PNG in the folder, RGBA.
    pub fn png(&self, name: &str) -> image::RgbaImage {
        image::open(self.path(name)).unwrap().into_rgba8()
    }
}

/// A PLY file with one surfel per line: x y z nx ny nz radius.
pub fn surfels(lines: &[&str]) -> String {
    let header = "ply\nformat ascii 1.0\nelement vertex";
    let properties: String =
        ["x", "y", "z", "nx", "ny", "nz", "radius"].map(|name| format!("property float {name}\n")).concat();
    format!("{header} {}\n{properties}end_header\n{}\n", lines.len(), lines.join("\n"))
}

/// [`surfels`] with a further property at the end of each line.
pub fn surfels_with(name: &str, lines: &[&str]) -> String {
    surfels(lines).replace("end_header", &format!("property float {name}\nend_header"))
}

/// The canonical path of [`data`].
pub fn scan(name: &str) -> Option<PathBuf> {
    data(name)?.canonicalize().ok()
}
