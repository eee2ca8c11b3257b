//! What wgpu would otherwise end the program for.

use crate::Error;
use pollster::block_on;

/// Does some work on a device; a lack of memory, a lost device and refused commands are its errors, before those of `work`.
///
/// # Errors
/// Those of `work` and of the device.
pub fn guarded<T>(device: &wgpu::Device, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    // The innermost first; what memory lacked for is refused afterwards.
    let [validation, internal, memory] = [validation, internal, memory].map(|scope| block_on(scope.pop()));
    match memory.or(internal).or(validation) {
        Some(error) => Err(Error::Device(one_line(&error.to_string()))),
        None => result,
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
