//! The images of one frame, made anew when its size changes.

use crate::gpu::storage_buffer;
use crate::passes::{Segments, pyramid_texels, records_bytes, relations_bytes};
use crate::{Error, Scale, Settings};

/// `frame.wgsl`'s `BLOCK`.
const BLOCK_PX: u32 = 32;
const TILE_PX: u32 = 8;
/// `covered.wgsl`'s `TILE`, and how wide it is on its other levels.
const COVERED_TILES_PX: [u32; 4] = [4, 8, 16, 32];

/// Bytes per pixel of the largest image, `surface` or `shaded`.
const LARGEST_PIXEL: u64 = 16;

#[derive(Clone)]
pub(crate) struct Targets {
    /// The host's pixels.
    pub picture_size: [u32; 2],
    pub filter_scale: Scale,
    /// The fluid's own pixels: the size of all images below but `thickness` and `picture`.
    pub size: [u32; 2],
    pub thickness_scale: Scale,
    /// f32 nearness (frame.wgsl) after the splat.
    pub raw: wgpu::Buffer,
    /// u32 nearness bits per block, then per tile of each width, that all its pixels reach (`covered.wgsl`).
    pub covered: wgpu::Buffer,
    /// Indirect dispatch, count, indirect dispatch for four at a time ([`QUAD_GROUPS`]) and positions of the tiles that hold fluid.
    pub tiles: wgpu::Buffer,
    /// u32 for each tile: whether it is among them.
    pub occupied: wgpu::Buffer,
    /// f32 nearness, the filters' ping-pong.
    pub smooth: [wgpu::Buffer; 2],
    /// f32: smoothing length at each pixel, world units (`liquid_lengths.wgsl`, `breadth.wgsl`).
    pub smoothing_lengths: wgpu::Buffer,
    /// What curvature flow solves: rows, and columns.
    pub segments: [Segments; 2],
    pub thickness: ThicknessImages,
    /// vec4: view-space normal, thickness in world units. Before these, curvature flow's relations or records.
    pub surface: wgpu::Buffer,
    /// vec4: linear premultiplied colour.
    pub shaded: wgpu::Buffer,
    /// The same at the picture's resolution, where that is another.
    pub picture: Option<PictureImages>,
}

/// Where in [`Targets::tiles`] the indirect dispatch of one group for four tiles is, bytes.
pub(crate) const QUAD_GROUPS: u64 = 16;

/// Thickness of one view.
#[derive(Clone)]
pub(crate) struct ThicknessImages {
    /// Texels of the finest level and of the result.
    pub size: [u32; 2],
    /// u32 fixed-point sums, a pyramid.
    pub sums: wgpu::Buffer,
    /// u32: which levels hold something.
    pub levels_used: wgpu::Buffer,
    /// f32 thickness in world units: the first is the result. Negative: `hidden.wgsl`.
    pub images: [wgpu::Buffer; 2],
    /// Whether the frame has a scene's depth.
    pub in_scene: bool,
    pub occlusion: Occlusion,
}

/// What the host's scene hides of the liquid. Without a scene: stand-ins that nothing reads.
#[derive(Clone)]
pub(crate) struct Occlusion {
    /// Two f32 per texel of the pyramid: nearest and farthest depth of the scene (`scene_range.wgsl`).
    pub ranges: wgpu::Buffer,
    /// u32 fixed-point sums between the two, and a bit for liquid behind both.
    pub between: wgpu::Buffer,
    /// `hidden.wgsl`'s `Hidden` for each texel of the finest level.
    pub hidden: wgpu::Buffer,
}

impl ThicknessImages {
    /// `in_scene`: whether a scene may hide some of the liquid.
    pub fn new(device: &wgpu::Device, size: [u32; 2], in_scene: bool) -> Self {
        let texels = u64::from(size[0]) * u64::from(size[1]);
        let hideable = |count: u64| if in_scene { count } else { 0 };
        let image = |label, words: u64| storage_buffer(device, label, 4 * words);
        Self {
            size,
            sums: image("thickness sums", pyramid_texels(size)),
            levels_used: image("thickness levels used", 1),
            images: [image("thickness a", texels), image("thickness b", texels)],
            in_scene,
            occlusion: Occlusion {
                ranges: image("scene ranges", hideable(2 * pyramid_texels(size))),
                between: image("thickness between", hideable(pyramid_texels(size))),
                hidden: image("hidden thickness", hideable(2 * texels)),
            },
        }
    }
}

/// Images that only exist where the fluid's resolution is not the picture's.
#[derive(Clone)]
pub(crate) struct PictureImages {
    pub raw: wgpu::Buffer,
    pub nearness: wgpu::Buffer,
    pub surface: wgpu::Buffer,
    pub shaded: wgpu::Buffer,
}

/// The images that a frame ends in.
#[derive(Clone, Copy)]
pub(crate) struct FluidImages<'a> {
    pub raw: &'a wgpu::Buffer,
    pub nearness: &'a wgpu::Buffer,
    pub surface: &'a wgpu::Buffer,
    pub shaded: &'a wgpu::Buffer,
}

impl Targets {
    pub fn new(
        device: &wgpu::Device,
        picture_size: [u32; 2],
        filter_scale: Scale,
        thickness_scale: Scale,
        in_scene: bool,
    ) -> Result<Self, Error> {
        let limits = device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let [width, height] = picture_size;
        let picture_pixels = u64::from(width) * u64::from(height);
        let most = limit / LARGEST_PIXEL;
        if picture_pixels == 0 || picture_pixels > most || width.max(height) > TILE_PX * 65_535 {
            return Err(Error::Size { width, height, most });
        }
        let size = filter_scale.of(picture_size);
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let image = |label, bytes| storage_buffer(device, label, bytes);
        // Without them the flow goes by segments.
        let records = Some(records_bytes(size)).filter(|bytes| *bytes <= limit).unwrap_or(0);
        Ok(Self {
            picture_size,
            filter_scale,
            size,
            thickness_scale,
            raw: image("raw nearness", 4 * pixels),
            covered: image("covered blocks", 4 * covered_words(size)),
            tiles: image("tiles", 28 + 4 * cells(size, TILE_PX)),
            occupied: image("occupied tiles", 4 * cells(size, TILE_PX)),
            smooth: [image("nearness a", 4 * pixels), image("nearness b", 4 * pixels)],
            smoothing_lengths: image("smoothing lengths", 4 * pixels),
            segments: [Segments::new(device, size[1], size[0]), Segments::new(device, size[0], size[1])],
            thickness: ThicknessImages::new(device, thickness_scale.of(picture_size), in_scene),
            surface: image("surface", (16 * pixels).max(relations_bytes(size)).max(records)),
            shaded: image("shaded", 16 * pixels),
            picture: (filter_scale != Scale::Full).then(|| PictureImages {
                raw: image("picture raw nearness", 4 * picture_pixels),
                nearness: image("picture nearness", 4 * picture_pixels),
                surface: image("picture surface", 16 * picture_pixels),
                shaded: image("picture shaded", 16 * picture_pixels),
            }),
        })
    }

    /// Whether these serve a frame of that size and those settings, with or without a scene's depth.
    pub fn fit(&self, picture_size: [u32; 2], settings: &Settings, in_scene: bool) -> bool {
        self.picture_size == picture_size
            && self.filter_scale == settings.filter_scale
            && self.thickness_scale == settings.thickness_scale
            && self.thickness.in_scene == in_scene
    }

    /// What the particles leave behind, with the words of each that count: all that later passes know of them.
    pub fn splatted(&self) -> [(&wgpu::Buffer, usize); 5] {
        let Self { raw, covered, thickness, .. } = self;
        let pixels = self.size[0] as usize * self.size[1] as usize;
        let texels = pyramid_texels(thickness.size) as usize;
        [
            (raw, pixels),
            // Tiles are noted from stage to stage; only blocks say what no pixel does.
            (covered, cells(self.size, BLOCK_PX) as usize),
            (&thickness.sums, texels),
            (&thickness.levels_used, 1),
            (&thickness.occlusion.between, if self.thickness.in_scene { texels } else { 0 }),
        ]
    }

    /// The smallest tiles of `covered.wgsl`.
    pub fn covered_tile_count(&self) -> u64 {
        cells(self.size, COVERED_TILES_PX[0])
    }

    /// Its widest.
    pub fn widest_covered_tile_count(&self) -> u64 {
        cells(self.size, COVERED_TILES_PX[COVERED_TILES_PX.len() - 1])
    }

    /// Tiles that cover the fluid's images.
    pub fn tile_count(&self) -> u64 {
        cells(self.size, TILE_PX)
    }
}

/// Words of `covered.wgsl`'s list.
fn covered_words(size: [u32; 2]) -> u64 {
    cells(size, BLOCK_PX) + COVERED_TILES_PX.map(|px| cells(size, px)).iter().sum::<u64>()
}

/// Squares of `px` pixels that cover an image.
fn cells(size: [u32; 2], px: u32) -> u64 {
    u64::from(size[0].div_ceil(px)) * u64::from(size[1].div_ceil(px))
}
