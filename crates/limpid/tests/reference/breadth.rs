//! How broad the sheets are that pixels belong to.

use super::nearness::Nearness;

/// Share of the smoothing length that each pixel gets: 0 up to a run of 2.5 drawn radii in the longer of its row and column,
/// 1 from 5 on. `drawn` and `step` in world units.
pub fn shares(image: &Nearness<'_>, drawn: f64, step: f64) -> Vec<f64> {
    let share = |(index, &center): (usize, &f64)| {
        if center <= 0.0 {
            return 0.0;
        }
        let stride = (drawn * image.camera.px_per_world(image.depth_of(center)) / 2.0).max(1.0);
        let at = image.place(index);
        let reach = |axis: [f64; 2]| {
            let place = |i: f64| {
                [
                    at[0] + (i * stride * axis[0]).round_ties_even() as i64,
                    at[1] + (i * stride * axis[1]).round_ties_even() as i64,
                ]
            };
            (1..=10).take_while(|&i| image.linked(place(f64::from(i) - 1.0), place(f64::from(i)), step)).count()
        };
        let run = |x: f64, y: f64| reach([x, y]) + reach([-x, -y]);
        let radii = run(1.0, 0.0).max(run(0.0, 1.0)) as f64 / 2.0;
        let part = ((radii - 2.5) / 2.5).clamp(0.0, 1.0);
        part * part * (3.0 - 2.0 * part)
    };
    image.values.iter().enumerate().map(share).collect()
}
