//! The passes of a frame, each one file beside its WGSL; renderer.rs has their order.

mod anisotropy;
mod composite;
mod curvature;
mod detail;
mod droplets;
mod gather;
mod layers;
mod neighbours;
mod normals;
mod paint;
mod resolve_depth;
mod shade;
mod smooth;
mod splat;
mod surface;
mod thickness;
mod tiles;
mod upsample;
mod visible;

pub(crate) use composite::Composite;
pub(crate) use curvature::Curvature;
pub(crate) use detail::Detail;
#[cfg(test)]
pub(crate) use detail::DetailUniform;
#[cfg(test)]
pub(crate) use droplets::DropletsUniform;
pub(crate) use droplets::{DropletImages, DropletsPass};
pub(crate) use gather::Gather;
#[cfg(test)]
pub(crate) use gather::GatherUniform;
pub(crate) use layers::{FluidPasses, Layers};
pub(crate) use normals::Normals;
#[cfg(test)]
pub(crate) use paint::PaintUniform;
pub(crate) use paint::{Layout as PaintLayout, LiquidsUniform, Paint};
pub(crate) use resolve_depth::ResolveDepth;
pub(crate) use shade::{OpticsUniform, SceneViews, Shade, With};
#[cfg(test)]
pub(crate) use smooth::LengthsUniform;
pub(crate) use smooth::{Segments, Smooth, records_bytes, relations_bytes};
pub(crate) use surface::Surface;
pub(crate) use thickness::{Thickness, level_count, pyramid_texels};
pub(crate) use tiles::Tiles;
pub(crate) use upsample::Upsample;

/// What `frame.wgsl` and the parts of a pass say, as one shader module.
macro_rules! module {
    ($label:literal, $($part:literal),+) => {
        crate::gpu::Module::new($label, vec![$(include_str!($part)),+])
    };
}
pub(crate) use module;

/// `ball.wgsl`'s override.
pub(crate) fn ellipsoids_constant(ellipsoids: bool) -> (&'static str, f64) {
    ("ELLIPSOIDS", f64::from(u8::from(ellipsoids)))
}
