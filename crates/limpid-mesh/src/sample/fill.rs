//! The points of a lattice inside a closed mesh, by rays along z that count the surfaces they cross.

use glam::{DVec2, DVec3, Vec3Swizzles as _};

use super::{SampleError, Triangle, check_count};

/// A ray through an empty part of the bounds costs less than a point by this factor or more.
const COLUMNS_PER_POINT: f64 = 10.0;

/// The lattice's places along one axis.
struct Axis {
    first: f64,
    count: usize,
    spacing: f64,
}

impl Axis {
    /// As many places as whole steps fit best, in the middle.
    fn over(min: f64, max: f64, spacing: f64) -> Self {
        let count = ((max - min) / spacing).round().max(1.0);
        Self { first: 0.5 * (min + max) - 0.5 * (count - 1.0) * spacing, count: count as usize, spacing }
    }

    fn at(&self, index: usize) -> f64 {
        self.first + index as f64 * self.spacing
    }

    /// The first index whose place is beyond x.
    fn beyond(&self, x: f64) -> usize {
        let mut index = (((x - self.first) / self.spacing).ceil().max(0.0) as usize).min(self.count);
        // Rounding may be off by one place.
        while index > 0 && self.at(index - 1) > x {
            index -= 1;
        }
        while index < self.count && self.at(index) <= x {
            index += 1;
        }
        index
    }
}

/// Where a ray crosses the surface.
struct Crossing {
    column: usize,
    z: f64,
    /// 1 on the side that faces along the ray, -1 on the other.
    turn: i32,
}

pub(super) fn lattice(triangles: &[Triangle], spacing: f64) -> Result<Vec<[f32; 3]>, SampleError> {
    let corners = || triangles.iter().flat_map(|triangle| triangle.corners);
    let min = corners().fold(DVec3::INFINITY, DVec3::min);
    let max = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    let base = (max - min).xy().max(DVec2::splat(spacing));
    check_count(base.x * base.y / COLUMNS_PER_POINT, 2, spacing)?;
    let [x, y, z] = [0, 1, 2].map(|axis| Axis::over(min[axis], max[axis], spacing));

    // A row of rays after the other, each with the triangles that reach over it.
    let mut waiting: Vec<(usize, usize, &Triangle)> = triangles.iter().map(|t| rows(t, &y)).collect();
    waiting.sort_by_key(|(first, ..)| std::cmp::Reverse(*first));
    let mut active: Vec<(usize, &Triangle)> = Vec::new();
    let mut crossings = Vec::new();
    let mut positions = Vec::new();
    for row in 0..y.count {
        active.retain(|(end, _)| *end > row);
        while let Some((_, end, triangle)) = waiting.pop_if(|(first, ..)| *first <= row) {
            active.push((end, triangle));
        }
        crossings.clear();
        active.iter().for_each(|(_, triangle)| cross(triangle, &x, y.at(row), &mut crossings));
        crossings.sort_by(|a: &Crossing, b| a.column.cmp(&b.column).then(a.z.total_cmp(&b.z)));
        for column in crossings.chunk_by(|a, b| a.column == b.column) {
            let mut winding = 0;
            for pair in column.windows(2) {
                winding += pair[0].turn;
                let inside = if winding == 0 { 0..0 } else { z.beyond(pair[0].z)..z.beyond(pair[1].z) };
                let place = |index| [x.at(pair[0].column), y.at(row), z.at(index)].map(|x| x as f32);
                positions.extend(inside.map(place));
            }
        }
    }
    Ok(positions)
}

/// The rows that a triangle may reach over: the first, and the one after the last.
fn rows<'a>(triangle: &'a Triangle, y: &Axis) -> (usize, usize, &'a Triangle) {
    let [a, b, c] = triangle.corners.map(|corner| corner.y);
    (y.beyond(a.min(b).min(c)).saturating_sub(1), y.beyond(a.max(b).max(c)), triangle)
}

/// Adds the crossings of a row of rays with a triangle.
fn cross(triangle: &Triangle, x: &Axis, y: f64, crossings: &mut Vec<Crossing>) {
    let [a, b, c] = triangle.corners;
    let columns = x.beyond(a.x.min(b.x).min(c.x)).saturating_sub(1)..x.beyond(a.x.max(b.x).max(c.x));
    let normal = triangle.doubled_area();
    for column in columns {
        let ray = DVec2::new(x.at(column), y);
        let turn = [(a, b), (b, c), (c, a)].map(|(from, to)| passes(from.xy(), to.xy(), ray)).iter().sum();
        if turn != 0 {
            let rise = (ray - a.xy()).dot(normal.xy()) / normal.z;
            let z = if rise.is_finite() { a.z - rise } else { a.z };
            let (low, high) = (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z));
            crossings.push(Crossing { column, z: z.clamp(low, high), turn });
        }
    }
}

/// How an edge passes a point on its right in the plane: upwards 1, downwards -1, not at all 0. The sum around a polygon is
/// its winding number there. The other way along the same edge it is the exact opposite even where it is rounded, so
/// that no ray slips through between two triangles.
fn passes(from: DVec2, to: DVec2, point: DVec2) -> i32 {
    let is_left = |low: DVec2, high: DVec2| i32::from((high - low).perp_dot(point - low) > 0.0);
    match (from.y <= point.y, to.y <= point.y) {
        (true, false) => is_left(from, to),
        (false, true) => -is_left(to, from),
        _ => 0,
    }
}
