//! A dam break in a scene of Bevy's: a floor, a pillar that stands in the water, a pane of glass half in it. And pictures of it
//! without a window.

use bevy::app::PluginsState;
use bevy::camera::{Exposure, Hdr, RenderTarget, Viewport};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::NotShadowCaster;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::storage::ShaderBuffer;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::ExitCondition;
use bevy_limpid::{Fluid, FluidParticles, LimpidPlugin};
use image::RgbaImage;
use std::error::Error;
use std::path::Path;

/// Particle radius of the simulation, metres.
pub const RADIUS: f32 = 0.025;

/// What is in the picture, and how it is taken.
#[derive(Resource, Clone)]
pub struct Options {
    pub size: UVec2,
    pub msaa: Msaa,
    pub projection: Projection,
    /// Where in the picture: all of it, or a part.
    pub viewport: Option<Viewport>,
    pub fluid: Option<Fluid>,
    pub fluid_transform: Transform,
    pub has_pillar: bool,
    pub has_pane: bool,
    /// The fluid's particles lie in a buffer of the GPU.
    pub is_on_gpu: bool,
}

impl Options {
    /// All there is to see.
    pub fn new(size: UVec2) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            size,
            msaa: Msaa::Sample4,
            projection: Projection::Perspective(PerspectiveProjection { fov: 45f32.to_radians(), ..default() }),
            viewport: None,
            fluid: Some(Fluid::new(positions()?, RADIUS)),
            fluid_transform: Transform::IDENTITY,
            has_pillar: true,
            has_pane: true,
            is_on_gpu: false,
        })
    }
}

/// Just under the lowest particles.
const FLOOR: f32 = -RADIUS;

/// Of one frame of a simulation.
pub fn positions() -> Result<Vec<Vec3>, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/dam_break_double/ParticleData_Fluid_20.bgeo");
    Ok(limpid_io::read(&file)?.positions.into_iter().map(Vec3::from).collect())
}

pub fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    options: Res<Options>,
) {
    let Options { fluid, fluid_transform, is_on_gpu, has_pillar, has_pane, .. } = &*options;
    if let Some(fluid) = fluid {
        let particles = if *is_on_gpu { on_gpu(&fluid.particles, &mut buffers) } else { fluid.particles.clone() };
        commands.spawn((Fluid { particles, ..fluid.clone() }, *fluid_transform));
    }
    let mut rough =
        |color| materials.add(StandardMaterial { base_color: color, perceptual_roughness: 0.9, ..default() });
    let (stone, brick) = (rough(Color::srgb(0.6, 0.57, 0.52)), rough(Color::srgb(0.7, 0.24, 0.14)));
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(60.0, 60.0))),
        MeshMaterial3d(stone),
        Transform::from_xyz(0.0, FLOOR, 0.0),
    ));
    if *has_pillar {
        commands.spawn((
            Mesh3d(meshes.add(Cuboid::new(0.5, 1.8, 0.5))),
            MeshMaterial3d(brick),
            Transform::from_xyz(0.9, 0.9 + FLOOR, 0.3),
        ));
    }
    if *has_pane {
        let glass = StandardMaterial {
            base_color: Color::srgba(0.1, 0.9, 0.4, 0.4),
            alpha_mode: AlphaMode::Blend,
            double_sided: true,
            cull_mode: None,
            ..default()
        };
        commands.spawn((
            Mesh3d(meshes.add(Rectangle::new(1.1, 1.5))),
            MeshMaterial3d(materials.add(glass)),
            Transform::from_xyz(-0.9, 0.75, 0.0).with_rotation(Quat::from_rotation_y(0.7)),
            NotShadowCaster,
        ));
    }
    commands.spawn((
        DirectionalLight { illuminance: 5000.0, shadow_maps_enabled: true, ..default() },
        Transform::from_xyz(-1.0, 3.0, 2.5).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

/// The positions with nothing between them.
fn on_gpu(particles: &FluidParticles, buffers: &mut Assets<ShaderBuffer>) -> FluidParticles {
    let FluidParticles::Positions(positions) = particles else { return particles.clone() };
    let words: Vec<f32> = positions.iter().flat_map(|place| place.to_array()).collect();
    let buffer = buffers.add(ShaderBuffer::new(words, default()));
    FluidParticles::Buffer { buffer, count: positions.len() as u64, offset: 0, stride: 12 }
}

/// The camera, less where it draws.
pub fn camera(options: &Options) -> impl Bundle {
    (
        Camera3d::default(),
        Camera { viewport: options.viewport.clone(), ..default() },
        Hdr,
        options.msaa,
        options.projection.clone(),
        Exposure::default(),
        Tonemapping::KhronosPbrNeutral,
        Transform::from_xyz(2.6, 2.2, 4.9).looking_at(Vec3::new(0.0, 0.95, 0.0), Vec3::Y),
        AmbientLight { brightness: 500.0, ..default() },
    )
}

pub fn sky() -> ClearColor {
    ClearColor(Color::srgb(0.45, 0.62, 0.82))
}

#[derive(Resource)]
struct Target(Handle<Image>);

#[derive(Resource, Default)]
struct Captured(Option<Image>);

/// The picture, without a window.
pub fn picture(options: &Options) -> Result<RgbaImage, Box<dyn Error>> {
    let plugins = DefaultPlugins
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
        .disable::<PipelinedRenderingPlugin>()
        // Tests make several pictures in one process, which has one log.
        .disable::<LogPlugin>();
    #[cfg(feature = "window")]
    let plugins = plugins.disable::<bevy::winit::WinitPlugin>();
    let mut app = App::new();
    app.add_plugins((plugins, LimpidPlugin))
        .insert_resource(sky())
        .insert_resource(options.clone())
        .init_resource::<Captured>()
        .add_systems(Startup, (spawn, spawn_camera));
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
    // Meshes and buffers are on the GPU by the second frame.
    for _ in 0..3 {
        app.update();
    }
    let target = app.world().resource::<Target>().0.clone();
    let keep = |captured: On<ScreenshotCaptured>, mut kept: ResMut<Captured>| kept.0 = Some(captured.image.clone());
    app.world_mut().spawn(Screenshot::image(target)).observe(keep);
    for _ in 0..100 {
        app.update();
        if let Some(image) = app.world_mut().resource_mut::<Captured>().0.take() {
            return Ok(image.try_into_dynamic()?.into_rgba8());
        }
    }
    Err("the picture has not arrived".into())
}

fn spawn_camera(mut commands: Commands, mut images: ResMut<Assets<Image>>, options: Res<Options>) {
    let UVec2 { x, y } = options.size;
    let target = images.add(Image::new_target_texture(x, y, TextureFormat::Rgba8UnormSrgb, None));
    commands.spawn((camera(&options), RenderTarget::Image(target.clone().into())));
    commands.insert_resource(Target(target));
}
