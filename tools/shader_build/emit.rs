//! The Rust text of `shaders.rs`.

use super::compile::Module;
use super::reflect::{Interface, Kind, Resource, Struct, push_constants, resources, specialization_ids};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Bytes and Rust alignment of each struct by name.
type Sizes<'a> = BTreeMap<&'a str, (u32, u32)>;

/// The whole file.
pub fn rust(modules: &[Module], interface: &Interface) -> Result<String, String> {
    let mut text = String::from("// Made from shaders-glsl; see tools/shader_build.\n");
    for module in modules {
        code(&mut text, module)?;
    }
    constants(&mut text, interface);
    for_descriptors(&mut text, interface);
    layouts(&mut text, interface)?;
    Ok(text)
}

/// A module, whose SPIR-V the file that includes this has from `NAME.spv` beside it.
fn code(text: &mut String, module: &Module) -> Result<(), String> {
    let stage = module.stage().to_lowercase();
    let (constant, name) = (&module.constant, module.file_name());
    line(text, format_args!("\n/// The {stage} stage of `{}`.", module.file));
    line(text, format_args!("pub static {constant}: Module = Module {{"));
    line(text, format_args!("    name: \"{name}\","));
    line(text, format_args!("    stage: ShaderStageFlags::{},", stage.to_uppercase()));
    line(text, format_args!("    spirv: spirv!(\"{name}.spv\"),"));
    line(text, format_args!("    constants: &{:?},", specialization_ids(module)?));
    let declared = resources(module)?;
    let each = declared.iter().map(|found| format!("(&resource::{}, {})", upper(&found.name), found.writes));
    line(text, format_args!("    resources: &[{}],", each.collect::<Vec<_>>().join(", ")));
    let push =
        push_constants(module)?.map_or("0".into(), |block| format!("size_of::<layout::{block}>() as u32"));
    line(text, format_args!("    push: {push},"));
    text.push_str("};\n");
    Ok(())
}

/// `LARGE_SPLATS` of `LargeSplats`, `FROM_DEPTHS` of `from_Depths`.
fn upper(name: &str) -> String {
    let mut text = String::new();
    let mut before = '_';
    for letter in name.chars() {
        if letter.is_uppercase() && before != '_' && !before.is_uppercase() {
            text.push('_');
        }
        text.extend(letter.to_uppercase());
        before = letter;
    }
    text
}

fn for_descriptors(text: &mut String, interface: &Interface) {
    text.push_str("\n/// What shaders see at the bindings of their descriptor sets.\npub mod resource {\n");
    text.push_str("    use super::{DescriptorType, Resource, ShaderStageFlags};\n");
    for (name, Resource { file, set, binding, kind, stages }) in &interface.resources {
        let stages: Vec<_> =
            stages.iter().map(|stage| format!("ShaderStageFlags::{stage}.as_raw()")).collect();
        line(text, format_args!("\n    /// `{name}`, first in `{file}`."));
        line(text, format_args!("    pub static {}: Resource = Resource {{", upper(name)));
        line(text, format_args!("        name: \"{name}\","));
        line(text, format_args!("        set: {set},"));
        line(text, format_args!("        binding: {binding},"));
        line(text, format_args!("        kind: DescriptorType::{kind},"));
        line(text, format_args!("        stages: ShaderStageFlags::from_raw({}),", stages.join(" | ")));
        text.push_str("    };\n");
    }
    text.push_str("}\n");
}

fn constants(text: &mut String, interface: &Interface) {
    text.push_str("\n/// Ids of the specialization constants, one id for each name in all shaders.\npub mod constant {\n");
    for (name, (id, file)) in &interface.constants {
        line(text, format_args!("    /// `{name}`, first in `{file}`."));
        line(text, format_args!("    pub const {}: u32 = {id};", name.to_uppercase()));
    }
    text.push_str("}\n");
}

fn layouts(text: &mut String, interface: &Interface) -> Result<(), String> {
    text.push_str("\n/// The blocks and structs of the shaders, byte for byte.\n");
    text.push_str("#[allow(non_snake_case, non_camel_case_types)]\npub mod layout {\n");
    let mut sizes = Sizes::new();
    for name in interface.structs.keys() {
        measure(name, interface, &mut sizes)?;
    }
    for (name, found) in &interface.structs {
        declare(text, name, found, &sizes)?;
    }
    text.push_str("}\n");
    Ok(())
}

/// Size and Rust alignment of a struct, those of its members first.
fn measure<'a>(name: &'a str, interface: &'a Interface, sizes: &mut Sizes<'a>) -> Result<(), String> {
    let Some(found) = interface.structs.get(name) else {
        return Err(format!("error: {name} has no layout of its own: give it another name than a block's"));
    };
    let (mut end, mut align) = (0, 1);
    for field in &found.fields {
        if let Some(inner) = struct_inside(&field.kind) {
            measure(inner, interface, sizes)?;
        }
        let (bytes, needs) = extent(&field.kind, sizes);
        end = end.max(field.offset + bytes);
        align = align.max(needs);
    }
    let size = found.size.unwrap_or(end.next_multiple_of(found.align.max(align)));
    sizes.insert(name, (size, align));
    Ok(())
}

fn struct_inside(kind: &Kind) -> Option<&str> {
    match kind {
        Kind::Scalar(..) => None,
        Kind::Array(inner, _) => struct_inside(inner),
        Kind::Struct(name) => Some(name),
    }
}

fn extent(kind: &Kind, sizes: &Sizes) -> (u32, u32) {
    match kind {
        Kind::Scalar(_, bytes) => (*bytes, *bytes),
        Kind::Array(inner, count) => {
            let (bytes, align) = extent(inner, sizes);
            (bytes * count, align)
        }
        Kind::Struct(name) => sizes.get(name.as_str()).copied().unwrap_or((0, 1)),
    }
}

fn spelling(kind: &Kind) -> String {
    match kind {
        Kind::Scalar(name, _) => (*name).to_owned(),
        Kind::Array(inner, count) => format!("[{}; {count}]", spelling(inner)),
        Kind::Struct(name) => name.clone(),
    }
}

fn declare(text: &mut String, name: &str, found: &Struct, sizes: &Sizes) -> Result<(), String> {
    let size = sizes[name].0;
    line(text, format_args!("    /// `{name}`, {size} bytes, first in `{}`.", found.file));
    line(text, format_args!("    #[repr(C)]"));
    line(text, format_args!("    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]"));
    line(text, format_args!("    pub struct {name} {{"));
    let mut end = 0;
    for (index, field) in found.fields.iter().enumerate() {
        pad(text, name, index, end..field.offset)?;
        line(text, format_args!("        /// Byte {}.", field.offset));
        line(text, format_args!("        pub {}: {},", ident(&field.name), spelling(&field.kind)));
        end = field.offset + extent(&field.kind, sizes).0;
    }
    pad(text, name, found.fields.len(), end..size)?;
    text.push_str("    }\n");
    for field in &found.fields {
        let (member, offset) = (ident(&field.name), field.offset);
        line(
            text,
            format_args!("    const _: () = assert!(std::mem::offset_of!({name}, {member}) == {offset});"),
        );
    }
    line(text, format_args!("    const _: () = assert!(std::mem::size_of::<{name}>() == {size});\n"));
    Ok(())
}

/// A gap that the layout leaves before a member or at the end.
fn pad(text: &mut String, name: &str, index: usize, gap: std::ops::Range<u32>) -> Result<(), String> {
    if gap.start > gap.end {
        return Err(format!("error: {name}: bytes {} to {} belong to two members", gap.end, gap.start));
    }
    if !gap.is_empty() {
        line(text, format_args!("        /// Unused: the layout leaves a gap here."));
        line(text, format_args!("        pub _pad{index}: [u8; {}],", gap.len()));
    }
    Ok(())
}

/// A GLSL name that Rust keeps for itself.
fn ident(name: &str) -> String {
    match name {
        "type" | "move" | "ref" | "box" | "match" | "mod" | "use" | "loop" | "fn" | "let" | "mut" | "pub"
        | "dyn" => {
            format!("r#{name}")
        }
        _ => name.to_owned(),
    }
}

fn line(text: &mut String, arguments: std::fmt::Arguments) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{arguments}");
}
