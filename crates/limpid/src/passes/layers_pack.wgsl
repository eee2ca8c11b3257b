// What is beyond the air behind the first sheet gets its share of the liquid, and all goes into one buffer (layers.wgsl).

@group(1) @binding(0) var<storage, read> fluid: array<vec4f>; // normals.wgsl's surface, at the fluid's own pixels
@group(1) @binding(1) var<storage, read> fronts: array<f32>;
@group(1) @binding(2) var<storage, read> sheets: array<vec4u>; // sheets.wgsl's
@group(1) @binding(3) var<storage, read_write> beyond_surface: array<vec4f>;
@group(1) @binding(4) var<storage, read> back: array<f32>; // nearness, smoothed
@group(1) @binding(5) var<storage, read> back_surface: array<vec4f>;
@group(1) @binding(6) var<storage, read> beyond: array<f32>; // nearness, smoothed
@group(1) @binding(7) var<storage, read_write> layers: array<vec4f>;

// Share of a ray's liquid that the first sheet has.
fn first_share(texel: u32) -> f32 {
    let sheet = sheets[texel];
    return f32(sheet.z) / max(f32(sheet.z) + f32(sheet.w), 1.0);
}

@compute @workgroup_size(8, 8)
fn pack(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= view.size) {
        return;
    }
    let texel = id.y * view.size.x + id.x;
    let share = first_share(texel);
    beyond_surface[texel].w = (1.0 - share) * fluid[fluid_index(id.xy)].w;
    layers[3u * texel] = vec4f(fronts[texel], back[texel], share, beyond[texel]);
    layers[3u * texel + 1u] = vec4f(back_surface[texel].xyz, 0.0);
}
