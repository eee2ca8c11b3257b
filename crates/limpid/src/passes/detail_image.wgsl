// The noise image: a texel for `divisor` x `divisor` pixels of the fluid, in up to three planes of fixed-point sums.

struct Detail {
    size: vec2u, // texels
    divisor: u32, // pixels along a texel
    octaves: u32,
    height: f32, // of the ripples, r
    frequency: f32, // of the first octave, 1 / r
    agitated_gain: f32,
    foam: u32, // FOAM_*
    foam_color: vec3f,
    foam_opacity: f32,
    foam_begins: f32, // world units per second
    foam_full: f32,
    has_motion: u32,
}

const MOST_OCTAVES: u32 = 4u;

const FOAM_OFF: u32 = 0u;
const FOAM_AGITATION: u32 = 1u;
const FOAM_SPEED: u32 = 2u;

// Counts of a sum's 1, and where sums stop growing: far below overflow, and more than 60,000 particles in one place.
const SUM_UNIT: f32 = 16384.0;
const SUM_FULL: i32 = 0x3fffffff;

// The pixel that a texel samples: its centre's, or the one after.
fn texel_pixel(texel: vec2i, detail: Detail) -> vec2i {
    let pixel = texel * i32(detail.divisor) + i32(detail.divisor / 2u);
    return min(pixel, vec2i(view.size) - 1);
}
