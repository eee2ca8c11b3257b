//! The papers' comparison pictures with limpid's filters, for docs/filters.md.

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

/// Renders every picture that docs/filters.md shows.
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
    println!("The pictures are in {FOLDER}");
    Ok(())
}

fn render(name: &str, options: &[&str]) -> Result {
    let picture = format!("{FOLDER}/{name}.png");
    output(Command::new(built("limpid")?).arg("render").args(FRAME).args(["-o", &picture]).args(options)).map(drop)
}
