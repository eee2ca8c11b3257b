// Curvature flow with one lane for a whole line: for CPUs, which a few hundred lanes keep busy. Long runs are what their caches
// look ahead for, and a step is half the dispatches.

fn solve(line: u32, axis: vec2i) {
    if line >= lines_of(axis) {
        return;
    }
    let share = Share(line, i32(line) * axis.yx, axis, 0, dot(vec2i(view.size), axis));
    _ = eliminate(share);
    substitute(share, vec2f(0.0));
}

@compute @workgroup_size(LINES)
fn solve_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    solve(item_index(group, groups, lane, LINES), ROW);
}

@compute @workgroup_size(LINES)
fn solve_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    solve(item_index(group, groups, lane, LINES), COLUMN);
}
