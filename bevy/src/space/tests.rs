use super::*;
use bevy::camera::{CameraProjection, OrthographicProjection, PerspectiveProjection, Projection, ScalingMode};
use bevy::math::{Quat, Vec2};

fn perspective() -> Mat4 {
    PerspectiveProjection { aspect_ratio: 1.5, near: 0.2, ..Default::default() }.get_clip_from_view()
}

fn orthographic(near: f32) -> Mat4 {
    let scaling_mode = ScalingMode::Fixed { width: 6.0, height: 4.0 };
    let mut projection =
        OrthographicProjection { near, far: 50.0, scaling_mode, ..OrthographicProjection::default_3d() };
    projection.update(600.0, 400.0);
    Projection::Orthographic(projection).get_clip_from_view()
}

fn whole() -> Rect {
    Rect::from_corners(Vec2::ZERO, Vec2::ONE)
}

fn camera() -> Affine3A {
    Affine3A::from_rotation_translation(
        Quat::from_rotation_y(0.3) * Quat::from_rotation_x(-0.2),
        Vec3::new(1.0, 2.0, 8.0),
    )
}

fn fluid() -> Affine3A {
    let rotation = Quat::from_rotation_z(0.7) * Quat::from_rotation_x(1.1);
    Affine3A::from_scale_rotation_translation(Vec3::splat(2.5), rotation, Vec3::new(-0.4, 0.3, 0.2))
}

/// Where limpid sees a place of the fluid, as normalised device coordinates.
fn seen_by_limpid(view: &View, place: Vec3) -> [f64; 3] {
    let place = of_limpid_vector(place.as_dvec3());
    (view.clip_from_view * view.view_from_world).project_point3(place).to_array()
}

/// Where Bevy sees it.
fn seen_by_bevy(clip_from_view: Mat4, place: Vec3) -> [f64; 3] {
    let in_view = (camera().inverse() * fluid()).transform_point3(place);
    clip_from_view.project_point3(in_view).to_array().map(f64::from)
}

fn assert_near(a: [f64; 3], b: [f64; 3]) {
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5), "{a:?} and {b:?}");
}

#[test]
fn places_and_depths_are_bevys_whatever_the_transforms() {
    for clip_from_view in [perspective(), orthographic(0.1), orthographic(0.0), orthographic(-3.0)] {
        let view = Eye { world_from_view: camera(), clip_from_view, viewport: whole() }.view_of(fluid()).unwrap();
        for place in [Vec3::ZERO, Vec3::new(0.3, -0.2, 0.1), Vec3::new(-0.5, 0.4, 0.6)] {
            assert_near(seen_by_limpid(&view, place), seen_by_bevy(clip_from_view, place));
        }
    }
}

#[test]
fn views_are_rigid_and_w_is_the_depth() {
    let view =
        Eye { world_from_view: camera(), clip_from_view: perspective(), viewport: whole() }.view_of(fluid()).unwrap();
    let rows = glam::DMat3::from_mat4(view.view_from_world);
    assert!((rows * rows.transpose()).abs_diff_eq(glam::DMat3::IDENTITY, 1e-6));
    assert!((view.clip_from_view.z_axis.w + 1.0).abs() < 1e-6);
    // In the fluid's units, which are 2.5 times as large as the world's.
    assert!((view.near - 0.2 / 2.5).abs() < 1e-6, "{}", view.near);
}

#[test]
fn orthographic_depths_are_positive() {
    for near in [-3.0, 0.0, 0.1, 5.0] {
        let eye = Eye { world_from_view: camera(), clip_from_view: orthographic(near), viewport: whole() };
        let view = eye.view_of(fluid()).unwrap();
        assert!(view.near > 0.0 && view.far.is_finite() && view.far > view.near, "{near}: {view:?}");
        // From the near plane to the far one, in the fluid's units.
        assert!((view.far - view.near - f64::from(50.0 - near) / 2.5).abs() < 1e-4, "{near}: {view:?}");
    }
}

#[test]
fn a_viewport_is_a_part_of_the_target() {
    // The right half of the upper half.
    let viewport = Rect::new(0.5, 0.0, 1.0, 0.5);
    let part = Eye { world_from_view: camera(), clip_from_view: perspective(), viewport }.view_of(fluid()).unwrap();
    let place = Vec3::new(0.3, -0.2, 0.1);
    let [x, y, z] = seen_by_bevy(perspective(), place);
    assert_near(seen_by_limpid(&part, place), [0.5 + 0.5 * x, 0.5 + 0.5 * y, z]);
}

#[test]
fn the_floor_and_directions_are_in_the_fluids_space() {
    let environment = surroundings(fluid(), Some(0.7)).unwrap();
    let on_floor = Vec3::new(3.0, 0.7, -2.0);
    let place = of_limpid_vector((affine(fluid()).inverse()).transform_point3(on_floor.as_dvec3()));
    assert!((place.dot(environment.up) - environment.floor.unwrap()).abs() < 1e-6);
    assert!(direction_in(fluid(), Vec3::Y).unwrap().abs_diff_eq(environment.up, 1e-6));
}

#[test]
fn nothing_is_seen_of_what_is_scaled_to_nothing() {
    let eye = Eye { world_from_view: camera(), clip_from_view: perspective(), viewport: whole() };
    assert!(eye.view_of(Affine3A::from_scale(Vec3::ZERO)).is_none());
    assert!(surroundings(Affine3A::from_scale(Vec3::ZERO), None).is_none());
}
