//! Reading a large file takes little more memory than its particles do.

#![allow(unsafe_code, reason = "an allocator that counts")]

mod common;

use common::{Folder, bgeo, bgeo_attribute, npy, pos};
use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{Cursor, Write};
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

/// Appended arrays of positions and velocities, as they are.
fn vtu(points: &[[f32; 3]]) -> Vec<u8> {
    let length = size_of_val(points);
    let array = |name: &str, offset: usize| {
        format!(
            "<DataArray type=\"Float32\" Name=\"{name}\" NumberOfComponents=\"3\" format=\"appended\" offset=\"{offset}\"/>"
        )
    };
    let mut bytes = format!(
        "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"UInt64\"><UnstructuredGrid>\
         <Piece NumberOfPoints=\"{}\"><PointData>{}</PointData><Points>{}</Points></Piece></UnstructuredGrid>\
         <AppendedData encoding=\"raw\">_",
        points.len(),
        array("velocity", 8 + length),
        array("Points", 0)
    )
    .into_bytes();
    for _ in 0..2 {
        bytes.extend((length as u64).to_le_bytes());
        points.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
    }
    bytes.extend(b"</AppendedData></VTKFile>");
    bytes
}

/// Positions inline, packed by zlib in blocks of 32 KiB.
fn packed_vtp(points: &[[f32; 3]]) -> Vec<u8> {
    const BLOCK: usize = 1 << 15;
    let data: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let blocks: Vec<Vec<u8>> = data
        .chunks(BLOCK)
        .map(|block| {
            let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
            encoder.write_all(block).unwrap();
            encoder.finish().unwrap()
        })
        .collect();
    let sizes = [blocks.len(), BLOCK, data.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
    let header: Vec<u8> = sizes.flat_map(|size| (size as u32).to_le_bytes()).collect();
    let mut bytes = format!(
        "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"{}\"><Points>\
         <DataArray type=\"Float32\" format=\"appended\" offset=\"0\"/></Points></Piece></PolyData>\
         <AppendedData encoding=\"raw\">_",
        points.len(),
    )
    .into_bytes();
    bytes.extend(header);
    bytes.extend(blocks.concat());
    bytes
}

fn npz(points: &[[f32; 3]]) -> Vec<u8> {
    let data: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let plain = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for name in ["positions.npy", "velocity.npy"] {
        archive.start_file(name, plain).unwrap();
        archive.write_all(&npy("<f4", false, points.len(), &data)).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// The most memory that reading a file took.
fn peak(folder: &Folder, name: &str, contents: Vec<u8>) -> usize {
    folder.write(name, contents);
    let before = HELD.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    let set = limpid_io::read(folder.path(name).as_ref()).unwrap();
    let most = MOST.load(Ordering::Relaxed) - before;
    assert_eq!(set.len(), COUNT, "{name}");
    most
}

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
        ("a.vtu", vtu(&points), 24),
        ("a.npz", npz(&points), 24),
        (
            "a.npy",
            npy("<f4", false, COUNT, &points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>()),
            12,
        ),
    ];
    let packed = packed_vtp(&points);
    drop((points, velocities));
    let folder = Folder::new("memory");
    for (name, contents, bytes_each) in files {
        let most = peak(&folder, name, contents);
        let particles = bytes_each * COUNT;
        assert!(
            most >= particles && most < particles * 11 / 10 + BUFFERS,
            "{name}: {most} bytes, {particles} of particles"
        );
    }
    // How much a packed array holds is known only when it is unpacked: it grows, and its blocks are there for a while.
    let most = peak(&folder, "a.vtp", packed);
    assert!(most < 12 * COUNT * 5 / 2 + BUFFERS, "a.vtp: {most} bytes");
}
