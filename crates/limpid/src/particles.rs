//! Particles on the GPU.

use crate::droplets::PackedDroplet;
use crate::paint::PaintAverage;
use crate::{Droplets, Error, Motion, Paint};
use glam::DVec3;

/// Particle arrays of the host's, not copied. World position = origin + position.
#[derive(Clone, Copy, Debug)]
pub struct ParticleSlices<'a> {
    /// Where the positions' local space starts, world units. Keep it near the particles: f32 keeps the digits then.
    pub origin: DVec3,
    /// Local positions, world units, finite.
    pub positions: &'a [[f32; 3]],
    /// Particle radii.
    pub radius: Radius<'a>,
    /// Density of each particle (any unit), for [`crate::Settings::density_threshold`].
    pub density: Option<&'a [f32]>,
}

/// Particle radii in world units: half the spacing of particles at rest. Above 0.
#[derive(Clone, Copy, Debug)]
pub enum Radius<'a> {
    /// The same for all.
    Uniform(f32),
    /// One for each particle.
    Each(&'a [f32]),
}

impl ParticleSlices<'_> {
    /// The r in which settings are measured: the radius, or the median where each particle has its own.
    pub fn reference_radius(&self) -> f32 {
        match self.radius {
            Radius::Uniform(radius) => radius,
            Radius::Each([]) => 1.0,
            Radius::Each(radii) => {
                let mut radii = radii.to_vec();
                let middle = radii.len() / 2;
                *radii.select_nth_unstable_by(middle, f32::total_cmp).1
            }
        }
    }

    fn largest_radius(&self) -> f32 {
        match self.radius {
            Radius::Uniform(radius) => radius,
            Radius::Each(radii) => radii.iter().copied().fold(0.0, f32::max),
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        let count = self.positions.len();
        let bad = |text: String| Err(Error::Particles(text));
        if let Radius::Each(radii) = self.radius
            && radii.len() != count
        {
            return bad(format!("{} radii for {count} positions", radii.len()));
        }
        if let Some(density) = self.density
            && density.len() != count
        {
            return bad(format!("{} densities for {count} positions", density.len()));
        }
        if let Some(index) = self.positions.iter().position(|p| !p.iter().all(|v| v.is_finite())) {
            return bad(format!("the position of particle {index} is not finite"));
        }
        // The square of a radius must stay a normal float32.
        let usable = |radius: f32| radius > 1e-18 && radius < 1e18;
        let radius = match self.radius {
            Radius::Uniform(radius) => Some(radius).filter(|r| !usable(*r)),
            Radius::Each(radii) => radii.iter().copied().find(|r| !usable(*r)),
        };
        match radius {
            Some(radius) => bad(format!("a radius of {radius}; it must be between 1e-18 and 1e18")),
            None => Ok(()),
        }
    }
}

/// Particles in GPU buffers, in as many chunks as the device's binding limit asks for: order does not matter to a splat.
pub struct Particles {
    pub(crate) chunks: Vec<Chunk>,
    pub(crate) origin: DVec3,
    pub(crate) reference_radius: f32,
    pub(crate) largest_radius: f32,
    has_density: bool,
    /// `detail_splat.wgsl`'s vec4u of each particle, a buffer for each chunk; empty: nothing is known.
    motions: Vec<wgpu::Buffer>,
    /// `paint_sums.wgsl`'s vec2u of each particle, a buffer for each chunk; empty: all are alike.
    paints: Vec<wgpu::Buffer>,
    paint_average: Option<PaintAverage>,
    droplets: Vec<DropletChunk>,
}

/// Droplets that one dispatch can bind.
pub(crate) struct DropletChunk {
    pub count: u64,
    /// `droplets_splat.wgsl`'s `Droplet`.
    buffer: wgpu::Buffer,
}

impl DropletChunk {
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        first_bytes(&self.buffer, size_of::<PackedDroplet>() as u64 * self.count)
    }
}

/// Particles that one dispatch can bind, as the balls that `ball.wgsl` reads. Buffers may be larger.
#[derive(Clone)]
pub(crate) struct Chunk {
    pub count: u64,
    /// vec4: local position, radius.
    pub positions: wgpu::Buffer,
    /// f32, or a single unused one.
    pub densities: wgpu::Buffer,
    /// `shape.wgsl`'s vec4u of each ellipsoid; None: spheres.
    pub shapes: Option<wgpu::Buffer>,
}

impl Chunk {
    /// vec4 of each particle.
    pub fn positions(&self) -> wgpu::BindingResource<'_> {
        first_bytes(&self.positions, 16 * self.count)
    }

    /// `ball.wgsl`'s bindings.
    pub fn bindings(&self) -> [wgpu::BindingResource<'_>; 3] {
        let unused = &self.positions;
        [
            self.positions(),
            self.densities.as_entire_binding(),
            self.shapes.as_ref().unwrap_or(unused).as_entire_binding(),
        ]
    }
}

/// Bytes that one binding holds, at most a gigabyte.
pub(crate) fn largest_binding(device: &wgpu::Device) -> u64 {
    let limits = device.limits();
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(1 << 30)
}

/// A binding of the start of a buffer that may be larger.
pub(crate) fn first_bytes(buffer: &wgpu::Buffer, bytes: u64) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size: wgpu::BufferSize::new(bytes) })
}

impl Particles {
    /// Copies particles to the device: 16 bytes each, 20 with density.
    ///
    /// # Errors
    /// Arrays of different lengths, positions that are not finite, radii that are not positive.
    pub fn upload(device: &wgpu::Device, queue: &wgpu::Queue, slices: &ParticleSlices<'_>) -> Result<Self, Error> {
        slices.check()?;
        let chunk_len = (largest_binding(device) / 16) as usize;
        let chunks = slices.positions.chunks(chunk_len).enumerate().map(|(i, positions)| {
            let first = i * chunk_len;
            let radius = |k: usize| match slices.radius {
                Radius::Uniform(radius) => radius,
                Radius::Each(radii) => radii[first + k],
            };
            let packed: Vec<[f32; 4]> =
                positions.iter().enumerate().map(|(k, p)| [p[0], p[1], p[2], radius(k)]).collect();
            let densities = slices.density.map_or(&[0.0][..], |d| &d[first..first + positions.len()]);
            Chunk {
                count: positions.len() as u64,
                positions: filled_buffer(device, queue, "particles", bytemuck::cast_slice(&packed)),
                densities: filled_buffer(device, queue, "densities", bytemuck::cast_slice(densities)),
                shapes: None,
            }
        });
        let radii = [slices.reference_radius(), slices.largest_radius()];
        Ok(Self::of_chunks(chunks.collect(), slices.origin, radii, slices.density.is_some()))
    }

    /// None at all, for [`crate::Renderer::gather`] to fill.
    pub fn none() -> Self {
        Self::of_chunks(Vec::new(), DVec3::ZERO, [1.0; 2], false)
    }

    /// The same particles as a part of others, whose median radius this is: the r in which settings are measured.
    pub fn with_reference_radius(self, reference_radius: f32) -> Self {
        Self { reference_radius, ..self }
    }

    /// Of chunks whose median and largest radius are known.
    pub(crate) fn of_chunks(
        chunks: Vec<Chunk>,
        origin: DVec3,
        [reference_radius, largest_radius]: [f32; 2],
        has_density: bool,
    ) -> Self {
        Self {
            chunks,
            origin,
            reference_radius,
            largest_radius,
            has_density,
            motions: Vec::new(),
            paints: Vec::new(),
            paint_average: None,
            droplets: Vec::new(),
        }
    }

    /// Empties it; gives back the buffers.
    pub(crate) fn take_buffers(&mut self) -> Vec<Chunk> {
        std::mem::replace(self, Self::none()).chunks
    }

    /// Copies what the particles carry from frame to frame, 16 bytes each, in the order of the positions.
    ///
    /// # Errors
    /// Arrays of other lengths than the positions.
    pub fn set_motion(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, motion: &Motion<'_>) -> Result<(), Error> {
        motion.check(self.len() as usize)?;
        let mut first = 0;
        let buffer = |chunk: &Chunk| {
            let range = first..first + chunk.count as usize;
            first = range.end;
            let packed: Vec<[u32; 4]> = range.map(|index| motion.packed(index)).collect();
            filled_buffer(device, queue, "motions", bytemuck::cast_slice(&packed))
        };
        self.motions = self.chunks.iter().map(buffer).collect();
        Ok(())
    }

    /// Copies what the particles are painted with, 8 bytes each, in the order of the positions.
    ///
    /// # Errors
    /// Arrays of other lengths than the positions, more than [`crate::MOST_LIQUIDS`].
    pub fn set_paint(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, paint: &Paint<'_>) -> Result<(), Error> {
        let count = self.len() as usize;
        paint.check(count)?;
        let mut first = 0;
        let buffer = |chunk: &Chunk| {
            let range = first..first + chunk.count as usize;
            first = range.end;
            let packed: Vec<[u32; 2]> = range.map(|index| paint.packed(index)).collect();
            filled_buffer(device, queue, "paints", bytemuck::cast_slice(&packed))
        };
        self.paints = self.chunks.iter().map(buffer).collect();
        self.paint_average = Some(paint.average(count));
        Ok(())
    }

    /// Copies foam, spray and bubbles to the device, 32 bytes each, in place of those there were. They are drawn with the fluid.
    ///
    /// # Errors
    /// Arrays of different lengths.
    pub fn set_droplets(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        droplets: &[Droplets<'_>],
    ) -> Result<(), Error> {
        droplets.iter().try_for_each(Droplets::check)?;
        let packed: Vec<PackedDroplet> = droplets.iter().flat_map(Droplets::packed).collect();
        let most = largest_binding(device) as usize / size_of::<PackedDroplet>();
        let chunk = |packed: &[PackedDroplet]| DropletChunk {
            count: packed.len() as u64,
            buffer: filled_buffer(device, queue, "droplets", bytemuck::cast_slice(packed)),
        };
        self.droplets = packed.chunks(most).map(chunk).collect();
        Ok(())
    }

    pub(crate) fn droplets(&self) -> &[DropletChunk] {
        &self.droplets
    }

    /// A buffer for each chunk.
    pub(crate) fn paints(&self) -> &[wgpu::Buffer] {
        &self.paints
    }

    /// None where all particles are alike.
    pub(crate) fn paint_average(&self) -> Option<&PaintAverage> {
        self.paint_average.as_ref()
    }

    /// The chunks with what `detail_splat.wgsl` reads of each.
    pub(crate) fn chunks_in_motion(&self) -> impl Iterator<Item = (&Chunk, Option<&wgpu::Buffer>)> {
        self.chunks.iter().enumerate().map(|(index, chunk)| (chunk, self.motions.get(index)))
    }

    pub(crate) fn has_motion(&self) -> bool {
        !self.motions.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> u64 {
        self.chunks.iter().map(|chunk| chunk.count).sum()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.chunks.is_empty()
    }

    pub(crate) fn has_density(&self) -> bool {
        self.has_density
    }
}

fn filled_buffer(device: &wgpu::Device, queue: &wgpu::Queue, label: &str, bytes: &[u8]) -> wgpu::Buffer {
    let buffer = crate::gpu::storage_buffer(device, label, bytes.len() as u64);
    queue.write_buffer(&buffer, 0, bytes);
    buffer
}
