//! GLSL to SPIR-V with shaderc: one module for each stage that a file has.

use shaderc::{
    CompilationArtifact, CompileOptions, Compiler, OptimizationLevel, ResolvedInclude, ShaderKind,
};
use std::path::{Path, PathBuf};

const STAGES: [(&str, ShaderKind); 3] =
    [("VERTEX", ShaderKind::Vertex), ("FRAGMENT", ShaderKind::Fragment), ("COMPUTE", ShaderKind::Compute)];

/// One stage of one file.
pub struct Module {
    /// The file as messages name it: `shaders-glsl/footprint.glsl`.
    pub file: String,
    /// Name of the Rust constant: `FOOTPRINT_COMPUTE`, or of a variant `VISIBILITY_COVERAGE_COMPUTE`.
    pub constant: String,
    /// Optimised SPIR-V, to be embedded.
    pub optimised: Vec<u32>,
    /// SPIR-V with the names of members, which the optimiser drops; to be reflected.
    pub named: Vec<u32>,
    /// The compiler's warnings, a line each.
    pub warnings: String,
}

impl Module {
    /// Name of the module's file, without extension: `footprint_compute`.
    pub fn file_name(&self) -> String {
        self.constant.to_lowercase()
    }

    /// Vulkan's name of its stage.
    pub fn stage(&self) -> String {
        self.constant.rsplit('_').next().unwrap_or_default().to_owned()
    }
}

/// Environment variable that names the compiler, set by tools/setup where the system's shaderc is linked.
pub const COMPILER: &str = "SURFEL_SHADERC";

/// The compiler in words: equal words, equal SPIR-V.
pub fn compiler() -> String {
    let built = "built by the crate shaderc-sys";
    std::env::var(COMPILER).ok().filter(|name| !name.is_empty()).unwrap_or_else(|| built.to_owned())
}

/// Compiles every stage of every variant of every `folder/*.glsl`, in the order of their names. A folder that does not exist has no shaders.
pub fn folder(folder: &Path) -> Result<Vec<Module>, String> {
    let compiler = Compiler::new().map_err(|error| error.to_string())?;
    let mut modules = Vec::new();
    for path in passes(folder)? {
        modules.extend(file(&compiler, folder, &path)?);
    }
    Ok(modules)
}

fn passes(folder: &Path) -> Result<Vec<PathBuf>, String> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let entries = folder.read_dir().and_then(|entries| entries.collect::<Result<Vec<_>, _>>());
    let entries = entries.map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<_> = entries.iter().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "glsl"));
    paths.sort();
    Ok(paths)
}

fn file(compiler: &Compiler, folder: &Path, path: &Path) -> Result<Vec<Module>, String> {
    let name = shown(folder, path);
    let source = read(folder, path)?;
    let has = |stage: &str| {
        source.contains(&format!("defined({stage})"))
            || source.lines().any(|line| line.split_whitespace().take(2).eq(["#ifdef", stage]))
    };
    let stages: Vec<_> = STAGES.into_iter().filter(|(stage, _)| has(stage)).collect();
    if stages.is_empty() {
        return Err(format!(
            "{name}:1: error: no stage: give it an #ifdef VERTEX, FRAGMENT or COMPUTE, or move it to lib/"
        ));
    }
    let mut modules = Vec::new();
    for stage in &stages {
        modules.push(module(compiler, folder, &name, &source, None, *stage)?);
    }
    for (variant, wanted) in variants(&source) {
        for stage in stages.iter().filter(|(stage, _)| wanted.is_empty() || wanted.contains(stage)) {
            modules.push(module(compiler, folder, &name, &source, Some(variant), *stage)?);
        }
    }
    Ok(modules)
}

/// The names that a file is compiled with beside being compiled without any, each with the stages that it changes, none for all: those of its
/// lines `#pragma variant NAME STAGE…`. For what a specialization constant cannot take away, such as a buffer.
fn variants(source: &str) -> impl Iterator<Item = (&str, Vec<&str>)> {
    let lines = source.lines().filter_map(|line| line.strip_prefix("#pragma variant "));
    lines.filter_map(|line| {
        let mut words = line.split_whitespace();
        Some((words.next()?, words.collect()))
    })
}

fn module(
    compiler: &Compiler,
    folder: &Path,
    name: &str,
    source: &str,
    variant: Option<&str>,
    (stage, kind): (&str, ShaderKind),
) -> Result<Module, String> {
    let compile = |level| {
        let mut options = options(folder).map_err(|error| error.to_string())?;
        options.add_macro_definition(stage, None);
        variant.into_iter().for_each(|name| options.add_macro_definition(name, None));
        options.set_optimization_level(level);
        compiler.compile_into_spirv(source, kind, name, "main", Some(&options)).map_err(message)
    };
    let named: CompilationArtifact = compile(OptimizationLevel::Zero)?;
    let optimised = compile(OptimizationLevel::Performance)?;
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    Ok(Module {
        file: name.to_owned(),
        constant: [Some(&*stem), variant, Some(stage)]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("_")
            .replace('-', "_")
            .to_uppercase(),
        optimised: optimised.as_binary().to_vec(),
        named: named.as_binary().to_vec(),
        warnings: named.get_warning_messages(),
    })
}

fn options(folder: &Path) -> shaderc::Result<CompileOptions<'_>> {
    let mut options = CompileOptions::new()?;
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_1 as u32);
    options.set_target_spirv(shaderc::SpirvVersion::V1_3);
    // Includes are relative to the folder, wherever they stand: `lib/a.glsl` is one file under one name.
    options.set_include_callback(move |requested, _, _, _| {
        let path = folder.join(requested);
        Ok(ResolvedInclude { resolved_name: shown(folder, &path), content: read(folder, &path)? })
    });
    Ok(options)
}

fn read(folder: &Path, path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", shown(folder, path)))
}

/// The path as messages name it: from the folder's own name on, with slashes.
fn shown(folder: &Path, path: &Path) -> String {
    let inside = path.strip_prefix(folder).unwrap_or(path).to_string_lossy().replace('\\', "/");
    format!("{}/{inside}", folder.file_name().unwrap_or_default().to_string_lossy())
}

/// shaderc's own lines, which start with file and line.
fn message(error: shaderc::Error) -> String {
    match error {
        shaderc::Error::CompilationError(_, lines) => lines.trim_end().to_owned(),
        other => other.to_string(),
    }
}
