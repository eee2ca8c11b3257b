//! The face of limpid for other pages: particles from an array, drawn on a canvas.

use limpid_headless::{Painter, device_descriptor};
use limpid_io::ParticleSet;
use limpid_shot::{FrameParticles, Options, Paints, Props, Size, Stage, Survey, config};
use std::sync::{Arc, Mutex, PoisonError};
use wasm_bindgen::prelude::*;

/// A fluid on a canvas: create, give it particles, draw.
#[wasm_bindgen]
pub struct Fluid {
    canvas: web_sys::HtmlCanvasElement,
    surface: wgpu::Surface<'static>,
    device: wgpu::Device,
    queue: wgpu::Queue,
    painter: Painter,
    blitter: wgpu::util::TextureBlitter,
    format: wgpu::TextureFormat,
    options: Options,
    particles: Option<(Arc<ParticleSet>, Survey)>,
    failure: Arc<Failure>,
    size: [u32; 2],
}

/// What the device has said since it was last asked.
#[derive(Default)]
struct Failure(Mutex<Option<(String, IsFinal)>>);

/// Whether the device is gone.
type IsFinal = bool;

impl Failure {
    fn watch(self: &Arc<Self>, device: &wgpu::Device) {
        let (refused, lost) = (Arc::clone(self), Arc::clone(self));
        device.on_uncaptured_error(Arc::new(move |error| refused.note(format!("the device refuses: {error}"), false)));
        device.set_device_lost_callback(move |_, reason| {
            let reason = reason.trim().trim_end_matches('.');
            lost.note(format!("the graphics device was lost ({reason}): create the fluid anew"), true);
        });
    }

    fn note(&self, text: String, is_final: IsFinal) {
        let mut noted = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !noted.as_ref().is_some_and(|(_, is_final)| *is_final) {
            *noted = Some((text, is_final));
        }
    }

    fn check(&self) -> Result<(), JsError> {
        let mut noted = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let Some((text, is_final)) = noted.take() else { return Ok(()) };
        let error = JsError::new(&text);
        if is_final {
            *noted = Some((text, is_final));
        }
        Err(error)
    }
}

#[wasm_bindgen]
impl Fluid {
    /// Opens a WebGPU device for a canvas. Rejects where the browser has none.
    pub async fn create(canvas: web_sys::HtmlCanvasElement) -> Result<Fluid, JsError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::BROWSER_WEBGPU;
        let instance = wgpu::Instance::new(descriptor);
        let surface = instance.create_surface(wgpu::SurfaceTarget::Canvas(canvas.clone()))?;
        let request = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = instance.request_adapter(&request).await?;
        let (device, queue) = adapter.request_device(&device_descriptor(&adapter)).await?;
        let capabilities = surface.get_capabilities(&adapter);
        let format = capabilities.formats.first().copied().ok_or_else(|| JsError::new("the canvas has no format"))?;
        let painter = Painter::new(&device, &queue);
        let blitter = wgpu::util::TextureBlitter::new(&device, format);
        let options = Options::defaults();
        let (particles, size, failure) = (None, [0; 2], Arc::<Failure>::default());
        failure.watch(&device);
        Ok(Self { canvas, surface, device, queue, painter, blitter, format, options, particles, failure, size })
    }

    /// The particles: x, y, z of each in world units, and the radius of all (half their spacing at rest); without it, it is
    /// estimated. Fails for numbers that are not finite, or not three for each.
    #[wasm_bindgen(js_name = setParticles)]
    pub fn set_particles(&mut self, positions: &[f32], radius: Option<f64>) -> Result<(), JsError> {
        let (triples, []) = positions.as_chunks() else {
            let count = positions.len();
            return Err(JsError::new(&format!(
                "positions are x, y, z of each particle: {count} numbers are no multiple of 3"
            )));
        };
        let bytes = pos_file(triples, radius);
        let set = Arc::new(limpid_io::read_bytes(std::path::Path::new("particles.pos"), bytes.into())?);
        let survey = Survey::of(&set, &Options::default());
        self.particles = Some((set, survey));
        Ok(())
    }

    /// Where the camera is and what it looks at, world units; without one, it frames the fluid.
    #[wasm_bindgen(js_name = setCamera)]
    pub fn set_camera(&mut self, eye: &[f64], target: &[f64]) -> Result<(), JsError> {
        let triple = |v: &[f64]| <[f64; 3]>::try_from(v).map_err(|_| JsError::new("eye and target are three numbers"));
        let layer =
            Options { camera_eye: Some(triple(eye)?), camera_target: Some(triple(target)?), ..Options::default() };
        self.options = config::change(&self.options, &layer)?;
        Ok(())
    }

    /// Changes settings: TOML with the keys of `limpid render --config`, over those so far.
    pub fn set(&mut self, toml: &str) -> Result<(), JsError> {
        let layer = config::parse(toml).map_err(|problem| JsError::new(&problem))?;
        self.options = config::change(&self.options, &layer)?;
        Ok(())
    }

    /// Draws on the canvas, in as many pixels as it has (its attributes width and height). Fails where the picture cannot be
    /// drawn, what the device refused of an earlier one, and always after the device was lost: then create another fluid.
    pub fn draw(&mut self) -> Result<(), JsError> {
        self.failure.check()?;
        let Some((set, survey)) = &mut self.particles else { return Ok(()) };
        let size = [self.canvas.width().max(1), self.canvas.height().max(1)];
        if self.size != size {
            self.surface.configure(
                &self.device,
                &wgpu::SurfaceConfiguration {
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                    format: self.format,
                    color_space: Default::default(),
                    width: size[0],
                    height: size[1],
                    present_mode: wgpu::PresentMode::AutoVsync,
                    desired_maximum_frame_latency: 2,
                    alpha_mode: wgpu::CompositeAlphaMode::Auto,
                    view_formats: Vec::new(),
                },
            );
            self.size = size;
        }
        let options = Options { size: Some(Size(size)), ..self.options.clone() };
        survey.settle(&options)?;
        let stage = Stage::of(&options, survey, &Props::default())?;
        let paints = Paints::of(&options, survey)?;
        let frame = FrameParticles::of(Arc::clone(set), survey, &paints)?;
        let shot = stage.shot(&options, &frame, &[]);
        let particles = Painter::upload(&self.device, &self.queue, &shot)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.painter.draw(&self.device, &self.queue, &mut encoder, &shot, &particles)?;
        let target = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(target) | wgpu::CurrentSurfaceTexture::Suboptimal(target) => target,
            _ => return Err(JsError::new("the canvas cannot be drawn on now: draw again at the next animation frame")),
        };
        if let Some(shown) = self.painter.shown() {
            let to = target.texture.create_view(&Default::default());
            self.blitter.copy(&self.device, &mut encoder, &crate::screen::raw_view(shown), &to);
        }
        self.queue.submit([encoder.finish()]);
        self.queue.present(target);
        Ok(())
    }
}

/// As limpid's own readers have them: the checks are theirs.
fn pos_file(positions: &[[f32; 3]], radius: Option<f64>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 + 12 * positions.len());
    bytes.extend((positions.len() as u32).to_le_bytes());
    bytes.extend((radius.unwrap_or(0.0) as f32).to_le_bytes());
    bytes.extend(positions.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}
