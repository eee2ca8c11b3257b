//! Finding an adapter and opening a device.

use crate::Error;

/// One way to run on this machine.
#[derive(Clone, Debug)]
pub struct AdapterInfo {
    /// The driver's name of the device.
    pub name: String,
    /// "discrete gpu", "integrated gpu", "virtual gpu", "cpu" or "other".
    pub kind: &'static str,
    /// "vulkan", "gl", ...
    pub backend: String,
    /// Driver name and version.
    pub driver: String,
}

/// An open device.
pub struct Gpu {
    /// What it runs on.
    pub info: AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// All adapters, the one that would be picked first: real GPUs before CPUs, Vulkan before GL.
pub fn adapters() -> Vec<AdapterInfo> {
    todo!()
}

impl Gpu {
    /// Opens the adapter that `wanted` names (an index into [`adapters`] or a part of a name, case aside), or the best.
    pub fn open(wanted: Option<&str>) -> Result<Self, Error> {
        let _ = wanted;
        todo!()
    }
}
