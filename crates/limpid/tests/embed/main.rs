//! The example's host off screen: a fluid in somebody else's frame. wgpu's own handler fails a test at the first validation
//! error.

#[path = "../../examples/embed/host.rs"]
mod host;

mod buffers;
mod devices;
mod frames;
mod memory;
mod studio;
