// Stage of lighting: Shade of src/settings/splatting.rs.

#ifndef LIB_SHADE
#define LIB_SHADE

layout(constant_id = 20) const uint SHADE = 1;

const uint PER_SPLAT = 0;      // summed colours are lit: splats are lit at their centres
const uint BY_MEAN_NORMAL = 2; // pixels are lit; diffuse light is that of the mean normal

#endif
