//! The papers' comparison pictures with limpid: filters for docs/filters.md, spheres and ellipsoids for docs/ellipsoids.md.

use crate::driver;
use crate::shell::{Result, built, cargo, output, run};
use std::fs;
use std::process::Command;

const FOLDER: &str = "docs/figures";
const FRAME: [&str; 7] = [
    "data/dam_break_double/ParticleData_Fluid_20.bgeo",
    "--size",
    "400x300",
    "--camera-eye=1.9,1.5,3.1",
    "--camera-target=0.1,0.65,0",
    "--radius",
    "0.025",
];

/// Each filter as clay, as curvature and shaded (2022, Fig. 6 to 8).
const FILTERS: [&str; 5] = ["none", "gaussian", "bilateral", "curvature-flow", "narrow-range"];
const VIEWS: [(&str, &[&str]); 3] =
    [("clay", &["--show", "clay"]), ("curvature", &["--show", "curvature"]), ("shaded", &[])];

/// Iterations of the 2009 paper's Fig. 8; 0 is no filter.
const FLOW_ITERATIONS: [&str; 3] = ["0", "40", "60"];
/// Iterations of the bilateral filter in its Fig. 9.
const BILATERAL_ITERATIONS: [&str; 4] = ["1", "2", "4", "6"];

/// The 2022 paper's matrix, its Fig. 4 to 8: two scenes, each with every shape, filter and look.
const MATRIX_SCENES: [(&str, &[&str]); 2] = [
    (
        "rigid",
        &[
            "data/rigid_coupling/ParticleData_Fluid_22.bgeo",
            "--bodies=data/rigid_coupling/bodies.json",
            "--size=240x180",
            "--camera-eye=1.45,0.95,1.75",
            "--camera-target=0.35,0.3,0",
            "--radius=0.025",
        ],
    ),
    (
        "blocks",
        &[
            "data/dam_break_double/ParticleData_Fluid_20.bgeo",
            "--size=240x180",
            "--camera-eye=1.5,1.3,2.4",
            "--camera-target=0.1,0.8,0",
            "--radius=0.025",
        ],
    ),
];
const MATRIX_SHAPES: [(&str, &[&str]); 2] =
    [("spheres", &["--anisotropy", "off"]), ("ellipsoids", &["--anisotropy", "on"])];
const MATRIX_LOOKS: [(&str, &[&str]); 2] = [("opaque", &["--opaque", "on"]), ("clear", &[])];

/// Renders every picture that docs/filters.md and docs/ellipsoids.md show.
pub fn render_all() -> Result {
    driver::ensure()?;
    run(cargo().args(["build", "--release", "--package", "limpid-cli"]))?;
    fs::create_dir_all(FOLDER).map_err(|error| format!("{FOLDER}: {error}"))?;
    for filter in FILTERS {
        for (view, options) in VIEWS {
            render(&format!("{filter}_{view}"), &[&["--filter", filter], options].concat())?;
        }
    }
    for iterations in FLOW_ITERATIONS {
        let flow: &[&str] = match iterations {
            "0" => &["--filter", "none"],
            _ => &["--curvature-flow", "explicit", "--strength", "20", "--iterations", iterations],
        };
        for (view, options) in VIEWS {
            render(&format!("fig8_{iterations}_{view}"), &[flow, options].concat())?;
        }
    }
    for iterations in BILATERAL_ITERATIONS {
        // The iterations share the strength: the same smoothing each time.
        let strength = format!("{:.3}", 1.5 * iterations.parse::<f64>().map_or(1.0, f64::sqrt));
        let options = ["--filter", "bilateral", "--iterations", iterations, "--strength", &strength, "--show", "clay"];
        render(&format!("fig9_{iterations}"), &options)?;
    }
    for scale in ["1", "2", "4"] {
        render(&format!("scale_{scale}"), &["--filter-scale", scale, "--thickness-scale", scale])?;
    }
    for (scene, frame) in MATRIX_SCENES {
        for (shape, shape_options) in MATRIX_SHAPES {
            for (look, look_options) in MATRIX_LOOKS {
                for filter in FILTERS {
                    let options = [shape_options, look_options, &["--filter", filter]].concat();
                    render_frame(&format!("matrix_{scene}_{shape}_{look}_{filter}"), frame, &options)?;
                }
            }
        }
    }
    println!("The pictures are in {FOLDER}");
    Ok(())
}

fn render(name: &str, options: &[&str]) -> Result {
    render_frame(name, &FRAME, options)
}

fn render_frame(name: &str, frame: &[&str], options: &[&str]) -> Result {
    let picture = format!("{FOLDER}/{name}.png");
    output(Command::new(built("limpid")?).arg("render").args(frame).args(["-o", &picture]).args(options)).map(drop)
}
