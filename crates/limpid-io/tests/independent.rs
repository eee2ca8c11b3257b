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

/// Three positions appended as they are, from the given tags before them.
fn appended(tags: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = format!(
        "<?xml version=\"1.0\"?><!-- > --><VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><!----><Piece NumberOfPoints=\"3\">{tags}\
         </Piece></PolyData>\r\n<AppendedData encoding=\"raw\">\n  _"
    )
    .into_bytes();
    bytes.extend(data);
    bytes
}

#[test]
fn appended_arrays_may_lie_in_any_order_and_be_one() {
    let folder = Folder::new("appended");
    let array = |name: &str, components: usize, offset: usize| {
        let (format, kind) = ("format='appended'", "type=\"Float32\"");
        format!(
            "<DataArray {kind} Name=\"{name}\" NumberOfComponents=\"{components}\" {format} offset=\" {offset} \"></DataArray>"
        )
    };
    let block = |numbers: &[f32]| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        [&(bytes.len() as u32).to_le_bytes(), &bytes[..]].concat()
    };
    let positions: Vec<f32> = (0..9).map(|x| x as f32).collect();
    // Density first, a gap, then positions, which are the velocities too.
    let data = [block(&[5.0, 6.0, 7.0]), b"<gap>".to_vec(), block(&positions)].concat();
    let tags = |velocity: usize| {
        let points = format!("<Points>{}</Points>", array("Points", 3, 21));
        let odd = array("a &gt; &quot;b&quot; > c", 1, 0);
        format!("{points}<PointData>{}{}{odd}</PointData>", array("velocity", 3, velocity), array("density", 1, 0))
    };
    let set = folder.read("a.vtp", appended(&tags(21), &data)).unwrap();
    assert_eq!(set.positions.as_flattened(), positions);
    assert_eq!(set.attribute("velocity").unwrap().values, Values::F32(positions));
    assert_eq!(set.attribute("density").unwrap().values, Values::F32(vec![5.0, 6.0, 7.0]));
    assert_eq!(set.attribute("a > \"b\" > c").unwrap().values, Values::F32(vec![5.0, 6.0, 7.0]));

    let error = folder.read("within.vtp", appended(&tags(25), &data)).unwrap_err().to_string();
    assert!(error.contains("within another"), "{error}");
    let error = folder.read("sizes.vtp", appended(&tags(0), &data)).unwrap_err().to_string();
    assert!(error.contains("12 bytes instead of 36"), "{error}");
    let swapped =
        tags(21).replace("Name=\"density\" NumberOfComponents=\"1\"", "Name=\"density\" NumberOfComponents=\"2\"");
    let swapped = swapped.replace("offset=\" 0 \"", "offset=\" 21 \"");
    let error = folder.read("swapped.vtp", appended(&swapped, &data)).unwrap_err().to_string();
    assert!(error.contains("different sizes"), "{error}");
    let error = folder.read("beyond.vtp", appended(&tags(1 << 40), &data)).unwrap_err().to_string();
    assert!(error.contains("ends too early"), "{error}");
}

#[test]
fn arrays_of_text_have_as_many_numbers_as_points() {
    let folder = Folder::new("text");
    for (numbers, problem) in [
        ("1 2 3", ""),
        ("1 2", "claims|ends too early"),
        ("1 2 3 4", "more than 3"),
        ("1 2 x", "a number was expected"),
    ] {
        let text = format!(
            "<VTKFile type=\"PolyData\"><Piece NumberOfPoints=\"1\"><Points><DataArray type=\"Float32\">{numbers}</DataArray>\
             </Points></Piece></VTKFile>"
        );
        let outcome = folder.read("a.vtp", text).map(|set| set.positions).map_err(|error| error.to_string());
        match outcome {
            Ok(positions) => assert!(problem.is_empty() && positions == [[1.0, 2.0, 3.0]]),
            Err(error) => assert!(problem.split('|').any(|problem| error.contains(problem)), "{error}"),
        }
    }
}

#[test]
fn tags_must_be_nested() {
    let folder = Folder::new("nested");
    let deep = "<a>".repeat(100);
    for tags in ["<Piece NumberOfPoints=\"0\"></PolyData>", "<a b=1/>", "<a", "<!-- x", "</VTKFile", &deep] {
        let text = format!("<VTKFile type=\"PolyData\"><PolyData>{tags}");
        assert!(folder.read("a.vtp", text).is_err(), "{tags}");
    }
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
