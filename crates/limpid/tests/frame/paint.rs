//! Colours and several liquids: against the twin, and what must hold whatever the order of particles is.

use crate::common::{
    Cloud, Difference, Random, SIZE, above, forward, forward_orthographic, looking, shot_of, unsmoothed, with_gpu,
};
use crate::reference::{Camera, balls_of, body_paint, surface_paint};
use glam::{DVec3, dvec3};
use limpid::{Absorption, Coloring, Filter, Optics, Paint, Scale, Settings, Smoothing, View};
use limpid_headless::{Aov, Shot};

const SMALL: [u32; 2] = [246, 134];

/// Paint that owns its arrays.
#[derive(Clone)]
struct Paints {
    colors: Vec<[f32; 3]>,
    liquids: Vec<u8>,
}

impl Paints {
    fn random(seed: u64, count: usize, liquids: u64) -> Self {
        let mut random = Random(seed);
        let mut color = || [0; 3].map(|_| random.between(0.0, 1.0) as f32);
        let colors = (0..count).map(|_| color()).collect();
        let mut random = Random(seed + 1);
        Self { colors, liquids: (0..count).map(|_| (random.bits() % liquids) as u8).collect() }
    }

    fn paint(&self) -> Paint<'_> {
        Paint { colors: Some(&self.colors), liquids: Some(&self.liquids) }
    }
}

fn milk() -> Optics {
    Optics {
        absorption: Absorption::PerRadius([0.002, 0.004, 0.012]),
        scattering: [0.9; 3],
        albedo: [0.98, 0.95, 0.88],
        color: [0.0; 3],
        ..Optics::default()
    }
}

fn paint_water() -> Optics {
    Optics { opaque: true, albedo: [0.1, 0.3, 0.7], ..Optics::default() }
}

/// Settings with these liquids after the first.
fn with_liquids(others: &[Optics], settings: Settings) -> Settings {
    let mut settings = settings;
    for (place, other) in settings.other_liquids.iter_mut().zip(others) {
        *place = Some(*other);
    }
    settings
}

fn images<const N: usize>(shot: &Shot<'_>, aovs: [Aov; N]) -> [Vec<f32>; N] {
    let picture = with_gpu(|offscreen| offscreen.render(shot, &aovs)).unwrap();
    let mut images = picture.aovs.into_iter().map(|image| image.values);
    [(); N].map(|()| images.next().unwrap())
}

fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value)).collect()
}

/// Colours and liquids of the surface, absorption along the ray.
fn compare(what: &str, cloud: &Cloud, view: View, size: [u32; 2], settings: Settings) {
    let paints = Paints::random(61, cloud.positions.len(), 3);
    let paint = paints.paint();
    let (camera, depth_of_colors) = (Camera::new(view, size), 4.0);

    let settings = with_liquids(&[Optics::default(); 2], Settings { coloring: Coloring::Surface, ..settings });
    let shot = Shot { paint, ..shot_of(cloud, view, size, settings) };
    let [raw, depth, albedo, liquids] = images(&shot, [Aov::RawDepth, Aov::Depth, Aov::Albedo, Aov::Liquids]);
    let balls = balls_of(&cloud.slices(), &camera, &settings);
    let expected = surface_paint(&camera, &balls, &paint, &wide(&raw), &wide(&depth));
    let covered: Vec<usize> = (0..depth.len()).filter(|i| depth[*i].is_finite()).collect();
    assert!(covered.len() > 1000, "{what}: little to see");
    let colors = covered.iter().flat_map(|i| [0, 1, 2].map(|k| f64::from(albedo[3 * i + k]) - expected[*i].mean()[k]));
    Difference::new(colors).assert(&format!("{what}, surface color"), 1e-3, 1e-2);
    let shares = covered.iter().flat_map(|i| [0, 1, 2].map(|k| f64::from(liquids[3 * i + k]) - expected[*i].share(k)));
    Difference::new(shares).assert(&format!("{what}, liquids"), 1e-3, 1e-2);
    for i in &covered {
        let sum: f64 = wide(&liquids[3 * i..3 * i + 3]).iter().sum();
        assert!((sum - 1.0).abs() < 1e-6, "{what}: shares sum to {sum}");
    }

    let settings =
        Settings { coloring: Coloring::Absorption(depth_of_colors), thickness_scale: Scale::Half, ..settings };
    let shot = Shot { paint, ..shot_of(cloud, view, size, settings) };
    let [thickness, transmittance] = images(&shot, [Aov::Thickness, Aov::Transmittance]);
    let density = |c: f64| -c.max(1.0 / 255.0).ln();
    let expected = body_paint(&camera, &balls, &paint, Scale::Half, density);
    let through = |i: &usize| {
        let depth = f64::from(thickness[*i]) / cloud.radius() / f64::from(depth_of_colors);
        let is_known = expected[*i].weight > 0.1 * cloud.radius();
        [0, 1, 2].map(|k| {
            if is_known { f64::from(transmittance[3 * i + k]) - (-depth * expected[*i].mean()[k]).exp() } else { 0.0 }
        })
    };
    Difference::new(covered.iter().flat_map(through)).assert(&format!("{what}, absorption"), 2e-3, 2e-2);
}

#[test]
fn colors_and_liquids_match_the_twin() {
    let cloud = Cloud::random(60, 1500, [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]], [0.04, 0.06]);
    let size = [161, 91];
    let view = looking([0.9, 0.8, 1.4], [0.0; 3], size);
    compare("perspective", &cloud, view, size, Settings::spheres());
    for filter in [Filter::None, Filter::Gaussian, Filter::CurvatureFlow] {
        let settings = Settings { smoothing: Smoothing::of(filter), ..Settings::spheres() };
        compare(&format!("{filter:?}"), &cloud, view, size, settings);
    }
    let moved = Cloud { origin: DVec3::NEG_Z, ..cloud };
    compare("orthographic", &moved, forward_orthographic(1.0, 0.05, 6.0, size), size, Settings::spheres());
}

#[test]
fn real_water_matches_the_twin() {
    let (cloud, size) = (Cloud::read("jet/ParticleData_Fluid_42.bgeo", 0.025), [160, 90]);
    compare("jet", &cloud, looking([0.6, 0.9, 1.4], [0.0, 0.2, 0.0], size), size, Settings::spheres());
}

#[test]
fn surface_splats_of_thousands_of_pixels_match_the_twin() {
    let cloud = Cloud::random(62, 60, [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]], [0.1, 0.15]);
    let (size, paints) = ([161, 91], Paints::random(63, 60, 1));
    let (view, settings) =
        (looking([0.3, 0.2, 0.9], [0.0; 3], size), Settings { coloring: Coloring::Surface, ..unsmoothed() });
    let shot = Shot { paint: paints.paint(), ..shot_of(&cloud, view, size, settings) };
    let [raw, depth, albedo] = images(&shot, [Aov::RawDepth, Aov::Depth, Aov::Albedo]);
    let camera = Camera::new(view, size);
    let balls = balls_of(&cloud.slices(), &camera, &settings);
    let expected = surface_paint(&camera, &balls, &paints.paint(), &wide(&raw), &wide(&depth));
    let covered = (0..depth.len()).filter(|i| depth[*i].is_finite());
    let colors = covered.flat_map(|i| [0, 1, 2].map(|k| f64::from(albedo[3 * i + k]) - expected[i].mean()[k]));
    Difference::new(colors).assert("close, surface color", 1e-3, 1e-2);
}

#[test]
fn the_order_of_particles_means_nothing() {
    let cloud = Cloud::random(64, 3000, [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]], [0.02, 0.05]);
    let paints = Paints::random(65, 3000, 3);
    let mut order: Vec<usize> = (0..cloud.positions.len()).collect();
    Random(66).shuffle(&mut order);
    let shuffled = Cloud {
        positions: order.iter().map(|i| cloud.positions[*i]).collect(),
        radii: order.iter().map(|i| cloud.radii[*i]).collect(),
        ..Cloud::default()
    };
    let with = Paints {
        colors: order.iter().map(|i| paints.colors[*i]).collect(),
        liquids: order.iter().map(|i| paints.liquids[*i]).collect(),
    };
    for coloring in [Coloring::Surface, Coloring::Absorption(6.0)] {
        let settings = with_liquids(&[milk(), paint_water()], Settings { coloring, ..Settings::spheres() });
        let bits = |cloud: &Cloud, paints: &Paints| {
            let view = looking([0.9, 0.8, 1.4], [0.0; 3], SMALL);
            let shot = Shot { paint: paints.paint(), ..shot_of(cloud, view, SMALL, settings) };
            let aovs = [Aov::Color, Aov::Albedo, Aov::Liquids, Aov::Transmittance];
            images(&shot, aovs).map(|values| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>())
        };
        let first = bits(&cloud, &paints);
        assert!(first == bits(&cloud, &paints), "{coloring:?}: two runs differ");
        assert!(first == bits(&shuffled, &with), "{coloring:?}: the order shows");
    }
}

#[test]
fn a_lattice_of_two_colors_seen_through_is_their_mix() {
    // Seen from above, layer over layer: along every ray half is red and half is blue.
    let radius = 0.05;
    let cloud = Cloud::slab(16, 8, radius, 0.0);
    let [red, blue] = [[0.9, 0.2, 0.1_f32], [0.1, 0.3, 0.9]];
    let colors: Vec<[f32; 3]> = (0..cloud.positions.len()).map(|i| if i % 2 == 0 { red } else { blue }).collect();
    for (settings, allowed) in [(Settings::spheres(), 0.01), (Settings::default(), 0.01)] {
        let settings = Settings { coloring: Coloring::Absorption(8.0), ..settings };
        let paint = Paint { colors: Some(&colors), liquids: None };
        let shot = Shot { paint, ..shot_of(&cloud, above(3.0, 1.0, SIZE), SIZE, settings) };
        let [thickness, transmittance] = images(&shot, [Aov::Thickness, Aov::Transmittance]);
        let (width, height) = (SIZE[0] as usize, SIZE[1] as usize);
        let mut differences = Vec::new();
        for y in height / 4..3 * height / 4 {
            for x in width / 2 - height / 4..width / 2 + height / 4 {
                let i = y * width + x;
                let depth = f64::from(thickness[i]) / radius / 8.0;
                for k in 0..3 {
                    // Of white light, what the geometric mean of the two leaves after that depth.
                    let mix = (f64::from(red[k]) * f64::from(blue[k])).sqrt();
                    differences.push(f64::from(transmittance[3 * i + k]) - mix.powf(depth));
                }
            }
        }
        Difference::new(differences).assert("two colors", allowed, 3.0 * allowed);
    }
}

#[test]
fn liquids_that_look_alike_are_one() {
    let cloud = Cloud::read("jet/ParticleData_Fluid_42.bgeo", 0.025);
    let paints = Paints::random(67, cloud.positions.len(), 4);
    let view = looking([0.6, 0.9, 1.4], [0.0, 0.2, 0.0], SMALL);
    for optics in [Optics::default(), milk(), paint_water()] {
        for base in
            [Settings::default(), Settings::spheres(), Settings { filter_scale: Scale::Half, ..Settings::default() }]
        {
            let one = Settings { optics, ..base };
            let four = with_liquids(&[optics; 3], one);
            let shown = |settings| {
                let shot = Shot { paint: paints.paint(), ..shot_of(&cloud, view, SMALL, settings) };
                images(&shot, [Aov::Color, Aov::Albedo, Aov::Transmittance])
            };
            let (one, four) = (shown(one), shown(four));
            for (what, (one, four)) in ["color", "albedo", "transmittance"].iter().zip(one.iter().zip(&four)) {
                let most = one.iter().zip(four).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(most <= 1e-6, "{what}: {most}");
            }
        }
    }
}

#[test]
fn what_is_not_used_changes_no_bit() {
    let cloud = Cloud::read("jet/ParticleData_Fluid_42.bgeo", 0.025);
    let paints = Paints::random(68, cloud.positions.len(), 4);
    let view = looking([0.6, 0.9, 1.4], [0.0, 0.2, 0.0], SIZE);
    let plain = shot_of(&cloud, view, SIZE, Settings::default());
    let [a, b] = [plain, Shot { paint: paints.paint(), ..plain }]
        .map(|shot| with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Color])).unwrap());
    assert!(a.rgba == b.rgba && a.aovs == b.aovs);
}

#[test]
fn an_interface_is_as_sharp_as_the_particles() {
    // A slab that is one liquid to the left and another to the right.
    let radius = 0.05;
    let cloud = Cloud::slab(24, 6, radius, 0.1);
    let liquids: Vec<u8> = cloud.positions.iter().map(|p| u8::from(p[0] > 0.0)).collect();
    let settings = with_liquids(&[milk()], Settings::default());
    let paint = Paint { colors: None, liquids: Some(&liquids) };
    let shot = Shot { paint, ..shot_of(&cloud, above(3.0, 1.0, SIZE), SIZE, settings) };
    let [shares] = images(&shot, [Aov::Liquids]);
    let (width, height) = (SIZE[0] as usize, SIZE[1] as usize);
    let px = 1.0 / height as f64;
    for y in height / 4..3 * height / 4 {
        let row: Vec<f32> = (0..width).map(|x| shares[3 * (y * width + x) + 1]).collect();
        let middle = width / 2 - height / 3..width / 2 + height / 3;
        let mixed = row[middle.clone()].iter().filter(|share| (0.1..0.9).contains(*share)).count();
        assert!(mixed as f64 * px <= 2.5 * radius, "row {y}: {:.1} r wide", mixed as f64 * px / radius);
        assert!(row[middle.start] < 0.01 && row[middle.end] > 0.99, "row {y}");
    }
}

#[test]
fn a_camera_in_the_liquid_sees_its_colors() {
    let cloud = Cloud::random(69, 4000, [[-0.4, -0.4, -1.0], [0.4, 0.4, 0.4]], [0.04, 0.05]);
    let colors = vec![[0.25, 0.5, 0.75_f32]; cloud.positions.len()];
    for coloring in [Coloring::Surface, Coloring::Absorption(6.0)] {
        let settings = Settings { coloring, ..Settings::default() };
        let paint = Paint { colors: Some(&colors), liquids: None };
        let size = [160, 90];
        let shot = Shot { paint, ..shot_of(&cloud, forward(45.0, 0.01, size), size, settings) };
        let [color, albedo] = images(&shot, [Aov::Color, Aov::Albedo]);
        assert!(color.iter().all(|value| value.is_finite()));
        if coloring == Coloring::Surface {
            let wrong = albedo.as_chunks::<3>().0.iter().filter(|rgb| {
                (dvec3(rgb[0].into(), rgb[1].into(), rgb[2].into()) - dvec3(0.25, 0.5, 0.75)).length() > 1e-3
            });
            assert_eq!(wrong.count(), 0);
        }
    }
}
