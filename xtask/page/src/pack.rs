//! From WebAssembly to a folder that any web server can serve.

use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::Write;
use std::path::Path;
use wasm_bindgen_cli_support::Bindgen;

/// The most bytes that a visitor loads before the viewer starts, gzipped.
const LIMIT: usize = 3_000_000;

/// What the page consists of beside the program; the data are the simulation that it starts with.
const FILES: [(&str, &str); 8] = [
    ("web/index.html", "index.html"),
    ("web/reader.js", "reader.js"),
    ("web/example.html", "example.html"),
    ("data/dam_break_double/ParticleData_Fluid_1.bgeo", "data/dam_break_1.bgeo"),
    ("data/dam_break_double/ParticleData_Fluid_20.bgeo", "data/dam_break_20.bgeo"),
    ("data/jet/ParticleData_Fluid_32.bgeo", "data/jet_32.bgeo"),
    ("data/jet/ParticleData_Fluid_42.bgeo", "data/jet_42.bgeo"),
    ("data/jet/ParticleData_Fluid_52.bgeo", "data/jet_52.bgeo"),
];

/// Writes the page, and fails if it has grown too large.
pub fn page(wasm: &Path, folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder.join("data")).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut bindgen = Bindgen::new();
    bindgen.input_path(wasm).out_name("limpid").typescript(true).omit_default_module_path(false);
    // Names of functions would be an eighth of the download.
    bindgen.remove_name_section(true);
    bindgen.web(true).and_then(|bindgen| bindgen.generate(folder)).map_err(|error| format!("{error:#}"))?;
    for (from, to) in FILES {
        fs::copy(from, folder.join(to)).map_err(|error| format!("{from}: {error}"))?;
    }
    let program = folder.join("limpid_bg.wasm");
    let bytes = fs::read(&program).map_err(|error| format!("{}: {error}", program.display()))?;
    let packed = gzipped(&bytes).map_err(|error| error.to_string())?.len();
    println!(
        "   {}: {:.2} MB, {:.2} of {:.2} MB gzipped",
        program.display(),
        mega(bytes.len()),
        mega(packed),
        mega(LIMIT)
    );
    if packed <= LIMIT { Ok(()) } else { Err(format!("the page's program has {packed} bytes gzipped, over {LIMIT}")) }
}

fn mega(bytes: usize) -> f64 {
    bytes as f64 / 1e6
}

fn gzipped(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}
