// Droplets before the surface and in the air, over the host's picture with the fluid in it; foam on it is in that already.

@group(1) @binding(0) var<storage, read> sums: array<u32>;
@group(1) @binding(1) var<uniform> droplets: Droplets;

// Light on a droplet, which has no side of its own, over that on a white wall in full light.
const LIGHT: f32 = 0.9;

@fragment
fn front(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = clamp(position.xy / settings.fluid_scale - 0.5, vec2f(0.0), vec2f(view.size) - 1.0);
    let low = vec2u(at);
    let part = at - floor(at);
    var counts = 0.0;
    for (var corner = 0u; corner < 4u; corner++) {
        let offset = vec2u(corner & 1u, corner >> 1u);
        let texel = min(low + offset, view.size - 1u);
        let along = select(1.0 - part, part, offset == vec2u(1u));
        let plane = view.size.x * view.size.y;
        let index = texel.y * view.size.x + texel.x;
        // Where sums are full, the parts may be more than the whole.
        let before = sums[BEFORE * plane + index];
        counts += along.x * along.y * f32(before - min(sums[AFLOAT * plane + index], before));
    }
    if counts <= 0.0 {
        discard;
    }
    let opacity = opacity_of(counts / DEPTH_UNIT);
    return vec4f(LIGHT * opacity * droplets.color, opacity);
}
