//! Particles in buffers of the host's.

use crate::Error;
use glam::DVec3;

/// Particles that are on the GPU already, in buffers of the host's, of whatever layout. [`crate::Renderer::gather`] copies
/// them there; World position = origin + position.
#[derive(Clone, Copy, Debug)]
pub struct ParticleBuffers<'a> {
    /// Where the positions' local space starts, world units.
    pub origin: DVec3,
    /// How many particles there are.
    pub count: u64,
    /// Three f32 of each: its local position, world units.
    pub positions: Column<'a>,
    /// Particle radii.
    pub radius: RadiusColumn<'a>,
    /// One f32 of each: its density (any unit), for [`crate::Settings::density_threshold`].
    pub density: Option<Column<'a>>,
}

/// One value of every particle in a buffer: at `offset` that of the first, at `offset + stride` that of the next.
#[derive(Clone, Copy, Debug)]
pub struct Column<'a> {
    /// With [`wgpu::BufferUsages::STORAGE`].
    pub buffer: &'a wgpu::Buffer,
    /// Bytes, a multiple of 4.
    pub offset: u64,
    /// Bytes, a multiple of 4; 12 for positions without padding.
    pub stride: u64,
}

/// Particle radii in world units: half the spacing of particles at rest, 1e-18 to 1e18.
#[derive(Clone, Copy, Debug)]
pub enum RadiusColumn<'a> {
    /// The same for all.
    Uniform(f32),
    /// One f32 for each particle.
    Each {
        /// Where they are.
        column: Column<'a>,
        /// The r in which settings are measured: about the median.
        reference: f32,
        /// No particle has a larger one.
        largest: f32,
    },
}

impl RadiusColumn<'_> {
    /// The r in which settings are measured, and the largest radius.
    pub(crate) fn extremes(&self) -> (f32, f32) {
        match *self {
            Self::Uniform(radius) => (radius, radius),
            Self::Each { reference, largest, .. } => (reference, largest),
        }
    }

    pub(crate) fn column(&self) -> Option<&Column<'_>> {
        match self {
            Self::Uniform(_) => None,
            Self::Each { column, .. } => Some(column),
        }
    }
}

impl ParticleBuffers<'_> {
    pub(crate) fn check(&self) -> Result<(), Error> {
        self.positions.check("positions", self.count, 12)?;
        if let Some(column) = self.radius.column() {
            column.check("radii", self.count, 4)?;
        }
        if let Some(column) = &self.density {
            column.check("densities", self.count, 4)?;
        }
        let (reference, largest) = self.radius.extremes();
        match [reference, largest].into_iter().find(|radius| !(*radius > 1e-18 && *radius < 1e18)) {
            Some(radius) => Err(Error::Particles(format!("a radius of {radius}; it must be between 1e-18 and 1e18"))),
            None => Ok(()),
        }
    }
}

impl Column<'_> {
    fn check(&self, what: &str, count: u64, value_bytes: u64) -> Result<(), Error> {
        let Self { buffer, offset, stride } = *self;
        let bad = |text: String| Err(Error::Particles(format!("{what} {text}")));
        if !buffer.usage().contains(wgpu::BufferUsages::STORAGE) {
            return bad("are in a buffer without the usage STORAGE".into());
        }
        if !offset.is_multiple_of(4) || !stride.is_multiple_of(4) {
            return bad(format!("have an offset of {offset} and a stride of {stride} bytes; make both multiples of 4"));
        }
        let last = count.saturating_sub(1).checked_mul(stride);
        let end = last.and_then(|last| last.checked_add(offset)?.checked_add(value_bytes));
        if count > 0 && end.is_none_or(|end| end > buffer.size()) {
            return bad(format!(
                "of {count} particles from byte {offset} with a stride of {stride} end beyond their buffer of {} bytes",
                buffer.size()
            ));
        }
        Ok(())
    }
}
