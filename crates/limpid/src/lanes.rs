//! How much work at once a device wants.

/// How many lanes, each with a pixel or more of its own, keep a device busy. Passes that can cut up their work in two ways go by it.
/// Pictures are the same but for rounding.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Lanes {
    /// Some hundreds: CPUs, which would rather do more in a row.
    Few,
    /// Ten thousands: GPUs.
    Many,
}

impl Lanes {
    /// By the type of the device's adapter.
    pub fn of(device: &wgpu::Device) -> Self {
        match device.adapter_info().device_type {
            wgpu::DeviceType::Cpu => Self::Few,
            _ => Self::Many,
        }
    }
}
