// Shading after van der Laan 2009, Eq. 13-15: what is behind the fluid, refracted and absorbed; what is around it,
// reflected; the sun's highlight. Linear light in, linear premultiplied colour out.

struct Optics {
    absorption: vec3f, // per world unit
    refractive_index: f32,
    color: vec3f,
    refraction: f32,
    specular: f32,
    shininess: f32,
}

@group(1) @binding(1) var<uniform> optics: Optics;
@group(1) @binding(2) var<uniform> environment: Environment;
@group(1) @binding(3) var<storage, read> nearness: array<f32>;
@group(1) @binding(4) var<storage, read> surface: array<vec4f>;
@group(1) @binding(5) var<storage, read_write> shaded: array<vec4f>;
@group(1) @binding(6) var scene_color: texture_2d<f32>;
@group(1) @binding(7) var scene_depth: texture_depth_2d;
@group(1) @binding(8) var<storage, read> shadow: array<f32>;

const BACKGROUND_NONE: u32 = 0u;
// Brightness of the sun's mirror image, over that of a white wall in the sun.
const GLINT: f32 = 4.0;
// Width of the cone of a reflected ray per distance: ripples too fine to see blur what they reflect.
const REFLECTED_SPREAD: f32 = 0.02;

// Unpolarised reflectance of a smooth dielectric, exact; `cosine` of the angle to the normal, `index` above 1.
fn fresnel(cosine: f32, index: f32) -> f32 {
    let g = sqrt(index * index - 1.0 + cosine * cosine);
    let a = (g - cosine) / (g + cosine);
    let b = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

// Bilinear by hand: works for every float format, filterable or not.
fn scene_color_at(px: vec2f) -> vec3f {
    let size = textureDimensions(scene_color);
    let at = clamp(px * settings.fluid_scale - 0.5, vec2f(0.0), vec2f(size) - 1.0);
    let low = vec2u(at);
    let high = min(low + 1u, size - 1u);
    let part = at - floor(at);
    let top = mix(textureLoad(scene_color, low, 0), textureLoad(scene_color, vec2u(high.x, low.y), 0), part.x);
    let bottom = mix(textureLoad(scene_color, vec2u(low.x, high.y), 0), textureLoad(scene_color, high, 0), part.x);
    return mix(top, bottom, part.y).rgb;
}

// Where the scene behind the fluid is seen: the view ray, bent at the surface, as far into the fluid as the fluid is
// thick, and from there seen straight. The offset is 0 at thickness 0, and never leads to something in front of the fluid.
fn refracted_px(px: vec2f, position: vec3f, toward: vec3f, normal: vec3f, thickness: f32) -> vec2f {
    let inside = refract(toward, normal, 1.0 / optics.refractive_index);
    let exit = position + thickness * (toward + optics.refraction * (inside - toward));
    let slope = select(exit.xy, exit.xy / -exit.z, is_perspective());
    let bent = (slope - view.px_zero) / view.px_step;
    let usable = exit.z < 0.0 && scene_depth_at(bent) > -position.z;
    return select(px, bent, usable);
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
    shaded[pixel.index] = vec4f(0.0);
    let px = vec2f(pixel.at) + 0.5;
    let near = nearness[pixel.index];
    let thickness = surface[pixel.index].w;
    if near <= 0.0 || thickness < settings.min_thickness * settings.radius {
        return;
    }
    let depth = depth_of(near);
    // At a lower resolution upsample.wgsl decides, by the picture's own pixels.
    if settings.fluid_scale == 1.0 && depth >= scene_depth_at(px) {
        return;
    }
    let ray = pixel_ray(px);
    let position = ray.origin + depth * ray.direction;
    let toward = normalize(ray.direction);
    let normal = surface[pixel.index].xyz;
    let cosine = clamp(-dot(normal, toward), 0.0, 1.0);
    let reflectance = fresnel(cosine, optics.refractive_index);

    let rotation = mat3x3f(view.world_from_view[0].xyz, view.world_from_view[1].xyz, view.world_from_view[2].xyz);
    let normal_world = rotation * normal;
    let toward_world = rotation * toward;
    let reflected = reflect(toward_world, normal_world);
    let around = surroundings(rotation * position, reflected, REFLECTED_SPREAD);

    let highlight = pow(max(dot(normal_world, normalize(environment.sun - toward_world)), 0.0), optics.shininess);
    let glint = SUN_LIGHT * (optics.specular * highlight * GLINT);

    let transmitted = exp(-optics.absorption * thickness) * (1.0 - reflectance);
    let body = optics.color * (1.0 - reflectance - transmitted);
    var color = vec4f(body + reflectance * around + glint, 1.0);
    if settings.background == BACKGROUND_NONE {
        color.a = 1.0 - dot(transmitted, vec3f(1.0 / 3.0));
    } else {
        let behind = scene_color_at(refracted_px(px, position, toward, normal, thickness));
        color += vec4f(transmitted * behind, 0.0);
    }
    shaded[pixel.index] = color;
}
