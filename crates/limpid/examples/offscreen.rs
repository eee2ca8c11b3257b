//! A particle file to a raw RGBA picture in thirty lines: `cargo run --example offscreen FILE OUT.rgba`.

use glam::DVec3;
use limpid::{Bounds, Environment, Framing, Motion, Paint, ParticleSlices, Radius, Settings};
use limpid_headless::{Aov, Background, Gpu, Offscreen, Shot};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().collect();
    let set = limpid_io::read(args[1].as_ref())?;
    let radius = set.estimate_spacing().unwrap_or(0.1) * 0.5;
    let origin = DVec3::from_array(set.origin);
    let points = || set.positions.iter().map(|p| origin + DVec3::from_array(p.map(f64::from)));
    let bounds = Bounds::robust(points()).unwrap();
    let size = [1280, 720];
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let fov = 45f64.to_radians();
    let framing = Framing::of(&bounds.grown(1.5 * radius), DVec3::Y, fov, aspect);
    let shot = Shot {
        particles: ParticleSlices {
            origin,
            positions: &set.positions,
            radius: Radius::Uniform(radius as f32),
            density: None,
        },
        motion: Motion::default(),
        paint: Paint::default(),
        droplets: &[],
        view: framing.view(DVec3::Y, fov, aspect, radius * 0.1),
        size,
        settings: Settings::default(),
        environment: Environment::around(bounds.min, bounds.max, bounds.min.y - radius, DVec3::Y, framing.eye),
        background: Background::Scene,
        bodies: &[],
        exposure: 1.0,
        samples: 1,
    };
    let mut offscreen = Offscreen::new(Gpu::open(None)?)?;
    let picture = offscreen.render(&shot, &[Aov::Depth])?;
    println!("{:?}", offscreen.time(&shot, 11)?);
    std::fs::write(&args[2], picture.rgba)?;
    Ok(())
}
