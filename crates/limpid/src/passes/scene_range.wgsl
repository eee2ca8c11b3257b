// Nearest and farthest depth of the host's scene within each texel of the thickness pyramid, so that an object thinner
// than a texel is neither lost nor taken for the whole texel. The finest level from the scene, each other from the one below.

@group(1) @binding(0) var scene_depth: texture_depth_2d;
@group(1) @binding(1) var<storage, read_write> ranges: array<vec2f>;
@group(1) @binding(2) var<uniform> level: vec4u; // its x

const NOTHING: vec2f = vec2f(3.4e38, 0.0);

fn together(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(min(a.x, b.x), max(a.y, b.y));
}

@compute @workgroup_size(8, 8)
fn finest(@builtin(global_invocation_id) texel: vec3u) {
    if any(texel.xy >= settings.thickness_size) {
        return;
    }
    // Pixels of the host's picture.
    let side = u32(round(settings.thickness_divisor * settings.fluid_scale));
    let limit = min(settings.picture_size, textureDimensions(scene_depth));
    let low = min(texel.xy * side, limit - 1u);
    let high = min(low + side, limit);
    // Of the buffer's own values, whichever way they grow: one quotient for each end, not for each pixel.
    var least = 1.0;
    var most = 0.0;
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            let value = textureLoad(scene_depth, vec2u(x, y), 0);
            least = min(least, value);
            most = max(most, value);
        }
    }
    let ends = vec2f(scene_depth_from_host(least), scene_depth_from_host(most));
    ranges[texel.y * settings.thickness_size.x + texel.x] = vec2f(min(ends.x, ends.y), max(ends.x, ends.y));
}

@compute @workgroup_size(8, 8)
fn coarser(@builtin(global_invocation_id) texel: vec3u) {
    let size = level_size(level.x);
    if any(texel.xy >= size) {
        return;
    }
    let finer = level_size(level.x - 1u);
    let finer_start = level_start(level.x - 1u);
    var range = NOTHING;
    for (var i = 0u; i < 4u; i++) {
        let at = min(2u * texel.xy + vec2u(i & 1u, i >> 1u), finer - 1u);
        range = together(range, ranges[finer_start + at.y * finer.x + at.x]);
    }
    ranges[level_start(level.x) + texel.y * size.x + texel.x] = range;
}
