//! A picture in the window, by a triangle of its own (`screen.wgsl`): egui's shader does far more for each pixel, and CPU drivers
//! run all of it, whether it is asked for or not.

use eframe::egui::{self, Rect};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState, Renderer, wgpu};
use limpid_headless::Painter;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// One picture's place in the window.
pub struct Screen {
    number: u64,
    target: wgpu::TextureFormat,
    renderer: Arc<egui::mutex::RwLock<Renderer>>,
}

/// It lies with egui's renderer, since what egui is handed to draw must be able to go to other threads, which handles of a page
/// cannot.
#[derive(Default)]
struct Shown {
    /// For opaque pictures and for transparent ones, all screens'.
    pipelines: [Option<wgpu::RenderPipeline>; 2],
    /// By the number of the screen.
    pictures: HashMap<u64, (wgpu::RenderPipeline, wgpu::BindGroup)>,
}

impl Screen {
    /// An empty one.
    pub fn new(gpu: &RenderState) -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        Self {
            number: COUNT.fetch_add(1, Ordering::Relaxed),
            target: gpu.target_format,
            renderer: Arc::clone(&gpu.renderer),
        }
    }

    /// Shows another of [`Painter::shown`]'s textures from now on.
    pub fn show(&self, device: &wgpu::Device, picture: &wgpu::Texture, is_transparent: bool) {
        let mut renderer = self.renderer.write();
        let shown: &mut Shown = renderer.callback_resources.entry().or_insert_with(Shown::default);
        let pipeline = shown.pipelines[usize::from(is_transparent)]
            .get_or_insert_with(|| pipeline(device, self.target, is_transparent));
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&raw_view(picture)) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        shown.pictures.insert(self.number, (pipeline.clone(), group));
    }

    /// The picture as egui draws it; nothing before the first [`Self::show`].
    pub fn shape(&self, place: Rect) -> egui::PaintCallback {
        Callback::new_paint_callback(place, Sheet(self.number))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if let Some(shown) = self.renderer.write().callback_resources.get_mut::<Shown>() {
            shown.pictures.remove(&self.number);
        }
    }
}

fn pipeline(device: &wgpu::Device, target: wgpu::TextureFormat, is_transparent: bool) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("screen.wgsl"));
    let constants = [("is_transparent", is_transparent), ("encodes", target.is_srgb())];
    let constants = constants.map(|(name, holds)| (name, f64::from(u8::from(holds))));
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("screen"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("whole"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("show"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: &[Some(wgpu::ColorTargetState {
                format: target,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The bytes as they are: what windows and pages show is encoded for the screen too.
pub fn raw_view(picture: &wgpu::Texture) -> wgpu::TextureView {
    picture.create_view(&wgpu::TextureViewDescriptor {
        format: Some(Painter::SHOWN_RAW),
        usage: Some(wgpu::TextureUsages::TEXTURE_BINDING),
        ..Default::default()
    })
}

/// The number of a screen.
struct Sheet(u64);

impl CallbackTrait for Sheet {
    fn paint(&self, _: egui::PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        let shown = resources.get::<Shown>().and_then(|shown| shown.pictures.get(&self.0));
        let Some((pipeline, group)) = shown else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}
