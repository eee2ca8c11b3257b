// From the fluid's own lower resolution to the picture's (van der Laan 2009, section 3.5.1): the shaded colour is blended,
// over silhouettes too, which softens them; depth and normals are interpolated only within one sheet of fluid.
//
// Colours are blended by weights that fall with their brightness (Karis 2013, after Reinhard's tone curve): a glint in one
// texel, many times as bright as white, would otherwise be a white disc of eight texels' width.

@group(1) @binding(0) var<storage, read> raw: array<f32>;
@group(1) @binding(1) var<storage, read> nearness: array<f32>;
@group(1) @binding(2) var<storage, read> surface: array<vec4f>;
@group(1) @binding(3) var<storage, read> shaded: array<vec4f>;
@group(1) @binding(4) var<storage, read_write> picture_raw: array<f32>;
@group(1) @binding(5) var<storage, read_write> picture_nearness: array<f32>; // negative where less than half is fluid
@group(1) @binding(6) var<storage, read_write> picture_surface: array<vec4f>;
@group(1) @binding(7) var<storage, read_write> picture_shaded: array<vec4f>;
@group(1) @binding(8) var scene_depth: texture_depth_2d;

@compute @workgroup_size(8, 8)
fn upsample(@builtin(global_invocation_id) pixel: vec3u) {
    if any(pixel.xy >= settings.picture_size) {
        return;
    }
    let index = pixel.y * settings.picture_size.x + pixel.x;
    let at = (vec2f(pixel.xy) + 0.5) / settings.fluid_scale - 0.5;
    let low = floor(at);
    let part = at - low;

    // No loops over the corners: to CPU drivers they are dear.
    let last = vec2i(view.size) - 1;
    let first = vec2u(clamp(vec2i(low), vec2i(0), last));
    let second = vec2u(clamp(vec2i(low) + 1, vec2i(0), last));
    let texels = vec4u(first.y, first.y, second.y, second.y) * view.size.x + vec4u(first.x, second.x, first.x, second.x);
    let near = vec4f(nearness[texels.x], nearness[texels.y], nearness[texels.z], nearness[texels.w]);
    let bilinear = vec4f(1.0 - part.x, part.x, 1.0 - part.x, part.x) * vec4f(vec2f(1.0 - part.y), vec2f(part.y));
    let weights = select(vec4f(0.0), bilinear, near > vec4f(0.0));
    picture_nearness[index] = 0.0;
    picture_raw[index] = 0.0;
    // But one that is left at once where there is no fluid is cheaper than a branch, of which they run both sides.
    for (var once = 0u; once < select(0u, 1u, any(weights > vec4f(0.0))); once++) {
        blend(index, (vec2f(pixel.xy) + 0.5) / settings.fluid_scale, texels, weights, near);
    }
}

// Where there is no fluid, the images hold anything.
fn part_of(value: vec4f, weight: f32) -> vec4f {
    return select(vec4f(0.0), weight * value, weight > 0.0);
}

// How much less a bright texel weighs, so that a glint does not spread.
fn dimming(color: vec4f) -> f32 {
    return 1.0 / (1.0 + max(color.r, max(color.g, color.b)));
}

// Writes a pixel of the picture that some fluid covers.
fn blend(index: u32, px: vec2f, texels: vec4u, weights: vec4f, near: vec4f) {
    let coverage = dot(weights, vec4f(1.0));
    // That of the covered texel with most weight.
    let most = max(max(weights.x, weights.y), max(weights.z, weights.w));
    let of_most = select(select(select(near.w, near.z, weights.z == most), near.y, weights.y == most), near.x, weights.x == most);
    let sheet_step = settings.normal_step * settings.radius / depth_slope(of_most);
    let of_sheet = select(vec4f(0.0), weights, abs(near - of_most) <= vec4f(sheet_step));
    let sheet = dot(of_sheet, vec4f(1.0));
    let colors = array(shaded[texels.x], shaded[texels.y], shaded[texels.z], shaded[texels.w]);
    let bright = weights * vec4f(dimming(colors[0]), dimming(colors[1]), dimming(colors[2]), dimming(colors[3]));
    let shares = select(vec4f(0.0), bright, weights > vec4f(0.0));
    let sum = part_of(colors[0], shares.x) + part_of(colors[1], shares.y) + part_of(colors[2], shares.z)
        + part_of(colors[3], shares.w);
    let color = sum * (coverage / dot(shares, vec4f(1.0)));
    let raw_near = vec4f(raw[texels.x], raw[texels.y], raw[texels.z], raw[texels.w]);
    let normal_thickness = part_of(surface[texels.x], of_sheet.x) + part_of(surface[texels.y], of_sheet.y)
        + part_of(surface[texels.z], of_sheet.z) + part_of(surface[texels.w], of_sheet.w);
    let nearest = dot(of_sheet, near) / sheet;
    // A fringe that is less than half fluid shows its colour but has no surface.
    let side = select(-1.0, 1.0, coverage >= 0.5);
    picture_nearness[index] = side * nearest;
    picture_raw[index] = side * dot(of_sheet, raw_near) / sheet;
    picture_surface[index] = vec4f(normalize(normal_thickness.xyz), normal_thickness.w / sheet);
    picture_shaded[index] = select(color, vec4f(0.0), depth_of(nearest) >= scene_depth_at(px));
}
