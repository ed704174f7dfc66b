//! Hierarchies of levels of detail.

/// The hierarchy that levels of detail come from.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Hierarchy {
    /// Cells of a grid, selected on the GPU in every frame.
    ///
    /// These are [`Levels`](crate::geometry::Levels).
    #[default]
    Grid,
    /// The point octree of pajarola2004, selected on the CPU for each camera.
    ///
    /// This is a [`PointOctree`](crate::geometry::PointOctree).
    Paper,
}
