//! Particles: real, random, and in lattices.

use glam::DVec3;
use limpid::{ParticleSlices, Radius};
use std::path::Path;

/// Particles that own their arrays.
#[derive(Clone, Default)]
pub struct Cloud {
    pub origin: DVec3,
    pub positions: Vec<[f32; 3]>,
    /// One for each particle.
    pub radii: Vec<f32>,
    pub density: Option<Vec<f32>>,
}

impl Cloud {
    pub fn uniform(positions: Vec<[f32; 3]>, radius: f32) -> Self {
        Self { radii: vec![radius; positions.len()], positions, ..Self::default() }
    }

    /// A file of the repository's own data.
    pub fn read(file: &str, radius: f32) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(file);
        Self::uniform(limpid_io::read(&path).unwrap().positions, radius)
    }

    /// A ball of water hits a floor: 22,155 particles.
    pub fn sphere_drop() -> Self {
        Self::read("sphere_drop/frame.0014.pos", 0.008)
    }

    /// Two dam breaks meet: 24,360 particles.
    pub fn dam_break() -> Self {
        Self::read("dam_break_double/ParticleData_Fluid_20.bgeo", 0.025)
    }

    /// Particles of different radii within a box.
    pub fn random(seed: u64, count: usize, [min, max]: [[f64; 3]; 2], radii: [f64; 2]) -> Self {
        let mut random = Random(seed);
        let mut cloud = Self::default();
        for _ in 0..count {
            cloud.positions.push([0, 1, 2].map(|axis| random.between(min[axis], max[axis]) as f32));
            cloud.radii.push(random.between(radii[0], radii[1]) as f32);
        }
        cloud
    }

    /// A slab of spacing 2 r around the y axis, its topmost centres at y = 0, each coordinate off by up to `jitter` r
    /// RMS.
    pub fn slab(across: i32, layers: i32, radius: f64, jitter: f64) -> Self {
        let mut random = Random(7);
        let mut off = || 3f64.sqrt() * jitter * random.between(-1.0, 1.0);
        let mut positions = Vec::new();
        for x in 0..across {
            for z in 0..across {
                for layer in 0..layers {
                    let middle = 0.5 * f64::from(across - 1);
                    let cell = [f64::from(x) - middle, f64::from(-layer), f64::from(z) - middle];
                    positions.push(cell.map(|c| (radius * (2.0 * c + off())) as f32));
                }
            }
        }
        Self::uniform(positions, radius as f32)
    }

    pub fn slices(&self) -> ParticleSlices<'_> {
        let alike = self.radii.windows(2).all(|pair| pair[0] == pair[1]);
        ParticleSlices {
            origin: self.origin,
            positions: &self.positions,
            radius: match self.radii.first() {
                Some(radius) if alike => Radius::Uniform(*radius),
                _ => Radius::Each(&self.radii),
            },
            density: self.density.as_deref(),
        }
    }

    /// r: what settings are measured in.
    pub fn radius(&self) -> f64 {
        self.slices().reference_radius().into()
    }
}

/// SplitMix64: the same numbers everywhere, every time.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, (self.bits() % (last as u64 + 1)) as usize);
        }
    }
}
