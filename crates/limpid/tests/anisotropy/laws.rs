//! What must hold whatever the particles are.

use crate::fluid::{Drawn, Fluid, Particle};
use crate::scenes::{SIZE, cloud, dam_break, from_above, looking, mark_of, marked, slab, stretched};
use glam::{DMat3, DVec3, Vec3};
use limpid::{Anisotropy, Scale, Settings, View};

fn bits(drawn: &Drawn) -> Vec<u32> {
    drawn.depth.iter().map(|depth| depth.to_bits()).collect()
}

fn dam_view() -> View {
    looking(DVec3::new(116.0, 100.0, 216.0), DVec3::new(0.0, 48.0, 0.0))
}

#[test]
fn skipping_hidden_particles_changes_no_bit() {
    let mut fluid = Fluid::new();
    let mut check = |particles: &[Particle], view: &View, settings: Settings, most: f64| {
        let with = fluid.draw(particles, view, SIZE, &settings);
        let without = fluid.draw(particles, view, SIZE, &Settings { skip_hidden: false, ..settings });
        assert!(bits(&with) == bits(&without));
        let worked_on = with.ellipsoids.iter().filter(|e| e.shape != DMat3::IDENTITY).count();
        assert!(worked_on as f64 <= most * particles.len() as f64, "{worked_on} of {} particles", particles.len());
    };
    let base = stretched();
    let still = Settings { anisotropy: Anisotropy { center_smoothing: 0.0, ..base.anisotropy }, ..base };
    let coarse = Settings { filter_scale: Scale::Quarter, ..base };
    let dam = marked(dam_break());
    let block = marked(slab(15, 20, 0.2));
    let coarse_spheres = Settings { filter_scale: Scale::Quarter, ..Settings::spheres() };
    for settings in [base, still, coarse, Settings::spheres(), coarse_spheres] {
        check(&dam, &dam_view(), settings, 1.0);
        check(&dam, &looking(DVec3::new(-10.0, 30.0, 20.0), DVec3::ZERO), settings, 0.8);
        check(&dam, &looking(DVec3::new(0.0, 5.0, 0.0), DVec3::new(30.0, 2.0, 10.0)), settings, 0.8);
        check(&block, &looking(DVec3::new(30.0, 40.0, 60.0), DVec3::new(0.0, -20.0, 0.0)), settings, 1.0);
        check(&block, &from_above(40.0), settings, 0.8);
        check(&marked(cloud(3000, 15.0, 11)), &looking(DVec3::Z * 50.0, DVec3::ZERO), settings, 1.0);
    }
}

#[test]
fn same_bits_every_run() {
    let dam = marked(dam_break());
    let first = Fluid::new().draw(&dam, &dam_view(), SIZE, &stretched());
    let mut fluid = Fluid::new();
    fluid.draw(&marked(cloud(40_000, 30.0, 12)), &dam_view(), SIZE, &stretched());
    for _ in 0..3 {
        assert!(bits(&fluid.draw(&dam, &dam_view(), SIZE, &stretched())) == bits(&first));
    }
}

#[test]
fn shuffled_particles_give_the_same_bits() {
    let dam = marked(dam_break());
    let mut shuffled = dam.clone();
    shuffled.sort_by_key(|p| mark_of(p.radius) * 7919 % 10_007);
    let mut fluid = Fluid::new();
    let [one, other] = [dam, shuffled].map(|particles| fluid.draw(&particles, &dam_view(), SIZE, &stretched()));
    assert!(bits(&one) == bits(&other));
}

#[test]
fn a_scene_far_from_the_origin_looks_the_same() {
    let particles = marked(slab(7, 3, 0.24));
    let shift = DVec3::new(1e5, -7e4, 9e4);
    let eye = DVec3::new(3.0, 20.0, 40.0);
    let mut fluid = Fluid::new();
    let here = fluid.draw(&particles, &looking(eye, DVec3::ZERO), SIZE, &stretched());
    let far = looking(eye + shift, shift);
    let there = fluid.draw_about(shift, &particles, &far, SIZE, &stretched());
    let off = here.depth.iter().zip(&there.depth).filter(|(a, b)| a != b && (*a - *b).abs() >= 0.02).count();
    assert!(off * 1000 <= here.depth.len(), "{off} pixels differ");
}

#[test]
fn ellipsoids_keep_the_volume_of_their_spheres() {
    let all = Settings { skip_hidden: false, ..stretched() };
    let drawn = Fluid::new().draw(&marked(dam_break()), &dam_view(), SIZE, &all);
    for ellipsoid in drawn.ellipsoids {
        let volume = ellipsoid.shape.determinant();
        assert!((volume - 1.0).abs() < 0.01, "{volume}");
    }
}

/// Isolated drops are drawn as the spheres they are.
#[test]
fn few_particles_stay_round_where_they_are() {
    let mut fluid = Fluid::new();
    let view = looking(DVec3::Z * 20.0, DVec3::ZERO);
    let round = Settings { anisotropy: Anisotropy { enabled: false, ..stretched().anisotropy }, ..stretched() };
    let line = |count: usize| (0..count).map(|k| Vec3::new(2.0 * k as f32 - count as f32, 0.0, 0.0)).collect();
    for positions in [Vec::new(), line(1), line(2), line(8), vec![Vec3::ONE; 5]] {
        let particles = marked(positions);
        let ellipsoids = fluid.draw(&particles, &view, SIZE, &stretched());
        let spheres = fluid.draw(&particles, &view, SIZE, &round);
        let off = ellipsoids.depth.iter().zip(&spheres.depth).filter(|(a, b)| a != b && (*a - *b).abs() >= 1e-4);
        assert!(off.count() <= 2, "{} particles", particles.len());
    }
}

/// Where particles are too small for a shape of their own, the picture is that of spheres, which are smoothed more.
#[test]
fn far_particles_are_drawn_and_smoothed_as_spheres() {
    let mut fluid = Fluid::new();
    let dam = marked(dam_break());
    let eye = DVec3::new(116.0, 100.0, 216.0) * 1.5;
    let view = looking(eye, DVec3::new(0.0, 48.0, 0.0));
    let ellipsoids = fluid.draw(&dam, &view, SIZE, &Settings::default());
    let spheres = fluid.draw(&dam, &view, SIZE, &Settings::spheres());
    let near = fluid.draw(&dam, &view, SIZE, &stretched());
    let differ = |a: &Drawn, b: &Drawn| {
        let pairs = a.depth.iter().zip(&b.depth).chain(a.smooth.iter().zip(&b.smooth));
        pairs.filter(|(a, b)| a.is_finite() != b.is_finite() || (*a - *b).abs() > 0.01).count()
    };
    assert!(differ(&ellipsoids, &spheres) <= 5, "{} pixels differ", differ(&ellipsoids, &spheres));
    assert!(differ(&near, &spheres) > 1000);
}

/// A dense line becomes a rod, a dense plane a sheet: whole, and about where its particles are.
#[test]
fn lines_and_planes_hold_together() {
    let mut fluid = Fluid::new();
    let view = from_above(20.0);
    let dense = |k: i32| 0.25 * k as f32;
    let line = fluid.draw(&marked((-60..=60).map(|k| Vec3::new(dense(k), 0.0, 0.0))), &view, SIZE, &stretched());
    let middle = |drawn: &Drawn, x: u32, y: u32| drawn.depth[(y * SIZE[0] + x) as usize];
    for x in 60..SIZE[0] - 60 {
        assert!((49.0..50.0).contains(&middle(&line, x, SIZE[1] / 2)), "{}", middle(&line, x, SIZE[1] / 2));
    }
    let plane = (-12..=12).flat_map(|x| (-12..=12).map(move |z| Vec3::new(x as f32, 0.0, z as f32)));
    let plane = fluid.draw(&marked(plane), &view, SIZE, &stretched());
    for y in 40..SIZE[1] - 40 {
        assert!((49.0..50.0).contains(&middle(&plane, SIZE[0] / 2, y)), "{}", middle(&plane, SIZE[0] / 2, y));
    }
}
