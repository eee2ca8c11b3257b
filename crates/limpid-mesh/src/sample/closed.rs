//! Whether a mesh has an inside, and how large it is.

use std::collections::HashMap;

use super::{SampleError, Triangle};

/// How often an edge is used.
#[derive(Default)]
struct Uses {
    triangles: usize,
    /// Those that go along it one way less those that go the other.
    balance: i64,
}

/// Checks that along each edge as many triangles go one way as the other.
pub(super) fn check(triangles: &[Triangle]) -> Result<(), SampleError> {
    let mut names: HashMap<[u64; 3], usize> = HashMap::new();
    let mut edges: HashMap<(usize, usize), Uses> = HashMap::new();
    for triangle in triangles {
        let corners = triangle.corners.map(|corner| {
            let next = names.len();
            // Zero may have a sign.
            *names.entry(corner.to_array().map(|x| (x + 0.0).to_bits())).or_insert(next)
        });
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let (from, to) = (corners[from], corners[to]);
            if from != to {
                let uses = edges.entry((from.min(to), from.max(to))).or_default();
                uses.triangles += 1;
                uses.balance += if from < to { 1 } else { -1 };
            }
        }
    }
    let count = |is_wrong: fn(&Uses) -> bool| edges.values().filter(|uses| is_wrong(uses)).count();
    match (count(|uses| uses.triangles % 2 == 1), count(|uses| uses.balance != 0)) {
        (0, 0) => Ok(()),
        (0, turned) => Err(SampleError::Turned(turned)),
        (open, _) => Err(SampleError::Open(open)),
    }
}

/// The volume of a closed mesh; what shells share counts for each of them.
pub(super) fn volume(triangles: &[Triangle]) -> f64 {
    let Some(origin) = triangles.first().map(|triangle| triangle.corners[0]) else { return 0.0 };
    let cone = |triangle: &Triangle| triangle.doubled_area().dot(triangle.corners[0] - origin) / 6.0;
    triangles.iter().map(cone).sum::<f64>().abs()
}
