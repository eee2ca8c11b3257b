// Ellipsoids along the surface: weighted principal components of each particle's neighbours (Xu et al. 2022, Eq. 3-7,
// after Yu and Turk 2013). Axes are proportional to the covariance's eigenvalues, the smallest at least the largest /
// kappa, with the volume of the particle's sphere; centres move towards the neighbours' mean.

@group(1) @binding(0) var<uniform> grid: Grid;
@group(1) @binding(1) var<storage, read> sorted: array<vec4f>; // neighbours.wgsl's
@group(1) @binding(2) var<storage, read> counts: array<u32>;
@group(1) @binding(3) var<storage, read> ends: array<u32>;
@group(1) @binding(4) var<storage, read> list: array<u32>; // count, then particles to work on: visible.wgsl's
@group(1) @binding(5) var<storage, read_write> balls: array<vec4f>; // drawn centre, particle radius
@group(1) @binding(6) var<storage, read_write> shapes: array<vec4u>; // shape.wgsl

// Weighted sums over neighbours and the particle itself, lengths in supports from the particle.
struct Moments {
    weight: f32,
    first: vec3f,
    diagonal: vec3f, // second: xx, yy, zz
    mixed: vec3f, // second: yz, zx, xy
}

// The particles of a row of cells: those of two ranges of the sorted order, the second where a block of buckets ends
// within the row.
struct Row {
    first: u32,
    first_count: u32,
    second: u32,
    count: u32,
}

fn row_of(start: vec3i, cells: i32) -> Row {
    let buckets = arrayLength(&ends);
    let split = min((start.x | (ROW - 1)) - start.x, cells - 1);
    let low = bucket_of(start, buckets);
    let first = ends[low] - counts[low];
    let first_count = ends[low + u32(split)] - first;
    if split == cells - 1 {
        return Row(first, first_count, 0u, first_count);
    }
    let high = bucket_of(start + vec3i(split + 1, 0, 0), buckets);
    let second = ends[high] - counts[high];
    return Row(first, first_count, second, first_count + ends[high + u32(cells - split - 2)] - second);
}

fn moments_of(position: vec3f, support: f32) -> Moments {
    var moments = Moments(0.0, vec3f(0.0), vec3f(0.0), vec3f(0.0));
    let center = cell_of(position, grid);
    let within = position / grid.cell - vec3f(center);
    let reach = support / grid.cell;
    let per_support = 1.0 / support;
    for (var z = -REACH; z <= REACH; z++) {
        for (var y = -REACH; y <= REACH; y++) {
            // The part of the row of cells that the support reaches.
            let gap = max(max(vec2f(f32(y), f32(z)) - within.yz, within.yz - vec2f(f32(y), f32(z)) - 1.0), vec2f(0.0));
            let half = sqrt(max(reach * reach - dot(gap, gap), 0.0));
            if half <= 0.0 {
                continue;
            }
            let low = max(i32(floor(within.x - half)), -REACH);
            let high = min(i32(floor(within.x + half)), REACH);
            let row = row_of(center + vec3i(low, y, z), high - low + 1);
            let count = select(row.count, 0u, row.count > CROWD);
            for (var k = 0u; k < count; k++) {
                let other = select(row.second + k - row.first_count, row.first + k, k < row.first_count);
                let offset = (sorted[other].xyz - position) * per_support;
                let squared = dot(offset, offset);
                let weight = max(1.0 - squared * sqrt(squared), 0.0);
                let weighted = weight * offset;
                moments.weight += weight;
                moments.first += weighted;
                moments.diagonal += weighted * offset;
                moments.mixed += weighted.yzx * offset.zxy;
            }
        }
    }
    return moments;
}

struct Eigen {
    values: vec3f,
    vectors: mat3x3f, // columns
}

// One Jacobi rotation of a symmetric matrix, which makes entry (p, q) 0.
fn rotate(m: ptr<function, mat3x3f>, vectors: ptr<function, mat3x3f>, p: u32, q: u32) {
    let off = (*m)[p][q];
    let gap = (*m)[q][q] - (*m)[p][p];
    // The smaller root of t^2 + (gap / off) t - 1 = 0, without a division that could overflow.
    let denominator = abs(gap) + sqrt(gap * gap + 4.0 * off * off);
    let t = select(0.0, select(-2.0, 2.0, gap >= 0.0) * off / denominator, denominator > 0.0);
    let c = inverseSqrt(1.0 + t * t);
    let s = t * c;
    var turn = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    turn[p][p] = c;
    turn[q][q] = c;
    turn[q][p] = s;
    turn[p][q] = -s;
    *m = transpose(turn) * *m * turn;
    *vectors = *vectors * turn;
}

// Five sweeps of Jacobi's method: float32's accuracy on any symmetric matrix, multiple eigenvalues too.
fn eigen_of(symmetric: mat3x3f) -> Eigen {
    var m = symmetric;
    var vectors = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    for (var sweep = 0; sweep < 5; sweep++) {
        rotate(&m, &vectors, 0u, 1u);
        rotate(&m, &vectors, 0u, 2u);
        rotate(&m, &vectors, 1u, 2u);
    }
    return Eigen(vec3f(m[0][0], m[1][1], m[2][2]), vectors);
}

// The way that evens the surface out, for a particle whose neighbours' mean lies there; both in supports. Going all the
// way to the mean (Yu and Turk, Eq. 6) would draw a flat surface in by FLAT_MEAN and edges by more. So particles on a
// surface go only as far as their mean is farther, and those just beneath keep their distance to it.
fn evening(mean: vec3f) -> vec3f {
    let ratio = length(mean) / FLAT_MEAN;
    let part = select(ratio - 1.0, 1.0 - 1.0 / max(ratio, 1.0), ratio > 1.0);
    return mean * min(part, MOST_EVENING / max(length(mean), 1e-9));
}

@compute @workgroup_size(64)
fn anisotropy(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = item_index(group, groups, lane, 64u);
    if item >= list[0] {
        return;
    }
    let index = list[1u + item];
    let particle = sorted[index];
    let share = stretch_share(particle.w, -(view.view_from_local * vec4f(particle.xyz, 1.0)).z);
    if share == 0.0 {
        return; // it is there as a sphere
    }
    let support = max(support_of(particle.w, grid), 1e-18);
    let moments = moments_of(particle.xyz, support);

    let weight = max(moments.weight, 1.0);
    let mean = moments.first / weight;
    let diagonal = moments.diagonal / weight - mean * mean;
    let mixed = moments.mixed / weight - mean.yzx * mean.zxy;
    let eigen = eigen_of(mat3x3f(
        vec3f(diagonal.x, mixed.z, mixed.y),
        vec3f(mixed.z, diagonal.y, mixed.x),
        vec3f(mixed.y, mixed.x, diagonal.z),
    ));

    // The kernel averages 1/2 over its support, so this is the number of neighbours in an even cloud; but one who comes or
    // goes does so at weight 0, and nothing pops.
    let neighbours = 2.0 * (weight - 1.0);
    let trust = share * clamp(2.0 * neighbours / grid.min_neighbours - 1.0, 0.0, 1.0);
    let largest = max(max(eigen.values.x, eigen.values.y), max(eigen.values.z, 1e-12));
    let values = max(eigen.values / largest, vec3f(1.0 / grid.kappa));
    let axes = pow(values * pow(values.x * values.y * values.z, -1.0 / 3.0), vec3f(trust));
    let v = eigen.vectors;
    let shape = mat3x3f(v[0] * axes.x, v[1] * axes.y, v[2] * axes.z) * transpose(v);
    balls[index] = vec4f(particle.xyz + grid.center_smoothing * trust * support * evening(mean), particle.w);
    shapes[index] = pack_shape(shape);
}
