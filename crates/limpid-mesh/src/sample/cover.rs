//! Points spread over a surface.

use std::collections::HashMap;

use glam::DVec3;

use super::Triangle;

/// Points are nowhere nearer than this many spacings. Then a surface takes one for each square of the spacing.
const LEAST_DISTANCE: f64 = 0.775;

/// Darts for each square of the spacing: more find hardly any gap.
const DARTS_PER_SQUARE: f64 = 20.0;

/// A point of the surface.
pub(super) struct Dart {
    pub position: DVec3,
    pub triangle: usize,
    pub weights: [f64; 3],
}

pub(super) fn darts(triangles: &[Triangle], area: f64, spacing: f64) -> Vec<Dart> {
    let mut sum = 0.0;
    let areas_up_to: Vec<f64> = triangles
        .iter()
        .map(|triangle| {
            sum += 0.5 * triangle.doubled_area().length();
            sum
        })
        .collect();
    let mut kept = Kept::new(LEAST_DISTANCE * spacing);
    let thrown = (DARTS_PER_SQUARE * area / spacing.powi(2)).ceil().max(1.0) as u64;
    for index in 0..thrown {
        let [place, u, v] = [0, 1, 2].map(|axis| random(3 * index + axis));
        let triangle = areas_up_to.partition_point(|up_to| *up_to <= place * sum).min(triangles.len() - 1);
        let weights = if u + v < 1.0 { [1.0 - u - v, u, v] } else { [u + v - 1.0, 1.0 - u, 1.0 - v] };
        let position = triangles[triangle].at(weights);
        kept.add(Dart { position, triangle, weights });
    }
    kept.darts
}

/// The number of this index in a random sequence, from 0 to 1 (SplitMix64: Steele, Lea and Flood, 2014).
fn random(index: u64) -> f64 {
    let mut bits = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ bits >> 31) >> 11) as f64 / (1_u64 << 53) as f64
}

/// The darts so far, in cells of twice the distance that they keep.
struct Kept {
    distance: f64,
    darts: Vec<Dart>,
    /// The latest dart of each cell.
    latest: HashMap<[i64; 3], usize>,
    /// The dart before, in the same cell.
    before: Vec<Option<usize>>,
}

impl Kept {
    fn new(distance: f64) -> Self {
        Self { distance, darts: Vec::new(), latest: HashMap::new(), before: Vec::new() }
    }

    fn cell(&self, position: DVec3) -> [i64; 3] {
        (position / (2.0 * self.distance)).floor().to_array().map(|x| x as i64)
    }

    /// Keeps a dart unless another is too near.
    fn add(&mut self, dart: Dart) {
        let low = self.cell(dart.position - self.distance);
        let high = self.cell(dart.position + self.distance);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut next = self.latest.get(&[x, y, z]).copied();
                    while let Some(index) = next {
                        if self.darts[index].position.distance_squared(dart.position) < self.distance.powi(2) {
                            return;
                        }
                        next = self.before[index];
                    }
                }
            }
        }
        let cell = self.cell(dart.position);
        self.before.push(self.latest.insert(cell, self.darts.len()));
        self.darts.push(dart);
    }
}
