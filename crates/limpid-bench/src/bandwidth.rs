//! What the adapter's memory can do: the yardstick for passes that mostly move bytes.

use limpid_headless::{Error, Gpu};
use std::time::Instant;

/// Seconds that a measurement lasts at least.
const LONG_ENOUGH: f64 = 0.1;

/// Bytes per second that copies between two buffers read and write together, by the wall clock.
///
/// # Errors
/// The device fails.
pub fn copy_bandwidth(gpu: &Gpu) -> Result<f64, Error> {
    let bytes = gpu.device.limits().max_buffer_size.min(256 << 20);
    let buffer = || {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("bandwidth"),
            size: bytes,
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    };
    let (from, to) = (buffer(), buffer());
    let seconds = |copies: u32| {
        let begin = Instant::now();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for _ in 0..copies {
            encoder.copy_buffer_to_buffer(&from, 0, &to, 0, bytes);
        }
        gpu.queue.submit([encoder.finish()]);
        let waited = gpu.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| Error::Device(error.to_string()))?;
        Ok::<f64, Error>(begin.elapsed().as_secs_f64())
    };
    // The first copy also makes the pages.
    seconds(1)?;
    let mut copies = 1;
    loop {
        let taken = seconds(copies)?;
        if taken >= LONG_ENOUGH || copies >= 1 << 12 {
            return Ok(2.0 * bytes as f64 * f64::from(copies) / taken.max(1e-9));
        }
        copies *= 2;
    }
}
