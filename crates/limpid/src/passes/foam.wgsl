// Foam over the shaded fluid (van der Laan 2009, Fig. 3): a matt white, lit by the sky and the sun.

@group(1) @binding(1) var<storage, read> surface: array<vec4f>;
@group(1) @binding(2) var<storage, read> shown: array<vec2f>; // detail_apply.wgsl's
@group(1) @binding(3) var<uniform> detail: Detail;
@group(1) @binding(4) var<storage, read_write> shaded: array<vec4f>;

// Share of the light that comes from the sky.
const SKY: f32 = 0.75;

@compute @workgroup_size(8, 8)
fn foam(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let pixel = tile_pixel(group, groups, local);
    if !pixel.inside {
        return;
    }
    let below = shaded[pixel.index];
    let opacity = shown[pixel.index].y;
    // Nothing: something hides the fluid here.
    if all(below == vec4f(0.0)) || opacity <= 0.0 {
        return;
    }
    let light = SKY + (1.0 - SKY) * max(dot(surface[pixel.index].xyz, detail.sun_view), 0.0);
    shaded[pixel.index] = mix(below, vec4f(light * detail.foam_color, 1.0), opacity);
}
