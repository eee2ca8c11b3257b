//! The pictures that the documentation shows: of scenes, and of every look.

use crate::driver;
use crate::shell::{Result, built, cargo, output, run};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A picture under `docs`, what it is of, under `data`, and the options that it takes.
struct Entry(&'static str, &'static str, &'static [&'static str]);

const RIGID: &[&str] = &[
    "--size=640x360",
    "--bodies=data/rigid_coupling/bodies.json",
    "--camera-eye=1.9,1.5,3.6",
    "--camera-target=0.2,0.45,0",
];
const JET: [&str; 4] =
    ["--size=800x450", "--bodies=data/jet/bodies.json", "--camera-eye=1.4,1.1,2.2", "--camera-target=0,0.25,0"];

const DAM: [&str; 3] = ["--size=640x360", "--camera-eye=2.9,2.0,4.4", "--camera-target=0,0.9,0"];

const ENTRIES: &[Entry] = &[
    Entry(
        "colours/speed.png",
        "dam_break_double/ParticleData_Fluid_20.bgeo",
        &[DAM[0], DAM[1], DAM[2], "--color-by=velocity", "--legend-unit=m/s"],
    ),
    Entry(
        "colours/liquids.png",
        "dam_break_double/ParticleData_Fluid_20.bgeo",
        &[DAM[0], DAM[1], DAM[2], "--look=coffee", "--liquid=milk where=id>=12000"],
    ),
    Entry(
        "colours/oil.png",
        "dam_break_double/ParticleData_Fluid_15.bgeo",
        &["--size=640x360", "--camera-eye=1.5,1.7,4.4", "--camera-target=0,0.7,0", "--liquid=oil where=id>=12000"],
    ),
    Entry(
        "water.png",
        "dam_break_double/ParticleData_Fluid_20.bgeo",
        &["--size=960x540", "--camera-eye=2.9,2.0,4.4", "--camera-target=0,0.9,0"],
    ),
    Entry("scene/rigid_7.png", "rigid_coupling/ParticleData_Fluid_7.bgeo", RIGID),
    Entry("scene/rigid_13.png", "rigid_coupling/ParticleData_Fluid_13.bgeo", RIGID),
    Entry("scene/rigid_22.png", "rigid_coupling/ParticleData_Fluid_22.bgeo", RIGID),
    Entry("scene/rigid_34.png", "rigid_coupling/ParticleData_Fluid_34.bgeo", RIGID),
    Entry(
        "scene/blocks.png",
        "dam_break_double/ParticleData_Fluid_15.bgeo",
        &[
            "--size=800x450",
            "--bodies=data/dam_break_double/bodies.json",
            "--camera-eye=2.9,2.2,4.6",
            "--camera-target=0,1.1,0",
        ],
    ),
    Entry("scene/jet.png", "jet/ParticleData_Fluid_42.bgeo", &JET),
    Entry(
        "scene/green.png",
        "jet/ParticleData_Fluid_42.bgeo",
        &[
            JET[0],
            JET[1],
            JET[2],
            JET[3],
            "--strength=2",
            "--absorption=0.14,0.012,0.12",
            "--scattering=0.008,0.03,0.008",
            "--albedo=0.5,1,0.4",
            "--color=0.004,0.03,0.005",
        ],
    ),
];

const WAVE: &str = "dam_break_double/ParticleData_Fluid_20.bgeo";
const STREAM: &str = "jet/ParticleData_Fluid_42.bgeo";
const BLOCKS: &str = "dam_break_double/ParticleData_Fluid_15.bgeo";
const WAVE_NEAR: [&str; 4] =
    ["--size=480x360", "--camera-eye=1.3,0.9,1.7", "--camera-target=0.25,0.3,0", "--filter-scale=4"];
const STREAM_NEAR: [&str; 4] =
    ["--size=480x360", "--camera-eye=0.8,0.9,1.6", "--camera-target=0.1,0.2,0", "--filter-scale=2"];
const CROWN: [&str; 4] = ["--size=480x360", "--camera-eye=1.6,2.0,2.4", "--camera-target=0,0.9,0", "--noise=0.04"];

/// What docs/living.md shows, with the options that a picture takes beside its subject's. A frame alone foams by speed.
const LIVING: &[(&str, &str, [&str; 4], &[&str])] = &[
    ("wave_gaussian", WAVE, WAVE_NEAR, &["--filter=gaussian"]),
    ("wave_flow", WAVE, WAVE_NEAR, &["--filter=curvature-flow"]),
    ("wave_noise", WAVE, WAVE_NEAR, &["--filter=curvature-flow", "--noise=0.1", "--noise-wavelength=4"]),
    ("stream_gaussian", STREAM, STREAM_NEAR, &["--filter=gaussian"]),
    ("stream_flow", STREAM, STREAM_NEAR, &["--filter=curvature-flow"]),
    ("stream_noise", STREAM, STREAM_NEAR, &["--filter=curvature-flow", "--noise=0.06"]),
    ("calm", BLOCKS, CROWN, &[]),
    ("foam", BLOCKS, CROWN, &["--foam=agitation", "--foam-speed-min=1", "--foam-speed-max=5"]),
    ("spray", BLOCKS, CROWN, &["--spray-neighbours=14"]),
    ("both", BLOCKS, CROWN, &["--foam=agitation", "--foam-speed-min=1", "--foam-speed-max=5", "--spray-neighbours=14"]),
];

/// What every look is shown on.
const SUBJECT: Entry = Entry(
    "looks",
    "dam_break_double/ParticleData_Fluid_20.bgeo",
    &["--size=320x240", "--camera-eye=1.9,1.4,2.9", "--camera-target=0,0.55,0"],
);

/// Renders all of them.
pub fn render_all() -> Result {
    driver::ensure()?;
    run(cargo().args(["build", "--release", "--package", "limpid-cli"]))?;
    for Entry(picture, input, options) in ENTRIES {
        render_data(picture, input, options)?;
    }
    render_mesh()?;
    for (name, input, subject, options) in LIVING {
        render_data(&format!("living/{name}.png"), input, &[subject, *options].concat())?;
    }
    let Entry(folder, input, options) = SUBJECT;
    let looks = fs::read_dir("looks").map_err(|error| format!("looks: {error}"))?;
    for look in looks.flatten() {
        let path = look.path();
        let Some(name) = path.file_stem().and_then(|name| name.to_str()) else { continue };
        render_data(&format!("{folder}/{name}.png"), input, &[options, &["--look", name]].concat())?;
    }
    println!("The pictures are in docs");
    Ok(())
}

/// Of a file under `data`, by the simulation's own radius: the file does not say.
fn render_data(picture: &str, input: &str, options: &[&str]) -> Result {
    render(picture, &Path::new("data").join(input), &[&["--radius", "0.025"], options].concat())
}

/// Of a textured mesh, filled with particles in its colours.
fn render_mesh() -> Result {
    let particles = Path::new("out/clownfish.ply");
    fs::create_dir_all("out").map_err(|error| format!("out: {error}"))?;
    let mut sample = Command::new(built("limpid")?);
    sample.args(["sample", "data/fish/clownfish.glb", "--spacing", "0.02", "-o"]).arg(particles);
    output(&mut sample)?;
    let camera = ["--size=640x360", "--camera-eye=1.1,0.9,2.8", "--camera-target=-0.25,-0.05,0"];
    for (picture, options) in [
        ("colours/fish.png", &["--color-by=color"][..]),
        ("colours/fish_clear.png", &["--color-by=color", "--color-as=absorption", "--color-depth=25"]),
    ] {
        render(picture, particles, &[&camera, options].concat())?;
    }
    Ok(())
}

fn render(picture: &str, input: &Path, options: &[&str]) -> Result {
    let picture = Path::new("docs").join(picture);
    if let Some(folder) = picture.parent() {
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let mut command = Command::new(built("limpid")?);
    command.arg("render").arg(input).arg("-o").arg(&picture);
    command.args(["--quality", "high", "--samples", "8"]).args(options);
    output(&mut command).map(drop)
}
