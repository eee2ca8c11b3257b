//! Large particle sets: one frame of a dam break, mirrored and tiled (the rule of data/README.md).

use limpid_io::ReadError;
use std::path::Path;
use std::sync::Arc;

/// Of all particles here, world units: half the spacing at rest.
pub const RADIUS: f32 = 0.025;

/// The frame that is tiled, 24,360 particles.
const FRAME: &[u8] = include_bytes!("../../../data/dam_break_double/ParticleData_Fluid_20.bgeo");

/// Widths that the resting water fills, and one spacing: mirrored neighbours meet.
const TILE: [f64; 2] = [3.05, 1.55];

/// A grid of tiles in x and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiled {
    /// Tiles in x.
    pub across: u32,
    /// Tiles in z.
    pub deep: u32,
}

impl Tiled {
    /// The smallest grid of about the shape of the others that holds this many particles, given those of a tile.
    pub fn holding(count: usize, tile: usize) -> Self {
        let tiles = count.div_ceil(tile.max(1)) as u32;
        let across = (f64::from(tiles) * 6.0 / 7.0).sqrt().round().max(1.0) as u32;
        Self { across, deep: tiles.div_ceil(across).max(1) }
    }

    /// The positions of one tile.
    ///
    /// # Errors
    /// Never, unless the repository's data are broken.
    pub fn tile() -> Result<Vec<[f32; 3]>, ReadError> {
        Ok(limpid_io::read_bytes(Path::new("ParticleData_Fluid_20.bgeo"), Arc::from(FRAME))?.positions)
    }

    /// All positions, x outermost, every second tile mirrored; worked out in f64, rounded once.
    pub fn positions(self, tile: &[[f32; 3]]) -> impl Iterator<Item = [f32; 3]> {
        let place = |index: u32, count: u32, width: f64| {
            let sign = if index % 2 == 1 { -1.0 } else { 1.0 };
            (sign, (f64::from(index) - f64::from(count - 1) / 2.0) * width)
        };
        let tiles = (0..self.across).flat_map(move |i| (0..self.deep).map(move |j| (i, j)));
        tiles.flat_map(move |(i, j)| {
            let (sign_x, offset_x) = place(i, self.across, TILE[0]);
            let (sign_z, offset_z) = place(j, self.deep, TILE[1]);
            tile.iter().map(move |[x, y, z]| {
                [(sign_x * f64::from(*x) + offset_x) as f32, *y, (sign_z * f64::from(*z) + offset_z) as f32]
            })
        })
    }
}
