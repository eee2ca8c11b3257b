//! Reads particle files five times each and prints, for each, its particles, the least time in ms, and the most memory that
//! the process has had so far in MiB (Linux). `reading.py` beside it compares that with other programs.

use std::time::Instant;

fn main() -> Result<(), limpid_io::ReadError> {
    for path in std::env::args_os().skip(1) {
        let mut least_ms = f64::INFINITY;
        let mut particles = 0;
        for _ in 0..5 {
            let start = Instant::now();
            particles = limpid_io::read(path.as_ref())?.len();
            least_ms = least_ms.min(1e3 * start.elapsed().as_secs_f64());
        }
        println!("{particles} {least_ms:.3} {:.1}", peak_mib().unwrap_or(f64::NAN));
    }
    Ok(())
}

fn peak_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? / 1024.0)
}
