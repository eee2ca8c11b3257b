//! How much the colours of moving water change from frame to frame, against those of the nearest particle at each pixel.

use crate::common::{Cloud, looking, shot_of, with_gpu};
use crate::reference::{Camera, balls_of};
use glam::{Vec2, dvec2, vec2};
use limpid::{Coloring, Motion, Paint, Settings, View};
use limpid_headless::{Aov, Shot};
use limpid_io::{ParticleSet, Values};
use std::path::{Path, PathBuf};

const RADIUS: f32 = 0.025;
const SIZE: [u32; 2] = [320, 180];

fn view() -> View {
    looking([2.9, 2.5, 5.4], [0.0, 1.2, 0.0], SIZE)
}

/// Water with velocities, coloured by the particles' ids from blue to yellow.
struct Water {
    cloud: Cloud,
    velocities: Vec<[f32; 3]>,
    colors: Vec<[f32; 3]>,
}

impl Water {
    /// What a file holds, so many seconds later by its velocities.
    fn read(path: &Path, seconds: f32) -> Self {
        let set: ParticleSet = limpid_io::read(path).unwrap();
        let values = |name| &set.attribute(name).unwrap().values;
        let (Values::F32(velocities), Values::I64(ids)) = (values("velocity"), values("id")) else {
            panic!("{}: velocities and ids of other kinds", path.display())
        };
        let velocities = velocities.as_chunks::<3>().0.to_vec();
        let moved = set.positions.iter().zip(&velocities);
        let moved = moved.map(|(p, v)| std::array::from_fn(|k| p[k] + seconds * v[k])).collect();
        let most = ids.iter().max().map_or(1.0, |most| *most as f32);
        let color = |id: &i64| [*id as f32 / most, *id as f32 / most, 0.5 - 0.5 * *id as f32 / most];
        Self { cloud: Cloud::uniform(moved, RADIUS), velocities, colors: ids.iter().map(color).collect() }
    }
}

/// What is seen at each pixel.
struct Seen {
    /// How far the surface moves until the next frame, pixels to the right and down; None: there is no fluid.
    motion: Vec<Option<Vec2>>,
    /// Colours as they are mixed, and those of the particles that a depth test finds.
    colors: [Vec<[f32; 3]>; 2],
}

impl Seen {
    fn of(water: &Water, seconds: f32) -> Self {
        let settings = Settings { coloring: Coloring::Surface, ..Settings::default() };
        let shot = Shot {
            paint: Paint { colors: Some(&water.colors), liquids: None },
            motion: Motion { velocities: Some(&water.velocities), ..Motion::default() },
            ..shot_of(&water.cloud, view(), SIZE, settings)
        };
        let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Depth, Aov::Albedo, Aov::Motion])).unwrap();
        let [depth, albedo, motion] = [0, 1, 2].map(|aov| &picture.aovs[aov].values);
        let nearest = nearest(water, &settings);
        let seen = |i: usize| depth[i].is_finite() && nearest[i].0.is_finite();
        let motion = motion.as_chunks::<2>().0.iter().map(|[right, up]| seconds * vec2(*right, -*up));
        Self {
            motion: motion.enumerate().map(|(i, motion)| seen(i).then_some(motion)).collect(),
            colors: [albedo.as_chunks().0.to_vec(), nearest.into_iter().map(|(_, color)| color).collect()],
        }
    }
}

/// The depth of the nearest particle at each pixel and its colour.
fn nearest(water: &Water, settings: &Settings) -> Vec<(f64, [f32; 3])> {
    let camera = Camera::new(view(), SIZE);
    let mut nearest = vec![(f64::INFINITY, [0.0; 3]); camera.pixel_count()];
    for (ball, color) in balls_of(&water.cloud.slices(), &camera, settings).iter().zip(&water.colors) {
        let [columns, rows] = ball.texels(&camera, 1.0, SIZE);
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let ray = camera.ray(dvec2(x.into(), y.into()) + 0.5);
            let pixel = &mut nearest[(y * SIZE[0] + x) as usize];
            if let Some(chord) = ball.chord(&ray, camera.view.near).filter(|chord| chord.start < pixel.0) {
                *pixel = (chord.start, *color);
            }
        }
    }
    nearest
}

/// How much pixels change from one frame to the next: in place, or to where their water moves.
#[derive(Debug)]
struct Change {
    rms: f64,
    /// Share of pixels that change by more than a tenth.
    jumps: f64,
}

/// Of mixed colours and of those of a depth test.
fn changes(frames: &[Seen], follow: bool) -> [Change; 2] {
    let size = SIZE.map(|n| n as f32);
    [0, 1].map(|way| {
        let (mut squares, mut jumps, mut count) = (0.0, 0.0, 0.0);
        for pair in frames.windows(2) {
            for (i, motion) in pair[0].motion.iter().enumerate() {
                let Some(motion) = motion.map(|motion| if follow { motion } else { Vec2::ZERO }) else { continue };
                let at = vec2(i as f32 % size[0], (i as f32 / size[0]).floor()) + motion.round();
                if at.x < 0.0 || at.y < 0.0 || at.x >= size[0] || at.y >= size[1] {
                    continue;
                }
                let next = at.y as usize * SIZE[0] as usize + at.x as usize;
                if pair[1].motion[next].is_none() {
                    continue;
                }
                let (before, after) = (pair[0].colors[way][i], pair[1].colors[way][next]);
                let change = (0..3).map(|k| f64::from(after[k] - before[k]).abs()).fold(0.0, f64::max);
                squares += change * change;
                jumps += f64::from(u8::from(change > 0.1));
                count += 1.0;
            }
        }
        assert!(count > 1000.0, "little to see");
        Change { rms: f64::sqrt(squares / count), jumps: jumps / count }
    })
}

#[test]
fn mixed_colors_are_steadier_than_those_of_a_depth_test() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/dam_break_double/ParticleData_Fluid_20.bgeo");
    // A fortieth of a frame: what little changes is no new water.
    let seconds = 0.001;
    let frames: Vec<Seen> = (0..5).map(|i| Seen::of(&Water::read(&file, seconds * i as f32), seconds)).collect();
    let [mixed, nearest] = changes(&frames, false);
    println!("{mixed:?}, by a depth test {nearest:?}");
    assert!(mixed.rms < 0.5 * nearest.rms, "{mixed:?}, by a depth test {nearest:?}");
    assert!(mixed.jumps < 0.15 * nearest.jumps, "{mixed:?}, by a depth test {nearest:?}");
}

/// The table of docs/colours.md.
#[test]
#[ignore = "reads more frames than the repository has: FLICKER_FRAMES is a pattern, FLICKER_FPS how many there are a second"]
fn report() {
    let pattern = std::env::var("FLICKER_FRAMES").expect("FLICKER_FRAMES");
    let seconds = 1.0 / std::env::var("FLICKER_FPS").map_or(25.0, |fps| fps.parse().expect("FLICKER_FPS"));
    let files: Vec<PathBuf> = limpid_io::expand(&[pattern]).unwrap().frames.into_iter().map(|f| f.path).collect();
    let frames: Vec<Seen> = files.iter().map(|file| Seen::of(&Water::read(file, 0.0), seconds)).collect();
    for follow in [false, true] {
        let [mixed, nearest] = changes(&frames, follow);
        println!("{} frames, follow {follow}: {mixed:.4?}, by a depth test {nearest:.4?}", files.len());
    }
}
