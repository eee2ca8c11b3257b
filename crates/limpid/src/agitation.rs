//! Which particles are agitated: a state that lives across frames, by the particles' ids.

use std::collections::HashMap;

/// Agitation of particles (van der Laan 2009, Eq. 12): a large change of velocity makes a particle hot, and it cools down.
///
/// The heat of a particle is 0 to 1. With `a` its change of velocity per second since the last frame and `t` the seconds
/// since then,
///
/// ```text
/// heat = max(heat of the last frame * exp(-t / cooling), clamp(a / threshold - 1, 0, 1))
/// ```
///
/// so that it cools alike at any frame rate, and is fully hot at twice the threshold. A particle that appears is calm, one
/// that vanishes is forgotten. The first frame of all has no velocity to compare with: there a particle is as hot as it is
/// fast, rising smoothly between the two speeds of `first_frame`.
#[derive(Clone, Debug)]
pub struct Agitation {
    limits: AgitationLimits,
    /// The last frame's particles in its order; None before the first.
    last: Option<Vec<Known>>,
}

/// What agitates particles and for how long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgitationLimits {
    /// tau of Eq. 12 per second: changes of velocity beyond it count, world units per second squared, above 0. Default 15: half again
    /// as much as gravity in metres, so that free fall never counts and impacts do.
    pub threshold: f64,
    /// Seconds in which the heat falls to 1 / e, above 0. Default 1.
    pub cooling: f64,
    /// World units per second at which particles of the first frame begin to be hot, and are fully. Default 1.8 and 6.
    pub first_frame: [f64; 2],
}

impl Default for AgitationLimits {
    fn default() -> Self {
        Self { threshold: 15.0, cooling: 1.0, first_frame: [1.8, 6.0] }
    }
}

/// What is remembered of a particle.
#[derive(Clone, Copy, Debug)]
struct Known {
    id: i64,
    velocity: [f32; 3],
    heat: f64,
}

impl Agitation {
    /// Of a fluid that is not known yet.
    pub fn new(limits: AgitationLimits) -> Self {
        Self { limits, last: None }
    }

    /// Forgets everything: the next frame is a first one.
    pub fn restart(&mut self) {
        self.last = None;
    }

    /// The heat of every particle of a frame that is `seconds` (above 0) after the last one, in the order of `ids`;
    /// `velocities` are in world units per second, as many as there are ids.
    pub fn advance(&mut self, seconds: f64, ids: &[i64], velocities: &[[f32; 3]]) -> Vec<f32> {
        let particles = || ids.iter().zip(velocities).map(|(id, velocity)| (*id, *velocity));
        let cooled = (-seconds / self.limits.cooling).exp();
        let next: Vec<Known> = match &self.last {
            None => particles().map(|(id, velocity)| Known { id, velocity, heat: self.first_heat(velocity) }).collect(),
            Some(last) => {
                let find = Finder::new(last, ids);
                let heat = |(place, (id, velocity)): (usize, (i64, [f32; 3]))| {
                    let heat = find.known(place, id).map_or(0.0, |known| {
                        let excess =
                            length(difference(velocity, known.velocity)) / seconds / self.limits.threshold - 1.0;
                        (known.heat * cooled).max(excess.clamp(0.0, 1.0))
                    });
                    Known { id, velocity, heat }
                };
                particles().enumerate().map(heat).collect()
            }
        };
        let heat = next.iter().map(|known| known.heat as f32).collect();
        self.last = Some(next);
        heat
    }

    fn first_heat(&self, velocity: [f32; 3]) -> f64 {
        let [low, high] = self.limits.first_frame;
        let part = ((length(velocity.map(f64::from)) - low) / (high - low)).clamp(0.0, 1.0);
        part * part * (3.0 - 2.0 * part)
    }
}

/// Finds the last frame's particles by id.
struct Finder<'a> {
    last: &'a [Known],
    /// None where the order is still the same, as it mostly is.
    places: Option<HashMap<i64, usize>>,
}

impl<'a> Finder<'a> {
    fn new(last: &'a [Known], ids: &[i64]) -> Self {
        let same = last.len() == ids.len() && last.iter().zip(ids).all(|(known, id)| known.id == *id);
        let places = (!same).then(|| last.iter().enumerate().map(|(place, known)| (known.id, place)).collect());
        Self { last, places }
    }

    fn known(&self, place: usize, id: i64) -> Option<&'a Known> {
        match &self.places {
            None => self.last.get(place),
            Some(places) => places.get(&id).map(|place| &self.last[*place]),
        }
    }
}

fn difference(a: [f32; 3], b: [f32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| f64::from(a[axis]) - f64::from(b[axis]))
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: [f32; 3] = [0.0; 3];

    #[test]
    fn a_kick_decays_as_stated_at_any_frame_rate() {
        for fps in [24.0, 25.0, 60.0] {
            let mut agitation = Agitation::new(AgitationLimits::default());
            assert_eq!(agitation.advance(1.0 / fps, &[7, 8], &[STILL; 2]), [0.0, 0.0]);
            let kicked = [0.0, 10.0, 0.0];
            assert_eq!(agitation.advance(1.0 / fps, &[7, 8], &[kicked, STILL]), [1.0, 0.0]);
            for frame in 1..=120 {
                let heat = agitation.advance(1.0 / fps, &[7, 8], &[kicked, STILL]);
                let expected = (-f64::from(frame) / fps).exp();
                assert!((f64::from(heat[0]) - expected).abs() <= 1e-7 * expected, "{fps} {frame}: {heat:?}");
                assert_eq!(heat[1], 0.0);
            }
        }
    }

    #[test]
    fn the_threshold_is_per_second() {
        for fps in [24.0, 25.0, 60.0_f64] {
            let mut agitation = Agitation::new(AgitationLimits::default());
            agitation.advance(1.0 / fps, &[0, 1, 2], &[STILL; 3]);
            let after = |acceleration: f64| [(acceleration / fps) as f32, 0.0, 0.0];
            let heat = agitation.advance(1.0 / fps, &[0, 1, 2], &[after(14.9), after(22.5), after(45.0)]);
            assert_eq!(heat[0], 0.0);
            assert!((heat[1] - 0.5).abs() < 1e-6, "{heat:?}");
            assert_eq!(heat[2], 1.0);
        }
    }

    #[test]
    fn the_state_goes_by_id_whatever_comes_goes_or_moves() {
        let mut agitation = Agitation::new(AgitationLimits::default());
        agitation.advance(0.04, &[1, 2, 3], &[STILL; 3]);
        agitation.advance(0.04, &[1, 2, 3], &[STILL, [9.0, 0.0, 0.0], STILL]);
        // 3 is gone, 4 is new and fast, 2 comes last.
        let heat = agitation.advance(0.04, &[4, 1, 2], &[[50.0, 0.0, 0.0], STILL, [9.0, 0.0, 0.0]]);
        assert_eq!(heat[..2], [0.0, 0.0]);
        assert!((heat[2] - (-0.04_f32).exp()).abs() < 1e-6, "{heat:?}");
        // Who comes back is new.
        agitation.advance(0.04, &[4, 1], &[[50.0, 0.0, 0.0], STILL]);
        assert_eq!(agitation.advance(0.04, &[2], &[[9.0, 0.0, 0.0]]), [0.0]);
    }

    #[test]
    fn a_first_frame_goes_by_speed() {
        let mut agitation = Agitation::new(AgitationLimits::default());
        let speeds = [1.0, 3.9, 7.0].map(|speed| [0.0, -speed, 0.0]);
        let heat = agitation.advance(0.04, &[1, 2, 3], &speeds);
        assert_eq!([heat[0], heat[2]], [0.0, 1.0]);
        assert!((heat[1] - 0.5).abs() < 1e-6, "{heat:?}");
        agitation.restart();
        assert_eq!(agitation.advance(0.04, &[1, 2, 3], &speeds), heat);
    }
}
