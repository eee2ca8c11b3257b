//! Keeping a Vulkan layer from talking on standard error, where scripts expect our one line and nothing else.

use std::env;

/// Mesa's device-select layer looks for a Wayland desktop even where there is none (containers, clusters, ssh), and
/// libwayland prints an error each time. The layer only sorts adapters by the desktop's preference: without a desktop
/// it is not missed, unless the user steers it.
pub fn prepare() {
    let unset = |name: &str| env::var_os(name).is_none();
    if unset("XDG_RUNTIME_DIR") && unset("MESA_VK_DEVICE_SELECT") && unset("DRI_PRIME") && unset("NODEVICE_SELECT") {
        // SAFETY: the program has only this thread yet, so nothing reads the environment meanwhile.
        #[allow(unsafe_code)]
        unsafe {
            env::set_var("NODEVICE_SELECT", "1");
        }
    }
}
