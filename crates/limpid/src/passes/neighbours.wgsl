// Sorts particles by cell: counting sort into the buckets of grid.wgsl. Where a row of buckets starts in the sorted order
// depends on thread timing and means nothing; the order within a bucket is that of the particles' places, so that sums
// over neighbours have the same bits every time, also when the particles come in another order.

@group(1) @binding(0) var<uniform> grid: Grid;
@group(1) @binding(1) var<storage, read> positions: array<vec4f>; // local position, particle radius
@group(1) @binding(2) var<storage, read> densities: array<f32>;
@group(1) @binding(3) var<storage, read_write> counts: array<atomic<u32>>; // of each bucket, cleared; [buckets]: all before
@group(1) @binding(4) var<storage, read_write> ends: array<atomic<u32>>; // where each bucket's particles end when sorted
@group(1) @binding(5) var<storage, read_write> order: array<u32>; // particle indices by bucket
@group(1) @binding(6) var<storage, read_write> sorted: array<vec4f>; // radius 0: stray

fn bucket_count() -> u32 {
    return arrayLength(&ends);
}

@compute @workgroup_size(64)
fn count(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index < arrayLength(&positions) {
        atomicAdd(&counts[bucket_of(cell_of(positions[index].xyz, grid), bucket_count())], 1u);
    }
}

// One lane for each row of buckets takes room for its particles.
@compute @workgroup_size(64)
fn allocate(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let first = item_index(group, groups, lane, 64u) * u32(ROW);
    if first >= bucket_count() {
        return;
    }
    var total = 0u;
    for (var k = 0u; k < u32(ROW); k++) {
        total += atomicLoad(&counts[first + k]);
    }
    var next = 0u;
    if total > 0u {
        next = atomicAdd(&counts[bucket_count()], total);
    }
    for (var k = 0u; k < u32(ROW); k++) {
        // The bucket's start, which `scatter` moves to its end.
        atomicStore(&ends[first + k], next);
        next += atomicLoad(&counts[first + k]);
    }
}

@compute @workgroup_size(64)
fn scatter(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = item_index(group, groups, lane, 64u);
    if index < arrayLength(&positions) {
        order[atomicAdd(&ends[bucket_of(cell_of(positions[index].xyz, grid), bucket_count())], 1u)] = index;
    }
}

// Whether one particle is before another in a bucket. Those in the same place add the same to any sum.
fn is_before(a: vec4f, index_a: u32, b: vec4f, index_b: u32) -> bool {
    var before = index_a < index_b;
    before = select(a.z < b.z, before, a.z == b.z);
    before = select(a.y < b.y, before, a.y == b.y);
    return select(a.x < b.x, before, a.x == b.x);
}

// Moves each particle to its place in its bucket.
@compute @workgroup_size(64)
fn gather(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let slot = item_index(group, groups, lane, 64u);
    if slot >= arrayLength(&positions) {
        return;
    }
    let index = order[slot];
    var particle = positions[index];
    let bucket = bucket_of(cell_of(particle.xyz, grid), bucket_count());
    let end = atomicLoad(&ends[bucket]);
    let start = end - atomicLoad(&counts[bucket]);
    var place = slot;
    if end - start <= CROWD { // no search reads a larger one
        place = start;
        for (var other = start; other < end; other++) {
            place += u32(is_before(positions[order[other]], order[other], positions[index], index));
        }
    }
    if settings.density_threshold > 0.0 && densities[index] < settings.density_threshold {
        // Out of reach of all others.
        particle = vec4f(particle.xyz + 1e6 * grid.cell, 0.0);
    }
    sorted[place] = particle;
}
