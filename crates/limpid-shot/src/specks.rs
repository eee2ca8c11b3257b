//! Strays of the fluid as spray: each breaks up into specks.

use crate::frame::Strays;

/// What a stray breaks up into.
const SPECKS: u64 = 12;
/// Specks are at most so far from where the stray is, in its radii.
const REACH: f32 = 1.4;
/// How much farther along the stray's way.
const STRETCH: f32 = 2.0;

/// Centres and radii of specks, and the velocities of their strays. They are the same in every frame for a stray with an id, and ride
/// with it. `size`: their mean radius in the stray's.
pub(crate) fn specks(strays: &Strays, size: f32) -> Strays {
    let mut specks = Strays::default();
    let mut velocities = Vec::new();
    for (index, (place, radius)) in strays.positions.iter().zip(&strays.radii).enumerate() {
        let id = strays.ids.as_ref().map_or(index as i64, |ids| ids[index]);
        let velocity = strays.velocities.as_ref().map(|velocities| velocities[index]);
        let way = unit(velocity.unwrap_or_default());
        for k in 0..SPECKS {
            let mut random = Random((id as u64).wrapping_mul(SPECKS).wrapping_add(k));
            let offset = random.in_ball();
            let along = (STRETCH - 1.0) * dot(offset, way);
            let reach = REACH * radius;
            specks.positions.push([0, 1, 2].map(|axis| place[axis] + reach * (offset[axis] + along * way[axis])));
            // Mostly small ones.
            specks.radii.push(radius * size * (0.5 + 1.5 * random.unit().powi(2)));
            velocities.extend(velocity);
        }
    }
    specks.velocities = strays.velocities.is_some().then_some(velocities);
    specks
}

/// SplitMix64.
struct Random(u64);

impl Random {
    /// From 0 to 1.
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Within a radius of 1, denser in the middle.
    fn in_ball(&mut self) -> [f32; 3] {
        let height = 2.0 * self.unit() - 1.0;
        let (sin, cos) = (std::f32::consts::TAU * self.unit()).sin_cos();
        let across = (1.0 - height * height).max(0.0).sqrt();
        let distance = self.unit().sqrt();
        [across * cos, across * sin, height].map(|x| distance * x)
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// 0 of what has no direction.
fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = dot(v, v).sqrt();
    if length > 0.0 && length.is_finite() { v.map(|x| x / length) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stray(id: i64, place: [f32; 3], velocity: [f32; 3]) -> Strays {
        Strays { positions: vec![place], radii: vec![0.1], velocities: Some(vec![velocity]), ids: Some(vec![id]) }
    }

    #[test]
    fn specks_ride_with_their_stray() {
        let [before, after] = [[1.0, 2.0, 3.0], [1.5, 2.0, 3.0]].map(|at| specks(&stray(7, at, [9.0, 0.0, 0.0]), 0.2));
        assert_eq!(before.positions.len(), SPECKS as usize);
        assert_eq!(before.radii, after.radii);
        for (a, b) in before.positions.iter().zip(&after.positions) {
            assert!((b[0] - a[0] - 0.5).abs() < 1e-6 && b[1..] == a[1..], "{a:?} {b:?}");
            assert!((a[0] - 1.0).abs() <= 0.1 * REACH * STRETCH && (a[1] - 2.0).abs() <= 0.1 * REACH, "{a:?}");
        }
        assert!(before.radii.iter().all(|radius| (0.01..=0.04).contains(radius)), "{:?}", before.radii);
        assert_eq!(before.velocities, Some(vec![[9.0, 0.0, 0.0]; SPECKS as usize]));
        assert_ne!(specks(&stray(8, [1.0, 2.0, 3.0], [9.0, 0.0, 0.0]), 0.2).positions, before.positions);
    }

    #[test]
    fn strays_at_rest_or_of_unknown_speed_break_up_all_round() {
        let resting = specks(&stray(7, [0.0; 3], [0.0; 3]), 0.2);
        let unknown = specks(&Strays { velocities: None, ..stray(7, [0.0; 3], [0.0; 3]) }, 0.2);
        assert_eq!(resting.positions, unknown.positions);
        assert_eq!(unknown.velocities, None);
        assert!(resting.positions.iter().all(|at| dot(*at, *at).sqrt() <= 0.1 * REACH + 1e-6));
    }
}
