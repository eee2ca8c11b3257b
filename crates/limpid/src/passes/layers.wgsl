// What shading reads of the sheets behind the front surface. Whoever includes this binds `layers`: three for each texel,
//   nearness of the front, nearness of the back of the first sheet, its share of the liquid, nearness of what is beyond,
//   the back's normal (towards the eye),
//   the shaded colour of what is beyond.

// How far apart in r a texel's front and a pixel's may be to be one sheet.
const SAME_SHEET: f32 = 4.0;

struct LayersTap {
    texels: vec4u,
    weights: vec4f,
}

// The four texels about a position of the fluid's images, bilinear. No loops here: to CPU drivers they are dear.
fn layers_tap(px: vec2f) -> LayersTap {
    let wide = settings.layers_px;
    let size = (view.size + wide - 1u) / wide;
    let at = px / f32(wide) - 0.5;
    let low = floor(at);
    let part = at - low;
    let last = vec2i(size) - 1;
    let first = vec2u(clamp(vec2i(low), vec2i(0), last));
    let second = vec2u(clamp(vec2i(low) + 1, vec2i(0), last));
    let columns = vec4u(first.x, second.x, first.x, second.x);
    let rows = vec4u(first.y, first.y, second.y, second.y);
    let weights = vec4f(1.0 - part.x, part.x, 1.0 - part.x, part.x) * vec4f(vec2f(1.0 - part.y), vec2f(part.y));
    return LayersTap(3u * (rows * size.x + columns), weights);
}

fn depths_of(nearness: vec4f) -> vec4f {
    return select((1.0 - nearness) * view.far, 1.0 / nearness, is_perspective());
}

// The back's normals, weighted.
fn back_normals(texels: vec4u, weights: vec4f) -> vec3f {
    return weights.x * layers[texels.x + 1u].xyz + weights.y * layers[texels.y + 1u].xyz
        + weights.z * layers[texels.z + 1u].xyz + weights.w * layers[texels.w + 1u].xyz;
}

// The first sheet at a pixel whose front is known.
struct FirstSheet {
    found: bool,
    share: f32,
    back_depth: f32,
    back_normal: vec3f,
}

fn first_sheet(px: vec2f, near: f32) -> FirstSheet {
    let tap = layers_tap(px);
    let step = SAME_SHEET * settings.radius / depth_slope(near);
    let texels = tap.texels;
    let values = transpose(mat4x4f(layers[texels.x], layers[texels.y], layers[texels.z], layers[texels.w]));
    let is_same = (values[0] > vec4f(0.0)) & (values[1] > vec4f(0.0)) & (abs(values[0] - near) <= vec4f(step));
    let weights = select(vec4f(0.0), tap.weights, is_same);
    let weight = dot(weights, vec4f(1.0));
    if weight <= 1e-4 {
        return FirstSheet(false, 1.0, 0.0, vec3f(0.0));
    }
    let normal = normalize(back_normals(texels, weights));
    return FirstSheet(true, dot(weights, values[2]) / weight, depth_of(dot(weights, values[1]) / weight), normal);
}

// The back of whatever sheet is first at a position, farther than a depth; depth 0: none.
fn back_at(px: vec2f, depth: f32) -> vec4f {
    let tap = layers_tap(px);
    let texels = tap.texels;
    let near = vec4f(layers[texels.x].y, layers[texels.y].y, layers[texels.z].y, layers[texels.w].y);
    let is_behind = (near > vec4f(0.0)) & (depths_of(near) > vec4f(depth));
    let weights = select(vec4f(0.0), tap.weights, is_behind);
    let weight = dot(weights, vec4f(1.0));
    if weight <= 1e-4 {
        return vec4f(0.0);
    }
    return vec4f(normalize(back_normals(texels, weights)), depth_of(dot(weights, near) / weight));
}

// Liquid beyond the air at a position, farther than a depth: its colour, how much of the position it covers, its depth.
struct Beyond {
    color: vec4f,
    coverage: f32,
    depth: f32,
}

fn beyond_at(px: vec2f, depth: f32) -> Beyond {
    let tap = layers_tap(px);
    let texels = tap.texels;
    let near = vec4f(layers[texels.x].w, layers[texels.y].w, layers[texels.z].w, layers[texels.w].w);
    let is_behind = (near > vec4f(0.0)) & (depths_of(near) > vec4f(depth));
    let weights = select(vec4f(0.0), tap.weights, is_behind);
    let color = weights.x * layers[texels.x + 2u] + weights.y * layers[texels.y + 2u]
        + weights.z * layers[texels.z + 2u] + weights.w * layers[texels.w + 2u];
    let coverage = dot(weights, vec4f(1.0));
    let some = max(coverage, 1e-9);
    return Beyond(color / some, coverage, select(3.4e38, depth_of(dot(weights, near) / some), coverage > 0.0));
}
