// Shares of liquids and colours at a pixel's surface, from sums of paint (paint_sums.wgsl).
//
// Whoever includes this binds `liquids`, with its `paint`, and, read-only, `paint_sums`.

const MOST_LIQUIDS: u32 = 8u;

// Sums of paint in one place, or of several.
struct Shares {
    weight: f32,
    color: vec3f,
    liquids: array<f32, MOST_LIQUIDS>, // but the first
}

fn add_shares(shares: ptr<function, Shares>, first: u32, factor: f32) {
    let paint = liquids.paint;
    (*shares).weight += factor * f32(paint_sums[first]);
    if paint.coloring != COLORING_OFF {
        (*shares).color += factor * vec3f(vec3u(paint_sums[first + 1u], paint_sums[first + 2u], paint_sums[first + 3u]));
    }
    for (var k = 1u; k < paint.liquids; k++) {
        (*shares).liquids[k] += factor * f32(paint_sums[first + paint.first_liquid + k - 1u]);
    }
}

// As shares of 1.
fn normalized(shares: Shares) -> Shares {
    var result = shares;
    let weight = max(shares.weight, 1e-30);
    result.color = select(liquids.paint.mean_color, shares.color / weight, shares.weight > 0.0);
    for (var k = 1u; k < liquids.paint.liquids; k++) {
        result.liquids[k] = shares.liquids[k] / weight;
    }
    return result;
}

// Rings of pixels, each twice as wide as the one before, that are looked at where no particle is near: at the tips of long ellipsoids.
const RINGS: u32 = 5u;

fn surface_shares(at: vec2i) -> Shares {
    var shares: Shares;
    let size = vec2i(view.size);
    add_shares(&shares, liquids.paint.surface_first + u32(at.y * size.x + at.x) * liquids.paint.planes, 1.0);
    // No branch: CPU drivers execute both sides.
    var rings = select(0u, RINGS, shares.weight <= 0.0);
    for (var ring = 0u; ring < rings; ring++) {
        for (var side = 0; side < 9; side++) {
            let neighbour = at + (vec2i(side % 3, side / 3) - 1) * (1 << ring);
            if all(neighbour >= vec2i(0)) && all(neighbour < size) {
                let pixel = u32(neighbour.y * size.x + neighbour.x);
                add_shares(&shares, liquids.paint.surface_first + pixel * liquids.paint.planes, 1.0);
            }
        }
        rings = select(rings, 0u, shares.weight > 0.0);
    }
    return shares;
}
