// The splats that get a workgroup each, as kernels over particles list them. Whoever includes this binds `large`, and has
// a kernel `splat_large` that takes one of the list for each group.

struct LargeSplats {
    groups: vec3u, // indirect dispatch of splat_large
    count: atomic<u32>,
    indices: array<u32>,
}

@compute @workgroup_size(1)
fn count_large() {
    let count = atomicLoad(&large.count);
    large.groups = vec3u(min(count, 65535u), (count + 65534u) / 65535u, 1u);
}
