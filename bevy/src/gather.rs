//! Particles on the device, as limpid has them.

use crate::FluidParticles;
use crate::extract::{ExtractedFluid, Scene};
use bevy::ecs::entity::Entity;
use bevy::ecs::resource::Resource;
use bevy::ecs::system::{Res, ResMut};
use bevy::ecs::world::{FromWorld, World};
use bevy::log::error;
use bevy::math::Vec3;
use bevy::platform::collections::HashMap;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue};
use bevy::render::storage::GpuShaderBuffer;
use limpid::glam::DVec3;
use limpid::{
    Column, Error, ParticleBuffers, ParticleSlices, Particles, Radius, RadiusColumn, Renderer, TargetFormat, wgpu,
};
use std::sync::Arc;

/// The particles of each fluid, by its entity in the main world.
#[derive(Resource)]
pub(crate) struct Gathered {
    fluids: HashMap<Entity, OnDevice>,
    /// Copies particles and draws nothing.
    renderer: Renderer,
}

struct OnDevice {
    particles: Particles,
    /// What was uploaded; None: nothing, or it is read in every frame.
    positions: Option<Arc<Vec<Vec3>>>,
    radius: f32,
    /// What was said of them last.
    complaint: Option<String>,
}

impl FromWorld for Gathered {
    fn from_world(world: &mut World) -> Self {
        let device = world.resource::<RenderDevice>().wgpu_device();
        let nothing = TargetFormat { color: wgpu::TextureFormat::Rgba8Unorm, depth: None, samples: 1 };
        Self { fluids: HashMap::default(), renderer: Renderer::new(device, &nothing) }
    }
}

impl Gathered {
    /// None: they could not be had, or there are none.
    pub fn of(&self, entity: Entity) -> Option<&Particles> {
        let particles = &self.fluids.get(&entity)?.particles;
        (!particles.is_empty()).then_some(particles)
    }

    fn entry(&mut self, entity: Entity) -> &mut OnDevice {
        self.fluids.entry(entity).or_insert_with(|| OnDevice {
            particles: Particles::none(),
            positions: None,
            radius: 0.0,
            complaint: None,
        })
    }
}

impl OnDevice {
    fn is_of(&self, positions: &Arc<Vec<Vec3>>, radius: f32) -> bool {
        self.radius == radius && self.positions.as_ref().is_some_and(|old| Arc::ptr_eq(old, positions))
    }

    /// Says what is wrong once, not in every frame.
    fn tell(&mut self, entity: Entity, result: Result<(), Error>) {
        let complaint = result.err().map(|error| error.to_string());
        if let Some(complaint) = complaint.as_ref().filter(|_| self.complaint != complaint) {
            error!("fluid {entity}: {complaint}");
        }
        self.complaint = complaint;
    }
}

/// Those in memory, where they have changed.
pub(crate) fn upload_fluids(
    scene: Res<Scene>,
    mut gathered: ResMut<Gathered>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    gathered.fluids.retain(|entity, _| scene.fluids.iter().any(|fluid| fluid.entity == *entity));
    for ExtractedFluid { entity, particles, radius, .. } in &scene.fluids {
        let FluidParticles::Positions(positions) = particles else { continue };
        let fluid = gathered.entry(*entity);
        if fluid.is_of(positions, *radius) {
            continue;
        }
        let slices = ParticleSlices {
            origin: DVec3::ZERO,
            positions: bytemuck::cast_slice(positions.as_slice()),
            radius: Radius::Uniform(*radius),
            density: None,
        };
        let uploaded = Particles::upload(device.wgpu_device(), &queue, &slices);
        (fluid.positions, fluid.radius) = (Some(Arc::clone(positions)), *radius);
        let result = uploaded.map(|particles| fluid.particles = particles);
        if result.is_err() {
            fluid.particles = Particles::none();
        }
        fluid.tell(*entity, result);
    }
}

/// Those in buffers, in every frame.
pub(crate) fn gather_fluids(
    scene: Res<Scene>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    mut gathered: ResMut<Gathered>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut context: RenderContext,
) {
    for ExtractedFluid { entity, particles, radius, .. } in &scene.fluids {
        let FluidParticles::Buffer { buffer, count, offset, stride } = particles else { continue };
        // Not there in the frame in which it is made.
        let Some(GpuShaderBuffer { buffer, .. }) = buffers.get(buffer) else { continue };
        gathered.entry(*entity);
        let Gathered { fluids, renderer } = &mut *gathered;
        let Some(fluid) = fluids.get_mut(entity) else { continue };
        fluid.positions = None;
        let columns = ParticleBuffers {
            origin: DVec3::ZERO,
            count: *count,
            positions: Column { buffer, offset: *offset, stride: *stride },
            radius: RadiusColumn::Uniform(*radius),
            density: None,
        };
        let encoder = context.command_encoder();
        let result = renderer.gather(device.wgpu_device(), &queue, encoder, &columns, &mut fluid.particles);
        if result.is_err() {
            fluid.particles = Particles::none();
        }
        fluid.tell(*entity, result);
    }
}
