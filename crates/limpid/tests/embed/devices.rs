//! Devices that hosts have, and resolutions that they ask for.

use crate::host::{Host, HostOptions, Images};
use crate::studio::{PLAIN, SIZE, draw, positions, read_depth, read_picture, record, view, with_gpu};
use limpid::{Detail, Foam, Particles, Pipelines, Renderer, Scale, Settings};
use limpid_headless::{AdapterInfo, Gpu};

/// As a web engine has it: wgpu's default limits, no features. An error of validation is a panic there.
fn plain_device() -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let adapter = limpid_headless::choose(adapters, None).unwrap();
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).unwrap();
    assert!(device.features().is_empty(), "{:?}", device.features());
    Gpu { info: AdapterInfo::new(&adapter.get_info()), device, queue }
}

#[test]
fn a_device_of_default_limits_and_no_features_draws_the_same() {
    let water = positions();
    let plain = plain_device();
    let mut host = Host::new(&plain.device, &plain.queue, PLAIN);
    let images = Images::new(&plain.device, SIZE, PLAIN);
    record(&plain, &mut host, &images, &view(SIZE), &[&water], &Settings::default());
    let expected = with_gpu(|gpu| read_picture(gpu, &draw(gpu, PLAIN, &view(SIZE), &[&water])));
    assert!(read_picture(&plain, &images) == expected);

    // What else a frame can ask for.
    let detail = Detail { foam: Foam::Agitation, noise: 0.05, ..Detail::default() };
    let elaborate = Settings { detail, thickness_scale: Scale::Full, ..Settings::default() };
    record(&plain, &mut host, &images, &view(SIZE), &[&water], &elaborate);
    plain.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
}

#[test]
fn a_fluid_may_be_coarser_than_the_hosts_picture() {
    with_gpu(|gpu| {
        let (water, view) = (positions(), view(SIZE));
        let dry = read_depth(gpu, &draw(gpu, PLAIN, &view, &[]));
        let mut host = Host::new(&gpu.device, &gpu.queue, PLAIN);
        let images = Images::new(&gpu.device, SIZE, PLAIN);
        let mut covered = |filter_scale| {
            let settings = Settings { filter_scale, ..Settings::default() };
            record(gpu, &mut host, &images, &view, &[&water], &settings);
            let wet = read_depth(gpu, &images);
            wet.iter().zip(&dry).map(|(wet, dry)| wet != dry).collect::<Vec<bool>>()
        };
        let full = covered(Scale::Full);
        let [width, height] = SIZE.map(|n| n as usize);
        let coarse = covered(Scale::Half);
        assert_ne!(coarse, full);
        // The outline moves by less than a coarse pixel.
        let reach = Scale::Half.divisor() as usize;
        for (index, _) in coarse.iter().zip(&full).enumerate().filter(|(_, (coarse, full))| coarse != full) {
            let (x, y) = (index % width, index / width);
            let mut around = (y.saturating_sub(reach)..(y + reach + 1).min(height))
                .flat_map(|y| (x.saturating_sub(reach)..(x + reach + 1).min(width)).map(move |x| y * width + x));
            assert!(around.any(|other| full[other] != full[index]), "{x}, {y} turns inside the fluid");
        }
        // Of several samples a pixel, too.
        let options = HostOptions { samples: 4, ..PLAIN };
        let mut host = Host::new(&gpu.device, &gpu.queue, options);
        let images = Images::new(&gpu.device, SIZE, options);
        let settings = Settings { filter_scale: Scale::Half, ..Settings::default() };
        record(gpu, &mut host, &images, &view, &[&water], &settings);
        let four = read_picture(gpu, &images);
        assert!(four.iter().flatten().all(|value| value.is_finite()));
    });
}

#[test]
fn what_a_host_keeps_may_go_to_another_thread() {
    fn may_go<T: Send + Sync + 'static>() {}
    may_go::<Renderer>();
    may_go::<Particles>();
    may_go::<Pipelines>();
}
