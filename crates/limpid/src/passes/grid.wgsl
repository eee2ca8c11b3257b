// The neighbour grid: particles sorted by cell. Cells are cubes of half the support's length, kept in a table of buckets
// by the hash of their coordinates, so that a scene may be as wide as it likes.
//
// A bucket's number holds the low bits of its cell's coordinates as they are; only the blocks of 16 x 8 x 8 cells are
// hashed. Cells less than 8 apart therefore never share a bucket, and no search meets one twice. Cells along x follow each
// other within a block, and so do their particles.

const ROW: i32 = 16; // cells along x whose particles follow each other
const REACH: i32 = 2; // cells that a search extends to either side
// A row of cells that holds more than this is no liquid (at rest one has 17 within reach) but data gone wrong, thousands
// of particles in one point perhaps: it is left out of every search, or a frame would take minutes.
const CROWD: u32 = 256u;

// The neighbours' mean of a particle on a flat surface of a lattice is that far away, in supports.
const FLAT_MEAN: f32 = 0.235;
// No centre moves farther than this, in supports.
const MOST_EVENING: f32 = 0.15;

struct Grid {
    cell: f32, // edge, world units
    support: f32, // r
    kappa: f32,
    min_neighbours: f32,
    center_smoothing: f32,
    skip_hidden: u32,
}

// How far a particle looks for neighbours, world units.
fn support_of(radius: f32, grid: Grid) -> f32 {
    return min(grid.support * radius, f32(REACH) * grid.cell);
}

// Coordinates beyond what an integer holds are clamped: float32 positions are coarser than cells there.
fn cell_of(position: vec3f, grid: Grid) -> vec3i {
    return vec3i(clamp(floor(position / grid.cell), vec3f(-1e9), vec3f(1e9)));
}

// `buckets` is a power of two.
fn bucket_of(cell: vec3i, buckets: u32) -> u32 {
    let block = vec3u(cell >> vec3u(4u, 3u, 3u));
    var hash = (block.x * 0x8da6b343u) ^ (block.y * 0xd8163841u) ^ (block.z * 0xcb1ab31fu);
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash = hash ^ (hash >> 13u);
    let low = vec3u(cell) & vec3u(15u, 7u, 7u);
    return ((hash << 10u) | (low.z << 7u) | (low.y << 4u) | low.x) & (buckets - 1u);
}
