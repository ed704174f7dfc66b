//! Numbers of accessors, every range checked.

use super::schema::{Accessor, Document, SparsePart, component};
use crate::formats::declared::Scalar;
use crate::formats::quoted::quoted;
use crate::formats::source::Parsed;
use crate::formats::table::binary::decode;
use std::borrow::Cow;

/// The description of a file, and the contents of its buffers.
pub struct Contents<'a> {
    pub document: &'a Document,
    pub buffers: &'a [Cow<'a, [u8]>],
}

/// Elements at equal distances.
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// The numbers of an accessor.
pub struct Numbers<'a> {
    /// Number of elements.
    pub count: usize,
    pub scalar: Scalar,
    normalized: bool,
    /// `None` for zeros.
    base: Option<Strided<'a>>,
    /// Indices of replaced elements, rising, and these elements.
    sparse: Option<(Vec<usize>, Strided<'a>)>,
}

impl<'a> Contents<'a> {
    /// The numbers of accessor `index`, of which each element has one of these widths.
    pub fn numbers(&self, index: u32, widths: &[usize]) -> Parsed<Numbers<'a>> {
        let named = |cause: crate::error::Cause| format!("accessor {index}: {cause}").into();
        let accessor = self.document.accessors.get(index as usize).ok_or_else(|| {
            format!("it refers to accessor {index}, which it does not have: fetch or write it again")
        })?;
        self.read(accessor, widths).map_err(named)
    }

    /// The bytes of a buffer view.
    pub fn view(&self, view: u32) -> Parsed<&'a [u8]> {
        let length = self.document.buffer_views.get(view as usize).map_or(0, |view| view.byte_length);
        Ok(self.strided(view, 0, length, 1)?.bytes)
    }

    fn read(&self, accessor: &Accessor, widths: &[usize]) -> Parsed<Numbers<'a>> {
        let kind = accessor.component_type;
        let scalar = component(kind)
            .ok_or_else(|| format!("{kind} is not a type of numbers: fetch or write it again"))?;
        let width = match accessor.shape.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        if !widths.contains(&width) {
            let shape = quoted(accessor.shape.as_bytes());
            return Err(format!("elements {shape} do not fit what they are used for: write it again").into());
        }
        let size = width * scalar.size() as usize;
        let base = match accessor.buffer_view {
            Some(view) => Some(self.strided(view, accessor.byte_offset, accessor.count, size)?),
            None => {
                self.check_zeros(accessor)?;
                None
            }
        };
        // Fits: the elements are in memory, or fewer than its bytes.
        let count = accessor.count as usize;
        let sparse = accessor.sparse.as_ref();
        let sparse =
            sparse.map(|sparse| self.sparse(&sparse.indices, &sparse.values, sparse.count, count, size));
        Ok(Numbers { count, scalar, normalized: accessor.normalized, base, sparse: sparse.transpose()? })
    }

    /// Zeros, which take no bytes, are at most as many as all buffers have bytes.
    fn check_zeros(&self, accessor: &Accessor) -> Parsed<()> {
        let bytes: u64 = self.buffers.iter().map(|buffer| buffer.len() as u64).sum();
        if accessor.sparse.is_some() && accessor.count <= bytes {
            return Ok(());
        }
        Err(format!(
            "it has no data for its {} elements: write it without compression or other extensions",
            accessor.count
        )
        .into())
    }

    /// `count` elements of `size` bytes in a buffer view.
    fn strided(&self, view: u32, offset: u64, count: u64, size: usize) -> Parsed<Strided<'a>> {
        let at = self.document.buffer_views.get(view as usize);
        let at = at.ok_or_else(|| format!("there is no buffer view {view}: fetch or write it again"))?;
        let buffer = self.buffers.get(at.buffer as usize).map(|buffer| &**buffer);
        let buffer =
            buffer.ok_or_else(|| format!("there is no buffer {}: fetch or write it again", at.buffer))?;
        if buffer.is_empty()
            && let Some(extension) = at.extensions.keys().next()
        {
            let extension = quoted(extension.as_bytes());
            return Err(format!(
                "buffer view {view} needs the extension {extension}: write it without compression"
            )
            .into());
        }
        let stride = at.byte_stride.unwrap_or(size as u64);
        let range = |start: u64, length: u64| {
            let end = start.checked_add(length)?;
            Some((usize::try_from(start).ok()?, usize::try_from(end).ok()?))
        };
        let length = match count {
            0 => Some(0),
            _ => (count - 1).checked_mul(stride).and_then(|length| length.checked_add(size as u64)),
        };
        let all = range(at.byte_offset, at.byte_length).and_then(|(start, end)| buffer.get(start..end));
        let part = length.and_then(|length| range(offset, length));
        let bytes = all.zip(part).and_then(|(all, (start, end))| all.get(start..end));
        let stride = usize::try_from(stride).ok().filter(|stride| *stride >= size);
        bytes.zip(stride).map(|(bytes, stride)| Strided { bytes, stride }).ok_or_else(|| {
            format!(
                "{count} elements of {size} bytes at byte {offset} are not in buffer view {view}: the file is truncated or wrong; fetch it \
                 again"
            )
            .into()
        })
    }

    /// The indices and the elements that a sparse accessor replaces.
    fn sparse(
        &self,
        indices: &SparsePart,
        values: &SparsePart,
        count: u64,
        all: usize,
        size: usize,
    ) -> Parsed<(Vec<usize>, Strided<'a>)> {
        let scalar = component(indices.component_type);
        let scalar = scalar.filter(|scalar| matches!(scalar, Scalar::U8 | Scalar::U16 | Scalar::U32));
        let scalar = scalar.ok_or("its sparse indices are not unsigned integers: write it again")?;
        let width = scalar.size() as usize;
        let places = self.strided(indices.buffer_view, indices.byte_offset, count, width)?;
        let index = |slot: usize| decode(places.element(slot, 0), scalar, false).unwrap_or(f64::NAN) as usize;
        let found: Vec<usize> = (0..count as usize).map(index).collect();
        if !found.is_sorted_by(|a, b| a < b) || found.last().is_some_and(|last| *last >= all) {
            return Err(
                "its sparse indices do not rise, or exceed its elements: fetch or write it again".into()
            );
        }
        Ok((found, self.strided(values.buffer_view, values.byte_offset, count, size)?))
    }
}

impl Strided<'_> {
    /// The bytes from `offset` on of an element; empty if there are none.
    fn element(&self, index: usize, offset: usize) -> &[u8] {
        self.bytes.get(index * self.stride + offset..).unwrap_or_default()
    }
}

impl Numbers<'_> {
    /// A number of an element, which must exist.
    pub fn get(&self, element: usize, axis: usize) -> f64 {
        let replaced = self.sparse.as_ref().and_then(|(indices, values)| {
            let slot = indices.binary_search(&element).ok()?;
            Some((values, slot))
        });
        let Some((from, index)) = replaced.or_else(|| Some((self.base.as_ref()?, element))) else {
            return 0.0;
        };
        let offset = axis * self.scalar.size() as usize;
        let value = decode(from.element(index, offset), self.scalar, false).unwrap_or_default();
        if self.normalized { normalize(value, self.scalar) } else { value }
    }

    /// The elements as indices.
    pub fn indices(&self) -> impl Iterator<Item = u32> {
        (0..self.count).map(|element| self.get(element, 0) as u32)
    }
}

/// The fraction that a normalized integer means.
fn normalize(value: f64, scalar: Scalar) -> f64 {
    match scalar {
        Scalar::I8 => (value / 127.0).max(-1.0),
        Scalar::U8 => value / 255.0,
        Scalar::I16 => (value / 32767.0).max(-1.0),
        Scalar::U16 => value / 65535.0,
        _ => value,
    }
}
