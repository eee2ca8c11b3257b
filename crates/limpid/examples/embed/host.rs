//! A small renderer of its own, as an engine has one: an opaque scene, fluids in it, a pane of glass after them. It owns
//! textures and passes; of limpid it uses `prepare` and `composite`.

use glam::{DVec3, Mat4};
use limpid::{
    Column, Environment, Frame, ParticleBuffers, Particles, RadiusColumn, Renderer, Scene, Settings, TargetFormat, View,
};
use wgpu::{CompareFunction, LoadOp, StoreOp, TextureFormat, TextureUsages};

/// What the host draws into.
#[derive(Clone, Copy, PartialEq)]
pub struct HostOptions {
    /// HDR, or for a screen.
    pub color: TextureFormat,
    /// Of each pixel, 1 or 4.
    pub samples: u32,
    /// Whether near things have the larger depth.
    pub reversed_depth: bool,
    /// Whether the pane of glass is there.
    pub has_glass: bool,
}

/// One of the host's particles, as its solver has it on the GPU.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct HostParticle {
    pub velocity: [f32; 3],
    pub mass: f32,
    pub position: [f32; 3],
    pub radius: f32,
}

/// A fluid of the host's.
pub struct Fluid<'a> {
    /// An array of [`HostParticle`].
    pub buffer: &'a wgpu::Buffer,
    pub count: u64,
    pub radius: f32,
    pub settings: &'a Settings,
}

/// The textures of one view.
pub struct Images {
    /// What everything is drawn into.
    color: wgpu::Texture,
    pub depth: wgpu::Texture,
    /// The opaque scene, one sample a pixel: what is seen through the fluid.
    scene: wgpu::Texture,
    /// The finished picture, one sample a pixel.
    pub picture: wgpu::Texture,
}

impl Images {
    pub fn new(device: &wgpu::Device, size: [u32; 2], options: HostOptions) -> Self {
        let texture = |format, sample_count, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let copied = |samples| if samples == 1 { TextureUsages::COPY_SRC } else { TextureUsages::empty() };
        let single = TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        Self {
            color: texture(options.color, options.samples, copied(options.samples)),
            depth: texture(TextureFormat::Depth32Float, options.samples, copied(options.samples)),
            scene: texture(options.color, 1, single),
            picture: texture(options.color, 1, single),
        }
    }
}

type Vertex = ([f32; 3], [f32; 4]);

pub struct Host {
    options: HostOptions,
    opaque: wgpu::RenderPipeline,
    glass: wgpu::RenderPipeline,
    vertices: wgpu::Buffer,
    opaque_count: u32,
    vertex_count: u32,
    /// One for each fluid: all are composited in one pass.
    fluids: Vec<(Renderer, Particles)>,
}

impl Host {
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, options: HostOptions) -> Self {
        let compare = if options.reversed_depth { CompareFunction::Greater } else { CompareFunction::Less };
        let target = TargetFormat {
            color: options.color,
            depth: Some((TextureFormat::Depth32Float, compare)),
            samples: options.samples,
        };
        let opaque = scene_triangles();
        let all: Vec<Vertex> = opaque.iter().copied().chain(glass_triangles()).collect();
        let words: Vec<f32> = all.iter().flat_map(|(place, color)| place.iter().chain(color)).copied().collect();
        let vertices = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("scene"),
            size: 4 * words.len() as u64,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&vertices, 0, bytemuck::cast_slice(&words));
        Self {
            opaque: pipeline(device, &target, true),
            glass: pipeline(device, &target, false),
            vertices,
            opaque_count: opaque.len() as u32,
            vertex_count: all.len() as u32,
            fluids: vec![(Renderer::new(device, &target), Particles::none())],
            options,
        }
    }

    /// Records one view of the scene with all fluids in it.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        images: &Images,
        view: &View,
        fluids: &[Fluid<'_>],
    ) -> Result<(), limpid::Error> {
        let views = [&images.color, &images.depth, &images.scene, &images.picture];
        let [color, depth, scene, picture] = views.map(|texture| texture.create_view(&Default::default()));
        let group = self.camera(device, queue, view);
        let is_multisampled = self.options.samples > 1;

        let far = if self.options.reversed_depth { 0.0 } else { 1.0 };
        let sky = LoadOp::Clear(wgpu::Color { r: 0.35, g: 0.5, b: 0.7, a: 1.0 });
        let mut pass = begin(encoder, &color, is_multisampled.then_some(&scene), sky, &depth, LoadOp::Clear(far));
        self.draw(&mut pass, &self.opaque, &group, 0..self.opaque_count);
        drop(pass);
        if !is_multisampled {
            let size = images.color.size();
            encoder.copy_texture_to_texture(images.color.as_image_copy(), images.scene.as_image_copy(), size);
        }

        let size = [images.color.width(), images.color.height()];
        let environment = Environment::around(DVec3::splat(-1.5), DVec3::splat(1.5), -0.025, DVec3::Y, view.eye());
        while self.fluids.len() < fluids.len() {
            self.fluids.push((self.fluids[0].0.sibling(device), Particles::none()));
        }
        for (fluid, (renderer, particles)) in fluids.iter().zip(&mut self.fluids) {
            renderer.gather(device, queue, encoder, &fluid.particles(), particles)?;
            let frame = Frame {
                particles,
                view,
                size,
                settings: fluid.settings,
                environment: &environment,
                scene: Scene { color: Some(&scene), depth: Some(&depth) },
            };
            renderer.prepare(device, queue, encoder, &frame)?;
        }

        let resolve = is_multisampled.then_some(&picture);
        let mut pass = begin(encoder, &color, resolve, LoadOp::Load, &depth, LoadOp::Load);
        for (renderer, _) in &self.fluids[..fluids.len()] {
            renderer.composite(&mut pass);
        }
        if self.options.has_glass {
            self.draw(&mut pass, &self.glass, &group, self.opaque_count..self.vertex_count);
        }
        drop(pass);
        if !is_multisampled {
            let size = images.color.size();
            encoder.copy_texture_to_texture(images.color.as_image_copy(), images.picture.as_image_copy(), size);
        }
        Ok(())
    }

    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipeline: &wgpu::RenderPipeline,
        camera: &wgpu::BindGroup,
        vertices: std::ops::Range<u32>,
    ) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, camera, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(vertices, 0..1);
    }

    fn camera(&self, device: &wgpu::Device, queue: &wgpu::Queue, view: &View) -> wgpu::BindGroup {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("camera"),
            size: size_of::<Mat4>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let clip_from_world = (view.clip_from_view * view.view_from_world).as_mat4();
        queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&clip_from_world));
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.opaque.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        })
    }
}

impl Fluid<'_> {
    fn particles(&self) -> ParticleBuffers<'_> {
        let column = |offset: usize| Column {
            buffer: self.buffer,
            offset: offset as u64,
            stride: size_of::<HostParticle>() as u64,
        };
        ParticleBuffers {
            origin: DVec3::ZERO,
            count: self.count,
            positions: column(std::mem::offset_of!(HostParticle, position)),
            radius: RadiusColumn::Each {
                column: column(std::mem::offset_of!(HostParticle, radius)),
                reference: self.radius,
                largest: self.radius,
            },
            density: None,
        }
    }
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    color: &wgpu::TextureView,
    resolve_target: Option<&wgpu::TextureView>,
    load_color: LoadOp<wgpu::Color>,
    depth: &wgpu::TextureView,
    load_depth: LoadOp<f32>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations { load: load_color, store: StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: load_depth, store: StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

/// Opaque things write depth; glass is blended and only tested against it.
fn pipeline(device: &wgpu::Device, target: &TargetFormat, is_opaque: bool) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("scene.wgsl"));
    let camera = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&camera)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 28,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x4],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: target.depth.map(|(format, compare)| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(is_opaque),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("color"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: target.color,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The corners of a quad's two triangles.
fn quad([a, b, c, d]: [[f32; 3]; 4], color: [f32; 4]) -> impl Iterator<Item = Vertex> {
    [a, b, c, a, c, d].into_iter().map(move |corner| (corner, color))
}

/// A floor, and a column that stands in the water.
fn scene_triangles() -> Vec<Vertex> {
    let floor = [[-4.0, -0.025, -4.0], [-4.0, -0.025, 4.0], [4.0, -0.025, 4.0], [4.0, -0.025, -4.0]];
    let corners = |y: f32| [[0.3, y, -0.3], [0.3, y, 0.3], [0.9, y, 0.3], [0.9, y, -0.3]];
    let (low, high) = (corners(-0.02), corners(1.6));
    let red = [0.75, 0.2, 0.1, 1.0];
    let sides = (0..4).flat_map(|k| quad([low[k], low[(k + 1) % 4], high[(k + 1) % 4], high[k]], red));
    quad(floor, [0.8, 0.8, 0.75, 1.0]).chain(sides).chain(quad(high, red)).collect()
}

/// A pane of green glass, upright and half in the water.
fn glass_triangles() -> impl Iterator<Item = Vertex> {
    quad([[-1.4, 0.0, 0.4], [-0.4, 0.0, -0.4], [-0.4, 1.5, -0.4], [-1.4, 1.5, 0.4]], [0.1, 0.8, 0.3, 0.5])
}
