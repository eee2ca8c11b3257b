//! Frames whose particles come in parts: more than the device holds at once, or from several machines.

use super::{Begun, Frame, Renderer};
use crate::partial::{Conditions, IMAGES};
use crate::{Error, Partial, Particles, Settings, View};

/// A frame that is open for particles.
pub(super) struct Parts {
    begun: Begun,
    view: View,
    size: [u32; 2],
    settings: Settings,
    origin: glam::DVec3,
    has_density: bool,
    is_empty: bool,
}

/// The images of a frame that is open for particles, for reading back: [`Partial::new`] takes the words in this order.
#[non_exhaustive]
#[derive(Clone)]
pub struct PartialBuffers<'a> {
    /// Each with how many u32 of it count.
    pub buffers: [(&'a wgpu::Buffer, usize); IMAGES],
    pub(crate) conditions: &'a Conditions,
}

impl Renderer {
    /// Records the beginning of a frame whose particles come in parts, by [`Self::add_part`] or [`Self::load_partial`], in this
    /// encoder and others after it; [`Self::finish_parts`] ends it. The bits are those of a frame with all of them at once. Of
    /// `frame.particles` only the origin, the reference radius and whether there are densities count; they may be the first part.
    ///
    /// # Errors
    /// As [`Self::prepare`]; [`Error::Parts`] where the settings want all particles at once: anisotropy, layers, noise, foam
    /// and paint.
    pub fn begin_parts(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<(), Error> {
        let Frame { particles, view, size, settings, .. } = *frame;
        let wants_all = [
            ("anisotropy", settings.anisotropy.enabled),
            ("layers", settings.layers),
            ("noise and foam", settings.detail.is_on()),
            ("colours and liquids of particles", settings.uses_paint()),
        ];
        if let Some((what, _)) = wants_all.into_iter().find(|(_, is_on)| *is_on) {
            return Err(Error::Parts(format!("{what} need all particles at once; turn them off")));
        }
        let begun = self.clear(device, queue, encoder, frame)?;
        self.parts = Some(Parts {
            begun,
            view: *view,
            size,
            settings: *settings,
            origin: particles.origin,
            has_density: particles.has_density(),
            is_empty: true,
        });
        Ok(())
    }

    /// Adds particles to the frame that [`Self::begin_parts`] began. They may be dropped, or their buffers filled anew, once
    /// the encoder is submitted.
    ///
    /// # Errors
    /// [`Error::Parts`]: no frame was begun, or the particles' origin or densities are not as there.
    pub fn add_part(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        particles: &Particles,
    ) -> Result<(), Error> {
        let mut parts = self.parts.take().ok_or_else(not_begun)?;
        let fits = parts.origin == particles.origin && parts.has_density == particles.has_density();
        if fits {
            self.splat(device, encoder, &parts.settings, particles, &parts.begun);
            parts.is_empty = false;
        }
        self.parts = Some(parts);
        match fits {
            true => Ok(()),
            false => Err(Error::Parts("parts differ in origin, or in whether they have densities".into())),
        }
    }

    /// Puts what was saved of other particles into the frame that [`Self::begin_parts`] began. Several are
    /// [merged](Partial::merge) first.
    ///
    /// # Errors
    /// [`Error::Parts`]: no frame was begun, it has particles already, or what was saved is of another frame.
    pub fn load_partial(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        partial: &Partial,
    ) -> Result<(), Error> {
        let parts = self.parts.as_mut().ok_or_else(not_begun)?;
        if !parts.is_empty {
            return Err(Error::Parts("load what was saved before other particles are added".into()));
        }
        parts.begun.conditions.check(partial)?;
        let images = parts.begun.targets.splatted();
        for ((image, _), words) in images.into_iter().zip(partial.images()).filter(|(_, words)| !words.is_empty()) {
            let staged = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("saved image"),
                size: 4 * words.len() as u64,
                usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            queue.write_buffer(&staged, 0, bytemuck::cast_slice(words));
            encoder.copy_buffer_to_buffer(&staged, 0, image, 0, staged.size());
        }
        parts.is_empty = false;
        Ok(())
    }

    /// The images as they will be once what is recorded has run, for saving them as a [`Partial`]; None where no frame is
    /// open for particles.
    pub fn partial_buffers(&self) -> Option<PartialBuffers<'_>> {
        let begun = &self.parts.as_ref()?.begun;
        Some(PartialBuffers { buffers: begun.targets.splatted(), conditions: &begun.conditions })
    }

    /// Records the rest of the frame, given once more: what [`Self::prepare`] does after its particles are drawn.
    ///
    /// # Errors
    /// [`Error::Parts`]: no frame was begun, or another view, size, origin or other settings than these.
    pub fn finish_parts(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<(), Error> {
        let parts = self.parts.take().ok_or_else(not_begun)?;
        let is_same = parts.view == *frame.view
            && parts.size == frame.size
            && parts.settings == *frame.settings
            && parts.origin == frame.particles.origin
            && parts.begun.scene_depth.is_some() == frame.scene.depth.is_some();
        if !is_same {
            self.parts = Some(parts);
            return Err(Error::Parts("the frame is not the one that was begun".into()));
        }
        self.resolve(device, queue, encoder, frame, parts.begun);
        Ok(())
    }

    /// Keeps the images of a frame that nobody finished.
    pub(super) fn abandon_parts(&mut self) {
        if let Some(parts) = self.parts.take() {
            self.targets = Some(parts.begun.targets);
        }
    }
}

fn not_begun() -> Error {
    Error::Parts("no frame was begun".into())
}
