// The host's own scene: coloured triangles in the sun, and a checked floor.

@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) color: vec4f,
}

@vertex
fn corner(@location(0) world: vec3f, @location(1) color: vec4f) -> Corner {
    return Corner(clip_from_world * vec4f(world, 1.0), world, color);
}

@fragment
fn color(corner: Corner) -> @location(0) vec4f {
    let normal = normalize(cross(dpdx(corner.world), dpdy(corner.world)));
    let sun = 0.35 + 0.65 * abs(dot(normal, normalize(vec3f(0.5, 0.8, 0.3))));
    let cell = vec2i(floor(corner.world.xz * 2.0));
    let is_dark = corner.world.y < 0.0 && ((cell.x + cell.y) & 1) == 1;
    let rgb = corner.color.rgb * select(1.0, 0.45, is_dark) * sun;
    return vec4f(rgb * corner.color.a, corner.color.a);
}
