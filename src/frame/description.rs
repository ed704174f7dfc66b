//! What a frame is: decided from scenes, camera and settings, before anything is made.

use super::rasterizer::{Fit, rasterizer_of, width_of_sums};
use super::renderer::RenderOptions;
use super::splat_list::{room_of_frame, team_of};
use super::uniforms::Blocks;
use super::variant::{SceneVariant, Variant};
use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::scene::instance::Placed;
use crate::settings::Settings;
use crate::vk::Device;

/// What a frame is.
pub struct Description {
    pub blocks: Blocks,
    pub variant: Variant,
    /// What each of its scenes is.
    pub scenes: Vec<SceneVariant>,
}

/// What a frame of these scenes is, whose splats come in slices if they are `crowded`. Refuses what cannot be rendered.
pub fn describe(
    device: &Device,
    options: &RenderOptions,
    scenes: &[Placed<'_>],
    camera: &Camera,
    settings: &Settings,
    crowded: bool,
) -> Result<Description> {
    settings.check()?;
    for Placed { scene, .. } in scenes {
        settings.splatting.normalization.check_weights(scene.weights.is_some())?;
        settings.check_primitives(scene.primitives.is_some())?;
    }
    settings.check_outputs(options.outputs)?;
    let blocks = Blocks::new(camera, settings, options.size, scenes)?;
    let team = team_of(device, room_of_frame(device, scenes));
    let fit = Fit::new(device, options, team.is_some(), crowded);
    let rasterizer = rasterizer_of(device, options, settings, scenes, fit)?;
    let perspective = camera.projection()?.perspective;
    let precision = match settings.pull_push {
        Some(_) => options.precision,
        None => width_of_sums(device, options, rasterizer),
    };
    let options = RenderOptions { precision, ..*options };
    let streams: Vec<_> = scenes.iter().map(|placed| placed.scene.streams()).collect();
    let variant = Variant::new(&streams, perspective, settings, &options, rasterizer);
    let variant = Variant { team: team.unwrap_or_default(), ..variant }.crowded(crowded);
    check_lookups(&variant, scenes)?;
    let instanced = !blocks.instances.is_empty();
    let scenes = streams.into_iter().map(|streams| SceneVariant::new(variant, streams, instanced)).collect();
    Ok(Description { blocks, variant, scenes })
}

/// Refuses several scenes of which one has what is looked up pixel by pixel, where there is but one table of it.
fn check_lookups(variant: &Variant, scenes: &[Placed<'_>]) -> Result<()> {
    let refuse = |what: &str| {
        Err(Error::Usage(format!(
            "{} scenes in a frame of pull-push, of which one has {what}, which its pixels look up as if all were of that scene: leave {what} \
             out, show the scene alone, or choose a method that splats",
            scenes.len()
        )))
    };
    // Coordinates are the same wherever the scene stands; the numbers of its points are not.
    let alike = scenes.windows(2).all(|pair| pair[0].scene.id == pair[1].scene.id);
    if variant.texture.is_some() && !alike {
        return refuse("a texture");
    }
    if variant.materials && scenes.len() > 1 {
        return refuse("materials");
    }
    Ok(())
}
