// What the scene hides of a texel's liquid. `thickness` holds the liquid before the farthest depth of the scene within the
// texel; negated where the scene hides liquid from some of its pixels, and then `hidden` says what they see.
// Whoever includes this binds `thickness`, `hidden` and `ranges` (scene_range.wgsl).

struct Hidden {
    near: f32, // liquid before the nearest depth of the scene, world units
    behind_far: f32, // 1: there is liquid behind the farthest too
}

// Depths of a scene within this many r of each other are one surface.
const SAME_DEPTH: f32 = 2.0;

// Whether the farthest depth of the scene cuts off liquid.
fn is_cut(value: f32, index: u32) -> bool {
    return value < 0.0 && hidden[index].behind_far > 0.0;
}

// Share of the way through a texel's range of scene depths.
fn range_part(range: vec2f, depth: f32) -> f32 {
    return clamp((depth - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0);
}
