// Order of a scene's surfels on the tile path, if they are stored in no order: consecutive entries are close together in space.

// Of each surfel, in that order, its index; then scratch memory of the sort (order.glsl).
layout(set = 0, binding = 20, std430) ORDER_ACCESS buffer Order { uint order[]; };
