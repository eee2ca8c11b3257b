//! The splat against f64 rays through the same ellipsoids.

use crate::fluid::{Drawn, Ellipsoid, Fluid, Particle};
use crate::scenes::{SIZE, cloud, from_above, looking, marked, slab, stretched};
use glam::{DMat3, DVec3};
use limpid::{Settings, View};

fn settings() -> Settings {
    Settings { splat_scale: 1.4, ..stretched() }
}

/// View depths at which the ray through a pixel centre enters and leaves an ellipsoid, cut at the near plane.
fn chord(view: &View, ellipsoid: &Ellipsoid, scale: f64, x: u32, y: u32) -> Option<[f64; 2]> {
    let ndc = |at: u32, size: u32| 2.0 * (f64::from(at) + 0.5) / f64::from(size) - 1.0;
    let (u, v) = (ndc(x, SIZE[0]), -ndc(y, SIZE[1]));
    let clip = view.clip_from_view;
    let across = DVec3::new(u / clip.x_axis.x, v / clip.y_axis.y, 0.0);
    let (origin, direction) = match view.is_perspective() {
        true => (DVec3::ZERO, across - DVec3::Z),
        false => (across, -DVec3::Z),
    };
    let turn = DMat3::from_mat4(view.view_from_world);
    let unit_from_view = (turn * ellipsoid.shape * (scale * f64::from(ellipsoid.radius))).inverse();
    let center = unit_from_view * (view.view_from_world.transform_point3(ellipsoid.center) - origin);
    let direction = unit_from_view * direction;
    let middle = center.dot(direction) / direction.length_squared();
    let half_squared = (1.0 - (center - middle * direction).length_squared()) / direction.length_squared();
    let half = half_squared.max(0.0).sqrt();
    let [enter, leave] = [(middle - half).max(view.near), middle + half];
    (half_squared > 0.0 && leave > enter).then_some([enter, leave])
}

fn nearest(view: &View, drawn: &Drawn, scale: f64, x: u32, y: u32) -> f64 {
    let entries = drawn.ellipsoids.iter().filter_map(|e| chord(view, e, scale, x, y));
    entries.map(|[enter, _]| enter).fold(f64::INFINITY, f64::min)
}

/// Compares every `step`th pixel; `tolerance` is a world length.
fn compare(particles: &[Particle], view: &View, step: usize, tolerance: f64) {
    let settings = settings();
    let drawn = Fluid::new().draw(particles, view, SIZE, &settings);
    let (mut covered, mut off) = (0, 0);
    for index in (0..drawn.depth.len()).step_by(step) {
        let truth = nearest(view, &drawn, settings.splat_scale.into(), index as u32 % SIZE[0], index as u32 / SIZE[0]);
        let depth = f64::from(drawn.depth[index]);
        covered += usize::from(truth.is_finite());
        off += usize::from(depth != truth && (depth - truth).abs() > tolerance * (1.0 + 1e-3 * truth));
        assert!(depth.is_finite() == truth.is_finite() || tolerance > 0.0, "pixel {index}: {depth} for {truth}");
    }
    assert!(covered > 100, "only {covered} pixels hold fluid");
    // Pixels whose ray grazes a silhouette may fall to either side.
    assert!(off * 500 <= covered, "{off} of {covered} pixels are off");
}

#[test]
fn depth_is_that_of_f64_rays() {
    let wavy = || marked(slab(7, 3, 0.24));
    compare(&wavy(), &looking(DVec3::new(3.0, 20.0, 40.0), DVec3::ZERO), 7, 2e-4);
    compare(&wavy(), &from_above(30.0), 7, 2e-4);
    compare(&marked(cloud(600, 10.0, 3)), &looking(DVec3::new(-25.0, 5.0, 9.0), DVec3::ZERO), 7, 2e-4);
}

#[test]
fn close_and_cut_by_the_near_plane() {
    let mut view = looking(DVec3::new(0.0, 1.0, 3.0), DVec3::new(3.0, -2.0, -4.0));
    compare(&marked(cloud(500, 10.0, 9)), &view, 7, 2e-4);
    view.near = 6.0;
    compare(&marked(cloud(1500, 10.0, 10)), &view, 7, 2e-4);
    let mut above = from_above(25.0);
    above.near = 52.0;
    compare(&marked(slab(7, 3, 0.24)), &above, 7, 2e-4);
}

#[test]
fn thickness_of_a_slab_is_its_depth() {
    let particles = marked(slab(14, 5, 0.0));
    let settings = Settings { thickness_scale: limpid::Scale::Full, ..settings() };
    let drawn = Fluid::new().draw(&particles, &from_above(20.0), SIZE, &settings);
    let mean = drawn.thickness.iter().sum::<f32>() / drawn.thickness.len() as f32;
    assert!((mean - 10.0).abs() < 0.2, "{mean} for 10");
}
