// What both kernels of the caustics know beside the sun's view. Whoever includes this binds `lens` and `shadow`, shadow.rs's map.

struct Lens {
    floor: vec4f, // the floor's plane in the sun's view: dot(xyz, place) = w; all 0: none
    shadow_texels: u32, // along the edge of the fluid's map (shadow.wgsl)
    scene_texels: u32, // along the edge of the scene's, which follows it; 0: no scene
    first: u32, // word of the map where the result goes
    sun_tangent: f32, // of half the angle that the sun's disc spans
    absorption: f32, // of the colour that is absorbed least, per world unit
}

// Counts of one pixel's light, and of that light times the liquid it came through, in half widths of the view.
const COUNTS: f32 = 32768.0;

// Half the width of the view, world units.
fn half_width() -> f32 {
    return 0.5 * f32(view.size.x) * view.px_step.x;
}

// Depth of the first place of the scene through a pixel position of the sun's view.
fn landing_depth(px: vec2f) -> f32 {
    let across = view.px_zero + px * view.px_step;
    let upward = lens.floor.z;
    let floor_depth = (dot(lens.floor.xy, across) - lens.floor.w) / max(upward, 1e-6);
    let depth = select(view.far, floor_depth, upward > 0.01);
    // Without a branch on a uniform: ball.wgsl says why.
    let size = max(i32(lens.scene_texels), 1);
    let texel = clamp(vec2i(floor(px / vec2f(view.size) * f32(size))), vec2i(0), vec2i(size - 1));
    let fluid = lens.shadow_texels * lens.shadow_texels * SHADOW_WORDS;
    let nearness = shadow[fluid + u32(texel.y * size + texel.x)];
    let is_scene = (nearness > 0.0) & (lens.scene_texels > 0u);
    return select(depth, min(depth, mix(view.far, view.near, nearness)), is_scene);
}
