//! Copies from the device.

use crate::Error;
use std::sync::mpsc::Receiver;

/// Waits until everything submitted is done.
pub(crate) fn wait(device: &wgpu::Device) -> Result<(), Error> {
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| Error::Device(error.to_string()))?;
    Ok(())
}

fn staging(device: &wgpu::Device, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

fn read_bytes(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    bytes: u64,
    copy: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::Buffer),
) -> Result<Vec<u8>, Error> {
    let staging = staging(device, bytes);
    let mut encoder = device.create_command_encoder(&Default::default());
    copy(&mut encoder, &staging);
    queue.submit([encoder.finish()]);
    let (sender, receiver) = std::sync::mpsc::channel();
    staging.map_async(wgpu::MapMode::Read, .., move |result| {
        // Nobody listens only when the wait below failed, and then says so itself.
        let _ = sender.send(result);
    });
    wait(device)?;
    let failed = |error: &dyn std::fmt::Display| Error::Device(error.to_string());
    receiver.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
    let mapped = staging.get_mapped_range(..).map_err(|error| failed(&error))?;
    Ok(mapped.to_vec())
}

/// The first `count` 4-byte words of a buffer.
pub(crate) fn read_words<T: bytemuck::Pod>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    buffer: &wgpu::Buffer,
    count: usize,
) -> Result<Vec<T>, Error> {
    let bytes = 4 * count as u64;
    let read = read_bytes(device, queue, bytes, |encoder, to| encoder.copy_buffer_to_buffer(buffer, 0, to, 0, bytes))?;
    Ok(bytemuck::pod_collect_to_vec(&read))
}

/// All texels of a texture of an uncompressed colour format, row by row.
pub(crate) fn read_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, Error> {
    let row = texture.format().block_copy_size(None).unwrap_or(4) * texture.width();
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let bytes = u64::from(padded) * u64::from(texture.height());
    let read = read_bytes(device, queue, bytes, |encoder, to| {
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: to, layout },
            texture.size(),
        );
    })?;
    Ok(read.chunks_exact(padded as usize).flat_map(|line| &line[..row as usize]).copied().collect())
}

/// A copy from the device that nobody waits for: what a window or a web page does between its frames.
pub struct Download {
    staging: wgpu::Buffer,
    padded_row: usize,
    row: usize,
    arrival: Option<Receiver<Result<(), wgpu::BufferAsyncError>>>,
}

impl Download {
    /// Records the copy of a texture of an uncompressed colour format.
    pub fn of_texture(device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) -> Self {
        let row = texture.format().block_copy_size(None).unwrap_or(4) * texture.width();
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = staging(device, u64::from(padded) * u64::from(texture.height()));
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &staging, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        Self { staging, padded_row: padded as usize, row: row as usize, arrival: None }
    }

    /// Records the copy of the first `words` 4-byte words of a buffer.
    pub fn of_words(
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &wgpu::Buffer,
        words: usize,
    ) -> Self {
        let bytes = 4 * words as u64;
        let staging = staging(device, bytes);
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, bytes);
        Self { staging, padded_row: 4 * words, row: 4 * words, arrival: None }
    }

    /// Asks for the bytes, after the copy has been submitted.
    pub fn start(&mut self) {
        let (sender, receiver) = std::sync::mpsc::channel();
        // Nobody listens any more: then nobody wants them.
        self.staging.map_async(wgpu::MapMode::Read, .., move |result| {
            let _ = sender.send(result);
        });
        self.arrival = Some(receiver);
    }

    /// The bytes, once they are there.
    ///
    /// # Errors
    /// The device failed.
    pub fn bytes(&self, device: &wgpu::Device) -> Option<Result<Vec<u8>, Error>> {
        let failed = |error: &dyn std::fmt::Display| Error::Device(error.to_string());
        if let Err(error) = device.poll(wgpu::PollType::Poll) {
            return Some(Err(failed(&error)));
        }
        let arrived = self.arrival.as_ref()?.try_recv().ok()?;
        let bytes = arrived.map_err(|error| failed(&error)).and_then(|()| {
            let mapped = self.staging.get_mapped_range(..).map_err(|error| failed(&error))?;
            Ok(mapped.chunks_exact(self.padded_row).flat_map(|line| &line[..self.row]).copied().collect())
        });
        Some(bytes)
    }
}
