// Perlin's gradient noise in three dimensions (Perlin 2002), with a hash in place of the table: another pattern for every
// seed, and no period to notice.

fn lattice_hash(cell: vec3i, seed: u32) -> u32 {
    let u = bitcast<vec3u>(cell);
    var h = seed ^ (u.x * 0x8da6b343u) ^ (u.y * 0xd8163841u) ^ (u.z * 0xcb1ab31fu);
    h = (h ^ (h >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    return h ^ (h >> 16u);
}

// The offset from a lattice point along one of the twelve directions to a cube's edges.
fn along_gradient(hash: u32, offset: vec3f) -> f32 {
    let g = hash % 12u;
    let one = select(offset.y, offset.x, g < 8u);
    let other = select(offset.z, offset.y, g < 4u);
    return select(-one, one, (g & 1u) == 0u) + select(-other, other, (g & 2u) == 0u);
}

fn perlin(at: vec3f, seed: u32) -> f32 {
    let low = floor(at);
    let part = at - low;
    let smooth_part = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    var sum = 0.0;
    for (var corner = 0; corner < 8; corner++) {
        let step = vec3i(corner & 1, (corner >> 1u) & 1, corner >> 2u);
        let along = select(1.0 - smooth_part, smooth_part, step == vec3i(1));
        let value = along_gradient(lattice_hash(vec3i(low) + step, seed), part - vec3f(step));
        sum += along.x * along.y * along.z * value;
    }
    return sum;
}
