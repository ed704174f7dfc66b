//! Declarations of a file: encoding, elements and properties.

use std::fmt;

/// Encoding of the records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Decimal numbers between white space.
    Ascii,
    /// Packed little-endian binary.
    BinaryLittleEndian,
    /// Packed big-endian binary.
    BinaryBigEndian,
    /// Binary in fewer bits than the numbers have.
    Compressed,
}

/// Type of a number in a record, with its PLY names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// `char` or `int8`.
    I8,
    /// `uchar` or `uint8`.
    U8,
    /// `short` or `int16`.
    I16,
    /// `ushort` or `uint16`.
    U16,
    /// `int` or `int32`.
    I32,
    /// `uint` or `uint32`.
    U32,
    /// A 64-bit integer, not of PLY.
    I64,
    /// A 64-bit unsigned integer, not of PLY.
    U64,
    /// `float` or `float32`.
    F32,
    /// `double` or `float64`.
    F64,
}

/// Type of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One number.
    Scalar(Scalar),
    /// A length and that many items.
    List {
        /// Type of the length, an integer.
        length: Scalar,
        /// Type of the items.
        item: Scalar,
    },
}

/// A property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Property {
    /// Name, as in the file.
    pub name: String,
    /// Type.
    pub kind: Kind,
}

/// An element: a group of records of one kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element {
    /// Type.
    pub name: String,
    /// Declared number of records.
    pub count: u64,
    /// Properties of each record, in order.
    pub properties: Vec<Property>,
}

impl Scalar {
    /// Size in a binary record, bytes.
    pub fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Whether it is a floating-point type.
    pub fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// The type with one of its two names.
    pub(super) fn of_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }
}

impl Kind {
    /// Least size in a binary record, bytes: for a list, without items.
    pub fn least_size(self) -> u64 {
        match self {
            Self::Scalar(scalar) => scalar.size(),
            Self::List { length, .. } => length.size(),
        }
    }
}

impl Element {
    /// Least size of a binary record, bytes; the size of every record without lists.
    pub fn least_stride(&self) -> u64 {
        self.properties.iter().map(|property| property.kind.least_size()).sum()
    }

    /// Whether records may differ in size.
    pub fn has_lists(&self) -> bool {
        self.properties.iter().any(|property| matches!(property.kind, Kind::List { .. }))
    }
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ascii => "ascii",
            Self::BinaryLittleEndian => "binary_little_endian",
            Self::BinaryBigEndian => "binary_big_endian",
            Self::Compressed => "compressed",
        })
    }
}

impl fmt::Display for Scalar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::I8 => "char",
            Self::U8 => "uchar",
            Self::I16 => "short",
            Self::U16 => "ushort",
            Self::I32 => "int",
            Self::U32 => "uint",
            Self::I64 => "int64",
            Self::U64 => "uint64",
            Self::F32 => "float",
            Self::F64 => "double",
        })
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scalar(scalar) => scalar.fmt(f),
            Self::List { length, item } => write!(f, "list {length} {item}"),
        }
    }
}
