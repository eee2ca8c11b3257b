//! The fluids in a camera's picture.

use crate::extract::{ExtractedFluid, Scene};
use crate::gather::Gathered;
use crate::space::{Eye, direction_in, surroundings};
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{Camera3d, MainPassResolutionOverride, Viewport};
use bevy::ecs::entity::Entity;
use bevy::ecs::resource::Resource;
use bevy::ecs::system::{Query, Res, ResMut};
use bevy::log::error;
use bevy::math::{Affine3A, Rect, UVec2};
use bevy::platform::collections::HashMap;
use bevy::render::camera::{ExtractedCamera, TemporalJitter};
use bevy::render::render_resource::{RenderPassDescriptor, StoreOp, TextureUsages};
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ExtractedView, ViewDepthStencilTexture, ViewTarget};
use limpid::{Environment, Frame, Lamp, MOST_LAMPS, Particles, Renderer, TargetFormat, View, wgpu};

/// A renderer for each camera, so that no two share images that differ in size.
#[derive(Resource, Default)]
pub(crate) struct Renderers(HashMap<Entity, ViewRenderer>);

struct ViewRenderer {
    target: TargetFormat,
    renderer: Renderer,
    /// Whether a first frame's pipelines have been built.
    is_warm: bool,
    /// What was said of each fluid last.
    complaints: HashMap<Entity, String>,
}

impl Renderers {
    /// The one of a camera, with the pipelines of another's where it draws into the same kind of target.
    fn of(&mut self, view: Entity, device: &wgpu::Device, target: TargetFormat) -> &mut ViewRenderer {
        if self.0.get(&view).is_none_or(|renderer| renderer.target != target) {
            let alike = self.0.values().find(|other| other.target == target);
            let (renderer, is_warm) = match alike {
                Some(other) => (other.renderer.sibling(device), other.is_warm),
                None => (Renderer::new(device, &target), false),
            };
            self.0.insert(view, ViewRenderer { target, renderer, is_warm, complaints: HashMap::default() });
        }
        self.0.get_mut(&view).expect("it has just been made")
    }
}

/// Cameras' depth is read by the fluids. Also frees what was of cameras that are gone.
pub(crate) fn let_depth_be_read(
    scene: Res<Scene>,
    mut renderers: ResMut<Renderers>,
    mut views: Query<(Entity, &mut Camera3d)>,
) {
    renderers.0.retain(|view, _| views.contains(*view));
    if scene.fluids.is_empty() {
        return;
    }
    for (_, mut camera) in &mut views {
        let usages = TextureUsages::from(camera.depth_texture_usages) | TextureUsages::TEXTURE_BINDING;
        camera.depth_texture_usages = usages.into();
    }
}

type CameraItems = (
    &'static ExtractedCamera,
    &'static ExtractedView,
    &'static ViewTarget,
    &'static ViewDepthStencilTexture,
    Option<&'static MainPassResolutionOverride>,
    Option<&'static TemporalJitter>,
    Option<&'static RenderLayers>,
);

pub(crate) fn draw_fluids(
    view: ViewQuery<CameraItems>,
    scene: Res<Scene>,
    gathered: Res<Gathered>,
    mut renderers: ResMut<Renderers>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut context: RenderContext,
) {
    let entity = view.entity();
    let (camera, extracted_view, target, depth, resolution, jitter, layers) = view.into_inner();
    let depth_texture = depth.texture();
    if !depth_texture.usage().contains(TextureUsages::TEXTURE_BINDING) {
        return;
    }
    let size = UVec2::new(depth_texture.width(), depth_texture.height());
    let viewport = Viewport::from_viewport_and_override(camera.viewport.as_ref(), resolution);
    let corners = viewport.map_or((UVec2::ZERO, size), |viewport| {
        (viewport.physical_position, viewport.physical_position + viewport.physical_size)
    });
    let eye = eye_of(extracted_view, jitter, corners, size);
    let seen = scene.seen_by(&eye, layers, &gathered);
    if seen.is_empty() {
        return;
    }

    let device = device.wgpu_device();
    let format = TargetFormat {
        color: target.main_texture_format(),
        depth: Some((depth_texture.format(), wgpu::CompareFunction::GreaterEqual)),
        samples: depth_texture.sample_count(),
    };
    let drawing = renderers.of(entity, device, format);
    let scene_depth = depth.attachment.depth_stencil_views().depth_only_view();
    for (fluid, particles, view) in &seen {
        let Some(environment) = scene.environment(fluid, camera.exposure) else { continue };
        let frame = Frame {
            particles,
            view,
            size: size.to_array(),
            settings: &fluid.settings,
            environment: &environment,
            // With what was drawn before it, other fluids too.
            scene: limpid::Scene { color: Some(target.main_texture_view()), depth: scene_depth.map(|view| &**view) },
        };
        let prepared = drawing.prepare(device, &queue, context.command_encoder(), &frame);
        if !drawing.tell(fluid.entity, prepared) {
            continue;
        }
        let mut pass = context.command_encoder().begin_render_pass(&RenderPassDescriptor {
            label: Some("fluid"),
            color_attachments: &[Some(target.get_color_attachment())],
            depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
            ..Default::default()
        });
        let (from, to) = corners;
        let part = to.min(size).saturating_sub(from);
        pass.set_scissor_rect(from.x.min(size.x), from.y.min(size.y), part.x, part.y);
        drawing.renderer.composite(&mut pass);
    }
}

impl ViewRenderer {
    /// Says what is wrong with a fluid once, not in every frame. Whether all is well.
    fn tell(&mut self, fluid: Entity, result: Result<(), limpid::Error>) -> bool {
        let complaint = result.err().map(|error| error.to_string()).unwrap_or_default();
        let before = self.complaints.entry(fluid).or_default();
        if *before != complaint {
            if !complaint.is_empty() {
                error!("fluid {fluid}: {complaint}");
            }
            before.clone_from(&complaint);
        }
        complaint.is_empty()
    }

    fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<(), limpid::Error> {
        if !self.is_warm {
            let record = |renderer: &mut Renderer, encoder: &mut _| renderer.prepare(device, queue, encoder, frame);
            self.renderer.pipelines_of(device, record)?.build(None);
            self.is_warm = true;
        }
        self.renderer.prepare(device, queue, encoder, frame)
    }
}

fn eye_of(view: &ExtractedView, jitter: Option<&TemporalJitter>, (from, to): (UVec2, UVec2), size: UVec2) -> Eye {
    let mut clip_from_view = view.clip_from_view;
    if let Some(jitter) = jitter {
        jitter.jitter_projection(&mut clip_from_view, (to - from).as_vec2());
    }
    let viewport = Rect::from_corners(from.as_vec2() / size.as_vec2(), to.as_vec2() / size.as_vec2());
    Eye { world_from_view: view.world_from_view.affine(), clip_from_view, viewport }
}

impl Scene {
    /// The fluids that a camera sees, the farthest first: each is seen through those after it.
    fn seen_by<'a>(
        &'a self,
        eye: &Eye,
        layers: Option<&RenderLayers>,
        gathered: &'a Gathered,
    ) -> Vec<(&'a ExtractedFluid, &'a Particles, View)> {
        let layers = layers.cloned().unwrap_or_default();
        let seen = |fluid: &'a ExtractedFluid| {
            let particles = gathered.of(fluid.entity).filter(|_| layers.intersects(&fluid.render_layers))?;
            Some((fluid, particles, eye.view_of(fluid.world_from_fluid)?))
        };
        let mut fluids: Vec<_> = self.fluids.iter().filter_map(seen).collect();
        let depth = |fluid: &ExtractedFluid| depth_of(eye.world_from_view, fluid.world_from_fluid);
        fluids.sort_by(|(a, ..), (b, ..)| depth(b).total_cmp(&depth(a)));
        fluids
    }

    /// What lights a fluid, in its own space.
    fn environment(&self, fluid: &ExtractedFluid, exposure: f32) -> Option<Environment> {
        let to = fluid.world_from_fluid;
        let mut environment = surroundings(to, fluid.floor)?;
        if let Some(sun) = self.lights.sun() {
            environment.sun = direction_in(to, sun.toward)?;
            environment.sun_strength = sun.strength(exposure).into();
        }
        let lamps = self.lights.lamps();
        environment.lamps = std::array::from_fn::<_, MOST_LAMPS, _>(|index| {
            let lamp = lamps.get(index)?;
            Some(Lamp { toward: direction_in(to, lamp.toward)?, color: lamp.color(exposure) })
        });
        Some(environment)
    }
}

/// Of an entity's origin, along the view.
fn depth_of(world_from_view: Affine3A, world_from_entity: Affine3A) -> f32 {
    -world_from_view.inverse().transform_point3a(world_from_entity.translation).z
}
