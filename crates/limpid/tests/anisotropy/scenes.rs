//! Particle sets and cameras.

use crate::fluid::Particle;
use glam::{DVec3, Vec3};
use limpid::{Anisotropy, Settings, View};

/// Pseudo-random numbers in 0..1 (xorshift), the same every run.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    /// In the cube -1..1.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }
}

/// Particles of radius 1, each marked by the last bits of its radius, which every pass keeps.
pub fn marked(positions: impl IntoIterator<Item = Vec3>) -> Vec<Particle> {
    let radius = |index: usize| f32::from_bits(1f32.to_bits() + index as u32);
    positions.into_iter().enumerate().map(|(index, position)| Particle { position, radius: radius(index) }).collect()
}

/// The index that `marked` gave.
pub fn mark_of(radius: f32) -> usize {
    (radius.to_bits() - 1f32.to_bits()) as usize
}

/// A slab of spacing 2, `layers` deep below y = -1, `half` particles to each side, jittered by up to `jitter` each way.
pub fn slab(half: i32, layers: i32, jitter: f32) -> Vec<Vec3> {
    let mut random = Random::new(7);
    let mut positions = Vec::new();
    for layer in 0..layers {
        for x in -half..=half {
            for z in -half..=half {
                let place = Vec3::new(x as f32, -(layer as f32) - 0.5, z as f32) * 2.0;
                positions.push(place + jitter * random.vector());
            }
        }
    }
    positions
}

pub fn cloud(count: usize, half: f32, seed: u64) -> Vec<Vec3> {
    let mut random = Random::new(seed);
    (0..count).map(|_| half * random.vector()).collect()
}

/// A frame of a simulated dam break, in particle radii.
pub fn dam_break() -> Vec<Vec3> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/dam_break_double/ParticleData_Fluid_20.bgeo");
    let set = limpid_io::read(path.as_ref()).unwrap();
    let origin = DVec3::from_array(set.origin).as_vec3();
    set.positions.iter().map(|p| (Vec3::from_array(*p) + origin) / 0.025).collect()
}

pub const SIZE: [u32; 2] = [320, 240];

pub fn looking(eye: DVec3, target: DVec3) -> View {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let up = if (target - eye).cross(DVec3::Y).length() < 1e-6 * (target - eye).length() { DVec3::Z } else { DVec3::Y };
    View::perspective(eye, target, up, 45f64.to_radians(), aspect, 0.1)
}

/// From straight above, without perspective.
pub fn from_above(height: f64) -> View {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    View::orthographic(DVec3::Y * 50.0, DVec3::ZERO, DVec3::Z, height, aspect, 1.0, 200.0)
}

/// The defaults, but for particles of whatever size in the picture.
pub fn stretched() -> Settings {
    let defaults = Settings::default();
    Settings { anisotropy: Anisotropy { min_radius_px: 0.0, ..defaults.anisotropy }, ..defaults }
}
