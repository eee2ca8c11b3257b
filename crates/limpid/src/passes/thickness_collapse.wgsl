// Collapses the thickness pyramid into one image, in world units.

@group(1) @binding(0) var<storage, read> sums: array<u32>;
@group(1) @binding(1) var<storage, read> levels_used: u32;
@group(1) @binding(2) var<storage, read_write> thickness: array<f32>;
@group(1) @binding(3) var<storage, read> between: array<u32>;
@group(1) @binding(4) var<storage, read> ranges: array<vec2f>;
@group(1) @binding(5) var<storage, read_write> hidden: array<Hidden>;

// Counts before the nearest and before the farthest depth of `range`, whether any are behind the nearest and the farthest.
struct Counts {
    near: f32,
    far: f32,
    behind_near: f32,
    behind_far: f32,
}

fn level_texel(level: u32, start: u32, size: vec2u, at: vec2i, range: vec2f) -> Counts {
    let texel = vec2u(clamp(at, vec2i(0), vec2i(size) - 1));
    let index = start + texel.y * size.x + texel.x;
    let free = f32(min(sums[index], 0x80000000u));
    if !IN_SCENE {
        return Counts(free, free, 0.0, 0.0);
    }
    let word = between[index];
    let amid = f32(word & 0x7fffffffu);
    let behind = f32(word >> 31u);
    let own = ranges[index];
    let near = range_part(own, range.x);
    let far = range_part(own, range.y);
    // All of the liquid amid a coarse texel's depths is before the far one only where that is the coarse texel's own.
    return Counts(
        free + near * amid,
        free + far * amid,
        max(behind, select(0.0, 1.0, amid * (1.0 - near) > 0.0)),
        max(behind, select(0.0, 1.0, amid * (1.0 - far) > 0.0)),
    );
}

fn plus(a: Counts, weight: f32, b: Counts) -> Counts {
    let used = select(0.0, 1.0, weight > 0.0);
    return Counts(
        a.near + weight * b.near,
        a.far + weight * b.far,
        max(a.behind_near, used * b.behind_near),
        max(a.behind_far, used * b.behind_far),
    );
}

// Sums of all levels; those above the finest are interpolated.
@compute @workgroup_size(8, 8)
fn collapse(@builtin(global_invocation_id) texel: vec3u) {
    if any(texel.xy >= settings.thickness_size) {
        return;
    }
    let index = texel.y * settings.thickness_size.x + texel.x;
    var range = vec2f(3.4e38);
    if IN_SCENE {
        range = ranges[index];
    }
    var total = Counts(0.0, 0.0, 0.0, 0.0);
    // Mostly there is only the finest level.
    let levels = 32u - countLeadingZeros(levels_used);
    for (var level = 0u; level < levels; level++) {
        let start = level_start(level);
        let size = level_size(level);
        let at = (vec2f(texel.xy) + 0.5) / f32(1u << level) - 0.5;
        let low = floor(at);
        let part = at - low;
        let corner = vec2i(low);
        if level == 0u {
            total = plus(total, 1.0, level_texel(level, start, size, corner, range));
            continue;
        }
        for (var i = 0; i < 4; i++) {
            let offset = vec2i(i & 1, i >> 1u);
            let along = select(1.0 - part, part, offset == vec2i(1));
            total = plus(total, along.x * along.y, level_texel(level, start, size, corner + offset, range));
        }
    }
    let is_hidden = total.behind_near > 0.0;
    thickness[index] = select(total.far, -total.far, is_hidden) * settings.thickness_unit;
    if is_hidden {
        hidden[index] = Hidden(total.near * settings.thickness_unit, total.behind_far);
    }
}
