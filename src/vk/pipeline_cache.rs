//! Pipeline cache on disk.

use super::{Device, lock};
use crate::error::{Error, Result};
use ash::vk;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use xxhash_rust::xxh3::xxh3_128;

pub(super) struct PipelineCache {
    pub(super) raw: vk::PipelineCache,
    file: Option<PathBuf>,
    /// The data in the file.
    saved: Mutex<Vec<u8>>,
}

impl Device {
    /// Writes the pipelines that were created so far to the [pipeline cache](super::DeviceOptions::pipeline_cache) on disk, which otherwise
    /// happens only when the device is dropped. Without a folder, or if nothing has changed since, it writes nothing.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be written; [`Error::Vulkan`].
    pub fn save_pipelines(&self) -> Result<()> {
        // SAFETY: the cache is the device's.
        unsafe { self.pipeline_cache.save(&self.raw) }
    }
}

impl PipelineCache {
    /// Loads the cache of this device and driver from `folder`; an empty cache if there is none. An unreadable file is not an error:
    /// pipelines are then compiled again.
    pub(super) fn load(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        device: &ash::Device,
        folder: Option<&Path>,
    ) -> Result<Self> {
        // SAFETY: `physical` is one of the instance's devices.
        let properties = unsafe { instance.get_physical_device_properties(physical) };
        let uuid: String = properties.pipeline_cache_uuid.iter().map(|byte| format!("{byte:02x}")).collect();
        let name = format!("pipelines-{:08x}-{:08x}-{uuid}.bin", properties.vendor_id, properties.device_id);
        let file = folder.map(|folder| folder.join(name));
        let read = file.as_ref().and_then(|file| std::fs::read(file).ok()).unwrap_or_default();
        let loaded = unsealed(&read).filter(|data| is_for(data, &properties)).unwrap_or_default().to_vec();
        let info = vk::PipelineCacheCreateInfo::default().initial_data(&loaded);
        // SAFETY: the data's header names this device and driver.
        let raw = unsafe { device.create_pipeline_cache(&info, None) }
            .map_err(Error::vulkan("vkCreatePipelineCache"))?;
        Ok(Self { raw, file, saved: Mutex::new(loaded) })
    }

    /// Writes the cache to its file, if it has changed.
    ///
    /// # Safety
    /// `device` created the cache.
    unsafe fn save(&self, device: &ash::Device) -> Result<()> {
        let Some(file) = &self.file else { return Ok(()) };
        let mut saved = lock(&self.saved);
        // SAFETY: by the caller.
        let data = unsafe { device.get_pipeline_cache_data(self.raw) }
            .map_err(Error::vulkan("vkGetPipelineCacheData"))?;
        if data != *saved {
            write(file, &data).map_err(Error::io(file, "cannot write the pipeline cache"))?;
            *saved = data;
        }
        Ok(())
    }

    /// Writes the cache if it has changed, and destroys it.
    ///
    /// # Safety
    /// `device` created the cache, and no pipeline is being created with it.
    pub(super) unsafe fn save_and_destroy(&self, device: &ash::Device) {
        // SAFETY: by the caller.
        if let Err(error) = unsafe { self.save(device) } {
            log::debug!("{error}");
        }
        // SAFETY: by the caller.
        unsafe { device.destroy_pipeline_cache(self.raw, None) };
    }
}

/// First bytes of a file.
const MAGIC: &[u8; 8] = b"surfel\x00\x01";
/// Size of the file header, bytes: magic, length, digest.
const SEAL: usize = 8 + 8 + 16;

/// The file header. It detects truncated or altered data, on which a driver may crash.
fn seal(data: &[u8]) -> [u8; SEAL] {
    let mut seal = [0; SEAL];
    seal[..8].copy_from_slice(MAGIC);
    seal[8..16].copy_from_slice(&(data.len() as u64).to_le_bytes());
    seal[16..].copy_from_slice(&xxh3_128(data).to_le_bytes());
    seal
}

/// The data of an intact file.
fn unsealed(file: &[u8]) -> Option<&[u8]> {
    let (found, data) = file.split_at_checked(SEAL)?;
    (found == seal(data)).then_some(data)
}

/// Whether `data` has a version-one header of this device. Drivers must check it; not all do.
fn is_for(data: &[u8], properties: &vk::PhysicalDeviceProperties) -> bool {
    let word = |i: usize| data.get(4 * i..4 * i + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    word(1) == Some(vk::PipelineCacheHeaderVersion::ONE.as_raw() as u32)
        && word(2) == Some(properties.vendor_id)
        && word(3) == Some(properties.device_id)
        && data.get(16..32) == Some(&properties.pipeline_cache_uuid[..])
}

fn write(file: &Path, data: &[u8]) -> std::io::Result<()> {
    let folder = file.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    // Another process may read or write the file at the same time.
    let mut temporary = tempfile::NamedTempFile::new_in(folder)?;
    temporary.write_all(&seal(data))?;
    temporary.write_all(data)?;
    temporary.persist(file)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_whole_is_not_passed_on() {
        let data = b"a driver's own".repeat(9);
        let file = [&seal(&data)[..], &data].concat();
        assert_eq!(unsealed(&file), Some(&data[..]));
        for end in 0..file.len() {
            assert_eq!(unsealed(&file[..end]), None, "{end} bytes of it");
        }
        for byte in 0..file.len() {
            let mut altered = file.clone();
            altered[byte] ^= 1;
            assert_eq!(unsealed(&altered), None, "byte {byte} altered");
        }
        assert_eq!(unsealed(&[file, vec![0]].concat()), None);
        assert_eq!(unsealed(&data), None);
    }
}
