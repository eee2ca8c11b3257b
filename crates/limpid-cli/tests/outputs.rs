//! Outputs that cannot be written are found before the work, and leave nothing behind.

mod common;

use common::{Folder, cube};
use std::fs;

#[test]
fn folders_are_checked_first() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &cube(2, 0.0));
    fs::create_dir(folder.path("taken.png")).unwrap();
    let cases: [(&[&str], &str); 5] = [
        (&["-o", "missing/a.png"], "missing"),
        (&["-o", "a.pos/a.png"], "a.pos"),
        (&["-o", "taken.png"], "taken.png"),
        (&["-o", "a.png", "--aov", "depth=missing/d.exr"], "missing"),
        (&["-o", "a.png", "--timings=missing/t.json"], "missing"),
    ];
    for (arguments, expected) in cases {
        let (_, line) = folder.fail(&[&["render", "a.pos"], arguments].concat());
        assert!(line.contains(expected), "{line}");
        assert_eq!(folder.names(), ["a.pos", "taken.png"]);
    }
}

#[test]
fn two_frames_never_share_a_file() {
    let folder = Folder::new();
    for name in ["one", "two"] {
        fs::create_dir(folder.path(name)).unwrap();
        folder.write_pos(&format!("{name}/f_7.pos"), &cube(2, 0.0));
    }
    let (code, line) = folder.fail(&["render", "one/f_7.pos", "two/f_7.pos", "-o", "a.png"]);
    assert_eq!(code, 2);
    assert!(line.contains("a_0007.png"), "{line}");
    assert_eq!(folder.names(), ["one", "two"]);
}
