// Shading after van der Laan 2009, Eq. 13-15: what is behind the fluid, refracted and absorbed; what is around it,
// reflected; the sun's highlight; what the body scatters. Linear light in, linear premultiplied colour out.
// interface.wgsl has what surfaces do, body.wgsl what the liquid between them does; through.wgsl or no_layers.wgsl what is behind, lamps.wgsl
// or no_lamps.wgsl what lights beside the sun add.

@group(1) @binding(1) var<uniform> liquids: Liquids;
@group(1) @binding(2) var<uniform> environment: Environment;
@group(1) @binding(3) var<storage, read> nearness: array<f32>;
@group(1) @binding(4) var<storage, read> surface: array<vec4f>;
@group(1) @binding(5) var<storage, read_write> shaded: array<vec4f>;
@group(1) @binding(6) var scene_color: texture_2d<f32>;
@group(1) @binding(7) var scene_depth: texture_depth_2d;
@group(1) @binding(8) var<storage, read> shadow: array<f32>;
@group(1) @binding(9) var environment_map: texture_2d<f32>;
@group(1) @binding(10) var<storage, read> layers: array<vec4f>; // layers.wgsl's, or unused

@group(1) @binding(11) var<storage, read> paint_sums: array<u32>;
@group(1) @binding(12) var<storage, read> droplet_sums: array<u32>; // droplets_image.wgsl's, or unused
@group(1) @binding(13) var<uniform> droplets: Droplets; // or unused

// Whether there are droplets in the liquid or behind it.
override DROPLETS: bool = false;

@group(1) @binding(14) var<uniform> detail: Detail; // or unused

// Whether there is foam: its opacity is the first word of each pixel of `shaded`.
override FOAM: bool = false;

// The liquid of this invocation's pixel.
var<private> optics: Optics;

const BACKGROUND_NONE: u32 = 0u;
// What is computed: settings.rs's `Shading`.
const SHADING_TRANSMITTANCE: u32 = 1u;
const SHADING_ALBEDO: u32 = 2u;
const SHADING_LIQUIDS: u32 = 3u;
// Brightness of the sun's mirror image, over that of a white wall in the sun.
const GLINT: f32 = 4.0;

// A place on the fluid's surface and how it is looked at.
struct Sight {
    px: vec2f,
    depth: f32,
    position: vec3f, // view space
    toward: vec3f, // unit, away from the eye
    normal: vec3f, // unit, towards the eye
    thickness: f32, // of the liquid behind it, world units
    is_submerged: bool, // the eye is inside the liquid: the near plane cuts it open here, and there is no surface
}

fn world_from_view() -> mat3x3f {
    return mat3x3f(view.world_from_view[0].xyz, view.world_from_view[1].xyz, view.world_from_view[2].xyz);
}

fn sight_at(px: vec2f, depth: f32, normal_thickness: vec4f) -> Sight {
    let ray = pixel_ray(px);
    let position = ray.origin + depth * ray.direction;
    let is_submerged = depth <= 1.0005 * view.near;
    return Sight(px, depth, position, normalize(ray.direction), normal_thickness.xyz, normal_thickness.w, is_submerged);
}

// Where a place is seen, in pixels.
fn px_of(place: vec3f) -> vec2f {
    let slope = select(place.xy, place.xy / -place.z, is_perspective());
    return (slope - view.px_zero) / view.px_step;
}

// The scene through a pixel position, bilinear by hand: works for every float format, filterable or not. Texels that lie in
// front of the fluid have no say.
fn scene_color_behind(px: vec2f, depth: f32) -> vec4f {
    let last = vec2i(textureDimensions(scene_color)) - 1;
    let at = clamp(px * settings.fluid_scale - 0.5, vec2f(0.0), vec2f(last));
    let low = vec2i(at);
    let part = at - floor(at);
    // No loop: to CPU drivers it is dear.
    let high = min(low + 1, last);
    let right = vec2i(high.x, low.y);
    let below = vec2i(low.x, high.y);
    let is_behind = vec4<bool>(
        is_scene_behind(low, depth),
        is_scene_behind(right, depth),
        is_scene_behind(below, depth),
        is_scene_behind(high, depth)
    );
    let bilinear = vec4f(1.0 - part.x, part.x, 1.0 - part.x, part.x) * vec4f(vec2f(1.0 - part.y), vec2f(part.y));
    let weights = select(vec4f(0.0), bilinear, is_behind);
    let first = textureLoad(scene_color, low, 0);
    let sum = weights.x * first + weights.y * textureLoad(scene_color, right, 0)
        + weights.z * textureLoad(scene_color, below, 0) + weights.w * textureLoad(scene_color, high, 0);
    let weight = dot(weights, vec4f(1.0));
    return select(first, sum / weight, weight > 0.0);
}

fn is_scene_behind(texel: vec2i, depth: f32) -> bool {
    return scene_depth_at((vec2f(texel) + 0.5) / settings.fluid_scale) > depth;
}

// Where the scene behind the fluid is seen: the view ray, bent at the surface, as far into the fluid as the fluid is
// thick, and from there seen straight. The offset is 0 at thickness 0, and never leads to something in front of the fluid.
fn refracted_px(sight: Sight) -> vec2f {
    let inside = refract(sight.toward, sight.normal, 1.0 / optics.refractive_index);
    let bend = select(optics.refraction, 0.0, sight.is_submerged);
    let exit = sight.position + sight.thickness * (sight.toward + bend * (inside - sight.toward));
    let bent = px_of(exit);
    let usable = exit.z < 0.0 && scene_depth_at(bent) > sight.depth;
    return select(sight.px, bent, usable);
}

// What the surface sends on of the light around it: mirror images of the surroundings and of the sun.
fn surface_light(sight: Sight, reflectance: vec3f, sunlight: vec3f) -> vec3f {
    let rotation = world_from_view();
    let normal = rotation * sight.normal;
    let toward = rotation * sight.toward;
    let spread = 2.0 * optics.roughness * optics.roughness;
    let around = surroundings(rotation * sight.position, reflect(toward, normal), spread);
    let highlight = pow(max(dot(normal, normalize(environment.sun - toward)), 0.0), optics.shininess);
    let glint = SUN_LIGHT * sunlight * (environment.sun_strength * optics.specular * highlight * GLINT);
    return reflectance * around + select(glint, vec3f(0.0), sight.is_submerged);
}

// What is behind the front surface and the liquid that it bounds.
struct Behind {
    color: vec4f, // linear premultiplied
    share: f32, // of that light that passes the liquid's back surface
    inner: vec3f, // what that surface mirrors from inside, in place of the rest
    thickness: f32, // of the liquid, world units
}

// The scene straight behind the front surface, bent by that alone.
fn scene_behind(sight: Sight) -> Behind {
    if settings.background == BACKGROUND_NONE {
        return Behind(vec4f(0.0), 1.0, vec3f(0.0), sight.thickness);
    }
    return Behind(scene_color_behind(refracted_px(sight), sight.depth), 1.0, vec3f(0.0), sight.thickness);
}

// Linear premultiplied colour; where the host's scene is not opaque, alpha is what does not come from behind.
fn color_of(sight: Sight, foam: f32) -> vec4f {
    let reflectance = select(reflectance_at(-dot(sight.normal, sight.toward)), vec3f(0.0), sight.is_submerged);
    let behind = behind_of(sight);
    let through = body_transmittance(behind.thickness);
    let sunlight = sunlight_on_liquid(world_from_view() * sight.position);
    let lit = light_on(world_from_view() * sight.normal, sunlight);
    let scattered = (1.0 - reflectance) * (1.0 - through) * scattered_color();
    let lamps = lamps_light(sight, scattered);
    var body = body_light(through, lit);
    var passed = (1.0 - reflectance) * through;
    if DROPLETS {
        // They hide what is behind them, and are seen through the liquid before them.
        let veil = veil_behind(sight);
        let until = body_transmittance(min(veil.distance, behind.thickness));
        body = mix(body, body_light(until, lit) + until * droplets.color * lit, veil.opacity);
        passed *= 1.0 - veil.opacity;
    }
    let own = surface_light(sight, reflectance, sunlight) + (1.0 - reflectance) * body + lamps;
    let inner = passed * (1.0 - behind.share) * behind.inner;
    let transmitted = passed * behind.share;
    let alpha = 1.0 - (1.0 - behind.color.a) * dot(transmitted, vec3f(1.0 / 3.0));
    var color = vec4f(own + inner + transmitted * behind.color.rgb, alpha);
    if FOAM {
        color = mix(color, vec4f(detail.foam_color * lit, 1.0), foam);
    }
    if DROPLETS {
        color = mix(color, vec4f(droplets.color * lit, 1.0), afloat_at(sight.px));
    }
    return color;
}

fn shading_at(pixel: TilePixel, sight: Sight, foam: f32) -> vec4f {
    if settings.shading == SHADING_LIQUIDS {
        return vec4f(liquids_at(pixel), 1.0);
    }
    optics = optics_at(pixel, sight.thickness);
    if settings.shading == SHADING_TRANSMITTANCE {
        return vec4f(body_transmittance(sight.thickness), 1.0);
    }
    if settings.shading == SHADING_ALBEDO {
        return vec4f(scattered_color(), 1.0);
    }
    return color_of(sight, foam);
}

@compute @workgroup_size(8, 8)
fn shade(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let foam = shaded[pixel.index].x;
    shaded[pixel.index] = vec4f(0.0);
    let px = vec2f(pixel.at) + 0.5;
    let near = nearness[pixel.index];
    let normal_thickness = surface[pixel.index];
    let depth = depth_of(near);
    // At a lower resolution upsample.wgsl decides, by the picture's own pixels.
    let is_hidden = settings.fluid_scale == 1.0 && depth >= scene_depth_at(px);
    if near > 0.0 && normal_thickness.w >= settings.min_thickness * settings.radius && !is_hidden {
        shaded[pixel.index] = shading_at(pixel, sight_at(px, depth, normal_thickness), foam);
    }
}
