//! `limpid render --part` and `--partials`: one frame from several runs.

mod common;

use common::{Folder, cube};

const OPTIONS: [&str; 9] = [
    "render",
    "cube.pos",
    "--size=120x80",
    "--anisotropy=off",
    "--layers=off",
    "--camera-eye=2.5,2,3",
    "--camera-target=0.5,0.5,0.5",
    "--quiet",
    "-o",
];

fn with(more: &[&'static str]) -> Vec<&'static str> {
    [&OPTIONS[..], more].concat()
}

#[test]
fn four_parts_make_the_picture_of_the_whole() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &cube(7, 0.0));
    folder.succeed(&with(&["whole.png"]));
    folder.succeed(&with(&["a.partial", "--part=1/4"]));
    folder.succeed(&with(&["b.partial", "--part=2/4"]));
    folder.succeed(&with(&["c.partial", "--part=3/4"]));
    folder.succeed(&with(&["d.partial", "--part=4/4"]));
    folder.succeed(&with(&["merged.png", "--partials=c.partial,a.partial,d.partial,b.partial"]));
    assert!(folder.bytes("merged.png") == folder.bytes("whole.png"));
    folder.succeed(&with(&["some.png", "--partials=c.partial,a.partial,d.partial"]));
    assert!(folder.bytes("some.png") != folder.bytes("whole.png"));
}

#[test]
fn what_does_not_fit_is_told_in_one_line() {
    let folder = Folder::new();
    folder.write_pos("cube.pos", &cube(3, 0.0));
    folder.succeed(&with(&["a.partial", "--part=1/2"]));
    folder.write("broken.partial", &folder.bytes("a.partial")[..1000]);
    folder.write("other.partial", "text");
    let told = |more: &[&'static str]| folder.fail(&with(more)).1;
    assert!(told(&["a.png", "--part=1/2"]).contains(".partial"));
    assert!(told(&["b.partial", "--part=3/2"]).contains("K/N"));
    assert!(told(&["b.partial", "--part=1/2", "--noise=0.2"]).contains("noise and foam need all particles at once"));
    // Whose surface a pixel shows is known only when that surface is whole and smooth.
    let paint = "colours and liquids of particles need all particles at once";
    for more in ["--color-by=y", "--liquid=milk where=x>0.5"] {
        assert!(told(&["b.partial", "--part=1/2", more]).contains(paint), "{more}");
        assert!(told(&["a.png", "--partials=a.partial", more]).contains(paint), "{more}");
    }
    assert!(told(&["a.png", "--partials=none.partial"]).contains("none.partial"));
    assert!(told(&["a.png", "--partials=broken.partial"]).contains("broken.partial"));
    assert!(told(&["a.png", "--partials=other.partial"]).contains("other.partial"));
    assert!(
        told(&["a.png", "--partials=a.partial", "--splat-scale=2"]).contains("another view, size, radius or scale")
    );
    assert_eq!(folder.names().iter().filter(|name| name.ends_with(".png")).count(), 0);
}
