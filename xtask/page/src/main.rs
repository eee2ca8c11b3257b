//! Builds the viewer's web page from its WebAssembly, and serves it: `limpid-page build WASM FOLDER`, `limpid-page serve FOLDER [PORT]`.

mod pack;
mod serve;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match arguments[..] {
        ["build", wasm, folder] => pack::page(Path::new(wasm), Path::new(folder)),
        ["serve", folder] => serve::forever(Path::new(folder), 8080),
        ["serve", folder, port] => match port.parse() {
            Ok(port) => serve::forever(Path::new(folder), port),
            Err(_) => Err(format!("{port} is no port")),
        },
        _ => Err("use `cargo xtask web` or `cargo xtask web --serve`".into()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("limpid-page: {reason}");
            ExitCode::FAILURE
        }
    }
}
