//! Estimating the spacing of particles from how densely they lie.
//!
//! Water that has settled is no lattice: its particles come closer than their spacing to some neighbours and stay
//! farther from others, so that distances to nearest neighbours mislead by 10 to 20 %. What solvers keep constant is the
//! density, a kernel-weighted count of neighbours. So this finds the spacing s whose kernel of support 2 s, as most
//! solvers use, counts one particle per s³, at particles well inside the fluid.

use std::collections::HashMap;

use crate::parallel;

/// Particles whose neighbours are looked at.
const QUERIES: usize = 512;

/// Particles whose distances among themselves give the first guess.
const PAIRED: usize = 1500;

/// Support of the kernel in spacings.
const SUPPORT: f64 = 2.0;

/// Neighbours are gathered out to this many supports, so that the spacing may turn out larger than guessed.
const MARGIN: f64 = 1.5;

/// A query with more neighbours than this is in a clump, or the radius is much too large.
const CLUMP: usize = 1000;

/// The share of queries that are less dense than one well inside: at the surface, in sheets or in spray.
const INSIDE: f64 = 0.95;

/// Neighbours that fill a kernel; a lattice has 32. With fewer, the distance of the nearest ones tells more.
const FILLED: usize = 12;

/// Nearest neighbours are at the spacing in a lattice, and at 0.8 to 0.9 of it in settled water.
const SPACING_PER_NEAREST: f64 = 1.1;

/// Solvers give a particle a volume between 0.8 s³ (older SPlisHSPlasH) and s³: water at rest is
/// packed by up to 7 % closer than the lattice it started from. This stands between.
const SPACING_PER_PACKING: f64 = 1.025;

const ROUNDS: usize = 24;

/// Particles that a core looks at in the time that it takes to ask it.
const LEAST_SHARE: usize = 1 << 16;

pub(crate) fn estimate_spacing(positions: &[[f32; 3]]) -> Option<f64> {
    let mut spacing = guess(positions)?;
    let queries: Vec<[f32; 3]> = sample(positions, QUERIES).collect();
    for _ in 0..ROUNDS {
        let reach = spacing * SUPPORT * MARGIN;
        let neighbours = neighbour_distances(positions, &queries, reach);
        let clumps = neighbours.iter().filter(|distances| distances.len() >= CLUMP).count();
        let nearest = median(neighbours.iter().filter_map(|distances| distances.iter().copied().reduce(f64::min)));
        match nearest {
            _ if 2 * clumps > queries.len() => spacing *= 0.5,
            None => spacing *= 2.0,
            Some(nearest) => {
                let (refined, filled) = refine(&neighbours, spacing);
                let refined =
                    if filled { SPACING_PER_PACKING * refined } else { refined.min(SPACING_PER_NEAREST * nearest) };
                if refined * SUPPORT <= reach {
                    return Some(refined);
                }
                spacing = refined;
            }
        }
    }
    None
}

/// An upper bound that is about right for a body of fluid: the distance of nearest neighbours in a sample, scaled to
/// the whole.
fn guess(positions: &[[f32; 3]]) -> Option<f64> {
    let sampled: Vec<[f32; 3]> = sample(positions, PAIRED).collect();
    let nearest = |a: &[f32; 3]| {
        let squares = sampled.iter().map(|b| distance_squared(*a, *b));
        squares.filter(|square| *square > 0.0).reduce(f64::min).map(f64::sqrt)
    };
    let share = sampled.len() as f64 / positions.len() as f64;
    Some(median(sampled.iter().filter_map(nearest))? * share.cbrt())
}

/// An even sample in steps that no regular order of the particles resonates with.
fn sample(positions: &[[f32; 3]], count: usize) -> impl Iterator<Item = [f32; 3]> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let all = positions.len() <= count;
    (0..count.min(positions.len())).map(move |index| {
        let at = if all { index } else { ((index as f64 * GOLDEN).fract() * positions.len() as f64) as usize };
        positions[at]
    })
}

/// The distances from each query to the particles within reach that are not in the same place.
fn neighbour_distances(positions: &[[f32; 3]], queries: &[[f32; 3]], reach: f64) -> Vec<Vec<f64>> {
    // A particle far out falls into a wrong cell, and finds no query there.
    let per_cell = (1.0 / reach) as f32;
    let cell = |position: [f32; 3]| position.map(|x| floor(x * per_cell));
    let mut near: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
    let mut mask = Mask::new();
    for (index, query) in queries.iter().enumerate() {
        let [x, y, z] = cell(*query);
        for shift in 0..27 {
            let [dx, dy, dz] = [shift % 3 - 1, shift / 3 % 3 - 1, shift / 9 - 1];
            let around = [x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz)];
            near.entry(around).or_default().push(index);
            mask.set(around);
        }
    }
    let of_share = |share: &[[f32; 3]]| {
        let (mut near, mut neighbours) = (near.clone(), vec![Vec::new(); queries.len()]);
        for &position in share {
            let cell = cell(position);
            if !mask.has(cell) {
                continue;
            }
            let Some(indices) = near.get_mut(&cell) else { continue };
            indices.retain(|&index| {
                let distance = distance_squared(position, queries[index]).sqrt();
                if distance > 0.0 && distance <= reach {
                    neighbours[index].push(distance);
                }
                neighbours[index].len() < CLUMP
            });
        }
        neighbours
    };
    let shares = positions.chunks(positions.len().div_ceil(parallel::threads()).max(LEAST_SHARE)).collect();
    let joined = parallel::map(shares, of_share).into_iter().reduce(|mut neighbours, others| {
        for (distances, mut others) in neighbours.iter_mut().zip(others) {
            distances.append(&mut others);
            distances.truncate(CLUMP);
        }
        neighbours
    });
    joined.unwrap_or_default()
}

/// The whole number below, without asking a library where the processor's first instructions lack it.
fn floor(x: f32) -> i32 {
    let whole = x as i32;
    whole.wrapping_sub(i32::from(x < whole as f32))
}

/// A small set of cells that may say yes to others too: it spares most particles the look-up in a larger map.
struct Mask(Vec<u64>);

impl Mask {
    const BITS: u32 = 18;

    fn new() -> Self {
        Self(vec![0; 1 << (Self::BITS - 6)])
    }

    fn bit([x, y, z]: [i32; 3]) -> usize {
        let mixed = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
            ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
            ^ (z as u64).wrapping_mul(0x1656_67b1_9e37_79f9);
        (mixed.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - Self::BITS)) as usize
    }

    fn set(&mut self, cell: [i32; 3]) {
        let bit = Self::bit(cell);
        self.0[bit >> 6] |= 1 << (bit & 63);
    }

    fn has(&self, cell: [i32; 3]) -> bool {
        let bit = Self::bit(cell);
        self.0[bit >> 6] >> (bit & 63) & 1 == 1
    }
}

/// Finds the spacing that agrees with the density which its kernel measures, and whether there are enough neighbours
/// for it to mean anything.
fn refine(neighbours: &[Vec<f64>], guess: f64) -> (f64, bool) {
    const STEPS: usize = 12;
    let mut spacing = guess;
    let mut filled = false;
    for _ in 0..STEPS {
        let support = SUPPORT * spacing;
        let mut measured: Vec<(f64, usize)> = neighbours
            .iter()
            .filter(|distances| distances.len() < CLUMP)
            .map(|distances| {
                let inside = distances.iter().filter(|distance| **distance < support);
                let (density, count) = inside.fold((0.0, 0), |(sum, count), r| (sum + kernel(*r, support), count + 1));
                (density + kernel(0.0, support), count)
            })
            .collect();
        let inside = (INSIDE * (measured.len() - 1) as f64) as usize;
        let (_, &mut (density, count), _) = measured.select_nth_unstable_by(inside, |a, b| a.0.total_cmp(&b.0));
        spacing = density.cbrt().recip();
        filled = count >= FILLED;
    }
    (spacing, filled)
}

/// The cubic spline kernel of SPH.
fn kernel(distance: f64, support: f64) -> f64 {
    let q = distance / support;
    let shape = if q <= 0.5 { 6.0 * (q - 1.0) * q * q + 1.0 } else { 2.0 * (1.0 - q).max(0.0).powi(3) };
    8.0 / (std::f64::consts::PI * support.powi(3)) * shape
}

fn distance_squared(a: [f32; 3], b: [f32; 3]) -> f64 {
    (0..3).map(|axis| (f64::from(a[axis]) - f64::from(b[axis])).powi(2)).sum()
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
