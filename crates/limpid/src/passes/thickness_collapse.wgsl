// Collapses the thickness pyramid into one image, in world units.

@group(1) @binding(0) var<storage, read> sums: array<u32>;
@group(1) @binding(1) var<storage, read> levels_used: u32;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;

fn level_texel(level: u32, start: u32, size: vec2u, at: vec2i) -> f32 {
    let texel = vec2u(clamp(at, vec2i(0), vec2i(size) - 1));
    return f32(min(sums[start + texel.y * size.x + texel.x], 0x80000000u));
}

// Sums of all levels; those above the finest are interpolated.
@compute @workgroup_size(8, 8)
fn collapse(@builtin(global_invocation_id) texel: vec3u) {
    if any(texel.xy >= settings.thickness_size) {
        return;
    }
    var total = 0.0;
    // Mostly there is only the finest level.
    let levels = 32u - countLeadingZeros(levels_used);
    for (var level = 0u; level < levels; level++) {
        let start = level_start(level);
        let size = level_size(level);
        let at = (vec2f(texel.xy) + 0.5) / f32(1u << level) - 0.5;
        let low = floor(at);
        let part = at - low;
        let corner = vec2i(low);
        if level == 0u {
            total += level_texel(level, start, size, corner);
            continue;
        }
        let top = mix(level_texel(level, start, size, corner), level_texel(level, start, size, corner + vec2i(1, 0)), part.x);
        let bottom = mix(level_texel(level, start, size, corner + vec2i(0, 1)), level_texel(level, start, size, corner + vec2i(1, 1)), part.x);
        total += mix(top, bottom, part.y);
    }
    output[texel.y * settings.thickness_size.x + texel.x] = total * settings.thickness_unit;
}
