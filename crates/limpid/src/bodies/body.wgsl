// Bodies in the built-in surroundings: vertices, and the opaque ones' light (the metallic-roughness model of glTF 2.0).

struct Body {
    clip_from_mesh: mat4x4f,
    eye_from_mesh: mat4x4f, // world axes, places relative to the eye
    normal_from_mesh: mat4x4f, // world axes
    base_color: vec4f,
    metallic: f32,
    roughness: f32,
    alpha: f32, // of a glass's own colour
    padding: f32,
}

@group(1) @binding(0) var<uniform> environment: Environment;
@group(1) @binding(1) var<storage, read> shadow: array<f32>;
@group(1) @binding(2) var environment_map: texture_2d<f32>;
@group(2) @binding(0) var<uniform> body: Body;
@group(2) @binding(1) var base_color_texture: texture_2d<f32>;
@group(2) @binding(2) var metallic_roughness_texture: texture_2d<f32>;
@group(2) @binding(3) var texels: sampler;

// Share of a mirror's light that a dielectric reflects straight back.
const DIELECTRIC: f32 = 0.04;
const PI: f32 = 3.14159265;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) color: vec4f,
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) from_eye: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) color: vec4f,
}

@vertex
fn vertex(vertex: Vertex) -> Corner {
    let at = vec4f(vertex.position, 1.0);
    return Corner(
        body.clip_from_mesh * at,
        (body.eye_from_mesh * at).xyz,
        (body.normal_from_mesh * vec4f(vertex.normal, 0.0)).xyz,
        vertex.uv,
        vertex.color,
    );
}

// From the eye to a place.
fn sight(from_eye: vec3f) -> vec3f {
    let forward = -vec3f(view.world_from_view[2].xyz);
    return normalize(select(forward, from_eye, is_perspective()));
}

// Surfaces are lit on the side that is seen: meshes from files need not be closed, nor wound one way.
fn facing(normal: vec3f, toward: vec3f) -> vec3f {
    let unit = normalize(normal);
    return select(unit, -unit, dot(unit, toward) > 0.0);
}

// Light from around that falls on a surface, as on a white one; the floor's is as environment.wgsl lights it.
fn light_around(normal: vec3f) -> vec3f {
    let upward = 0.5 + 0.5 * dot(normal, environment.up);
    let procedural = mix(vec3f(0.22, 0.215, 0.21), vec3f(0.43, 0.45, 0.47), upward);
    return select(procedural, map_light(normal, 1.0), environment.map_levels > 0u);
}

// Just outside a surface, so that it does not shade itself; relative to the centre.
fn outside(normal: vec3f, from_eye: vec3f) -> vec3f {
    return environment.eye_from_center + from_eye + 0.004 * environment.extent * normal;
}

// Irradiance of the sun over pi: with that from around, 1 on a floor.
fn sun_on(normal: vec3f, from_eye: vec3f) -> vec3f {
    let height = max(dot(environment.sun, environment.up), 0.2);
    let facing_sun = environment.sun_strength * max(dot(normal, environment.sun), 0.0) / height;
    return 0.55 * facing_sun * sunlight(outside(normal, from_eye));
}

// GGX (Walter et al. 2007) with Smith's shadowing, of a light in a direction: over its irradiance over pi.
fn mirrored(light: vec3f, normal: vec3f, toward: vec3f, roughness: f32, f0: vec3f) -> vec3f {
    let middle = normalize(light - toward);
    let alpha = max(roughness * roughness, 0.01);
    let along = max(dot(normal, middle), 0.0);
    let view_cosine = max(-dot(normal, toward), 1e-3);
    let light_cosine = max(dot(normal, light), 1e-3);
    let lobe = along * along * (alpha * alpha - 1.0) + 1.0;
    let distribution = alpha * alpha / (PI * lobe * lobe);
    let k = 0.5 * alpha;
    let hidden = (view_cosine * (1.0 - k) + k) * (light_cosine * (1.0 - k) + k);
    let away = 1.0 - max(dot(middle, -toward), 0.0);
    let fresnel = f0 + (1.0 - f0) * pow(away, 5.0);
    return fresnel * min(distribution / (4.0 * hidden), 8.0) * PI;
}

@fragment
fn opaque(corner: Corner) -> @location(0) vec4f {
    let toward = sight(corner.from_eye);
    let normal = facing(corner.normal, toward);
    let rough_metal = textureSample(metallic_roughness_texture, texels, corner.uv);
    let roughness = clamp(body.roughness * rough_metal.g, 0.05, 1.0);
    let metallic = body.metallic * rough_metal.b;
    let base = textureSample(base_color_texture, texels, corner.uv) * body.base_color * corner.color;
    // Cut-outs: what a texture makes more than half transparent is not there.
    if base.a < 0.5 {
        discard;
    }
    let f0 = mix(vec3f(DIELECTRIC), base.rgb, metallic);
    let sun = sun_on(normal, corner.from_eye);
    let at = outside(normal, corner.from_eye);
    let diffuse = base.rgb * (1.0 - metallic) * (light_around(normal) + sun + lamps_on(normal, at));
    let away = 1.0 - max(-dot(normal, toward), 0.0);
    let from_around = f0 + (max(vec3f(1.0 - roughness), f0) - f0) * pow(away, 5.0);
    // Rough surfaces mirror the mean of their surroundings.
    let sharp = surroundings(corner.from_eye, reflect(toward, normal), roughness);
    let around = mix(sharp, light_around(reflect(toward, normal)), roughness);
    var glints = mirrored(environment.sun, normal, toward, roughness, f0) * sun;
    for (var lamp = 1u; lamp < environment.light_count; lamp++) {
        let direction = environment.lights[lamp].toward;
        let shed = 0.55 * max(dot(normal, direction), 0.0) * lamplight(lamp, at);
        glints += mirrored(direction, normal, toward, roughness, f0) * shed;
    }
    return vec4f(diffuse + from_around * around + glints, 1.0);
}
