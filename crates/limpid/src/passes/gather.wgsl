// Particles out of the host's buffers, whatever their layout. Those that cannot be drawn get a radius of 0, which leaves them
// out everywhere, and a place where they are nobody's neighbours.

struct Gather {
    position_offset: u32, // words
    position_stride: u32,
    radius_offset: u32,
    radius_stride: u32,
    density_offset: u32,
    density_stride: u32,
    has_radii: u32,
    has_densities: u32,
    radius: f32, // where each has none of its own
}

@group(1) @binding(0) var<uniform> gather_from: Gather;
@group(1) @binding(1) var<storage, read> positions: array<u32>;
@group(1) @binding(2) var<storage, read> radii: array<u32>;
@group(1) @binding(3) var<storage, read> densities: array<u32>;
@group(1) @binding(4) var<storage, read_write> particles: array<vec4f>; // local position, radius
@group(1) @binding(5) var<storage, read_write> particle_densities: array<f32>;

const NOWHERE: vec3f = vec3f(1e15);

// By the bits: a compiler may take it that no float is infinite.
fn is_finite(bits: u32) -> bool {
    return (bits & 0x7f800000u) != 0x7f800000u;
}

@compute @workgroup_size(64)
fn gather(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index >= arrayLength(&particles) {
        return;
    }
    let first = gather_from.position_offset + index * gather_from.position_stride;
    let bits = vec3u(positions[first], positions[first + 1u], positions[first + 2u]);
    var radius_bits = bitcast<u32>(gather_from.radius);
    if gather_from.has_radii != 0u {
        radius_bits = radii[gather_from.radius_offset + index * gather_from.radius_stride];
    }
    let radius = bitcast<f32>(radius_bits);
    let has_place = is_finite(bits.x) && is_finite(bits.y) && is_finite(bits.z);
    let has_size = is_finite(radius_bits) && radius > 1e-18 && radius < 1e18;
    particles[index] = select(vec4f(NOWHERE, 0.0), vec4f(bitcast<vec3f>(bits), radius), has_place && has_size);
    if gather_from.has_densities != 0u {
        particle_densities[index] = bitcast<f32>(densities[gather_from.density_offset + index * gather_from.density_stride]);
    }
}
