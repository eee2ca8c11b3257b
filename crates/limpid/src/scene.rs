//! What the host has drawn before the fluid.

use crate::Error;

/// What is already in the host's picture. Textures have the frame's size and can be bound
/// ([`wgpu::TextureUsages::TEXTURE_BINDING`]).
#[derive(Clone, Copy, Debug, Default)]
pub struct Scene<'a> {
    /// Linear premultiplied colour of one sample a pixel, any float format, seen through the fluid: alpha 1 where the
    /// scene is opaque. Where there is nothing, or None, the fluid's alpha is 1 - mean transmittance.
    pub color: Option<&'a wgpu::TextureView>,
    /// Depth by the view's projection: a view of the depth aspect alone, of one sample a pixel or several. Hides fluid behind
    /// it, and ends its thickness; of several samples the farthest counts. None: nothing is in the way.
    pub depth: Option<&'a wgpu::TextureView>,
}

impl Scene<'_> {
    pub(crate) fn check(&self, size: [u32; 2]) -> Result<(), Error> {
        for (what, view) in [("color", self.color), ("depth", self.depth)] {
            let Some(texture) = view.map(wgpu::TextureView::texture) else { continue };
            let own = [texture.width(), texture.height()];
            // A view of a smaller level cannot be told from one of the first.
            if texture.mip_level_count() == 1 && own != size {
                return Err(Error::Scene(format!(
                    "its {what} has {} x {} pixels, the frame {} x {}; make them equal",
                    own[0], own[1], size[0], size[1]
                )));
            }
            if !texture.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING) {
                return Err(Error::Scene(format!("its {what} lacks the usage TEXTURE_BINDING")));
            }
        }
        if self.color.is_some_and(|view| view.texture().sample_count() > 1) {
            return Err(Error::Scene("its color has several samples a pixel; resolve it first".into()));
        }
        if self.depth.is_some_and(|view| !view.texture().format().has_depth_aspect()) {
            return Err(Error::Scene("its depth is of a format without depth".into()));
        }
        Ok(())
    }
}
