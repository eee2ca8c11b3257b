// What all share who make or read the maps of what the lights see (shadow.rs).

// Slices of a texel of the fluid's map, and its words: the two depths, and the liquid up to the end of each slice.
const SHADOW_SLICES: u32 = 16u;
const SHADOW_WORDS: u32 = SHADOW_SLICES + 2u;

// An angle that differs from pixel to pixel: neighbours take other points of a disc, grain in place of steps.
fn turn_at(at: vec2f) -> f32 {
    return 6.2831853 * fract(52.9829189 * fract(dot(at, vec2f(0.06711056, 0.00583715))));
}

// A point of a disc, evenly spread (Vogel 1979), turned by an angle.
fn on_disc(tap: i32, taps: i32, turn: f32) -> vec2f {
    let angle = 2.39996323 * f32(tap) + turn;
    return sqrt((f32(tap) + 0.5) / f32(taps)) * vec2f(cos(angle), sin(angle));
}
