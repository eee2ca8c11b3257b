// The shaded colour of what is beyond the air, into what the first sheet's shading reads (layers.wgsl).

@group(1) @binding(0) var<storage, read> shaded: array<vec4f>;
@group(1) @binding(1) var<storage, read_write> layers: array<vec4f>;

@compute @workgroup_size(8, 8)
fn pack_color(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < view.size) {
        let texel = id.y * view.size.x + id.x;
        layers[3u * texel + 2u] = shaded[texel];
    }
}
