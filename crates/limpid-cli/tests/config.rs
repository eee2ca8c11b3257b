//! Configuration files.

mod common;

use common::Folder;

#[test]
fn a_printed_configuration_reads_back_to_itself() {
    let folder = Folder::new();
    let runs: [&[&str]; 3] = [
        &[],
        &["in 1.vtk", "-o", "out \"x\".png", "--ortho", "2", "--up", "z", "--quality", "draft", "--strength", "0.3"],
        &[
            "a_{}.vtk",
            "b.pos",
            "-o",
            "o.png",
            "--camera-eye=-1,1e-7,3",
            "--camera-target",
            "1,2,3",
            "--radius",
            "1e-6",
            "--absorption-per-world",
            "0.1,0.2,0.3",
            "--aov",
            "depth=d.exr",
            "--aov",
            "normal=n.npy",
            "--timings",
            "--adapter",
            "0",
            "--quiet",
            "--background",
            "transparent",
            "--thickness-scale",
            "4",
            "--filter",
            "none",
            "--size",
            "31x17",
            "--exposure",
            "0.5",
            "--density-threshold",
            "3.25",
        ],
    ];
    for arguments in runs {
        let printed = folder.succeed(&[&["render", "--print-config"], arguments].concat());
        folder.write("printed.toml", &printed);
        let again = folder.succeed(&["render", "--print-config", "--config", "printed.toml"]);
        assert_eq!(printed, again);
    }
}

#[test]
fn flags_win_over_the_file_and_the_file_over_defaults() {
    let folder = Folder::new();
    folder.write("c.toml", "fov = 30\nstrength = 2\nquiet = true\n");
    let printed = folder.succeed(&["render", "--print-config", "--config", "c.toml", "--fov=60", "--quiet=false"]);
    for line in ["fov = 60.0", "strength = 2.0", "quiet = false", "splat-scale = 1.5"] {
        assert!(printed.lines().any(|found| found == line), "{line}: {printed}");
    }
}

#[test]
fn mistakes_name_the_file_and_the_key() {
    let folder = Folder::new();
    let cases = [
        ("\nstrenght = 2", ["c.toml: line 2", "strenght"]),
        ("fov = \"wide\"", ["c.toml", "fov"]),
        ("fov = [", ["c.toml", "line 1"]),
        ("fov = 30\northo = 2", ["c.toml", "--ortho"]),
        ("filter = \"bogus\"", ["c.toml", "narrow-range"]),
        ("size = \"0x1\"", ["c.toml", "16384x16384"]),
        ("strength = -1", ["--strength", "0 to 20"]),
        ("aov = [\"bogus=a.exr\"]\ninput = [\"a.vtk\"]\noutput = \"a.png\"", ["a.vtk", "no such file"]),
    ];
    for (text, expected) in cases {
        folder.write("c.toml", text);
        let (_, line) = folder.fail(&["render", "--config", "c.toml"]);
        assert!(expected.iter().all(|part| line.contains(part)), "{text}: {line}");
    }
    let (_, line) = folder.fail(&["render", "--config", "missing.toml"]);
    assert!(line.contains("missing.toml"), "{line}");
}
