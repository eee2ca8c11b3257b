//! Files that several cores share, each reading parts, hold what they hold in every encoding.

mod common;

use std::fmt::Write as _;
use std::io::Write as _;

use common::{Folder, bgeo, bgeo_attribute, gzip, npy, pos};
use limpid_io::{ParticleSet, ReadError, Values};

/// Several parts' worth, and no multiple of anything.
const COUNT: usize = 250_007;

fn point(index: usize) -> [f32; 3] {
    let x = index as f32;
    [x, -0.5 * x, 1.0 / (1.0 + x)]
}

fn points() -> Vec<[f32; 3]> {
    (0..COUNT).map(point).collect()
}

fn little(points: &[[f32; 3]]) -> Vec<u8> {
    points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect()
}

fn assert_whole(name: &str, set: &ParticleSet) {
    assert_eq!(set.len(), COUNT, "{name}");
    let wrong = (0..COUNT).find(|index| set.positions[*index] != point(*index));
    assert_eq!(wrong, None, "{name}: the first wrong position");
}

fn assert_is_id(name: &str, set: &ParticleSet) {
    let Values::I64(ids) = &set.attribute("id").unwrap().values else { panic!("{name}: ids") };
    assert!(ids.iter().copied().eq((0..COUNT as i64).map(|id| id % 30_000)), "{name}: ids");
}

#[test]
fn records() {
    let folder = Folder::new("large-records");
    for (format, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let mut ply = format!(
            "ply\nformat {format} 1.0\nelement vertex {COUNT}\nproperty short id\nproperty float x\nproperty float y\n\
             property float z\nproperty uchar flag\nend_header\n"
        )
        .into_bytes();
        for (index, point) in points().iter().enumerate() {
            let id = (index % 30_000) as i16;
            ply.extend(if big { id.to_be_bytes() } else { id.to_le_bytes() });
            point.iter().for_each(|x| ply.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() }));
            ply.push(index as u8);
        }
        for (name, contents) in [("a.ply", ply.clone()), ("a.ply.gz", gzip(&ply))] {
            let set = folder.read(name, contents).unwrap();
            assert_whole(name, &set);
            assert_is_id(name, &set);
            let Values::U8(flags) = &set.attribute("flag").unwrap().values else { panic!("{name}: flags") };
            assert!(flags.iter().copied().eq((0..COUNT).map(|index| index as u8)), "{name}: flags");
        }
        ply.pop();
        assert!(folder.read("short.ply", ply).unwrap_err().to_string().contains("where only"));
    }
    let rows: Vec<Vec<u8>> = (0..COUNT).map(|index| ((index % 30_000) as i32).to_be_bytes().to_vec()).collect();
    let set = folder.read("a.bgeo", bgeo(&points(), &[bgeo_attribute("id", 1, 1, &[0; 4])], &rows)).unwrap();
    assert_whole("bgeo", &set);
    assert_is_id("bgeo", &set);
}

#[test]
fn arrays() {
    let folder = Folder::new("large-arrays");
    let points = points();
    assert_whole("pos", &folder.read("a.pos", pos(0.5, &points)).unwrap());
    assert_whole("npy", &folder.read("a.npy", npy("<f4", false, COUNT, &little(&points))).unwrap());

    let mut bad = points.clone();
    bad[COUNT - 5][1] = f32::NAN;
    let error = folder.read("nan.pos", pos(0.5, &bad)).unwrap_err();
    assert!(matches!(error, ReadError::NotFinite { count: 1, first, .. } if first == COUNT - 5), "{error}");

    // Cells that are passed over lie between the arrays.
    let head = "# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\n";
    let mut vtk = format!("{head}POINTS {COUNT} float\n").into_bytes();
    points.iter().flatten().for_each(|x| vtk.extend(x.to_be_bytes()));
    vtk.extend(format!("\nVERTICES {COUNT} {}\n", 2 * COUNT).bytes());
    vtk.extend([7; 8].repeat(COUNT));
    vtk.extend(format!("\nPOINT_DATA {COUNT}\nSCALARS id unsigned_short\nLOOKUP_TABLE default\n").bytes());
    (0..COUNT).for_each(|index| vtk.extend(((index % 30_000) as u16).to_be_bytes()));
    for (name, contents) in [("a.vtk", vtk.clone()), ("a.vtk.gz", gzip(&vtk))] {
        let set = folder.read(name, contents).unwrap();
        assert_whole(name, &set);
        assert_is_id(name, &set);
    }
    vtk.pop();
    assert!(folder.read("short.vtk", vtk).unwrap_err().to_string().contains("broken vtk file"));
    // The cells that it claims are not all there.
    let cut = format!("{head}POINTS 0 float\nVERTICES {COUNT} {}\n", 2 * COUNT).into_bytes();
    let error = folder.read("cut.vtk", [cut, vec![7; 300_000]].concat()).unwrap_err().to_string();
    assert!(error.contains("broken vtk file"), "{error}");

    let folder = Folder::new("large-bare");
    for (name, contents) in [("a.raw", little(&points)), ("a.raw.gz", gzip(&little(&points)))] {
        let path = folder.write(name, contents);
        assert_whole(name, &limpid_io::read_bare(&path, limpid_io::Bare::F32).unwrap());
    }
    let path = folder.write("cut.raw.gz", gzip(&little(&points)[..100]));
    let error = limpid_io::read_bare(&path, limpid_io::Bare::F32).unwrap_err().to_string();
    assert!(error.contains("it ends within a particle"), "{error}");
}

/// A VTU of positions: the header of the array and what follows it, as bytes, inline as base64 or appended.
fn vtu(compressor: &str, header: &[u8], data: &[u8], break_lines: bool) -> (Vec<u8>, Vec<u8>) {
    let tags = |format: &str, inside: &str, after: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"{compressor}><UnstructuredGrid>\
             <Piece NumberOfPoints=\"{COUNT}\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" {format}>{inside}\
             </DataArray></Points></Piece></UnstructuredGrid>{after}"
        )
        .into_bytes()
    };
    let appended = [
        tags("format=\"appended\" offset=\"0\"", "", "<AppendedData encoding=\"raw\">_"),
        header.to_vec(),
        data.to_vec(),
        b"</AppendedData></VTKFile>".to_vec(),
    ];
    let text = base64(data);
    let text = if break_lines {
        text.as_bytes().chunks(76).map(|line| str::from_utf8(line).unwrap()).collect::<Vec<_>>().join("\n")
    } else {
        text
    };
    let inline = tags("format=\"binary\"", &format!("\n  {}{text}\n", base64(header)), "</VTKFile>");
    (inline, appended.concat())
}

fn base64(bytes: &[u8]) -> String {
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits = three.iter().chain(&[0, 0]).take(3).fold(0u32, |bits, byte| bits << 8 | u32::from(*byte));
        for place in 0..4 {
            let character = alphabet[(bits >> (18 - 6 * place) & 63) as usize];
            text.push(if place > three.len() { '=' } else { char::from(character) });
        }
    }
    text
}

#[test]
fn blocks() {
    const BLOCK: usize = 40_000;
    let folder = Folder::new("large-blocks");
    let data = little(&points());
    let zlib = |block: &[u8]| {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(block).unwrap();
        encoder.finish().unwrap()
    };
    type Pack<'a> = &'a dyn Fn(&[u8]) -> Vec<u8>;
    let packers: [(&str, Pack); 2] =
        [("vtkZLibDataCompressor", &zlib), ("vtkLZ4DataCompressor", &|block| lz4_flex::block::compress(block))];
    for (compressor, pack) in packers {
        let blocks: Vec<Vec<u8>> = data.chunks(BLOCK).map(pack).collect();
        let sizes = [blocks.len(), BLOCK, data.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
        let header: Vec<u8> = sizes.flat_map(|size| (size as u32).to_le_bytes()).collect();
        let attribute = format!(" compressor=\"{compressor}\"");
        for break_lines in [false, true] {
            let (inline, appended) = vtu(&attribute, &header, &blocks.concat(), break_lines);
            for (name, contents) in [("inline.vtu", inline), ("appended.vtu", appended)] {
                assert_whole(&format!("{compressor} {name}"), &folder.read(name, &contents).unwrap());
                // One byte is another in the middle of the packed numbers.
                let mut broken = contents;
                let middle = broken.len() / 2;
                broken[middle] = if broken[middle] == b'!' { b'?' } else { b'!' };
                if let Err(error) = folder.read(name, broken) {
                    assert!(error.to_string().contains("broken vtu file"), "{error}");
                }
            }
        }
    }
    let header = (data.len() as u32).to_le_bytes();
    for break_lines in [false, true] {
        let (inline, appended) = vtu("", &header, &data, break_lines);
        assert_whole("inline", &folder.read("plain.vtu", &inline).unwrap());
        assert_whole("inline, gzipped", &folder.read("plain.vtu.gz", gzip(&inline)).unwrap());
        assert_whole("appended", &folder.read("appended.vtu", appended).unwrap());
    }
}

#[test]
fn text() {
    let folder = Folder::new("large-text");
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {COUNT}\n");
    text += "property float x\nproperty float y\nproperty float z\nend_header\n";
    points().iter().for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").unwrap());
    assert_whole("ascii ply", &folder.read("a.ply", &text).unwrap());
}

#[test]
fn gzip_of_several_members() {
    let folder = Folder::new("members");
    let file = pos(0.5, &points());
    let (first, second) = file.split_at(1_000_001);
    assert_whole("members", &folder.read("a.pos.gz", [gzip(first), gzip(second)].concat()).unwrap());
}

/// What another program writes while it is read.
#[cfg(target_os = "linux")]
#[test]
fn pipes() {
    use std::os::fd::AsRawFd;
    for contents in [pos(0.5, &points()), gzip(&pos(0.5, &points()))] {
        let (reader, mut writer) = std::io::pipe().unwrap();
        let writing = std::thread::spawn(move || writer.write_all(&contents));
        // Its name alone tells what it is, since its size does not.
        let folder = Folder::new("pipes");
        std::os::unix::fs::symlink(format!("/proc/self/fd/{}", reader.as_raw_fd()), folder.path("a.pos")).unwrap();
        let set = limpid_io::read(folder.path("a.pos").as_ref());
        drop(reader);
        assert_whole("pipe", &set.unwrap());
        writing.join().unwrap().unwrap();
    }
}
