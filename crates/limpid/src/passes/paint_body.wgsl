// Paint of the body of liquid: every particle adds its own along the rays through its ball, by their length inside. Only ratios
// are read, so that nothing need be blurred.

@group(1) @binding(3) var<storage, read> paints: array<vec2u>;
@group(1) @binding(4) var<storage, read_write> sums: array<atomic<u32>>;
@group(1) @binding(5) var<uniform> paint: Paint;
@group(1) @binding(6) var scene_depth: texture_depth_2d;

// Counts of a chord of one r.
const UNIT: f32 = 4096.0;

@compute @workgroup_size(64)
fn splat(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index >= arrayLength(&particles) {
        return;
    }
    let ball = ball_of(index);
    if !is_drawn(ball) {
        return;
    }
    let place = pyramid_box(ball);
    if any(place.box.max < place.box.min) {
        return;
    }
    let own = unpack_paint(paints[index], paint);
    atomicOr(&sums[paint.body_first], 1u << place.level);
    let first = level_start(place.level);
    let rays = pixel_rays();
    for (var y = place.box.min.y; y <= place.box.max.y; y++) {
        for (var x = place.box.min.x; x <= place.box.max.x; x++) {
            let at = (vec2f(f32(x), f32(y)) + 0.5) * place.px;
            let chord = ball_chord(ball, ray_at(rays, at));
            if chord.length <= 0.0 {
                continue;
            }
            // What the scene hides has no say.
            if 0.5 * (chord.enter + chord.leave) >= scene_depth_at(at) {
                continue;
            }
            let counts = u32(min(chord.length / settings.radius * UNIT, 1048576.0) + 0.5);
            let texel = first + u32(y) * place.size.x + u32(x);
            add_paint(paint.body_first + 1u + texel * paint.planes, counts, own);
        }
    }
}
