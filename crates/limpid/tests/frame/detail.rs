//! Advected noise and foam: against the twin, and what must hold whatever order, rate and camera are.

use crate::common::{Cloud, Difference, Random, SIZE, forward_orthographic, looking, shot_of, with_gpu};
use crate::reference::{Camera, living};
use glam::{DVec3, dvec3};
use limpid::{Detail, Foam, Motion, Scale, Settings, View};
use limpid_headless::{Aov, Shot};
use std::path::Path;

/// What particles carry.
#[derive(Clone, Default)]
struct Carried {
    ids: Vec<i64>,
    velocities: Vec<[f32; 3]>,
    heat: Vec<f32>,
}

impl Carried {
    fn random(seed: u64, count: usize) -> Self {
        let mut random = Random(seed);
        let mut carried = Self::default();
        for _ in 0..count {
            carried.ids.push(random.bits() as i64);
            carried.velocities.push([0; 3].map(|_| random.between(-4.0, 4.0) as f32));
            carried.heat.push(random.between(-0.5, 1.0).max(0.0) as f32);
        }
        carried
    }

    fn motion(&self) -> Motion<'_> {
        Motion { ids: Some(&self.ids), velocities: Some(&self.velocities), heat: Some(&self.heat) }
    }
}

/// Depth, noise and foam of a picture.
fn rendered(cloud: &Cloud, motion: Motion<'_>, view: View, size: [u32; 2], detail: Detail) -> [Vec<f32>; 3] {
    let settings = Settings { detail, ..Settings::default() };
    let shot = Shot { motion, ..shot_of(cloud, view, size, settings) };
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Depth, Aov::Noise, Aov::Foam])).unwrap();
    let mut images = picture.aovs.into_iter().map(|image| image.values);
    [(); 3].map(|()| images.next().unwrap())
}

const LIVELY: Detail = Detail {
    noise: 0.05,
    wavelength: 2.0,
    octaves: 2,
    scale: Scale::Half,
    agitated_gain: 2.0,
    foam: Foam::Agitation,
    foam_opacity: 0.9,
    foam_color: [1.0; 3],
    foam_speed: [1.8, 6.0],
};

fn compare(what: &str, cloud: &Cloud, view: View, size: [u32; 2], detail: Detail) {
    let carried = Carried::random(5, cloud.positions.len());
    let [depth, noise, foam] = rendered(cloud, carried.motion(), view, size, detail);
    let camera = Camera::new(view, size);
    let depth: Vec<f64> = depth.iter().map(|depth| f64::from(*depth)).collect();
    let step = f64::from(Settings::default().normal_step) * cloud.radius();
    let expected = living(&camera, &cloud.slices(), &carried.motion(), &detail, &depth, step, cloud.radius());
    let covered = || (0..depth.len()).filter(|i| depth[*i].is_finite());
    assert!(covered().any(|i| expected.noise[i].abs() > 0.05) && covered().any(|i| expected.foam[i] > 0.5));
    let noises = covered().map(|i| f64::from(noise[i]) - expected.noise[i]);
    Difference::new(noises).assert(&format!("{what}, noise, r"), 2e-4, 1e-3);
    let foams = covered().map(|i| f64::from(foam[i]) - expected.foam[i]);
    Difference::new(foams).assert(&format!("{what}, foam"), 1e-3, 1e-2);
}

#[test]
fn noise_and_foam_match_the_twin() {
    let cloud = Cloud::random(40, 1500, [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]], [0.04, 0.06]);
    let view = looking([0.9, 0.8, 1.4], [0.0; 3], [161, 91]);
    for scale in [Scale::Full, Scale::Half, Scale::Quarter] {
        let detail = Detail { scale, wavelength: 4.0, ..LIVELY };
        compare(&format!("{scale:?}"), &cloud, view, [161, 91], detail);
    }
    let fast = Detail { foam: Foam::Speed, wavelength: 4.0, ..LIVELY };
    compare("speed", &cloud, view, [161, 91], fast);
    let moved = Cloud { origin: DVec3::NEG_Z, ..cloud };
    compare("orthographic", &moved, forward_orthographic(1.0, 0.05, 6.0, [161, 91]), [161, 91], LIVELY);
}

#[test]
fn splats_of_thousands_of_texels_match_the_twin() {
    let cloud = Cloud::random(41, 60, [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]], [0.1, 0.15]);
    let view = looking([0.3, 0.2, 0.9], [0.0; 3], [161, 91]);
    compare("close", &cloud, view, [161, 91], Detail { scale: Scale::Full, ..LIVELY });
}

#[test]
fn real_water_matches_the_twin() {
    let (cloud, size) = (Cloud::read("jet/ParticleData_Fluid_42.bgeo", 0.025), [160, 90]);
    compare("jet", &cloud, looking([0.6, 0.9, 1.4], [0.0, 0.2, 0.0], size), size, Detail { wavelength: 4.0, ..LIVELY });
}

#[test]
fn the_order_of_particles_means_nothing() {
    let cloud = Cloud::random(42, 3000, [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]], [0.02, 0.05]);
    let carried = Carried::random(43, cloud.positions.len());
    let mut order: Vec<usize> = (0..cloud.positions.len()).collect();
    Random(44).shuffle(&mut order);
    let shuffled = Cloud {
        positions: order.iter().map(|i| cloud.positions[*i]).collect(),
        radii: order.iter().map(|i| cloud.radii[*i]).collect(),
        ..Cloud::default()
    };
    let with = Carried {
        ids: order.iter().map(|i| carried.ids[*i]).collect(),
        velocities: order.iter().map(|i| carried.velocities[*i]).collect(),
        heat: order.iter().map(|i| carried.heat[*i]).collect(),
    };
    let view = looking([0.9, 0.8, 1.4], [0.0; 3], SIZE);
    // Ellipsoids differ by rounding when shuffled; spheres do not.
    let bits = |cloud: &Cloud, carried: &Carried| {
        let settings = Settings { detail: LIVELY, ..Settings::spheres() };
        let shot = Shot { motion: carried.motion(), ..shot_of(cloud, view, SIZE, settings) };
        let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Noise, Aov::Foam, Aov::Color])).unwrap();
        assert!(picture.aovs[0].values.iter().any(|noise| *noise != 0.0));
        picture.aovs.iter().flat_map(|image| image.values.iter().map(|v| v.to_bits())).collect::<Vec<_>>()
    };
    assert!(bits(&cloud, &carried) == bits(&shuffled, &with));
}

/// A frame of the jet: particles and their ids.
fn jet(frame: u32) -> (Vec<[f32; 3]>, Vec<i64>) {
    let path = format!("../../data/jet/ParticleData_Fluid_{frame}.bgeo");
    let set = limpid_io::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
    let Some(limpid_io::Values::I64(ids)) = set.attribute("id").map(|attribute| attribute.values.clone()) else {
        panic!("no ids")
    };
    (set.positions, ids)
}

#[test]
fn particles_keep_their_pattern_when_the_solver_sorts_again() {
    let (earlier, later) = (jet(42), jet(52));
    assert_ne!(earlier.1[..], later.1[..earlier.1.len()], "the solver has not sorted");
    // A particle alone, seen from the same side: only its pattern tells who it is.
    let view_of = |p: [f32; 3]| {
        let center = DVec3::from_array(p.map(f64::from));
        View::orthographic(center + DVec3::Z, center, DVec3::Y, 0.15, 1.0, 0.01, 4.0)
    };
    let detail = Detail { scale: Scale::Full, foam: Foam::Off, ..LIVELY };
    let pattern = |(positions, ids): &(Vec<[f32; 3]>, Vec<i64>), id: i64| {
        let at = ids.iter().position(|other| *other == id).unwrap();
        let cloud = Cloud::uniform(vec![positions[at]], 0.025);
        let motion = Motion { ids: Some(&ids[at..=at]), ..Motion::default() };
        rendered(&cloud, motion, view_of(positions[at]), [48, 48], detail)[1].clone()
    };
    let apart = |a: &[f32], b: &[f32]| Difference::new(a.iter().zip(b).map(|(a, b)| f64::from(a - b))).rms();
    for index in [0, 700, 2500, 4000] {
        let id = earlier.1[index];
        let [before, after, other] = [pattern(&earlier, id), pattern(&later, id), pattern(&later, id + 1)];
        assert!(apart(&before, &after) < 2e-3, "particle {id}: {}", apart(&before, &after));
        assert!(apart(&before, &other) > 2e-2, "particle {id} looks like its neighbour");
    }
}

/// The cubic through values at -1, 0, 1 and 2.
fn cubic(t: f64, [a, b, c, d]: [f64; 4]) -> f64 {
    let outer = d * t * (t * t - 1.0) - a * t * (t - 1.0) * (t - 2.0);
    let inner = b * (t + 1.0) * (t - 1.0) * (t - 2.0) - c * t * (t + 1.0) * (t - 2.0);
    outer / 6.0 + inner / 2.0
}

#[test]
fn the_pattern_is_steady_in_slow_flow() {
    // A slab drifts by a fraction of a pixel in each of 10 frames. In its own frame nothing should change.
    let (size, px) = ([128, 96], 1.0 / 96.0);
    let slab = Cloud::slab(30, 4, 0.04, 0.3);
    let carried = Carried::random(45, slab.positions.len());
    let still = Detail { foam: Foam::Off, agitated_gain: 0.0, wavelength: 2.0, ..LIVELY };
    let noise = |drift: f64| {
        let cloud = Cloud { origin: dvec3(drift * px, 0.0, 0.37 * drift * px), ..slab.clone() };
        // The camera drifts along by whole pixels only, so that pixels can be compared.
        let whole = dvec3(drift.round() * px, 0.0, (0.37 * drift).round() * px);
        let eye = whole + 2.0 * DVec3::Y;
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let view = View::orthographic(eye, whole, DVec3::NEG_Z, 1.0, aspect, 0.02, 4.0);
        rendered(&cloud, carried.motion(), view, size, still)[1].clone()
    };
    let first = noise(0.0);
    let rms = Difference::new(first.iter().map(|v| f64::from(*v))).rms();
    let mut worst: f64 = 0.0;
    for frame in 1..10 {
        let drift = 0.3 * f64::from(frame);
        let shifted = [drift - drift.round(), 0.37 * drift - (0.37 * drift).round()];
        // The first frame moved by the rest of a pixel, by the cubic through four pixels: a straight line between two
        // would change more than the noise does.
        let at = |x: f64, y: f64| {
            let value = |x: f64, y: f64| f64::from(first[y as usize * size[0] as usize + x as usize]);
            let row = |y: f64| cubic(x.fract(), [-1.0, 0.0, 1.0, 2.0].map(|step| value(x.floor() + step, y)));
            cubic(y.fract(), [-1.0, 0.0, 1.0, 2.0].map(|step| row(y.floor() + step)))
        };
        let now = noise(drift);
        let inner = (4..size[1] - 4).flat_map(|y| (4..size[0] - 4).map(move |x| [x, y]));
        let changes = inner.map(|[x, y]| {
            f64::from(now[(y * size[0] + x) as usize]) - at(f64::from(x) - shifted[0], f64::from(y) - shifted[1])
        });
        worst = worst.max(Difference::new(changes).rms() / rms);
    }
    println!("steadiness: the pattern changes by at most {:.1} % RMS over 10 frames; height {rms:.3} r", 100.0 * worst);
    assert!(worst < 0.05, "{worst}");
}

#[test]
fn the_height_is_the_rms_of_a_calm_surface() {
    let slab = Cloud::slab(30, 4, 0.04, 0.1);
    let view = View::orthographic(2.0 * DVec3::Y, DVec3::ZERO, DVec3::NEG_Z, 1.0, 1.0, 0.02, 4.0);
    let detail = Detail { noise: 0.1, octaves: 1, foam: Foam::Off, scale: Scale::Full, ..LIVELY };
    let [_, noise, _] = rendered(&slab, Motion::default(), view, [128, 128], detail);
    let rms = Difference::new(noise.iter().map(|v| f64::from(*v))).rms();
    assert!((rms / 0.1 - 1.0).abs() < 0.25, "{rms}");
}

#[test]
fn foam_covers_its_share_in_crisp_threads() {
    let slab = Cloud::slab(30, 4, 0.04, 0.1);
    let view = View::orthographic(2.0 * DVec3::Y, DVec3::ZERO, DVec3::NEG_Z, 1.0, 1.0, 0.02, 4.0);
    let detail = Detail { noise: 0.0, octaves: 1, foam_opacity: 1.0, wavelength: 3.0, scale: Scale::Full, ..LIVELY };
    let ids: Vec<i64> = (0..slab.positions.len() as i64).collect();
    for heat in [0.25, 0.5, 0.9] {
        let heats = vec![heat; ids.len()];
        let motion = Motion { ids: Some(&ids), heat: Some(&heats), ..Motion::default() };
        let [_, _, foam] = rendered(&slab, motion, view, [160, 160], detail);
        let count = foam.len() as f64;
        let covered = foam.iter().map(|foam| f64::from(*foam)).sum::<f64>() / count;
        assert!((covered / (0.85 * f64::from(heat)) - 1.0).abs() < 0.15, "{heat}: covers {covered}");
        let pale = foam.iter().filter(|foam| (0.1..0.9).contains(*foam)).count() as f64 / count;
        assert!(pale < 0.35, "{heat}: {pale} of the area is neither foam nor water");
    }
}

#[test]
fn nothing_changes_without_noise_and_foam() {
    let cloud = Cloud::sphere_drop();
    let shot = shot_of(&cloud, looking([1.8, 1.2, 2.3], [0.5, 0.42, 0.5], SIZE), SIZE, Settings::default());
    let carried = Carried::random(46, cloud.positions.len());
    let [plain, carrying] = [shot, Shot { motion: carried.motion(), ..shot }]
        .map(|shot| with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Noise])).unwrap());
    assert!(plain.rgba == carrying.rgba && plain.aovs == carrying.aovs);
    assert!(plain.aovs[0].values.iter().all(|noise| *noise == 0.0));
}

#[test]
fn lengths_of_arrays_must_fit() {
    let cloud = Cloud::uniform(vec![[0.0, 0.0, -3.0]; 3], 0.1);
    let settings = Settings { detail: LIVELY, ..Settings::default() };
    let motion = Motion { ids: Some(&[1, 2]), ..Motion::default() };
    let shot = Shot { motion, ..shot_of(&cloud, looking([0.0; 3], [0.0, 0.0, -1.0], SIZE), SIZE, settings) };
    let error = with_gpu(|offscreen| offscreen.render(&shot, &[])).unwrap_err().to_string();
    assert!(error.contains("2 ids for 3 positions"), "{error}");
}
