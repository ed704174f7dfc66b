//! What build.rs promises: errors with file and line, and Rust layouts that are the shaders' own.

use crate::shader_build::bundle::Bundle;
use crate::shader_build::{Shaders, compile_folder, digest};
use std::path::Path;

const BLOCK: &str =
    "layout(push_constant) uniform Frame { vec3 eye; float epsilon; mat4 view; uint count; } frame;";

/// A compute pass that uses `block` through `expression`, on line 6.
fn pass(block: &str, expression: &str) -> String {
    format!(
        "#version 460\n#ifdef COMPUTE\nlayout(local_size_x = 64) in;\n{block}\nlayout(set = 0, binding = 7) writeonly buffer Out {{ float result[]; }};\nvoid main() {{ result[gl_GlobalInvocationID.x] = float({expression}); }}\n#endif\n"
    )
}

/// A folder with these files in `shaders-glsl`.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let root = tempfile::tempdir().expect("a temporary folder");
    let folder = root.path().join("shaders-glsl");
    std::fs::create_dir_all(folder.join("lib")).expect("a folder for the includes");
    for (name, source) in files {
        std::fs::write(folder.join(name), source).expect("a shader");
    }
    root
}

/// Compiles these files in `shaders-glsl` of a folder of their own.
fn build(files: &[(&str, &str)]) -> Result<String, String> {
    let root = folder(files);
    let folder = root.path().join("shaders-glsl");
    compile(&folder).map(|shaders| shaders.bundle.reflection)
}

fn compile(folder: &Path) -> Result<Shaders, String> {
    compile_folder(folder, String::new())
}

/// The bundle of these files.
fn bundle(files: &[(&str, &str)]) -> Bundle {
    let root = folder(files);
    compile(&root.path().join("shaders-glsl")).expect("it builds").bundle
}

fn error(files: &[(&str, &str)]) -> String {
    build(files).expect_err("the build must fail")
}

#[track_caller]
fn contains(text: &str, wanted: &[&str]) {
    let missing: Vec<_> = wanted.iter().filter(|part| !text.contains(**part)).collect();
    assert!(missing.is_empty(), "{missing:#?} not in:\n{text}");
}

#[test]
fn nothing_to_compile() {
    contains(&build(&[]).expect("an empty folder builds"), &["pub mod layout {", "pub mod constant {"]);
    assert!(compile(Path::new("no/such/folder")).is_ok());
}

#[test]
fn every_stage_of_a_file_is_embedded() {
    let both = "#version 460\n#ifdef VERTEX\nvoid main() { gl_Position = vec4(0.0); }\n#endif\n\
        #if defined(FRAGMENT)\nlayout(location = 0) out vec4 colour;\nvoid main() { colour = vec4(1.0); }\n#endif\n";
    let rust = build(&[("disc.glsl", both), ("point-fill.glsl", &pass("", "1.0"))]).expect("it builds");
    contains(
        &rust,
        &[
            "pub static DISC_VERTEX: Module",
            "pub static DISC_FRAGMENT: Module",
            "pub static POINT_FILL_COMPUTE: Module",
            "/// The fragment stage of `shaders-glsl/disc.glsl`.",
            "stage: ShaderStageFlags::FRAGMENT",
        ],
    );
    assert!(!rust.contains("DISC_COMPUTE"));
    let bundle = bundle(&[("disc.glsl", both)]);
    let names: Vec<_> = bundle.spirv.iter().map(|module| &*module.name).collect();
    assert_eq!(names, ["disc_fragment", "disc_vertex"]);
    // SPIR-V 1.3: what Vulkan 1.1 takes.
    assert!(bundle.spirv.iter().all(|module| module.words[..2] == [0x0723_0203, 0x0001_0300]));
}

#[test]
fn a_variant_is_compiled_beside_the_file() {
    let buffer = "#ifdef FULL\nlayout(set = 0, binding = 1) readonly buffer Extra { float extra[]; };\n#endif\n#pragma variant FULL";
    let plain = build(&[("a.glsl", &pass(buffer, "1.0"))]).expect("it builds");
    contains(&plain, &["pub static A_COMPUTE: Module", "pub static A_FULL_COMPUTE: Module"]);
    // What the variant has the file itself has not.
    let message = error(&[("a.glsl", &pass(buffer, "extra[0]"))]);
    contains(&message, &["shaders-glsl/a.glsl:", "'extra'"]);
    // And the other way round.
    let only = "#pragma variant FULL\n#ifdef FULL\nmisspelt x;\n#endif";
    contains(&error(&[("a.glsl", &pass(only, "1.0"))]), &["shaders-glsl/a.glsl:6: error:"]);
}

#[test]
fn a_variant_may_change_one_stage_alone() {
    let source = "#version 460\n#pragma variant WIDE FRAGMENT\n#ifdef VERTEX\nvoid main() { gl_Position = vec4(0.0); }\n#endif\n\
        #ifdef FRAGMENT\nlayout(location = 0) out vec4 colour;\nvoid main() { colour = vec4(1.0); }\n#endif\n";
    let bundle = bundle(&[("disc.glsl", source)]);
    let names: Vec<_> = bundle.spirv.iter().map(|module| &*module.name).collect();
    assert_eq!(names, ["disc_fragment", "disc_vertex", "disc_wide_fragment"]);
}

#[test]
fn a_wrong_shader_names_file_and_line() {
    let message = error(&[("attribute.glsl", &pass("", "radius"))]);
    assert!(message.starts_with("shaders-glsl/attribute.glsl:6: error: 'radius'"), "{message}");
}

#[test]
fn a_file_without_a_stage_is_refused() {
    contains(&error(&[("conic.glsl", "#version 460\n")]), &["shaders-glsl/conic.glsl:1: error: no stage"]);
}

#[test]
fn an_error_in_an_include_names_the_include() {
    let uses = pass("#include \"lib/kernel.glsl\"", "kernel(2.0)");
    let wrong = "float kernel(float u) {\n    return exp(v);\n}\n";
    let message = error(&[("a.glsl", &uses), ("lib/kernel.glsl", wrong)]);
    assert!(message.starts_with("shaders-glsl/lib/kernel.glsl:2: error: 'v'"), "{message}");
    // And the line numbers after an include are still the file's own.
    let after =
        error(&[("a.glsl", &uses.replace("2.0", "w")), ("lib/kernel.glsl", &wrong.replace('v', "u"))]);
    assert!(after.starts_with("shaders-glsl/a.glsl:6: error: 'w'"), "{after}");
}

#[test]
fn an_include_may_include_by_the_same_path() {
    let outer = "#include \"lib/inner.glsl\"\nfloat outer() { return inner(); }\n";
    let files = [("lib/inner.glsl", "float inner() { return 1.0; }\n"), ("lib/outer.glsl", outer)];
    let uses = pass("#include \"lib/outer.glsl\"", "outer()");
    build(&[files[0], files[1], ("a.glsl", &uses)]).expect("it builds");
    let message = error(&[files[1], ("a.glsl", &uses)]);
    contains(&message, &["shaders-glsl/lib/outer.glsl:1: error:", "shaders-glsl/lib/inner.glsl"]);
}

#[test]
fn a_block_becomes_a_struct_at_its_offsets() {
    let rust = build(&[("a.glsl", &pass(BLOCK, "frame.eye.x"))]).expect("it builds");
    contains(
        &rust,
        &[
            "pub struct Frame {",
            "pub eye: [f32; 3],",
            "pub epsilon: f32,",
            "pub view: [[f32; 4]; 4],",
            "pub count: u32,",
            "assert!(std::mem::offset_of!(Frame, epsilon) == 12);",
            "assert!(std::mem::offset_of!(Frame, view) == 16);",
            "assert!(std::mem::offset_of!(Frame, count) == 80);",
            "assert!(std::mem::size_of::<Frame>() == 84);",
        ],
    );
    assert!(!rust.contains("_pad"), "{rust}");
}

#[test]
fn swapped_and_renamed_fields_change_the_struct() {
    let swapped = BLOCK.replace("vec3 eye; float epsilon;", "float epsilon; vec3 eye;");
    let rust = build(&[("a.glsl", &pass(&swapped, "frame.eye.x"))]).expect("it builds");
    contains(
        &rust,
        &[
            "pub _pad1: [u8; 12],",
            "assert!(std::mem::offset_of!(Frame, epsilon) == 0);",
            "assert!(std::mem::offset_of!(Frame, eye) == 16);",
            "assert!(std::mem::offset_of!(Frame, view) == 32);",
        ],
    );
    let renamed = BLOCK.replace("epsilon", "tolerance");
    let rust = build(&[("a.glsl", &pass(&renamed, "frame.eye.x"))]).expect("it builds");
    assert!(rust.contains("pub tolerance: f32,") && !rust.contains("epsilon"), "{rust}");
}

#[test]
fn arrays_fix_the_size_of_their_structs() {
    let block = "struct Light { vec3 to_light; };
        layout(set = 0, binding = 0) uniform Lights { Light lights[4]; mat3 turn; float gain[2]; int many; };";
    let rust = build(&[("a.glsl", &pass(block, "lights[0].to_light.x + turn[0][0] + gain[0] + many"))])
        .expect("it builds");
    contains(
        &rust,
        &[
            "pub struct Light {",
            "assert!(std::mem::size_of::<Light>() == 16);",
            "pub lights: [Light; 4],",
            "assert!(std::mem::offset_of!(Lights, turn) == 64);",
            // std140 keeps columns and the elements of arrays 16 bytes apart.
            "pub turn: [[f32; 4]; 3],",
            "pub gain: [[f32; 4]; 2],",
            "assert!(std::mem::offset_of!(Lights, many) == 144);",
            "assert!(std::mem::size_of::<Lights>() == 160);",
        ],
    );
}

#[test]
fn a_runtime_array_is_not_part_of_the_struct() {
    let block = "struct Surfel { vec3 centre; float radius; vec2 turn; };
        layout(set = 0, binding = 0) readonly buffer Surfels { uint count; Surfel surfels[]; };
        layout(set = 0, binding = 1) readonly buffer Colours { vec4 colours[]; };";
    let rust = build(&[("a.glsl", &pass(block, "surfels[count].radius + colours[0].x"))]).expect("it builds");
    contains(
        &rust,
        &[
            "assert!(std::mem::size_of::<Surfel>() == 32);",
            "pub struct Surfels {",
            "assert!(std::mem::size_of::<Surfels>() == 16);",
        ],
    );
    assert!(!rust.contains("struct Colours") && !rust.contains("struct Out"), "{rust}");
}

#[test]
fn one_name_has_one_layout() {
    let here = pass(BLOCK, "frame.eye.x");
    let there = pass(&BLOCK.replace("eye", "centre"), "frame.centre.x");
    let message = error(&[("here.glsl", &here), ("there.glsl", &there)]);
    contains(
        &message,
        &[
            "shaders-glsl/there.glsl: error: Frame is laid out as",
            "shaders-glsl/here.glsl",
            "eye at 0",
            "centre at 0",
        ],
    );
    build(&[("here.glsl", &here), ("there.glsl", &here)]).expect("twice the same is no conflict");
}

#[test]
fn specialization_constants_have_one_id() {
    let constant = "layout(constant_id = 3) const bool HAS_COLOUR = false;";
    let here = pass(constant, "HAS_COLOUR ? 1.0 : 0.0");
    let rust = build(&[("here.glsl", &here)]).expect("it builds");
    contains(&rust, &["pub const HAS_COLOUR: u32 = 3;"]);
    let message = error(&[("here.glsl", &here), ("there.glsl", &here.replace("= 3", "= 4"))]);
    contains(
        &message,
        &["shaders-glsl/there.glsl: error: constant HAS_COLOUR has id 4, but 3 in shaders-glsl/here.glsl"],
    );
    let message = error(&[("here.glsl", &here), ("there.glsl", &here.replace("HAS_COLOUR", "HAS_NORMALS"))]);
    contains(
        &message,
        &[
            "shaders-glsl/there.glsl: error: constant HAS_NORMALS has id 3, as HAS_COLOUR in shaders-glsl/here.glsl",
        ],
    );
}

#[test]
fn a_module_names_what_it_sees_at_its_bindings() {
    let blocks = "layout(set = 1, binding = 4, std430) readonly buffer OldPlaces { float old[]; };
layout(set = 0, binding = 2, std430) buffer NewPlaces { float made[]; };
layout(set = 0, binding = 9, std430) buffer Unused { float unused[]; };
layout(push_constant) uniform Push { uint first; uint last; } push;";
    let rust =
        build(&[("a.glsl", &shader(blocks, "made[push.first] = old[push.last];"))]).expect("it builds");
    contains(&rust, &["resources: &[(&resource::NEW_PLACES, true), (&resource::OLD_PLACES, false)],"]);
    contains(&rust, &["push: size_of::<layout::Push>() as u32,", "pub static OLD_PLACES: Resource"]);
    contains(&rust, &["set: 1,", "binding: 4,", "kind: DescriptorType::STORAGE_BUFFER,"]);
    contains(&rust, &["stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),"]);
}

#[test]
fn one_name_has_one_binding() {
    let at = |binding: u32| {
        let block =
            format!("layout(set = 0, binding = {binding}, std430) buffer Places {{ float places[]; }};");
        shader(&block, "places[0] = 1.0;")
    };
    let message = build(&[("a.glsl", &at(1)), ("b.glsl", &at(2))]).expect_err("they disagree");
    contains(
        &message,
        &["b.glsl: error: Places is STORAGE_BUFFER 2 of set 0, but STORAGE_BUFFER 1 of set 0 in"],
    );
}

/// A compute shader with these declarations that does this.
fn shader(declarations: &str, statement: &str) -> String {
    format!("#version 450\n{declarations}\n#ifdef COMPUTE\nvoid main() {{ {statement} }}\n#endif\n")
}

#[test]
fn a_module_names_the_constants_that_it_reads() {
    let constants = "layout(constant_id = 9) const uint UNREAD = 1;
        layout(constant_id = 5) const float B = 1.0;
        layout(constant_id = 2) const float A = 1.0;";
    let rust = build(&[("a.glsl", &pass(constants, "A + B"))]).expect("it builds");
    contains(&rust, &["constants: &[2, 5],"]);
}

#[test]
fn a_bundle_is_read_as_it_was_written() {
    let written = Bundle {
        sources: "1f".into(),
        compiler: "a compiler".into(),
        ..bundle(&[("a.glsl", &pass("", "1.0"))])
    };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("compiled");
    written.write(&at).unwrap();
    assert_eq!(Bundle::read(&at).unwrap(), written);
    let out = folder.path().join("out");
    written.unpack(&out).unwrap();
    let bytes = std::fs::read(out.join("a_compute.spv")).unwrap();
    assert_eq!(bytes.len(), 4 * written.spirv[0].words.len());
    assert_eq!(std::fs::read_to_string(out.join("shaders.rs")).unwrap(), written.reflection);

    let reflection = at.join("reflection.rs");
    std::fs::write(&reflection, "other").unwrap();
    contains(&Bundle::read(&at).unwrap_err(), &["of another build"]);
    std::fs::write(&reflection, &written.reflection).unwrap();

    let packed = at.join("a_compute.spv.z");
    let bytes = std::fs::read(&packed).unwrap();
    std::fs::write(&packed, &bytes[..bytes.len() / 2]).unwrap();
    contains(&Bundle::read(&at).unwrap_err(), &["a_compute.spv.z is damaged"]);
    std::fs::remove_file(at.join("digest")).unwrap();
    contains(&Bundle::read(&at).unwrap_err(), &["cannot read", "digest"]);
}

#[test]
fn the_digest_is_of_the_glsl_and_not_of_its_line_ends() {
    let of = |files: &[(&str, &str)]| digest::sources(folder(files).path()).unwrap();
    let first = of(&[("a.glsl", "a\nb\n")]);
    assert_eq!(first.len(), 32);
    assert_eq!(of(&[("a.glsl", "a\r\nb\r\n"), ("notes.txt", "x"), (".a.glsl", "x")]), first);
    for other in [("a.glsl", "a\nc\n"), ("b.glsl", "a\nb\n"), ("lib/a.glsl", "a\nb\n")] {
        assert_ne!(of(&[other]), first, "{other:?}");
    }
}
