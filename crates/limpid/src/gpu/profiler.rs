//! GPU time of each pass by timestamp queries.

use std::sync::{Arc, OnceLock};

const MAX_PASSES: u32 = 512;

/// Name of the pass that only starts the clock.
const CLOCK: &str = "";

/// GPU time of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// "splat-depth", "smooth/narrow-range-x", ... Passes of one name are added up.
    pub name: String,
    /// Milliseconds.
    pub ms: f64,
}

/// Measures the passes of one frame on devices with [`wgpu::Features::TIMESTAMP_QUERY`].
///
/// Hand it to [`crate::Renderer::set_profiler`], call [`Profiler::resolve`] at the end of the frame's encoder, submit, then
/// map and read with [`Profiler::read`].
pub struct Profiler {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
    names: Vec<String>,
    ns_per_tick: f64,
    /// Whether what was asked for is mapped, once that is known.
    arrival: Option<Arc<OnceLock<bool>>>,
}

impl Profiler {
    /// None where the device has no timestamps.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: u64::from(2 * MAX_PASSES) * 8,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("passes"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * MAX_PASSES,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readable: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            names: Vec::new(),
            ns_per_tick: f64::from(queue.get_timestamp_period()),
            arrival: None,
        })
    }

    fn next(&mut self, name: &str) -> Option<(u32, u32)> {
        let first = 2 * self.names.len() as u32;
        if first + 1 >= 2 * MAX_PASSES {
            return None;
        }
        self.names.push(name.to_owned());
        Some((first, first + 1))
    }

    /// Starts the clock with an empty pass: for passes that are measured from here, since some drivers take the time of the first
    /// one's begin only when it is over.
    pub fn start_clock(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let timestamp_writes = self.compute(CLOCK);
        encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("clock"), timestamp_writes });
    }

    /// Queries around a compute pass; None beyond the 512th pass of a frame.
    pub fn compute(&mut self, name: &str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let (begin, end) = self.next(name)?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(end),
        })
    }

    /// Queries around a render pass of the host's; None beyond the 512th pass of a frame.
    pub fn render(&mut self, name: &str) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let (begin, end) = self.next(name)?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(end),
        })
    }

    /// Ends the frame's measurement: call it after the last pass.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        let count = 2 * self.names.len() as u32;
        if count > 0 {
            encoder.resolve_query_set(&self.queries, 0..count, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, u64::from(count) * 8);
        }
    }

    /// Asks for the times, after the frame has been submitted.
    pub fn start(&mut self) {
        let bytes = self.bytes();
        if bytes > 0 {
            let arrival = Arc::new(OnceLock::new());
            let told = Arc::clone(&arrival);
            self.readable.map_async(wgpu::MapMode::Read, 0..bytes, move |result| {
                let _ = told.set(result.is_ok());
            });
            self.arrival = Some(arrival);
        }
    }

    /// Waits for the submitted frame and returns the time of each pass as [`Profiler::arrived`] does.
    pub fn read(&mut self, device: &wgpu::Device) -> Vec<PassTime> {
        self.start();
        // A failure shows as times of 0.
        let _ = device.poll(wgpu::PollType::wait_indefinitely());
        self.arrived().unwrap_or_default()
    }

    /// The time of each pass in the order they ran, once it is there, clears and copies before it
    /// included: from the end of the one before to its own end, so that they add up to the frame. (Some drivers take the
    /// timestamp at a pass's begin too late.) Starts over for the next frame.
    pub fn arrived(&mut self) -> Option<Vec<PassTime>> {
        let is_mapped = *self.arrival.as_ref()?.get()?;
        self.arrival = None;
        let bytes = self.bytes();
        let ticks: Vec<u64> = match self.readable.get_mapped_range(0..bytes) {
            Ok(bytes) if is_mapped => bytemuck::pod_collect_to_vec(&bytes),
            _ => vec![0; 2 * self.names.len()],
        };
        self.readable.unmap();
        let mut passes: Vec<PassTime> = Vec::new();
        let mut end_of_last = ticks[0];
        for (name, ticks) in self.names.drain(..).zip(ticks.chunks_exact(2)) {
            let ms = ticks[1].saturating_sub(end_of_last) as f64 * self.ns_per_tick * 1e-6;
            end_of_last = ticks[1];
            if name == CLOCK {
                continue;
            }
            match passes.iter_mut().find(|pass| pass.name == name) {
                Some(pass) => pass.ms += ms,
                None => passes.push(PassTime { name, ms }),
            }
        }
        Some(passes)
    }

    fn bytes(&self) -> u64 {
        2 * 8 * self.names.len() as u64
    }
}
