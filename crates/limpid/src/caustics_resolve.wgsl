// From counts to the light that arrives, over the light that would without the liquid, and to the liquid that it came through.

@group(1) @binding(0) var<storage, read> nearness: array<f32>;
@group(1) @binding(1) var<storage, read> sums: array<u32>;
@group(1) @binding(2) var<storage, read_write> shadow: array<f32>; // shadow.rs's map
@group(1) @binding(3) var<uniform> lens: Lens;
@group(1) @binding(4) var<storage, read> occupied: array<u32>; // of each tile: whether there is liquid in it

const TAPS: i32 = 16;
const TILE: i32 = 8;

// Depth of the liquid at a pixel; beyond everything where there is none.
fn liquid_depth(at: vec2i) -> f32 {
    let inside = clamp(at, vec2i(0), vec2i(view.size) - 1);
    let near = nearness[u32(inside.y) * view.size.x + u32(inside.x)];
    return select(3.4e38, depth_of(near), near > 0.0);
}

// Whether there is liquid in a tile about a pixel or beside it.
fn is_near_liquid(at: vec2i) -> bool {
    let tiles = (vec2i(view.size) + TILE - 1) / TILE;
    var found = 0u;
    for (var tap = 0; tap < 25; tap++) {
        let tile = clamp(at / TILE + vec2i(tap % 5 - 2, tap / 5 - 2), vec2i(0), tiles - 1);
        found |= occupied[u32(tile.y * tiles.x + tile.x)];
    }
    return found != 0u;
}

// Share of the sun's disc that the liquid's outline leaves free: soft where the liquid is far off (Fernando 2005).
fn passing(at: vec2i, depth: f32) -> f32 {
    let turn = turn_at(vec2f(at));
    let px_per_slope = 1.0 / view.px_step.x;
    let widest = clamp(lens.sun_tangent * depth * px_per_slope, 1.0, f32(2 * TILE));
    var blockers = 0.0;
    var blocker_depth = 0.0;
    for (var tap = 0; tap < TAPS; tap++) {
        let nearest = liquid_depth(at + vec2i(round(widest * on_disc(tap, TAPS, turn))));
        let blocks = nearest < depth;
        blockers += select(0.0, 1.0, blocks);
        blocker_depth += select(0.0, nearest, blocks);
    }
    let distance = depth - blocker_depth / max(blockers, 1.0);
    let radius = clamp(lens.sun_tangent * distance * px_per_slope, 1.0, widest);
    var free = 0.0;
    for (var tap = 0; tap < TAPS; tap++) {
        let nearest = liquid_depth(at + vec2i(round(radius * on_disc(tap, TAPS, turn))));
        free += select(1.0, 0.0, nearest < depth);
    }
    return select(1.0, free / f32(TAPS), blockers > 0.0);
}

// What has landed about a pixel, smoothed over 3 x 3: light, and light times liquid.
fn landed(at: vec2i) -> vec2f {
    var counts = vec2f(0.0);
    for (var tap = 0; tap < 9; tap++) {
        let offset = vec2i(tap % 3 - 1, tap / 3 - 1);
        let inside = clamp(at + offset, vec2i(0), vec2i(view.size) - 1);
        let index = 2u * (u32(inside.y) * view.size.x + u32(inside.x));
        let weight = f32((2 - abs(offset.x)) * (2 - abs(offset.y))) / 16.0;
        counts += weight * vec2f(f32(sums[index]), f32(sums[index + 1u]));
    }
    return counts / COUNTS;
}

@compute @workgroup_size(8, 8)
fn resolve(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= view.size) {
        return;
    }
    let at = vec2i(id.xy);
    let bent = landed(at);
    var light = bent.x;
    if is_near_liquid(at) {
        light += passing(at, landing_depth(vec2f(at) + 0.5));
    } else {
        light += 1.0;
    }
    let first = lens.first + 2u * (id.y * view.size.x + id.x);
    shadow[first] = light;
    shadow[first + 1u] = bent.y / max(light, 1e-6) * half_width();
}
