//! Running the program, and files for it to read.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// Where Mesa keeps compiled shaders: what it compiles for one run of the program serves all others, those of the next test run too.
pub const SHADER_CACHE: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/shaders");

/// What came of a run.
pub struct Run {
    pub code: i32,
    pub out: Vec<u8>,
    pub err: String,
}

impl Run {
    /// The one line that an error must be, without its beginning; checks the code too.
    pub fn error(&self, code: i32) -> &str {
        assert_eq!(self.code, code, "{}", self.err);
        let line = self.err.strip_suffix('\n').and_then(|text| text.strip_prefix("surfel: error: "));
        let line = line.unwrap_or_else(|| panic!("no error line: {}", self.err));
        assert!(!line.contains('\n'), "more than a line: {}", self.err);
        line
    }

    /// Nothing went wrong; what was printed.
    pub fn text(&self) -> &str {
        assert_eq!(self.code, 0, "{}", self.err);
        std::str::from_utf8(&self.out).unwrap()
    }
}

/// The built program in a folder of its own.
pub struct Program {
    folder: TempDir,
}

impl Program {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// The program if there is a Vulkan device for it; otherwise the test is skipped, which it says where a captured test is heard too.
    pub fn with_device(test: &str) -> Option<Self> {
        let program = Self::new();
        let devices = program.run("devices");
        if devices.code == 0 {
            return Some(program);
        }
        assert_ne!(std::env::var("SURFEL_REQUIRE_GPU").as_deref(), Ok("1"), "{test}: {}", devices.err);
        say_skipped(test, "no Vulkan device");
        None
    }

    /// Runs it in its folder with arguments that are separated by spaces.
    pub fn run(&self, arguments: &str) -> Run {
        self.run_with(arguments, &[])
    }

    /// [`Program::run`] with variables in its environment.
    pub fn run_with(&self, arguments: &str, variables: &[(&str, &str)]) -> Run {
        let Output { status, stdout, stderr } = Command::new(env!("CARGO_BIN_EXE_surfel"))
            .args(arguments.split_whitespace())
            .current_dir(self.folder.path())
            .env_remove("RUST_LOG")
            .env("XDG_CACHE_HOME", self.folder.path().join(".cache"))
            .env("MESA_SHADER_CACHE_DIR", SHADER_CACHE)
            .envs(variables.iter().copied())
            .output()
            .unwrap();
        Run { code: status.code().unwrap(), out: stdout, err: String::from_utf8(stderr).unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.path(name), contents).unwrap();
        self
    }

    /// Names of the files in its folder.
    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.filter(|name| name != ".cache").collect();
        names.sort();
        names
    }

    /// Pixels of a PNG in its folder, RGBA.
    pub fn png(&self, name: &str) -> image::RgbaImage {
        image::open(self.path(name)).unwrap().into_rgba8()
    }
}

/// A PLY file of one surfel a line: x y z nx ny nz radius.
pub fn surfels(lines: &[&str]) -> String {
    let header = "ply\nformat ascii 1.0\nelement vertex";
    let properties: String =
        ["x", "y", "z", "nx", "ny", "nz", "radius"].map(|name| format!("property float {name}\n")).concat();
    format!("{header} {}\n{properties}end_header\n{}\n", lines.len(), lines.join("\n"))
}

/// [`surfels`] with one more number at the end of each line.
pub fn surfels_with(name: &str, lines: &[&str]) -> String {
    surfels(lines).replace("end_header", &format!("property float {name}\nend_header"))
}

/// A file of the scans that lie beside the project; `None`, said aloud, where they are not.
pub fn scan(test: &str, name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
    if path.exists() {
        return path.canonicalize().ok();
    }
    say_skipped(test, &format!("no {}", path.display()));
    None
}

/// Past the test harness, which keeps to itself what a passing test prints through macros.
pub fn say_skipped(test: &str, why: &str) {
    std::io::stderr().write_all(format!("SKIPPED {test}: {why}\n").as_bytes()).unwrap();
}
