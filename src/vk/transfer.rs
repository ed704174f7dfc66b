//! Copies to the GPU's own memory.

use super::{Access, Buffer, Commands, Device, Recorder};
use crate::error::Result;
use std::cell::RefCell;
use std::sync::Arc;

/// Most bytes staged at once, where a copy is waited for.
const CHUNK: usize = 32 << 20;

/// Makes buffers with contents.
pub struct Uploads<'a> {
    device: &'a Arc<Device>,
    way: RefCell<Way<'a>>,
}

enum Way<'a> {
    /// Submitted and waited for, chunk by chunk.
    Now(Commands),
    /// Recorded.
    Later(Recorder<'a>, Staging),
}

/// What recorded copies are made from. It must stay until the GPU is done with them.
#[derive(Default)]
#[must_use = "the copies are made from it once they are submitted: keep it until then"]
pub struct Staging(Vec<Buffer>);

impl Staging {
    /// Memory that it holds, bytes.
    pub fn bytes(&self) -> u64 {
        self.0.iter().map(Buffer::size).sum()
    }
}

impl<'a> Uploads<'a> {
    /// Copies that are made at once. Refused on a device that a host lends.
    pub fn now(device: &'a Arc<Device>) -> Result<Self> {
        Ok(Self { device, way: RefCell::new(Way::Now(Commands::new(device, false)?)) })
    }

    /// Copies that `rec` records.
    pub fn later(device: &'a Arc<Device>, rec: Recorder<'a>) -> Self {
        Self { device, way: RefCell::new(Way::Later(rec, Staging::default())) }
    }

    /// A new storage buffer with `bytes` in it, for shaders to read. An empty slice makes a buffer of 4 zero bytes, which can be bound.
    pub fn buffer(&self, name: &str, bytes: &[u8]) -> Result<Buffer> {
        let bytes = if bytes.is_empty() { &[0; 4][..] } else { bytes };
        let buffer = Buffer::storage(self.device, name, bytes.len() as u64)?;
        match &mut *self.way.borrow_mut() {
            Way::Now(commands) => copy_now(self.device, commands, &buffer, bytes)?,
            Way::Later(rec, staging) => {
                let staged = self.staged(bytes)?;
                copy(rec, &staged, &buffer, 0, bytes.len());
                rec.wait(&[buffer.with(Access::SHADER_READ)]);
                staging.0.push(staged);
            }
        }
        Ok(buffer)
    }

    fn staged(&self, bytes: &[u8]) -> Result<Buffer> {
        let mut staging = Buffer::staging(self.device, "staging", bytes.len() as u64)?;
        staging.bytes_mut().copy_from_slice(bytes);
        Ok(staging)
    }

    /// What recorded copies are made from.
    pub fn finish(self) -> Staging {
        match self.way.into_inner() {
            Way::Now(_) => Staging::default(),
            Way::Later(_, staging) => staging,
        }
    }
}

fn copy_now(device: &Arc<Device>, commands: &mut Commands, buffer: &Buffer, bytes: &[u8]) -> Result<()> {
    let mut staging = Buffer::staging(device, "staging", bytes.len().min(CHUNK) as u64)?;
    for (i, chunk) in bytes.chunks(CHUNK).enumerate() {
        staging.bytes_mut()[..chunk.len()].copy_from_slice(chunk);
        commands.run(|rec| copy(rec, &staging, buffer, (i * CHUNK) as u64, chunk.len()))?;
    }
    Ok(())
}

fn copy(rec: &mut Recorder<'_>, staging: &Buffer, buffer: &Buffer, offset: u64, size: usize) {
    let uses = [staging.with(Access::COPY_READ), buffer.with(Access::COPY_WRITE)];
    rec.pass("upload", &uses, |enc| enc.copy(staging, buffer, offset, size as u64));
}
