//! Mistakes on the command line: one line that names the option, exit code 2, nothing written.

mod common;

use common::{Folder, cube};

#[test]
fn every_mistake_is_one_line_that_names_it() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &cube(2, 0.0));
    let cases: &[(&[&str], &str)] = &[
        (&[], "limpid --help"),
        (&["bogus"], "bogus"),
        (&["render"], "no input"),
        (&["render", "a.pos"], "-o"),
        (&["render", "a.pos", "-o", "a.jpg"], ".png"),
        (&["render", "a.pos", "-o", "a.png", "--bogus"], "--bogus"),
        (&["render", "a.pos", "-o", "a.png", "--fov", "nan"], "--fov is NaN, but must be 0.1 to 179"),
        (&["render", "a.pos", "-o", "a.png", "--fov", "-5"], "--fov"),
        (&["render", "a.pos", "-o", "a.png", "--fov", "wide"], "--fov"),
        (&["render", "a.pos", "-o", "a.png", "--radius", "0"], "--radius"),
        (&["render", "a.pos", "-o", "a.png", "--radius", "-1"], "--radius"),
        (&["render", "a.pos", "-o", "a.png", "--radius", "inf"], "--radius"),
        (&["render", "a.pos", "-o", "a.png", "--splat-scale=9"], "--splat-scale is 9, but must be 0.5 to 4"),
        (&["render", "a.pos", "-o", "a.png", "--iterations", "0"], "--iterations"),
        (&["render", "a.pos", "-o", "a.png", "--iterations", "-3"], "--iterations"),
        (&["render", "a.pos", "-o", "a.png", "--camera-eye", "1,2"], "--camera-eye"),
        (&["render", "a.pos", "-o", "a.png", "--camera-eye", "1,2,nan"], "--camera-eye"),
        (&["render", "a.pos", "-o", "a.png", "--size", "0x10"], "--size"),
        (&["render", "a.pos", "-o", "a.png", "--size", "10x99999"], "16384x16384"),
        (&["render", "a.pos", "-o", "a.png", "--filter", "bogus"], "narrow-range"),
        (&["render", "a.pos", "-o", "a.png", "--quality", "best"], "draft"),
        (&["render", "a.pos", "-o", "a.png", "--thickness-scale", "3"], "--thickness-scale"),
        (&["render", "a.pos", "-o", "a.png", "--fov", "30", "--ortho", "2"], "--ortho"),
        (&["render", "a.pos", "-o", "a.png", "--aov", "depth"], "NAME=FILE"),
        (&["render", "a.pos", "-o", "a.png", "--aov", "bogus=a.exr"], "raw-depth"),
        (&["render", "a.pos", "-o", "a.png", "--aov", "depth=a.tif"], ".npy"),
        (&["render", "a.pos", "-o", "a.png", "--aov", "depth=d.npy", "--aov", "normal=d.npy"], "d.npy"),
    ];
    for (arguments, expected) in cases {
        let (code, line) = folder.fail(arguments);
        assert_eq!(code, 2, "{line}");
        assert!(line.contains(expected), "{line}");
    }
    assert_eq!(folder.names(), ["a.pos"]);
}

#[test]
fn negative_numbers_need_no_equals_sign() {
    let folder = Folder::new();
    let spaced = folder.succeed(&["render", "--print-config", "--camera-eye", "-1,2,-3.5"]);
    let joined = folder.succeed(&["render", "--print-config", "--camera-eye=-1,2,-3.5"]);
    assert!(spaced.contains("\ncamera-eye = [-1.0, 2.0, -3.5]\n"), "{spaced}");
    assert_eq!(spaced, joined);
}

#[test]
fn help_and_version_are_no_errors() {
    let folder = Folder::new();
    assert!(folder.succeed(&["--version"]).starts_with("limpid "));
    let help = folder.succeed(&["render", "--help"]).split_whitespace().collect::<Vec<_>>().join(" ");
    // Ranges, defaults and names come from where they are defined.
    for part in ["[0.5 to 4]", "[default: 1.5]", "narrow-range", "[default: 1280x720]"] {
        assert!(help.contains(part), "{part}: {help}");
    }
}
