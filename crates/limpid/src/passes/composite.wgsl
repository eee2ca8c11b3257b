// The fluid over the host's target, at the host's depth.

@group(1) @binding(0) var<storage, read> nearness: array<f32>;
@group(1) @binding(1) var<storage, read> shaded: array<vec4f>;

struct Fragment {
    @location(0) color: vec4f, // linear, premultiplied
    @builtin(frag_depth) depth: f32,
}

fn fluid_at(position: vec2f) -> Fragment {
    let pixel = min(vec2u(position), settings.picture_size - 1u);
    let index = pixel.y * settings.picture_size.x + pixel.x;
    let near = abs(nearness[index]);
    if near == 0.0 {
        discard;
    }
    let color = shaded[index];
    if color.a <= 0.0 {
        discard;
    }
    return Fragment(color, host_from_depth(depth_of(near)));
}

@fragment
fn composite(@builtin(position) position: vec4f) -> Fragment {
    return fluid_at(position.xy);
}

// For targets without depth.
@fragment
fn composite_color(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return fluid_at(position.xy).color;
}
