// Splats of many pixels: how many each instance has, and from each list's start on their numbers.

layout(set = 0, binding = 7, std430) LIST_ACCESS buffer LargeSplats { uint large_splats[]; };
