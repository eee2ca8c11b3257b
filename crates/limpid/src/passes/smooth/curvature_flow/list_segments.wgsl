// Lists the segments that hold fluid, LINES lines at a time, and clears the pieces of the others. One frame's fluid covers
// the same pixels in every step.

@group(1) @binding(0) var<storage, read> occupied: array<u32>; // for each tile, in rows
@group(1) @binding(1) var<storage, read_write> segments: Segments;
@group(1) @binding(2) var<storage, read_write> pieces: array<Piece>;

struct Segments {
    groups: vec3u, // indirect dispatch of one group for LINES segments
    count: atomic<u32>,
    places: array<u32>, // segment along the line | line / LINES << 16; order varies, results do not
}

fn list_segments(item: u32, axis: vec2i) {
    let along = segments_along(axis);
    let place = vec2u(item % along, item / along);
    let lines = lines_of(axis);
    if place.y * LINES >= lines {
        return;
    }
    let tiles = (view.size + TILE - 1u) / TILE;
    let end = min((place.x + 1u) * (SEGMENT / TILE), u32(dot(vec2i(tiles), axis)));
    var fluid = 0u;
    for (var i = place.x * (SEGMENT / TILE); i < end; i++) {
        let tile = i * vec2u(axis) + place.y * vec2u(axis.yx);
        fluid |= occupied[tile.y * tiles.x + tile.x];
    }
    if fluid != 0u {
        segments.places[atomicAdd(&segments.count, 1u)] = place.x | (place.y << 16u);
        return;
    }
    for (var line = place.y * LINES; line < min((place.y + 1u) * LINES, lines); line++) {
        pieces[piece_slot(vec2u(place.x, line), axis)] = Piece(vec3f(0.0), vec3f(0.0));
    }
}

@compute @workgroup_size(64)
fn list_segments_of_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    list_segments(item_index(group, groups, lane, 64u), ROW);
}

@compute @workgroup_size(64)
fn list_segments_of_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    list_segments(item_index(group, groups, lane, 64u), COLUMN);
}

@compute @workgroup_size(1)
fn count_segments() {
    let count = (atomicLoad(&segments.count) + LINES - 1u) / LINES;
    segments.groups = vec3u(min(count, 65535u), (count + 65534u) / 65535u, 1u);
}
