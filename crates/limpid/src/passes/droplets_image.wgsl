// Droplets at each pixel of the fluid, in planes of fixed-point sums. All have one colour, so what hides what does not matter:
// their optical depths add up.

struct Droplets {
    color: vec3f, // linear, in full light
    density: f32, // optical depth in the middle of one
    shutter: f32, // seconds
    fade: f32, // seconds
    foam_lift: f32, // world units towards the eye
    bubble_lift: f32,
}

// Optical depth before the surface; behind it; that times the distance behind it; of that before the surface, what is foam
// on it, which shading lights with the surface.
const BEFORE: u32 = 0u;
const BEHIND: u32 = 1u;
const BEHIND_DISTANCE: u32 = 2u;
const AFLOAT: u32 = 3u;

// Counts of an optical depth of 1, and of that times 1 r.
const DEPTH_UNIT: f32 = 4096.0;
const DISTANCE_UNIT: f32 = 256.0;
// Droplets farther behind the surface than this many r count as that far.
const FARTHEST: f32 = 64.0;

fn opacity_of(optical_depth: f32) -> f32 {
    return 1.0 - exp(-optical_depth);
}
