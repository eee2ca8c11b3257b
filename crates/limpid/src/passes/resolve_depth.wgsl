// The farthest of a pixel's samples: fluid before it is to be seen in some of them, and the host's depth test takes it from
// the others.

@group(1) @binding(0) var samples: texture_depth_multisampled_2d;

@fragment
fn resolve_depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    let pixel = vec2u(position.xy);
    var farthest = textureLoad(samples, pixel, 0);
    for (var sample = 1u; sample < textureNumSamples(samples); sample++) {
        let depth = textureLoad(samples, pixel, sample);
        farthest = select(min(farthest, depth), max(farthest, depth), host_depth_grows());
    }
    return farthest;
}
