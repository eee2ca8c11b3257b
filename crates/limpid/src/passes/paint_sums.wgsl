// Sums of the particles' paint, in fixed point: at each pixel by nearness to the smoothed surface, and in the texels of the thickness
// pyramid by the length of the ray in each ball. Each place holds `planes` words: the weight, then what the weight times red, green
// and blue comes to where particles have colours, then the weight of each liquid but the first.
//
// Before them lies a word for each tile: the least nearness of the surface in it (paint_splat.wgsl).

struct Paint {
    planes: u32, // 0: all particles are alike
    first_liquid: u32, // plane of the second liquid
    liquids: u32,
    coloring: u32, // COLORING_*
    surface_first: u32, // words before the pixels
    body_first: u32, // words before the pyramid and the word of its levels in use; 0: there are none
    absorption: f32, // per world unit, of a colour as dark as any
    layer: f32, // world units of depth that the surface's paint stands for
    mean_color: vec3f, // of all particles
}

const COLORING_OFF: u32 = 0u;
const COLORING_SURFACE: u32 = 1u;
const COLORING_ABSORPTION: u32 = 2u;
// Minus the logarithm of the darkest colour of COLORING_ABSORPTION.
const DARKEST_DENSITY: f32 = 5.541264; // ln 255

// Sums stop growing here: far below overflow, and more than 30,000 particles in one place.
const FULL: u32 = 0x80000000u;

struct ParticlePaint {
    color: vec3f, // for COLORING_ABSORPTION density: 1 is as dark as any
    liquid: u32,
}

fn unpack_paint(packed: vec2u, paint: Paint) -> ParticlePaint {
    let words = vec3u(packed.x & 0xffffu, packed.x >> 16u, packed.y & 0xffffu);
    var color = vec3f(words) / 65535.0;
    if paint.coloring == COLORING_ABSORPTION {
        color = -log(max(color, vec3f(1.0 / 255.0))) / DARKEST_DENSITY;
    }
    return ParticlePaint(color, packed.y >> 16u);
}
