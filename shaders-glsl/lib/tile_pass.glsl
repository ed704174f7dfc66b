// What passes over tiles are compiled with. With SUBGROUPS they pass values on by shuffles and fetch splats as texels, which is faster on
// lavapipe; otherwise by shared memory and from storage buffers, as every device can.

#ifdef COMPUTE
#define TILE_PASS
#ifdef SUBGROUPS
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_samplerless_texture_functions : require
#endif
#endif
