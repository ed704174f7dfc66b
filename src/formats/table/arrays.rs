//! Arrays of the points' attributes, filled in pieces by several threads.

use super::columns::{CORNERS, MATERIAL, SCALAR, TANGENT, TEXTURE, WEIGHT};
use super::layout::{Layout, Shape};
use crate::formats::attributes::{Values, ValuesMut};
use crate::formats::source::Parsed;
use crate::formats::source::room;
use crate::geometry::memory;
use crate::geometry::{Clip, Ellipse};
use glam::{DVec3, Vec2, Vec3};

macro_rules! arrays {
    ($($name:ident: $type:ty, $there:expr, $what:literal;)*) => {
        /// Arrays with one entry per vertex that is read; empty for attributes that the file does not have.
        #[derive(Default)]
        pub struct Arrays {
            $(#[doc = $what] pub $name: Vec<$type>,)*
            /// The attributes of the layout.
            pub attributes: Vec<Values>,
        }

        /// Consecutive entries of [`Arrays`].
        pub struct Slices<'a> {
            $(#[doc = $what] pub $name: &'a mut [$type],)*
            /// The attributes of the layout.
            pub attributes: Vec<ValuesMut<'a>>,
        }

        impl Arrays {
            /// Arrays of zeros for the points of a file that the layout's filter keeps by their number. `count`, that of all points, is
            /// validated against the size of the file.
            pub fn new(count: u64, layout: &Layout) -> Parsed<Self> {
                let count = layout.filter.thinned(count);
                let each = layout.attributes.iter().map(|(_, scalar)| scalar.size()).sum::<u64>()
                    $(+ if $there(layout) { size_of::<$type>() as u64 } else { 0 })*;
                memory::check(&format!("its {count} points"), count.saturating_mul(each))?;
                let attributes = layout.attributes.iter().map(|(_, scalar)| Values::new(*scalar, count));
                Ok(Self {
                    $($name: room(if $there(layout) { count } else { 0 })?,)*
                    attributes: attributes.collect::<Parsed<_>>()?,
                })
            }

            /// All entries.
            pub fn slices(&mut self) -> Slices<'_> {
                Slices {
                    $($name: &mut self.$name,)*
                    attributes: self.attributes.iter_mut().map(Values::all_mut).collect(),
                }
            }

            /// Removes entries whose `kept` is false.
            pub fn retain(&mut self, kept: &[bool]) {
                $(let mut flags = kept.iter();
                self.$name.retain(|_| flags.next().is_none_or(|kept| *kept));)*
                self.attributes.iter_mut().for_each(|values| values.retain(kept));
            }
        }

        impl<'a> Slices<'a> {
            /// Splits off the first `rows` entries.
            pub fn split(&mut self, rows: usize) -> Slices<'a> {
                Slices {
                    $($name: split(&mut self.$name, rows),)*
                    attributes: self.attributes.iter_mut().map(|values| values.split(rows)).collect(),
                }
            }
        }
    };
}

arrays! {
    narrow: Vec3, |layout: &Layout| layout.narrow, "Positions in the file; not finite if missing.";
    wide: DVec3, |layout: &Layout| !layout.narrow, "The same, if f32 would round them.";
    normals: Vec3, Layout::has_normals, "Unit normals or 0.";
    radii: f32, Layout::has_radii, "Radii or 0.";
    ellipses: Ellipse, |layout: &Layout| layout.shape != Shape::Circle, "Shapes.";
    two_sided: bool, Layout::has_sides, "Whether the surfel is two-sided.";
    clips: Clip, Layout::has_clips, "Clips; both lines are `ClipLine::NONE` if the disc is whole.";
    weights: f32, |layout: &Layout| layout.fills(WEIGHT), "Normalization weights or 0.";
    corners: [f32; 4], |layout: &Layout| layout.fills(CORNERS), "Corner weights of discs at borders; all 0 for others.";
    tangents: Vec3, |layout: &Layout| layout.fills(TANGENT), "Unit tangents or 0.";
    codes: [u8; 4], Layout::has_codes, "sRGB-encoded colours.";
    linear: [f32; 3], |layout: &Layout| layout.colour.is_some() && !layout.has_codes(), "Linear colours.";
    coordinates: Vec2, |layout: &Layout| layout.fills(TEXTURE), "Coordinates in a texture.";
    materials: u16, |layout: &Layout| layout.fills(MATERIAL), "Material indices, or `Materials::NONE`.";
    scalar: f64, |layout: &Layout| layout.fills(SCALAR), "The chosen scalar.";
}

fn split<'a, T>(rest: &mut &'a mut [T], rows: usize) -> &'a mut [T] {
    let (first, others) = std::mem::take(rest).split_at_mut_checked(rows).unwrap_or_default();
    *rest = others;
    first
}
