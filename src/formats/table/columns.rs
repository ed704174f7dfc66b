//! Columns of a block of vertices, and the names of properties that are written.

/// Number of columns.
pub const COLUMNS: usize = FILTER + 3;
/// Column of x; y and z follow.
pub const POSITION: usize = 0;
/// Column of nx; ny and nz follow.
pub const NORMAL: usize = 3;
/// Column of the radius.
pub const RADIUS: usize = 6;
/// Column of red; green and blue follow. For 3D Gaussians, of the constant harmonics f_dc_0 to 2.
pub const COLOUR: usize = 7;
/// Column of ux; uy uz, vx vy vz follow. For 3D Gaussians, of scale_0 to 2.
pub const AXES: usize = 10;
/// Column of two_sided.
pub const TWO_SIDED: usize = 16;
/// Column of the opacity of a 3D Gaussian.
pub const OPACITY: usize = 17;
/// Column of rot_0, the real part of a 3D Gaussian's rotation; rot_1 to 3 follow.
pub const ROTATION: usize = 18;
/// Column of clip0x; clip0y clip0z clip0d, clip1x clip1y clip1z clip1d follow.
pub const CLIPS: usize = 22;
/// Column of clip_concave.
pub const CONCAVE: usize = 30;
/// Column of surfel_weight.
pub const WEIGHT: usize = 31;
/// Column of surfel_weight0; 1 to 3 follow.
pub const CORNERS: usize = 32;
/// Column of tx; ty and tz follow.
pub const TANGENT: usize = 36;
/// Column of u in a texture; v follows.
pub const TEXTURE: usize = 39;
/// Column of material_index.
pub const MATERIAL: usize = 41;
/// Column of the scalar that the caller selects.
pub const SCALAR: usize = 42;
/// Column of the first property of a [`Filter`](crate::formats::Filter); two others follow.
pub const FILTER: usize = 43;

/// Column names of two clip lines.
pub const CLIP_LINES: [[&str; 4]; 2] =
    [["clip0x", "clip0y", "clip0z", "clip0d"], ["clip1x", "clip1y", "clip1z", "clip1d"]];
/// Column name of the flag of concave corners.
pub const CLIP_CONCAVE: &str = "clip_concave";
/// Column name of normalization weights.
pub const WEIGHT_NAME: &str = "surfel_weight";
/// Column names of corner weights.
pub const CORNER_NAMES: [&str; 4] = ["surfel_weight0", "surfel_weight1", "surfel_weight2", "surfel_weight3"];
/// Column names of tangents.
pub const TANGENT_NAMES: [&str; 3] = ["tx", "ty", "tz"];
/// Column name of the material index.
pub const MATERIAL_NAME: &str = "material_index";
