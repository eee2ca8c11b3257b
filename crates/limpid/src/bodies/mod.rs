//! Rigid bodies and glass tanks, drawn as a scene for hosts that have none of their own: `body.wgsl`, `glass.wgsl`.

mod mesh;
mod rims;

pub use mesh::{Material, Mesh, PartSlices, TextureSlices};

use crate::backdrop::BackdropFrame;
use crate::environment::EnvironmentUniform;
use crate::gpu::{Module, Pipelines, Raster, RasterSource, Slot, bind, slot_entries, storage_buffer, uniform_buffer};
use crate::passes::module;
use crate::renderer::{SettingsUniform, frame_layout};
use crate::shadow::SCENE_SHADOW_TEXELS;
use crate::view::ViewUniform;
use crate::{Environment, Scale, TargetFormat, View};
use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, Mat4};
use mesh::{ATTRIBUTES, Part, Vertex};

/// A mesh at its place.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// What it is.
    pub mesh: &'a Mesh,
    /// Where it is: any affine transform, mirrored ones too.
    pub world_from_mesh: DMat4,
    /// What it is made of.
    pub look: Look,
}

/// What a body is made of.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Look {
    /// The materials of its mesh.
    #[default]
    Own,
    /// The same in this base colour, linear: the mesh's textures and its vertices' colours multiply it.
    Colored([f32; 3]),
    /// Thin panes, as of a tank: drawn behind what they hold where they turn their outside away from the eye, else before
    /// it. They cast no shadow.
    Glass,
}

/// Which part of a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Opaque bodies: colour and depth, before the fluid.
    Opaque,
    /// Glass behind what it holds: after the opaque bodies, before the fluid.
    FarGlass,
    /// Glass before what it holds: after [`crate::Renderer::composite`].
    NearGlass,
}

/// Own colour of a pane, and of a rim.
const PANE_ALPHA: f32 = 0.025;
const RIM_ALPHA: f32 = 0.5;

/// `body.wgsl`'s `Body`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct BodyUniform {
    pub clip_from_mesh: Mat4,
    pub eye_from_mesh: Mat4,
    pub normal_from_mesh: Mat4,
    pub base_color: [f32; 4],
    pub metallic: f32,
    pub roughness: f32,
    pub alpha: f32,
    pub padding: f32,
}

/// Draws bodies in the light of an [`crate::Environment`]. Writes reversed depth, as [`crate::Backdrop`] does.
pub struct Bodies {
    opaque: Raster,
    far_pane: Raster,
    near_pane: Raster,
    rim: Raster,
    caster: Raster,
    /// What the sun sees.
    /// A layer for each light, as many as were asked for so far.
    from_lights: wgpu::Texture,
    frame_group: wgpu::BindGroup,
    light_layout: wgpu::BindGroupLayout,
    body_layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    blank: wgpu::TextureView,
    no_shadow: wgpu::Buffer,
    view: wgpu::Buffer,
    environment: wgpu::Buffer,
}

impl Bodies {
    /// Readies them for one kind of target.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, target: &TargetFormat) -> Self {
        let module = module!(
            "bodies",
            "../frame.wgsl",
            "../light_maps.wgsl",
            "../environment.wgsl",
            "../elaborate.wgsl",
            "body.wgsl",
            "glass.wgsl"
        );
        let frame = frame_layout(device);
        let light_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("light"),
            entries: &slot_entries(&[Slot::Uniform, Slot::Read, Slot::Color], wgpu::ShaderStages::FRAGMENT),
        });
        let body_layout = body_layout(device);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("bodies"),
            bind_group_layouts: &[Some(&frame), Some(&light_layout), Some(&body_layout)],
            immediate_size: 0,
        });
        let raster = |fragment, blend| mesh_raster(device, &layout, &module, fragment, blend, target);
        let over = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let view = uniform_buffer::<ViewUniform>(device, "bodies' view");
        // The frame's group wants settings, of which these shaders use none.
        let settings = uniform_buffer::<SettingsUniform>(device, "no settings");
        Self {
            opaque: raster("opaque", None),
            far_pane: raster("far_pane", over),
            near_pane: raster("near_pane", over),
            rim: raster("rim", over),
            caster: caster_raster(device, &layout, &module),
            from_lights: shadow_texture(device, 1),
            frame_group: bind(device, &frame, &[view.as_entire_binding(), settings.as_entire_binding()]),
            light_layout,
            body_layout,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            blank: mesh::white(device, queue),
            no_shadow: storage_buffer(device, "no shadow", 4),
            view,
            environment: uniform_buffer::<EnvironmentUniform>(device, "bodies' environment"),
        }
    }

    /// What they draw these with.
    pub fn pipelines(&self, bodies: &[Body<'_>]) -> Pipelines {
        let mut pipelines = Pipelines::default();
        let glass = [&self.far_pane, &self.near_pane, &self.rim];
        let opaque = [&self.opaque, &self.caster];
        for body in bodies {
            let rasters = if body.look == Look::Glass { &glass[..] } else { &opaque };
            rasters.iter().for_each(|raster| pipelines.push_raster(raster));
        }
        pipelines
    }

    /// Records what the lights see of the opaque bodies, for [`crate::Renderer::cast_shadow`]; None: there are none.
    pub fn from_lights(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        environment: &Environment,
        bodies: &[Body<'_>],
    ) -> Option<&wgpu::Texture> {
        let opaque: Vec<&Body<'_>> = bodies.iter().filter(|body| body.look != Look::Glass).collect();
        if opaque.is_empty() {
            return None;
        }
        let lights = environment.light_views().count() as u32;
        if self.from_lights.depth_or_array_layers() < lights {
            self.from_lights = shadow_texture(device, lights);
        }
        for (layer, view) in (0..).zip(environment.light_views()) {
            self.draw_depth(device, queue, encoder, &opaque, (layer, &view));
        }
        Some(&self.from_lights)
    }

    /// Draws the depth of bodies from a light into its layer.
    fn draw_depth(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        bodies: &[&Body<'_>],
        (layer, view): (u32, &View),
    ) {
        let depth = self.from_lights.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("bodies from a light"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(self.caster.pipeline());
        pass.set_bind_group(0, &self.frame_group, &[]);
        let light = [
            self.environment.as_entire_binding(),
            self.no_shadow.as_entire_binding(),
            wgpu::BindingResource::TextureView(&self.blank),
        ];
        pass.set_bind_group(1, &bind(device, &self.light_layout, &light), &[]);
        for body in bodies {
            for part in &body.mesh.parts {
                let uniform = body.uniform(view, part);
                self.triangles(device, queue, &mut pass, &uniform, &part.textures, (&part.vertices, part.count));
            }
        }
    }

    /// Draws one layer into the host's pass. Uniforms are written to the queue at once: one view per submission.
    pub fn draw(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        frame: &BackdropFrame<'_>,
        bodies: &[Body<'_>],
        layer: Layer,
    ) {
        let BackdropFrame { view, size, shadow, map, .. } = *frame;
        let bodies = bodies.iter().filter(|body| (body.look == Look::Glass) == (layer != Layer::Opaque));
        let bodies: Vec<&Body<'_>> = bodies.collect();
        if bodies.is_empty() {
            return;
        }
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view.uniform(size, Scale::Full, DVec3::ZERO)));
        queue.write_buffer(&self.environment, 0, bytemuck::bytes_of(&frame.uniform()));
        let light = [
            self.environment.as_entire_binding(),
            shadow.map_or(&self.no_shadow, |shadow| shadow.map).as_entire_binding(),
            wgpu::BindingResource::TextureView(map.map_or(&self.blank, |map| &map.view)),
        ];
        let light = bind(device, &self.light_layout, &light);
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, &light, &[]);
        for body in bodies {
            let raster = match layer {
                Layer::Opaque => &self.opaque,
                Layer::FarGlass => &self.far_pane,
                Layer::NearGlass => &self.near_pane,
            };
            pass.set_pipeline(raster.pipeline());
            for part in &body.mesh.parts {
                let uniform = body.uniform(view, part);
                self.triangles(device, queue, pass, &uniform, &part.textures, (&part.vertices, part.count));
            }
            if layer != Layer::Opaque {
                self.rims(device, queue, pass, view, body, layer);
            }
        }
    }

    fn rims(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        view: &View,
        body: &Body<'_>,
        layer: Layer,
    ) {
        let eye = view.eye();
        let forward = (!view.is_perspective()).then(|| -view.view_from_world.row(2).truncate());
        let [far, near] = rims::bars(&body.mesh.edges, &body.world_from_mesh, eye, forward);
        let vertices = if layer == Layer::FarGlass { far } else { near };
        if vertices.is_empty() {
            return;
        }
        let clip_from_eye = view.clip_from_view * view.view_from_world * DMat4::from_translation(eye);
        let uniform = BodyUniform {
            clip_from_mesh: clip_from_eye.as_mat4(),
            eye_from_mesh: Mat4::IDENTITY,
            normal_from_mesh: Mat4::IDENTITY,
            alpha: RIM_ALPHA,
            ..BodyUniform::zeroed()
        };
        let buffer = mesh::vertex_buffer(device, queue, &vertices);
        pass.set_pipeline(self.rim.pipeline());
        let textures = [self.blank.clone(), self.blank.clone()];
        self.triangles(device, queue, pass, &uniform, &textures, (&buffer, vertices.len() as u32));
    }

    fn triangles(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        uniform: &BodyUniform,
        textures: &[wgpu::TextureView; 2],
        (vertices, count): (&wgpu::Buffer, u32),
    ) {
        let buffer = uniform_buffer::<BodyUniform>(device, "body");
        queue.write_buffer(&buffer, 0, bytemuck::bytes_of(uniform));
        let group = bind(
            device,
            &self.body_layout,
            &[
                buffer.as_entire_binding(),
                wgpu::BindingResource::TextureView(&textures[0]),
                wgpu::BindingResource::TextureView(&textures[1]),
                wgpu::BindingResource::Sampler(&self.sampler),
            ],
        );
        pass.set_bind_group(2, &group, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..count, 0..1);
    }
}

impl Body<'_> {
    fn uniform(&self, view: &View, part: &Part) -> BodyUniform {
        let [r, g, b, a] = part.base_color;
        let world_from_mesh = self.world_from_mesh;
        BodyUniform {
            // In f64: scenes far from the origin keep their digits.
            clip_from_mesh: (view.clip_from_view * view.view_from_world * world_from_mesh).as_mat4(),
            eye_from_mesh: (DMat4::from_translation(-view.eye()) * world_from_mesh).as_mat4(),
            normal_from_mesh: world_from_mesh.inverse().transpose().as_mat4(),
            base_color: match self.look {
                Look::Colored([r, g, b]) => [r, g, b, a],
                Look::Own | Look::Glass => [r, g, b, a],
            },
            metallic: part.metallic,
            roughness: part.roughness,
            alpha: PANE_ALPHA,
            padding: 0.0,
        }
    }
}

/// Depth of the scene from so many lights.
fn shadow_texture(device: &wgpu::Device, lights: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("bodies from the lights"),
        size: wgpu::Extent3d { width: SCENE_SHADOW_TEXELS, height: SCENE_SHADOW_TEXELS, depth_or_array_layers: lights },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn body_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let mut entries = slot_entries(&[Slot::Uniform, Slot::Color, Slot::Color], stages);
    for entry in &mut entries[1..] {
        entry.ty = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
    }
    entries.push(wgpu::BindGroupLayoutEntry {
        binding: 3,
        visibility: stages,
        ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        count: None,
    });
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("body"), entries: &entries })
}

/// Depth alone, in the sun's view.
fn caster_raster(device: &wgpu::Device, layout: &wgpu::PipelineLayout, module: &Module) -> Raster {
    let depth = (wgpu::TextureFormat::Depth32Float, wgpu::CompareFunction::Greater);
    let source = RasterSource {
        module: module.clone(),
        layout: layout.clone(),
        vertex: "vertex",
        vertices: Some(VERTICES),
        fragment: None,
        color: None,
        depth: Some(depth_state(depth, true)),
        samples: 1,
    };
    Raster::new(device, source)
}

const VERTICES: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &ATTRIBUTES,
};

fn mesh_raster(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    module: &Module,
    fragment: &'static str,
    blend: Option<wgpu::BlendState>,
    target: &TargetFormat,
) -> Raster {
    let source = RasterSource {
        module: module.clone(),
        layout: layout.clone(),
        vertex: "vertex",
        vertices: Some(VERTICES),
        fragment: Some(fragment),
        color: Some(wgpu::ColorTargetState { format: target.color, blend, write_mask: wgpu::ColorWrites::ALL }),
        // What is seen through does not hide.
        depth: target.depth.map(|depth| depth_state(depth, blend.is_none())),
        samples: target.samples,
    };
    Raster::new(device, source)
}

fn depth_state(
    (format, compare): (wgpu::TextureFormat, wgpu::CompareFunction),
    is_written: bool,
) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(is_written),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}
