//! Files that VTK and NumPy wrote themselves.

mod common;

use common::Folder;
use limpid_io::{ParticleSet, Values, expand, read};
use std::path::{Path, PathBuf};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name)
}

fn assert_whole(set: &ParticleSet, name: &str) {
    let positions = [[0.5, 1.0, 2.0], [-1.5, 0.25, 1e-3], [3.0, -4.0, 10.0]];
    assert_eq!(set.positions, positions, "{name}");
    assert_eq!(set.origin, [0.0; 3], "{name}");
    let values = |wanted: &str| {
        let found = set.attributes.iter().find(|attribute| attribute.name == wanted);
        &found.unwrap_or_else(|| panic!("{name}: no {wanted}")).values
    };
    assert_eq!(values("velocity"), &Values::F32((1..10).map(|x| x as f32).collect()), "{name}");
    assert_eq!(values("density"), &Values::F32(vec![1000.5, 999.25, 1001.0]), "{name}");
    assert_eq!(values("id"), &Values::I64(vec![30, 10, 20]), "{name}");
}

#[test]
fn every_encoding_holds_the_same_particles() {
    let vtk =
        ["ascii.vtp", "inline.vtu", "inline_zlib.vtp", "raw.vtu", "raw_lz4.vtu", "raw_lzma.vtp", "base64_zlib.vtu"];
    for name in vtk.into_iter().chain(["columns.npz", "packed.npz"]) {
        let set = read(&fixture(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_whole(&set, name);
        assert!(name.ends_with(set.format.name()), "{name}");
    }
}

#[test]
fn a_text_beside_the_numbers_is_left_out_and_said() {
    let set = read(&fixture("columns.npz")).unwrap();
    assert_eq!(set.warnings, ["array \"note\" holds no numbers: left out"]);
}

#[test]
fn pieces_follow_each_other_and_keep_what_all_have() {
    let piece = |points: &str, extra: &str| {
        format!(
            "<Piece NumberOfPoints=\"1\"><PointData>{extra}<DataArray type=\"Int32\" Name=\"id\"> 7 </DataArray></PointData>\
             <Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">{points}</DataArray></Points></Piece>"
        )
    };
    let alone = "<DataArray type=\"Float32\" Name=\"alone\">1</DataArray>";
    let text = format!(
        "<?xml version=\"1.0\"?>\r\n<VTKFile type=\"PolyData\"><PolyData>{}{}<Piece NumberOfPoints=\"0\"/></PolyData></VTKFile>",
        piece("1 2 3", alone),
        piece("4 5 6", "")
    );
    let set = Folder::new("pieces").read("a.vtp", text);
    // A piece without points has no attributes either, and says nothing about those of others.
    let set = set.unwrap();
    assert_eq!(set.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(set.attributes.iter().map(|a| a.name.as_str()).collect::<Vec<_>>(), ["id"]);
}

#[test]
fn other_xml_is_told_apart() {
    let folder = Folder::new("xml");
    let text = "<?xml version=\"1.0\"?><VTKFile type=\"ImageData\"/>";
    assert!(folder.read("a.vti", text).unwrap_err().to_string().contains("ImageData"));
    assert!(folder.read("a.xml", "<?xml version=\"1.0\"?><html/>").unwrap_err().to_string().contains("html"));
}

#[test]
fn a_pvd_lists_its_frames_by_time() {
    let folder = Folder::new("pvd");
    let frame = std::fs::read(fixture("ascii.vtp")).unwrap();
    for name in ["f_9.vtp", "f_10.vtp", "other.vtp"] {
        folder.write(name, &frame);
    }
    folder.write(
        "a.pvd",
        "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection>\
         <DataSet timestep=\"0.5\" group=\"\" part=\"0\" file=\"f_10.vtp\"/>\
         <DataSet timestep=\"0.25\" part=\"0\" file=\"f_9.vtp\"/>\
         <DataSet timestep=\"0.5\" part=\"1\" file=\"other.vtp\"/></Collection></VTKFile>",
    );
    let sequence = expand(&[folder.path("a.pvd")]).unwrap();
    let names: Vec<_> = sequence.frames.iter().map(|frame| frame.path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["f_9.vtp", "f_10.vtp"]);
    assert_eq!(sequence.warnings.len(), 1, "{:?}", sequence.warnings);
    folder.write("b.pvd", "<VTKFile type=\"Collection\"><Collection/></VTKFile>");
    assert!(expand(&[folder.path("b.pvd")]).unwrap_err().to_string().contains("lists none"));
}
