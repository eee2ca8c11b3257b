//! Thin helpers over wgpu: kernels, recording of timed passes, buffers that grow.

mod buffer;
mod kernel;
mod profiler;
mod recorder;

pub(crate) use buffer::{GrowBuffer, storage_buffer, uniform_buffer};
pub(crate) use kernel::{Kernel, Slot, bind, slot_entries};
pub use profiler::{PassTime, Profiler};
pub(crate) use recorder::{Grid, Recorder};
