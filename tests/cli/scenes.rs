//! `surfel scenes`.

use crate::program::Program;

#[test]
fn every_scene_is_listed_with_its_parameters() {
    let text = Program::new().run("scenes").text().to_owned();
    for scene in surfel::verify::scenes::list() {
        let entry = text.split("\n\n").find(|entry| entry.starts_with(&format!("{}: ", scene.name)));
        let entry = entry.unwrap_or_else(|| panic!("{} is not in {text}", scene.name));
        assert!(entry.contains("--eye") && entry.contains("--fov"), "{entry}");
        for parameter in scene.surface_parameters {
            assert!(entry.contains(&format!("  {}={}: ", parameter.name, parameter.default)), "{entry}");
        }
    }
    assert!(text.contains("sampler=jittered") && text.contains("blue-noise, grid or scanner"), "{text}");
}
