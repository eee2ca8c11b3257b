//! Several liquids in one picture.

mod common;

use common::Folder;
use std::fs;

const SIZE: [&str; 2] = ["--size", "96x64"];

/// Two cubes side by side, in one file with a number for each, and in a file each.
fn folder() -> Folder {
    let folder = Folder::new();
    let rows = |shift: f32, kind: u32| {
        let row = move |[x, y, z]: [f32; 3]| format!("{x},{y},{z},{kind}\n");
        common::cube(5, shift).into_iter().map(row).collect::<String>()
    };
    let [left, right] = [rows(0.0, 3), rows(1.0, 7)];
    folder.write("both.csv", format!("x,y,z,kind\n{left}{right}"));
    folder.write("left_1.csv", format!("x,y,z,kind\n{left}"));
    folder.write("right_1.csv", format!("x,y,z,kind\n{right}"));
    folder
}

fn picture(folder: &Folder, input: &str, options: &[&str]) -> Vec<u8> {
    let fixed = ["-o", "a.png", "--radius", "0.1", "--quiet"];
    folder.succeed(&[&["render", input], &fixed[..], &SIZE, options].concat());
    image::open(folder.path("a.png")).unwrap().to_rgb8().into_raw()
}

/// The shares of the first three liquids at every pixel.
fn shares(folder: &Folder, input: &str, options: &[&str]) -> Vec<[f32; 3]> {
    picture(folder, input, &[options, &["--aov", "liquids=l.npy"]].concat());
    let bytes = fs::read(folder.path("l.npy")).unwrap();
    let values: Vec<f32> =
        bytes[bytes.len() - 4 * 3 * 96 * 64..].as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    values.as_chunks().0.to_vec()
}

#[test]
fn whichever_way_liquids_are_told_apart_the_picture_is_the_same() {
    let folder = folder();
    let by_number = picture(&folder, "both.csv", &["--phase-by", "kind", "--liquid", "milk phase=7"]);
    let by_condition = picture(&folder, "both.csv", &["--liquid", "milk where=kind>5"]);
    let by_file = picture(&folder, "left_1.csv", &["--liquid", "milk input=right_1.csv"]);
    assert!(by_number == by_condition, "a number and a condition");
    assert!(by_number == by_file, "a number and a file");
    folder.write("o.toml", "look = \"water\"\n[[liquid]]\nlook = \"milk\"\ninput = \"right_1.csv\"\n");
    assert!(by_file == picture(&folder, "left_1.csv", &["--config", "o.toml"]), "a flag and a table");
    assert!(by_file != picture(&folder, "left_1.csv", &["--liquid", "oil input=right_1.csv"]));
    let printed = folder.succeed(&["render", "--config", "o.toml", "--print-config"]);
    folder.write("p.toml", printed);
    assert!(by_file == picture(&folder, "left_1.csv", &["--config", "p.toml"]), "a printed configuration");
}

#[test]
fn a_liquid_like_the_first_is_not_seen() {
    let folder = folder();
    let one = picture(&folder, "both.csv", &["--look", "milk"]);
    let two = picture(&folder, "both.csv", &["--look", "milk", "--liquid", "milk where=kind==7"]);
    let most = one.iter().zip(&two).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    // Shading is the same to 1e-6: a byte may round the other way.
    assert!(most <= 1, "{most}");
}

#[test]
fn shares_sum_to_one_and_are_where_the_particles_are() {
    let folder = folder();
    let camera = ["--camera-eye", "0.9,0.4,9", "--camera-target", "0.9,0.4,0", "--ortho", "1.6"];
    let apart = ["--liquid", "milk where=kind==7", "--anisotropy", "off"];
    let shares = shares(&folder, "both.csv", &[&camera[..], &apart].concat());
    let covered = || shares.iter().enumerate().filter(|(_, share)| share.iter().any(|s| *s > 0.0));
    assert!(covered().count() > 500);
    for (i, share) in covered() {
        assert!((share.iter().sum::<f32>() - 1.0).abs() < 1e-6, "{share:?}");
        // The cubes meet at 0.9, in the middle; 2 particles beyond, each is by itself.
        let x = (i % 96) as f32 - 47.5;
        if x.abs() > 16.0 {
            assert_eq!(share[1] > 0.5, x > 0.0, "at {x}: {share:?}");
            assert!(share[0].max(share[1]) > 0.99, "at {x}: {share:?}");
        }
    }
    assert!(covered().any(|(_, share)| share[1] > 0.2 && share[1] < 0.8), "nowhere mixed");
}

#[test]
fn a_liquid_has_a_radius_of_its_own() {
    let folder = folder();
    let camera = ["--camera-eye", "0.9,0.4,9", "--camera-target", "0.9,0.4,0", "--ortho", "1.6"];
    let milk = |liquid: &str| {
        let shares = shares(&folder, "left_1.csv", &[&camera[..], &["--liquid", liquid]].concat());
        shares.iter().filter(|share| share[1] > 0.5).count()
    };
    let (same, larger) = (milk("milk input=right_1.csv"), milk("milk input=right_1.csv radius=0.15"));
    assert!(larger as f64 > 1.1 * same as f64, "{larger} pixels, {same} with the common radius");
}

#[test]
fn files_of_a_frame_belong_together_by_number() {
    let folder = folder();
    for number in [2, 10] {
        fs::copy(folder.path("left_1.csv"), folder.path(&format!("left_{number}.csv"))).unwrap();
    }
    fs::copy(folder.path("right_1.csv"), folder.path("right_10.csv")).unwrap();
    let fixed = ["render", "left_{}.csv", "--liquid", "milk input=right_{}.csv", "-o", "p_{}.png", "--radius", "0.1"];
    let output = folder.limpid(&[&fixed[..], &SIZE].concat());
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("no file for 1 frames, the first left_2.csv"), "{said}");
    let [first, second, tenth] = [1, 2, 10].map(|number| fs::read(folder.path(&format!("p_{number}.png"))).unwrap());
    assert!(first == tenth && first != second);
}

#[test]
fn mistakes_are_one_line() {
    let folder = folder();
    let fixed = ["render", "both.csv", "-o", "a.png", "--radius", "0.1"];
    for (options, expected) in [
        (&["--liquid", "milk"][..], "which particles?"),
        (&["--liquid", "glue where=kind==7"], "water, sea"),
        (&["--liquid", "milk where=sort==7"], "kind"),
        (&["--liquid", "milk input=none_{}.csv"], "none_{}.csv"),
        (&["--liquid", "milk where=kind==7 colour=1"], "not part of a look"),
        (&["--phase-by", "kind"], "--liquid"),
        (&["--phase-by", "sort", "--liquid", "milk phase=7"], "kind, x, y, z"),
        (&["--phase-by", "kind", "--liquid", "milk"], "from 3 to 7"),
    ] {
        let (_, line) = folder.fail(&[&fixed[..], &SIZE, options].concat());
        assert!(line.contains(expected), "{options:?}: {line}");
    }
    assert!(!folder.names().iter().any(|name| name.ends_with(".png")));
}
