//! No shader takes the root of a difference of products. A device may fuse a product with the difference, and rounds the other product alone:
//! the difference of equal products is then not 0 but a rounding error of either sign, and the root of a negative number is NaN.

use crate::shader_build::bundle::{Bundle, Spirv};
use crate::shader_build::compile_folder;
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::Op;
use std::collections::HashMap;
use std::path::Path;

/// GLSL.std.450: Sqrt and InverseSqrt.
const ROOTS: [u32; 2] = [31, 32];
/// GLSL.std.450: Fma, by which the compiler replaces sums and differences of products.
const FMA: [u32; 1] = [50];

fn is_product(value: &Instruction) -> bool {
    matches!(value.class.opcode, Op::FMul | Op::VectorTimesScalar | Op::Dot)
}

/// Whether a value is one of these functions of GLSL.std.450.
fn is_function(value: &Instruction, numbers: &[u32]) -> bool {
    let is = |operand: &Operand| matches!(operand, Operand::LiteralExtInstInteger(n) if numbers.contains(n));
    value.class.opcode == Op::ExtInst && value.operands.iter().any(is)
}

/// Number of roots of differences of products in a module.
fn faults(module: &Spirv) -> usize {
    let module = rspirv::dr::load_words(&module.words).expect("it is SPIR-V");
    let values: HashMap<u32, &Instruction> =
        module.all_inst_iter().filter_map(|value| Some((value.result_id?, value))).collect();
    let operands = |value: &Instruction| -> Vec<&Instruction> {
        let ids = value.operands.iter().filter_map(|operand| match operand {
            Operand::IdRef(id) => values.get(id).copied(),
            _ => None,
        });
        ids.collect()
    };
    let is_difference = |value: &Instruction| match value.class.opcode {
        Op::FSub => operands(value).into_iter().any(is_product),
        _ => is_function(value, &FMA) && operands(value).iter().any(|part| part.class.opcode == Op::FNegate),
    };
    let roots = module.all_inst_iter().filter(|value| is_function(value, &ROOTS));
    roots.filter(|root| operands(root).into_iter().any(is_difference)).count()
}

#[test]
fn no_root_is_of_a_difference_of_products() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders-glsl/compiled");
    let bundle = Bundle::read(&folder).expect("the compiled shaders are there");
    let faulty: Vec<_> =
        bundle.spirv.iter().filter(|module| faults(module) > 0).map(|module| &module.name).collect();
    assert!(
        faulty.is_empty(),
        "factor the differences, a² − b² = (a − b)(a + b), or bound them by max: {faulty:?}"
    );
}

#[test]
fn a_root_of_a_difference_of_products_is_found() {
    let faults_of = |expression: &str| {
        let root = tempfile::tempdir().expect("a temporary folder");
        let source = format!(
            "#version 460\n#ifdef COMPUTE\nlayout(local_size_x = 64) in;\nlayout(set = 0, binding = 7) buffer Out {{ vec4 v[]; }};\nvoid main() {{ vec4 p = v[gl_GlobalInvocationID.x]; v[0].x = {expression}; }}\n#endif\n"
        );
        std::fs::write(root.path().join("pass.glsl"), source).expect("a shader");
        let bundle = compile_folder(root.path(), String::new()).expect("it builds").bundle;
        bundle.spirv.iter().map(faults).sum::<usize>()
    };
    assert_eq!(faults_of("sqrt(p.x * p.x - p.y * p.y)"), 1);
    assert_eq!(faults_of("inversesqrt(1.0 - dot(p.xy, p.xy))"), 1);
    assert_eq!(faults_of("sqrt((p.x - p.y) * (p.x + p.y))"), 0);
    assert_eq!(faults_of("sqrt(max(p.x * p.x - p.y * p.y, 0.0))"), 0);
}
