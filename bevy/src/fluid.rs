//! What a user says of a fluid.

use bevy::asset::Handle;
use bevy::camera::visibility::Visibility;
use bevy::ecs::component::Component;
use bevy::math::Vec3;
use bevy::render::storage::ShaderBuffer;
use bevy::transform::components::Transform;
use limpid::Settings;
use std::sync::Arc;

/// A body of liquid made of particles, in the space of its entity: [`Transform`] moves, turns and scales it (evenly: of a scale that
/// differs between axes the geometric mean counts). [`Visibility`] and render layers hide it.
#[derive(Component, Clone, Debug)]
#[require(Transform, Visibility)]
pub struct Fluid {
    /// Where they are.
    pub particles: FluidParticles,
    /// Their radius, above 0: half the spacing of particles at rest, in the entity's space.
    pub radius: f32,
    /// How the liquid looks. `Settings::default()` is water.
    pub settings: Settings,
    /// Height in the world of a floor to be seen, by mirror images and through the liquid, where the picture has nothing to show; None,
    /// the default: sky all around.
    pub floor: Option<f32>,
}

/// Where a fluid's particles are.
#[derive(Clone, Debug)]
pub enum FluidParticles {
    /// In memory, finite. Uploaded whenever the `Arc` is another one: a new `Vec` in each frame in which they have moved.
    Positions(Arc<Vec<Vec3>>),
    /// In a buffer that a solver of yours writes, before [`FluidSystems::Gather`](crate::FluidSystems::Gather): three f32 each. Read in every
    /// frame. Those that are not finite are left out.
    Buffer {
        /// With the usage STORAGE.
        buffer: Handle<ShaderBuffer>,
        /// How many particles there are.
        count: u64,
        /// Bytes before the first position, a multiple of 4.
        offset: u64,
        /// Bytes from each position to the next, a multiple of 4: 12 where there is nothing between them.
        stride: u64,
    },
}

impl Fluid {
    /// Water.
    pub fn new(positions: Vec<Vec3>, radius: f32) -> Self {
        Self::of(FluidParticles::Positions(Arc::new(positions)), radius)
    }

    /// Water whose particles may be on the GPU.
    pub fn of(particles: FluidParticles, radius: f32) -> Self {
        Self { particles, radius, settings: Settings::default(), floor: None }
    }
}
