// The surroundings themselves, as a host would draw its scene.

@group(1) @binding(0) var<uniform> environment: Environment;
@group(1) @binding(1) var<storage, read> shadow: array<f32>;
@group(1) @binding(2) var environment_map: texture_2d<f32>;

struct Fragment {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn backdrop(@builtin(position) position: vec4f) -> Fragment {
    let ray = pixel_ray(position.xy);
    let rotation = mat3x3f(view.world_from_view[0].xyz, view.world_from_view[1].xyz, view.world_from_view[2].xyz);
    let origin = rotation * ray.origin;
    let direction = rotation * ray.direction;
    let scale = length(direction);
    let spread = select(0.0, abs(view.px_step.y), is_perspective());
    let color = surroundings(origin, direction / scale, spread);
    let descent = -dot(direction, environment.up);
    let depth = (environment.eye_height + dot(origin, environment.up)) / descent;
    let hits = descent > 0.0 && depth > view.near;
    // Beyond everything: the far end of a reversed depth buffer.
    return Fragment(vec4f(color, 1.0), select(0.0, clamp(host_from_depth(depth), 0.0, 1.0), hits));
}
