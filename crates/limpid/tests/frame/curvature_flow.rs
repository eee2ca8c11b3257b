//! Curvature flow and the mean curvature against their twins, and the laws they obey.

use crate::common::{
    Cloud, Difference, Random, Rendered, SIZE, forward, forward_orthographic, looking, render, shot_of, with_gpu,
};
use crate::reference::{Camera, curvature_flow, mean_curvature};
use glam::DVec3;
use limpid::{CurvatureFlow, Lanes, Settings, Smoothing, View};
use limpid_headless::Aov;

const FORMS: [CurvatureFlow; 2] = [CurvatureFlow::Implicit, CurvatureFlow::Explicit];

fn smoothed(cloud: &Cloud, view: View, size: [u32; 2], smoothing: Smoothing) -> Rendered {
    render(&shot_of(cloud, view, size, Settings { smoothing, ..Settings::spheres() }))
}

fn dam_break_view() -> View {
    looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE)
}

fn f64s(values: &[f32]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value)).collect()
}

fn compare(what: &str, cloud: &Cloud, view: View) {
    let camera = Camera::new(view, SIZE);
    for form in FORMS {
        let smoothing = Smoothing { iterations: 5, strength: 1.0, ..Smoothing::flow(form) };
        let rendered = smoothed(cloud, view, SIZE, smoothing);
        let expected = curvature_flow(
            &camera,
            &f64s(&rendered.raw_depth),
            &smoothing,
            cloud.radius(),
            Settings::spheres().splat_scale.into(),
        );
        let same = rendered.depth.iter().zip(&expected).all(|(a, b)| a.is_finite() == b.is_finite());
        assert!(same, "{what}: the silhouette moved");
        let off = Difference::of_depth(&rendered.depth, &expected);
        off.assert(&format!("{what}, {form:?}"), 2e-3 * cloud.radius(), 1e-2 * cloud.radius());
        let step = f64::from(Settings::spheres().normal_step) * cloud.radius();
        let expected = mean_curvature(&camera, &f64s(&rendered.depth), step);
        let curvatures = rendered.curvature.iter().zip(&expected);
        let off = Difference::new(curvatures.map(|(rendered, expected)| f64::from(*rendered) - expected));
        off.assert(&format!("{what}, {form:?}, curvature"), 0.02 / cloud.radius(), 0.05 / cloud.radius());
    }
}

#[test]
fn twins() {
    let random = Cloud::random(60, 4000, [[-2.0, -1.0, -4.0], [2.0, 1.0, -1.0]], [0.015, 0.04]);
    compare("random", &random, forward(60.0, 0.05, SIZE));
    compare("orthographic", &random, forward_orthographic(2.0, 0.05, 5.0, SIZE));
    compare("dam break", &Cloud::dam_break(), dam_break_view());
}

/// Lines cut into segments, as GPUs take them, give what whole lines give, as CPUs do: also where smoothing reaches over many, and in a
/// picture with fewer lines than are taken at a time.
#[test]
fn segments_are_whole_lines() {
    let cloud = Cloud::dam_break();
    for (strength, size) in [(1.5, SIZE), (6.0, SIZE), (20.0, [200, 2])] {
        let smoothing = Smoothing { strength, ..Smoothing::flow(CurvatureFlow::Implicit) };
        let shot = shot_of(&cloud, dam_break_view(), size, Settings { smoothing, ..Settings::spheres() });
        let [few, many] = with_gpu(|offscreen| {
            let depths = [Lanes::Few, Lanes::Many].map(|lanes| {
                offscreen.renderer_mut().set_lanes(lanes);
                offscreen.render(&shot, &[Aov::Depth]).unwrap().aovs.remove(0).values
            });
            let lanes = Lanes::of(&offscreen.gpu().device);
            offscreen.renderer_mut().set_lanes(lanes);
            depths
        });
        assert!(few != many, "they differ in rounding, or one of them did not run");
        let what = format!("{strength} r, {size:?}");
        Difference::of_depth(&many, &f64s(&few)).assert(&what, 1e-4 * cloud.radius(), 1e-3 * cloud.radius());
    }
}

/// Close by, a step is of many pixels: none may swing about.
#[test]
fn long_steps_leave_no_pixel_swinging() {
    let cloud = Cloud::dam_break();
    let view = looking([1.75, 0.75, 1.25], [1.2, 0.4, 0.6], SIZE);
    let [few, many] = [9, 200].map(|iterations| {
        let smoothing = Smoothing { iterations, ..Smoothing::flow(CurvatureFlow::Implicit) };
        smoothed(&cloud, view, SIZE, smoothing)
    });
    // Pixels a tenth of r and more beside the mean of both neighbours, which are much closer to each other.
    let spikes = |rendered: &Rendered| {
        let [width, height] = SIZE.map(|size| size as usize);
        let rows = (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| y * width + x));
        rows.filter(|&i| {
            let [left, here, right] = [i - 1, i, i + 1].map(|i| f64::from(rendered.depth[i]));
            let beside = (0.5 * (left + right) - here).abs();
            beside > 0.1 * cloud.radius() && (left - right).abs() < 0.5 * beside
        })
        .count()
    };
    let [few, many] = [&few, &many].map(spikes);
    println!("{few} spikes after 9 steps, {many} after 200");
    assert!(few <= 5 * many, "{few} spikes after 9 steps, {many} after 200");
}

/// Mean |H| where all neighbours are there.
fn mean_curvature_of(rendered: &Rendered) -> f64 {
    let inside: Vec<f64> = f64s(&rendered.curvature).into_iter().filter(|h| *h != 0.0).map(f64::abs).collect();
    inside.iter().sum::<f64>() / inside.len() as f64
}

#[test]
fn curvature_falls_with_every_iteration() {
    let cloud = Cloud::dam_break();
    for form in FORMS {
        let mut before = f64::INFINITY;
        for iterations in 1..=6 {
            let strength = 0.3 * (iterations as f32).sqrt();
            let smoothing = Smoothing { iterations, strength, ..Smoothing::flow(form) };
            let after = mean_curvature_of(&smoothed(&cloud, dam_break_view(), SIZE, smoothing));
            assert!(after < before, "{form:?}: {before} became {after} in iteration {iterations}");
            before = after;
        }
    }
}

#[test]
fn a_hundred_explicit_iterations_leave_a_fifth_of_the_curvature() {
    let cloud = Cloud::dam_break();
    let raw = smoothed(&cloud, dam_break_view(), SIZE, Smoothing::of(limpid::Filter::None));
    let smoothing = Smoothing { strength: 20.0, ..Smoothing::flow(CurvatureFlow::Explicit) };
    let smooth = smoothed(&cloud, dam_break_view(), SIZE, smoothing);
    let (raw, smooth) = (mean_curvature_of(&raw), mean_curvature_of(&smooth));
    println!("mean |H| from {raw:.2} to {smooth:.2}");
    assert!(smooth < 0.2 * raw);
}

#[test]
fn the_forms_agree() {
    const SIZE: [u32; 2] = [1024, 768];
    let view = looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE);
    let cloud = Cloud::dam_break();
    // As many steps as none needs shortening.
    let explicit = Smoothing { iterations: 400, ..Smoothing::flow(CurvatureFlow::Explicit) };
    let implicit = Smoothing::flow(CurvatureFlow::Implicit);
    let [explicit, implicit] = [explicit, implicit].map(|form| smoothed(&cloud, view, SIZE, form));
    let [width, height] = SIZE.map(|side| side as usize);
    let radius = cloud.radius();
    // Farther than 8 pixels from the ends of a sheet.
    let whole = |index: usize| {
        let (x, y) = (index % width, index / width);
        let sheet = |place: usize| explicit.curvature[place] != 0.0;
        (8..width - 8).contains(&x)
            && (8..height - 8).contains(&y)
            && (y - 8..=y + 8).all(|y| (x - 8..=x + 8).all(|x| sheet(y * width + x)))
    };
    let pixels: Vec<usize> = (0..width * height).filter(|index| whole(*index)).collect();
    let off = Difference::new(pixels.iter().map(|i| f64::from(implicit.depth[*i] - explicit.depth[*i])));
    let mean = |of: &Rendered| pixels.iter().map(|i| f64::from(of.curvature[*i].abs())).sum::<f64>();
    let ratio = mean(&implicit) / mean(&explicit);
    println!("{} pixels: depth within {:.4} r RMS, mean |H| {ratio:.3} of it", pixels.len(), off.rms() / radius);
    assert!(off.rms() < 0.02 * radius);
    assert!((ratio - 1.0).abs() < 0.05);
}

/// A picture of any depths: one tiny ball for each pixel, and unseen ones behind the camera that set r.
fn picture(view: View, size: [u32; 2], depth: impl Fn(usize, DVec3) -> Option<f64>, radius: f32) -> Cloud {
    let camera = Camera::new(view, size);
    let mut cloud = Cloud::default();
    for (index, px) in camera.pixels() {
        let ray = camera.ray(px);
        if let Some(depth) = depth(index, ray.direction) {
            cloud.positions.push(ray.at(depth).as_vec3().into());
            cloud.radii.push((0.1 / camera.px_per_world(depth)) as f32);
        }
    }
    let behind = cloud.positions.len() + 1;
    cloud.positions.extend(std::iter::repeat_n([0.0, 0.0, 50.0], behind));
    cloud.radii.extend(std::iter::repeat_n(radius, behind));
    cloud
}

const RADIUS: f32 = 0.05;

#[test]
fn planes_stay() {
    let size = [160, 100];
    let view = forward(30.0, 0.05, size);
    for degrees in [0.0, 30.0, 60.0] {
        let normal = DVec3::new(f64::sin(f64::to_radians(degrees)), 0.0, f64::cos(f64::to_radians(degrees)));
        let cloud = picture(view, size, |_, ray| Some(-3.0 * normal.z / normal.dot(ray)), RADIUS);
        for form in FORMS {
            let rendered = smoothed(&cloud, view, size, Smoothing { strength: 1.0, ..Smoothing::flow(form) });
            // Up to the picture's edge. Only the rounding of the balls' own depths moves.
            let pixels = rendered.depth.iter().zip(&rendered.raw_depth);
            let off = Difference::new(pixels.map(|(after, before)| f64::from(after - before)));
            println!("{degrees} degrees, {form:?}: {:e} r", off.max() / f64::from(RADIUS));
            assert!(off.max() < 1e-3 * f64::from(RADIUS), "{degrees} degrees, {form:?}: {:e}", off.max());
        }
    }
    // A ball around the camera, cut by the near plane: the same depth in every pixel.
    let cloud = Cloud { positions: vec![[0.0; 3]], radii: vec![RADIUS], ..Cloud::default() };
    for form in FORMS {
        let rendered = smoothed(&cloud, forward(45.0, 0.001, size), size, Smoothing::flow(form));
        assert_eq!(rendered.covered(), rendered.depth.len());
        assert_eq!(rendered.depth, rendered.raw_depth, "{form:?}");
    }
}

#[test]
fn single_pixels_do_not_explode() {
    let size = [96, 64];
    let view = forward(45.0, 0.05, size);
    let mut random = Random(3);
    let bumps: Vec<Option<f64>> = (0..size[0] * size[1])
        .map(|_| Some(3.0 - f64::from(RADIUS) * random.between(-1.0, 1.0)).filter(|_| random.between(0.0, 1.0) > 0.1))
        .collect();
    let cloud = picture(view, size, |index, _| bumps[index], RADIUS);
    for form in FORMS {
        for strength in [1.0, 20.0] {
            let smoothing = Smoothing { iterations: 500, strength, ..Smoothing::flow(form) };
            let rendered = smoothed(&cloud, view, size, smoothing);
            let off = Difference::new(rendered.depth.iter().filter(|z| z.is_finite()).map(|z| f64::from(*z) - 3.0));
            assert!(off.max() < 1.5 * f64::from(RADIUS), "{form:?}, strength {strength}: {}", off.max());
        }
    }
}

#[test]
fn nothing_crosses_a_silhouette() {
    let size = [96, 64];
    let view = forward(45.0, 0.05, size);
    let in_front = |index: usize| (index % 96 / 16 + index / 96 / 16).is_multiple_of(2);
    for form in FORMS {
        let back = |seed| {
            let mut random = Random(seed);
            let front: Vec<f64> = (0..96 * 64).map(|_| random.between(2.0, 2.05)).collect();
            let depth =
                |index: usize, _| Some(if in_front(index) { front[index] } else { 3.0 + 0.001 * (index % 7) as f64 });
            let rendered = smoothed(&picture(view, size, depth, RADIUS), view, size, Smoothing::flow(form));
            let pixels = rendered.depth.iter().enumerate();
            pixels.filter(|(index, _)| !in_front(*index)).map(|(_, depth)| *depth).collect::<Vec<f32>>()
        };
        assert_eq!(back(1), back(2), "{form:?}");
    }
}

#[test]
fn drops_stay_round() {
    let size = [200, 150];
    let view = forward(40.0, 0.05, size);
    // A drop by itself, one right before a wall of the same liquid, and the wall's own bumps.
    let mut cloud = Cloud::default();
    cloud.positions.extend([[-0.9, 0.0, -3.0], [0.5, 0.0, -3.0]]);
    for (x, y) in (0..24).flat_map(|x| (0..24).map(move |y| (x, y))) {
        cloud.positions.push([x as f32 * 0.06 - 0.2, y as f32 * 0.06 - 0.7, -4.0]);
    }
    cloud.radii = vec![RADIUS; cloud.positions.len()];
    let camera = Camera::new(view, size);
    let near = |px: glam::DVec2, place: [f32; 3]| {
        let ray = camera.ray(px).direction;
        let place = DVec3::from(place.map(f64::from));
        (ray * -place.z - place).length() < 0.7 * 1.5 * f64::from(RADIUS)
    };
    for smoothing in FORMS.map(Smoothing::flow).into_iter().chain([Smoothing::of(limpid::Filter::Bilateral)]) {
        let rendered = smoothed(&cloud, view, size, smoothing);
        let moved = |index: usize| f64::from((rendered.depth[index] - rendered.raw_depth[index]).abs() / RADIUS);
        for place in [cloud.positions[0], cloud.positions[1]] {
            let drop: Vec<usize> = camera.pixels().filter(|(_, px)| near(*px, place)).map(|(index, _)| index).collect();
            assert!(drop.len() > 20);
            let most = drop.iter().map(|index| moved(*index)).fold(0.0, f64::max);
            assert!(most < 0.05, "{smoothing:?}: a drop moved by {most} r");
        }
        let wall =
            camera.pixels().filter(|(index, _)| rendered.depth[*index] > 3.5 && rendered.depth[*index].is_finite());
        let most = wall.map(|(index, _)| moved(index)).fold(0.0, f64::max);
        assert!(most > 0.1, "{smoothing:?}: the wall is as it was");
    }
}
