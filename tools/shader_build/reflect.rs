//! What a module asks of its caller: the layouts of blocks and of the structs in them, the ids of specialization constants, and what stands
//! at which binding of which descriptor set.

use super::compile::Module;
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Decoration, Dim, Op, StorageClass};
use std::collections::{BTreeMap, BTreeSet};

/// Operand of OpTypeImage that is 2 for storage images.
const SAMPLED: usize = 5;

/// The interface of all modules together.
#[derive(Default)]
pub struct Interface {
    /// Blocks and structs by name.
    pub structs: BTreeMap<String, Struct>,
    /// Specialization constants: name → id and the file that said so first.
    pub constants: BTreeMap<String, (u32, String)>,
    /// Buffers, images and input attachments by name.
    pub resources: BTreeMap<String, Resource>,
}

/// What stands at a binding of a descriptor set.
#[derive(Clone, Debug, PartialEq)]
pub struct Resource {
    /// The file that declared it first.
    pub file: String,
    /// Number of the descriptor set.
    pub set: u32,
    /// Number of the binding.
    pub binding: u32,
    /// Vulkan's name of its descriptor type.
    pub kind: &'static str,
    /// Vulkan's names of the stages that see it, those of all modules.
    pub stages: BTreeSet<String>,
}

/// A resource as a module declares it.
#[derive(Clone, Debug, PartialEq)]
pub struct Declared {
    /// Name of the block, or of the image.
    pub name: String,
    /// What it is.
    pub resource: Resource,
    /// Whether it is not `readonly`.
    pub writes: bool,
}

/// A block, or a struct inside one, with explicit offsets.
#[derive(Clone, Debug, PartialEq)]
pub struct Struct {
    /// The file that declared it first.
    pub file: String,
    /// Members in the order of their offsets, without a runtime array.
    pub fields: Vec<Field>,
    /// Size in bytes, where something fixes it: the stride of an array of it, or the start of its runtime array.
    pub size: Option<u32>,
    /// Where nothing fixes the size, it is a multiple of this: 16 for a uniform block, by std140's rule.
    pub align: u32,
}

/// A member.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// GLSL name.
    pub name: String,
    /// Offset in bytes.
    pub offset: u32,
    /// Type.
    pub kind: Kind,
}

/// A type with one Rust spelling.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A Rust number and its bytes.
    Scalar(&'static str, u32),
    /// So many of the same, without gaps.
    Array(Box<Kind>, u32),
    /// A struct by name.
    Struct(String),
}

impl Interface {
    /// Adds a module's; an error where it contradicts an earlier one.
    pub fn add(&mut self, module: &Module) -> Result<(), String> {
        let wrong = |what: String| format!("{}: error: {what}", module.file);
        let ids = Ids::new(&module.named).map_err(wrong)?;
        for (name, id) in ids.specialization_constants() {
            self.add_constant(name, id, &module.file)?;
        }
        for (name, mut found) in ids.structs().map_err(wrong)? {
            found.file.clone_from(&module.file);
            self.add_struct(name, found)?;
        }
        for declared in resources(module)? {
            self.add_resource(declared.name, declared.resource)?;
        }
        Ok(())
    }

    fn add_resource(&mut self, name: String, found: Resource) -> Result<(), String> {
        let Some(known) = self.resources.get_mut(&name) else {
            self.resources.insert(name, found);
            return Ok(());
        };
        let place = |at: &Resource| format!("{} {} of set {}", at.kind, at.binding, at.set);
        if place(known) != place(&found) {
            let (ours, theirs) = (place(&found), place(known));
            return Err(format!("{}: error: {name} is {ours}, but {theirs} in {}", found.file, known.file));
        }
        known.stages.extend(found.stages);
        Ok(())
    }

    fn add_constant(&mut self, name: String, id: u32, file: &str) -> Result<(), String> {
        let (known, first) = self.constants.entry(name.clone()).or_insert((id, file.to_owned()));
        if *known != id {
            return Err(format!("{file}: error: constant {name} has id {id}, but {known} in {first}"));
        }
        let others = self.constants.iter().filter(|(other, (taken, _))| *other != &name && *taken == id);
        match others.map(|(other, (_, place))| format!("{other} in {place}")).next() {
            None => Ok(()),
            Some(other) => Err(format!("{file}: error: constant {name} has id {id}, as {other}")),
        }
    }

    fn add_struct(&mut self, name: String, found: Struct) -> Result<(), String> {
        let Some(known) = self.structs.get_mut(&name) else {
            self.structs.insert(name, found);
            return Ok(());
        };
        let sizes_agree = known.size.is_none() || found.size.is_none() || known.size == found.size;
        if known.fields != found.fields || !sizes_agree {
            return Err(format!(
                "{}: error: {name} is laid out as {}, but as {} in {}",
                found.file,
                found.summary(),
                known.summary(),
                known.file
            ));
        }
        known.size = known.size.or(found.size);
        known.align = known.align.max(found.align);
        Ok(())
    }
}

impl Struct {
    fn summary(&self) -> String {
        let field = |field: &Field| format!("{} at {}", field.name, field.offset);
        let fields: Vec<_> = self.fields.iter().map(field).collect();
        let size = self.size.map(|size| format!(", {size} bytes")).unwrap_or_default();
        format!("{{ {} }}{size}", fields.join(", "))
    }
}

/// Ids of the specialization constants that the optimised module reads, ascending.
pub fn specialization_ids(module: &Module) -> Result<Vec<u32>, String> {
    let parsed = rspirv::dr::load_words(&module.optimised)
        .map_err(|error| format!("{}: error: cannot reflect: {error}", module.file))?;
    let id = |instruction: &Instruction| match instruction.operands[..] {
        [_, Operand::Decoration(Decoration::SpecId), Operand::LiteralBit32(id)] => Some(id),
        _ => None,
    };
    let mut ids: Vec<_> = parsed.annotations.iter().filter_map(id).collect();
    ids.sort_unstable();
    Ok(ids)
}

/// What the optimised module declares, by set and binding; the names are those of the other.
pub fn resources(module: &Module) -> Result<Vec<Declared>, String> {
    let ids = |words| Ids::new(words).map_err(|cause| format!("{}: error: {cause}", module.file));
    let left: BTreeSet<_> = ids(&module.optimised)?.bound().map(|(_, place)| place).collect();
    let named = ids(&module.named)?;
    let mut found = Vec::new();
    for (variable, place) in named.bound().filter(|(_, place)| left.contains(place)) {
        found.push(named.declared(variable, place, module)?);
    }
    found.sort_by(|a, b| {
        (a.resource.set, a.resource.binding, &a.name).cmp(&(b.resource.set, b.resource.binding, &b.name))
    });
    Ok(found)
}

/// Name and bytes of the push constants that the optimised module declares.
pub fn push_constants(module: &Module) -> Result<Option<String>, String> {
    let ids = |words| Ids::new(words).map_err(|cause| format!("{}: error: {cause}", module.file));
    let pushed = |ids: &Ids| {
        let storage = Operand::StorageClass(StorageClass::PushConstant);
        let variable = ids.variables.iter().find(|variable| variable.operands.first() == Some(&storage));
        variable.and_then(|variable| ids.pointee(variable))
    };
    let used = pushed(&ids(&module.optimised)?).is_some();
    let named = ids(&module.named)?;
    Ok(pushed(&named).filter(|_| used).map(|block| named.name(block)))
}

/// A module's names, decorations and types by id.
struct Ids {
    names: BTreeMap<u32, String>,
    members: BTreeMap<(u32, u32), String>,
    decorations: BTreeMap<(u32, Decoration), u32>,
    member_decorations: BTreeMap<(u32, u32, Decoration), u32>,
    values: BTreeMap<u32, Instruction>,
    variables: Vec<Instruction>,
}

impl Ids {
    fn new(words: &[u32]) -> Result<Self, String> {
        let module = rspirv::dr::load_words(words).map_err(|error| format!("cannot reflect: {error}"))?;
        let mut ids = Self {
            names: BTreeMap::new(),
            members: BTreeMap::new(),
            decorations: BTreeMap::new(),
            member_decorations: BTreeMap::new(),
            values: BTreeMap::new(),
            variables: Vec::new(),
        };
        for instruction in module.debug_names.iter().chain(&module.annotations) {
            ids.note(&instruction.operands);
        }
        for instruction in module.types_global_values {
            match (instruction.class.opcode, instruction.result_id) {
                (Op::Variable, _) => ids.variables.push(instruction),
                (_, Some(id)) => {
                    ids.values.insert(id, instruction);
                }
                _ => (),
            }
        }
        Ok(ids)
    }

    /// OpName, OpMemberName, OpDecorate and OpMemberDecorate are told apart by their operands.
    fn note(&mut self, operands: &[Operand]) {
        use Operand::{Decoration as Is, IdRef, LiteralBit32 as Number, LiteralString as Text};
        match operands {
            [IdRef(id), Text(name)] => {
                self.names.insert(*id, name.clone());
            }
            [IdRef(id), Number(member), Text(name)] => {
                self.members.insert((*id, *member), name.clone());
            }
            [IdRef(id), Is(decoration), rest @ ..] => {
                self.decorations.insert((*id, *decoration), number(rest));
            }
            [IdRef(id), Number(member), Is(decoration), rest @ ..] => {
                self.member_decorations.insert((*id, *member, *decoration), number(rest));
            }
            _ => (),
        }
    }

    /// Names and ids. `local_size_x_id` makes constants without a name: those are the pass's own affair.
    fn specialization_constants(&self) -> impl Iterator<Item = (String, u32)> {
        let ids = self.decorations.iter().filter(|((_, decoration), _)| *decoration == Decoration::SpecId);
        ids.filter_map(|((id, _), number)| {
            Some((self.names.get(id).filter(|name| !name.is_empty())?.clone(), *number))
        })
    }

    /// Every named struct with explicit offsets and a member of fixed size. A name may come twice, once for each layout rule.
    fn structs(&self) -> Result<Vec<(String, Struct)>, String> {
        let mut structs = Vec::new();
        for (id, value) in &self.values {
            let explicit = self.member_decorations.contains_key(&(*id, 0, Decoration::Offset));
            if value.class.opcode == Op::TypeStruct && explicit {
                let found = self.layout(*id, value)?;
                if !found.fields.is_empty() {
                    structs.push((self.name(*id), found));
                }
            }
        }
        Ok(structs)
    }

    fn layout(&self, id: u32, value: &Instruction) -> Result<Struct, String> {
        let align = if self.is_uniform_block(id) { 16 } else { 1 };
        let mut found =
            Struct { file: String::new(), fields: Vec::new(), size: self.stride_of_array(id), align };
        for (member, operand) in (0..).zip(&value.operands) {
            let name = self.members.get(&(id, member)).cloned().unwrap_or_default();
            let decoration = |which| self.member_decorations.get(&(id, member, which)).copied();
            let offset = decoration(Decoration::Offset).unwrap_or_default();
            let kind = literal(operand);
            if self.values.get(&kind).is_some_and(|value| value.class.opcode == Op::TypeRuntimeArray) {
                found.size = Some(offset);
                continue;
            }
            let place = |what: String| format!("{}.{name}: {what}", self.name(id));
            if decoration(Decoration::RowMajor).is_some() {
                return Err(place("row_major has no Rust spelling: leave it out".to_owned()));
            }
            let kind = self.kind(kind, decoration(Decoration::MatrixStride)).map_err(place)?;
            found.fields.push(Field { name, offset, kind });
        }
        found.fields.sort_by_key(|field| field.offset);
        Ok(found)
    }

    fn kind(&self, id: u32, matrix_stride: Option<u32>) -> Result<Kind, String> {
        let value = self.values.get(&id).ok_or("a type that is not declared")?;
        let operand = |index: usize| value.operands.get(index).map_or(0, literal);
        match value.class.opcode {
            Op::TypeInt | Op::TypeFloat => scalar(value.class.opcode, operand(0), operand(1)),
            Op::TypeVector => Ok(Kind::Array(Box::new(self.kind(operand(0), None)?), operand(1))),
            Op::TypeMatrix => {
                let column = spaced(self.kind(operand(0), None)?, matrix_stride)?;
                Ok(Kind::Array(Box::new(column), operand(1)))
            }
            Op::TypeArray => {
                let length = self.values.get(&operand(1)).filter(|value| value.class.opcode == Op::Constant);
                let length = length.ok_or("the length of an array in a block must be a plain constant")?;
                let stride = self.decorations.get(&(id, Decoration::ArrayStride)).copied();
                let element = spaced(self.kind(operand(0), matrix_stride)?, stride)?;
                Ok(Kind::Array(Box::new(element), length.operands.first().map_or(0, literal)))
            }
            Op::TypeStruct => Ok(Kind::Struct(self.name(id))),
            // A buffer reference is an address.
            Op::TypePointer => Ok(Kind::Scalar("u64", 8)),
            other => Err(format!("{other:?} has no Rust spelling")),
        }
    }

    /// Every variable with a binding, with its set and that.
    fn bound(&self) -> impl Iterator<Item = (&Instruction, (u32, u32))> {
        self.variables.iter().filter_map(|variable| {
            let decoration = |which| self.decorations.get(&(variable.result_id?, which)).copied();
            Some((variable, (decoration(Decoration::DescriptorSet)?, decoration(Decoration::Binding)?)))
        })
    }

    /// The type that a variable is of.
    fn pointee(&self, variable: &Instruction) -> Option<u32> {
        self.values.get(&variable.result_type?)?.operands.get(1).map(literal)
    }

    fn declared(
        &self,
        variable: &Instruction,
        (set, binding): (u32, u32),
        module: &Module,
    ) -> Result<Declared, String> {
        let kind = self.pointee(variable).unwrap_or_default();
        let image = self.values.get(&kind).filter(|value| value.class.opcode == Op::TypeImage);
        let storage = variable.operands.first();
        let name = self.name(if image.is_some() { variable.result_id.unwrap_or_default() } else { kind });
        let kind_name = match (image, storage) {
            (Some(image), _) if image.operands.contains(&Operand::Dim(Dim::DimSubpassData)) => {
                "INPUT_ATTACHMENT"
            }
            (Some(image), _) if image.operands.contains(&Operand::Dim(Dim::DimBuffer)) => {
                "UNIFORM_TEXEL_BUFFER"
            }
            (Some(image), _) if image.operands.get(SAMPLED) == Some(&Operand::LiteralBit32(2)) => {
                "STORAGE_IMAGE"
            }
            (Some(_), _) => "SAMPLED_IMAGE",
            (None, Some(Operand::StorageClass(StorageClass::Uniform))) => "UNIFORM_BUFFER",
            (None, Some(Operand::StorageClass(StorageClass::StorageBuffer))) => "STORAGE_BUFFER",
            _ => return Err(format!("{}: error: {name} is of no kind that is known", module.file)),
        };
        let members = self.values.get(&kind).map_or(0, |block| block.operands.len() as u32);
        let readonly =
            |member| self.member_decorations.contains_key(&(kind, member, Decoration::NonWritable));
        let resource = Resource {
            file: module.file.clone(),
            set,
            binding,
            kind: kind_name,
            stages: BTreeSet::from([module.stage()]),
        };
        let is_readonly = match kind_name {
            "STORAGE_IMAGE" => variable
                .result_id
                .is_some_and(|id| self.decorations.contains_key(&(id, Decoration::NonWritable))),
            "STORAGE_BUFFER" => (0..members).all(readonly),
            _ => true,
        };
        let writes = !is_readonly;
        Ok(Declared { name, resource, writes })
    }

    fn name(&self, id: u32) -> String {
        self.names.get(&id).cloned().unwrap_or_default()
    }

    fn stride_of_array(&self, element: u32) -> Option<u32> {
        let mut strides =
            self.decorations.iter().filter(|((_, decoration), _)| *decoration == Decoration::ArrayStride);
        strides.find_map(|((array, _), stride)| {
            let operands = &self.values.get(array)?.operands;
            (operands.first().map(literal) == Some(element)).then_some(*stride)
        })
    }

    fn is_uniform_block(&self, id: u32) -> bool {
        self.variables.iter().any(|variable| {
            let uniform = variable.operands.first() == Some(&Operand::StorageClass(StorageClass::Uniform));
            let pointer = variable.result_type.and_then(|pointer| self.values.get(&pointer));
            uniform && pointer.and_then(|pointer| pointer.operands.get(1)).map(literal) == Some(id)
        })
    }
}

/// A result id or a literal number.
fn literal(operand: &Operand) -> u32 {
    match operand {
        Operand::IdRef(number) | Operand::LiteralBit32(number) => *number,
        _ => 0,
    }
}

/// The number of a decoration, 0 where it has none.
fn number(rest: &[Operand]) -> u32 {
    rest.first().map_or(0, literal)
}

fn scalar(opcode: Op, bits: u32, signed: u32) -> Result<Kind, String> {
    let name = match (opcode, bits, signed) {
        (Op::TypeFloat, 32, _) => "f32",
        (Op::TypeFloat, 64, _) => "f64",
        (Op::TypeInt, 8, 0) => "u8",
        (Op::TypeInt, 8, _) => "i8",
        (Op::TypeInt, 16, 0) => "u16",
        (Op::TypeInt, 16, _) => "i16",
        (Op::TypeInt, 32, 0) => "u32",
        (Op::TypeInt, 32, _) => "i32",
        (Op::TypeInt, 64, 0) => "u64",
        (Op::TypeInt, 64, _) => "i64",
        _ => return Err(format!("{opcode:?} of {bits} bits has no Rust spelling")),
    };
    Ok(Kind::Scalar(name, bits / 8))
}

/// The element of an array, or the column of a matrix, as wide as its stride: std140 keeps `mat3` in columns of four.
fn spaced(element: Kind, stride: Option<u32>) -> Result<Kind, String> {
    let (scalar, count) = match &element {
        Kind::Struct(_) => return Ok(element),
        Kind::Scalar(..) => (&element, 1),
        Kind::Array(inner, count) => (&**inner, *count),
    };
    match (scalar, stride) {
        (_, None) => Ok(element),
        (Kind::Scalar(_, bytes), Some(stride)) if bytes * count == stride => Ok(element),
        (Kind::Scalar(_, bytes), Some(stride)) if stride % bytes == 0 => {
            Ok(Kind::Array(Box::new(scalar.clone()), stride / bytes))
        }
        // Arrays of matrices and of arrays have no gaps of their own.
        (Kind::Array(..) | Kind::Struct(_), Some(_)) => Ok(element),
        (_, Some(stride)) => Err(format!("{stride} bytes from element to element have no Rust spelling")),
    }
}
