//! What must hold for any fluid: order, place, orientation and unit mean nothing.

use crate::common::{Cloud, Difference, Random, Rendered, SIZE, forward, looking, render, shot_of};
use glam::{DMat4, DQuat, DVec3, dvec3};
use limpid::{Environment, Settings, View};
use limpid_headless::{Background, Shot};

fn view() -> View {
    looking([1.8, 1.2, 2.3], [0.5, 0.42, 0.5], SIZE)
}

fn drop_shot(cloud: &Cloud, settings: Settings) -> Shot<'_> {
    Shot { background: Background::Scene, ..shot_of(cloud, view(), SIZE, settings) }
}

fn assert_same_bits(left: &Rendered, right: &Rendered) {
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert!(bits(&left.raw_depth) == bits(&right.raw_depth), "raw depth differs");
    assert!(bits(&left.depth) == bits(&right.depth), "depth differs");
    assert!(bits(&left.thickness) == bits(&right.thickness), "thickness differs");
    assert!(left.normal == right.normal, "normals differ");
    assert!(left.color == right.color, "colour differs");
    assert!(left.rgba == right.rgba, "the picture differs");
}

#[test]
fn the_same_twice_gives_the_same_bits() {
    let cloud = Cloud::sphere_drop();
    let first = render(&drop_shot(&cloud, Settings::default()));
    // Something else in between leaves no trace, whatever its size.
    let other = Cloud::random(60, 500, [[-1.0, -1.0, -4.0], [1.0, 1.0, -0.5]], [0.01, 0.4]);
    render(&shot_of(&other, forward(60.0, 0.05, SIZE), SIZE, Settings::default()));
    render(&shot_of(&other, forward(60.0, 0.05, [64, 80]), [64, 80], Settings::default()));
    assert_same_bits(&first, &render(&drop_shot(&cloud, Settings::default())));
}

#[test]
fn order_means_nothing() {
    let cloud = Cloud::random(61, 5000, [[-1.0, -1.0, -4.0], [1.0, 1.0, 0.2]], [0.01, 0.1]);
    let mut order: Vec<usize> = (0..cloud.positions.len()).collect();
    Random(62).shuffle(&mut order);
    let shuffled = Cloud {
        positions: order.iter().map(|i| cloud.positions[*i]).collect(),
        radii: order.iter().map(|i| cloud.radii[*i]).collect(),
        ..Cloud::default()
    };
    let view = forward(60.0, 0.05, SIZE);
    let [left, right] = [cloud, shuffled].map(|cloud| render(&shot_of(&cloud, view, SIZE, Settings::default())));
    assert_same_bits(&left, &right);
}

/// world point = turn * (scale * point) + shift
#[derive(Clone, Copy)]
struct Motion {
    scale: f64,
    turn: DQuat,
    shift: DVec3,
}

impl Motion {
    fn cloud(&self, cloud: &Cloud) -> Cloud {
        let moved =
            |p: &[f32; 3]| (self.turn * (self.scale * DVec3::from_array(p.map(f64::from)))).as_vec3().to_array();
        Cloud {
            origin: self.shift,
            positions: cloud.positions.iter().map(moved).collect(),
            radii: cloud.radii.iter().map(|radius| (self.scale * f64::from(*radius)) as f32).collect(),
            density: None,
        }
    }

    fn view(&self, view: View) -> View {
        let still_from_moved = DMat4::from_quat(self.turn.inverse()) * DMat4::from_translation(-self.shift);
        let mut view_from_world = view.view_from_world * still_from_moved;
        // The view space's unit changes with the world's: its translation grows, the points that it moves already have.
        let translation = view.view_from_world.w_axis.truncate() * (self.scale - 1.0);
        view_from_world.w_axis += translation.extend(0.0);
        let mut clip_from_view = view.clip_from_view;
        clip_from_view.w_axis.z *= self.scale;
        View { view_from_world, clip_from_view, near: view.near * self.scale, far: view.far * self.scale }
    }

    fn environment(&self, environment: Environment) -> Environment {
        let up = self.turn * environment.up;
        Environment {
            up,
            sun: self.turn * environment.sun,
            sun_strength: environment.sun_strength,
            floor: environment.floor.map(|floor| self.scale * floor + self.shift.dot(up)),
            extent: self.scale * environment.extent,
            center: self.turn * (self.scale * environment.center) + self.shift,
            ..environment
        }
    }
}

/// Compares all buffers of the moved frame with the still one's, lengths in units of r. Particle positions are rounded
/// to float32 anew when they are turned or scaled: depths agree within 1e-5, but for pixels at silhouettes, where another
/// ball is seen; what sums and differences of depth amplify has wider bounds.
fn assert_moves_with(motion: Motion, compare_color: bool) {
    let cloud = Cloud::sphere_drop();
    let shot = drop_shot(&cloud, Settings::spheres());
    let moved_cloud = motion.cloud(&cloud);
    let moved = Shot {
        environment: motion.environment(shot.environment),
        background: Background::Scene,
        ..shot_of(&moved_cloud, motion.view(shot.view), SIZE, Settings::spheres())
    };
    let (still, moved) = (render(&shot), render(&moved));
    let strays = still.depth.iter().zip(&moved.depth).filter(|(a, b)| a.is_finite() != b.is_finite()).count();
    println!("silhouettes differ in {strays} of {} pixels", still.covered());
    assert!(strays as f64 <= 2e-4 * still.covered() as f64);
    let unscaled = |values: &[f32]| values.iter().map(|v| f64::from(*v) / motion.scale).collect::<Vec<_>>();
    let relative = |a: &[f32], b: &[f32]| Difference::of_relative_depth(a, &unscaled(b));
    relative(&still.raw_depth, &moved.raw_depth).assert("raw depth, relative", 1e-4, 1e-5);
    relative(&still.depth, &moved.depth).assert("depth, relative", 1e-4, 1e-5);
    let both = || (0..still.depth.len()).filter(|i| still.depth[*i].is_finite() && moved.depth[*i].is_finite());
    let thickness = unscaled(&moved.thickness);
    Difference::new(both().map(|i| (f64::from(still.thickness[i]) - thickness[i]) / cloud.radius())).assert(
        "thickness, r",
        1e-2,
        3e-3,
    );
    Difference::new(both().map(|i| still.normal[i].distance(moved.normal[i]).into())).assert("normal", 1e-2, 1e-3);
    if compare_color {
        Difference::new(both().map(|i| still.color[i].distance(moved.color[i]).into())).assert("color", 1e-2, 1e-2);
    }
}

#[test]
fn place_means_nothing() {
    // 10,000 r away.
    assert_moves_with(Motion { scale: 1.0, turn: DQuat::IDENTITY, shift: dvec3(80.0, -50.0, 70.0) }, true);
}

#[test]
fn the_unit_means_nothing() {
    for scale in [1e-3, 1e3] {
        let shift = 80.0 * scale * dvec3(1.0, -0.5, 0.8);
        assert_moves_with(Motion { scale, turn: DQuat::IDENTITY, shift }, true);
    }
}

#[test]
fn orientation_means_nothing() {
    let turn = DQuat::from_axis_angle(dvec3(0.3, -0.5, 0.8).normalize(), 2.2);
    for scale in [1e-3, 1.0, 1e3] {
        // But for where the floor's tiles begin.
        assert_moves_with(Motion { scale, turn, shift: 80.0 * scale * DVec3::ONE }, false);
    }
}

#[test]
fn no_particles_are_an_empty_scene() {
    let nothing = Cloud::default();
    let rendered = render(&drop_shot(&nothing, Settings::default()));
    assert_eq!(rendered.covered(), 0);
    assert!(rendered.thickness.iter().all(|thickness| *thickness == 0.0));
    assert!(rendered.rgba.chunks(4).all(|pixel| pixel[3] == 255), "the background is there");
}
