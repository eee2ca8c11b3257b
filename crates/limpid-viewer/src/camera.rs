//! Moving the camera by mouse, touch and keys.

use crate::fingers::Gesture;
use crate::held::Held;
use eframe::egui::{self, Key, PointerButton};
use glam::{DMat3, DVec3};
use limpid_shot::Pose;

/// Radians for a point of the pointer's way.
const TURN: f64 = 0.008;
/// e-foldings of the distance for a point of the wheel's way.
const DOLLY: f64 = 0.003;
/// The steepest view, so that up stays up: radians from the horizon.
const STEEPEST: f64 = 1.55;
/// Part of the distance to the target that is flown in a second.
const FLIGHT: f64 = 0.6;

/// How the camera has been moved in a frame; None: not at all.
pub fn moved(
    ui: &egui::Ui,
    response: &egui::Response,
    gesture: Option<Gesture>,
    held: &Held,
    pose: Pose,
    up: DVec3,
    world_per_point: f64,
) -> Option<Pose> {
    let mut next = pose;
    let drag = response.drag_delta();
    let (modifiers, seconds) = ui.input(|input| (input.modifiers, f64::from(input.stable_dt.min(0.1))));
    if let Some(Gesture { drag, spread }) = gesture {
        // Two fingers: drag to move, pinch to come nearer.
        pan(&mut next, drag, world_per_point);
        dolly(&mut next, -spread.ln());
    } else if response.dragged_by(PointerButton::Primary) && !modifiers.shift {
        orbit(&mut next, drag, up);
    } else if response.dragged_by(PointerButton::Secondary) && modifiers.command {
        dolly(&mut next, f64::from(drag.y) * DOLLY);
    } else if response.dragged() {
        pan(&mut next, drag, world_per_point);
    }
    // egui makes a zoom of two fingers too.
    if gesture.is_none() && response.hovered() {
        let (scroll, zoom) = ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
        dolly(&mut next, -f64::from(scroll.y) * DOLLY - f64::from(zoom.max(1e-3)).ln());
    }
    if !ui.ctx().egui_wants_keyboard_input() {
        fly(ui, held, &mut next, up, seconds);
    }
    (next != pose).then_some(next)
}

/// Around the target.
fn orbit(pose: &mut Pose, drag: egui::Vec2, up: DVec3) {
    if drag == egui::Vec2::ZERO {
        return;
    }
    let offset = turned(pose.eye - pose.target, -f64::from(drag.x) * TURN, f64::from(drag.y) * TURN, up);
    pose.eye = pose.target + offset;
    pose.up = up;
}

/// A vector turned around up, and raised from the horizon.
fn turned(vector: DVec3, around: f64, raise: f64, up: DVec3) -> DVec3 {
    let length = vector.length();
    let elevation = (vector.dot(up) / length).clamp(-1.0, 1.0).asin();
    let flat = (vector - vector.dot(up) * up).try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
    let elevation = (elevation + raise).clamp(-STEEPEST, STEEPEST);
    let flat = DMat3::from_axis_angle(up, around) * flat;
    length * (elevation.cos() * flat + elevation.sin() * up)
}

/// Across the picture.
fn pan(pose: &mut Pose, drag: egui::Vec2, world_per_point: f64) {
    let (right, above) = axes(pose);
    let shift = world_per_point * (f64::from(drag.y) * above - f64::from(drag.x) * right);
    pose.eye += shift;
    pose.target += shift;
}

/// Nearer (below 0) or farther.
fn dolly(pose: &mut Pose, by: f64) {
    if by == 0.0 {
        // Else rounding would move the camera, and it would not be limpid's choice any more.
        return;
    }
    pose.eye = pose.target + (pose.eye - pose.target) * by.clamp(-3.0, 3.0).exp();
}

/// W, A, S, D, Q and E: through the scene; with Shift faster. Arrows turn the view.
fn fly(ui: &egui::Ui, keys: &Held, pose: &mut Pose, up: DVec3, seconds: f64) {
    let held = |key: Key| keys.amount(key);
    let (right, _) = axes(pose);
    let offset = pose.target - pose.eye;
    let way = (held(Key::W) - held(Key::S)) * offset.normalize()
        + (held(Key::D) - held(Key::A)) * right
        + (held(Key::E) - held(Key::Q)) * up;
    let fast = if ui.input(|input| input.modifiers.shift) { 4.0 } else { 1.0 };
    let shift = fast * FLIGHT * seconds * offset.length() * way;
    pose.eye += shift;
    pose.target += shift;
    let (around, raise) = (held(Key::ArrowLeft) - held(Key::ArrowRight), held(Key::ArrowUp) - held(Key::ArrowDown));
    if around != 0.0 || raise != 0.0 {
        pose.target = pose.eye + turned(offset, around * seconds, raise * seconds, up);
        pose.up = up;
    }
    if way != DVec3::ZERO || around != 0.0 || raise != 0.0 {
        ui.ctx().request_repaint();
    }
}

/// Right and up in the picture, in the world.
fn axes(pose: &Pose) -> (DVec3, DVec3) {
    let forward = (pose.target - pose.eye).normalize();
    let right = forward.cross(pose.up).normalize();
    (right, right.cross(forward))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::vec2;

    const POSE: Pose = Pose { eye: DVec3::new(0.0, 0.0, 2.0), target: DVec3::ZERO, up: DVec3::Y };

    #[test]
    fn an_orbit_keeps_its_distance_and_never_turns_over() {
        let mut pose = POSE;
        for _ in 0..100 {
            orbit(&mut pose, vec2(7.0, 50.0), DVec3::Y);
            assert!((pose.eye.length() - 2.0).abs() < 1e-9);
            assert!(axes(&pose).1.y > 0.0);
        }
        assert!(pose.eye.y > 1.99);
    }

    #[test]
    fn nothing_done_moves_nothing() {
        let mut pose = Pose { eye: DVec3::new(0.1, 0.7, 1.3), target: DVec3::new(0.3, 0.1, 0.7), up: DVec3::Y };
        let before = pose;
        orbit(&mut pose, egui::Vec2::ZERO, DVec3::Y);
        pan(&mut pose, egui::Vec2::ZERO, 0.1);
        dolly(&mut pose, 0.0);
        assert_eq!(pose, before);
    }

    #[test]
    fn what_is_dragged_follows_the_pointer() {
        let mut pose = POSE;
        pan(&mut pose, vec2(10.0, 0.0), 0.1);
        assert!((pose.target - DVec3::new(-1.0, 0.0, 0.0)).length() < 1e-12, "the scene moves to the right");
        dolly(&mut pose, -std::f64::consts::LN_2);
        assert!((pose.eye.distance(pose.target) - 1.0).abs() < 1e-12);
    }
}
