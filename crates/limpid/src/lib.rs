//! Screen-space rendering of particle fluids on wgpu.
