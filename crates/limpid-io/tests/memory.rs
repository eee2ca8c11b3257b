//! Reading a large file takes little more memory than its particles do.

#![allow(unsafe_code, reason = "an allocator that counts")]

mod common;

use common::{Folder, bgeo, bgeo_attribute, pos};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Remembers how much there was at most.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

impl Counting {
    fn take(bytes: usize) {
        let held = HELD.fetch_add(bytes, Ordering::Relaxed) + bytes;
        MOST.fetch_max(held, Ordering::Relaxed);
    }
}

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const COUNT: usize = 200_000;
/// Buffers of reading.
const BUFFERS: usize = 1 << 20;

// One test: what others hold meanwhile would count too.
#[test]
fn binary_files_take_a_tenth_more_than_their_particles() {
    let points: Vec<[f32; 3]> = (0..COUNT).map(|i| [i as f32, 0.5, -1.0]).collect();
    let mut ply = format!("ply\nformat binary_little_endian 1.0\nelement vertex {COUNT}\n").into_bytes();
    for name in ["x", "y", "z", "vx", "vy", "vz", "density"] {
        ply.extend(format!("property float {name}\n").bytes());
    }
    ply.extend(b"end_header\n");
    for [x, y, z] in &points {
        [*x, *y, *z, *x, *y, *z, 1000.0].iter().for_each(|number| ply.extend(number.to_le_bytes()));
    }
    let mut vtk =
        format!("# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS {COUNT} float\n").into_bytes();
    points.iter().flatten().for_each(|x| vtk.extend(x.to_be_bytes()));
    vtk.extend(format!("\nPOINT_DATA {COUNT}\nVECTORS velocity float\n").bytes());
    points.iter().flatten().for_each(|x| vtk.extend(x.to_be_bytes()));
    let velocities: Vec<Vec<u8>> = points.iter().map(|p| p.iter().flat_map(|x| x.to_be_bytes()).collect()).collect();
    let files = [
        ("a.ply", ply, 28),
        ("a.vtk", vtk, 24),
        ("a.bgeo", bgeo(&points, &[bgeo_attribute("velocity", 3, 5, &[0; 12])], &velocities), 24),
        ("a.pos", pos(0.5, &points), 12),
    ];
    drop((points, velocities));
    let folder = Folder::new("memory");
    for (name, contents, bytes_each) in files {
        folder.write(name, contents);
        let before = HELD.load(Ordering::Relaxed);
        MOST.store(before, Ordering::Relaxed);
        let set = limpid_io::read(folder.path(name).as_ref()).unwrap();
        let most = MOST.load(Ordering::Relaxed) - before;
        assert_eq!(set.len(), COUNT, "{name}");
        let particles = bytes_each * COUNT;
        assert!(
            most >= particles && most < particles * 11 / 10 + BUFFERS,
            "{name}: {most} bytes, {particles} of particles"
        );
    }
}
