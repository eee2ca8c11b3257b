//! Fluids and lights of the frame, in the render world.

use crate::lights::Lights;
use crate::{Fluid, FluidParticles};
use bevy::camera::visibility::{InheritedVisibility, RenderLayers};
use bevy::ecs::entity::Entity;
use bevy::ecs::resource::Resource;
use bevy::ecs::system::{Query, ResMut};
use bevy::math::Affine3A;
use bevy::render::Extract;
use bevy::transform::components::GlobalTransform;
use limpid::Settings;

/// What is to be drawn.
#[derive(Resource, Default)]
pub(crate) struct Scene {
    pub fluids: Vec<ExtractedFluid>,
    pub lights: Lights,
}

pub(crate) struct ExtractedFluid {
    /// In the main world.
    pub entity: Entity,
    pub particles: FluidParticles,
    /// In the fluid's own space.
    pub radius: f32,
    pub settings: Settings,
    /// Height in the world.
    pub floor: Option<f32>,
    pub world_from_fluid: Affine3A,
    pub render_layers: RenderLayers,
}

type FluidQuery<'w, 's> = Query<
    'w,
    's,
    (Entity, &'static Fluid, &'static GlobalTransform, &'static InheritedVisibility, Option<&'static RenderLayers>),
>;

pub(crate) fn extract_fluids(mut scene: ResMut<Scene>, fluids: Extract<FluidQuery>) {
    let visible = fluids.iter().filter(|(_, _, _, visibility, _)| visibility.get());
    scene.fluids = visible
        .map(|(entity, fluid, transform, _, render_layers)| ExtractedFluid {
            entity,
            particles: fluid.particles.clone(),
            radius: fluid.radius,
            settings: fluid.settings,
            floor: fluid.floor,
            world_from_fluid: transform.affine(),
            render_layers: render_layers.cloned().unwrap_or_default(),
        })
        .collect();
}
