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

    var texels: array<u32, 4>;
    var weights: array<f32, 4>;
    var coverage = 0.0;
    var color = vec4f(0.0);
    var color_weight = 0.0;
    var main_nearness = 0.0; // of the covered texel with most weight
    var main_weight = 0.0;
    for (var corner = 0; corner < 4; corner++) {
        let offset = vec2i(corner & 1, corner >> 1u);
        let texel = vec2u(clamp(vec2i(low) + offset, vec2i(0), vec2i(view.size) - 1));
        let along = select(1.0 - part, part, offset == vec2i(1));
        texels[corner] = texel.y * view.size.x + texel.x;
        let near = nearness[texels[corner]];
        weights[corner] = select(0.0, along.x * along.y, near > 0.0);
        if near > 0.0 {
            let texel_color = shaded[texels[corner]];
            let weight = weights[corner] / (1.0 + max(texel_color.r, max(texel_color.g, texel_color.b)));
            color += weight * texel_color;
            color_weight += weight;
        }
        coverage += weights[corner];
        if weights[corner] > main_weight {
            main_weight = weights[corner];
            main_nearness = near;
        }
    }
    picture_nearness[index] = 0.0;
    if coverage <= 0.0 {
        picture_raw[index] = 0.0;
        return;
    }

    let sheet_step = settings.normal_step * settings.radius / depth_slope(main_nearness);
    var sheet = 0.0;
    var near = 0.0;
    var raw_near = 0.0;
    var normal_thickness = vec4f(0.0);
    for (var corner = 0; corner < 4; corner++) {
        let value = nearness[texels[corner]];
        if weights[corner] > 0.0 && abs(value - main_nearness) <= sheet_step {
            sheet += weights[corner];
            near += weights[corner] * value;
            raw_near += weights[corner] * raw[texels[corner]];
            normal_thickness += weights[corner] * surface[texels[corner]];
        }
    }
    near /= sheet;
    raw_near /= sheet;
    // A fringe that is less than half fluid shows its colour but has no surface.
    let side = select(-1.0, 1.0, coverage >= 0.5);
    picture_nearness[index] = side * near;
    picture_raw[index] = side * raw_near;
    picture_surface[index] = vec4f(normalize(normal_thickness.xyz), normal_thickness.w / sheet);
    let px = (vec2f(pixel.xy) + 0.5) / settings.fluid_scale;
    color *= coverage / color_weight;
    picture_shaded[index] = select(color, vec4f(0.0), depth_of(near) >= scene_depth_at(px));
}
