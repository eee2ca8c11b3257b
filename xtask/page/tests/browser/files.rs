//! Files dropped on the page.

use crate::chromium::Chromium;
use crate::layout::OPEN;
use crate::picture::{self, Folder};

/// A simulation that the page has beside that which it starts with.
pub const DAM: (&str, &str) = ("dam.bgeo", "await (await fetch('data/dam_break_20.bgeo')).arrayBuffer()");

/// A red and a blue wall behind the liquid.
const OBJ: &str = "mtllib walls.mtl\nv -1.4 1.3 -1.4\nv 1.4 1.3 -1.4\nv 1.4 0 -1.4\nv -1.4 0 -1.4\nv -1.4 1.3 1.4\nv -1.4 0 1.4\n\
    usemtl red\nf 1 4 3 2\nusemtl blue\nf 1 5 6 4\n";
const MTL: &str = "newmtl red\nKd 0.8 0.05 0.05\nnewmtl blue\nKd 0.05 0.1 0.8\n";

pub fn files_can_be_dropped(page: &mut Chromium) {
    page.drop(&[DAM]);
    page.wait("viewer.frames === 1 && viewer.isSettled && viewer.particles === 24360");
    page.drop(&[("broken.bgeo", "new Uint8Array([66, 103, 101, 111, 86, 0, 0, 0, 5, 1, 2, 3])")]);
    page.wait("viewer.problems.join().includes('broken.bgeo')");
    page.drop(&[DAM]);
    page.wait("viewer.isSettled && viewer.particles === 24360");
    page.drop(&[("shot.toml", "'size = \"300x200\"\\nlook = \"milk\"\\n'")]);
    page.wait("viewer.isSettled && viewer.toml().includes('300x200') && viewer.toml().includes('milk')");
    page.drop(&[("odd.toml", "'look = 7'")]);
    page.wait("viewer.problems.join().includes('odd.toml')");
}

/// The same file twice: it may have changed meanwhile.
pub fn files_can_be_chosen(page: &mut Chromium) {
    let folder = Folder::new("chosen");
    let path = folder.0.join("chosen.csv");
    for rows in ["0,0,0\n0.2,0,0\n", "0,0,0\n0.2,0,0\n0.4,0,0\n"] {
        std::fs::write(&path, format!("x,y,z\n{rows}")).unwrap();
        page.choose(OPEN, &path);
        page.wait(&format!("viewer.isSettled && viewer.particles === {}", rows.lines().count()));
    }
}

/// A mesh with its materials, and light from an OpenEXR picture: what the program draws of the same files.
pub fn scenes_can_be_dropped(page: &mut Chromium) {
    page.run("viewer.setToml('size = \"240x160\"\\ncamera-eye = [2.0, 1.5, 2.9]\\ncamera-target = [0.0, 0.45, 0.0]')");
    page.wait("viewer.isSettled && viewer.toml().includes('240x160')");
    let empty = page.picture();
    page.drop(&[("walls.obj", &format!("{OBJ:?}")), ("walls.mtl", &format!("{MTL:?}"))]);
    page.wait("viewer.isSettled && viewer.toml().includes('walls.obj')");
    let files = [("walls.obj", OBJ.as_bytes()), ("walls.mtl", MTL.as_bytes())];
    let shown = picture::is_that_of_the_program(page, &files);
    let is_red = |p: &image::Rgba<u8>| p.0[0] > 90 && p.0[0] / 2 > p.0[1] && p.0[0] / 2 > p.0[2];
    let red = shown.pixels().zip(empty.pixels()).filter(|(now, before)| is_red(now) && !is_red(before)).count();
    assert!(red > 500, "{red} pixels are red");
    let sky = picture::made_by_the_program("sky.exr");
    let bytes: Vec<String> = sky.iter().map(u8::to_string).collect();
    page.drop(&[("sky.exr", &format!("new Uint8Array([{}])", bytes.join(",")))]);
    page.wait("viewer.isSettled && viewer.toml().includes('sky.exr')");
    let lit = picture::is_that_of_the_program(page, &[("sky.exr", &sky), files[0], files[1]]);
    let changed = lit.pixels().zip(shown.pixels()).filter(|(a, b)| a != b).count();
    assert!(changed > 5000, "{changed} pixels changed");
    assert_eq!(
        page.text("viewer.problems.filter((line) => !line.includes('.toml') && !line.includes('fov')).join()"),
        ""
    );
}
