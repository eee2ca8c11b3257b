//! Finding an adapter and opening a device.

use crate::Error;
use pollster::block_on;

/// One way to run on this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
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

impl AdapterInfo {
    /// What wgpu says of an adapter.
    pub fn new(info: &wgpu::AdapterInfo) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete gpu",
            wgpu::DeviceType::IntegratedGpu => "integrated gpu",
            wgpu::DeviceType::VirtualGpu => "virtual gpu",
            wgpu::DeviceType::Cpu => "cpu",
            wgpu::DeviceType::Other => "other",
        };
        Self {
            name: info.name.clone(),
            kind,
            backend: info.backend.to_string(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        }
    }
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

/// All adapters that can run limpid, the one that would be picked first: real GPUs before CPUs.
pub fn adapters() -> Vec<AdapterInfo> {
    ranked().iter().map(|adapter| AdapterInfo::new(&adapter.get_info())).collect()
}

fn ranked() -> Vec<wgpu::Adapter> {
    // Not GL: its shading language cannot load texels of depth textures.
    let backends = wgpu::Backends::PRIMARY;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        flags: instance_flags(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let mut adapters = block_on(instance.enumerate_adapters(backends));
    rank(&mut adapters);
    adapters
}

/// wgpu's own flags of an instance, without the dispatch that it adds to every indirect one to look at its arguments: limpid's kernels write them. On
/// D3D12 kernels would no longer be told the number of groups.
pub fn instance_flags() -> wgpu::InstanceFlags {
    let flags = wgpu::InstanceFlags::from_env_or_default();
    if cfg!(windows) { flags } else { flags - wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL }
}

/// Keeps those that can run limpid, the best first.
fn rank(adapters: &mut Vec<wgpu::Adapter>) {
    adapters.retain(|adapter| wgpu::Limits::default().check_limits(&adapter.limits()));
    let rank = |info: &wgpu::AdapterInfo| match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    };
    adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
}

impl Gpu {
    /// Opens the adapter that `wanted` names (an index into [`adapters`] or a part of a name, case aside), or the best.
    ///
    /// # Errors
    /// No adapter, none of that name, or a device that the driver refuses.
    pub fn open(wanted: Option<&str>) -> Result<Self, Error> {
        let adapters = ranked();
        let adapter = &choose(adapters, wanted)?;
        let (device, queue) = block_on(adapter.request_device(&device_descriptor(adapter)))
            .map_err(|error| Error::Device(error.to_string()))?;
        Ok(Self { info: AdapterInfo::new(&adapter.get_info()), device, queue })
    }
}

/// What limpid asks of an adapter: the default limits, larger buffers and images, exact blending and a cache of pipelines where they
/// exist.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("limpid"),
        required_limits: wgpu::Limits {
            max_buffer_size: adapter.limits().max_buffer_size,
            max_storage_buffer_binding_size: adapter.limits().max_storage_buffer_binding_size,
            max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
            ..wgpu::Limits::default()
        },
        required_features: adapter.features()
            & (wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::PIPELINE_CACHE),
        ..Default::default()
    }
}

/// The adapter that `wanted` names, or the best, among those that a window can use.
///
/// # Errors
/// None can run limpid, or none has that name.
pub fn choose(mut adapters: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter, Error> {
    rank(&mut adapters);
    if adapters.is_empty() {
        return Err(Error::NoAdapter);
    }
    let names: Vec<_> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let unknown =
        || Error::UnknownAdapter { wanted: wanted.unwrap_or_default().to_owned(), available: names.join(", ") };
    pick(&adapters, wanted).cloned().ok_or_else(unknown)
}

fn pick<'a>(adapters: &'a [wgpu::Adapter], wanted: Option<&str>) -> Option<&'a wgpu::Adapter> {
    let Some(wanted) = wanted else { return adapters.first() };
    if let Ok(index) = wanted.parse::<usize>() {
        return adapters.get(index);
    }
    let named = |adapter: &&wgpu::Adapter| adapter.get_info().name.to_lowercase().contains(&wanted.to_lowercase());
    adapters.iter().find(named)
}
