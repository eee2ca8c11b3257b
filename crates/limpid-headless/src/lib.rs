//! limpid without a window: adapters, off-screen frames, buffers read back.
