// From the sheets along each ray to images that the frame's other passes take, and back to what shading reads (layers.wgsl).

@group(1) @binding(0) var<storage, read> fluid: array<f32>; // nearness of the front surface, at the fluid's own pixels
@group(1) @binding(1) var<storage, read_write> fronts: array<f32>;
@group(1) @binding(2) var<storage, read> slices: array<u32>; // sheets.wgsl's, like all below
@group(1) @binding(3) var<storage, read_write> gaps: array<f32>;
@group(1) @binding(4) var<storage, read> sheets: array<vec4u>;
@group(1) @binding(5) var<storage, read_write> back_raw: array<f32>; // nearness
@group(1) @binding(6) var<storage, read_write> beyond_raw: array<f32>;

@compute @workgroup_size(8, 8)
fn take_fronts(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < view.size) {
        fronts[id.y * view.size.x + id.x] = fluid[fluid_index(id.xy)];
    }
}

@compute @workgroup_size(8, 8)
fn find_gaps(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= view.size) {
        return;
    }
    let texel = id.y * view.size.x + id.x;
    var slice = 0u;
    for (var word = 0u; word < WORDS; word++) {
        if slice == 32u * word {
            slice += countTrailingZeros(~slices[WORDS * texel + word]);
        }
    }
    gaps[texel] = select(3.4e38, depth_of(fronts[texel]) + (f32(slice) + 0.5) * settings.radius, slice < u32(SLICES));
}

@compute @workgroup_size(8, 8)
fn give_sheets(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= view.size) {
        return;
    }
    let texel = id.y * view.size.x + id.x;
    let sheet = sheets[texel];
    back_raw[texel] = select(0.0, nearness_of(bitcast<f32>(sheet.x)), sheet.x > 0u);
    beyond_raw[texel] = bitcast<f32>(sheet.y);
}
