// What shading reads of the sheets behind the front surface. Whoever includes this binds `layers`: three for each texel,
//   nearness of the front, nearness of the back of the first sheet, its share of the liquid, nearness of what is beyond,
//   the back's normal (towards the eye),
//   the shaded colour of what is beyond.

// How far apart in r a texel's front and a pixel's may be to be one sheet.
const SAME_SHEET: f32 = 4.0;

struct LayersTap {
    texels: array<u32, 4>,
    weights: array<f32, 4>,
}

// The four texels about a position of the fluid's images, bilinear.
fn layers_tap(px: vec2f) -> LayersTap {
    let wide = settings.layers_px;
    let size = (view.size + wide - 1u) / wide;
    let at = px / f32(wide) - 0.5;
    let low = floor(at);
    let part = at - low;
    var tap: LayersTap;
    for (var corner = 0; corner < 4; corner++) {
        let offset = vec2i(corner & 1, corner >> 1u);
        let texel = vec2u(clamp(vec2i(low) + offset, vec2i(0), vec2i(size) - 1));
        let along = select(1.0 - part, part, offset == vec2i(1));
        tap.texels[corner] = 3u * (texel.y * size.x + texel.x);
        tap.weights[corner] = along.x * along.y;
    }
    return tap;
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
    var weights = 0.0;
    var share = 0.0;
    var back = 0.0;
    var normal = vec3f(0.0);
    for (var corner = 0; corner < 4; corner++) {
        let values = layers[tap.texels[corner]];
        let is_same = values.x > 0.0 && values.y > 0.0 && abs(values.x - near) <= step;
        let weight = select(0.0, tap.weights[corner], is_same);
        weights += weight;
        share += weight * values.z;
        back += weight * values.y;
        normal += weight * layers[tap.texels[corner] + 1u].xyz;
    }
    if weights <= 1e-4 {
        return FirstSheet(false, 1.0, 0.0, vec3f(0.0));
    }
    return FirstSheet(true, share / weights, depth_of(back / weights), normalize(normal));
}

// The back of whatever sheet is first at a position, farther than a depth; depth 0: none.
fn back_at(px: vec2f, depth: f32) -> vec4f {
    let tap = layers_tap(px);
    var weights = 0.0;
    var sum = vec4f(0.0);
    for (var corner = 0; corner < 4; corner++) {
        let near = layers[tap.texels[corner]].y;
        let is_behind = near > 0.0 && depth_of(near) > depth;
        let weight = select(0.0, tap.weights[corner], is_behind);
        weights += weight;
        sum += weight * vec4f(layers[tap.texels[corner] + 1u].xyz, near);
    }
    if weights <= 1e-4 {
        return vec4f(0.0);
    }
    return vec4f(normalize(sum.xyz), depth_of(sum.w / weights));
}

// Liquid beyond the air at a position, farther than a depth: its colour, how much of the position it covers, its depth.
struct Beyond {
    color: vec4f,
    coverage: f32,
    depth: f32,
}

fn beyond_at(px: vec2f, depth: f32) -> Beyond {
    let tap = layers_tap(px);
    var coverage = 0.0;
    var near = 0.0;
    var color = vec4f(0.0);
    for (var corner = 0; corner < 4; corner++) {
        let value = layers[tap.texels[corner]].w;
        let is_behind = value > 0.0 && depth_of(value) > depth;
        let weight = select(0.0, tap.weights[corner], is_behind);
        coverage += weight;
        near += weight * value;
        color += weight * layers[tap.texels[corner] + 2u];
    }
    let some = max(coverage, 1e-9);
    return Beyond(color / some, coverage, select(3.4e38, depth_of(near / some), coverage > 0.0));
}
