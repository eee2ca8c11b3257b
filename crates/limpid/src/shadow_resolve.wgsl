// From sums in slices to the liquid before the end of each slice, world units.

@group(1) @binding(0) var<storage, read> ends: array<u32>;
@group(1) @binding(1) var<storage, read> sums: array<u32>;
@group(1) @binding(2) var<storage, read_write> map: array<f32>;

@compute @workgroup_size(8, 8)
fn resolve(@builtin(global_invocation_id) at: vec3u) {
    if any(at.xy >= view.size) {
        return;
    }
    let texel = at.y * view.size.x + at.x;
    let first = texel * SHADOW_WORDS;
    let back = bitcast<f32>(ends[2u * texel + 1u]);
    map[first] = depth_of(bitcast<f32>(ends[2u * texel]));
    map[first + 1u] = back;
    var before = 0.0;
    for (var slice = 0u; slice < SHADOW_SLICES; slice++) {
        before += f32(sums[texel * SHADOW_SLICES + slice]) * settings.thickness_unit;
        map[first + 2u + slice] = before;
    }
}
