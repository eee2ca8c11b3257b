//! Frames of changing sizes and counts leave nothing behind: as many resources and bytes after many as after a few.
//!
//! `LIMPID_TEST_FRAMES=10000 cargo test --release -p limpid --test embed memory -- --nocapture` is the long form.

use crate::host::{Host, HostOptions, Images};
use crate::studio::{PLAIN, positions, record, view};
use limpid::{ParticleSlices, Particles, Radius, Settings};
use limpid_headless::{AdapterInfo, Gpu, choose, device_descriptor};
use pollster::block_on;

/// Sizes, counts and whether there are ellipsoids and layers, over and over.
const CYCLE: [([u32; 2], usize, bool); 6] = [
    ([64, 48], 500, true),
    ([64, 48], 40, false),
    ([31, 77], 0, true),
    ([96, 20], 2000, false),
    ([8, 8], 1000, true),
    ([64, 48], 500, true),
];

/// Bytes on the device, and how many buffers, textures, bind groups and pipelines there are.
fn in_use(instance: &wgpu::Instance, device: &wgpu::Device) -> [u64; 6] {
    let allocator = device.generate_allocator_report().expect("the backend reports what it allocates");
    let hub = instance.generate_report().expect("there is a native instance").hub;
    let count = |registry: wgpu::wgc::registry::RegistryReport| registry.num_kept_from_user as u64;
    [
        allocator.total_allocated_bytes,
        allocator.total_reserved_bytes,
        count(hub.buffers),
        count(hub.textures),
        count(hub.bind_groups),
        count(hub.compute_pipelines),
    ]
}

#[test]
fn nothing_grows_over_many_frames() {
    let frames: usize = std::env::var("LIMPID_TEST_FRAMES").map_or(240, |text| text.parse().unwrap());
    let backends = wgpu::Backends::PRIMARY;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter = choose(block_on(instance.enumerate_adapters(backends)), None).unwrap();
    let (device, queue) = block_on(adapter.request_device(&device_descriptor(&adapter))).unwrap();
    let gpu = Gpu { info: AdapterInfo::new(&adapter.get_info()), device, queue };
    let options = HostOptions { samples: 4, ..PLAIN };
    let mut host = Host::new(&gpu.device, &gpu.queue, options);
    let water = positions();
    let mut first: Option<[u64; 6]> = None;
    for frame in 0..frames {
        let (size, count, is_fine) = CYCLE[frame % CYCLE.len()];
        let settings = if is_fine { Settings::default() } else { Settings::spheres() };
        let images = Images::new(&gpu.device, size, options);
        let second = &water[water.len() - count / 2..];
        record(&gpu, &mut host, &images, &view(size), &[&water[..count], second], &settings);
        // From memory too: new buffers for each frame.
        let slices = ParticleSlices {
            origin: glam::DVec3::ZERO,
            positions: &water[..count],
            radius: Radius::Uniform(0.025),
            density: None,
        };
        drop(Particles::upload(&gpu.device, &gpu.queue, &slices).unwrap());
        drop(images);
        if frame % CYCLE.len() == CYCLE.len() - 1 {
            gpu.queue.submit([]);
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
            let now = in_use(&instance, &gpu.device);
            // The first cycles make what lasts.
            if frame / CYCLE.len() == 2 {
                println!("after {} frames: {now:?}", frame + 1);
                first = Some(now);
            }
            if let Some(first) = first {
                assert_eq!(now[1..], first[1..], "after {} frames", frame + 1);
                // What is lost between allocations goes by where they happen to lie.
                assert!(now[0].abs_diff(first[0]) < 1 << 16, "{now:?} after {} frames, {first:?} before", frame + 1);
            }
        }
    }
    assert!(first.is_some(), "too few frames to tell");
}
