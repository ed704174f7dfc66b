// Extensions of tile passes. With SUBGROUPS, lanes exchange values by shuffles and splats are texel buffers, which is faster on lavapipe;
// otherwise by shared memory and storage buffers, which every device supports.

#ifdef COMPUTE
#define TILE_PASS
#extension GL_EXT_control_flow_attributes : require
#ifdef SUBGROUPS_SLICES
#define SUBGROUPS
#define SLICES
#endif
#ifdef SUBGROUPS
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_samplerless_texture_functions : require
#endif
#endif
