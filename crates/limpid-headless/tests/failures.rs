//! A device that fails reaches the caller as an error.

use glam::DVec3;
use limpid::{Environment, ParticleSlices, Radius, View};
use limpid_headless::{Aov, Error, Gpu, Offscreen, Shot, guarded};

const SIZE: [u32; 2] = [64, 48];

fn shot(positions: &[[f32; 3]], size: [u32; 2]) -> Shot<'_> {
    let particles = ParticleSlices { origin: DVec3::ZERO, positions, radius: Radius::Uniform(0.1), density: None };
    let view = View::perspective(DVec3::Z * 3.0, DVec3::ZERO, DVec3::Y, 0.8, 4.0 / 3.0, 0.1);
    Shot::new(particles, view, size, Environment::around(-DVec3::ONE, DVec3::ONE, -1.0, DVec3::Y, DVec3::ONE))
}

#[test]
fn a_lost_device_is_an_error() {
    let mut offscreen = Offscreen::new(Gpu::open(None).unwrap()).unwrap();
    let positions = [[0.0; 3], [0.2, 0.0, 0.0]];
    offscreen.render(&shot(&positions, SIZE), &[Aov::Depth]).unwrap();
    offscreen.gpu().device.destroy();
    for size in [SIZE, [80, 60]] {
        let error = offscreen.render(&shot(&positions, size), &[Aov::Depth]).unwrap_err();
        assert!(matches!(error, Error::Device(_)), "{error}");
        assert_eq!(error.to_string().lines().count(), 1, "{error}");
    }
    assert!(matches!(offscreen.time(&shot(&positions, SIZE), 1), Err(Error::Device(_))));
}

#[test]
fn what_the_device_refuses_is_an_error() {
    let gpu = Gpu::open(None).unwrap();
    let buffer = |size| {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        })
    };
    let too_large = guarded(&gpu.device, || Ok(buffer(1 << 60)));
    let error = too_large.unwrap_err();
    assert!(matches!(error, Error::Device(_)), "{error}");
    assert_eq!(error.to_string().lines().count(), 1, "{error}");
    // It goes on working.
    assert_eq!(guarded(&gpu.device, || Ok(buffer(64))).unwrap().size(), 64);
}
