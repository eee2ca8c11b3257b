// The balls of the particles.

@group(1) @binding(0) var<storage, read> particles: array<vec4f>; // local position, particle radius; 0: left out
@group(1) @binding(1) var<storage, read> densities: array<f32>; // one for each particle of spheres, or unused
@group(1) @binding(2) var<storage, read> shapes: array<vec4u>; // shape.wgsl's; one for each particle of ellipsoids, or unused

// Radius 0: left out.
fn ball_of(index: u32) -> Ball {
    let particle = particles[index];
    let center = (view.view_from_local * vec4f(particle.xyz, 1.0)).xyz;
    let radius = particle.w * settings.splat_scale;
    if !ELLIPSOIDS {
        let stray = settings.density_threshold > 0.0 && densities[index] < settings.density_threshold;
        return sphere(center, select(radius, 0.0, stray));
    }
    let turn = mat3x3f(view.view_from_local[0].xyz, view.view_from_local[1].xyz, view.view_from_local[2].xyz);
    let shape = unpack_shape(shapes[index]);
    let stretch = turn * shape;
    let spread = radius * radius * stretch * transpose(stretch);
    let round_from_view = inverse_of_symmetric(shape) * transpose(turn);
    return Ball(center, radius, spread, round_from_view, sqrt(spread[2][2]));
}
