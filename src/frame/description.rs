//! Frame description: variant and uniforms, decided from scenes, camera and settings before any resource is created.

use super::distinct::Distinct;
use super::group_culling::GroupCulling;
use super::normal_fields::may_bend;
use super::rasterizer::{Fit, rasterizer_of, width_of_sums};
use super::renderer::RenderOptions;
use super::scene_resources::batches_of;
use super::scene_variant::SceneVariant;
use super::selection::Selection;
use super::slicing::{Slicing, may_slice, total_splats_per_tile};
use super::splat_list::{ListExtent, extent_of, padded_instances, workgroup_of};
use super::uniforms::Uniforms;
use super::variant::Variant;
use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::scene::instance::Placed;
use crate::scene::{Scene, Streams};
use crate::settings::{Rasterizer, RasterizerChoice, RasterizerReason, Settings};
use crate::vk::Device;

/// Description of a frame.
pub struct Description {
    pub uniforms: Uniforms,
    pub variant: Variant,
    /// Reason for its rasterizer.
    pub reason: RasterizerReason,
    /// The variant without the choices by camera, size and density.
    base: Variant,
    /// Whether frames of these scenes may be sliced.
    may_slice: bool,
    streams: Vec<Streams>,
    /// Variants of its scenes.
    pub scenes: Vec<SceneVariant>,
    /// Of each distinct scene, the groups of clusters that may be drawn.
    pub selections: Vec<Selection>,
    /// Average splats per covered tile.
    pub splats_per_tile: f64,
    /// Level of detail, px.
    pub lod: f32,
}

/// Describes a frame; rejects unsupported frames.
pub fn describe(
    device: &Device,
    options: &RenderOptions,
    scenes: &[Placed<'_>],
    camera: &Camera,
    settings: &Settings,
    slicing: &Slicing,
) -> Result<Description> {
    settings.check()?;
    for Placed { scene, .. } in scenes {
        settings.splatting.normalization.check_weights(scene.weights.is_some())?;
        settings.check_primitives(scene.primitives.is_some())?;
    }
    settings.check_outputs(options.outputs)?;
    let lod = level_of_detail(scenes, camera, settings, options.size);
    let settings = &Settings { lod, ..settings.clone() };
    let uniforms = Uniforms::new(camera, settings, options.size, scenes)?;
    let perspective = camera.projection()?.perspective;
    let distinct = Distinct::new(scenes);
    let (mut selections, extent) = match options.rasterizer {
        RasterizerChoice::Require(Rasterizer::Draw) => {
            (distinct.scenes.iter().map(|scene| Selection::none(scene)).collect(), ListExtent::default())
        }
        _ => select(device, &distinct, &uniforms, perspective),
    };
    let workgroup = workgroup_of(device, extent);
    let is_seen = selections.iter().any(|selection| !selection.is_empty());
    let splats_per_tile =
        if is_seen { total_splats_per_tile(scenes, camera, options.size, lod) } else { 0.0 };
    // With a bound on the work of a tile there are no slices.
    let may_slice = device.capabilities().limited_loops && options.most_splats.is_none() && may_slice(scenes);
    let sliced = may_slice && slicing.needs_slices(scenes, splats_per_tile);
    if sliced {
        find_tiles(device, &distinct, &uniforms, perspective, options.size, &mut selections);
    }
    let streams: Vec<_> = scenes.iter().map(|placed| placed.scene.streams()).collect();
    let base = |options: &RenderOptions, rasterizer| {
        Variant::new(&streams, perspective, settings, options, rasterizer)
    };
    let tiled = base(options, Rasterizer::Compute).with_slices(sliced);
    let fit = Fit::new(device, options.size, workgroup.is_some(), &tiled);
    let (rasterizer, reason) = rasterizer_of(device, options, settings, scenes, fit)?;
    let precision = match settings.pull_push {
        Some(_) => options.precision,
        None => width_of_sums(device, options, rasterizer),
    };
    let options = RenderOptions { precision, ..*options };
    let base = Variant { workgroup: workgroup.unwrap_or_default(), ..base(&options, rasterizer) };
    let surfels = scenes.iter().map(|placed| placed.scene.count()).sum();
    let variant = Variant { distant: uniforms.is_distant(), ..base }
        .with_normal_fields(base.normal_fields && may_bend(scenes, camera, settings, options.size))
        .with_slices(sliced)
        .with_occlusion_culling(surfels, options.size.map(u64::from).iter().product());
    check_lookups(&variant, scenes)?;
    let scenes = scene_variants(variant, &streams, &uniforms);
    Ok(Description {
        uniforms,
        variant,
        reason,
        base,
        may_slice,
        streams,
        scenes,
        selections,
        splats_per_tile,
        lod,
    })
}

/// The variants of scenes with these `streams`.
fn scene_variants(variant: Variant, streams: &[Streams], uniforms: &Uniforms) -> Vec<SceneVariant> {
    let instanced = !uniforms.instances.is_empty();
    streams.iter().map(|streams| SceneVariant::new(variant, *streams, instanced)).collect()
}

impl Description {
    /// The variants that frames of these scenes and settings choose by camera, size and density alone, with those of their scenes.
    pub fn choices(&self) -> impl Iterator<Item = (Variant, Vec<SceneVariant>)> {
        let with_scenes = |variant| (variant, scene_variants(variant, &self.streams, &self.uniforms));
        self.base.choices(self.may_slice).into_iter().map(with_scenes)
    }
}

/// Selects the groups of clusters of each scene that may be drawn; also returns the extent of their splats.
fn select(
    device: &Device,
    distinct: &Distinct<'_>,
    uniforms: &Uniforms,
    perspective: bool,
) -> (Vec<Selection>, ListExtent) {
    let of_scene = |(scene, instances): (&&Scene, &Vec<usize>)| {
        let batches = batches_of(device, scene, padded_instances(instances.len() as u64));
        let culling = culling(scene, instances, uniforms, perspective);
        let selection = Selection::new(scene, &batches, instances.len() as u64, culling);
        let extent = extent_of(scene, &batches, &selection.room(None));
        (selection, extent)
    };
    let (selections, extents): (Vec<_>, Vec<_>) =
        distinct.scenes.iter().zip(&distinct.instances).map(of_scene).unzip();
    (selections, extents.into_iter().fold(ListExtent::default(), ListExtent::with))
}

/// Finds the tiles that selected groups may cover, of a picture of `size` px.
fn find_tiles(
    device: &Device,
    distinct: &Distinct<'_>,
    uniforms: &Uniforms,
    perspective: bool,
    size: [u32; 2],
    selections: &mut [Selection],
) {
    let scenes = distinct.scenes.iter().zip(&distinct.instances);
    for ((scene, instances), selection) in scenes.zip(selections) {
        let batches = batches_of(device, scene, padded_instances(instances.len() as u64));
        selection.find_tiles(scene, &batches, culling(scene, instances, uniforms, perspective), size);
    }
}

/// What culls the groups of an instance of a scene, which has these instances in the frame.
fn culling<'a>(
    scene: &'a Scene,
    instances: &'a [usize],
    uniforms: &'a Uniforms,
    perspective: bool,
) -> impl Fn(u64) -> GroupCulling<'a> {
    move |instance| {
        let view = uniforms.instances.get(instances[instance as usize]).unwrap_or(&uniforms.view);
        GroupCulling::new(&uniforms.frame, view, perspective, scene.level_table())
    }
}

/// The level of detail of a frame, px: that of the settings, or the least one that keeps to the most points.
fn level_of_detail(scenes: &[Placed<'_>], camera: &Camera, settings: &Settings, size: [u32; 2]) -> f32 {
    let Some(most) = settings.max_points else { return settings.lod };
    let drawn = scenes.iter().map(|placed| placed.most_drawn(camera, size)).reduce(|all, own| all.with(&own));
    drawn.map_or(settings.lod, |drawn| drawn.least_lod(most).max(settings.lod))
}

/// Rejects several scenes if one has a texture or materials: pixels look them up in one table.
fn check_lookups(variant: &Variant, scenes: &[Placed<'_>]) -> Result<()> {
    let refuse = |what: &str| {
        Err(Error::Usage(format!(
            "{} scenes in a frame of pull-push, of which one has {what}, which pixels of all scenes would look up: remove {what}, render \
             the scene alone, or choose a splatting method",
            scenes.len()
        )))
    };
    // Instances of one scene share texture coordinates, but not point ids.
    let alike = scenes.windows(2).all(|pair| pair[0].scene.id == pair[1].scene.id);
    if variant.texture.is_some() && !alike {
        return refuse("a texture");
    }
    if variant.materials && scenes.len() > 1 {
        return refuse("materials");
    }
    Ok(())
}
