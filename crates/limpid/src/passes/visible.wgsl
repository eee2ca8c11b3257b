// Which particles can show: they are splatted, and ellipsoids worked out, in two stages. First those whose centres lie about as
// near as any other in their part of the picture: most of what will be seen. Then those that could still show somewhere:
// whatever shape a particle takes, it stays within its bounds, and where every pixel of a tile is already nearer than
// those, it adds nothing. The rest cannot change a bit of the depth image, and are spheres in the thickness.

@group(1) @binding(0) var<uniform> grid: Grid;
@group(1) @binding(1) var<storage, read> particles: array<vec4f>; // local position, radius; 0: left out
@group(1) @binding(2) var<storage, read_write> fronts: array<atomic<u32>>; // per level and tile: nearness of its nearest centre
@group(1) @binding(3) var<storage, read> nearness: array<u32>; // bits, after the first stage
@group(1) @binding(4) var<storage, read_write> covered: array<atomic<u32>>;
@group(1) @binding(5) var<storage, read_write> list: List;
@group(1) @binding(6) var<storage, read_write> list_groups: vec3u; // indirect dispatch of a lane for each in the list

struct List {
    count: atomic<u32>,
    items: array<u32>, // order varies, results do not
}

const LEVELS: u32 = 7u; // of `fronts`, each of tiles twice as wide
const PER_LANE: u32 = 8u; // particles that a lane takes in the kernels that list them
const FRONT: f32 = 8.0; // r behind the nearest centre that the first stage draws: seen aslant, a tile's surface is at many depths

struct Center {
    depth: f32,
    front: u32, // its place in `fronts`
    seen: bool, // in the picture, beyond the near plane
}

// Levels are chosen by a particle's size on screen, so that a tile of a body of liquid holds about one at each depth.
fn center_of(particle: vec4f) -> Center {
    let at = (view.view_from_local * vec4f(particle.xyz, 1.0)).xyz;
    let depth = -at.z;
    let px = (at.xy / select(1.0, max(depth, view.near), is_perspective()) - view.px_zero) / view.px_step;
    let width = 2.0 * particle.w * px_per_world(max(depth, view.near)) / f32(TILE);
    let level = u32(clamp(ceil(log2(max(width, 1.0))), 0.0, f32(LEVELS - 1u)));
    let seen = depth > view.near && all(px >= vec2f(0.0)) && all(px < vec2f(view.size)) && particle.w > 0.0;
    let tile = vec2i(select(vec2f(0.0), px, seen)) / TILE;
    let tiles = tile_counts(0);
    let shifted = tile >> vec2u(level);
    return Center(depth, level * u32(tiles.x * tiles.y) + u32(shifted.y * tiles.x + shifted.x), seen);
}

@compute @workgroup_size(64)
fn find_fronts(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index < arrayLength(&particles) {
        let center = center_of(particles[index]);
        if center.seen {
            atomicMax(&fronts[center.front], bitcast<u32>(nearness_of(center.depth)));
        }
    }
}

fn is_in_front(particle: vec4f) -> bool {
    if grid.skip_hidden == 0u {
        return particle.w > 0.0;
    }
    let center = center_of(particle);
    let nearest = depth_of(bitcast<f32>(max(atomicLoad(&fronts[center.front]), 1u)));
    return center.seen && center.depth <= nearest + FRONT * particle.w;
}

// Lists particles from `first` on, one for each bit of `chosen`, by one addition for all of a lane: those of all lanes queue up.
fn add_to_list(first: u32, chosen: u32) {
    if chosen == 0u {
        return;
    }
    var place = atomicAdd(&list.count, countOneBits(chosen));
    for (var left = chosen; left != 0u; left &= left - 1u) {
        list.items[place] = first + firstTrailingBit(left);
        place++;
    }
}

@compute @workgroup_size(64)
fn list_fronts(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let first = PER_LANE * item_index(group, groups, lane, 64u);
    let end = min(first + PER_LANE, arrayLength(&particles));
    var chosen = 0u;
    for (var index = first; index < end; index++) {
        chosen |= u32(is_in_front(particles[index])) << (index - first);
    }
    add_to_list(first, chosen);
}

@compute @workgroup_size(64)
fn cover_tiles(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = i32(item_index(group, groups, lane, 64u));
    let columns = tile_counts(0).x;
    let tile = vec2i(item % columns, item / columns);
    let low = tile * TILE;
    let high = min(low + TILE, vec2i(view.size));
    if low.y >= high.y {
        return;
    }
    var least = 0xffffffffu;
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            least = min(least, nearness[u32(y) * view.size.x + u32(x)]);
        }
    }
    atomicStore(&covered[covered_level(0) + item], least);
}

// Wider tiles from the narrower, a lane for each of the widest.
@compute @workgroup_size(64)
fn cover_wide_tiles(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = i32(item_index(group, groups, lane, 64u));
    let widest = tile_counts(TILE_LEVELS - 1);
    if item >= widest.x * widest.y {
        return;
    }
    let place = vec2i(item % widest.x, item / widest.x);
    for (var level = 1; level < TILE_LEVELS; level++) {
        let finer = tile_counts(level - 1);
        let tiles = tile_counts(level);
        let low = place << vec2u(u32(TILE_LEVELS - 1 - level));
        let high = min((place + 1) << vec2u(u32(TILE_LEVELS - 1 - level)), tiles);
        for (var y = low.y; y < high.y; y++) {
            for (var x = low.x; x < high.x; x++) {
                var least = 0xffffffffu;
                for (var k = 0; k < 4; k++) {
                    let part = min(2 * vec2i(x, y) + vec2i(k & 1, k >> 1u), finer - 1);
                    least = min(least, atomicLoad(&covered[covered_level(level - 1) + part.y * finer.x + part.x]));
                }
                atomicStore(&covered[covered_level(level) + y * tiles.x + x], least);
            }
        }
    }
}

// No ellipsoid of a particle at this depth reaches farther than this from its place: its longest axis, where the two others
// are equally short, and the way to a mean of neighbours. A hundredth more covers rounding.
fn most_reach(radius: f32, depth: f32) -> f32 {
    let share = stretch_share(radius, depth);
    let longest = pow(grid.kappa, share * 2.0 / 3.0) * radius * settings.splat_scale;
    return 1.01 * (longest + share * MOST_EVENING * grid.center_smoothing * support_of(radius, grid));
}

// A drop between the pixel centres of a coarse image shows as one pixel beside them.
fn show_box(bounds: Ball) -> PixelBox {
    let box = texel_box(bounds, 1.0, view.size);
    let margin = select(0, 1, settings.fluid_scale > 1.0);
    return PixelBox(max(box.min - margin, vec2i(0)), min(box.max + margin, vec2i(view.size) - 1));
}

fn shape_can_show(particle: vec4f) -> bool {
    let center = (view.view_from_local * vec4f(particle.xyz, 1.0)).xyz;
    let bounds = sphere(center, most_reach(particle.w, -center.z));
    return is_drawn(bounds) && can_show(bounds, show_box(bounds));
}

@compute @workgroup_size(64)
fn list_rest(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let first = PER_LANE * item_index(group, groups, lane, 64u);
    let end = min(first + PER_LANE, arrayLength(&particles));
    var chosen = 0u;
    for (var index = first; index < end; index++) {
        let particle = particles[index];
        let is_left = particle.w > 0.0 && !is_in_front(particle);
        chosen |= u32(is_left && shape_can_show(particle)) << (index - first);
    }
    add_to_list(first, chosen);
}

@compute @workgroup_size(1)
fn count_list() {
    let groups = (atomicLoad(&list.count) + 63u) / 64u;
    list_groups = vec3u(min(groups, 65535u), (groups + 65534u) / 65535u, 1u);
}
