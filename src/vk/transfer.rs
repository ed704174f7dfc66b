//! Uploads to device-local buffers.

use super::{Access, Buffer, Commands, Device, Recorder, Use};
use crate::error::Result;
use ash::vk;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;

/// Size of the staging buffer of synchronous uploads, bytes.
const CHUNK: usize = 32 << 20;

/// Creates buffers with contents, and writes to buffers.
pub struct Uploads<'a> {
    device: &'a Arc<Device>,
    way: RefCell<Way>,
}

enum Way {
    /// Submitted and waited for chunk by chunk.
    Now(Commands),
    /// Staged; recorded by [`Uploads::record`].
    Later(Vec<Copy>),
    /// Kept; staged and recorded piece by piece.
    Kept(VecDeque<Kept>),
}

/// A copy of a whole staging buffer to an offset, bytes.
struct Copy {
    from: Buffer,
    to: vk::Buffer,
    at: u64,
    written: Use,
    read: Use,
}

/// Contents of a buffer of which the bytes from `at` on are not copied yet.
struct Kept {
    bytes: Vec<u8>,
    at: usize,
    to: vk::Buffer,
    written: Use,
    read: Use,
}

/// Copies that are staged and recorded piece by piece. Their destinations must outlive them.
pub struct Pieces {
    list: VecDeque<Kept>,
    device: Arc<Device>,
}

/// Source buffers of recorded copies. Keep it until the GPU has executed the copies.
#[derive(Default)]
#[must_use = "the recorded copies read it: keep it until the GPU has executed them"]
pub struct Staging(Vec<Buffer>);

impl Staging {
    /// Memory of the buffers, bytes.
    pub fn bytes(&self) -> u64 {
        self.0.iter().map(Buffer::size).sum()
    }
}

impl<'a> Uploads<'a> {
    /// Synchronous uploads. Returns an error on an external device.
    pub fn now(device: &'a Arc<Device>) -> Result<Self> {
        Ok(Self { device, way: RefCell::new(Way::Now(Commands::new(device, false)?)) })
    }

    /// Uploads that [`Uploads::record`] records.
    pub fn later(device: &'a Arc<Device>) -> Self {
        Self { device, way: RefCell::new(Way::Later(Vec::new())) }
    }

    /// Uploads that [`Pieces::record`] records.
    pub fn kept(device: &'a Arc<Device>) -> Self {
        Self { device, way: RefCell::new(Way::Kept(VecDeque::new())) }
    }

    /// The kept copies.
    pub fn pieces(self) -> Pieces {
        let list = match self.way.into_inner() {
            Way::Kept(list) => list,
            Way::Now(_) | Way::Later(_) => VecDeque::new(),
        };
        Pieces { list, device: self.device.clone() }
    }

    /// Creates a storage buffer with the contents `bytes`. An empty slice creates a buffer of 4 zero bytes, so that it can be bound.
    pub fn buffer(&self, name: &str, bytes: &[u8]) -> Result<Buffer> {
        let bytes = if bytes.is_empty() { &[0; 4][..] } else { bytes };
        let buffer = Buffer::storage(self.device, name, bytes.len() as u64)?;
        self.write(&buffer, 0, bytes)?;
        Ok(buffer)
    }

    /// Writes `bytes` to a buffer of the device at byte `at`, for shader reads. Both are multiples of 4, and the buffer must be large
    /// enough. Commands that were recorded before read the old contents.
    pub fn write(&self, buffer: &Buffer, at: u64, bytes: &[u8]) -> Result<()> {
        match &mut *self.way.borrow_mut() {
            Way::Now(commands) => copy_now(self.device, commands, buffer, at, bytes),
            Way::Later(copies) => {
                let mut from = Buffer::staging(self.device, "staging", bytes.len() as u64)?;
                from.bytes_mut().copy_from_slice(bytes);
                let (written, read) = (buffer.with(Access::COPY_WRITE), buffer.with(Access::SHADER_READ));
                copies.push(Copy { from, to: buffer.raw, at, written, read });
                Ok(())
            }
            Way::Kept(list) => {
                assert_eq!(at, 0, "kept copies are of whole buffers");
                let (written, read) = (buffer.with(Access::COPY_WRITE), buffer.with(Access::SHADER_READ));
                list.push_back(Kept { bytes: bytes.to_vec(), at: 0, to: buffer.raw, written, read });
                Ok(())
            }
        }
    }

    /// Records the copies. The destination buffers must be alive; keep the staging buffers until the GPU has executed the copies.
    pub fn record(self, rec: &mut Recorder<'_>) -> Staging {
        let Way::Later(copies) = self.way.into_inner() else { return Staging::default() };
        let uses = copies.iter().flat_map(|copy| [copy.from.with(Access::COPY_READ), copy.written]);
        if copies.is_empty() {
            return Staging::default();
        }
        let mut enc = rec.pass("upload", &uses.collect::<Vec<_>>());
        copies.iter().for_each(|copy| enc.copy_part(&copy.from, copy.to, [0, copy.at], copy.from.size()));
        drop(enc);
        rec.settle(&copies.iter().map(|copy| copy.read).collect::<Vec<_>>());
        Staging(copies.into_iter().map(|copy| copy.from).collect())
    }
}

impl Pieces {
    /// Bytes that are not recorded yet.
    pub fn left(&self) -> u64 {
        self.list.iter().map(|kept| (kept.bytes.len() - kept.at) as u64).sum()
    }

    /// Stages and records copies of at most `most` bytes, but at least 4. After an error nothing is recorded.
    pub fn record(&mut self, rec: &mut Recorder<'_>, most: u64) -> Result<Staging> {
        let most = (most / 4 * 4).max(4).min(self.left());
        if most == 0 {
            return Ok(Staging::default());
        }
        let mut from = Buffer::staging(&self.device, "staging", most)?;
        let mut uses = vec![from.with(Access::COPY_READ)];
        let (mut copies, mut read, mut staged) = (Vec::new(), Vec::new(), 0);
        let room = most as usize;
        while let Some(kept) = self.list.front_mut().filter(|_| staged < room) {
            let size = (kept.bytes.len() - kept.at).min(room - staged);
            from.bytes_mut()[staged..staged + size].copy_from_slice(&kept.bytes[kept.at..kept.at + size]);
            copies.push(([staged as u64, kept.at as u64], kept.to, size as u64));
            uses.push(kept.written);
            read.push(kept.read);
            (staged, kept.at) = (staged + size, kept.at + size);
            if kept.at == kept.bytes.len() {
                self.list.pop_front();
            }
        }
        let mut enc = rec.pass("upload", &uses);
        copies.into_iter().for_each(|(places, to, size)| enc.copy_part(&from, to, places, size));
        drop(enc);
        rec.settle(&read);
        Ok(Staging(vec![from]))
    }
}

fn copy_now(
    device: &Arc<Device>,
    commands: &mut Commands,
    buffer: &Buffer,
    at: u64,
    bytes: &[u8],
) -> Result<()> {
    let mut staging = Buffer::staging(device, "staging", bytes.len().min(CHUNK) as u64)?;
    for (i, chunk) in bytes.chunks(CHUNK).enumerate() {
        staging.bytes_mut()[..chunk.len()].copy_from_slice(chunk);
        let uses = [staging.with(Access::COPY_READ), buffer.with(Access::COPY_WRITE)];
        commands.run(|rec| {
            rec.pass("upload", &uses).copy(&staging, buffer, at + (i * CHUNK) as u64, chunk.len() as u64);
            rec.settle(&[buffer.with(Access::SHADER_READ)]);
        })?;
    }
    Ok(())
}
