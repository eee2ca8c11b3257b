// Light through the whole of the first sheet: bent where it enters, across the liquid to the back surface, bent where it
// leaves or mirrored there, and on through the air to the liquid or the scene beyond.

// Distance in r of the scene behind the back surface, square to it: less and the liquid lies on it, more and there is air.
const TOUCHING: f32 = 1.0;
const APART: f32 = 3.0;
// Refinements of where a bent ray meets a surface that is known from the eye only.
const MEETINGS: i32 = 3;
// In r: as good as infinitely far.
const FAR: f32 = 1e6;

// A place on a ray at a view depth; rays that hardly go deeper end soon.
fn ray_to(origin: vec3f, direction: vec3f, depth: f32) -> vec3f {
    return origin + direction * (max(depth + origin.z, 0.0) / max(-direction.z, 0.05));
}

fn is_on_screen(px: vec2f) -> bool {
    return all(px >= vec2f(0.0)) && all(px < vec2f(view.size));
}

// A direction bent by a surface; `normal` towards the side it comes from, `ratio` of the indices before and behind. No bend
// where `share` is 0.
fn bent(direction: vec3f, normal: vec3f, ratio: f32, share: f32) -> vec3f {
    let refracted = refract(direction, normal, ratio);
    return select(direction, normalize(mix(direction, refracted, share)), any(refracted != vec3f(0.0)));
}

// How far the light that a pixel collects spreads, per distance, once a curved surface has bent it: as far as the surface turns
// from one pixel to the next, twice, since there are two.
fn spread_of(sight: Sight) -> f32 {
    let turn = max(turn_toward(sight, vec2i(1, 0)), turn_toward(sight, vec2i(0, 1)));
    return 2.0 * (optics.refractive_index - 1.0) * turn;
}

fn turn_toward(sight: Sight, step: vec2i) -> f32 {
    let next = min(vec2i(sight.px) + step, vec2i(view.size) - 1);
    let index = u32(next.y) * view.size.x + u32(next.x);
    // Where there is no liquid, the surface is whatever it was.
    return select(0.0, length(surface[index].xyz - sight.normal), nearness[index] > 0.0);
}

// The surroundings where they have a share, else nothing. A loop, since CPUs run both sides of a branch.
fn surroundings_for(share: f32, place: vec3f, direction: vec3f, spread: f32) -> vec3f {
    let rotation = world_from_view();
    var light = vec3f(0.0);
    for (var once = 0u; once < select(0u, 1u, share > 0.0); once++) {
        light = surroundings(rotation * place, rotation * direction, spread);
    }
    return light;
}

// What a ray sees that leaves the liquid: liquid beyond the air, else the scene. Where the picture has neither, or shows too
// little of what so curved a surface gathers, the surroundings stand in, blurred as they should be.
//
// What the scene has before `front`, the depth of the liquid's front, has no say; balls may be drawn into it behind that.
fn seen_beyond(origin: vec3f, direction: vec3f, spread: f32, front: f32) -> vec4f {
    let depth = -origin.z;
    var px = px_of(origin);
    var beyond = beyond_at(px, depth);
    var step_px = 0.0;
    var wanted = depth;
    for (var meeting = 0; meeting < MEETINGS; meeting++) {
        let last = px;
        let scene = scene_depth_at(px);
        wanted = min(select(3.4e38, beyond.depth, beyond.coverage > 0.5), select(3.4e38, max(scene, depth), scene > front));
        if wanted < 1e30 {
            px = px_of(ray_to(origin, direction, wanted));
        } else if is_perspective() {
            // Infinitely far.
            px = px_of(select(direction, vec3f(1e9, 1e9, -1.0), direction.z > -0.02));
        }
        beyond = beyond_at(px, depth);
        step_px = length(px - last);
    }
    let is_hidden = beyond.depth >= scene_depth_at(px);
    let coverage = select(beyond.coverage, 0.0, is_hidden);
    if settings.background == BACKGROUND_NONE {
        return coverage * beyond.color;
    }
    let seen = scene_color_behind(clamp(px, vec2f(0.0), vec2f(view.size)), front);
    if settings.has_scene_depth == 0u {
        return mix(seen, beyond.color, coverage);
    }
    // In pixels.
    let reached = min(wanted, FAR * settings.radius);
    let blur = spread * (reached - depth) * px_per_world(reached);
    let lost = max(smoothstep(2.0, 8.0, blur), smoothstep(1.0, 6.0, step_px));
    // Where the host has left its picture transparent, there is nothing to stand in for.
    let unseen = seen.a * select(1.0, lost, is_on_screen(px));
    let around = surroundings_for(unseen, origin, direction, spread);
    return mix(mix(seen, vec4f(around, 1.0), unseen), beyond.color, coverage);
}

fn through_sheet(sight: Sight, sheet: FirstSheet) -> Behind {
    // Eq. 15's share of the bend; half of it, the default, is all that two surfaces do.
    let share = select(min(2.0 * optics.refraction, 1.0), 0.0, sight.is_submerged);
    let inside = bent(sight.toward, sight.normal, 1.0 / optics.refractive_index, share);
    var exit = ray_to(sight.position, inside, sheet.back_depth);
    var normal = sheet.back_normal;
    for (var meeting = 0; meeting < MEETINGS; meeting++) {
        let back = back_at(px_of(exit), sight.depth);
        if back.w > 0.0 {
            exit = ray_to(sight.position, inside, back.w);
            normal = back.xyz;
        }
    }
    // No farther than the scene.
    let scene = scene_depth_at(px_of(exit));
    exit = ray_to(sight.position, inside, min(-exit.z, max(scene, sight.depth)));
    // Towards the liquid, whatever noise is in it.
    normal = select(normal, -inside, dot(normal, inside) > -0.05);
    let distance = (scene + exit.z) * abs(dot(inside, normal));
    let air = share * smoothstep(TOUCHING, APART, distance / settings.radius);
    let refracted = refract(inside, normal, optics.refractive_index);
    let is_total = all(refracted == vec3f(0.0));
    let outside = bent(inside, normal, optics.refractive_index, air);
    let reflected = select(dot(reflectance_at(-dot(refracted, normal)), vec3f(1.0 / 3.0)), 1.0, is_total);
    let spread = share * spread_of(sight);
    let inner = surroundings_for(air * reflected, exit, reflect(inside, normal), max(spread, 0.1));
    let seen = seen_beyond(exit, outside, spread, sight.depth);
    return Behind(seen, 1.0 - air * reflected, inner, sheet.share * sight.thickness);
}

// What is behind the front surface and the liquid that it bounds.
fn behind_of(sight: Sight) -> Behind {
    let sheet = first_sheet(sight.px, nearness_of(sight.depth));
    if sheet.found {
        return through_sheet(sight, sheet);
    }
    return scene_behind(sight);
}
