//! Foam, spray and bubbles: which files and particles they are taken from, and what is said of them.

mod common;

use common::Folder;

/// Droplets that many pixels show.
const OPTIONS: [&str; 10] = [
    "--camera-eye",
    "1.5,1.5,30",
    "--camera-target",
    "1.5,1.5,0",
    "--ortho",
    "8",
    "--radius",
    "0.5",
    "--droplet-radius",
    "0.5",
];

/// A cube of fluid in frames 1 and 2, and a particle far from it.
fn folder() -> Folder {
    let folder = Folder::new();
    let cube = common::cube(4, 0.0).into_iter().map(|[x, y, z]| format!("{x},{y},{z}\n"));
    let text: String = cube.chain(["5,1.5,0\n".to_owned()]).collect();
    for number in [1, 2] {
        folder.write(&format!("fluid_{number}.csv"), format!("x,y,z\n{text}"));
    }
    folder
}

/// How many pixels of a buffer are not 0 and not infinite on the left and on the right half of a frame.
fn filled(folder: &Folder, name: &str) -> [usize; 2] {
    let bytes = folder.bytes(name);
    let values: Vec<f32> =
        bytes[bytes.len() - 4 * 160 * 80..].as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    let is_filled = |i: &usize| values[*i].is_finite() && values[*i] != 0.0;
    [true, false].map(|left| (0..160 * 80).filter(|i| (i % 160 < 105) == left).filter(is_filled).count())
}

fn rendered(folder: &Folder, options: &[&str]) -> String {
    let output = ["-o", "a.png", "--size", "160x80", "--aov", "spray=s.npy", "--aov", "depth=d.npy"];
    let result = folder.limpid(&[&["render"], options, &output, &OPTIONS].concat());
    let said = String::from_utf8(result.stderr).unwrap();
    assert!(result.status.success(), "{said}");
    said
}

#[test]
fn files_beside_the_fluid_are_found_by_name_and_number() {
    let folder = folder();
    folder.write("fluid_foam_2.csv", "x,y,z,vx,vy,vz\n1.5,1.5,4,0,0,0\n");
    folder.write("fluid_2_spray.csv", "x,y,z,vx,vy,vz\n5,3.5,0,0,0,0\n");
    // In the folder they are no sequence of their own.
    rendered(&folder, &["."]);
    assert_eq!(filled(&folder, "s_0001.npy"), [0, 0]);
    let [left, right] = filled(&folder, "s_0002.npy");
    assert!(left > 10 && right > 10, "{left} {right}");
    rendered(&folder, &["fluid_2.csv", "--foam-particles", "none"]);
    let [left, right] = filled(&folder, "s.npy");
    assert!(left == 0 && right > 10, "{left} {right}");
}

#[test]
fn named_files_are_matched_by_number_and_what_is_missing_is_said() {
    let folder = folder();
    folder.write("whitecaps_2.csv", "x,y,z\n1.5,1.5,4\n");
    folder.write("rain_1.csv", "x,y,z,vx,vy,vz\n");
    let options = ["fluid_{}.csv", "--foam-particles", "whitecaps_{}.csv", "--spray-particles", "rain_{}.csv"];
    let said = rendered(&folder, &options);
    assert!(filled(&folder, "s_0002.npy")[0] > 10);
    for expected in [
        "fluid_1.csv: no foam particles: --foam-particles whitecaps_{}.csv has none of this number",
        "rain_1.csv: 0 spray particles: the file holds none",
        "fluid_2.csv: no spray particles",
        "whitecaps_2.csv: has no velocity, so its foam is drawn round",
    ] {
        assert!(said.contains(expected), "{expected:?} is not in {said}");
    }
    let (_, error) = folder.fail(&["render", "fluid_1.csv", "-o", "a.png", "--bubble-particles", "none_{}.csv"]);
    assert!(error.contains("--bubble-particles none_{}.csv") && error.contains("check"), "{error}");
}

#[test]
fn strays_of_the_fluid_become_spray() {
    let folder = folder();
    rendered(&folder, &["fluid_1.csv"]);
    let ([_, ball], spray) = (filled(&folder, "d.npy"), filled(&folder, "s.npy"));
    assert!(ball > 10 && spray == [0, 0]);
    let said = rendered(&folder, &["fluid_1.csv", "--spray-neighbours", "3"]);
    let ([cube, ball], spray) = (filled(&folder, "d.npy"), filled(&folder, "s.npy"));
    assert!(cube > 100 && ball == 0 && spray[1] > 10, "{cube} {ball} {spray:?}");
    assert!(said.contains("has no velocity, so its spray is drawn round"), "{said}");
    let said = rendered(&folder, &["fluid_1.csv", "--spray-density", "500"]);
    assert!(said.contains("has no density, so --spray-density finds no spray"), "{said}");
    assert!(said.contains("0 spray particles: none is under --spray-density 500"), "{said}");
    // With densities, those of the thin ones.
    folder.write("thin.csv", "x,y,z,density,vx,vy,vz\n1.5,1.5,0,1000,0,0,0\n2.5,1.5,0,1000,0,0,0\n5,1.5,0,300,0,0,0\n");
    rendered(&folder, &["thin.csv", "--spray-density", "500"]);
    assert!(filled(&folder, "d.npy")[1] == 0 && filled(&folder, "s.npy")[1] > 10);
}

#[test]
fn droplets_at_the_end_of_their_life_are_fainter() {
    let folder = folder();
    let opacity = |life: &str| {
        folder.write("drop.csv", format!("x,y,z,vx,vy,vz,lifetime\n5,3.5,0,0,0,0,{life}\n"));
        rendered(&folder, &["fluid_1.csv", "--spray-particles", "drop.csv"]);
        let bytes = folder.bytes("s.npy");
        let values = bytes[bytes.len() - 4 * 160 * 80..].as_chunks().0.iter().map(|b| f32::from_le_bytes(*b));
        values.fold(0.0, f32::max)
    };
    let [young, old, over] = [opacity("9"), opacity("0.1"), opacity("0")];
    assert!(young > 0.7 && old < 0.5 * young && old > 0.1 && over == 0.0, "{young} {old} {over}");
}
