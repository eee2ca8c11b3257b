//! Broken files give one line, never a panic, a hang or a large allocation.

#![allow(unsafe_code, reason = "an allocator that counts")]

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{Folder, Random, bgeo, bgeo_attribute, gzip, npy, pos};
use limpid_io::{ParticleSet, ReadError, read};

/// Remembers the largest single allocation.
struct Counting;

static LARGEST: AtomicUsize = AtomicUsize::new(0);

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        LARGEST.fetch_max(layout.size(), Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LARGEST.fetch_max(size, Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The tests take turns: the largest allocation is theirs alone.
static TURN: Mutex<()> = Mutex::new(());

/// More than the read buffers, and far less than what the headers of damaged files claim.
const ALLOWED: usize = 4 << 20;

fn read_frugally(folder: &Folder, name: &str, contents: &[u8]) -> Result<ParticleSet, ReadError> {
    LARGEST.store(0, Ordering::Relaxed);
    let result = folder.read(name, contents);
    let largest = LARGEST.load(Ordering::Relaxed);
    assert!(largest <= ALLOWED, "{largest} bytes for {}", contents.escape_ascii());
    result
}

const POINTS: [[f32; 3]; 3] = [[0.5, 1.0, 2.0], [-1.5, 0.25, 1e-3], [3.0, -4.0, 10.0]];

/// A small file of each format and flavour.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let declarations = [
        bgeo_attribute("id", 1, 1, &[0; 4]),
        bgeo_attribute("kind", 1, 4, b"\0\0\0\x02\0\x03foo\0\x01b"),
        bgeo_attribute("velocity", 3, 5, &[0; 12]),
    ];
    let bgeo = bgeo(&POINTS, &declarations, &[vec![1; 20], vec![2; 20], vec![3; 20]]);

    let mut binary =
        b"# vtk DataFile Version 5.1\ntitle\nBINARY\n\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n".to_vec();
    POINTS.iter().flatten().for_each(|x| binary.extend(x.to_be_bytes()));
    binary.extend(b"\nMETADATA\nINFORMATION 0\n\nCELLS 2 3\nOFFSETS vtktypeint64\n");
    [0_i64, 3].iter().for_each(|x| binary.extend(x.to_be_bytes()));
    binary.extend(b"\nCONNECTIVITY vtktypeint64\n");
    [0_i64, 1, 2].iter().for_each(|x| binary.extend(x.to_be_bytes()));
    binary.extend(b"\nCELL_TYPES 1\n\0\0\0\x02\nPOINT_DATA 3\nFIELD FieldData 2\nid 1 3 unsigned_int\n");
    [7_u32, 8, 9].iter().for_each(|x| binary.extend(x.to_be_bytes()));
    binary.extend(b"\nname 1 3 string\n\xc1a\xc2bc\xc0\nVECTORS velocity float\n");
    POINTS.iter().flatten().for_each(|x| binary.extend(x.to_be_bytes()));
    binary.push(b'\n');

    let ascii = b"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 1 2 3 4 5\n6 7 8\n\
        VERTICES 3 6\n1 0 1 1 1 2\nCELL_DATA 3\nSCALARS c int 1\nLOOKUP_TABLE default\n1 2 3\n\
        POINT_DATA 3\nSCALARS density float\nLOOKUP_TABLE d\n1000 1001 1002\n";

    let ply_head = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment c\nelement face 1\nproperty list uchar int vertex_indices\n\
             element vertex 3\nproperty float x\nproperty list uchar short l\nproperty double y\n\
             property float z\nproperty uchar red\nend_header\n"
        )
    };
    let mut little = ply_head("binary_little_endian").into_bytes();
    little.extend([1, 2, 0, 0, 0]);
    for [x, y, z] in POINTS {
        little.extend(x.to_le_bytes());
        little.extend([1, 5, 0]);
        little.extend(f64::from(y).to_le_bytes());
        little.extend(z.to_le_bytes());
        little.push(200);
    }
    let text = ply_head("ascii") + "2 0 1\n1 1 5 2 3 200\n4 0 5 6 200\n7 2 1 1 8 9 200\n";
    let fixture = |name: &'static str| {
        (name, std::fs::read(format!("{}/tests/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap())
    };
    vec![
        fixture("ascii.vtp"),
        fixture("inline.vtu"),
        fixture("inline_zlib.vtp"),
        fixture("raw_lz4.vtu"),
        fixture("raw_lzma.vtp"),
        fixture("base64_zlib.vtu"),
        fixture("columns.npz"),
        fixture("packed.npz"),
        ("small.bgeo", bgeo.clone()),
        ("packed.bgeo", gzip(&bgeo)),
        ("binary.vtk", binary),
        ("ascii.vtk", ascii.to_vec()),
        ("little.ply", little),
        ("ascii.ply", text.into_bytes()),
        ("small.pos", pos(0.1, &POINTS)),
        (
            "small.npy",
            npy("<f4", false, 3, &POINTS.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>()),
        ),
        ("small.csv", b"x,y,z,id\n1,2,3,4\n5,6,7,8\n-1,-2,-3e-1,2".to_vec()),
        ("small.xyz", b"3\nProperties=species:S:1:pos:R:3:v:R:3\nO 1 2 3 1 2 3\nO 2 2 3 1 2 3\nO 3 2 3 1 2 3".to_vec()),
        ("array.json", b"[[1, 2.5e0, 3], [4, 5, 6], [-7, 8, 9]]".to_vec()),
        ("object.json", br#"{"positions": [[1, 2, 3], [4, 5, 6], [7, 8, 9]], "id": [1, 2, 3]}"#.to_vec()),
    ]
}

#[test]
fn the_samples_are_whole() {
    let _turn = TURN.lock();
    let folder = Folder::new("samples");
    for (name, bytes) in samples() {
        let set = folder.read(name, &bytes).unwrap();
        assert_eq!(set.len(), 3, "{name}");
        assert!(set.attributes.iter().all(|a| a.values.len() == 3 * a.components), "{name}");
    }
}

#[test]
fn truncated_anywhere() {
    let _turn = TURN.lock();
    let folder = Folder::new("truncated");
    for (name, bytes) in samples() {
        // Where the positions of a text or sectioned file end, the rest is not missed.
        let may_end_early =
            [".vtk", ".vtu", ".vtp", ".csv", ".xyz"].iter().any(|end| name.ends_with(end)) || name == "ascii.ply";
        for length in 0..bytes.len() {
            let result = read_frugally(&folder, name, &bytes[..length]);
            assert!(may_end_early || result.is_err(), "{name} cut at {length}");
        }
    }
}

#[test]
fn one_byte_changed() {
    let _turn = TURN.lock();
    let folder = Folder::new("mutated");
    let mut random = Random(1);
    for (name, bytes) in samples() {
        for _ in 0..2000 {
            let mut changed = bytes.clone();
            let at = (random.next() % bytes.len() as u64) as usize;
            changed[at] = random.next() as u8;
            if let Ok(set) = read_frugally(&folder, name, &changed) {
                assert!(set.positions.iter().flatten().all(|x| x.is_finite()));
                assert!(set.attributes.iter().all(|a| a.values.len() == set.len() * a.components), "{name}");
                set.estimate_spacing();
            }
        }
    }
}

/// A piece of a file taken out, doubled, or put there from another, bytes changed to telling ones, numbers made large.
fn mutate(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    const TELLING: [&[u8]; 12] = [
        b"\0",
        b"\xff",
        b"\x7f\xff\xff\xff",
        b"\xff\xff\xff\x7f",
        b"\x80\0\0\0",
        b"\0\0\0\x80",
        b"-1",
        b"1e999",
        b"nan",
        b"4294967296",
        b"18446744073709551615",
        b"\n",
    ];
    let mut below = |end: usize| (random.next() % end.max(1) as u64) as usize;
    let at = below(bytes.len());
    let end = (at + 1 + below(16)).min(bytes.len());
    match below(6) {
        0 => bytes[at] ^= 1 << below(8),
        1 => {
            let telling = TELLING[below(TELLING.len())];
            let end = (at + telling.len()).min(bytes.len());
            bytes.splice(at..end, telling.iter().copied());
        }
        2 => {
            bytes.drain(at..end);
        }
        3 => {
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        4 => {
            let from = below(other.len());
            let piece = &other[from..(from + 1 + below(64)).min(other.len())];
            bytes.splice(at..end, piece.iter().copied());
        }
        _ => {
            // A number of the text becomes another.
            let digits = bytes[at..].iter().position(u8::is_ascii_digit).map(|digit| at + digit);
            if let Some(digit) = digits {
                bytes[digit] = b'0' + below(10) as u8;
            }
        }
    }
}

/// The same that cargo-fuzz checks, on any compiler and always in the same order. `FUZZ_ROUNDS` makes it long.
#[test]
fn changed_in_many_ways() {
    let _turn = TURN.lock();
    let rounds = std::env::var("FUZZ_ROUNDS").map_or(1000, |rounds| rounds.parse().unwrap());
    let samples = samples();
    for round in 0..rounds {
        for (index, (name, bytes)) in samples.iter().enumerate() {
            let mut random = Random(1 + round * samples.len() as u64 + index as u64);
            let mut changed = bytes.clone();
            let (_, other) = &samples[(random.next() % samples.len() as u64) as usize];
            for _ in 0..=random.next() % 4 {
                mutate(&mut changed, other, &mut random);
                if changed.is_empty() {
                    break;
                }
            }
            LARGEST.store(0, Ordering::Relaxed);
            let outcome = std::panic::catch_unwind(|| common::sound::check(name, &changed));
            assert!(outcome.is_ok(), "round {round} of {name}: {}", changed.escape_ascii());
            let largest = LARGEST.load(Ordering::Relaxed);
            assert!(largest <= ALLOWED, "round {round}, {largest} bytes for {}", changed.escape_ascii());
        }
    }
}

/// The corpora of cargo-fuzz: small files that between them reach all of a reader's code that fuzzing has reached.
#[test]
fn what_fuzzing_keeps_is_read_soundly() {
    let _turn = TURN.lock();
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus");
    let entries = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    let formats = entries(&corpora);
    assert_eq!(formats.len(), limpid_io::Format::ALL.len());
    for format in formats {
        let name = format!("any.{}", format.file_name().unwrap().to_str().unwrap());
        for file in entries(&format) {
            let bytes = std::fs::read(&file).unwrap();
            LARGEST.store(0, Ordering::Relaxed);
            let outcome = std::panic::catch_unwind(|| common::sound::check(&name, &bytes));
            let largest = LARGEST.load(Ordering::Relaxed);
            assert!(outcome.is_ok() && largest <= ALLOWED, "{}: {largest} bytes at once", file.display());
        }
    }
}

#[test]
fn columns_of_other_lengths_are_no_components() {
    let _turn = TURN.lock();
    let folder = Folder::new("columns");
    let xyz = r#""x": [1, 2], "y": [1, 2], "z": [1, 2]"#;
    let set = folder.read("short.json", format!(r#"{{{xyz}, "u": [1], "v": [1, 2], "w": [1, 2]}}"#)).unwrap();
    assert!(set.len() == 2 && set.attribute("velocity").is_none());
    let error = folder.read("z.json", r#"{"x": [1, 2], "y": [1, 2], "z": [1]}"#).unwrap_err();
    assert!(error.to_string().contains("of one length"), "{error}");
}

#[test]
fn counts_that_lie() {
    let _turn = TURN.lock();
    let folder = Folder::new("lies");
    let vtk = |rest: &str| format!("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\n{rest}").into_bytes();
    let ascii = |rest: &str| format!("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n{rest}").into_bytes();
    let ply = |format: &str, rest: &str| format!("ply\nformat {format} 1.0\n{rest}end_header\n").into_bytes();
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let mut bgeo_lie = bgeo(&POINTS, &[], &[]);
    bgeo_lie[9..13].copy_from_slice(&i32::MAX.to_be_bytes());
    let mut bgeo_negative = bgeo(&POINTS, &[], &[]);
    bgeo_negative[9..13].copy_from_slice(&(-1_i32).to_be_bytes());
    let mut pos_lie = pos(0.1, &POINTS);
    pos_lie[..4].copy_from_slice(&u32::MAX.to_le_bytes());
    let wide = bgeo(&POINTS, &[bgeo_attribute("wide", 0xffff, 0, &vec![0; 4 * 0xffff])], &[]);
    let files = [
        ("count.vtk", vtk("POINTS 4294967296 float\n\0\0\0\0")),
        ("count64.vtk", vtk("POINTS 18446744073709551615 double\n\0\0\0\0")),
        ("negative.vtk", vtk("POINTS -1 float\n")),
        ("ascii.vtk", ascii("POINTS 4000000000 float\n1 2 3")),
        ("ascii64.vtk", ascii("POINTS 9223372036854775807 float\n1 2 3")),
        ("field.vtk", ascii("FIELD f 18446744073709551615\na 9999999999 9999999999 float\n1")),
        ("cells.vtk", vtk("POINTS 0 float\nVERTICES 1 4611686018427387904\n")),
        ("little.ply", ply("binary_little_endian", &format!("element vertex 4000000000\n{xyz}"))),
        ("text.ply", ply("ascii", &format!("element vertex 18446744073709551615\n{xyz}"))),
        ("before.ply", ply("ascii", &format!("element e 4000000000\nelement vertex 4000000000\n{xyz}"))),
        ("lists.ply", ply("binary_big_endian", "element e 4000000000\nproperty list uint64 int l\n")),
        ("points.bgeo", bgeo_lie.clone()),
        ("packed.bgeo", gzip(&bgeo_lie)),
        ("negative.bgeo", bgeo_negative),
        ("wide.bgeo", wide),
        (
            "points.vtu",
            b"<VTKFile type=\"UnstructuredGrid\"><Piece NumberOfPoints=\"4000000000\"><Points><DataArray type=\"Float64\"> 1 2 \
              3</DataArray></Points></Piece></VTKFile>"
                .to_vec(),
        ),
        (
            "blocks.vtp",
            b"<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"><Piece NumberOfPoints=\"4000000000\"><Points>\
              <DataArray type=\"Float64\" format=\"binary\">AQAAAP////8AAAAABAAAAAAAAAA=</DataArray></Points></Piece></VTKFile>"
                .to_vec(),
        ),
        ("count.pos", pos_lie.clone()),
        ("count.pos.gz", gzip(&pos_lie)),
    ];
    for (name, bytes) in files {
        assert!(matches!(read_frugally(&folder, name, &bytes), Err(ReadError::Broken { .. })), "{name}");
    }
}

#[test]
fn a_gzip_bomb_stops_at_the_count_of_its_header() {
    let _turn = TURN.lock();
    let folder = Folder::new("bomb");
    let mut bytes = bgeo(&POINTS, &[], &[]);
    bytes.resize(64 << 20, 0);
    let bomb = gzip(&bytes);
    assert!(matches!(read_frugally(&folder, "bomb.bgeo", &bomb), Err(ReadError::Broken { .. })));
    let zeros = gzip(&vec![0; 64 << 20]);
    assert!(read_frugally(&folder, "zeros.vtk", &zeros).is_err());
    let mut line = b"# vtk DataFile Version 3.0".to_vec();
    line.resize(64 << 20, b' ');
    assert!(read_frugally(&folder, "line.vtk", &gzip(&line)).is_err());
}

#[test]
fn what_is_no_particles_in_an_archive_is_not_unpacked() {
    let _turn = TURN.lock();
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let zeros = vec![0; 64 << 20];
    let positions: Vec<u8> = POINTS.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    for (name, array) in
        [("before", npy("<f4", false, zeros.len() / 12, &zeros)), ("positions", npy("<f4", false, 3, &positions))]
    {
        archive.start_file(format!("{name}.npy"), zip::write::SimpleFileOptions::default()).unwrap();
        std::io::Write::write_all(&mut archive, &array).unwrap();
    }
    let bomb = archive.finish().unwrap().into_inner();
    let set = read_frugally(&Folder::new("archive"), "bomb.npz", &bomb).unwrap();
    assert_eq!((set.len(), set.attributes.len()), (3, 0));
}

#[test]
fn other_files_are_told_apart() {
    let _turn = TURN.lock();
    let folder = Folder::new("others");
    let error = |name: &str, contents: &[u8]| folder.read(name, contents).unwrap_err();
    assert!(matches!(error("empty.vtk", b""), ReadError::Empty { .. }));
    assert!(matches!(error("empty.bgeo", &gzip(b"")), ReadError::Broken { .. }));
    assert!(matches!(error("text.vtk", b"hello\nworld\n"), ReadError::Broken { .. }));
    assert!(matches!(error("text.pos", b"hello\nworld\n"), ReadError::Broken { .. }));
    assert!(matches!(error("text.log", b"hello\nworld\n"), ReadError::Unrecognised { .. }));
    assert!(matches!(error("text.dat", b"hello\nworld\n"), ReadError::Broken { .. }));
    assert!(matches!(error("binary.dat", b"\0\0\x80\x3f\x01\x02"), ReadError::Unrecognised { .. }));
    assert!(matches!(error("houdini.bgeo", b"\x7fNSJb...."), ReadError::Unsupported { .. }));
    assert!(matches!(error("houdini.bgeo", &gzip(b"\x7fNSJb....")), ReadError::Unsupported { .. }));
    assert!(matches!(error("hdf.h5", b"\x89HDF\r\n\x1a\n...."), ReadError::Unsupported { .. }));
    assert!(matches!(error("alembic.abc", b"Ogawa\xff"), ReadError::Unsupported { .. }));
    assert!(matches!(error("partio.bin", b"\x01\x02\x03"), ReadError::Unsupported { .. }));
    for (name, contents, remedy) in [
        ("a.usda", &b"#usda 1.0\n"[..], "export the points as .ply"),
        ("a.usdc", b"PXR-USDC\0", "export the points as .ply"),
        ("a.lammpstrj", b"ITEM: TIMESTEP\n0\n", "dump ... xyz"),
        ("a.pcd", b"# .PCD v0.7\n", "pcl_pcd2ply"),
        ("positions", b"FoamFile\n{\n", "foamToVTK"),
        ("Part_0001.bi4", b"\x01\x02", "PartVTK"),
        ("ball.obj", b"v 1 2 3\n", "limpid sample"),
        ("ball.stl", b"solid ball\n", "limpid sample"),
        ("excel.csv", b"\xff\xfex\0,\0", "save it as UTF-8"),
        (
            "a.pvtu",
            b"<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\">",
            "the .vtu and .vtp files that it lists",
        ),
    ] {
        let error = error(name, contents);
        assert!(matches!(error, ReadError::Unsupported { .. }) && error.to_string().contains(remedy), "{error}");
    }
    // The same first bytes, but of a number of particles.
    let many = pos(0.5, &[[1.0; 3]; 0xfeff]);
    assert_eq!(folder.read("many.pos", &many).unwrap().len(), 0xfeff);
    let grid = b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\n";
    assert!(matches!(error("grid.vtk", grid), ReadError::Unsupported { .. }));
    assert!(matches!(read("no/such/file.vtk".as_ref()), Err(ReadError::Io { .. })));
    assert!(matches!(read(folder.path("").as_ref()), Err(ReadError::Io { .. })));
}

#[test]
fn contents_decide_before_the_name() {
    let _turn = TURN.lock();
    let folder = Folder::new("names");
    for (name, bytes) in samples() {
        let has_mark = [".vtk", ".bgeo", ".ply", ".pos", ".npy"].iter().any(|end| name.ends_with(end));
        let wrong = if has_mark { format!("{name}.csv") } else { name.into() };
        assert_eq!(folder.read(&wrong, &bytes).unwrap().len(), 3, "{wrong}");
    }
}

#[test]
fn positions_that_are_no_numbers() {
    let _turn = TURN.lock();
    let folder = Folder::new("nan");
    let points = [[0.0; 3], [0.0, f32::NAN, 0.0], [1.0; 3], [f32::INFINITY, 0.0, 0.0]];
    let error = folder.read("nan.pos", pos(0.1, &points)).unwrap_err();
    assert!(matches!(error, ReadError::NotFinite { count: 2, first: 1, .. }), "{error}");
    let huge = "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n\
        end_header\n0 0 0\n1e300 0 0\n";
    let error = folder.read("huge.ply", huge).unwrap_err();
    assert!(matches!(error, ReadError::NotFinite { count: 1, first: 1, .. }), "{error}");
}

#[test]
fn no_particles_is_a_warning() {
    let _turn = TURN.lock();
    let folder = Folder::new("none");
    let vtk = "# vtk DataFile Version 4.2\n\nASCII\nDATASET POLYDATA\nPOINTS 0 float\nPOINT_DATA 0\nCELL_DATA 0\n";
    let ply =
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header";
    let files = [
        ("none.pos", pos(0.1, &[])),
        ("none.bgeo", bgeo(&[], &[], &[])),
        ("none.vtk", vtk.into()),
        ("none.ply", ply.into()),
    ];
    for (name, bytes) in files {
        let set = folder.read(name, bytes).unwrap();
        assert!(set.is_empty() && set.bounds().is_none(), "{name}");
        assert_eq!(set.warnings, ["no particles"], "{name}");
    }
}
