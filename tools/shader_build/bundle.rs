//! Compiled shaders as a folder of files.
//!
//! | file | contents |
//! |---|---|
//! | `digest` | three lines: the digest of the sources, the name of the compiler, the digest of what was compiled |
//! | `reflection.rs` | Rust: modules, ids of specialization constants, shared structs |
//! | `NAME.spv.z` | the SPIR-V of a module, little-endian, zlib |

#[cfg(feature = "compile-shaders")]
use miniz_oxide::deflate::compress_to_vec_zlib;
use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;
use std::fs;
use std::path::Path;
use xxhash_rust::xxh3::Xxh3;

/// Extension of a compressed module.
const COMPRESSED: &str = "spv.z";
/// Name of the file with the digest.
const DIGEST: &str = "digest";
/// Name of the file with the reflection.
const REFLECTION: &str = "reflection.rs";
/// Upper bound of a module's size, bytes.
const LARGEST_MODULE: usize = 1 << 24;

/// Compiled shaders.
#[derive(Debug, PartialEq, Eq)]
pub struct Bundle {
    /// Digest of the sources.
    pub sources: String,
    /// The compiler, in words.
    pub compiler: String,
    /// The reflection as Rust.
    pub reflection: String,
    /// The modules in the order of their names.
    pub spirv: Vec<Spirv>,
}

/// The SPIR-V of one stage of one shader.
#[derive(Debug, PartialEq, Eq)]
pub struct Spirv {
    /// Name of the file without extension: `attribute_compute`.
    pub name: String,
    /// SPIR-V.
    pub words: Vec<u32>,
}

impl Bundle {
    /// Reads the bundle in `folder`.
    ///
    /// # Errors
    /// A file that is missing or damaged.
    pub fn read(folder: &Path) -> Result<Self, String> {
        let text = |name: &str| {
            let path = folder.join(name);
            let text =
                fs::read_to_string(&path).map_err(|error| format!("cannot read {}: {error}", path.display()));
            text.map(|text| text.replace('\r', ""))
        };
        let (digest, reflection) = (text(DIGEST)?, text(REFLECTION)?);
        let line = |key: &str| digest.lines().find_map(|line| line.strip_prefix(key)).map(String::from);
        let (Some(sources), Some(compiler)) = (line("sources "), line("compiler ")) else {
            return Err(format!("{}: no lines `sources` and `compiler`", folder.join(DIGEST).display()));
        };
        let failed = |error| format!("cannot read {}: {error}", folder.display());
        let mut spirv = Vec::new();
        for entry in fs::read_dir(folder).map_err(failed)? {
            let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
            if let Some(stem) = name.strip_suffix(COMPRESSED).and_then(|stem| stem.strip_suffix('.')) {
                spirv.push(Spirv { name: stem.to_owned(), words: decompress(&folder.join(&name))? });
            }
        }
        spirv.sort_by(|a, b| a.name.cmp(&b.name));
        let bundle = Self { sources, compiler, reflection, spirv };
        if line("contents ") != Some(bundle.contents()) {
            return Err(format!("{}: files are missing, damaged or of another build", folder.display()));
        }
        Ok(bundle)
    }

    /// Digest of the reflection and the SPIR-V.
    fn contents(&self) -> String {
        let mut hash = Xxh3::new();
        let names = self.spirv.iter().map(|module| (module.name.as_bytes().to_vec(), bytes(&module.words)));
        for (name, contents) in names.chain([(Vec::new(), self.reflection.clone().into_bytes())]) {
            for part in [name, contents] {
                hash.update(&(part.len() as u64).to_le_bytes());
                hash.update(&part);
            }
        }
        format!("{:032x}", hash.digest128())
    }

    /// Writes the bundle to `folder`, in place of what is there.
    ///
    /// # Errors
    /// A file that cannot be written.
    #[cfg(feature = "compile-shaders")]
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        if folder.exists() {
            fs::remove_dir_all(folder)
                .map_err(|error| format!("cannot empty {}: {error}", folder.display()))?;
        }
        let digest =
            format!("sources {}\ncompiler {}\ncontents {}\n", self.sources, self.compiler, self.contents());
        write(folder, DIGEST, digest.as_bytes())?;
        write(folder, REFLECTION, self.reflection.as_bytes())?;
        for module in &self.spirv {
            let packed = compress_to_vec_zlib(&bytes(&module.words), 10);
            write(folder, &format!("{}.{COMPRESSED}", module.name), &packed)?;
        }
        Ok(())
    }

    /// Writes what `src/vk/shaders.rs` includes to `folder`: `shaders.rs`, and beside it `NAME.spv` of each module.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn unpack(&self, folder: &Path) -> Result<(), String> {
        for module in &self.spirv {
            write(folder, &format!("{}.spv", module.name), &bytes(&module.words))?;
        }
        write(folder, "shaders.rs", self.reflection.as_bytes())
    }
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn decompress(path: &Path) -> Result<Vec<u32>, String> {
    let packed = fs::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let bytes = decompress_to_vec_zlib_with_limit(&packed, LARGEST_MODULE)
        .map_err(|error| format!("{} is damaged: {error}", path.display()))?;
    let (words, rest) = bytes.as_chunks();
    match rest {
        [] => Ok(words.iter().map(|word| u32::from_le_bytes(*word)).collect()),
        _ => Err(format!("{} is damaged: {} bytes are no whole words", path.display(), bytes.len())),
    }
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), String> {
    let path = folder.join(name);
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(&path, bytes))
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}
