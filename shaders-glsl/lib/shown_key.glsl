// κ of fragments. The low-pass widens a disc over which its plane extends in front of it: by little where the plane is that of the surface,
// far where the disc is seen edge-on.

#ifndef LIB_SHOWN_KEY
#define LIB_SHOWN_KEY

// Largest κ of fragments of a disc whose nearest point has κ `key_disc`.
float largest_shown_key(float key_disc) {
    if (DISTANT) return key_disc + frame.key_reach * inverse_depth(key_disc);
    return PERSPECTIVE ? frame.key_reach * key_disc : key_disc + frame.key_reach;
}

// κ of a fragment where the plane of its disc has κ `key`.
float shown_key(float key, float key_disc) {
    return min(key, largest_shown_key(key_disc));
}

#endif
