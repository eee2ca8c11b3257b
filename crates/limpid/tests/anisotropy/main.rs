//! Anisotropic particles against plain f64 twins, closed forms and laws.

mod fluid;
mod laws;
mod rays;
mod scenes;
mod shapes;
mod surface;
mod twin;
