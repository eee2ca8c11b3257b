//! Liquid from particles in a Bevy scene, drawn by [`limpid`].
//!
//! ```no_run
//! use bevy::camera::Hdr;
//! use bevy::prelude::*;
//! use bevy_limpid::{Fluid, LimpidPlugin};
//!
//! fn main() {
//!     App::new().add_plugins((DefaultPlugins, LimpidPlugin)).add_systems(Startup, setup).run();
//! }
//!
//! fn setup(mut commands: Commands) {
//!     let positions = vec![Vec3::ZERO, Vec3::new(0.05, 0.0, 0.0)]; // of the solver's
//!     commands.spawn(Fluid::new(positions, 0.025));
//!     commands.spawn((DirectionalLight::default(), Transform::from_xyz(1.0, 2.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y)));
//!     commands.spawn((Camera3d::default(), Hdr, Transform::from_xyz(0.0, 1.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y)));
//! }
//! ```
//!
//! Fluids are drawn between the opaque and the transparent objects of every [`Camera3d`](bevy::camera::Camera3d): opaque ones are seen
//! through them, bent and tinted, and what is transparent is hidden behind them. They write depth.

mod draw;
mod extract;
mod fluid;
mod gather;
mod lights;
mod space;

pub use fluid::{Fluid, FluidParticles};
pub use limpid;

use bevy::app::{App, Plugin};
use bevy::core_pipeline::core_3d::{main_opaque_pass_3d, main_transparent_pass_3d};
use bevy::core_pipeline::schedule::camera_driver;
use bevy::core_pipeline::{Core3d, Core3dSystems};
use bevy::ecs::schedule::{IntoScheduleConfigs, SystemSet};
use bevy::render::renderer::{RenderGraph, RenderGraphSystems};
use bevy::render::view::prepare_view_targets;
use bevy::render::{ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderSystems};

/// Draws every [`Fluid`]. Wants Bevy's renderer.
pub struct LimpidPlugin;

/// What the plugin does in a frame, for systems that have to come before or after it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FluidSystems {
    /// In the [`RenderGraph`]: copies particles from the GPU buffers of [`FluidParticles::Buffer`]. Solvers that write them come before it.
    Gather,
    /// In [`Core3d`], for each camera: draws the fluids.
    Draw,
}

impl Plugin for LimpidPlugin {
    fn build(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .init_resource::<extract::Scene>()
            .init_gpu_resource::<gather::Gathered>()
            .init_gpu_resource::<draw::Renderers>()
            .add_systems(ExtractSchedule, (extract::extract_fluids, lights::extract_lights))
            .add_systems(
                Render,
                (
                    draw::let_depth_be_read.in_set(RenderSystems::PrepareViews).ambiguous_with(prepare_view_targets),
                    gather::upload_fluids.in_set(RenderSystems::PrepareResources),
                ),
            )
            .add_systems(
                RenderGraph,
                gather::gather_fluids
                    .in_set(FluidSystems::Gather)
                    .in_set(RenderGraphSystems::Render)
                    .before(camera_driver),
            )
            .add_systems(
                Core3d,
                draw::draw_fluids
                    .in_set(FluidSystems::Draw)
                    .in_set(Core3dSystems::MainPass)
                    .after(main_opaque_pass_3d)
                    .before(main_transparent_pass_3d),
            );
    }
}
