//! Copies to the GPU's own memory.

use super::{Access, Buffer, Commands, Device};
use crate::error::Result;
use std::sync::Arc;

/// Most bytes staged at once.
const CHUNK: usize = 32 << 20;

/// A new storage buffer with `bytes` in it. An empty slice makes a buffer of 4 zero bytes, which can be bound.
pub fn upload(device: &Arc<Device>, name: &str, bytes: &[u8]) -> Result<Buffer> {
    let buffer = Buffer::storage(device, name, bytes.len().max(4) as u64)?;
    let mut commands = Commands::new(device, false)?;
    if bytes.is_empty() {
        commands.run(|rec| rec.pass("zero", &[buffer.with(Access::COPY_WRITE)], |enc| enc.zero(&buffer)))?;
        return Ok(buffer);
    }
    let mut staging = Buffer::staging(device, "staging", bytes.len().min(CHUNK) as u64)?;
    for (i, chunk) in bytes.chunks(CHUNK).enumerate() {
        staging.bytes_mut()[..chunk.len()].copy_from_slice(chunk);
        let uses = [staging.with(Access::COPY_READ), buffer.with(Access::COPY_WRITE)];
        commands.run(|rec| {
            rec.pass("upload", &uses, |enc| {
                enc.copy(&staging, &buffer, (i * CHUNK) as u64, chunk.len() as u64);
            });
        })?;
    }
    Ok(buffer)
}
