//! Thin helpers over wgpu: kernels, recording of timed passes, buffers that grow.

mod buffer;
mod kernel;
mod module;
mod pipelines;
mod profiler;
mod raster;
mod recorder;

pub(crate) use buffer::{GrowBuffer, storage_buffer, uniform_buffer};
pub(crate) use kernel::{Kernel, Slot, bind, slot_entries};
pub(crate) use module::Module;
pub use pipelines::Pipelines;
pub use profiler::{PassTime, Profiler};
pub(crate) use raster::{Raster, RasterSource};
pub(crate) use recorder::{Grid, Recorder, Watch};
