//! Camera and surroundings, the same for all frames of a sequence.

use crate::Error;
use crate::frame::FrameParticles;
use crate::liquid;
use crate::options::Options;
use crate::props::Props;
use crate::survey::Survey;
use glam::{DVec3, dvec3};
use limpid::{Body, Bounds, Environment, Framing, Lamp, MOST_LAMPS, View};
use limpid_headless::Shot;

/// The near plane in particle radii: closer than this to the eye nothing can be told apart. Depths are kept linear and
/// in reversed f32, so a small near plane costs no precision.
const NEAR_IN_RADII: f64 = 0.1;

/// The near plane is never closer than this part of the distance to the target, where f32 ends.
const NEAR_IN_DISTANCES: f64 = 1e-6;

/// Least sine of the angle between the view and a usable up.
const PARALLEL: f64 = 1e-6;

/// Where every frame is seen.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    pose: Pose,
    view: View,
    environment: Environment,
}

/// Where the camera is and how it is held, world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Where it is.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
    /// What is up in the picture, of any length.
    pub up: DVec3,
}

impl Stage {
    /// Sets camera, floor and sun around the fluid.
    pub fn of(options: &Options, survey: &Survey, props: &Props) -> Result<Self, Error> {
        let unit = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
        let radius_world = survey.radius_world();
        let bounds = survey.bounds.unwrap_or(unit);
        let extent = survey.extent.unwrap_or(unit).grown(radius_world);
        let up = options.data_up();

        let grown = bounds.grown(radius_world);
        let pose = pose(options, &grown, &extent)?;
        let view = view(options, pose, &extent, radius_world);
        // The lowest particles stand on the floor, and whatever stays where it is stands above it.
        let floor = bounds.min.dot(up) - radius_world;
        let floor = props.lowest(up).map_or(floor, |lowest| lowest.min(floor));
        let lit = props.bounds().map_or(grown, |props| props.union(grown));
        let around = Environment::around(lit.min, lit.max, floor, up, pose.eye);
        let environment = Environment {
            sun: sun(options)?.unwrap_or(around.sun),
            sun_strength: options.sun(),
            sun_size: options.sun_size(),
            caustics: options.caustics(),
            lamps: lamps(options)?,
            floor: around.floor.filter(|_| options.has_floor()),
            ..around
        };
        Ok(Self { pose, view, environment })
    }

    /// Where the camera is.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// A frame on this stage.
    pub fn shot<'a>(&self, options: &Options, particles: &'a FrameParticles, bodies: &'a [Body<'a>]) -> Shot<'a> {
        let slices = particles.slices();
        let mut settings = options.settings();
        let liquids = options.liquid.as_deref().unwrap_or_default();
        settings.other_strengths =
            liquid::strengths(liquids, settings.smoothing.strength, || slices.reference_radius());
        Shot {
            particles: slices,
            motion: particles.motion(),
            paint: particles.paint(),
            droplets: &[],
            view: self.view,
            size: options.size(),
            settings,
            environment: self.environment,
            background: options.background(),
            bodies,
            exposure: options.exposure(),
            samples: options.samples(),
        }
    }
}

/// Where the sun is, if the options say so.
fn sun(options: &Options) -> Result<Option<DVec3>, Error> {
    let Some(direction) = options.sun_direction else { return Ok(None) };
    let toward = DVec3::from_array(direction).try_normalize();
    toward.map(Some).ok_or_else(|| Error::usage("--sun-direction has no length: give a direction, like 0,1,0"))
}

/// The lights beside the sun.
fn lamps(options: &Options) -> Result<[Option<Lamp>; MOST_LAMPS], Error> {
    let given = options.light.as_deref().unwrap_or_default();
    if given.len() > MOST_LAMPS {
        return Err(Error::usage(format!("--light is given {} times: {MOST_LAMPS} are the most", given.len())));
    }
    let mut lamps = [None; MOST_LAMPS];
    for ([x, y, z, red, green, blue], lamp) in given.iter().copied().zip(&mut lamps) {
        let toward = DVec3::new(x, y, z).try_normalize();
        let toward = toward.ok_or_else(|| Error::usage("--light has no direction: begin with one, like 0,1,0"))?;
        let color = [red, green, blue].map(|value| value as f32);
        if color.iter().any(|value| *value < 0.0) {
            return Err(Error::usage("--light has a colour below 0: end with one like 1,0.8,0.5"));
        }
        *lamp = Some(Lamp { toward, color });
    }
    Ok(lamps)
}

fn aspect(options: &Options) -> f64 {
    let [width, height] = options.size();
    f64::from(width) / f64::from(height)
}

/// What the options say of the camera, and what frames the fluid where they say nothing.
fn pose(options: &Options, bounds: &Bounds, extent: &Bounds) -> Result<Pose, Error> {
    let data_up = options.data_up();
    let framing = Framing::of(bounds, data_up, options.fov_y(), aspect(options));
    let target = options.camera_target.map_or(framing.target, DVec3::from_array);
    let eye = match options.camera_eye {
        Some(eye) => DVec3::from_array(eye),
        // Parallel rays look the same from any distance, so nothing need be behind the eye.
        None if options.ortho.is_some() => {
            let reach = farthest(target, extent);
            target + 2.0 * reach * (framing.eye - framing.target).normalize()
        }
        None => framing.eye + (target - framing.target),
    };
    let Some(forward) = (target - eye).try_normalize() else {
        return Err(Error::usage(
            "--camera-eye and --camera-target are the same point: move one of them, or leave one out",
        ));
    };
    let up = match options.camera_up.map(DVec3::from_array) {
        Some(up) => up.try_normalize().filter(|up| up.cross(forward).length() > PARALLEL).ok_or_else(|| {
            Error::usage("--camera-up is zero or parallel to the view: turn it, for instance to another axis")
        })?,
        None if data_up.cross(forward).length() > PARALLEL => data_up,
        // Straight down or up: what lies at the back is at the top of the picture, as on a map.
        None if data_up.z != 0.0 => DVec3::Y,
        None => dvec3(0.0, 0.0, -1.0),
    };
    Ok(Pose { eye, target, up })
}

fn view(options: &Options, pose: Pose, extent: &Bounds, radius_world: f64) -> View {
    let Pose { eye, target, up } = pose;
    let near = (NEAR_IN_RADII * radius_world).max(NEAR_IN_DISTANCES * eye.distance(target));
    match options.ortho {
        Some(height) => {
            let far = 2.0 * farthest(eye, extent) + near;
            View::orthographic(eye, target, up, height, aspect(options), near, far)
        }
        None => View::perspective(eye, target, up, options.fov_y(), aspect(options), near),
    }
}

fn farthest(point: DVec3, bounds: &Bounds) -> f64 {
    bounds.corners().into_iter().map(|corner| corner.distance(point)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::{Axis, Named};

    const BOX: Bounds = Bounds { min: dvec3(1.0, 0.0, -1.0), max: dvec3(3.0, 1.0, 1.0) };

    fn pose_of(options: &Options) -> Result<Pose, Error> {
        pose(options, &BOX, &BOX)
    }

    #[test]
    fn an_eye_alone_looks_at_the_middle_of_the_fluid() {
        let pose = pose_of(&Options { camera_eye: Some([5.0, 5.0, 5.0]), ..Options::default() }).unwrap();
        assert_eq!(pose.target, dvec3(2.0, 0.5, 0.0));
        assert_eq!(pose.up, DVec3::Y);
    }

    #[test]
    fn looking_straight_down_needs_no_camera_up() {
        for (axis, eye) in [(Axis::Y, [2.0, 9.0, 0.0]), (Axis::X, [9.0, 0.5, 0.0]), (Axis::Z, [2.0, 0.5, 9.0])] {
            let options = Options { camera_eye: Some(eye), up: Some(Named(axis)), ..Options::default() };
            let pose = pose_of(&options).unwrap();
            assert!(pose.up.cross(pose.target - pose.eye).length() > 0.5, "{axis:?}");
        }
    }

    #[test]
    fn impossible_cameras_are_refused() {
        let same = Options { camera_eye: Some([1.0; 3]), camera_target: Some([1.0; 3]), ..Options::default() };
        assert!(pose_of(&same).unwrap_err().to_string().contains("--camera-eye"));
        let parallel =
            Options { camera_eye: Some([2.0, 9.0, 0.0]), camera_up: Some([0.0, 1.0, 0.0]), ..Options::default() };
        assert!(pose_of(&parallel).unwrap_err().to_string().contains("--camera-up"));
    }

    #[test]
    fn an_orthographic_view_holds_all_of_the_fluid_at_any_scale() {
        for scale in [1e-6, 1.0, 1e6] {
            let extent = Bounds { min: scale * BOX.min, max: scale * BOX.max };
            let options = Options { ortho: Some(scale), ..Options::default() };
            let pose = pose(&options, &extent, &extent).unwrap();
            let view = view(&options, pose, &extent, 0.01 * scale);
            for corner in extent.corners() {
                let depth = -view.view_from_world.transform_point3(corner).z;
                assert!(view.near < depth && depth < view.far, "{depth} at scale {scale}");
            }
        }
    }
}
