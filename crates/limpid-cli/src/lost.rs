//! A device that is lost in the middle of the work: whatever waits for it in wgpu would panic, so the program ends where that is noticed.

use crate::failure::Failure;
use limpid_headless::Gpu;

/// Opens an adapter whose loss ends the program. What it has written by then is whole.
pub fn open(adapter: Option<&str>) -> Result<Gpu, Failure> {
    let gpu = Gpu::open(adapter)?;
    gpu.device.set_device_lost_callback(|_, reason| {
        let reason = reason.trim().trim_end_matches('.');
        end(&format!("the graphics device was lost ({reason}); what is written is whole, render the rest by --start"))
    });
    Ok(gpu)
}

/// Says why, and ends the program.
pub fn end(reason: &str) -> ! {
    let failure = Failure::Lost(reason.to_owned());
    failure.report();
    std::process::exit(failure.exit_code().into())
}
