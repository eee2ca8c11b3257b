//! Colours of particles by a number of each, or their own.

mod common;

use common::Folder;
use std::fs;

/// Frames of three balls of particles, cold, warm and hot, in whatever order; the second is hotter.
fn folder() -> Folder {
    let folder = Folder::new();
    let rows = |heat: [f64; 3]| {
        let mut rows: Vec<String> = Vec::new();
        for (ball, heat) in heat.into_iter().enumerate() {
            let at = common::cube(4, 0.0).into_iter();
            rows.extend(at.map(|[x, y, z]| format!("{},{y},{z},{heat},0.5,0,1", 2.0 * ball as f32 + x)));
        }
        rows
    };
    let write = |name: &str, rows: Vec<String>| {
        folder.write(name, format!("x,y,z,heat,red,green,blue\n{}\n", rows.join("\n")));
    };
    write("f_1.csv", rows([1.0, 3.0, 5.0]));
    write("f_2.csv", rows([3.0, 5.0, 9.0]).into_iter().rev().collect());
    folder
}

/// Pixels of the middles of the three balls.
fn middles(folder: &Folder, inputs: &[&str], options: &[&str]) -> Vec<[[u8; 3]; 3]> {
    let camera = ["--camera-eye", "2.3,0.3,9", "--camera-target", "2.3,0.3,0", "--ortho", "3", "--radius", "0.1"];
    let fixed = ["-o", "p_{}.png", "--size", "160x80", "--quiet", "--show", "albedo", "--legend", "off"];
    folder.succeed(&[&["render"], inputs, &fixed, &camera, options].concat());
    let picture = |name: &&str| {
        let number = name.trim_end_matches(".csv").trim_start_matches("f_");
        let picture = image::open(folder.path(&format!("p_{number}.png"))).unwrap().to_rgb8();
        [0, 1, 2].map(|ball| {
            // A world unit is 80 / 3 pixels; 2.3 is in the middle.
            let x = 80.0 + (0.3 + 2.0 * f64::from(ball) - 2.3) * 80.0 / 3.0;
            picture.get_pixel(x as u32, 40).0
        })
    };
    inputs.iter().map(picture).collect()
}

fn assert_near(shown: [u8; 3], expected: [u8; 3], what: &str) {
    // Colours come back from sums in fixed point.
    assert!((0..3).all(|k| shown[k].abs_diff(expected[k]) <= 2), "{what}: {shown:?}, not {expected:?}");
}

#[test]
fn colours_are_the_same_numbers_in_every_frame_and_any_order() {
    let folder = folder();
    let viridis = |value: f64, [low, high]: [f64; 2]| colorous::VIRIDIS.eval_continuous((value - low) / (high - low));
    for (options, range) in
        [(&[][..], [1.0, 9.0]), (&["--range", "-2,10"], [-2.0, 10.0]), (&["--range=9,1"], [9.0, 1.0])]
    {
        let shown = middles(&folder, &["f_1.csv", "f_2.csv"], &[&["--color-by", "heat"], options].concat());
        for (frame, heat) in shown.into_iter().zip([[1.0, 3.0, 5.0], [3.0, 5.0, 9.0]]) {
            for (shown, heat) in frame.into_iter().zip(heat) {
                assert_near(shown, viridis(heat, range).as_array(), &format!("{heat} of {range:?}"));
            }
        }
    }
}

#[test]
fn maps_coordinates_and_the_files_own_colours_are_shown() {
    let folder = folder();
    for shown in middles(&folder, &["f_1.csv"], &["--color-by", "color"])[0] {
        assert_near(shown, [128, 0, 255], "own");
    }
    let shown = middles(&folder, &["f_1.csv"], &["--color-by", "x", "--range", "0.3,4.3", "--colormap", "plasma"]);
    for (shown, at) in shown[0].into_iter().zip([0.0, 0.5, 1.0]) {
        // The middles of the balls, give or take a particle.
        let near =
            [at - 0.05, at, at + 0.05].map(|at: f64| colorous::PLASMA.eval_continuous(at.clamp(0.0, 1.0)).as_array());
        let within = |k: usize| {
            let (low, high) = (near.iter().map(|c| c[k]).min(), near.iter().map(|c| c[k]).max());
            (low.unwrap().saturating_sub(2)..=high.unwrap().saturating_add(2)).contains(&shown[k])
        };
        assert!((0..3).all(within), "{shown:?} at {at}");
    }
}

#[test]
fn a_legend_is_in_the_picture_unless_it_is_off() {
    let folder = folder();
    let fixed = ["render", "f_1.csv", "-o", "a.png", "--size", "320x180", "--radius", "0.1", "--quiet"];
    let picture = |options: &[&str]| {
        folder.succeed(&[&fixed, options].concat());
        fs::read(folder.path("a.png")).unwrap()
    };
    let by = ["--color-by", "heat"];
    let shown = picture(&by);
    assert_ne!(shown, picture(&[&by[..], &["--legend", "off"]].concat()));
    assert_ne!(shown, picture(&[&by[..], &["--legend-unit", "K"]].concat()));
    let own = ["--color-by", "color"];
    assert_eq!(picture(&own), picture(&[&own[..], &["--legend", "off"]].concat()));
}

#[test]
fn the_range_is_said() {
    let folder = folder();
    let output = folder.limpid(&["render", "f_{}.csv", "-o", "p.png", "--size", "32x18", "--color-by", "heat"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("colours of heat from 1 to 9"), "{said}");
}

#[test]
fn mistakes_are_one_line() {
    let folder = folder();
    let fixed = ["render", "f_1.csv", "-o", "a.png", "--size", "32x18"];
    for (options, expected) in [
        (&["--color-by", "heta"][..], "color, heat, x, y, z"),
        (&["--color-by", "heat", "--colormap", "jet"], "viridis, magma, inferno, plasma, cividis"),
        (&["--color-by", "heat", "--range", "nan,1"], "--range"),
        (&["--color-by", "heat", "--range", "2,2"], "two numbers that differ"),
        (&["--color-by", "heat", "--range", "2"], "2 numbers"),
        (&["--color-by", "heat", "--color-depth", "0"], "--color-depth"),
    ] {
        let (_, line) = folder.fail(&[&fixed[..], options].concat());
        assert!(line.contains(expected), "{options:?}: {line}");
    }
    assert_eq!(folder.names(), ["f_1.csv", "f_2.csv"]);
}
