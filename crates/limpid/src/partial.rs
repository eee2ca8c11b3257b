//! What some of a frame's particles leave behind before anything is smoothed: depth is a maximum of nearness, thickness a sum, so
//! that those of several machines make the frame of all particles, to the bit.

use crate::renderer::SettingsUniform;
use crate::targets::Targets;
use crate::view::ViewUniform;
use crate::{Error, PartialBuffers};

/// Images of a partial frame.
pub(crate) const IMAGES: usize = 5;

/// How each of them, in the order of `Targets::splatted`, is put together.
const MERGES: [fn(u32, u32) -> u32; IMAGES] = [
    // Nearness of pixels and of what covers blocks, as bits of positive floats.
    u32::max,
    u32::max,
    // thickness.wgsl's sums: beyond half of what a word holds all are alike.
    u32::saturating_add,
    // Which levels hold something.
    |a, b| a | b,
    // Sums between two depths of the scene, and its HIDDEN.
    |a, b| ((a & AMID) + (b & AMID)).min(AMID) | ((a | b) & !AMID),
];
const AMID: u32 = 0x7fff_ffff;

const MAGIC: [u8; 8] = *b"LIMPIDP2";

/// What particles of equal images have in common: first the lengths of the images, then the view and what splats depend on,
/// as words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Conditions(Vec<u32>);

impl Conditions {
    pub fn new(view: &ViewUniform, settings: &SettingsUniform, targets: &Targets) -> Self {
        let view = bytemuck::cast_slice::<_, u32>(bytemuck::bytes_of(view)).iter().copied();
        let lengths = targets.splatted().map(|(_, words)| words as u32);
        let floats = [
            settings.splat_scale,
            settings.density_threshold,
            settings.thickness_unit,
            settings.thickness_divisor,
            settings.fluid_scale,
            settings.fixed_thickness,
        ];
        let sizes = [settings.thickness_size, settings.picture_size].into_iter().flatten();
        let words = lengths.into_iter().chain(view).chain(floats.map(f32::to_bits)).chain(sizes);
        Self(words.chain([settings.has_scene_depth]).collect())
    }

    pub fn check(&self, partial: &Partial) -> Result<(), Error> {
        match partial.conditions == *self {
            true => Ok(()),
            false => Err(other_frame()),
        }
    }
}

fn other_frame() -> Error {
    Error::Parts(
        "they are of frames of another view, size, radius or scale; save them all with the same options".into(),
    )
}

/// Raw depth and thickness of some of a frame's particles, to be saved and merged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Partial {
    conditions: Conditions,
    images: [Vec<u32>; IMAGES],
}

impl Partial {
    /// Of images that were read back from [`crate::Renderer::partial_buffers`], in their order.
    ///
    /// # Errors
    /// [`Error::Parts`]: other lengths than theirs.
    pub fn new(buffers: &PartialBuffers<'_>, images: [Vec<u32>; IMAGES]) -> Result<Self, Error> {
        let fit = buffers.buffers.iter().zip(&images).all(|((_, words), image)| image.len() == *words);
        match fit {
            true => Ok(Self { conditions: buffers.conditions.clone(), images }),
            false => Err(Error::Parts("images of other lengths than were to be read".into())),
        }
    }

    pub(crate) fn images(&self) -> &[Vec<u32>; IMAGES] {
        &self.images
    }

    /// Adds the particles of another. Their order does not matter.
    ///
    /// # Errors
    /// [`Error::Parts`]: it is of another frame.
    pub fn merge(&mut self, other: &Self) -> Result<(), Error> {
        self.conditions.check(other)?;
        for ((own, others), merge) in self.images.iter_mut().zip(&other.images).zip(MERGES) {
            own.iter_mut().zip(others).for_each(|(own, other)| *own = merge(*own, *other));
        }
        Ok(())
    }

    /// For a file: little-endian words after eight letters, each list after its length.
    pub fn to_bytes(&self) -> Vec<u8> {
        let lists = std::iter::once(&self.conditions.0).chain(&self.images);
        let words = lists.flat_map(|list| std::iter::once(list.len() as u32).chain(list.iter().copied()));
        MAGIC.into_iter().chain(words.flat_map(u32::to_le_bytes)).collect()
    }

    /// From a file.
    ///
    /// # Errors
    /// [`Error::Parts`]: it is none of [`Self::to_bytes`], or not whole.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let broken = || Error::Parts("the file is cut off or broken; save it anew".into());
        let rest = bytes
            .strip_prefix(&MAGIC)
            .ok_or_else(|| Error::Parts("the file holds no partial frame of this version of limpid".into()))?;
        let (words, odd) = rest.as_chunks::<4>();
        let mut words = words.iter().map(|word| u32::from_le_bytes(*word));
        let mut list = || {
            let length = words.next()? as usize;
            let list: Vec<u32> = words.by_ref().take(length).collect();
            (list.len() == length).then_some(list)
        };
        let conditions = Conditions(list().ok_or_else(broken)?);
        let mut images: [Vec<u32>; IMAGES] = Default::default();
        for image in &mut images {
            *image = list().ok_or_else(broken)?;
        }
        let fit = conditions.0.iter().zip(&images).filter(|(length, image)| **length as usize == image.len()).count();
        match words.next() {
            None if odd.is_empty() && fit == IMAGES => Ok(Self { conditions, images }),
            _ => Err(broken()),
        }
    }
}
