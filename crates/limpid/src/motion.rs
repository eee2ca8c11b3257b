//! What particles carry from frame to frame: who they are, how fast, how agitated.

use crate::Error;

/// What the detail of a surface needs to know of each particle beside its place; everything may be missing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion<'a> {
    /// Who each particle is, whatever the order of a frame: its pattern of noise goes by this. Missing: its place in the
    /// arrays.
    pub ids: Option<&'a [i64]>,
    /// World units per second. Missing: all at rest.
    pub velocities: Option<&'a [[f32; 3]]>,
    /// How agitated each particle is, 0 to 1 ([`crate::Agitation`]). Missing: all are calm.
    pub heat: Option<&'a [f32]>,
}

impl Motion<'_> {
    pub(crate) fn check(&self, count: usize) -> Result<(), Error> {
        let lengths = [
            ("ids", self.ids.map(<[_]>::len)),
            ("velocities", self.velocities.map(<[_]>::len)),
            ("heats", self.heat.map(<[_]>::len)),
        ];
        match lengths.into_iter().find(|(_, len)| len.is_some_and(|len| len != count)) {
            Some((what, len)) => {
                Err(Error::Particles(format!("{} {what} for {count} positions", len.unwrap_or_default())))
            }
            None => Ok(()),
        }
    }

    /// What `detail_splat.wgsl` reads of a particle: the seed of its pattern, heat and speed as bits, nothing.
    pub(crate) fn packed(&self, index: usize) -> [u32; 4] {
        let id = self.ids.map_or(index as i64, |ids| ids[index]) as u64;
        // SplitMix64: neighbouring ids get unlike patterns.
        let mixed = id.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        let seed = (mixed ^ mixed >> 31) as u32;
        let heat = self.heat.map_or(0.0, |heat| finite(heat[index]).clamp(0.0, 1.0));
        let speed = self.velocities.map_or(0.0, |v| v[index].iter().map(|x| x * x).sum::<f32>().sqrt());
        [seed, heat.to_bits(), finite(speed).to_bits(), 0]
    }
}

/// Solvers write NaN for particles that they have lost: those are at rest.
fn finite(value: f32) -> f32 {
    if value.is_finite() { value } else { 0.0 }
}
