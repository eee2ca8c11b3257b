//! A particle file to a raw RGBA picture in thirty lines: `cargo run --example offscreen FILE OUT.rgba`.

use glam::DVec3;
use limpid::{Bounds, Environment, Framing, ParticleSlices, Radius};
use limpid_headless::{Gpu, Offscreen, Shot};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [_, file, out] = std::env::args().collect::<Vec<_>>().try_into().map_err(|_| "offscreen FILE OUT.rgba")?;
    let set = limpid_io::read(file.as_ref())?;
    let radius = set.estimate_spacing().unwrap_or(0.1) * 0.5;
    let particles = ParticleSlices {
        origin: DVec3::from_array(set.origin),
        positions: &set.positions,
        radius: Radius::Uniform(radius as f32),
        density: None,
    };
    let places = set.positions.iter().map(|p| particles.origin + DVec3::from_array(p.map(f64::from)));
    let bounds = Bounds::robust(places).ok_or("no particles")?;

    let (size, aspect, fov_y) = ([1280, 720], 16.0 / 9.0, 45f64.to_radians());
    let framing = Framing::of(&bounds.grown(1.5 * radius), DVec3::Y, fov_y, aspect);
    let view = framing.view(DVec3::Y, fov_y, aspect, 0.1 * radius);
    let floor = bounds.min.y - radius;
    let environment = Environment::around(bounds.min, bounds.max, floor, DVec3::Y, framing.eye);

    let shot = Shot::new(particles, view, size, environment);
    let picture = Offscreen::new(Gpu::open(None)?)?.render(&shot, &[])?;
    std::fs::write(out, picture.rgba)?;
    Ok(())
}
