// Layout of the thickness pyramid: level l halves the finest l times, rounded up; levels follow each other in one buffer.

fn level_size(level: u32) -> vec2u {
    let round_up = (1u << level) - 1u;
    return (settings.thickness_size + round_up) >> vec2u(level);
}

fn level_start(level: u32) -> u32 {
    var start = 0u;
    for (var finer = 0u; finer < level; finer++) {
        let size = level_size(finer);
        start += size.x * size.y;
    }
    return start;
}
