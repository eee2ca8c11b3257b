//! Ellipsoids against the f64 twin.

use crate::fluid::{Fluid, Particle};
use crate::scenes::{SIZE, cloud, dam_break, from_above, looking, mark_of, marked, slab, stretched};
use crate::twin;
use glam::{DVec3, Vec3};
use limpid::{Anisotropy, Settings, View};

/// Every ellipsoid: nothing is left out.
fn all() -> Settings {
    let anisotropy = Anisotropy { center_smoothing: 0.9, ..stretched().anisotropy };
    Settings { anisotropy, skip_hidden: false, ..stretched() }
}

/// Compares every `step`th particle; `reach` is the farthest that any may look for neighbours.
fn compare(particles: &[Particle], step: usize, reach: f64) {
    compare_in(&looking(DVec3::new(0.0, 30.0, 90.0), DVec3::ZERO), all(), |_| 1.0, particles, step, reach);
}

/// `share_of` a radius is how much of its stretch is drawn.
fn compare_in(
    view: &View,
    settings: Settings,
    share_of: impl Fn(f64) -> f64,
    particles: &[Particle],
    step: usize,
    reach: f64,
) {
    let drawn = Fluid::new().draw(particles, view, SIZE, &settings);
    assert_eq!(drawn.ellipsoids.len(), particles.len());
    let mut met = vec![false; particles.len()];
    for ellipsoid in drawn.ellipsoids {
        let index = mark_of(ellipsoid.radius);
        assert!(!std::mem::replace(&mut met[index], true), "particle {index} twice");
        if index.is_multiple_of(step) {
            let share = share_of(f64::from(particles[index].radius));
            let twin = twin::ellipsoid(particles, index, &settings.anisotropy, reach, share);
            // Beside the sums' own rounding, that of positions far from the origin.
            let off = (ellipsoid.center - twin.center).length() - 2e-7 * twin.center.length();
            let bent = (ellipsoid.shape - twin.shape).to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            assert!(
                off < 2e-4,
                "center of {index}: {} for {}, {} neighbours",
                ellipsoid.center,
                twin.center,
                twin.neighbours
            );
            assert!(
                bent < 3e-3,
                "shape of {index}: {} for {}, {} neighbours, {:?}",
                ellipsoid.shape,
                twin.shape,
                twin.neighbours,
                twin.flatness
            );
        }
    }
}

#[test]
fn random_clouds_of_any_density() {
    for (seed, half) in [(1, 8.0), (2, 12.0), (3, 20.0), (4, 60.0)] {
        compare(&marked(cloud(2000, half, seed)), 1, 12.0);
    }
}

#[test]
fn lattices_lines_and_planes() {
    let whole = |n: i32| (-n..=n).map(|k| 2.0 * k as f32);
    let lattice = whole(4).flat_map(|x| whole(4).flat_map(move |y| whole(4).map(move |z| Vec3::new(x, y, z))));
    compare(&marked(lattice), 1, 12.0);
    compare(&marked(whole(30).map(|x| Vec3::new(x, 0.0, 0.0))), 1, 12.0);
    compare(&marked((0..400).map(|k| Vec3::new(0.05 * k as f32, 0.02 * k as f32, -0.03 * k as f32))), 1, 12.0);
    compare(&marked(whole(15).flat_map(|x| whole(15).map(move |z| Vec3::new(x, 0.0, z)))), 1, 12.0);
    compare(&marked(slab(8, 4, 0.24)), 1, 12.0);
}

#[test]
fn cells_on_every_side_of_the_origin_and_far_drops() {
    let mut positions = cloud(1500, 10.0, 5);
    positions.extend(cloud(200, 5.0, 6).iter().map(|p| *p + Vec3::new(3e4, -2e4, 1e4)));
    compare(&marked(positions), 1, 12.0);
}

#[test]
fn a_real_frame() {
    compare(&marked(dam_break()), 97, 12.0);
}

#[test]
fn each_particle_looks_as_far_as_its_own_radius_says() {
    let particles: Vec<Particle> = marked(cloud(3000, 12.0, 8));
    let radius = |index: usize, mark: f32| mark * [1.0, 2.0, 0.5, 1.5][index % 4];
    let scaled: Vec<Particle> = particles
        .iter()
        .enumerate()
        .map(|(index, p)| Particle { radius: radius(index, p.radius), ..p.clone() })
        .collect();
    let settings = all();
    let drawn = Fluid::new().draw(&scaled, &looking(DVec3::Z * 50.0, DVec3::ZERO), SIZE, &settings);
    for ellipsoid in drawn.ellipsoids.iter().step_by(7) {
        let index = scaled.iter().position(|p| p.radius == ellipsoid.radius).unwrap();
        let twin = twin::ellipsoid(&scaled, index, &settings.anisotropy, f64::INFINITY, 1.0);
        assert!((ellipsoid.center - twin.center).length() < 3e-4);
    }
}

#[test]
fn coincident_points_stay_round_and_cost_little() {
    let few = vec![Vec3::new(1.0, 2.0, 3.0); 40];
    compare(&marked(few), 1, 12.0);
    let many = marked(vec![Vec3::ZERO; 50_000]);
    let drawn = Fluid::new().draw(&many, &looking(DVec3::Z * 10.0, DVec3::ZERO), SIZE, &all());
    assert!(drawn.ellipsoids.iter().all(|e| e.center == DVec3::ZERO && e.shape == glam::DMat3::IDENTITY));
}

/// Between `min_radius_px` and 4/3 of it they turn from spheres into ellipsoids.
#[test]
fn small_particles_are_stretched_less() {
    let particles = marked(slab(8, 4, 0.24));
    for radius_px in [1.4, 1.625, 1.75, 2.1] {
        let settings = Settings { anisotropy: Anisotropy { min_radius_px: 1.5, ..all().anisotropy }, ..all() };
        let view = from_above(f64::from(SIZE[1]) / radius_px);
        let share_of = |radius: f64| (3.0 * (radius_px * radius / 1.5 - 1.0)).clamp(0.0, 1.0);
        compare_in(&view, settings, share_of, &particles, 1, 12.0);
    }
}
