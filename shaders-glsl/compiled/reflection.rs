// Made from shaders-glsl; see tools/shader_build.

/// The compute stage of `shaders-glsl/ambient.glsl`.
pub static AMBIENT_COMPUTE: Module = Module {
    name: "ambient_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("ambient_compute.spv"),
    constants: &[0, 66, 77],
    resources: &[(&resource::FRAME, false), (&resource::IMAGE_OUTPUT, true), (&resource::DEPTH_OUTPUT, false), (&resource::OCCLUSION, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/atomics.glsl`.
pub static ATOMICS_COMPUTE: Module = Module {
    name: "atomics_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("atomics_compute.spv"),
    constants: &[],
    resources: &[(&resource::WORDS, true)],
    push: size_of::<layout::AtomicOptions>() as u32,
};

/// The compute stage of `shaders-glsl/atomics.glsl`.
pub static ATOMICS_WIDE_COMPUTE: Module = Module {
    name: "atomics_wide_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("atomics_wide_compute.spv"),
    constants: &[],
    resources: &[(&resource::WIDE_WORDS, true)],
    push: size_of::<layout::AtomicOptions>() as u32,
};

/// The vertex stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_VERTEX: Module = Module {
    name: "attribute_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("attribute_vertex.spv"),
    constants: &[0, 3, 5, 7, 12, 13, 14, 15, 16, 17, 19, 20, 22, 26, 27, 37, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 67, 70, 78, 79, 83, 84],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::WEIGHTS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_FRAGMENT: Module = Module {
    name: "attribute_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("attribute_fragment.spv"),
    constants: &[0, 4, 15, 16, 19, 27, 70, 79, 83],
    resources: &[(&resource::FRAME, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_COMPUTE: Module = Module {
    name: "attribute_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("attribute_compute.spv"),
    constants: &[0, 3, 4, 14, 15, 16, 17, 19, 23, 24, 44, 45, 46, 47, 67, 70, 79, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VISIBILITY, false), (&resource::SUMS0, true), (&resource::SUMS1, true), (&resource::INCOMPLETE_FRAME, true), (&resource::BOXES, false), (&resource::FRAME_SPLATS, false), (&resource::FRAME_ATTRIBUTES, false), (&resource::FRAME_CLIPS, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The vertex stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_CLIP_LINES_VERTEX: Module = Module {
    name: "attribute_clip_lines_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("attribute_clip_lines_vertex.spv"),
    constants: &[0, 3, 5, 7, 12, 13, 14, 15, 16, 17, 19, 20, 22, 23, 26, 27, 37, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 67, 70, 78, 79, 83, 84],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::CLIPS, false), (&resource::WEIGHTS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_CLIP_LINES_FRAGMENT: Module = Module {
    name: "attribute_clip_lines_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("attribute_clip_lines_fragment.spv"),
    constants: &[0, 4, 15, 16, 19, 23, 24, 27, 70, 79, 83],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_SUBGROUPS_COMPUTE: Module = Module {
    name: "attribute_subgroups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("attribute_subgroups_compute.spv"),
    constants: &[0, 3, 4, 14, 15, 16, 17, 19, 23, 24, 44, 45, 46, 47, 67, 70, 79, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VISIBILITY, false), (&resource::SUMS0, true), (&resource::SUMS1, true), (&resource::INCOMPLETE_FRAME, true), (&resource::BOX_TEXELS, false), (&resource::SPLAT_TEXELS, false), (&resource::ATTRIBUTE_TEXELS, false), (&resource::CLIP_TEXELS, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The fragment stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_BEHIND_FRAGMENT: Module = Module {
    name: "attribute_behind_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("attribute_behind_fragment.spv"),
    constants: &[0, 4, 15, 16, 19, 27, 70, 79, 83],
    resources: &[(&resource::FRAME, false), (&resource::VISIBILITY_IMAGE, false)],
    push: 0,
};

/// The fragment stage of `shaders-glsl/attribute.glsl`.
pub static ATTRIBUTE_BEHIND_CLIP_LINES_FRAGMENT: Module = Module {
    name: "attribute_behind_clip_lines_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("attribute_behind_clip_lines_fragment.spv"),
    constants: &[0, 4, 15, 16, 19, 23, 24, 27, 70, 79, 83],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false), (&resource::VISIBILITY_IMAGE, false)],
    push: 0,
};

/// The vertex stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_VERTEX: Module = Module {
    name: "behind_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("behind_vertex.spv"),
    constants: &[0, 15, 16, 23, 37, 67, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::VIEWS, false), (&resource::CLIPS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_FRAGMENT: Module = Module {
    name: "behind_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("behind_fragment.spv"),
    constants: &[0, 15, 16, 23, 24, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false), (&resource::COVERAGE, true), (&resource::VISIBILITY_IMAGE, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_COMPUTE: Module = Module {
    name: "behind_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("behind_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 14, 15, 16, 17, 18, 19, 20, 23, 24, 44, 45, 46, 47, 67, 70, 72, 76, 79, 81, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, false), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, false), (&resource::BOXES, false), (&resource::FRAME_SPLATS, false), (&resource::FRAME_ATTRIBUTES, false), (&resource::FRAME_CLIPS, false), (&resource::EDGE_TILES, true)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_SUBGROUPS_COMPUTE: Module = Module {
    name: "behind_subgroups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("behind_subgroups_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 14, 15, 16, 17, 18, 19, 20, 23, 24, 44, 45, 46, 47, 67, 70, 72, 76, 79, 81, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, false), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, false), (&resource::BOX_TEXELS, false), (&resource::SPLAT_TEXELS, false), (&resource::ATTRIBUTE_TEXELS, false), (&resource::CLIP_TEXELS, false), (&resource::EDGE_TILES, true)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_SLICES_COMPUTE: Module = Module {
    name: "behind_slices_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("behind_slices_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 14, 15, 16, 17, 18, 19, 20, 23, 24, 44, 45, 46, 47, 67, 70, 72, 74, 76, 79, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, false), (&resource::SUMS0, true), (&resource::SUMS1, true), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOXES, false), (&resource::FRAME_SPLATS, false), (&resource::FRAME_ATTRIBUTES, false), (&resource::FRAME_CLIPS, false), (&resource::BEHIND_DEPTHS, true)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_SUBGROUPS_SLICES_COMPUTE: Module = Module {
    name: "behind_subgroups_slices_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("behind_subgroups_slices_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 14, 15, 16, 17, 18, 19, 20, 23, 24, 44, 45, 46, 47, 67, 70, 72, 74, 76, 79, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, false), (&resource::SUMS0, true), (&resource::SUMS1, true), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOX_TEXELS, false), (&resource::SPLAT_TEXELS, false), (&resource::ATTRIBUTE_TEXELS, false), (&resource::CLIP_TEXELS, false), (&resource::BEHIND_DEPTHS, true)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_MIX_COMPUTE: Module = Module {
    name: "behind_mix_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("behind_mix_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 17, 18, 20, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::IMAGE_OUTPUT, true), (&resource::COVERAGE, false), (&resource::SUMS0_IMAGE, false), (&resource::SUMS1_IMAGE, false), (&resource::BEHIND_IMAGE, false)],
    push: 0,
};

/// The fragment stage of `shaders-glsl/behind.glsl`.
pub static BEHIND_NEAREST_SAMPLES_FRAGMENT: Module = Module {
    name: "behind_nearest_samples_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("behind_nearest_samples_fragment.spv"),
    constants: &[0, 15, 16, 23, 24, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false), (&resource::COVERAGE, true), (&resource::VISIBILITY_IMAGE, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/boxes.glsl`.
pub static BOXES_COMPUTE: Module = Module {
    name: "boxes_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("boxes_compute.spv"),
    constants: &[63, 80],
    resources: &[(&resource::BOXES, true), (&resource::REVEALED_TILES, true)],
    push: size_of::<layout::Level>() as u32,
};

/// The compute stage of `shaders-glsl/boxes.glsl`.
pub static BOXES_SUBGROUPS_COMPUTE: Module = Module {
    name: "boxes_subgroups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("boxes_subgroups_compute.spv"),
    constants: &[63, 80],
    resources: &[(&resource::BOXES, true), (&resource::BOX_TEXELS, false), (&resource::REVEALED_TILES, true)],
    push: size_of::<layout::Level>() as u32,
};

/// The vertex stage of `shaders-glsl/colour_map.glsl`.
pub static COLOUR_MAP_VERTEX: Module = Module {
    name: "colour_map_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("colour_map_vertex.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The fragment stage of `shaders-glsl/colour_map.glsl`.
pub static COLOUR_MAP_FRAGMENT: Module = Module {
    name: "colour_map_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("colour_map_fragment.spv"),
    constants: &[6],
    resources: &[(&resource::SCREEN, false), (&resource::VALUE_RANGE, false), (&resource::MAP_COLOURS, false)],
    push: size_of::<layout::ScalarOptions>() as u32,
};

/// The vertex stage of `shaders-glsl/composite.glsl`.
pub static COMPOSITE_VERTEX: Module = Module {
    name: "composite_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("composite_vertex.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The fragment stage of `shaders-glsl/composite.glsl`.
pub static COMPOSITE_FRAGMENT: Module = Module {
    name: "composite_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("composite_fragment.spv"),
    constants: &[0, 40, 41, 44],
    resources: &[(&resource::PICTURE_IMAGE, false), (&resource::DEPTH_IMAGE, false)],
    push: size_of::<layout::Composite>() as u32,
};

/// The fragment stage of `shaders-glsl/composite.glsl`.
pub static COMPOSITE_NORMALS_FRAGMENT: Module = Module {
    name: "composite_normals_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("composite_normals_fragment.spv"),
    constants: &[0, 40, 41, 44],
    resources: &[(&resource::PICTURE_IMAGE, false), (&resource::NORMAL_IMAGE, false), (&resource::DEPTH_IMAGE, false)],
    push: size_of::<layout::Composite>() as u32,
};

/// The fragment stage of `shaders-glsl/composite.glsl`.
pub static COMPOSITE_IDS_FRAGMENT: Module = Module {
    name: "composite_ids_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("composite_ids_fragment.spv"),
    constants: &[0, 40, 41, 44],
    resources: &[(&resource::PICTURE_IMAGE, false), (&resource::DEPTH_IMAGE, false), (&resource::ID_IMAGE, false)],
    push: size_of::<layout::Composite>() as u32,
};

/// The fragment stage of `shaders-glsl/composite.glsl`.
pub static COMPOSITE_NORMALS_IDS_FRAGMENT: Module = Module {
    name: "composite_normals_ids_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("composite_normals_ids_fragment.spv"),
    constants: &[0, 40, 41, 44],
    resources: &[(&resource::PICTURE_IMAGE, false), (&resource::NORMAL_IMAGE, false), (&resource::DEPTH_IMAGE, false), (&resource::ID_IMAGE, false)],
    push: size_of::<layout::Composite>() as u32,
};

/// The compute stage of `shaders-glsl/copy.glsl`.
pub static COPY_COMPUTE: Module = Module {
    name: "copy_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("copy_compute.spv"),
    constants: &[17, 33, 38, 39],
    resources: &[(&resource::TO_IMAGE0, true), (&resource::TO_IMAGE1, true), (&resource::TO_IMAGE2, true), (&resource::TO_IMAGE3, true), (&resource::TO_IMAGE4, true), (&resource::FROM_QUAD0, false), (&resource::FROM_QUAD1, false), (&resource::FROM_QUAD2, false), (&resource::FROM_SINGLE0, false), (&resource::FROM_SINGLE1, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/covered.glsl`.
pub static COVERED_COMPUTE: Module = Module {
    name: "covered_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("covered_compute.spv"),
    constants: &[],
    resources: &[(&resource::FRAME, false), (&resource::BOXES, false), (&resource::COVERED_TILES, true)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/covered.glsl`.
pub static COVERED_SUBGROUPS_COMPUTE: Module = Module {
    name: "covered_subgroups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("covered_subgroups_compute.spv"),
    constants: &[],
    resources: &[(&resource::FRAME, false), (&resource::BOX_TEXELS, false), (&resource::COVERED_TILES, true)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/cull.glsl`.
pub static CULL_COMPUTE: Module = Module {
    name: "cull_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("cull_compute.spv"),
    constants: &[0, 1, 2, 15, 37, 64, 73],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBLE_CLUSTERS, true), (&resource::CLUSTERS, false), (&resource::GROUPS, false), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/cull.glsl`.
pub static CULL_TILES_COMPUTE: Module = Module {
    name: "cull_tiles_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("cull_tiles_compute.spv"),
    constants: &[0, 1, 2, 15, 37, 64, 73, 79, 80],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBLE_CLUSTERS, true), (&resource::CLUSTERS, false), (&resource::GROUPS, false), (&resource::HIDDEN_CLUSTERS, true), (&resource::BOXES, true), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The vertex stage of `shaders-glsl/darken.glsl`.
pub static DARKEN_VERTEX: Module = Module {
    name: "darken_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("darken_vertex.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The fragment stage of `shaders-glsl/darken.glsl`.
pub static DARKEN_FRAGMENT: Module = Module {
    name: "darken_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("darken_fragment.spv"),
    constants: &[],
    resources: &[(&resource::PICTURE_IMAGE, false)],
    push: size_of::<layout::Darken>() as u32,
};

/// The compute stage of `shaders-glsl/distance.glsl`.
pub static DISTANCE_COMPUTE: Module = Module {
    name: "distance_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("distance_compute.spv"),
    constants: &[0],
    resources: &[(&resource::FRAME, false), (&resource::IMAGE_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::HOST_DEPTH_IMAGE, false)],
    push: size_of::<layout::Distance>() as u32,
};

/// The compute stage of `shaders-glsl/distance.glsl`.
pub static DISTANCE_MULTISAMPLED_COMPUTE: Module = Module {
    name: "distance_multisampled_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("distance_multisampled_compute.spv"),
    constants: &[0, 43],
    resources: &[(&resource::FRAME, false), (&resource::IMAGE_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::HOST_DEPTH_SAMPLES, false)],
    push: size_of::<layout::Distance>() as u32,
};

/// The compute stage of `shaders-glsl/edl.glsl`.
pub static EDL_COMPUTE: Module = Module {
    name: "edl_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("edl_compute.spv"),
    constants: &[0, 66],
    resources: &[(&resource::FRAME, false), (&resource::IMAGE_OUTPUT, true), (&resource::DEPTH_OUTPUT, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/fetch.glsl`.
pub static FETCH_COMPUTE: Module = Module {
    name: "fetch_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("fetch_compute.spv"),
    constants: &[0, 1, 5, 12, 13, 17, 22, 28, 33, 34, 37, 38, 39, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 68, 73, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::NEAREST, false), (&resource::OCCUPIED_TILES, false), (&resource::TO_IMAGE0, true), (&resource::TO_IMAGE1, true), (&resource::TO_IMAGE2, true), (&resource::TO_IMAGE3, true), (&resource::TO_IMAGE4, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/fetch.glsl`.
pub static FETCH_LINES_COMPUTE: Module = Module {
    name: "fetch_lines_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("fetch_lines_compute.spv"),
    constants: &[0, 17, 28, 29, 33, 34, 37, 38, 39, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VERTICES, false), (&resource::LINE_DIRECTIONS, false), (&resource::VERTEX_COLOURS, false), (&resource::ELEMENTS, false), (&resource::NEAREST, false), (&resource::OCCUPIED_TILES, false), (&resource::TO_IMAGE0, true), (&resource::TO_IMAGE1, true), (&resource::TO_IMAGE2, true), (&resource::TO_IMAGE3, true), (&resource::TO_IMAGE4, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/fetch.glsl`.
pub static FETCH_TRIANGLES_COMPUTE: Module = Module {
    name: "fetch_triangles_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("fetch_triangles_compute.spv"),
    constants: &[0, 17, 28, 29, 33, 34, 37, 38, 39, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VERTICES, false), (&resource::VERTEX_COLOURS, false), (&resource::ELEMENTS, false), (&resource::NEAREST, false), (&resource::OCCUPIED_TILES, false), (&resource::TO_IMAGE0, true), (&resource::TO_IMAGE1, true), (&resource::TO_IMAGE2, true), (&resource::TO_IMAGE3, true), (&resource::TO_IMAGE4, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/fetch.glsl`.
pub static FETCH_RASTER_POINTS_COMPUTE: Module = Module {
    name: "fetch_raster_points_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("fetch_raster_points_compute.spv"),
    constants: &[0, 1, 5, 12, 13, 17, 22, 28, 33, 34, 37, 38, 39, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 68, 73, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::NEAREST_ID, false), (&resource::OCCUPIED_TILES, false), (&resource::TO_IMAGE0, true), (&resource::TO_IMAGE1, true), (&resource::TO_IMAGE2, true), (&resource::TO_IMAGE3, true), (&resource::TO_IMAGE4, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The vertex stage of `shaders-glsl/fill.glsl`.
pub static FILL_VERTEX: Module = Module {
    name: "fill_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("fill_vertex.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The fragment stage of `shaders-glsl/fill.glsl`.
pub static FILL_FRAGMENT: Module = Module {
    name: "fill_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("fill_fragment.spv"),
    constants: &[],
    resources: &[],
    push: size_of::<layout::FillOptions>() as u32,
};

/// The compute stage of `shaders-glsl/filled.glsl`.
pub static FILLED_COMPUTE: Module = Module {
    name: "filled_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("filled_compute.spv"),
    constants: &[33],
    resources: &[(&resource::FRAME, false), (&resource::OCCUPIED_TILES, false), (&resource::FILLED_TILES, true), (&resource::FINAL_QUAD0, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/filter.glsl`.
pub static FILTER_COMPUTE: Module = Module {
    name: "filter_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("filter_compute.spv"),
    constants: &[31, 66],
    resources: &[(&resource::FRAME, false), (&resource::IMAGE_OUTPUT, false), (&resource::FILTERED, true)],
    push: 0,
};

/// The compute stage of `shaders-glsl/filter.glsl`.
pub static FILTER_COVERED_COMPUTE: Module = Module {
    name: "filter_covered_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("filter_covered_compute.spv"),
    constants: &[31, 66],
    resources: &[(&resource::FRAME, false), (&resource::IMAGE_OUTPUT, false), (&resource::FILTERED, true), (&resource::COVERED_TILES, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/footprint.glsl`.
pub static FOOTPRINT_COMPUTE: Module = Module {
    name: "footprint_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("footprint_compute.spv"),
    constants: &[0, 1, 2, 12, 13, 14, 15, 16, 21, 22, 23, 37, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 67, 68, 70, 73, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLAT_LAYOUT, true), (&resource::SPLATS, true), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::CLIPS, false), (&resource::SCREEN_CLIPS, true), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/footprint.glsl`.
pub static FOOTPRINT_TILES_COMPUTE: Module = Module {
    name: "footprint_tiles_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("footprint_tiles_compute.spv"),
    constants: &[0, 1, 2, 3, 5, 7, 12, 13, 14, 15, 16, 17, 19, 20, 21, 22, 23, 26, 27, 37, 45, 46, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, 67, 68, 70, 73, 78, 79, 83, 84],
    resources: &[(&resource::FRAME, false), (&resource::SPLAT_LAYOUT, true), (&resource::SPLATS, true), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::SPLAT_ATTRIBUTES, true), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::CLIPS, false), (&resource::SCREEN_CLIPS, true), (&resource::WEIGHTS, false), (&resource::SPLAT_BOXES, true), (&resource::ORDER, false), (&resource::VISIBLE_CLUSTERS, false), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/hidden.glsl`.
pub static HIDDEN_COMPUTE: Module = Module {
    name: "hidden_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("hidden_compute.spv"),
    constants: &[0, 2, 15, 37, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBLE_CLUSTERS, true), (&resource::CLUSTERS, false), (&resource::GROUPS, false), (&resource::HIDDEN_CLUSTERS, true), (&resource::BOXES, true), (&resource::OPEN_TILES, true), (&resource::REVEALED_TILES, true), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The vertex stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_VERTEX: Module = Module {
    name: "nearest_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("nearest_vertex.spv"),
    constants: &[0, 3, 5, 7, 15, 16, 17, 20, 22, 37, 50, 51, 52, 53, 54, 57, 58, 67, 70, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_FRAGMENT: Module = Module {
    name: "nearest_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("nearest_fragment.spv"),
    constants: &[0, 4, 15, 16, 70, 79],
    resources: &[(&resource::FRAME, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_COMPUTE: Module = Module {
    name: "nearest_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("nearest_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 15, 16, 17, 18, 20, 23, 24, 31, 44, 45, 47, 67, 70, 72, 76, 79, 82],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::BOXES, false), (&resource::FRAME_SPLATS, false), (&resource::FRAME_ATTRIBUTES, false), (&resource::FRAME_CLIPS, false), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::COVERED_TILES, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The vertex stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_COVERAGE_VERTEX: Module = Module {
    name: "nearest_coverage_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("nearest_coverage_vertex.spv"),
    constants: &[0, 3, 5, 7, 15, 16, 17, 20, 22, 23, 37, 50, 51, 52, 53, 54, 57, 58, 67, 70, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::CLIPS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_COVERAGE_FRAGMENT: Module = Module {
    name: "nearest_coverage_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("nearest_coverage_fragment.spv"),
    constants: &[0, 4, 15, 16, 23, 24, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false), (&resource::COVERAGE, true)],
    push: 0,
};

/// The vertex stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_CLIP_LINES_VERTEX: Module = Module {
    name: "nearest_clip_lines_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("nearest_clip_lines_vertex.spv"),
    constants: &[0, 3, 5, 7, 15, 16, 17, 20, 22, 23, 37, 50, 51, 52, 53, 54, 57, 58, 67, 70, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::CLIPS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_CLIP_LINES_FRAGMENT: Module = Module {
    name: "nearest_clip_lines_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("nearest_clip_lines_fragment.spv"),
    constants: &[0, 4, 15, 16, 23, 24, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_SUBGROUPS_COMPUTE: Module = Module {
    name: "nearest_subgroups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("nearest_subgroups_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 15, 16, 17, 18, 20, 23, 24, 31, 44, 45, 47, 67, 70, 72, 76, 79, 82],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::BOX_TEXELS, false), (&resource::SPLAT_TEXELS, false), (&resource::ATTRIBUTE_TEXELS, false), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::CLIP_TEXELS, false), (&resource::COVERED_TILES, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_SLICES_COMPUTE: Module = Module {
    name: "nearest_slices_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("nearest_slices_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 15, 16, 17, 18, 20, 23, 24, 31, 44, 45, 47, 67, 70, 72, 76, 79, 82],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, true), (&resource::SUMS0, true), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOXES, false), (&resource::FRAME_SPLATS, false), (&resource::FRAME_ATTRIBUTES, false), (&resource::FRAME_CLIPS, false), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/nearest.glsl`.
pub static NEAREST_SUBGROUPS_SLICES_COMPUTE: Module = Module {
    name: "nearest_subgroups_slices_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("nearest_subgroups_slices_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 15, 16, 17, 18, 20, 23, 24, 31, 44, 45, 47, 67, 70, 72, 76, 79, 82],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, true), (&resource::SUMS0, true), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOX_TEXELS, false), (&resource::SPLAT_TEXELS, false), (&resource::ATTRIBUTE_TEXELS, false), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::CLIP_TEXELS, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The vertex stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_VERTEX: Module = Module {
    name: "normalize_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("normalize_vertex.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The fragment stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_FRAGMENT: Module = Module {
    name: "normalize_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("normalize_fragment.spv"),
    constants: &[0, 3, 4, 6, 7, 17, 18, 20, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY_IMAGE, false), (&resource::SUMS0_IMAGE, false), (&resource::SUMS1_IMAGE, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_COMPUTE: Module = Module {
    name: "normalize_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("normalize_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 17, 18, 20, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, false), (&resource::SUMS0, false), (&resource::SUMS1, false), (&resource::IMAGE_OUTPUT, true), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true)],
    push: 0,
};

/// The vertex stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_COVERAGE_VERTEX: Module = Module {
    name: "normalize_coverage_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("normalize_coverage_vertex.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The fragment stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_COVERAGE_FRAGMENT: Module = Module {
    name: "normalize_coverage_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("normalize_coverage_fragment.spv"),
    constants: &[0, 3, 4, 6, 7, 17, 18, 20, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::COVERAGE, false), (&resource::VISIBILITY_IMAGE, false), (&resource::SUMS0_IMAGE, false), (&resource::SUMS1_IMAGE, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_COVERAGE_COMPUTE: Module = Module {
    name: "normalize_coverage_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("normalize_coverage_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 17, 18, 20, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, false), (&resource::SUMS0, false), (&resource::SUMS1, false), (&resource::IMAGE_OUTPUT, true), (&resource::COVERAGE, false), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true)],
    push: 0,
};

/// The fragment stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_SUBPASS_FRAGMENT: Module = Module {
    name: "normalize_subpass_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("normalize_subpass_fragment.spv"),
    constants: &[0, 3, 4, 6, 7, 17, 18, 20, 40, 41, 42, 44, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY_INPUT, false), (&resource::SUMS0_INPUT, false), (&resource::SUMS1_INPUT, false)],
    push: size_of::<layout::Subpass>() as u32,
};

/// The fragment stage of `shaders-glsl/normalize.glsl`.
pub static NORMALIZE_SUBPASS_COVERAGE_FRAGMENT: Module = Module {
    name: "normalize_subpass_coverage_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("normalize_subpass_coverage_fragment.spv"),
    constants: &[0, 3, 4, 6, 7, 17, 18, 20, 40, 41, 42, 44, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::COVERAGE, false), (&resource::VISIBILITY_INPUT, false), (&resource::SUMS0_INPUT, false), (&resource::SUMS1_INPUT, false)],
    push: size_of::<layout::Subpass>() as u32,
};

/// The compute stage of `shaders-glsl/occlusion.glsl`.
pub static OCCLUSION_COMPUTE: Module = Module {
    name: "occlusion_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("occlusion_compute.spv"),
    constants: &[0],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::DEPTH_OUTPUT, false), (&resource::OCCLUSION, true)],
    push: 0,
};

/// The compute stage of `shaders-glsl/occupied.glsl`.
pub static OCCUPIED_COMPUTE: Module = Module {
    name: "occupied_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("occupied_compute.spv"),
    constants: &[],
    resources: &[(&resource::FRAME, false), (&resource::NEAREST, false), (&resource::OCCUPIED_TILES, true)],
    push: 0,
};

/// The compute stage of `shaders-glsl/occupied.glsl`.
pub static OCCUPIED_RASTER_POINTS_COMPUTE: Module = Module {
    name: "occupied_raster_points_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("occupied_raster_points_compute.spv"),
    constants: &[],
    resources: &[(&resource::FRAME, false), (&resource::NEAREST_ID, false), (&resource::OCCUPIED_TILES, true)],
    push: 0,
};

/// The compute stage of `shaders-glsl/open.glsl`.
pub static OPEN_COMPUTE: Module = Module {
    name: "open_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("open_compute.spv"),
    constants: &[],
    resources: &[(&resource::FRAME, false), (&resource::OPEN_TILES, true), (&resource::COVERED_TILES, true)],
    push: 0,
};

/// The compute stage of `shaders-glsl/open.glsl`.
pub static OPEN_EDGES_COMPUTE: Module = Module {
    name: "open_edges_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("open_edges_compute.spv"),
    constants: &[],
    resources: &[(&resource::FRAME, false), (&resource::EDGE_TILES, true)],
    push: 0,
};

/// The compute stage of `shaders-glsl/open.glsl`.
pub static OPEN_REVEALED_COMPUTE: Module = Module {
    name: "open_revealed_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("open_revealed_compute.spv"),
    constants: &[],
    resources: &[(&resource::FRAME, false), (&resource::REVEALED_TILES, true), (&resource::COVERED_TILES, true)],
    push: 0,
};

/// The compute stage of `shaders-glsl/order.glsl`.
pub static ORDER_COMPUTE: Module = Module {
    name: "order_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("order_compute.spv"),
    constants: &[50, 51, 78],
    resources: &[(&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::ORDER, true)],
    push: size_of::<layout::OrderStep>() as u32,
};

/// The compute stage of `shaders-glsl/order.glsl`.
pub static ORDER_TOTALS_COMPUTE: Module = Module {
    name: "order_totals_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("order_totals_compute.spv"),
    constants: &[],
    resources: &[(&resource::ORDER, true)],
    push: size_of::<layout::OrderStep>() as u32,
};

/// The compute stage of `shaders-glsl/order.glsl`.
pub static ORDER_SCAN_COMPUTE: Module = Module {
    name: "order_scan_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("order_scan_compute.spv"),
    constants: &[],
    resources: &[(&resource::ORDER, true)],
    push: size_of::<layout::OrderStep>() as u32,
};

/// The compute stage of `shaders-glsl/order.glsl`.
pub static ORDER_SCATTER_COMPUTE: Module = Module {
    name: "order_scatter_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("order_scatter_compute.spv"),
    constants: &[],
    resources: &[(&resource::ORDER, true)],
    push: size_of::<layout::OrderStep>() as u32,
};

/// The vertex stage of `shaders-glsl/points.glsl`.
pub static POINTS_VERTEX: Module = Module {
    name: "points_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("points_vertex.spv"),
    constants: &[0, 1, 12, 13, 22, 37, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 73, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/points.glsl`.
pub static POINTS_FRAGMENT: Module = Module {
    name: "points_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("points_fragment.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The compute stage of `shaders-glsl/project.glsl`.
pub static PROJECT_COMPUTE: Module = Module {
    name: "project_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("project_compute.spv"),
    constants: &[0, 1, 2, 12, 13, 22, 37, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, 73, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::VISIBLE_CLUSTERS, false), (&resource::NEAREST, true), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/project.glsl`.
pub static PROJECT_LINES_COMPUTE: Module = Module {
    name: "project_lines_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("project_lines_compute.spv"),
    constants: &[0, 28, 37, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VERTICES, false), (&resource::LINE_DIRECTIONS, false), (&resource::ELEMENTS, false), (&resource::NEAREST, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/project.glsl`.
pub static PROJECT_TRIANGLES_COMPUTE: Module = Module {
    name: "project_triangles_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("project_triangles_compute.spv"),
    constants: &[0, 30, 37, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VERTICES, false), (&resource::ELEMENTS, false), (&resource::LARGE_TRIANGLES, true), (&resource::NEAREST, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/project.glsl`.
pub static PROJECT_RASTER_POINTS_COMPUTE: Module = Module {
    name: "project_raster_points_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("project_raster_points_compute.spv"),
    constants: &[0],
    resources: &[(&resource::FRAME, false), (&resource::NEAREST, true), (&resource::NEAREST_DEPTH, false), (&resource::NEAREST_ID, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/project.glsl`.
pub static PROJECT_COUNT_ONLY_COMPUTE: Module = Module {
    name: "project_count_only_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("project_count_only_compute.spv"),
    constants: &[0, 1, 2, 12, 13, 22, 37, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 73, 78, 79],
    resources: &[(&resource::FRAME, false), (&resource::LATTICE_POSITIONS, false), (&resource::POSITIONS, false), (&resource::NORMALS, false), (&resource::LATTICES, false), (&resource::RADII, false), (&resource::COLOURS, false), (&resource::VIEWS, false), (&resource::ELLIPSE_WORDS, false), (&resource::ELLIPSES, false), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/pull.glsl`.
pub static PULL_COMPUTE: Module = Module {
    name: "pull_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("pull_compute.spv"),
    constants: &[0, 17, 28, 32, 33, 34, 35, 38, 39, 68],
    resources: &[(&resource::VIEWS, false), (&resource::OCCUPIED_TILES, false), (&resource::TO_IMAGE0, true), (&resource::TO_IMAGE1, true), (&resource::TO_IMAGE2, true), (&resource::TO_IMAGE3, true), (&resource::TO_IMAGE4, true), (&resource::FROM_QUAD0, false), (&resource::FROM_QUAD1, false), (&resource::FROM_QUAD2, false), (&resource::FROM_SINGLE0, false), (&resource::FROM_SINGLE1, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/push.glsl`.
pub static PUSH_COMPUTE: Module = Module {
    name: "push_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("push_compute.spv"),
    constants: &[0, 17, 28, 32, 33, 34, 35, 38, 39, 65, 68, 79],
    resources: &[(&resource::VIEWS, false), (&resource::FILLED_TILES, false), (&resource::TO_IMAGE0, true), (&resource::TO_IMAGE1, true), (&resource::TO_IMAGE2, true), (&resource::TO_IMAGE3, true), (&resource::TO_IMAGE4, true), (&resource::FINAL_QUAD0, false), (&resource::FINAL_QUAD1, false), (&resource::FINAL_QUAD2, false), (&resource::FINAL_SINGLE0, false), (&resource::FINAL_SINGLE1, false), (&resource::FROM_QUAD0, false), (&resource::FROM_QUAD1, false), (&resource::FROM_QUAD2, false), (&resource::FROM_SINGLE0, false), (&resource::FROM_SINGLE1, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/range.glsl`.
pub static RANGE_COMPUTE: Module = Module {
    name: "range_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("range_compute.spv"),
    constants: &[],
    resources: &[(&resource::SCREEN, false), (&resource::VALUE_RANGE, true)],
    push: size_of::<layout::ScalarOptions>() as u32,
};

/// The vertex stage of `shaders-glsl/seed.glsl`.
pub static SEED_VERTEX: Module = Module {
    name: "seed_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("seed_vertex.spv"),
    constants: &[],
    resources: &[],
    push: 0,
};

/// The fragment stage of `shaders-glsl/seed.glsl`.
pub static SEED_FRAGMENT: Module = Module {
    name: "seed_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("seed_fragment.spv"),
    constants: &[0],
    resources: &[(&resource::HOST_DEPTH, false)],
    push: size_of::<layout::Seed>() as u32,
};

/// The fragment stage of `shaders-glsl/seed.glsl`.
pub static SEED_MULTISAMPLED_FRAGMENT: Module = Module {
    name: "seed_multisampled_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("seed_multisampled_fragment.spv"),
    constants: &[0, 43],
    resources: &[(&resource::HOST_DEPTH, false)],
    push: size_of::<layout::Seed>() as u32,
};

/// The compute stage of `shaders-glsl/shade.glsl`.
pub static SHADE_COMPUTE: Module = Module {
    name: "shade_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("shade_compute.spv"),
    constants: &[0, 6, 7, 9, 10, 17, 28, 31, 32, 33, 34, 35, 38, 39, 48, 65, 68, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::IMAGE_OUTPUT, true), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::FILLED_TILES, false), (&resource::FINAL_QUAD0, false), (&resource::FINAL_QUAD1, false), (&resource::FINAL_QUAD2, false), (&resource::FINAL_SINGLE0, false), (&resource::FINAL_SINGLE1, false), (&resource::FROM_QUAD0, false), (&resource::FROM_QUAD1, false), (&resource::FROM_QUAD2, false), (&resource::FROM_SINGLE0, false), (&resource::FROM_SINGLE1, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/shade.glsl`.
pub static SHADE_LOOKUPS_COMPUTE: Module = Module {
    name: "shade_lookups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("shade_lookups_compute.spv"),
    constants: &[0, 6, 7, 9, 10, 17, 25, 28, 31, 32, 33, 34, 35, 36, 38, 39, 48, 65, 68, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::TEXTURE, false), (&resource::MATERIALS, false), (&resource::IMAGE_OUTPUT, true), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::FILLED_TILES, false), (&resource::FINAL_QUAD0, false), (&resource::FINAL_QUAD1, false), (&resource::FINAL_QUAD2, false), (&resource::FINAL_SINGLE0, false), (&resource::FINAL_SINGLE1, false), (&resource::FROM_QUAD0, false), (&resource::FROM_QUAD1, false), (&resource::FROM_QUAD2, false), (&resource::FROM_SINGLE0, false), (&resource::FROM_SINGLE1, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/shade.glsl`.
pub static SHADE_STORE_IDS_COMPUTE: Module = Module {
    name: "shade_store_ids_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("shade_store_ids_compute.spv"),
    constants: &[0, 6, 7, 9, 10, 17, 28, 31, 32, 33, 34, 35, 38, 39, 48, 65, 68, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::IMAGE_OUTPUT, true), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::ID_OUTPUT, true), (&resource::FILLED_TILES, false), (&resource::FINAL_QUAD0, false), (&resource::FINAL_QUAD1, false), (&resource::FINAL_QUAD2, false), (&resource::FINAL_SINGLE0, false), (&resource::FINAL_SINGLE1, false), (&resource::FROM_QUAD0, false), (&resource::FROM_QUAD1, false), (&resource::FROM_QUAD2, false), (&resource::FROM_SINGLE0, false), (&resource::FROM_SINGLE1, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/shade.glsl`.
pub static SHADE_LOOKUPS_STORE_IDS_COMPUTE: Module = Module {
    name: "shade_lookups_store_ids_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("shade_lookups_store_ids_compute.spv"),
    constants: &[0, 6, 7, 9, 10, 17, 25, 28, 31, 32, 33, 34, 35, 36, 38, 39, 48, 65, 68, 76, 79],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::TEXTURE, false), (&resource::MATERIALS, false), (&resource::IMAGE_OUTPUT, true), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::ID_OUTPUT, true), (&resource::FILLED_TILES, false), (&resource::FINAL_QUAD0, false), (&resource::FINAL_QUAD1, false), (&resource::FINAL_QUAD2, false), (&resource::FINAL_SINGLE0, false), (&resource::FINAL_SINGLE1, false), (&resource::FROM_QUAD0, false), (&resource::FROM_QUAD1, false), (&resource::FROM_QUAD2, false), (&resource::FROM_SINGLE0, false), (&resource::FROM_SINGLE1, false)],
    push: size_of::<layout::Step>() as u32,
};

/// The compute stage of `shaders-glsl/sides.glsl`.
pub static SIDES_COMPUTE: Module = Module {
    name: "sides_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("sides_compute.spv"),
    constants: &[0, 2, 15, 37, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, true), (&resource::VIEWS, false), (&resource::VISIBILITY_IMAGE, false), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/sides.glsl`.
pub static SIDES_TILES_COMPUTE: Module = Module {
    name: "sides_tiles_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("sides_tiles_compute.spv"),
    constants: &[0, 2, 15, 37, 63, 71, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, true), (&resource::SPLAT_BOXES, true), (&resource::VISIBLE_CLUSTERS, false), (&resource::VISIBILITY, false), (&resource::OPEN_TILES, true), (&resource::COUNTS, true)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The compute stage of `shaders-glsl/surface.glsl`.
pub static SURFACE_COMPUTE: Module = Module {
    name: "surface_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("surface_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 14, 15, 16, 17, 18, 19, 20, 23, 24, 31, 44, 45, 46, 47, 67, 68, 70, 72, 76, 79, 80, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, true), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOXES, false), (&resource::FRAME_SPLATS, false), (&resource::FRAME_ATTRIBUTES, false), (&resource::FRAME_CLIPS, false), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::OPEN_TILES, true), (&resource::EDGE_TILES, true), (&resource::REVEALED_TILES, true), (&resource::COVERED_TILES, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The compute stage of `shaders-glsl/surface.glsl`.
pub static SURFACE_SUBGROUPS_COMPUTE: Module = Module {
    name: "surface_subgroups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("surface_subgroups_compute.spv"),
    constants: &[0, 3, 4, 6, 7, 9, 10, 14, 15, 16, 17, 18, 19, 20, 23, 24, 31, 44, 45, 46, 47, 67, 68, 70, 72, 76, 79, 80, 82, 83],
    resources: &[(&resource::FRAME, false), (&resource::VIEWS, false), (&resource::VISIBILITY, true), (&resource::IMAGE_OUTPUT, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOX_TEXELS, false), (&resource::SPLAT_TEXELS, false), (&resource::ATTRIBUTE_TEXELS, false), (&resource::NORMAL_OUTPUT, true), (&resource::DEPTH_OUTPUT, true), (&resource::CLIP_TEXELS, false), (&resource::OPEN_TILES, true), (&resource::EDGE_TILES, true), (&resource::REVEALED_TILES, true), (&resource::COVERED_TILES, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The vertex stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_VERTEX: Module = Module {
    name: "visibility_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("visibility_vertex.spv"),
    constants: &[0, 15, 16, 37, 67, 69, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::VIEWS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_FRAGMENT: Module = Module {
    name: "visibility_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("visibility_fragment.spv"),
    constants: &[0, 15, 16, 70, 79],
    resources: &[(&resource::FRAME, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_COMPUTE: Module = Module {
    name: "visibility_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("visibility_compute.spv"),
    constants: &[0, 15, 16, 23, 24, 31, 44, 47, 67, 68, 70, 72, 79, 82],
    resources: &[(&resource::FRAME, false), (&resource::VISIBILITY, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOXES, false), (&resource::FRAME_SPLATS, false), (&resource::FRAME_CLIPS, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// The vertex stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_COVERAGE_VERTEX: Module = Module {
    name: "visibility_coverage_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("visibility_coverage_vertex.spv"),
    constants: &[0, 15, 16, 23, 37, 67, 69, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::VIEWS, false), (&resource::CLIPS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_COVERAGE_FRAGMENT: Module = Module {
    name: "visibility_coverage_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("visibility_coverage_fragment.spv"),
    constants: &[0, 15, 16, 23, 24, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false), (&resource::COVERAGE, true)],
    push: 0,
};

/// The vertex stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_CLIP_LINES_VERTEX: Module = Module {
    name: "visibility_clip_lines_vertex",
    stage: ShaderStageFlags::VERTEX,
    spirv: spirv!("visibility_clip_lines_vertex.spv"),
    constants: &[0, 15, 16, 23, 37, 67, 69, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SPLATS, false), (&resource::VIEWS, false), (&resource::CLIPS, false)],
    push: size_of::<layout::Chunk>() as u32,
};

/// The fragment stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_CLIP_LINES_FRAGMENT: Module = Module {
    name: "visibility_clip_lines_fragment",
    stage: ShaderStageFlags::FRAGMENT,
    spirv: spirv!("visibility_clip_lines_fragment.spv"),
    constants: &[0, 15, 16, 23, 24, 70, 79],
    resources: &[(&resource::FRAME, false), (&resource::SCREEN_CLIPS, false)],
    push: 0,
};

/// The compute stage of `shaders-glsl/visibility.glsl`.
pub static VISIBILITY_SUBGROUPS_COMPUTE: Module = Module {
    name: "visibility_subgroups_compute",
    stage: ShaderStageFlags::COMPUTE,
    spirv: spirv!("visibility_subgroups_compute.spv"),
    constants: &[0, 15, 16, 23, 24, 31, 44, 47, 67, 68, 70, 72, 79, 82],
    resources: &[(&resource::FRAME, false), (&resource::VISIBILITY, true), (&resource::INCOMPLETE_FRAME, true), (&resource::COVERAGE, true), (&resource::BOX_TEXELS, false), (&resource::SPLAT_TEXELS, false), (&resource::CLIP_TEXELS, false)],
    push: size_of::<layout::Hierarchy>() as u32,
};

/// Ids of the specialization constants, one id for each name in all shaders.
pub mod constant {
    /// `BEYOND_CLIPS`, first in `shaders-glsl/attribute.glsl`.
    pub const BEYOND_CLIPS: u32 = 24;
    /// `BILLBOARDS`, first in `shaders-glsl/attribute.glsl`.
    pub const BILLBOARDS: u32 = 22;
    /// `BOUNDED`, first in `shaders-glsl/cull.glsl`.
    pub const BOUNDED: u32 = 64;
    /// `BOX_WEIGHTS`, first in `shaders-glsl/push.glsl`.
    pub const BOX_WEIGHTS: u32 = 65;
    /// `CLIPS`, first in `shaders-glsl/attribute.glsl`.
    pub const CLIPS: u32 = 23;
    /// `CLUSTERS`, first in `shaders-glsl/attribute.glsl`.
    pub const CLUSTERS: u32 = 63;
    /// `COLOURS`, first in `shaders-glsl/attribute.glsl`.
    pub const COLOURS: u32 = 5;
    /// `COLOUR_OFFSET`, first in `shaders-glsl/attribute.glsl`.
    pub const COLOUR_OFFSET: u32 = 57;
    /// `COLOUR_STRIDE`, first in `shaders-glsl/attribute.glsl`.
    pub const COLOUR_STRIDE: u32 = 58;
    /// `COMPACT`, first in `shaders-glsl/copy.glsl`.
    pub const COMPACT: u32 = 33;
    /// `CONFETTI`, first in `shaders-glsl/attribute.glsl`.
    pub const CONFETTI: u32 = 16;
    /// `CORNERS`, first in `shaders-glsl/attribute.glsl`.
    pub const CORNERS: u32 = 27;
    /// `COUNT`, first in `shaders-glsl/cull.glsl`.
    pub const COUNT: u32 = 2;
    /// `COVERAGE`, first in `shaders-glsl/attribute.glsl`.
    pub const COVERAGE: u32 = 31;
    /// `COVERAGE_FOOTPRINT`, first in `shaders-glsl/attribute.glsl`.
    pub const COVERAGE_FOOTPRINT: u32 = 67;
    /// `CULL_AUTO`, first in `shaders-glsl/copy.glsl`.
    pub const CULL_AUTO: u32 = 68;
    /// `CULL_BACK`, first in `shaders-glsl/cull.glsl`.
    pub const CULL_BACK: u32 = 1;
    /// `CURVATURES`, first in `shaders-glsl/attribute.glsl`.
    pub const CURVATURES: u32 = 70;
    /// `DISTANT`, first in `shaders-glsl/ambient.glsl`.
    pub const DISTANT: u32 = 79;
    /// `DRAWN_ALPHA`, first in `shaders-glsl/composite.glsl`.
    pub const DRAWN_ALPHA: u32 = 44;
    /// `EDL`, first in `shaders-glsl/ambient.glsl`.
    pub const EDL: u32 = 77;
    /// `ELLIPSES`, first in `shaders-glsl/attribute.glsl`.
    pub const ELLIPSES: u32 = 12;
    /// `ELLIPSE_OFFSET`, first in `shaders-glsl/attribute.glsl`.
    pub const ELLIPSE_OFFSET: u32 = 59;
    /// `ELLIPSE_STRIDE`, first in `shaders-glsl/attribute.glsl`.
    pub const ELLIPSE_STRIDE: u32 = 60;
    /// `ENCODE`, first in `shaders-glsl/composite.glsl`.
    pub const ENCODE: u32 = 41;
    /// `FILTER_RADIUS`, first in `shaders-glsl/ambient.glsl`.
    pub const FILTER_RADIUS: u32 = 66;
    /// `FOOTPRINT`, first in `shaders-glsl/attribute.glsl`.
    pub const FOOTPRINT: u32 = 15;
    /// `FRAME_CORNERS`, first in `shaders-glsl/attribute.glsl`.
    pub const FRAME_CORNERS: u32 = 46;
    /// `FRAME_NORMAL_FIELDS`, first in `shaders-glsl/attribute.glsl`.
    pub const FRAME_NORMAL_FIELDS: u32 = 83;
    /// `FRAME_WEIGHTS`, first in `shaders-glsl/attribute.glsl`.
    pub const FRAME_WEIGHTS: u32 = 45;
    /// `FRONTS`, first in `shaders-glsl/visibility.glsl`.
    pub const FRONTS: u32 = 69;
    /// `HAS_LEVELS`, first in `shaders-glsl/cull.glsl`.
    pub const HAS_LEVELS: u32 = 73;
    /// `HOST_DEPTH`, first in `shaders-glsl/composite.glsl`.
    pub const HOST_DEPTH: u32 = 40;
    /// `HOST_SAMPLES`, first in `shaders-glsl/distance.glsl`.
    pub const HOST_SAMPLES: u32 = 43;
    /// `IDS`, first in `shaders-glsl/copy.glsl`.
    pub const IDS: u32 = 39;
    /// `INSTANCED`, first in `shaders-glsl/attribute.glsl`.
    pub const INSTANCED: u32 = 37;
    /// `LARGE_TRIANGLES`, first in `shaders-glsl/project.glsl`.
    pub const LARGE_TRIANGLES: u32 = 30;
    /// `LATE_BACKGROUND`, first in `shaders-glsl/ambient.glsl`.
    pub const LATE_BACKGROUND: u32 = 76;
    /// `LATTICES`, first in `shaders-glsl/attribute.glsl`.
    pub const LATTICES: u32 = 78;
    /// `LIGHTS`, first in `shaders-glsl/attribute.glsl`.
    pub const LIGHTS: u32 = 7;
    /// `LIMITED_LOOPS`, first in `shaders-glsl/attribute.glsl`.
    pub const LIMITED_LOOPS: u32 = 82;
    /// `MATERIALS`, first in `shaders-glsl/shade.glsl`.
    pub const MATERIALS: u32 = 25;
    /// `MIXED`, first in `shaders-glsl/attribute.glsl`.
    pub const MIXED: u32 = 72;
    /// `MOVED`, first in `shaders-glsl/footprint.glsl`.
    pub const MOVED: u32 = 21;
    /// `NORMALIZATION`, first in `shaders-glsl/attribute.glsl`.
    pub const NORMALIZATION: u32 = 18;
    /// `NORMALS`, first in `shaders-glsl/attribute.glsl`.
    pub const NORMALS: u32 = 54;
    /// `NORMAL_FIELDS`, first in `shaders-glsl/attribute.glsl`.
    pub const NORMAL_FIELDS: u32 = 84;
    /// `NORMAL_OFFSET`, first in `shaders-glsl/attribute.glsl`.
    pub const NORMAL_OFFSET: u32 = 52;
    /// `NORMAL_STRIDE`, first in `shaders-glsl/attribute.glsl`.
    pub const NORMAL_STRIDE: u32 = 53;
    /// `OCCLUSION_CULLING`, first in `shaders-glsl/boxes.glsl`.
    pub const OCCLUSION_CULLING: u32 = 80;
    /// `OPENS_TILES`, first in `shaders-glsl/sides.glsl`.
    pub const OPENS_TILES: u32 = 71;
    /// `OUT_DEPTH`, first in `shaders-glsl/behind.glsl`.
    pub const OUT_DEPTH: u32 = 10;
    /// `OUT_NORMAL`, first in `shaders-glsl/behind.glsl`.
    pub const OUT_NORMAL: u32 = 9;
    /// `OVERLAP`, first in `shaders-glsl/attribute.glsl`.
    pub const OVERLAP: u32 = 19;
    /// `PAPER`, first in `shaders-glsl/fetch.glsl`.
    pub const PAPER: u32 = 28;
    /// `PERSPECTIVE`, first in `shaders-glsl/ambient.glsl`.
    pub const PERSPECTIVE: u32 = 0;
    /// `PING_PONG`, first in `shaders-glsl/pull.glsl`.
    pub const PING_PONG: u32 = 32;
    /// `POSITION_OFFSET`, first in `shaders-glsl/attribute.glsl`.
    pub const POSITION_OFFSET: u32 = 50;
    /// `POSITION_STRIDE`, first in `shaders-glsl/attribute.glsl`.
    pub const POSITION_STRIDE: u32 = 51;
    /// `RADIUS_OFFSET`, first in `shaders-glsl/attribute.glsl`.
    pub const RADIUS_OFFSET: u32 = 55;
    /// `RADIUS_STRIDE`, first in `shaders-glsl/attribute.glsl`.
    pub const RADIUS_STRIDE: u32 = 56;
    /// `RECONSTRUCT`, first in `shaders-glsl/shade.glsl`.
    pub const RECONSTRUCT: u32 = 48;
    /// `SHADE`, first in `shaders-glsl/attribute.glsl`.
    pub const SHADE: u32 = 20;
    /// `SHADING`, first in `shaders-glsl/ambient.glsl`.
    pub const SHADING: u32 = 6;
    /// `SLICED`, first in `shaders-glsl/attribute.glsl`.
    pub const SLICED: u32 = 47;
    /// `SPLIT`, first in `shaders-glsl/behind.glsl`.
    pub const SPLIT: u32 = 81;
    /// `STAGE`, first in `shaders-glsl/behind.glsl`.
    pub const STAGE: u32 = 74;
    /// `STORED_COLOURS`, first in `shaders-glsl/attribute.glsl`.
    pub const STORED_COLOURS: u32 = 62;
    /// `SUM_COLOURS`, first in `shaders-glsl/attribute.glsl`.
    pub const SUM_COLOURS: u32 = 17;
    /// `SUM_DEPTH`, first in `shaders-glsl/attribute.glsl`.
    pub const SUM_DEPTH: u32 = 4;
    /// `SUM_NORMALS`, first in `shaders-glsl/attribute.glsl`.
    pub const SUM_NORMALS: u32 = 3;
    /// `TEXELS`, first in `shaders-glsl/shade.glsl`.
    pub const TEXELS: u32 = 36;
    /// `TEXTURE`, first in `shaders-glsl/copy.glsl`.
    pub const TEXTURE: u32 = 38;
    /// `TUBES`, first in `shaders-glsl/copy.glsl`.
    pub const TUBES: u32 = 35;
    /// `TWO_SIDED`, first in `shaders-glsl/attribute.glsl`.
    pub const TWO_SIDED: u32 = 13;
    /// `UNBOUNDED_COLOURS`, first in `shaders-glsl/copy.glsl`.
    pub const UNBOUNDED_COLOURS: u32 = 34;
    /// `UNCHECKED`, first in `shaders-glsl/attribute.glsl`.
    pub const UNCHECKED: u32 = 61;
    /// `UNORDERED`, first in `shaders-glsl/footprint.glsl`.
    pub const UNORDERED: u32 = 49;
    /// `VERTEX_COLOURS`, first in `shaders-glsl/fetch.glsl`.
    pub const VERTEX_COLOURS: u32 = 29;
    /// `VISIBLE_BY_SUMS`, first in `shaders-glsl/normalize.glsl`.
    pub const VISIBLE_BY_SUMS: u32 = 42;
    /// `WEIGHTS`, first in `shaders-glsl/attribute.glsl`.
    pub const WEIGHTS: u32 = 26;
    /// `WIDEN_SMALL`, first in `shaders-glsl/attribute.glsl`.
    pub const WIDEN_SMALL: u32 = 14;
}

/// What shaders see at the bindings of their descriptor sets.
pub mod resource {
    use super::{DescriptorType, Resource, ShaderStageFlags};

    /// `BehindDepths`, first in `shaders-glsl/behind.glsl`.
    pub static BEHIND_DEPTHS: Resource = Resource {
        name: "BehindDepths",
        set: 1,
        binding: 24,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Boxes`, first in `shaders-glsl/attribute.glsl`.
    pub static BOXES: Resource = Resource {
        name: "Boxes",
        set: 1,
        binding: 6,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Clips`, first in `shaders-glsl/attribute.glsl`.
    pub static CLIPS: Resource = Resource {
        name: "Clips",
        set: 0,
        binding: 9,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `Clusters`, first in `shaders-glsl/cull.glsl`.
    pub static CLUSTERS: Resource = Resource {
        name: "Clusters",
        set: 0,
        binding: 22,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Colours`, first in `shaders-glsl/attribute.glsl`.
    pub static COLOURS: Resource = Resource {
        name: "Colours",
        set: 0,
        binding: 5,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `Counts`, first in `shaders-glsl/cull.glsl`.
    pub static COUNTS: Resource = Resource {
        name: "Counts",
        set: 2,
        binding: 5,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Coverage`, first in `shaders-glsl/behind.glsl`.
    pub static COVERAGE: Resource = Resource {
        name: "Coverage",
        set: 1,
        binding: 5,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `CoveredTiles`, first in `shaders-glsl/covered.glsl`.
    pub static COVERED_TILES: Resource = Resource {
        name: "CoveredTiles",
        set: 1,
        binding: 29,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `EdgeTiles`, first in `shaders-glsl/behind.glsl`.
    pub static EDGE_TILES: Resource = Resource {
        name: "EdgeTiles",
        set: 1,
        binding: 25,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Elements`, first in `shaders-glsl/fetch.glsl`.
    pub static ELEMENTS: Resource = Resource {
        name: "Elements",
        set: 0,
        binding: 15,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `EllipseWords`, first in `shaders-glsl/attribute.glsl`.
    pub static ELLIPSE_WORDS: Resource = Resource {
        name: "EllipseWords",
        set: 0,
        binding: 8,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `Ellipses`, first in `shaders-glsl/attribute.glsl`.
    pub static ELLIPSES: Resource = Resource {
        name: "Ellipses",
        set: 0,
        binding: 8,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `FilledTiles`, first in `shaders-glsl/filled.glsl`.
    pub static FILLED_TILES: Resource = Resource {
        name: "FilledTiles",
        set: 1,
        binding: 31,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Frame`, first in `shaders-glsl/ambient.glsl`.
    pub static FRAME: Resource = Resource {
        name: "Frame",
        set: 0,
        binding: 0,
        kind: DescriptorType::UNIFORM_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `FrameAttributes`, first in `shaders-glsl/attribute.glsl`.
    pub static FRAME_ATTRIBUTES: Resource = Resource {
        name: "FrameAttributes",
        set: 1,
        binding: 8,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `FrameClips`, first in `shaders-glsl/attribute.glsl`.
    pub static FRAME_CLIPS: Resource = Resource {
        name: "FrameClips",
        set: 1,
        binding: 9,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `FrameSplats`, first in `shaders-glsl/attribute.glsl`.
    pub static FRAME_SPLATS: Resource = Resource {
        name: "FrameSplats",
        set: 1,
        binding: 7,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Groups`, first in `shaders-glsl/cull.glsl`.
    pub static GROUPS: Resource = Resource {
        name: "Groups",
        set: 0,
        binding: 23,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `HiddenClusters`, first in `shaders-glsl/cull.glsl`.
    pub static HIDDEN_CLUSTERS: Resource = Resource {
        name: "HiddenClusters",
        set: 0,
        binding: 24,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `IncompleteFrame`, first in `shaders-glsl/attribute.glsl`.
    pub static INCOMPLETE_FRAME: Resource = Resource {
        name: "IncompleteFrame",
        set: 1,
        binding: 4,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `LargeTriangles`, first in `shaders-glsl/project.glsl`.
    pub static LARGE_TRIANGLES: Resource = Resource {
        name: "LargeTriangles",
        set: 0,
        binding: 16,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `LatticePositions`, first in `shaders-glsl/attribute.glsl`.
    pub static LATTICE_POSITIONS: Resource = Resource {
        name: "LatticePositions",
        set: 0,
        binding: 2,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `Lattices`, first in `shaders-glsl/attribute.glsl`.
    pub static LATTICES: Resource = Resource {
        name: "Lattices",
        set: 0,
        binding: 4,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `LineDirections`, first in `shaders-glsl/fetch.glsl`.
    pub static LINE_DIRECTIONS: Resource = Resource {
        name: "LineDirections",
        set: 0,
        binding: 13,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `MapColours`, first in `shaders-glsl/colour_map.glsl`.
    pub static MAP_COLOURS: Resource = Resource {
        name: "MapColours",
        set: 0,
        binding: 2,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `Materials`, first in `shaders-glsl/shade.glsl`.
    pub static MATERIALS: Resource = Resource {
        name: "Materials",
        set: 0,
        binding: 18,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Nearest`, first in `shaders-glsl/fetch.glsl`.
    pub static NEAREST: Resource = Resource {
        name: "Nearest",
        set: 1,
        binding: 6,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Normals`, first in `shaders-glsl/attribute.glsl`.
    pub static NORMALS: Resource = Resource {
        name: "Normals",
        set: 0,
        binding: 3,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `OccupiedTiles`, first in `shaders-glsl/fetch.glsl`.
    pub static OCCUPIED_TILES: Resource = Resource {
        name: "OccupiedTiles",
        set: 1,
        binding: 30,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `OpenTiles`, first in `shaders-glsl/hidden.glsl`.
    pub static OPEN_TILES: Resource = Resource {
        name: "OpenTiles",
        set: 1,
        binding: 24,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Order`, first in `shaders-glsl/footprint.glsl`.
    pub static ORDER: Resource = Resource {
        name: "Order",
        set: 0,
        binding: 20,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Positions`, first in `shaders-glsl/attribute.glsl`.
    pub static POSITIONS: Resource = Resource {
        name: "Positions",
        set: 0,
        binding: 2,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `Radii`, first in `shaders-glsl/attribute.glsl`.
    pub static RADII: Resource = Resource {
        name: "Radii",
        set: 0,
        binding: 4,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `RevealedTiles`, first in `shaders-glsl/boxes.glsl`.
    pub static REVEALED_TILES: Resource = Resource {
        name: "RevealedTiles",
        set: 1,
        binding: 28,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `ScreenClips`, first in `shaders-glsl/attribute.glsl`.
    pub static SCREEN_CLIPS: Resource = Resource {
        name: "ScreenClips",
        set: 0,
        binding: 10,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `SplatAttributes`, first in `shaders-glsl/footprint.glsl`.
    pub static SPLAT_ATTRIBUTES: Resource = Resource {
        name: "SplatAttributes",
        set: 0,
        binding: 7,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `SplatBoxes`, first in `shaders-glsl/footprint.glsl`.
    pub static SPLAT_BOXES: Resource = Resource {
        name: "SplatBoxes",
        set: 0,
        binding: 19,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `SplatLayout`, first in `shaders-glsl/footprint.glsl`.
    pub static SPLAT_LAYOUT: Resource = Resource {
        name: "SplatLayout",
        set: 0,
        binding: 1,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Splats`, first in `shaders-glsl/attribute.glsl`.
    pub static SPLATS: Resource = Resource {
        name: "Splats",
        set: 0,
        binding: 1,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `Sums0`, first in `shaders-glsl/attribute.glsl`.
    pub static SUMS0: Resource = Resource {
        name: "Sums0",
        set: 1,
        binding: 1,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Sums1`, first in `shaders-glsl/attribute.glsl`.
    pub static SUMS1: Resource = Resource {
        name: "Sums1",
        set: 1,
        binding: 2,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Texture`, first in `shaders-glsl/shade.glsl`.
    pub static TEXTURE: Resource = Resource {
        name: "Texture",
        set: 0,
        binding: 17,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `ValueRange`, first in `shaders-glsl/colour_map.glsl`.
    pub static VALUE_RANGE: Resource = Resource {
        name: "ValueRange",
        set: 0,
        binding: 1,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `VertexColours`, first in `shaders-glsl/fetch.glsl`.
    pub static VERTEX_COLOURS: Resource = Resource {
        name: "VertexColours",
        set: 0,
        binding: 14,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Vertices`, first in `shaders-glsl/fetch.glsl`.
    pub static VERTICES: Resource = Resource {
        name: "Vertices",
        set: 0,
        binding: 12,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Views`, first in `shaders-glsl/attribute.glsl`.
    pub static VIEWS: Resource = Resource {
        name: "Views",
        set: 0,
        binding: 6,
        kind: DescriptorType::UNIFORM_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `Visibility`, first in `shaders-glsl/attribute.glsl`.
    pub static VISIBILITY: Resource = Resource {
        name: "Visibility",
        set: 1,
        binding: 0,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `VisibleClusters`, first in `shaders-glsl/cull.glsl`.
    pub static VISIBLE_CLUSTERS: Resource = Resource {
        name: "VisibleClusters",
        set: 0,
        binding: 21,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Weights`, first in `shaders-glsl/attribute.glsl`.
    pub static WEIGHTS: Resource = Resource {
        name: "Weights",
        set: 0,
        binding: 11,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::VERTEX.as_raw()),
    };

    /// `WideWords`, first in `shaders-glsl/atomics.glsl`.
    pub static WIDE_WORDS: Resource = Resource {
        name: "WideWords",
        set: 0,
        binding: 0,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `Words`, first in `shaders-glsl/atomics.glsl`.
    pub static WORDS: Resource = Resource {
        name: "Words",
        set: 0,
        binding: 0,
        kind: DescriptorType::STORAGE_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `attribute_texels`, first in `shaders-glsl/attribute.glsl`.
    pub static ATTRIBUTE_TEXELS: Resource = Resource {
        name: "attribute_texels",
        set: 1,
        binding: 18,
        kind: DescriptorType::UNIFORM_TEXEL_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `behind_image`, first in `shaders-glsl/behind.glsl`.
    pub static BEHIND_IMAGE: Resource = Resource {
        name: "behind_image",
        set: 1,
        binding: 26,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `box_texels`, first in `shaders-glsl/attribute.glsl`.
    pub static BOX_TEXELS: Resource = Resource {
        name: "box_texels",
        set: 1,
        binding: 16,
        kind: DescriptorType::UNIFORM_TEXEL_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `clip_texels`, first in `shaders-glsl/attribute.glsl`.
    pub static CLIP_TEXELS: Resource = Resource {
        name: "clip_texels",
        set: 1,
        binding: 22,
        kind: DescriptorType::UNIFORM_TEXEL_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `depth_image`, first in `shaders-glsl/composite.glsl`.
    pub static DEPTH_IMAGE: Resource = Resource {
        name: "depth_image",
        set: 0,
        binding: 3,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `depth_output`, first in `shaders-glsl/ambient.glsl`.
    pub static DEPTH_OUTPUT: Resource = Resource {
        name: "depth_output",
        set: 1,
        binding: 20,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `filtered`, first in `shaders-glsl/filter.glsl`.
    pub static FILTERED: Resource = Resource {
        name: "filtered",
        set: 1,
        binding: 23,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `final_quad0`, first in `shaders-glsl/filled.glsl`.
    pub static FINAL_QUAD0: Resource = Resource {
        name: "final_quad0",
        set: 2,
        binding: 5,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `final_quad1`, first in `shaders-glsl/push.glsl`.
    pub static FINAL_QUAD1: Resource = Resource {
        name: "final_quad1",
        set: 2,
        binding: 6,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `final_quad2`, first in `shaders-glsl/push.glsl`.
    pub static FINAL_QUAD2: Resource = Resource {
        name: "final_quad2",
        set: 2,
        binding: 7,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `final_single0`, first in `shaders-glsl/push.glsl`.
    pub static FINAL_SINGLE0: Resource = Resource {
        name: "final_single0",
        set: 2,
        binding: 8,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `final_single1`, first in `shaders-glsl/push.glsl`.
    pub static FINAL_SINGLE1: Resource = Resource {
        name: "final_single1",
        set: 2,
        binding: 9,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `from_quad0`, first in `shaders-glsl/copy.glsl`.
    pub static FROM_QUAD0: Resource = Resource {
        name: "from_quad0",
        set: 3,
        binding: 5,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `from_quad1`, first in `shaders-glsl/copy.glsl`.
    pub static FROM_QUAD1: Resource = Resource {
        name: "from_quad1",
        set: 3,
        binding: 6,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `from_quad2`, first in `shaders-glsl/copy.glsl`.
    pub static FROM_QUAD2: Resource = Resource {
        name: "from_quad2",
        set: 3,
        binding: 7,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `from_single0`, first in `shaders-glsl/copy.glsl`.
    pub static FROM_SINGLE0: Resource = Resource {
        name: "from_single0",
        set: 3,
        binding: 8,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `from_single1`, first in `shaders-glsl/copy.glsl`.
    pub static FROM_SINGLE1: Resource = Resource {
        name: "from_single1",
        set: 3,
        binding: 9,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `host_depth`, first in `shaders-glsl/seed.glsl`.
    pub static HOST_DEPTH: Resource = Resource {
        name: "host_depth",
        set: 1,
        binding: 15,
        kind: DescriptorType::INPUT_ATTACHMENT,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `host_depth_image`, first in `shaders-glsl/distance.glsl`.
    pub static HOST_DEPTH_IMAGE: Resource = Resource {
        name: "host_depth_image",
        set: 2,
        binding: 0,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `host_depth_samples`, first in `shaders-glsl/distance.glsl`.
    pub static HOST_DEPTH_SAMPLES: Resource = Resource {
        name: "host_depth_samples",
        set: 2,
        binding: 0,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `id_image`, first in `shaders-glsl/composite.glsl`.
    pub static ID_IMAGE: Resource = Resource {
        name: "id_image",
        set: 0,
        binding: 4,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `id_output`, first in `shaders-glsl/shade.glsl`.
    pub static ID_OUTPUT: Resource = Resource {
        name: "id_output",
        set: 1,
        binding: 21,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `image_output`, first in `shaders-glsl/ambient.glsl`.
    pub static IMAGE_OUTPUT: Resource = Resource {
        name: "image_output",
        set: 1,
        binding: 3,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `nearest_depth`, first in `shaders-glsl/project.glsl`.
    pub static NEAREST_DEPTH: Resource = Resource {
        name: "nearest_depth",
        set: 1,
        binding: 7,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `nearest_id`, first in `shaders-glsl/fetch.glsl`.
    pub static NEAREST_ID: Resource = Resource {
        name: "nearest_id",
        set: 1,
        binding: 8,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `normal_image`, first in `shaders-glsl/composite.glsl`.
    pub static NORMAL_IMAGE: Resource = Resource {
        name: "normal_image",
        set: 0,
        binding: 2,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `normal_output`, first in `shaders-glsl/nearest.glsl`.
    pub static NORMAL_OUTPUT: Resource = Resource {
        name: "normal_output",
        set: 1,
        binding: 19,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `occlusion`, first in `shaders-glsl/ambient.glsl`.
    pub static OCCLUSION: Resource = Resource {
        name: "occlusion",
        set: 1,
        binding: 27,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `picture_image`, first in `shaders-glsl/composite.glsl`.
    pub static PICTURE_IMAGE: Resource = Resource {
        name: "picture_image",
        set: 0,
        binding: 1,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `screen`, first in `shaders-glsl/colour_map.glsl`.
    pub static SCREEN: Resource = Resource {
        name: "screen",
        set: 0,
        binding: 0,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `splat_texels`, first in `shaders-glsl/attribute.glsl`.
    pub static SPLAT_TEXELS: Resource = Resource {
        name: "splat_texels",
        set: 1,
        binding: 17,
        kind: DescriptorType::UNIFORM_TEXEL_BUFFER,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `sums0_image`, first in `shaders-glsl/behind.glsl`.
    pub static SUMS0_IMAGE: Resource = Resource {
        name: "sums0_image",
        set: 1,
        binding: 10,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `sums0_input`, first in `shaders-glsl/normalize.glsl`.
    pub static SUMS0_INPUT: Resource = Resource {
        name: "sums0_input",
        set: 1,
        binding: 13,
        kind: DescriptorType::INPUT_ATTACHMENT,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `sums1_image`, first in `shaders-glsl/behind.glsl`.
    pub static SUMS1_IMAGE: Resource = Resource {
        name: "sums1_image",
        set: 1,
        binding: 11,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `sums1_input`, first in `shaders-glsl/normalize.glsl`.
    pub static SUMS1_INPUT: Resource = Resource {
        name: "sums1_input",
        set: 1,
        binding: 14,
        kind: DescriptorType::INPUT_ATTACHMENT,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `to_image0`, first in `shaders-glsl/copy.glsl`.
    pub static TO_IMAGE0: Resource = Resource {
        name: "to_image0",
        set: 2,
        binding: 0,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `to_image1`, first in `shaders-glsl/copy.glsl`.
    pub static TO_IMAGE1: Resource = Resource {
        name: "to_image1",
        set: 2,
        binding: 1,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `to_image2`, first in `shaders-glsl/copy.glsl`.
    pub static TO_IMAGE2: Resource = Resource {
        name: "to_image2",
        set: 2,
        binding: 2,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `to_image3`, first in `shaders-glsl/copy.glsl`.
    pub static TO_IMAGE3: Resource = Resource {
        name: "to_image3",
        set: 2,
        binding: 3,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `to_image4`, first in `shaders-glsl/copy.glsl`.
    pub static TO_IMAGE4: Resource = Resource {
        name: "to_image4",
        set: 2,
        binding: 4,
        kind: DescriptorType::STORAGE_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw()),
    };

    /// `visibility_image`, first in `shaders-glsl/attribute.glsl`.
    pub static VISIBILITY_IMAGE: Resource = Resource {
        name: "visibility_image",
        set: 1,
        binding: 9,
        kind: DescriptorType::SAMPLED_IMAGE,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::COMPUTE.as_raw() | ShaderStageFlags::FRAGMENT.as_raw()),
    };

    /// `visibility_input`, first in `shaders-glsl/normalize.glsl`.
    pub static VISIBILITY_INPUT: Resource = Resource {
        name: "visibility_input",
        set: 1,
        binding: 12,
        kind: DescriptorType::INPUT_ATTACHMENT,
        stages: ShaderStageFlags::from_raw(ShaderStageFlags::FRAGMENT.as_raw()),
    };
}

/// The blocks and structs of the shaders, byte for byte.
#[allow(non_snake_case, non_camel_case_types)]
pub mod layout {
    /// `AtomicOptions`, 8 bytes, first in `shaders-glsl/atomics.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct AtomicOptions {
        /// Byte 0.
        pub mask: u32,
        /// Byte 4.
        pub seed: u32,
    }
    const _: () = assert!(std::mem::offset_of!(AtomicOptions, mask) == 0);
    const _: () = assert!(std::mem::offset_of!(AtomicOptions, seed) == 4);
    const _: () = assert!(std::mem::size_of::<AtomicOptions>() == 8);

    /// `Chunk`, 48 bytes, first in `shaders-glsl/attribute.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Chunk {
        /// Byte 0.
        pub count: u32,
        /// Byte 4.
        pub first_id: u32,
        /// Byte 8.
        pub capacity: u32,
        /// Byte 12.
        pub instance_stride: u32,
        /// Byte 16.
        pub clip_stride: u32,
        /// Byte 20.
        pub first_instance: u32,
        /// Byte 24.
        pub first_clip: u32,
        /// Byte 28.
        pub attribute_rows: u32,
        /// Byte 32.
        pub instance_count: u32,
        /// Byte 36.
        pub first_node: u32,
        /// Byte 40.
        pub group_count: u32,
        /// Byte 44.
        pub revealed: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Chunk, count) == 0);
    const _: () = assert!(std::mem::offset_of!(Chunk, first_id) == 4);
    const _: () = assert!(std::mem::offset_of!(Chunk, capacity) == 8);
    const _: () = assert!(std::mem::offset_of!(Chunk, instance_stride) == 12);
    const _: () = assert!(std::mem::offset_of!(Chunk, clip_stride) == 16);
    const _: () = assert!(std::mem::offset_of!(Chunk, first_instance) == 20);
    const _: () = assert!(std::mem::offset_of!(Chunk, first_clip) == 24);
    const _: () = assert!(std::mem::offset_of!(Chunk, attribute_rows) == 28);
    const _: () = assert!(std::mem::offset_of!(Chunk, instance_count) == 32);
    const _: () = assert!(std::mem::offset_of!(Chunk, first_node) == 36);
    const _: () = assert!(std::mem::offset_of!(Chunk, group_count) == 40);
    const _: () = assert!(std::mem::offset_of!(Chunk, revealed) == 44);
    const _: () = assert!(std::mem::size_of::<Chunk>() == 48);

    /// `Cluster`, 48 bytes, first in `shaders-glsl/cull.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Cluster {
        /// Byte 0.
        pub low: [f32; 4],
        /// Byte 16.
        pub high: [f32; 4],
        /// Byte 32.
        pub axis: [f32; 4],
    }
    const _: () = assert!(std::mem::offset_of!(Cluster, low) == 0);
    const _: () = assert!(std::mem::offset_of!(Cluster, high) == 16);
    const _: () = assert!(std::mem::offset_of!(Cluster, axis) == 32);
    const _: () = assert!(std::mem::size_of::<Cluster>() == 48);

    /// `Composite`, 24 bytes, first in `shaders-glsl/composite.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Composite {
        /// Byte 0.
        pub depth: [f32; 4],
        /// Byte 16.
        pub origin: [i32; 2],
    }
    const _: () = assert!(std::mem::offset_of!(Composite, depth) == 0);
    const _: () = assert!(std::mem::offset_of!(Composite, origin) == 16);
    const _: () = assert!(std::mem::size_of::<Composite>() == 24);

    /// `Counts`, 32 bytes, first in `shaders-glsl/cull.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Counts {
        /// Byte 0.
        pub culled: [u32; 7],
        /// Byte 28.
        pub in_clusters: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Counts, culled) == 0);
    const _: () = assert!(std::mem::offset_of!(Counts, in_clusters) == 28);
    const _: () = assert!(std::mem::size_of::<Counts>() == 32);

    /// `CoveredTiles`, 20 bytes, first in `shaders-glsl/covered.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct CoveredTiles {
        /// Byte 0.
        pub columns: u32,
        /// Byte 4.
        pub rows: u32,
        /// Byte 8.
        pub layers: u32,
        /// Byte 12.
        pub listed_count: u32,
        /// Byte 16.
        pub all: u32,
    }
    const _: () = assert!(std::mem::offset_of!(CoveredTiles, columns) == 0);
    const _: () = assert!(std::mem::offset_of!(CoveredTiles, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(CoveredTiles, layers) == 8);
    const _: () = assert!(std::mem::offset_of!(CoveredTiles, listed_count) == 12);
    const _: () = assert!(std::mem::offset_of!(CoveredTiles, all) == 16);
    const _: () = assert!(std::mem::size_of::<CoveredTiles>() == 20);

    /// `Darken`, 8 bytes, first in `shaders-glsl/darken.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Darken {
        /// Byte 0.
        pub origin: [i32; 2],
    }
    const _: () = assert!(std::mem::offset_of!(Darken, origin) == 0);
    const _: () = assert!(std::mem::size_of::<Darken>() == 8);

    /// `Distance`, 28 bytes, first in `shaders-glsl/distance.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Distance {
        /// Byte 0.
        pub first: [f32; 2],
        /// Byte 8.
        pub by_distance: f32,
        /// Byte 12.
        pub farthest: f32,
        /// Byte 16.
        pub origin: [i32; 2],
        /// Byte 24.
        pub nearer: f32,
    }
    const _: () = assert!(std::mem::offset_of!(Distance, first) == 0);
    const _: () = assert!(std::mem::offset_of!(Distance, by_distance) == 8);
    const _: () = assert!(std::mem::offset_of!(Distance, farthest) == 12);
    const _: () = assert!(std::mem::offset_of!(Distance, origin) == 16);
    const _: () = assert!(std::mem::offset_of!(Distance, nearer) == 24);
    const _: () = assert!(std::mem::size_of::<Distance>() == 28);

    /// `EdgeTiles`, 20 bytes, first in `shaders-glsl/behind.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct EdgeTiles {
        /// Byte 0.
        pub columns: u32,
        /// Byte 4.
        pub rows: u32,
        /// Byte 8.
        pub layers: u32,
        /// Byte 12.
        pub listed_count: u32,
        /// Byte 16.
        pub all: u32,
    }
    const _: () = assert!(std::mem::offset_of!(EdgeTiles, columns) == 0);
    const _: () = assert!(std::mem::offset_of!(EdgeTiles, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(EdgeTiles, layers) == 8);
    const _: () = assert!(std::mem::offset_of!(EdgeTiles, listed_count) == 12);
    const _: () = assert!(std::mem::offset_of!(EdgeTiles, all) == 16);
    const _: () = assert!(std::mem::size_of::<EdgeTiles>() == 20);

    /// `FillOptions`, 16 bytes, first in `shaders-glsl/fill.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct FillOptions {
        /// Byte 0.
        pub scale: [f32; 4],
    }
    const _: () = assert!(std::mem::offset_of!(FillOptions, scale) == 0);
    const _: () = assert!(std::mem::size_of::<FillOptions>() == 16);

    /// `FilledTiles`, 40 bytes, first in `shaders-glsl/filled.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct FilledTiles {
        /// Byte 0.
        pub workgroups: [Workgroups; 3],
        /// Byte 36.
        pub listed_count: u32,
    }
    const _: () = assert!(std::mem::offset_of!(FilledTiles, workgroups) == 0);
    const _: () = assert!(std::mem::offset_of!(FilledTiles, listed_count) == 36);
    const _: () = assert!(std::mem::size_of::<FilledTiles>() == 40);

    /// `Frame`, 224 bytes, first in `shaders-glsl/ambient.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Frame {
        /// Byte 0.
        pub viewport: [f32; 2],
        /// Byte 8.
        pub near: f32,
        /// Byte 12.
        pub key_slope: f32,
        /// Byte 16.
        pub key_far: f32,
        /// Byte 20.
        pub key_near: f32,
        /// Byte 24.
        pub key_gain: f32,
        /// Byte 28.
        pub key_reach: f32,
        /// Byte 32.
        pub key_offset: [f32; 2],
        /// Byte 40.
        pub key_at_zero: f32,
        /// Byte 44.
        pub distance_offset: f32,
        /// Byte 48.
        pub cutoff: f32,
        /// Byte 52.
        pub epsilon: f32,
        /// Byte 56.
        pub visibility_lowpass: f32,
        /// Byte 60.
        pub attribute_lowpass: f32,
        /// Byte 64.
        pub kernel_a: f32,
        /// Byte 68.
        pub kernel_n: f32,
        /// Unused: the layout leaves a gap here.
        pub _pad16: [u8; 8],
        /// Byte 80.
        pub background: [f32; 4],
        /// Byte 96.
        pub albedo: [f32; 4],
        /// Byte 112.
        pub radiance: [[f32; 4]; 4],
        /// Byte 176.
        pub ambient: f32,
        /// Byte 180.
        pub specular: f32,
        /// Byte 184.
        pub shininess: f32,
        /// Byte 188.
        pub pixel_filter: f32,
        /// Byte 192.
        pub edl: f32,
        /// Byte 196.
        pub ao: f32,
        /// Byte 200.
        pub pixel_width: f32,
        /// Unused: the layout leaves a gap here.
        pub _pad26: [u8; 4],
        /// Byte 208.
        pub origin: [f32; 2],
        /// Unused: the layout leaves a gap here.
        pub _pad27: [u8; 8],
    }
    const _: () = assert!(std::mem::offset_of!(Frame, viewport) == 0);
    const _: () = assert!(std::mem::offset_of!(Frame, near) == 8);
    const _: () = assert!(std::mem::offset_of!(Frame, key_slope) == 12);
    const _: () = assert!(std::mem::offset_of!(Frame, key_far) == 16);
    const _: () = assert!(std::mem::offset_of!(Frame, key_near) == 20);
    const _: () = assert!(std::mem::offset_of!(Frame, key_gain) == 24);
    const _: () = assert!(std::mem::offset_of!(Frame, key_reach) == 28);
    const _: () = assert!(std::mem::offset_of!(Frame, key_offset) == 32);
    const _: () = assert!(std::mem::offset_of!(Frame, key_at_zero) == 40);
    const _: () = assert!(std::mem::offset_of!(Frame, distance_offset) == 44);
    const _: () = assert!(std::mem::offset_of!(Frame, cutoff) == 48);
    const _: () = assert!(std::mem::offset_of!(Frame, epsilon) == 52);
    const _: () = assert!(std::mem::offset_of!(Frame, visibility_lowpass) == 56);
    const _: () = assert!(std::mem::offset_of!(Frame, attribute_lowpass) == 60);
    const _: () = assert!(std::mem::offset_of!(Frame, kernel_a) == 64);
    const _: () = assert!(std::mem::offset_of!(Frame, kernel_n) == 68);
    const _: () = assert!(std::mem::offset_of!(Frame, background) == 80);
    const _: () = assert!(std::mem::offset_of!(Frame, albedo) == 96);
    const _: () = assert!(std::mem::offset_of!(Frame, radiance) == 112);
    const _: () = assert!(std::mem::offset_of!(Frame, ambient) == 176);
    const _: () = assert!(std::mem::offset_of!(Frame, specular) == 180);
    const _: () = assert!(std::mem::offset_of!(Frame, shininess) == 184);
    const _: () = assert!(std::mem::offset_of!(Frame, pixel_filter) == 188);
    const _: () = assert!(std::mem::offset_of!(Frame, edl) == 192);
    const _: () = assert!(std::mem::offset_of!(Frame, ao) == 196);
    const _: () = assert!(std::mem::offset_of!(Frame, pixel_width) == 200);
    const _: () = assert!(std::mem::offset_of!(Frame, origin) == 208);
    const _: () = assert!(std::mem::size_of::<Frame>() == 224);

    /// `Group`, 16 bytes, first in `shaders-glsl/cull.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Group {
        /// Byte 0.
        pub first: u32,
        /// Byte 4.
        pub count: u32,
        /// Byte 8.
        pub slot: u32,
        /// Byte 12.
        pub instance: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Group, first) == 0);
    const _: () = assert!(std::mem::offset_of!(Group, count) == 4);
    const _: () = assert!(std::mem::offset_of!(Group, slot) == 8);
    const _: () = assert!(std::mem::offset_of!(Group, instance) == 12);
    const _: () = assert!(std::mem::size_of::<Group>() == 16);

    /// `Hierarchy`, 80 bytes, first in `shaders-glsl/attribute.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Hierarchy {
        /// Byte 0.
        pub starts: [u32; 10],
        /// Byte 40.
        pub attribute_rows: u32,
        /// Byte 44.
        pub level: u32,
        /// Byte 48.
        pub group: u32,
        /// Byte 52.
        pub slice: u32,
        /// Byte 56.
        pub slices: u32,
        /// Byte 60.
        pub most_steps: u32,
        /// Byte 64.
        pub frame_number: u32,
        /// Byte 68.
        pub fronts: u32,
        /// Byte 72.
        pub first_tile: [u32; 2],
    }
    const _: () = assert!(std::mem::offset_of!(Hierarchy, starts) == 0);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, attribute_rows) == 40);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, level) == 44);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, group) == 48);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, slice) == 52);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, slices) == 56);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, most_steps) == 60);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, frame_number) == 64);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, fronts) == 68);
    const _: () = assert!(std::mem::offset_of!(Hierarchy, first_tile) == 72);
    const _: () = assert!(std::mem::size_of::<Hierarchy>() == 80);

    /// `IncompleteFrame`, 4 bytes, first in `shaders-glsl/attribute.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct IncompleteFrame {
        /// Byte 0.
        pub incomplete_frame: u32,
    }
    const _: () = assert!(std::mem::offset_of!(IncompleteFrame, incomplete_frame) == 0);
    const _: () = assert!(std::mem::size_of::<IncompleteFrame>() == 4);

    /// `Level`, 32 bytes, first in `shaders-glsl/boxes.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Level {
        /// Byte 0.
        pub finer_start: u32,
        /// Byte 4.
        pub finer_count: u32,
        /// Byte 8.
        pub start: u32,
        /// Byte 12.
        pub count: u32,
        /// Byte 16.
        pub number: u32,
        /// Byte 20.
        pub loaded: u32,
        /// Byte 24.
        pub nodes: u32,
        /// Byte 28.
        pub fronts: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Level, finer_start) == 0);
    const _: () = assert!(std::mem::offset_of!(Level, finer_count) == 4);
    const _: () = assert!(std::mem::offset_of!(Level, start) == 8);
    const _: () = assert!(std::mem::offset_of!(Level, count) == 12);
    const _: () = assert!(std::mem::offset_of!(Level, number) == 16);
    const _: () = assert!(std::mem::offset_of!(Level, loaded) == 20);
    const _: () = assert!(std::mem::offset_of!(Level, nodes) == 24);
    const _: () = assert!(std::mem::offset_of!(Level, fronts) == 28);
    const _: () = assert!(std::mem::size_of::<Level>() == 32);

    /// `ListedTile`, 8 bytes, first in `shaders-glsl/behind.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ListedTile {
        /// Byte 0.
        pub key: u32,
        /// Byte 4.
        pub listed: u32,
    }
    const _: () = assert!(std::mem::offset_of!(ListedTile, key) == 0);
    const _: () = assert!(std::mem::offset_of!(ListedTile, listed) == 4);
    const _: () = assert!(std::mem::size_of::<ListedTile>() == 8);

    /// `Materials`, 4 bytes, first in `shaders-glsl/shade.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Materials {
        /// Byte 0.
        pub count: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Materials, count) == 0);
    const _: () = assert!(std::mem::size_of::<Materials>() == 4);

    /// `OccupiedTiles`, 40 bytes, first in `shaders-glsl/fetch.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct OccupiedTiles {
        /// Byte 0.
        pub workgroups: [Workgroups; 3],
        /// Byte 36.
        pub listed_count: u32,
    }
    const _: () = assert!(std::mem::offset_of!(OccupiedTiles, workgroups) == 0);
    const _: () = assert!(std::mem::offset_of!(OccupiedTiles, listed_count) == 36);
    const _: () = assert!(std::mem::size_of::<OccupiedTiles>() == 40);

    /// `OpenTiles`, 20 bytes, first in `shaders-glsl/hidden.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct OpenTiles {
        /// Byte 0.
        pub columns: u32,
        /// Byte 4.
        pub rows: u32,
        /// Byte 8.
        pub layers: u32,
        /// Byte 12.
        pub listed_count: u32,
        /// Byte 16.
        pub all: u32,
    }
    const _: () = assert!(std::mem::offset_of!(OpenTiles, columns) == 0);
    const _: () = assert!(std::mem::offset_of!(OpenTiles, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(OpenTiles, layers) == 8);
    const _: () = assert!(std::mem::offset_of!(OpenTiles, listed_count) == 12);
    const _: () = assert!(std::mem::offset_of!(OpenTiles, all) == 16);
    const _: () = assert!(std::mem::size_of::<OpenTiles>() == 20);

    /// `OrderStep`, 32 bytes, first in `shaders-glsl/order.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct OrderStep {
        /// Byte 0.
        pub curve: [f32; 4],
        /// Byte 16.
        pub count: u32,
        /// Byte 20.
        pub capacity: u32,
        /// Byte 24.
        pub runs: u32,
        /// Byte 28.
        pub digit: u32,
    }
    const _: () = assert!(std::mem::offset_of!(OrderStep, curve) == 0);
    const _: () = assert!(std::mem::offset_of!(OrderStep, count) == 16);
    const _: () = assert!(std::mem::offset_of!(OrderStep, capacity) == 20);
    const _: () = assert!(std::mem::offset_of!(OrderStep, runs) == 24);
    const _: () = assert!(std::mem::offset_of!(OrderStep, digit) == 28);
    const _: () = assert!(std::mem::size_of::<OrderStep>() == 32);

    /// `RevealedTiles`, 20 bytes, first in `shaders-glsl/boxes.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct RevealedTiles {
        /// Byte 0.
        pub columns: u32,
        /// Byte 4.
        pub rows: u32,
        /// Byte 8.
        pub layers: u32,
        /// Byte 12.
        pub listed_count: u32,
        /// Byte 16.
        pub all: u32,
    }
    const _: () = assert!(std::mem::offset_of!(RevealedTiles, columns) == 0);
    const _: () = assert!(std::mem::offset_of!(RevealedTiles, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(RevealedTiles, layers) == 8);
    const _: () = assert!(std::mem::offset_of!(RevealedTiles, listed_count) == 12);
    const _: () = assert!(std::mem::offset_of!(RevealedTiles, all) == 16);
    const _: () = assert!(std::mem::size_of::<RevealedTiles>() == 20);

    /// `ScalarOptions`, 8 bytes, first in `shaders-glsl/colour_map.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ScalarOptions {
        /// Byte 0.
        pub least_alpha: f32,
        /// Byte 4.
        pub opaque: u32,
    }
    const _: () = assert!(std::mem::offset_of!(ScalarOptions, least_alpha) == 0);
    const _: () = assert!(std::mem::offset_of!(ScalarOptions, opaque) == 4);
    const _: () = assert!(std::mem::size_of::<ScalarOptions>() == 8);

    /// `ScreenClip`, 32 bytes, first in `shaders-glsl/attribute.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ScreenClip {
        /// Byte 0.
        pub first: [f32; 4],
        /// Byte 16.
        pub second: [f32; 4],
    }
    const _: () = assert!(std::mem::offset_of!(ScreenClip, first) == 0);
    const _: () = assert!(std::mem::offset_of!(ScreenClip, second) == 16);
    const _: () = assert!(std::mem::size_of::<ScreenClip>() == 32);

    /// `Seed`, 24 bytes, first in `shaders-glsl/seed.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Seed {
        /// Byte 0.
        pub key: [f32; 2],
        /// Byte 8.
        pub key_offset: f32,
        /// Byte 12.
        pub resolution: f32,
        /// Byte 16.
        pub rounding: f32,
        /// Byte 20.
        pub behind: f32,
    }
    const _: () = assert!(std::mem::offset_of!(Seed, key) == 0);
    const _: () = assert!(std::mem::offset_of!(Seed, key_offset) == 8);
    const _: () = assert!(std::mem::offset_of!(Seed, resolution) == 12);
    const _: () = assert!(std::mem::offset_of!(Seed, rounding) == 16);
    const _: () = assert!(std::mem::offset_of!(Seed, behind) == 20);
    const _: () = assert!(std::mem::size_of::<Seed>() == 24);

    /// `Splat`, 64 bytes, first in `shaders-glsl/footprint.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Splat {
        /// Byte 0.
        pub offset: [f32; 2],
        /// Byte 8.
        pub axis: [f32; 2],
        /// Byte 16.
        pub variance: f32,
        /// Byte 20.
        pub detail: f32,
        /// Byte 24.
        pub anchor: u32,
        /// Byte 28.
        pub epsilon: f32,
        /// Byte 32.
        pub plane_hi: [f32; 3],
        /// Byte 44.
        pub sqrt_det: f32,
        /// Byte 48.
        pub plane_lo: [f32; 3],
        /// Byte 60.
        pub key_disc: f32,
    }
    const _: () = assert!(std::mem::offset_of!(Splat, offset) == 0);
    const _: () = assert!(std::mem::offset_of!(Splat, axis) == 8);
    const _: () = assert!(std::mem::offset_of!(Splat, variance) == 16);
    const _: () = assert!(std::mem::offset_of!(Splat, detail) == 20);
    const _: () = assert!(std::mem::offset_of!(Splat, anchor) == 24);
    const _: () = assert!(std::mem::offset_of!(Splat, epsilon) == 28);
    const _: () = assert!(std::mem::offset_of!(Splat, plane_hi) == 32);
    const _: () = assert!(std::mem::offset_of!(Splat, sqrt_det) == 44);
    const _: () = assert!(std::mem::offset_of!(Splat, plane_lo) == 48);
    const _: () = assert!(std::mem::offset_of!(Splat, key_disc) == 60);
    const _: () = assert!(std::mem::size_of::<Splat>() == 64);

    /// `Step`, 44 bytes, first in `shaders-glsl/copy.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Step {
        /// Byte 0.
        pub size: [i32; 2],
        /// Byte 8.
        pub to_origin: [i32; 2],
        /// Byte 16.
        pub from_origin: [i32; 2],
        /// Byte 24.
        pub adjacent_size: [i32; 2],
        /// Byte 32.
        pub adjacent_origin: [i32; 2],
        /// Byte 40.
        pub level: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Step, size) == 0);
    const _: () = assert!(std::mem::offset_of!(Step, to_origin) == 8);
    const _: () = assert!(std::mem::offset_of!(Step, from_origin) == 16);
    const _: () = assert!(std::mem::offset_of!(Step, adjacent_size) == 24);
    const _: () = assert!(std::mem::offset_of!(Step, adjacent_origin) == 32);
    const _: () = assert!(std::mem::offset_of!(Step, level) == 40);
    const _: () = assert!(std::mem::size_of::<Step>() == 44);

    /// `Subpass`, 16 bytes, first in `shaders-glsl/normalize.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Subpass {
        /// Byte 0.
        pub depth: [f32; 4],
    }
    const _: () = assert!(std::mem::offset_of!(Subpass, depth) == 0);
    const _: () = assert!(std::mem::size_of::<Subpass>() == 16);

    /// `Texture`, 12 bytes, first in `shaders-glsl/shade.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Texture {
        /// Byte 0.
        pub width: u32,
        /// Byte 4.
        pub height: u32,
        /// Byte 8.
        pub levels: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Texture, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Texture, height) == 4);
    const _: () = assert!(std::mem::offset_of!(Texture, levels) == 8);
    const _: () = assert!(std::mem::size_of::<Texture>() == 12);

    /// `ValueRange`, 8 bytes, first in `shaders-glsl/colour_map.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ValueRange {
        /// Byte 0.
        pub least: u32,
        /// Byte 4.
        pub greatest: u32,
    }
    const _: () = assert!(std::mem::offset_of!(ValueRange, least) == 0);
    const _: () = assert!(std::mem::offset_of!(ValueRange, greatest) == 4);
    const _: () = assert!(std::mem::size_of::<ValueRange>() == 8);

    /// `View`, 480 bytes, first in `shaders-glsl/ambient.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct View {
        /// Byte 0.
        pub rows_hi: [[f32; 4]; 3],
        /// Byte 48.
        pub rows_lo: [[f32; 4]; 3],
        /// Byte 96.
        pub eye_hi: [f32; 4],
        /// Byte 112.
        pub eye_lo: [f32; 4],
        /// Byte 128.
        pub ray_hi: [[f32; 4]; 3],
        /// Byte 176.
        pub ray_lo: [[f32; 4]; 3],
        /// Byte 224.
        pub forward_hi: [f32; 4],
        /// Byte 240.
        pub forward_lo: [f32; 4],
        /// Byte 256.
        pub flat_rows: [[f32; 4]; 2],
        /// Byte 288.
        pub to_light: [[f32; 4]; 4],
        /// Byte 352.
        pub rotation: [[f32; 4]; 3],
        /// Byte 400.
        pub scale: f32,
        /// Byte 404.
        pub near: f32,
        /// Byte 408.
        pub key_slope: f32,
        /// Byte 412.
        pub jacobian: f32,
        /// Byte 416.
        pub first_id: u32,
        /// Byte 420.
        pub level_spacing: f32,
        /// Byte 424.
        pub level_reach: f32,
        /// Byte 428.
        pub distance_offset: f32,
        /// Byte 432.
        pub level_starts: [[u32; 4]; 3],
    }
    const _: () = assert!(std::mem::offset_of!(View, rows_hi) == 0);
    const _: () = assert!(std::mem::offset_of!(View, rows_lo) == 48);
    const _: () = assert!(std::mem::offset_of!(View, eye_hi) == 96);
    const _: () = assert!(std::mem::offset_of!(View, eye_lo) == 112);
    const _: () = assert!(std::mem::offset_of!(View, ray_hi) == 128);
    const _: () = assert!(std::mem::offset_of!(View, ray_lo) == 176);
    const _: () = assert!(std::mem::offset_of!(View, forward_hi) == 224);
    const _: () = assert!(std::mem::offset_of!(View, forward_lo) == 240);
    const _: () = assert!(std::mem::offset_of!(View, flat_rows) == 256);
    const _: () = assert!(std::mem::offset_of!(View, to_light) == 288);
    const _: () = assert!(std::mem::offset_of!(View, rotation) == 352);
    const _: () = assert!(std::mem::offset_of!(View, scale) == 400);
    const _: () = assert!(std::mem::offset_of!(View, near) == 404);
    const _: () = assert!(std::mem::offset_of!(View, key_slope) == 408);
    const _: () = assert!(std::mem::offset_of!(View, jacobian) == 412);
    const _: () = assert!(std::mem::offset_of!(View, first_id) == 416);
    const _: () = assert!(std::mem::offset_of!(View, level_spacing) == 420);
    const _: () = assert!(std::mem::offset_of!(View, level_reach) == 424);
    const _: () = assert!(std::mem::offset_of!(View, distance_offset) == 428);
    const _: () = assert!(std::mem::offset_of!(View, level_starts) == 432);
    const _: () = assert!(std::mem::size_of::<View>() == 480);

    /// `Views`, 16320 bytes, first in `shaders-glsl/ambient.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Views {
        /// Byte 0.
        pub views: [View; 34],
    }
    const _: () = assert!(std::mem::offset_of!(Views, views) == 0);
    const _: () = assert!(std::mem::size_of::<Views>() == 16320);

    /// `VisibleCluster`, 12 bytes, first in `shaders-glsl/cull.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct VisibleCluster {
        /// Byte 0.
        pub cluster: u32,
        /// Byte 4.
        pub slot: u32,
        /// Byte 8.
        pub instance: u32,
    }
    const _: () = assert!(std::mem::offset_of!(VisibleCluster, cluster) == 0);
    const _: () = assert!(std::mem::offset_of!(VisibleCluster, slot) == 4);
    const _: () = assert!(std::mem::offset_of!(VisibleCluster, instance) == 8);
    const _: () = assert!(std::mem::size_of::<VisibleCluster>() == 12);

    /// `VisibleClusters`, 32 bytes, first in `shaders-glsl/cull.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct VisibleClusters {
        /// Byte 0.
        pub columns: u32,
        /// Byte 4.
        pub rows: u32,
        /// Byte 8.
        pub layers: u32,
        /// Byte 12.
        pub visible_count: u32,
        /// Byte 16.
        pub revealed_columns: u32,
        /// Byte 20.
        pub revealed_rows: u32,
        /// Byte 24.
        pub revealed_layers: u32,
        /// Byte 28.
        pub revealed_count: u32,
    }
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, columns) == 0);
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, layers) == 8);
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, visible_count) == 12);
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, revealed_columns) == 16);
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, revealed_rows) == 20);
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, revealed_layers) == 24);
    const _: () = assert!(std::mem::offset_of!(VisibleClusters, revealed_count) == 28);
    const _: () = assert!(std::mem::size_of::<VisibleClusters>() == 32);

    /// `Workgroups`, 12 bytes, first in `shaders-glsl/fetch.glsl`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Workgroups {
        /// Byte 0.
        pub columns: u32,
        /// Byte 4.
        pub rows: u32,
        /// Byte 8.
        pub layers: u32,
    }
    const _: () = assert!(std::mem::offset_of!(Workgroups, columns) == 0);
    const _: () = assert!(std::mem::offset_of!(Workgroups, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(Workgroups, layers) == 8);
    const _: () = assert!(std::mem::size_of::<Workgroups>() == 12);

}
