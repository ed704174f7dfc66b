//! The compiled shaders of the hosts in `tools/hosts` are those of their GLSL.

use crate::shader_build::compile;
use crate::skipping::say_skipped;
use std::path::Path;

/// Writes them instead, as `tools/shaders` does.
const WRITE: &str = "SURFEL_WRITE_SHADERS";

#[test]
fn compiled_shaders_of_the_hosts_are_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let digest = std::fs::read_to_string(root.join("shaders-glsl/compiled/digest")).unwrap();
    let write = std::env::var_os(WRITE).is_some();
    // A test of the engine complains where the engine's are another compiler's than Debian's.
    if !write && !digest.contains(&compile::compiler()) {
        return say_skipped(&format!("{} is not the compiler of the hosts' shaders", compile::compiler()));
    }
    let shaders = root.join("tools/hosts/shaders");
    let modules = compile::folder(&shaders).expect("the hosts' shaders");
    let folder = shaders.join("compiled");
    if write {
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir(&folder).unwrap();
    }
    for module in &modules {
        let path = folder.join(module.file_name() + ".spv");
        let spirv: Vec<u8> = module.optimised.iter().flat_map(|word| word.to_le_bytes()).collect();
        if write {
            std::fs::write(&path, spirv).unwrap();
        } else {
            let same = std::fs::read(&path).is_ok_and(|kept| kept == spirv);
            assert!(same, "{}: run tools/shaders and commit what it writes", path.display());
        }
    }
    assert_eq!(
        folder.read_dir().unwrap().count(),
        modules.len(),
        "a shader that has no GLSL: run tools/shaders"
    );
}
