//! `limpid sample`.

mod common;

use common::{Folder, data};
use serde_json::{Value, json};

/// A red tetrahedron.
const TETRAHEDRON: &str =
    "v 0 0 0 1 0 0\nv 4 0 0 1 0 0\nv 0 4 0 1 0 0\nv 0 0 4 1 0 0\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

fn info(folder: &Folder, file: &str) -> Value {
    serde_json::from_str(&folder.succeed(&["info", "--json", file])).unwrap()
}

#[test]
fn particles_of_a_mesh_can_be_read_again() {
    let folder = Folder::new();
    folder.write("red.obj", TETRAHEDRON);
    for name in ["red.ply", "red.csv"] {
        folder.succeed(&["sample", "red.obj", "--spacing", "0.5", "-o", name]);
        let found = info(&folder, name);
        assert!((60..=110).contains(&found["particles"].as_u64().unwrap()), "{found}");
        let attributes = json!([{"name": "radius", "components": 1}, {"name": "color", "components": 3}]);
        assert_eq!(found["attributes"], attributes);
        assert_eq!(found["radius"], json!({"value": 0.25, "source": "file"}));
    }
    folder.succeed(&["sample", &data("obstacles/sphere.obj"), "--spacing=0.1", "--cover", "-o", "sphere.xyz"]);
    assert!((1200..1310).contains(&info(&folder, "sphere.xyz")["particles"].as_u64().unwrap()));
    assert_eq!(folder.names(), ["red.csv", "red.obj", "red.ply", "sphere.xyz"]);
}

#[test]
fn particles_have_the_colours_of_a_texture() {
    let folder = Folder::new();
    folder.succeed(&["sample", &data("fish/clownfish.glb"), "--spacing", "0.05", "-o", "fish.csv"]);
    let text = String::from_utf8(folder.bytes("fish.csv")).unwrap();
    let columns: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let [red, green, blue] = ["red", "green", "blue"].map(|name| columns.iter().position(|c| *c == name).unwrap());
    let rows = text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect::<Vec<f32>>());
    let colors: Vec<[f32; 3]> = rows.map(|row| [row[red], row[green], row[blue]]).collect();
    // A clownfish: mostly orange, with bands of white between lines of black.
    let share = |is: fn(&[f32; 3]) -> bool| colors.iter().filter(|c| is(c)).count() as f64 / colors.len() as f64;
    let (orange, white, black) = (
        share(|c| c[0] > 204.0 && c[1] < 166.0 && c[2] < 77.0),
        share(|c| c.iter().all(|v| *v > 230.0)),
        share(|c| c.iter().all(|v| *v < 51.0)),
    );
    assert!(orange > 0.4 && white > 0.1 && black > 0.05, "{orange} {white} {black}: {}", columns.join(","));
}

#[test]
fn the_same_mesh_gives_the_same_bytes() {
    let folder = Folder::new();
    folder.write("red.obj", TETRAHEDRON);
    for more in [&[][..], &["--cover"]] {
        let run = |name: &str| {
            folder.succeed(&[&["sample", "red.obj", "--spacing", "0.3", "-o", name], more].concat());
            folder.bytes(name)
        };
        assert_eq!(run("a.ply"), run("b.ply"));
    }
}

#[test]
fn mistakes_are_one_line_that_names_the_file() {
    let folder = Folder::new();
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (arguments, said) in [
        (&["sample", "open.obj", "--spacing", "0.1", "-o", "a.ply"][..], "open.obj: the mesh is not closed"),
        (&["sample", "open.obj", "--spacing", "-1", "-o", "a.ply"], "--spacing"),
        (&["sample", "open.obj", "--spacing", "1e-9", "--cover", "-o", "a.ply"], "give --spacing"),
        (&["sample", "open.obj", "--spacing", "0.1", "-o", "a.vdb"], "a.vdb: particles are written as"),
        (&["sample", "none.obj", "--spacing", "0.1", "-o", "a.ply"], "none.obj"),
    ] {
        let (_, line) = folder.fail(arguments);
        assert!(line.contains(said), "{line}");
    }
    assert_eq!(folder.names(), ["open.obj"]);
}
