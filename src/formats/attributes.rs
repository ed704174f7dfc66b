//! Properties of points as numbers of their own types: what a model does not hold, and other files of points keep.

use super::declared::Scalar;
use super::source::{Parsed, room};

/// Which properties of the points are read as [`Attribute`]s.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum WantedAttributes {
    /// None.
    #[default]
    None,
    /// Those with these names that the file has.
    Named(Vec<String>),
    /// All properties that a cloud does not hold.
    Others,
    /// These, and the coordinates and colours of the file.
    All,
}

/// A property of the points of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Name, as declared.
    pub name: String,
    /// Its numbers, one per point of the cloud, in the file's order.
    pub values: Values,
}

macro_rules! values {
    ($($kind:ident: $type:ty;)*) => {
        /// Numbers of a declared type.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Values {
            $(#[doc = concat!("Of the type `", stringify!($type), "`.")] $kind(Vec<$type>),)*
        }

        /// Consecutive [`Values`], to be filled.
        pub(super) enum ValuesMut<'a> {
            $($kind(&'a mut [$type]),)*
        }

        impl Values {
            /// Zeros.
            pub(super) fn new(scalar: Scalar, count: u64) -> Parsed<Self> {
                Ok(match scalar {
                    $(Scalar::$kind => Self::$kind(room(count)?),)*
                })
            }

            /// Type of the numbers.
            pub fn scalar(&self) -> Scalar {
                match self {
                    $(Self::$kind(_) => Scalar::$kind,)*
                }
            }

            /// Number of numbers.
            pub fn len(&self) -> usize {
                match self {
                    $(Self::$kind(all) => all.len(),)*
                }
            }

            /// Number `index`; `None` beyond the last one. 64-bit integers are rounded to float64.
            pub fn get(&self, index: usize) -> Option<f64> {
                match self {
                    $(Self::$kind(all) => all.get(index).map(|value| *value as f64),)*
                }
            }

            /// All numbers, to be filled.
            pub(super) fn all_mut(&mut self) -> ValuesMut<'_> {
                match self {
                    $(Self::$kind(all) => ValuesMut::$kind(all),)*
                }
            }

            /// Removes numbers whose `kept` is false.
            pub(super) fn retain(&mut self, kept: &[bool]) {
                let mut flags = kept.iter();
                let mut is_kept = || flags.next().is_none_or(|kept| *kept);
                match self {
                    $(Self::$kind(all) => all.retain(|_| is_kept()),)*
                }
            }
        }

        impl<'a> ValuesMut<'a> {
            /// Splits off the first numbers.
            pub fn split(&mut self, count: usize) -> ValuesMut<'a> {
                match self {
                    $(Self::$kind(rest) => {
                        let (first, others) =
                            std::mem::take(rest).split_at_mut_checked(count).unwrap_or_default();
                        *rest = others;
                        ValuesMut::$kind(first)
                    })*
                }
            }

            /// Stores numbers; those beyond an integer type become its nearest number.
            pub fn store(&mut self, numbers: &[f64]) {
                match self {
                    $(Self::$kind(to) => {
                        to.iter_mut().zip(numbers).for_each(|(to, number)| *to = *number as $type);
                    })*
                }
            }
        }
    };
}

values! {
    I8: i8;
    U8: u8;
    I16: i16;
    U16: u16;
    I32: i32;
    U32: u32;
    I64: i64;
    U64: u64;
    F32: f32;
    F64: f64;
}

impl Values {
    /// Whether there are no numbers.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
