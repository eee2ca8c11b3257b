//! Which particles and frames a picture is made of.

mod common;

use common::Folder;

/// Two balls of particles, of types 1 and 2.
fn folder() -> Folder {
    let folder = Folder::new();
    let rows = |x0: f64, kind: u32| {
        common::cube(4, 0.0).into_iter().map(move |[x, y, z]| format!("{},{y},{z},{kind},{kind}\n", x0 + f64::from(x)))
    };
    let text: String = rows(0.0, 1).chain(rows(10.0, 2)).collect();
    for number in [2, 4, 6, 8] {
        folder.write(&format!("f_{number}.csv"), format!("x,y,z,Type,Speed\n{text}"));
    }
    folder
}

fn covered(folder: &Folder, options: &[&str]) -> (usize, usize) {
    let camera = ["--camera-eye", "5.5,1,30", "--camera-target", "5.5,1,0", "--ortho", "8", "--radius", "0.5"];
    let fixed = ["render", "f_2.csv", "-o", "a.png", "--size", "160x80", "--quiet", "--aov", "depth=d.npy"];
    folder.succeed(&[&fixed[..], &camera, options].concat());
    let bytes = std::fs::read(folder.path("d.npy")).unwrap();
    let depths: Vec<f32> =
        bytes[bytes.len() - 4 * 160 * 80..].as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    let count = |left: bool| (0..160 * 80).filter(|i| (i % 160 < 80) == left && depths[*i].is_finite()).count();
    (count(true), count(false))
}

#[test]
fn what_is_chosen_is_what_is_drawn() {
    let folder = folder();
    let (left, right) = covered(&folder, &[]);
    assert!(left > 100 && right > 100);
    assert_eq!(covered(&folder, &["--where", "Type == 1"]), (left, 0));
    assert_eq!(covered(&folder, &["--where", "Type == 1 && Speed > 1"]), (0, 0));
    assert_eq!(covered(&folder, &["--where", "Type == 2", "--where", "y < 100"]), (0, right));
    assert_eq!(covered(&folder, &["--clip", "-1,-1,-1,5,9,9"]), (left, 0));
    assert_eq!(covered(&folder, &["--drop-isolated", "200"]), (0, 0));
    assert_eq!(covered(&folder, &["--attribute", "density=Type", "--density-threshold", "1.5"]), (0, right));
    // A quarter as large about the origin: all of it is in the left half.
    let (near, far) = covered(&folder, &["--unit-scale", "0.25"]);
    assert!(near > 0 && far == 0, "{near}, {far}");
}

#[test]
fn frames_are_chosen_by_number() {
    let folder = folder();
    let fixed = ["render", "f_{}.csv", "-o", "p_{}.png", "--size", "32x18", "--quiet", "--radius", "0.5"];
    folder.succeed(&[&fixed[..], &["--start", "3", "--end", "8", "--step", "2"]].concat());
    let there = |name: &str| folder.path(name).exists();
    assert_eq!(["p_2.png", "p_4.png", "p_6.png", "p_8.png"].map(there), [false, true, false, true]);
    let (_, line) = folder.fail(&[&fixed[..], &["--start", "100"]].concat());
    assert!(line.contains("frames 100"), "{line}");
}

#[test]
fn mistakes_are_one_line() {
    let folder = folder();
    let fixed = ["render", "f_2.csv", "-o", "a.png", "--size", "32x18"];
    for (options, expected) in [
        (["--where", "Kind == 1"], "Type, Speed"),
        (["--where", "Type"], "Type == 3"),
        (["--attribute", "velocity"], "NAME=IN_FILE"),
        (["--attribute", "velocity=Vel"], "Vel"),
        (["--clip", "1,2,3"], "6 numbers"),
        (["--unit-scale", "0"], "--unit-scale"),
        (["--step", "0"], "--step"),
    ] {
        let (_, line) = folder.fail(&[&fixed[..], &options].concat());
        assert!(line.contains(expected), "{options:?}: {line}");
    }
}
