//! What is behind the front surface: the back of the first sheet of liquid, and the next sheet beyond the air (`sheets.wgsl`,
//! `layers.wgsl`).

use super::{Normals, SceneViews, Shade, Smooth, Tiles, With, ellipsoids_constant, module};
use crate::gpu::{Grid, Kernel, Recorder, Slot, bind, storage_buffer, uniform_buffer};
use crate::renderer::{Frame, Nothing, SettingsUniform, settings_uniform};
use crate::targets::Targets;
use crate::view::ViewUniform;
use crate::{Error, Filter, Scale, Settings, Smoothing};

/// `sheets.wgsl`'s `WORDS` and `SHEET_WORDS`.
const SLICE_WORDS: u64 = 4;
const SHEET_WORDS: u64 = 4;
/// Of a texel in `layers.wgsl`.
const LAYERS_BYTES: u64 = 48;

/// The renderer's passes, lent for the sheets behind the front.
pub(crate) struct FluidPasses<'a> {
    pub tiles: &'a Tiles,
    pub smooth: &'a Smooth,
    pub normals: &'a Normals,
    pub shade: &'a Shade,
    /// Stand-in for sums of paint: sheets beyond the first have the particles' mean.
    pub no_paint: &'a wgpu::Buffer,
    pub nothing: &'a Nothing,
    pub scene: &'a SceneViews<'a>,
    /// What the lights see.
    pub shadow: &'a wgpu::Buffer,
}

/// The layers and their images.
pub(crate) struct Layers {
    kernels: Kernels,
    images: Option<Images>,
}

#[derive(Clone)]
struct Kernels {
    view: wgpu::Buffer,
    /// Settings of what is beyond the air, and of the back of the first sheet.
    beyond: LayerFrame,
    back: LayerFrame,
    take_fronts: Kernel,
    mark: Kernel,
    find_gaps: Kernel,
    split: Kernel,
    give_sheets: Kernel,
    pack: Kernel,
    pack_color: Kernel,
}

/// What the kernels of one layer see as the frame.
#[derive(Clone)]
struct LayerFrame {
    settings: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl LayerFrame {
    fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout, view: &wgpu::Buffer) -> Self {
        let settings = uniform_buffer::<SettingsUniform>(device, "layer settings");
        let group = bind(device, frame, &[view.as_entire_binding(), settings.as_entire_binding()]);
        Self { settings, group }
    }
}

/// The images of one size.
struct Images {
    back: Targets,
    beyond: Targets,
    fronts: wgpu::Buffer,
    slices: wgpu::Buffer,
    gaps: wgpu::Buffer,
    sheets: wgpu::Buffer,
    /// The result: `layers.wgsl`'s.
    layers: wgpu::Buffer,
}

impl Images {
    fn new(device: &wgpu::Device, picture_size: [u32; 2], scale: Scale) -> Result<Self, Error> {
        let targets = || Targets::new(device, picture_size, scale, Scale::Quarter, false);
        let back = targets()?;
        let texels = u64::from(back.size[0]) * u64::from(back.size[1]);
        Ok(Self {
            beyond: targets()?,
            back,
            fronts: storage_buffer(device, "fronts", 4 * texels),
            slices: storage_buffer(device, "slices", 4 * SLICE_WORDS * texels),
            gaps: storage_buffer(device, "gaps", 4 * texels),
            sheets: storage_buffer(device, "sheets", 4 * SHEET_WORDS * texels),
            layers: storage_buffer(device, "layers", LAYERS_BYTES * texels),
        })
    }

    fn fit(&self, picture_size: [u32; 2], scale: Scale) -> bool {
        self.back.picture_size == picture_size && self.back.filter_scale == scale
    }
}

impl Layers {
    pub fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        Self { kernels: Kernels::new(device, frame), images: None }
    }

    /// The same kernels for another renderer, with images of its own.
    pub fn sibling(&self) -> Self {
        Self { kernels: self.kernels.clone(), images: None }
    }

    /// Makes the images of a frame.
    ///
    /// # Errors
    /// A size that the device cannot hold.
    pub fn reserve(&mut self, device: &wgpu::Device, picture_size: [u32; 2], scale: Scale) -> Result<(), Error> {
        self.images = match self.images.take().filter(|images| images.fit(picture_size, scale)) {
            Some(images) => Some(images),
            None => Some(Images::new(device, picture_size, scale)?),
        };
        Ok(())
    }

    /// The result of the last frame with its size.
    pub fn buffer(&self) -> Option<([u32; 2], &wgpu::Buffer)> {
        self.images.as_ref().map(|images| (images.back.size, &images.layers))
    }

    /// Records the layers behind `front`, the smoothed nearness in the frame's own targets, whose surface is done. None
    /// where no images are reserved.
    pub fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        queue: &wgpu::Queue,
        frame: &Frame<'_>,
        passes: &FluidPasses<'_>,
        (front, targets): (&wgpu::Buffer, &Targets),
    ) -> Option<&wgpu::Buffer> {
        let images = self.images.as_ref()?;
        self.kernels.write(recorder, queue, frame, targets);
        self.kernels.encode(recorder, frame, passes, (front, targets), images);
        Some(&images.layers)
    }
}

impl Kernels {
    fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let balls = module!(
            "sheets",
            "../frame.wgsl",
            "shape.wgsl",
            "../ball.wgsl",
            "balls.wgsl",
            "slices.wgsl",
            "sheets.wgsl"
        );
        let images =
            module!("sheets' images", "../frame.wgsl", "layers_texel.wgsl", "slices.wgsl", "sheets_images.wgsl");
        let pack = module!("layers", "../frame.wgsl", "layers_texel.wgsl", "layers_pack.wgsl");
        let color = module!("layers' colour", "../frame.wgsl", "layers_color.wgsl");
        let [read, write] = [Slot::Read, Slot::Write];
        let of_balls = [read, read, read, read, write, read, write];
        let of_images = [read, write, read, write, read, write, write];
        let of_pack = [read, read, read, write, read, read, read, write];
        let splat =
            |entry| Kernel::with_constants(device, frame, &balls, entry, &of_balls, &[ellipsoids_constant(false)]);
        let image = |entry| Kernel::new(device, frame, &images, entry, &of_images);
        let view = uniform_buffer::<ViewUniform>(device, "layers' view");
        Self {
            beyond: LayerFrame::new(device, frame, &view),
            back: LayerFrame::new(device, frame, &view),
            take_fronts: image("take_fronts"),
            mark: splat("mark"),
            find_gaps: image("find_gaps"),
            split: splat("split"),
            give_sheets: image("give_sheets"),
            pack: Kernel::new(device, frame, &pack, "pack", &of_pack),
            pack_color: Kernel::new(device, frame, &color, "pack_color", &[read, write]),
            view,
        }
    }

    fn encode(
        &self,
        recorder: &mut Recorder<'_>,
        frame: &Frame<'_>,
        passes: &FluidPasses<'_>,
        (front, targets): (&wgpu::Buffer, &Targets),
        images: &Images,
    ) {
        let size = images.back.size;
        self.find_sheets(&mut recorder.in_frame(&self.beyond.group), frame, front, images);

        // Its own Gaussian: a filter that keeps edges would take the back for a front.
        let recorder_back = &mut recorder.in_frame(&self.back.group);
        passes.tiles.encode(recorder_back, &images.back);
        let back = passes.smooth.encode(recorder_back, &back_smoothing(frame.settings), &images.back);
        passes.normals.encode(recorder_back, back, &passes.nothing.depth, &images.back);

        let recorder = &mut recorder.in_frame(&self.beyond.group);
        passes.tiles.encode(recorder, &images.beyond);
        let beyond = passes.smooth.encode(recorder, &frame.settings.smoothing, &images.beyond);
        passes.normals.encode(recorder, beyond, passes.scene.depth, &images.beyond);
        let resources = [
            &targets.surface,
            &images.fronts,
            &images.sheets,
            &images.beyond.surface,
            back,
            &images.back.surface,
            beyond,
            &images.layers,
        ];
        recorder.run("layers", &self.pack, &resources.map(wgpu::Buffer::as_entire_binding), &Grid::Image(size));
        let alone = With::default();
        passes.shade.encode(recorder, beyond, passes.scene, passes.shadow, passes.no_paint, &alone, &images.beyond);
        let resources = [&images.beyond.shaded, &images.layers].map(wgpu::Buffer::as_entire_binding);
        recorder.run("layers", &self.pack_color, &resources, &Grid::Image(size));
    }

    fn write(&self, recorder: &mut Recorder<'_>, queue: &wgpu::Queue, frame: &Frame<'_>, targets: &Targets) {
        let scale = frame.settings.layers_scale();
        let view = frame.view.uniform(frame.size, scale, frame.particles.origin);
        recorder.write(queue, &self.view, &view);
        let own = settings_uniform(frame, targets);
        let spheres = SettingsUniform {
            fluid_scale: scale.divisor() as f32,
            // They are not stretched here.
            strength: own.sphere_strength,
            max_radius_px: frame.settings.smoothing.max_radius_px as f32 / scale.divisor() as f32,
            own_lengths: 0,
            ..own
        };
        recorder.write(queue, &self.beyond.settings, &spheres);
        let strength = back_smoothing(frame.settings).strength;
        let back = SettingsUniform { strength, sphere_strength: strength, has_scene_depth: 0, ..spheres };
        recorder.write(queue, &self.back.settings, &back);
    }

    /// From particles to `images.back.raw` and `images.beyond.raw`.
    fn find_sheets(&self, recorder: &mut Recorder<'_>, frame: &Frame<'_>, front: &wgpu::Buffer, images: &Images) {
        let size = images.back.size;
        let Images { fronts, slices, gaps, sheets, .. } = images;
        let of_images = [front, fronts, slices, gaps, sheets, &images.back.raw, &images.beyond.raw];
        let of_images = of_images.map(wgpu::Buffer::as_entire_binding);
        for buffer in [slices, sheets, &images.back.covered, &images.beyond.covered] {
            recorder.clear(buffer);
        }
        let splat = |recorder: &mut Recorder<'_>, kernel| {
            for chunk in &frame.particles.chunks {
                let [positions, densities, shapes] = chunk.bindings();
                let [fronts, slices, gaps, sheets] =
                    [fronts, slices, gaps, sheets].map(wgpu::Buffer::as_entire_binding);
                let resources = [positions, densities, shapes, fronts, slices, gaps, sheets];
                recorder.run("layers", kernel, &resources, &Grid::Items(chunk.count, 64));
            }
        };
        recorder.run("layers", &self.take_fronts, &of_images, &Grid::Image(size));
        splat(recorder, &self.mark);
        recorder.run("layers", &self.find_gaps, &of_images, &Grid::Image(size));
        splat(recorder, &self.split);
        recorder.run("layers", &self.give_sheets, &of_images, &Grid::Image(size));
    }
}

/// How the back of the first sheet is smoothed, in r: a lens makes much of every bump, but drops must stay round.
const BACK_STRENGTH: f32 = 1.9;

fn back_smoothing(settings: &Settings) -> Smoothing {
    let Smoothing { filter, max_radius_px, .. } = settings.smoothing;
    let filter = if filter == Filter::None { filter } else { Filter::Gaussian };
    Smoothing { max_radius_px, strength: BACK_STRENGTH, ..Smoothing::of(filter) }
}
