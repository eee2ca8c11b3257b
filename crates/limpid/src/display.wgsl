// From linear scene light to what a screen shows; the target encodes sRGB.

struct Display {
    exposure: f32,
    tone_map: u32, // 0: clip, 1: roll highlights off
}

@group(0) @binding(0) var<uniform> display: Display;
@group(0) @binding(1) var linear: texture_2d<f32>;

// Khronos PBR Neutral: base colours up to 0.8 keep hue and nearly their value, highlights roll off to white.
fn neutral(light: vec3f) -> vec3f {
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    let least = min(light.r, min(light.g, light.b));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let color = light - offset;
    let peak = max(color.r, max(color.g, color.b));
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let blend = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    return mix(color * (new_peak / peak), vec3f(new_peak), blend);
}

@fragment
fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let premultiplied = textureLoad(linear, vec2u(position.xy), 0);
    let alpha = clamp(premultiplied.a, 0.0, 1.0);
    // Straight alpha, as PNG wants it; what shines beyond its coverage clips.
    let light = display.exposure * premultiplied.rgb / max(alpha, 1e-6);
    let mapped = select(light, neutral(light), display.tone_map == 1u);
    return vec4f(select(vec3f(0.0), clamp(mapped, vec3f(0.0), vec3f(1.0)), alpha > 0.0), alpha);
}
