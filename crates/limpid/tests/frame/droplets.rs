//! Foam, spray and bubbles as particles of their own: against the twin, and what must hold.

use crate::common::{Cloud, Difference, Random, SIZE, above, forward_orthographic, looking, shot_of, with_gpu};
use crate::reference::{Camera, droplets as twin, light_on};
use glam::{DVec3, dvec3};
use limpid::{Absorption, Droplet, DropletKind, Droplets, Optics, Radius, Settings, View};
use limpid_headless::{Aov, Background, Shot};

/// Droplets that own their arrays.
#[derive(Clone)]
struct Group {
    kind: DropletKind,
    positions: Vec<[f32; 3]>,
    radii: Vec<f32>,
    velocities: Vec<[f32; 3]>,
    life: Vec<f32>,
}

impl Group {
    fn random(seed: u64, kind: DropletKind, count: usize, half: f64, radii: [f64; 2], speed: f64) -> Self {
        let mut random = Random(seed);
        let mut group = Self { kind, positions: vec![], radii: vec![], velocities: vec![], life: vec![] };
        for _ in 0..count {
            group.positions.push([0; 3].map(|_| random.between(-half, half) as f32));
            group.radii.push(random.between(radii[0], radii[1]) as f32);
            group.velocities.push([0; 3].map(|_| random.between(-speed, speed) as f32));
            // Sixteenths, which an f16 holds.
            group.life.push((random.between(0.0, 16.0) as f32).floor() / 16.0);
        }
        group
    }

    fn one(kind: DropletKind, place: [f32; 3], radius: f32) -> Self {
        Self { kind, positions: vec![place], radii: vec![radius], velocities: vec![[0.0; 3]], life: vec![100.0] }
    }

    fn slices(&self) -> Droplets<'_> {
        Droplets {
            kind: self.kind,
            positions: &self.positions,
            radius: Radius::Each(&self.radii),
            velocities: Some(&self.velocities),
            life: Some(&self.life),
        }
    }
}

const LOOK: Droplet = Droplet { opacity: 0.7, shutter: 0.05, fade: 0.5, color: [0.9; 3] };

fn all_kinds(seed: u64, count: usize, radii: [f64; 2], speed: f64) -> Vec<Group> {
    let group = |(kind, seed)| Group::random(seed, kind, count, 0.6, radii, speed);
    DropletKind::ALL.into_iter().zip(seed..).map(group).collect()
}

/// Depth, and the opacity before and behind it.
fn rendered(cloud: &Cloud, groups: &[Group], view: View, size: [u32; 2], settings: Settings) -> [Vec<f32>; 3] {
    let droplets: Vec<Droplets<'_>> = groups.iter().map(Group::slices).collect();
    let shot = Shot { droplets: &droplets, ..shot_of(cloud, view, size, settings) };
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Depth, Aov::Spray, Aov::Bubbles])).unwrap();
    let mut images = picture.aovs.into_iter().map(|image| image.values);
    [(); 3].map(|()| images.next().unwrap())
}

fn compare(what: &str, cloud: &Cloud, groups: &[Group], view: View, size: [u32; 2]) {
    let settings = Settings { droplet: LOOK, ..Settings::default() };
    let [depth, before, behind] = rendered(cloud, groups, view, size, settings);
    let depth: Vec<f64> = depth.into_iter().map(f64::from).collect();
    let droplets: Vec<Droplets<'_>> = groups.iter().map(Group::slices).collect();
    let r = f64::from(cloud.slices().reference_radius());
    let expected = twin(&Camera::new(view, size), cloud.origin, &droplets, &LOOK, &depth, r);
    for (side, opacities, depths) in [("before", before, expected.before), ("behind", behind, expected.behind)] {
        assert!(depths.iter().any(|depth| *depth > 0.05), "{what}: nothing {side}");
        let differences = opacities.iter().zip(&depths).map(|(a, t)| f64::from(*a) - (1.0 - (-t).exp()));
        Difference::new(differences).assert(&format!("{what}, {side}"), 3e-4, 2e-3);
    }
}

#[test]
fn droplets_match_the_twin() {
    let size = [161, 91];
    let cloud = Cloud::random(60, 1500, [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]], [0.04, 0.06]);
    let view = looking([0.9, 0.8, 1.4], [0.0; 3], size);
    compare("resting", &cloud, &all_kinds(61, 100, [0.01, 0.04], 0.0), view, size);
    compare("moving", &cloud, &all_kinds(64, 100, [0.01, 0.04], 4.0), view, size);
    compare("smaller than a pixel", &cloud, &all_kinds(67, 400, [0.001, 0.008], 1.0), view, size);
    let near = looking([0.3, 0.2, 0.75], [0.0; 3], size);
    compare("large and close", &cloud, &all_kinds(70, 30, [0.1, 0.2], 20.0), near, size);
    let moved = Cloud { origin: DVec3::NEG_Z, ..cloud };
    let orthographic = forward_orthographic(1.0, 0.05, 6.0, size);
    compare("orthographic", &moved, &all_kinds(73, 100, [0.01, 0.04], 4.0), orthographic, size);
}

#[test]
fn the_order_of_droplets_means_nothing() {
    let cloud = Cloud::random(80, 800, [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]], [0.04, 0.06]);
    let group = Group::random(81, DropletKind::Spray, 3000, 0.6, [0.01, 0.05], 4.0);
    let mut order: Vec<usize> = (0..group.positions.len()).collect();
    Random(82).shuffle(&mut order);
    let shuffled = Group {
        kind: group.kind,
        positions: order.iter().map(|i| group.positions[*i]).collect(),
        radii: order.iter().map(|i| group.radii[*i]).collect(),
        velocities: order.iter().map(|i| group.velocities[*i]).collect(),
        life: order.iter().map(|i| group.life[*i]).collect(),
    };
    let bits = |group: &Group| {
        let droplets = [group.slices()];
        let shot = shot_of(&cloud, looking([0.9, 0.8, 1.4], [0.0; 3], SIZE), SIZE, Settings::spheres());
        let shot = Shot { droplets: &droplets, ..shot };
        let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Picture, Aov::Spray, Aov::Bubbles])).unwrap();
        picture.aovs.iter().flat_map(|image| image.values.iter().map(|v| v.to_bits())).collect::<Vec<_>>()
    };
    assert!(bits(&group) == bits(&shuffled));
}

/// The optical depth of a droplet alone, added up over the picture.
fn total(velocity: [f32; 3], life: f32, radius: f32) -> f64 {
    let cloud = Cloud::uniform(vec![[0.0, 0.0, 50.0]], 0.1);
    let group =
        Group { velocities: vec![velocity], life: vec![life], ..Group::one(DropletKind::Spray, [0.0; 3], radius) };
    let size = [320, 240];
    let view = View::orthographic(2.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 1.0, 4.0 / 3.0, 0.1, 4.0);
    let [_, before, _] = rendered(&cloud, &[group], view, size, Settings { droplet: LOOK, ..Settings::default() });
    before.iter().map(|opacity| -f64::from(1.0 - opacity).ln()).sum()
}

#[test]
fn a_droplet_shows_as_much_however_fast_and_small() {
    let resting = total([0.0; 3], 9.0, 0.05);
    for velocity in [[4.0, 0.0, 0.0], [0.0, 0.0, 9.0], [3.0, -6.0, 2.0]] {
        let moving = total(velocity, 9.0, 0.05);
        assert!((moving / resting - 1.0).abs() < 0.01, "{velocity:?}: {moving} instead of {resting}");
    }
    // A quarter of a pixel: as its area.
    let small = total([0.0; 3], 9.0, 0.25 / 240.0) / (0.25f64 / 240.0 / 0.05).powi(2);
    assert!((small / resting - 1.0).abs() < 0.05, "{small} instead of {resting}");
}

#[test]
fn droplets_fade_at_the_end_of_their_life() {
    let young = total([0.0; 3], 9.0, 0.05);
    for (life, share) in [(0.5, 1.0), (0.25, 0.5), (0.125, 0.25), (0.0, 0.0), (-3.0, 0.0), (f32::NAN, 1.0)] {
        let part = total([0.0; 3], life, 0.05) / young;
        assert!((part - share).abs() < 0.01, "{life} s left: {part} instead of {share}");
    }
}

#[test]
fn foam_floats_and_bubbles_stay_under() {
    let slab = Cloud::slab(24, 4, 0.05, 0.0);
    let (view, size) = (above(3.0, 1.0, [64, 64]), [64, 64]);
    let settings = Settings { droplet: LOOK, ..Settings::default() };
    let surface = 3.0 - f64::from(rendered(&slab, &[], view, size, settings)[0][32 * 64 + 32]);
    // So many r above the surface.
    let shown = |kind, height: f64| {
        let group = Group::one(kind, [0.0, (surface + 0.05 * height) as f32, 0.0], 0.02);
        let [_, before, behind] = rendered(&slab, &[group], view, size, settings);
        [before, behind].map(|opacities| opacities.into_iter().fold(0.0, f32::max) > 0.3)
    };
    let (before, behind) = ([true, false], [false, true]);
    for (height, expected) in
        [(2.0, [before; 3]), (0.6, [before, before, behind]), (-0.5, [before, behind, behind]), (-3.0, [behind; 3])]
    {
        assert_eq!(DropletKind::ALL.map(|kind| shown(kind, height)), expected, "{height} r above the surface");
    }
}

#[test]
fn foam_is_lit_with_the_surface_that_it_lies_on() {
    let slab = Cloud::slab(24, 4, 0.05, 0.0);
    let (view, size) = (above(3.0, 1.0, [64, 64]), [64, 64]);
    let middle = 32 * 64 + 32;
    let look = Droplet { opacity: 0.99, color: [0.8, 0.6, 0.4], ..LOOK };
    let settings = Settings { droplet: look, layers: false, ..Settings::default() };
    let plain = shot_of(&slab, view, size, settings);
    let color = |kinds: &[DropletKind]| {
        // Enough of it on the surface to hide what is below.
        let group = |kind: &DropletKind| Group {
            positions: vec![[0.0, 0.25, 0.0]; 4],
            radii: vec![0.2; 4],
            velocities: vec![[0.0; 3]; 4],
            life: vec![100.0; 4],
            kind: *kind,
        };
        let groups: Vec<Group> = kinds.iter().map(group).collect();
        let droplets: Vec<Droplets<'_>> = groups.iter().map(Group::slices).collect();
        let shot = Shot { droplets: &droplets, ..plain };
        let image = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Color])).unwrap().aovs.remove(0);
        dvec3(image.values[4 * middle].into(), image.values[4 * middle + 1].into(), image.values[4 * middle + 2].into())
    };
    let expected = light_on(&plain.environment, DVec3::Y, DVec3::ONE) * dvec3(0.8, 0.6, 0.4);
    let foam = color(&[DropletKind::Foam]);
    assert!((foam / expected - 1.0).abs().max_element() < 0.03, "{foam} instead of {expected}");
    // Spray is drawn over the picture, not shaded with the liquid.
    assert_eq!(color(&[DropletKind::Spray]), color(&[]));
}

#[test]
fn bubbles_are_seen_through_the_liquid_before_them() {
    let slab = Cloud::slab(24, 8, 0.05, 0.0);
    let (view, size) = (above(3.0, 1.0, [64, 64]), [64, 64]);
    let middle = 32 * 64 + 32;
    let deep = -0.3;
    let bubble = Group::one(DropletKind::Bubbles, [0.0, deep, 0.0], 0.1);
    let light = |absorption: [f32; 3]| {
        let optics = Optics { absorption: Absorption::PerWorld(absorption), color: [0.0; 3], ..Optics::default() };
        let settings = Settings { optics, droplet: LOOK, layers: false, ..Settings::default() };
        let [without, with] = [&[][..], &[bubble.slices()]].map(|droplets| {
            let shot = Shot { droplets, ..shot_of(&slab, view, size, settings) };
            let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Color, Aov::Depth])).unwrap();
            let color = &picture.aovs[0].values[4 * middle..4 * middle + 3];
            (dvec3(color[0].into(), color[1].into(), color[2].into()), f64::from(picture.aovs[1].values[middle]))
        });
        (with.0 - without.0, 3.0 - f64::from(deep) - with.1)
    };
    let (clear, _) = light([0.0; 3]);
    let absorption = [3.0, 1.0, 0.2];
    let (tinted, distance) = light(absorption);
    assert!(clear.min_element() > 0.2, "{clear}");
    let expected = dvec3(3.0, 1.0, 0.2).map(|a: f64| (-a * distance).exp());
    assert!((tinted / clear - expected).abs().max_element() < 0.01, "{} instead of {expected}", tinted / clear);
}

#[test]
fn what_stands_in_the_way_hides_droplets() {
    let cloud = Cloud::uniform(vec![[0.9, 0.0, 0.0]], 0.05);
    let size = [160, 90];
    let shown = |height: f32| {
        let group = Group::one(DropletKind::Spray, [0.0, height, 0.0], 0.1);
        let droplets = [group.slices()];
        let shot = shot_of(&cloud, looking([0.0, 1.0, 3.0], [0.0, -1.0, 0.0], size), size, Settings::default());
        let shot = Shot { droplets: &droplets, background: Background::Scene, ..shot };
        let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Spray])).unwrap();
        picture.aovs[0].values.iter().copied().fold(0.0, f32::max)
    };
    // The floor is at -1.
    assert!(shown(-0.7) > 0.5, "{}", shown(-0.7));
    assert_eq!(shown(-1.4), 0.0);
}

#[test]
fn droplets_that_cannot_be_drawn_change_nothing() {
    let cloud = Cloud::random(90, 800, [[-0.4, -0.4, -0.4], [0.4, 0.4, 0.4]], [0.04, 0.06]);
    let shot = shot_of(&cloud, looking([0.9, 0.8, 1.4], [0.0; 3], SIZE), SIZE, Settings::spheres());
    let plain = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Picture])).unwrap();
    let mut group = Group::one(DropletKind::Bubbles, [f32::NAN, 0.0, 0.0], 0.1);
    for (place, radius) in
        [([0.0, 0.0, 0.0], 0.0), ([0.0, 0.0, 0.0], f32::NAN), ([90.0, 0.0, 0.0], 0.1), ([0.0, 0.0, 40.0], 0.1)]
    {
        group.positions.push(place);
        group.radii.push(radius);
        group.velocities.push([f32::NAN; 3]);
        group.life.push(1.0);
    }
    let droplets = [group.slices()];
    let with = with_gpu(|offscreen| offscreen.render(&Shot { droplets: &droplets, ..shot }, &[Aov::Picture])).unwrap();
    assert!(plain.rgba == with.rgba && plain.aovs == with.aovs);
}

#[test]
fn lengths_of_arrays_must_fit() {
    let cloud = Cloud::uniform(vec![[0.0, 0.0, -3.0]], 0.1);
    let group = Group::random(95, DropletKind::Foam, 3, 0.5, [0.01, 0.02], 1.0);
    let droplets = [Droplets { life: Some(&[1.0]), ..group.slices() }];
    let shot = shot_of(&cloud, looking([0.0; 3], [0.0, 0.0, -1.0], SIZE), SIZE, Settings::default());
    let error = with_gpu(|offscreen| offscreen.render(&Shot { droplets: &droplets, ..shot }, &[])).unwrap_err();
    assert!(error.to_string().contains("1 lives for 3 droplets"), "{error}");
}
