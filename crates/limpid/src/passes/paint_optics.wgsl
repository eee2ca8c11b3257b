// The liquid at a pixel, mixed from the paint of the particles there (paint_sums.wgsl, paint_shares.wgsl).
//
// What meets the eye first, the interface and what a thin layer under it scatters, goes by the particles near the surface; what
// is lost on the way through goes by all along the ray. Differences to the first liquid are what is mixed: liquids that look alike
// make the very same picture as one.
//
// Whoever includes this binds `liquids` and, read-only, `paint_sums`.

// Whether particles are of several liquids or colours.
override PAINT: bool = false;

struct Liquids {
    paint: Paint,
    looks: array<Optics, MOST_LIQUIDS>,
}

// Extinction of an opaque liquid, in 1 / r, where it is mixed with others or behind them.
const OPAQUE: f32 = 16.0;

// Words of the stand-in where nothing was summed: all is as the particles are on average.
const NO_SUMS: u32 = 16u;

// Along the whole ray, bilinear on each level of the pyramid.
fn body_shares(px: vec2f) -> Shares {
    var shares: Shares;
    let first = liquids.paint.body_first;
    if first == 0u {
        return shares;
    }
    let used = paint_sums[first];
    for (var level = 0u; level < settings.thickness_levels; level++) {
        if ((used >> level) & 1u) == 0u {
            continue;
        }
        let size = level_size(level);
        let start = level_start(level);
        let at = px / (settings.thickness_divisor * f32(1u << level)) - 0.5;
        let low = floor(at);
        let part = at - low;
        for (var corner = 0; corner < 4; corner++) {
            let offset = vec2i(corner & 1, corner >> 1u);
            let texel = vec2u(clamp(vec2i(low) + offset, vec2i(0), vec2i(size) - 1));
            let along = select(1.0 - part, part, offset == vec2i(1));
            add_shares(&shares, first + 1u + (start + texel.y * size.x + texel.x) * liquids.paint.planes, along.x * along.y);
        }
    }
    return shares;
}

// A look with the particles' colour, in the form that is mixed: all that is lost counts as scattered, and `albedo` is what comes
// back of it.
fn resolved(look: Optics, color: vec3f) -> Optics {
    var own = look;
    let paint = liquids.paint;
    if paint.coloring == COLORING_SURFACE {
        let is_clear = max(look.scattering.r, max(look.scattering.g, look.scattering.b)) <= 0.0;
        let is_metal = max(look.metal.r, max(look.metal.g, look.metal.b)) > 0.0;
        own.opacity = select(look.opacity, 1.0, is_clear);
        own.albedo = select(color, look.albedo, is_metal);
        own.metal = select(look.metal, color, is_metal);
        own.color = vec3f(0.0);
    }
    if paint.coloring == COLORING_ABSORPTION {
        own.absorption = color * paint.absorption;
        own.color = exp(-DARKEST_DENSITY * color) * max(look.color.r, max(look.color.g, look.color.b));
    }
    own.albedo = scattered_of(own);
    own.scattering = own.absorption + own.scattering;
    own.absorption = vec3f(0.0);
    return own;
}

fn extinction_in_mixture(own: Optics) -> vec3f {
    return select(own.scattering, vec3f(OPAQUE / settings.radius), own.opacity >= 1.0);
}

// What reflects straight back.
fn normal_reflectance(own: Optics) -> vec3f {
    let ratio = (own.refractive_index - 1.0) / (own.refractive_index + 1.0);
    let is_metal = max(own.metal.r, max(own.metal.g, own.metal.b)) > 0.0;
    return select(vec3f(ratio * ratio), own.metal, is_metal);
}

fn mixed(shares: Shares) -> Optics {
    let first = resolved(liquids.looks[0], shares.color);
    var mixture = first;
    let count = liquids.paint.liquids;
    if count <= 1u {
        return mixture;
    }
    let first_extinction = extinction_in_mixture(first);
    let first_reflectance = normal_reflectance(first);
    var extinction = first_extinction;
    var reflectance = first_reflectance;
    var metals = select(0.0, 1.0, max(first.metal.r, max(first.metal.g, first.metal.b)) > 0.0);
    for (var k = 1u; k < count; k++) {
        let share = shares.liquids[k];
        let other = resolved(liquids.looks[k], shares.color);
        extinction += share * (extinction_in_mixture(other) - first_extinction);
        reflectance += share * (normal_reflectance(other) - first_reflectance);
        metals += share * max(other.metal.r, max(other.metal.g, other.metal.b));
        mixture.opacity += share * (other.opacity - first.opacity);
        mixture.refractive_index += share * (other.refractive_index - first.refractive_index);
        mixture.refraction += share * (other.refraction - first.refraction);
        mixture.specular += share * (other.specular - first.specular);
        mixture.shininess += share * (other.shininess - first.shininess);
        mixture.roughness += share * (other.roughness - first.roughness);
    }
    for (var k = 1u; k < count; k++) {
        let other = resolved(liquids.looks[k], shares.color);
        // Of all that is lost, what this liquid takes.
        let share = shares.liquids[k] * extinction_in_mixture(other) / max(extinction, vec3f(1e-30));
        mixture.albedo += share * (other.albedo - first.albedo);
        mixture.color += share * (other.color - first.color);
    }
    mixture.scattering = max(extinction, vec3f(0.0));
    mixture.metal = select(vec3f(0.0), reflectance, metals > 0.0);
    return mixture;
}

// Paint near the surface and along the ray, shares of 1.
struct PixelShares {
    surface: Shares,
    body: Shares,
}

fn shares_at(pixel: TilePixel) -> PixelShares {
    let surface = surface_shares(pixel.at);
    let body = body_shares(vec2f(pixel.at) + 0.5);
    if surface.weight <= 0.0 {
        return PixelShares(normalized(body), normalized(body));
    }
    if body.weight <= 0.0 {
        return PixelShares(normalized(surface), normalized(surface));
    }
    return PixelShares(normalized(surface), normalized(body));
}

// The shares of the first three liquids near the surface.
fn liquids_at(pixel: TilePixel) -> vec3f {
    if !PAINT {
        return vec3f(1.0, 0.0, 0.0);
    }
    let others = shares_at(pixel).surface.liquids;
    var first = 1.0;
    for (var k = 1u; k < liquids.paint.liquids; k++) {
        first -= others[k];
    }
    return vec3f(first, others[1], others[2]);
}

// The look at a pixel of the fluid, `thickness` deep in world units.
fn optics_at(pixel: TilePixel, thickness: f32) -> Optics {
    if !PAINT {
        return liquids.looks[0];
    }
    if arrayLength(&paint_sums) <= NO_SUMS {
        var unknown: Shares;
        return mixed(normalized(unknown));
    }
    let shares = shares_at(pixel);
    var mixture = mixed(shares.surface);
    let whole = mixed(shares.body);
    // The share of what is lost on the way that is lost near the surface.
    let lost_there = 1.0 - exp(-mixture.scattering * min(thickness, liquids.paint.layer));
    let lost = 1.0 - exp(-whole.scattering * thickness);
    let share = select(clamp(lost_there / max(lost, vec3f(1e-6)), vec3f(0.0), vec3f(1.0)), vec3f(1.0), mixture.opacity >= 1.0);
    mixture.albedo = whole.albedo + share * (mixture.albedo - whole.albedo);
    mixture.color = whole.color + share * (mixture.color - whole.color);
    mixture.scattering = whole.scattering;
    return mixture;
}
