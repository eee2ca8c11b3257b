//! Buffers of the last picture for the eye, without waiting for the device.

use crate::{Aov, Download, Error, Image, Painter, Shot, motion};

/// Buffers on their way from the device.
pub struct Peek {
    aov: Aov,
    nearness: Download,
    /// None: the picture follows from the depth alone.
    values: Option<Download>,
    /// Thickness and normals, where they are needed too.
    surface: Option<Download>,
    /// Size in texels of what was copied.
    texels: [u32; 2],
}

impl Painter {
    /// Records the copy of a buffer of the shot drawn last, which must have had [`Aov::settings`]. None: there is nothing to
    /// copy, or the buffer cannot be had so ([`Aov::can_be_peeked`]).
    pub fn peek(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        shot: &Shot<'_>,
        aov: Aov,
    ) -> Option<Peek> {
        let buffers = self.renderer().buffers()?;
        let count = |size: [u32; 2]| size[0] as usize * size[1] as usize;
        let mut texels = shot.size;
        let mut surface = None;
        let values = match aov {
            _ if !aov.can_be_peeked() => return None,
            Aov::Motion => None,
            Aov::Picture => Some(Download::of_texture(device, encoder, self.linear()?)),
            Aov::Noise | Aov::Foam => {
                let detail = self.renderer().detail()?;
                texels = detail.size;
                Some(Download::of_words(device, encoder, detail.values, 2 * count(texels)))
            }
            Aov::Spray | Aov::Bubbles => {
                let droplets = self.renderer().droplets()?;
                texels = droplets.size;
                Some(Download::of_words(device, encoder, droplets.sums, 2 * count(texels)))
            }
            Aov::BackDepth | Aov::BeyondDepth | Aov::FirstThickness => {
                let layers = self.renderer().layers()?;
                texels = layers.size;
                surface = Some(Download::of_words(device, encoder, buffers.surface, 4 * count(shot.size)));
                Some(Download::of_words(device, encoder, layers.values, 12 * count(texels)))
            }
            _ => {
                let curvature =
                    (aov == Aov::Curvature).then(|| self.renderer().mean_curvature(device, encoder)).flatten();
                let (buffer, per_pixel) = aov.source(&buffers, curvature.as_ref());
                Some(Download::of_words(device, encoder, buffer, per_pixel * count(texels)))
            }
        };
        let nearness = Download::of_words(device, encoder, buffers.nearness, count(shot.size));
        Some(Peek { aov, nearness, values, surface, texels })
    }
}

impl Aov {
    /// Whether [`Painter::peek`] has it: not the one that takes more than one picture.
    pub fn can_be_peeked(self) -> bool {
        self != Self::Passage
    }
}

impl Peek {
    /// Asks for the bytes, after the copies have been submitted.
    pub fn start(&mut self) {
        self.values.iter_mut().chain(&mut self.surface).for_each(Download::start);
        self.nearness.start();
    }

    /// The image, once it is there; `shot` is the one that was drawn.
    ///
    /// # Errors
    /// The device failed.
    pub fn image(&self, device: &wgpu::Device, shot: &Shot<'_>) -> Option<Result<Image, Error>> {
        // Asked for last, so it arrives last.
        let nearness = self.nearness.bytes(device)?;
        let bytes = |download: &Option<Download>| download.as_ref().and_then(|download| download.bytes(device));
        let (values, surface) = (bytes(&self.values), bytes(&self.surface));
        Some(nearness.and_then(|nearness| {
            let nearness: Vec<f32> = bytemuck::pod_collect_to_vec(&nearness);
            let bytes = values.transpose()?.unwrap_or_default();
            let surface: Vec<f32> = bytemuck::pod_collect_to_vec(&surface.transpose()?.unwrap_or_default());
            let words = self.words(shot, &nearness, &bytes, &surface);
            Ok(self.aov.image(shot.size, &words, &nearness, &shot.view))
        }))
    }

    fn words(&self, shot: &Shot<'_>, nearness: &[f32], bytes: &[u8], surface: &[f32]) -> Vec<f32> {
        match self.aov {
            Aov::Motion => {
                let depth: Vec<f32> = nearness.iter().map(|nearness| shot.view.depth_of(*nearness)).collect();
                motion::motion(shot, &depth)
            }
            Aov::Picture if bytes.len() == 8 * nearness.len() => {
                bytes.as_chunks().0.iter().map(|half| half::f16::from_le_bytes(*half).to_f32()).collect()
            }
            Aov::Noise | Aov::Foam => {
                let values: Vec<f32> = bytemuck::pod_collect_to_vec(bytes);
                let which = usize::from(self.aov == Aov::Foam);
                let scale = shot.size[0].div_ceil(self.texels[0]);
                let texel = |x: u32, y: u32| 2 * (y / scale * self.texels[0] + x / scale) as usize + which;
                (0..shot.size[1])
                    .flat_map(|y| (0..shot.size[0]).map(move |x| (x, y)))
                    .map(|(x, y)| values[texel(x, y)])
                    .collect()
            }
            Aov::BackDepth | Aov::BeyondDepth | Aov::FirstThickness => {
                self.aov.of_layers(shot, (&bytemuck::pod_collect_to_vec(bytes), self.texels), surface)
            }
            Aov::Spray | Aov::Bubbles => {
                self.aov.of_droplets(&bytemuck::pod_collect_to_vec(bytes), self.texels, shot.size)
            }
            _ => bytemuck::pod_collect_to_vec(bytes),
        }
    }
}
