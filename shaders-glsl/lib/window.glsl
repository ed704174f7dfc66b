// The surfels and splats that the bound descriptor set names: `count` of them, from number `first` of the scene on.

layout(push_constant) uniform Window { uint count; uint first; } window;
