// What every kernel knows of the frame: the camera, the settings, and the image conventions. Bind group 0.
// "Pixels" are those of the fluid's own images, which may be coarser than the host's picture.
//
// Rays: the point at view depth z seen through pixel position px (pixel centres at +0.5) is origin + z direction, with
// direction.z = -1: the ray's parameter is the depth, in perspective and in orthographic views alike.
//
// Nearness: depth images hold 1 / depth (perspective) or 1 - depth / far (orthographic), and 0 where there is no fluid.
// Like a reversed depth buffer it is affine in the pixel on any plane, so that filters and differences leave planes exact;
// a cleared buffer is empty; the nearest wins by atomicMax on the bits, since all values are positive floats.

struct View {
    view_from_local: mat4x4f,
    world_from_view: mat4x4f,
    px_zero: vec2f,
    px_step: vec2f,
    depth_row: vec4f, // of clip_from_view: (z of z, z of w, w of z, w of w)
    size: vec2u,
    near: f32,
    far: f32, // 0 in perspective
}

struct Settings {
    radius: f32, // r, world units
    splat_scale: f32,
    density_threshold: f32,
    thickness_unit: f32, // world units of one count of the thickness sums
    thickness_size: vec2u, // texels of the finest level
    thickness_levels: u32,
    thickness_divisor: f32, // pixels along a texel of the finest level
    strength: f32, // smoothing length of one iteration where balls are ellipsoids, r
    sphere_strength: f32, // and where they are spheres
    ellipsoid_px: f32, // radius in the host's pixels up to which they are
    max_radius_px: f32,
    range: f32, // r
    clamp: f32, // r
    normal_step: f32, // r
    min_thickness: f32, // r
    has_scene_depth: u32,
    background: u32, // shade.wgsl's BACKGROUND_*
    picture_size: vec2u, // the host's pixels
    fluid_scale: f32, // of them along a pixel of the fluid's images
    shading: u32, // shade.wgsl's SHADING_*
    fixed_thickness: f32, // world units; 0: the fluid's own
    layers_px: u32, // pixels of the fluid's images along a texel of the layers' (layers.wgsl)
    own_lengths: u32, // whether each pixel has a smoothing length of its own (lengths.wgsl)
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> settings: Settings;

// Pixels along a block of the picture that the depth splat can skip as a whole.
const BLOCK: i32 = 32;

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

fn is_perspective() -> bool {
    return view.far == 0.0;
}

// What the rays of all pixels have in common. Loops take it before they begin: CPU drivers ask a uniform anew, with a check of
// its bounds, wherever it is named.
struct Rays {
    zero: vec2f,
    step: vec2f,
    is_perspective: bool,
}

fn pixel_rays() -> Rays {
    return Rays(view.px_zero, view.px_step, is_perspective());
}

fn ray_at(rays: Rays, px: vec2f) -> Ray {
    let at = rays.zero + px * rays.step;
    // No branch: to CPU drivers it is dear, whichever way it goes.
    let origin = select(at, vec2f(0.0), rays.is_perspective);
    let slope = select(vec2f(0.0), at, rays.is_perspective);
    return Ray(vec3f(origin, 0.0), vec3f(slope, -1.0));
}

fn pixel_ray(px: vec2f) -> Ray {
    return ray_at(pixel_rays(), px);
}

fn nearness_of(depth: f32) -> f32 {
    return select(1.0 - depth / view.far, 1.0 / depth, is_perspective());
}

fn depth_of(nearness: f32) -> f32 {
    return select((1.0 - nearness) * view.far, 1.0 / nearness, is_perspective());
}

// Depth per nearness at a surface, positive: (a - b) * depth_slope(a) is the step in depth from a to b, taken along the
// tangent, so that it is exact to first order and averages to 0 over a plane.
fn depth_slope(nearness: f32) -> f32 {
    return select(view.far, 1.0 / (nearness * nearness), is_perspective());
}

// Pixels that a world length covers at this depth, across the view.
fn px_per_world(depth: f32) -> f32 {
    return -1.0 / (view.px_step.y * select(1.0, depth, is_perspective()));
}

// How much of a ball's stretch is drawn at this depth, 0 to 1: what is about a pixel wide has no shape to see.
fn stretch_share(radius: f32, depth: f32) -> f32 {
    let radius_px = radius * px_per_world(max(depth, view.near)) * settings.fluid_scale;
    return clamp(3.0 * (radius_px / max(settings.ellipsoid_px, 1e-9) - 1.0), 0.0, 1.0);
}

// The standard deviation of one iteration of the filter at this depth, world units.
fn smoothing_length(depth: f32) -> f32 {
    return settings.radius * mix(settings.sphere_strength, settings.strength, stretch_share(settings.radius, depth));
}

// View depth of a value in the host's depth buffer; infinite where that buffer is at an infinite far plane.
fn depth_from_host(device_depth: f32) -> f32 {
    let row = view.depth_row;
    return (row.y - device_depth * row.w) / (row.x - device_depth * row.z);
}

// What the host's depth buffer holds for a view depth.
fn host_from_depth(depth: f32) -> f32 {
    let row = view.depth_row;
    return (row.y - depth * row.x) / (row.w - depth * row.z);
}

// Whether farther things have the larger value in it.
fn host_depth_grows() -> bool {
    return host_from_depth(2.0 * view.near) > host_from_depth(view.near);
}

// Work items beyond 65,535 groups fill a second dimension.
fn item_index(group: vec3u, groups: vec3u, lane: u32, lanes: u32) -> u32 {
    return (group.y * groups.x + group.x) * lanes + lane;
}
