//! A picture in the window, by a triangle of its own (`screen.wgsl`): egui's shader does far more for each pixel, and CPU drivers
//! run all of it, whether it is asked for or not.

use eframe::egui::{self, Rect};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState, Renderer, wgpu};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// One picture's place in the window.
pub struct Screen {
    number: u64,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    renderer: Arc<egui::mutex::RwLock<Renderer>>,
}

/// What is shown, by the number of its screen. It lies with egui's renderer, since what egui is handed to draw must be able to go to
/// other threads, which handles of a page cannot.
#[derive(Default)]
struct Shown(HashMap<u64, (wgpu::RenderPipeline, wgpu::BindGroup)>);

impl Screen {
    /// Builds the pipeline.
    pub fn new(gpu: &RenderState) -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::include_wgsl!("screen.wgsl"));
        // What is shown is encoded for the screen; a target that encodes by itself wants light.
        let entry_point = if gpu.target_format.is_srgb() { "show_light" } else { "show" };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
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
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: gpu.target_format,
                    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self {
            number: COUNT.fetch_add(1, Ordering::Relaxed),
            layout: pipeline.get_bind_group_layout(0),
            pipeline,
            sampler,
            renderer: Arc::clone(&gpu.renderer),
        }
    }

    /// Shows another texture from now on: encoded for the screen, premultiplied.
    pub fn show(&self, device: &wgpu::Device, texture: &wgpu::TextureView) {
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(texture) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        let mut renderer = self.renderer.write();
        let shown: &mut Shown = renderer.callback_resources.entry().or_insert_with(Shown::default);
        shown.0.insert(self.number, (self.pipeline.clone(), group));
    }

    /// The picture as egui draws it; nothing before the first [`Self::show`].
    pub fn shape(&self, place: Rect) -> egui::PaintCallback {
        Callback::new_paint_callback(place, Sheet(self.number))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if let Some(shown) = self.renderer.write().callback_resources.get_mut::<Shown>() {
            shown.0.remove(&self.number);
        }
    }
}

/// The number of a screen.
struct Sheet(u64);

impl CallbackTrait for Sheet {
    fn paint(&self, _: egui::PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        let Some((pipeline, group)) = resources.get::<Shown>().and_then(|shown| shown.0.get(&self.0)) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}
