//! Meshes and bodies from the command line: what is wrong with them is one line that names the file.

mod common;

use common::{Folder, cube, data};
use std::fs;

const SQUARE: &str = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3\nf 1 3 4\n";

fn scene() -> Folder {
    let folder = Folder::new();
    folder.write_pos("f_3.pos", &cube(3, 0.0));
    folder.write("square.obj", SQUARE);
    folder
}

const RENDER: [&str; 8] = ["render", "f_3.pos", "-o", "a.png", "--size", "64x48", "--quiet", "--camera-eye=2,2,2"];

#[test]
fn broken_meshes_and_bodies_are_one_line() {
    let folder = scene();
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 100000000\nproperty list uchar int vertex_indices\nend_header\n";
    folder.write("huge.ply", header);
    let mut stl = vec![0; 80];
    stl.extend(100_000_000_u32.to_le_bytes());
    folder.write("huge.stl", stl);
    folder.write("cut.glb", b"glTF\x02\0\0\0\xff");
    folder.write("lost.obj", "v 0 0 0\nf 1 2 3\n");
    folder.write("nobody.json", r#"{"bodies": [{"name": "ball", "mesh": "ball.obj"}]}"#);
    folder.write("text.json", "not json");
    folder.write("flat.json", r#"{"bodies": [{"name": "s", "mesh": "square.obj", "scale": [0, 0, 0]}]}"#);
    let cases = [
        ("--mesh", "huge.ply", "huge.ply"),
        ("--mesh", "huge.stl", "huge.stl"),
        ("--mesh", "cut.glb", "cut.glb"),
        ("--mesh", "lost.obj", "lost.obj"),
        ("--mesh", "missing.obj", "missing.obj"),
        ("--bodies", "nobody.json", "ball.obj"),
        ("--bodies", "text.json", "text.json"),
        ("--bodies", "flat.json", "flat.json"),
        ("--bodies", "missing.json", "missing.json"),
    ];
    for (option, file, named) in cases {
        let (_, line) = folder.fail(&[&RENDER[..], &[option, file]].concat());
        assert!(line.contains(named), "{line}");
        assert!(!folder.path("a.png").exists(), "{file}");
    }
}

#[test]
fn a_mesh_is_drawn_where_the_listing_puts_it_in_the_frame() {
    let folder = scene();
    let place = |y: i32| {
        format!(r#"{{"name": "s", "mesh": "elsewhere/square.obj", "dynamic": true, "position": [0, {y}, 0]}}"#)
    };
    let frames = r#"[{"frame": 2, "bodies": {"s": {"position": [0, 50, 0]}}}, {"frame": 3, "bodies": {"s": {"position": [0, 0, 0]}}}]"#;
    folder.write("b.json", format!(r#"{{"bodies": [{}], "frames": {frames}}}"#, place(90)));
    let picture = |options: &[&str]| {
        folder.succeed(&[&RENDER[..], options].concat());
        fs::read(folder.path("a.png")).unwrap()
    };
    let plain = picture(&["--background", "black"]);
    let still = picture(&["--background", "black", "--mesh", "square.obj"]);
    let placed = picture(&["--background", "black", "--mesh", "square.obj", "--bodies", "b.json"]);
    assert!(plain != still, "the mesh does not show");
    assert!(still == placed, "the listing puts the mesh elsewhere");
}

#[test]
fn the_bodies_of_a_real_scene_are_drawn() {
    let folder = scene();
    let bodies = data("rigid_coupling/bodies.json");
    let fluid = data("rigid_coupling/ParticleData_Fluid_22.bgeo");
    folder.succeed(&["render", &fluid, "--bodies", &bodies, "-o", "a.png", "--size", "160x90", "--quiet"]);
    folder.succeed(&["render", &fluid, "-o", "b.png", "--size", "160x90", "--quiet"]);
    assert!(folder.bytes("a.png") != folder.bytes("b.png"), "no body shows");
}
