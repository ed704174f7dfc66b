//! Traffic of passes, as their declarations imply it.

use super::methods::{Path, passes};
use super::pass::{Commands, Domain, Pass, Program, Programs};
use super::pyramids::Pyramids;
use super::renderer::RenderOptions;
use super::resource::Resource;
use super::scene_variant::SceneVariant;
use super::splat_buffers::SPLAT;
use super::splat_list::{ATTRIBUTE_ROW, BOX};
use super::target_descriptions::{Kind, describe, is_cleared, pixel_size};
use super::variant::Variant;
use crate::scene::{CLUSTER, Streams};
use crate::settings::{Rasterizer, Settings};
use crate::vk::shaders::layout::Cluster;

/// What a pass moves if each value that it declares to read or write moves once: streams, splats and targets.
///
/// Real traffic is higher where values are read again, as a splat is by every tile that it covers. It is lower in passes over tiles, which skip
/// hidden splats and empty tiles, and in those over pyramids, which skip samples without a point. Clip lines, lines and triangles are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PassTraffic {
    /// Name of the pass.
    pub name: &'static str,
    /// Bytes per drawn surfel.
    pub surfel: f64,
    /// Bytes per pixel of the picture.
    pub pixel: f64,
    /// Pixels that are written to images, per pixel of the picture: 0 or 1.
    pub written: f64,
    /// Atomic operations per drawn surfel.
    pub atomics: f64,
}

impl PassTraffic {
    /// The passes of a frame of one scene with these streams, in their order, with the clears before them; `perspective` or parallel rays. The
    /// device is not considered.
    pub fn of(
        scene: &Streams,
        perspective: bool,
        settings: &Settings,
        options: &RenderOptions,
        rasterizer: Rasterizer,
    ) -> Vec<Self> {
        let variant = Variant::new(&[*scene], perspective, settings, options, rasterizer);
        let of_scene = SceneVariant::new(variant, *scene, false);
        let mut list: Vec<Self> = Vec::new();
        for pass in passes(&variant, Path::of(&variant)) {
            for found in [cleared(pass, &variant), declared(pass, &of_scene, scene)] {
                match list.iter_mut().find(|known| known.name == found.name) {
                    Some(known) => known.add(&found),
                    None if found.surfel + found.pixel > 0.0 => list.push(found),
                    None => {}
                }
            }
        }
        list
    }

    /// Adds another step of the pass.
    fn add(&mut self, step: &Self) {
        self.surfel += step.surfel;
        self.pixel += step.pixel;
        self.written += step.written;
        self.atomics += step.atomics;
    }
}

/// The clear before a pass.
fn cleared(pass: &Pass, variant: &Variant) -> PassTraffic {
    // Of that list, only the length is.
    let is_list = |resource: &Resource| *resource == Resource::CoveredTiles;
    let cleared = pass.clears.iter().filter(|resource| !is_list(resource) && is_cleared(**resource, variant));
    let of = |resource: &Resource| match (resource, variant.pull_push) {
        (Resource::Pulled, Some(_)) => Pyramids::cleared(variant)[0],
        (Resource::Pushed, Some(_)) => Pyramids::cleared(variant)[1],
        _ => per_pixel(*resource, variant),
    };
    let pixel = cleared.map(of).sum();
    PassTraffic { name: "clear", pixel, ..PassTraffic::default() }
}

/// The pass itself.
fn declared(pass: &Pass, variant: &SceneVariant, scene: &Streams) -> PassTraffic {
    let programs = match pass.programs {
        Programs::OfFrame(programs) => programs(&variant.frame),
        Programs::OfScene(programs) => programs(variant),
    };
    let attached = match &pass.commands {
        Commands::Draws(targets) => {
            targets.colours.iter().chain(&targets.depth).map(|(resource, _)| *resource).collect()
        }
        Commands::Dispatches | Commands::Steps(_) => Vec::new(),
    };
    let mut all: Vec<Resource> = Vec::new();
    for resource in pass.reads.iter().chain(pass.writes).chain(&attached) {
        if !all.contains(resource) {
            all.push(*resource);
        }
    }
    let over =
        |domains: &[Domain]| programs.iter().any(|program: &Program| domains.contains(&program.domain));
    if over(&[Domain::OpenTiles, Domain::EdgeTiles, Domain::RevealedTiles, Domain::RevealedClusters]) {
        // The dispatch before has left the rest of what it would move.
        return PassTraffic { name: pass.name, ..PassTraffic::default() };
    }
    let over_clusters = over(&[Domain::Clusters]);
    let over_surfels = over(&[Domain::Surfels, Domain::SurfelSlots, Domain::VisibleClusters, Domain::Points]);
    let of_splats = match over_clusters {
        true => size_of::<Cluster>() as f64 / CLUSTER as f64,
        false => all.iter().map(|resource| per_surfel(*resource, &variant.frame)).sum::<u64>() as f64,
    };
    let streams = if over_surfels { of_streams(pass, &variant.frame, scene) } else { 0 };
    let is_image = |resource: &Resource| {
        let targets = describe(&variant.frame);
        targets.iter().any(|target| {
            target.resource == *resource && matches!(target.kind, Kind::Image(_) | Kind::Halved(_))
        })
    };
    // These have a sixty-fourth of the pixels.
    if over(&[Domain::CoarseLevels]) {
        all.retain(|resource| !matches!(resource, Resource::Pulled | Resource::Pushed));
    }
    let writes_image = pass.writes.iter().chain(&attached).any(is_image);
    let projects = over_surfels && pass.writes.contains(&Resource::Nearest);
    PassTraffic {
        name: pass.name,
        surfel: of_splats + streams as f64,
        pixel: all.iter().map(|resource| per_pixel(*resource, &variant.frame)).sum(),
        written: f64::from(u8::from(writes_image)),
        atomics: f64::from(u8::from(projects)),
    }
}

/// Bytes of a resource per surfel.
fn per_surfel(resource: Resource, variant: &Variant) -> u64 {
    match resource {
        Resource::Splats => SPLAT,
        Resource::Boxes if variant.is_tiled() => BOX,
        Resource::Attributes if variant.is_tiled() => ATTRIBUTE_ROW * variant.attribute_rows().max(1),
        Resource::Order if variant.unordered => 4,
        _ => 0,
    }
}

/// Bytes of a resource per pixel; of a pyramid, of its finest level.
fn per_pixel(resource: Resource, variant: &Variant) -> f64 {
    let target = describe(variant).into_iter().find(|target| target.resource == resource);
    match (resource, target) {
        (_, Some(target)) => pixel_size(&target),
        (Resource::Pulled, None) if variant.pull_push.is_some() => Pyramids::finest_level(variant)[0],
        (Resource::Pushed, None) if variant.pull_push.is_some() => Pyramids::finest_level(variant)[1],
        _ => 0.0,
    }
}

/// Bytes of a scene's streams per surfel that a pass over surfels reads: all for splats, with colours if sums are stored beside them; for
/// points the positions and the normals, as discs seen edge-on are left out.
fn of_streams(pass: &Pass, variant: &Variant, scene: &Streams) -> u64 {
    let makes_splats = pass.writes.contains(&Resource::Splats);
    let is_read = |name: &str| match name {
        "positions" | "normals" => true,
        "curvatures" => makes_splats && (variant.curvatures || variant.normal_fields),
        "colours" => makes_splats && variant.is_tiled() && variant.colours,
        "weights" => makes_splats && variant.weights,
        _ => makes_splats,
    };
    scene.per_surfel().into_iter().filter(|(name, _)| is_read(name)).map(|(_, bytes)| bytes).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ColourStream;
    use crate::settings::methods::{Method, perspective_ewa, pull_push};
    use crate::settings::{Alpha, Shading};

    fn of(method: Method, rasterizer: Rasterizer) -> Vec<PassTraffic> {
        let settings =
            Settings { shading: Shading::Lit, alpha: Alpha::Mask, ..method.settings().in_subpasses() };
        let streams = Streams::circles(ColourStream::None);
        PassTraffic::of(&streams, true, &settings, &RenderOptions::default(), rasterizer)
    }

    fn named(list: &[PassTraffic], name: &str) -> PassTraffic {
        list.iter().find(|pass| pass.name == name).unwrap_or_else(|| panic!("{name} in {list:?}")).clone()
    }

    #[test]
    fn splats_move_from_their_streams_to_tiles() {
        let computed = of(perspective_ewa::METHOD, Rasterizer::Compute);
        // Streams 28, splat 64, box 16, a row of attributes 16.
        assert_eq!(named(&computed, "footprint").surfel, 28.0 + 64.0 + 16.0 + 16.0);
        // They are read again; the picture has four floats a pixel, the list of covered tiles eight bytes a tile.
        let pixel = 16.0 + 8.0 / 64.0;
        let surface = PassTraffic { name: "surface", surfel: 96.0, pixel, written: 1.0, atomics: 0.0 };
        assert_eq!(named(&computed, "surface"), surface);
        let drawn = of(perspective_ewa::METHOD, Rasterizer::Draw);
        // Depth 4 and sums 16, of which visibility has the depth alone.
        let attribute =
            PassTraffic { name: "attribute", surfel: 64.0, pixel: 20.0, written: 1.0, atomics: 0.0 };
        assert_eq!(named(&drawn, "attribute"), attribute);
        assert_eq!(named(&drawn, "visibility").pixel, 4.0);
        // Depth and sums read, the picture written.
        assert_eq!(named(&drawn, "normalize").pixel, 4.0 + 16.0 + 16.0);
    }

    #[test]
    fn a_point_is_an_atomic_minimum() {
        let passes = of(pull_push::METHOD, Rasterizer::Compute);
        let project = named(&passes, "project");
        // Positions and normals; a distance and an id a pixel.
        assert_eq!((project.surfel, project.pixel, project.atomics), (24.0, 8.0, 1.0));
        // These, four words of a pulled and of a quarter of a pushed sample, the picture, and two lists of eight bytes a tile.
        assert_eq!(named(&passes, "clear").pixel, 8.0 + 16.0 + 4.0 + 16.0 + 2.0 * 8.0 / 256.0);
        // The pulled and the pushed samples of a pixel, and a list, or both lists.
        let [samples, list] = [36.0 + 9.0, 8.0 / 256.0];
        assert_eq!(named(&passes, "push").pixel, samples + 2.0 * list);
        assert_eq!(named(&passes, "filled").pixel, 2.0 * list);
        assert!(passes.iter().filter(|pass| pass.name != "project").all(|pass| pass.atomics == 0.0));
        assert!(passes.iter().all(|pass| pass.surfel >= 0.0 && pass.pixel >= 0.0));
    }
}
