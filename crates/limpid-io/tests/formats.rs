//! Legal but odd files.

mod common;

use common::{Folder, bgeo, bgeo_attribute, gzip, npy, pos};
use limpid_io::{Attribute, ParticleSet, ReadError, Values};

fn attribute<'a>(set: &'a ParticleSet, name: &str) -> &'a Attribute {
    let names: Vec<_> = set.attributes.iter().map(|a| &a.name).collect();
    set.attribute(name).unwrap_or_else(|| panic!("{name} is not among {names:?}"))
}

fn vtk(rest: &str) -> String {
    format!("# vtk DataFile Version 3.0\n\nASCII\n{rest}")
}

fn ply(header: &str, rows: &str) -> String {
    format!("ply\nformat ascii 1.0\n{header}end_header\n{rows}")
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

#[test]
fn vtk_sections_in_any_order() {
    let folder = Folder::new("vtk-sections");
    let text = vtk("DATASET UNSTRUCTURED_GRID\n\
        FIELD FieldData 2\nTIME 1 1 double\n0.25\nnote 1 1 string\nsome%20text with spaces\n\
        POINTS 2 float\n0 1 2\n3 4 5\nMETADATA\nINFORMATION 0\n\n\
        CELLS 2 4\n1 0 1 1\nCELL_TYPES 2\n1 1\n\
        CELL_DATA 2\nVECTORS velocity float\n9 9 9 9 9 9\nFIELD f 0\n\
        POINT_DATA 2\nNORMALS n float\n1 0 0 0 1 0\nTENSORS stress double\n1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9\n\
        COLOR_SCALARS Cd 3\n0 0.5 1 1 0.5 0\nSCALARS Rhop double\nLOOKUP_TABLE missing\n1000 1001\n\
        LOOKUP_TABLE unused 1\n0 0 0 1\nTEXTURE_COORDINATES uv 2 float\n1 2 3 4\n\
        FIELD FieldData 3\nIdp 1 2 vtkIdType\n-7 2147483647\nMETADATA\nCOMPONENT_NAMES\nX%20Y\n\n\
        Vel 3 2 double\n1 2 3 4 5 6\nshort 1 1 int\n5\nGLOBAL_IDS g long\n9007199254740993 2\n");
    for text in [text.clone(), text.replace('\n', "\r\n")] {
        let set = folder.read("sections.vtk", text).unwrap();
        assert_eq!(set.positions, [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]);
        assert_eq!(attribute(&set, "velocity").values, Values::F32(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(attribute(&set, "density").values, Values::F32(vec![1000.0, 1001.0]));
        assert_eq!(attribute(&set, "id").values, Values::I64(vec![-7, 2_147_483_647]));
        assert_eq!(attribute(&set, "color").values, Values::F32(vec![0.0, 0.5, 1.0, 1.0, 0.5, 0.0]));
        assert_eq!(attribute(&set, "g").values, Values::I64(vec![9_007_199_254_740_993, 2]));
        assert_eq!(attribute(&set, "stress").components, 9);
        assert_eq!(attribute(&set, "uv").components, 2);
        assert!(set.attribute("short").is_none() && set.warnings.len() == 1, "{:?}", set.warnings);
    }
}

#[test]
fn vtk_binary_blocks_may_hold_line_ends_and_keywords() {
    let folder = Folder::new("vtk-binary");
    let mut bytes =
        b"# vtk DataFile Version 5.1\nvtk output\nBINARY\n\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 double\n".to_vec();
    let mut word = *b"\nPOINTS\n";
    word[0] = 0x3f;
    let x = f64::from_be_bytes(word);
    bytes.extend(word.repeat(3));
    bytes.extend(b"\nCELLS 0 0\nOFFSETS vtktypeint64\n\nCONNECTIVITY vtktypeint64\n\nCELL_TYPES 0\n\n");
    bytes.extend(
        b"POINT_DATA 1\nFIELD f 3\nflags 1 1 bit\n\x80\nname 1 1 string\n\xc3\n\n\n\nid 1 1 unsigned_char\n\n\n",
    );
    let set = folder.read("binary.vtk", bytes).unwrap();
    assert_eq!(set.bounds().unwrap().min, [x; 3]);
    assert_eq!(attribute(&set, "id").values, Values::I64(vec![10]));
}

#[test]
fn vtk_sections_need_not_be_separated() {
    let folder = Folder::new("vtk-glued");
    let mut bytes = b"# vtk DataFile Version 2.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 1 float\n".to_vec();
    bytes.extend([0; 12]);
    bytes.extend(b"VERTICES 1 2\n\0\0\0\x01\0\0\0\0POINT_DATA 1\nSCALARS rho float 1\nLOOKUP_TABLE default\n");
    bytes.extend(5.0_f32.to_be_bytes());
    let set = folder.read("glued.vtk", bytes).unwrap();
    assert_eq!(attribute(&set, "density").values, Values::F32(vec![5.0]));
}

#[test]
fn bgeo_attributes_in_any_order_and_type() {
    let folder = Folder::new("bgeo");
    let declarations = [
        bgeo_attribute("pscale", 1, 0, &[0; 4]),
        bgeo_attribute("material", 1, 4, b"\0\0\0\x02\0\x05water\0\0"),
        bgeo_attribute("Cd", 3, 0, &[0; 12]),
        bgeo_attribute("id", 1, 1, &[0; 4]),
        bgeo_attribute("v", 3, 5, &[0; 12]),
    ];
    let mut row = 0.25_f32.to_be_bytes().to_vec();
    row.extend(1_i32.to_be_bytes());
    [0.1_f32, 0.2, 0.3].iter().for_each(|x| row.extend(x.to_be_bytes()));
    row.extend((-5_i32).to_be_bytes());
    [1.0_f32, 2.0, 3.0].iter().for_each(|x| row.extend(x.to_be_bytes()));
    let bytes = bgeo(&[[1.0, 2.0, 3.0]], &declarations, &[row]);
    for bytes in [gzip(&bytes), bytes] {
        let set = folder.read("odd.bgeo", bytes).unwrap();
        assert_eq!(set.positions, [[1.0, 2.0, 3.0]]);
        assert_eq!(set.radii(), Some(&[0.25][..]));
        assert_eq!(attribute(&set, "color").values, Values::F32(vec![0.1, 0.2, 0.3]));
        assert_eq!(attribute(&set, "id").values, Values::I64(vec![-5]));
        assert_eq!(attribute(&set, "velocity").values, Values::F32(vec![1.0, 2.0, 3.0]));
        assert_eq!(set.attributes.len(), 4);
    }
}

#[test]
fn ply_of_any_types_order_and_byte_order() {
    let folder = Folder::new("ply");
    let header = |format: &str| {
        format!(
            "ply\r\nformat {format} 1.0\r\ncomment made by hand\r\nobj_info x\r\nelement empty 7\r\n\
             element face 2\r\nproperty list uchar uint vertex_indices\r\nproperty short flags\r\n\
             element vertex 2\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n\
             property double z\r\nproperty int64 ID\r\nproperty short x\r\nproperty float y\r\n\
             property float width\r\nproperty float vx\r\nproperty float vy\r\nproperty float vz\r\n\
             element edge 1\r\nproperty int vertex1\r\nend_header\r\n"
        )
    };
    let text = header("ascii")
        + "3 0 1 2 5\r\n0 6\r\n255 51 0 2.5 9007199254740993 -1 0.5 0.2 1 2 3\r\n0 0 255 3.5 2 1 1.5 0.4 4 5 6\r\n0\r\n";
    let mut files = vec![text.into_bytes()];
    for big in [false, true] {
        let mut bytes = header(if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
        macro_rules! put {
            ($($x:expr),*) => { $(bytes.extend(if big { $x.to_be_bytes().to_vec() } else { $x.to_le_bytes().to_vec() });)* };
        }
        put!(3_u8, 0_u32, 1_u32, 2_u32, 5_i16, 0_u8, 6_i16);
        put!(255_u8, 51_u8, 0_u8, 2.5_f64, 9_007_199_254_740_993_i64, -1_i16, 0.5_f32, 0.2_f32, 1_f32, 2_f32, 3_f32);
        put!(0_u8, 0_u8, 255_u8, 3.5_f64, 2_i64, 1_i16, 1.5_f32, 0.4_f32, 4_f32, 5_f32, 6_f32);
        files.push(bytes);
    }
    for bytes in files {
        let set = folder.read("odd.ply", bytes).unwrap();
        assert_eq!(set.positions, [[-1.0, 0.5, 2.5], [1.0, 1.5, 3.5]]);
        assert_eq!(set.radii(), Some(&[0.1, 0.2][..]));
        assert_eq!(attribute(&set, "id").values, Values::I64(vec![9_007_199_254_740_993, 2]));
        assert_eq!(attribute(&set, "velocity").values, Values::F32(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(attribute(&set, "color").values, Values::F32(vec![1.0, 51.0 * (1.0 / 255.0), 0.0, 0.0, 0.0, 1.0]));
    }
}

#[test]
fn columns_are_joined_and_renamed() {
    let folder = Folder::new("columns");
    let header = format!(
        "element vertex 1\n{XYZ}property float u\nproperty float v\nproperty float w\nproperty float nx\n\
         property float ny\nproperty float nz\nproperty float force_x\nproperty float force_y\nproperty float force_z\n\
         property float h\nproperty float RHO\nproperty float quality\n"
    );
    let set = folder.read("columns.ply", ply(&header, "0 0 0 1 2 3 4 5 6 7 8 9 10 11 12")).unwrap();
    let columns: Vec<_> = set.attributes.iter().map(|a| (a.name.as_str(), a.components)).collect();
    let expected = [("velocity", 3), ("normal", 3), ("force", 3), ("radius", 1), ("density", 1), ("quality", 1)];
    assert_eq!(columns, expected);
    assert_eq!(attribute(&set, "force").values, Values::F32(vec![7.0, 8.0, 9.0]));
}

#[test]
fn csv_of_several_programs() {
    let folder = Folder::new("csv");
    let paraview = "\"Points:0\",\"Points:1\",\"Points:2\",\"velocity:0\",\"velocity:1\",\"velocity:2\",\"id\"\n\
        0,1,2,3,4,5,6\n7,8,9,1,2,3,4\n";
    let dualsph = "Pos.x [m];Pos.y [m];Pos.z [m];Idp;Vel.x [m/s];Vel.y [m/s];Vel.z [m/s]\r\n\
        0;1;2;6;3;4;5\r\n\r\n7;8;9;4;1;2;3";
    let script = "# made by a script\n# x y z id vx vy vz\n0 1 2 6 3 4 5\n  7\t8 9 4.0 1e0 2 3\n";
    for text in [paraview, dualsph, script] {
        let set = folder.read("table.csv", text).unwrap();
        assert_eq!(set.positions, [[0.0, 1.0, 2.0], [7.0, 8.0, 9.0]]);
        assert_eq!(attribute(&set, "id").values, Values::I64(vec![6, 4]));
        assert_eq!(attribute(&set, "velocity").values, Values::F32(vec![3.0, 4.0, 5.0, 1.0, 2.0, 3.0]));
    }
    // A byte order mark, quotes, words, a separator at each end, commas in numbers.
    let quoted = "\u{feff}\"kind\",\"x\",\"y\",\"z\",\"id\",\n\"a, \",\"0\",\"1\",\"2\",6,\nb,7,8,9,4,\n";
    let decimal = "x;y;z;id;name\n0,0;1,0;2e0;6;a\n7,0;8;9;4;\n";
    for text in [quoted, decimal] {
        let set = folder.read("table.csv", text).unwrap();
        assert_eq!(set.positions, [[0.0, 1.0, 2.0], [7.0, 8.0, 9.0]]);
        assert_eq!(set.attributes.len(), 1);
        assert_eq!(attribute(&set, "id").values, Values::I64(vec![6, 4]));
    }
    let gaps = folder.read("gaps.csv", ",x,y,z,rho\n0,0,1,2,\n1,7,8,9,5\n").unwrap();
    let Values::F32(density) = &attribute(&gaps, "density").values else { panic!() };
    assert!(gaps.attributes.len() == 1 && density[0].is_nan() && density[1] == 5.0);
    assert!(matches!(folder.read("gap.csv", "x,y,z\n0,1,2\n7,,9\n"), Err(ReadError::NotFinite { first: 1, .. })));
    let none = folder.read("none.csv", "x,y,z\n").unwrap();
    assert_eq!((none.len(), &none.warnings[..]), (0, &["no particles".to_owned()][..]));
    for broken in ["hello\n", "x,y\n1,2\n", "x,y,z\n1,2\n", "x,y,z\n1,2,3\n1,2,three\n", "1,2,3\nx,y,z\n"] {
        let error = folder.read("broken.csv", broken).unwrap_err();
        assert!(matches!(error, ReadError::Broken { .. }), "{error}");
    }
}

#[test]
fn tables_as_other_programs_name_them() {
    let folder = Folder::new("tables");
    let fluent = "nodenumber,    x-coordinate,    y-coordinate,    z-coordinate,  density\n\
        1, 1.0E+00, 2.0E+00, 3.0E+00, 1.0E+03\n2, 4.0E+00, 5.0E+00, 6.0E+00, 1.0E+03\n";
    let star = "\"Velocity[i] (m/s)\",\"Velocity[j] (m/s)\",\"Velocity[k] (m/s)\",\"X (m)\",\"Y (m)\",\"Z (m)\"\n\
        7,8,9,1,2,3\n7,8,9,4,5,6\n";
    for (name, text, attribute) in [
        ("fluent.csv", fluent, Some("density")),
        ("star.csv", star, Some("velocity")),
        ("savetxt.txt", "1.0e+00 2.0e+00 3.0e+00\n4.0e+00 5.0e+00 6.0e+00\n", None),
        ("tab.TSV", "X\tY\tZ\tRho\n1\t2\t3\t1000\n4\t5\t6\t1000\n", Some("density")),
        ("six.dat", "# x y z vx vy vz\n1 2 3 7 8 9\n4 5 6 7 8 9\n", Some("velocity")),
    ] {
        let set = folder.read(name, text).unwrap();
        assert_eq!(set.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{name}");
        assert!(attribute.is_none_or(|attribute| set.attribute(attribute).is_some()), "{name}: {:?}", set.attributes);
    }
}

#[test]
fn xyz_with_and_without_a_count() {
    let folder = Folder::new("xyz");
    let bare = "1 2 3 0.5\n4 5 6 0.5\n";
    let counted = "2\nwater\nO 1 2 3\nO 4 5 6\n";
    let extended = "2\nLattice=\"1 0 0\" Properties=species:S:1:vel:R:3:pos:R:3:id:I:1 Time=0.5\n\
        O 7 8 9 1 2 3 11\nO 7 8 9 4 5 6 12\n";
    let words_within = "2\nProperties=id:I:1:species:S:1:pos:R:3:fixed:L:1\n11 O 1 2 3 T\n12 O 4 5 6 F\n";
    let frames = "2\nwater\nO 1 2 3\nO 4 5 6\n2\nwater\nO 1 2 3\nO 4 5 7\n";
    let set = folder.read("lammps.xyz", "2\nAtoms. Timestep: 0\n1 1.25 2.25 3.25 7\n2 4 5 6 7\n").unwrap();
    assert_eq!(set.positions, [[1.25, 2.25, 3.25], [4.0, 5.0, 6.0]]);
    assert_eq!(attribute(&set, "type").values, Values::F64(vec![1.0, 2.0]));
    for text in [bare, counted, extended, words_within, frames] {
        let set = folder.read("text.xyz", text).unwrap();
        assert_eq!(set.warnings.len(), usize::from(text == frames));
        if text == words_within {
            assert_eq!(set.attributes.len(), 1);
            assert_eq!(attribute(&set, "id").values, Values::I64(vec![11, 12]));
        }
        assert_eq!(set.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        if text == extended {
            assert_eq!(attribute(&set, "velocity").values, Values::F32(vec![7.0, 8.0, 9.0, 7.0, 8.0, 9.0]));
            assert_eq!(attribute(&set, "id").values, Values::I64(vec![11, 12]));
        }
    }
    assert!(matches!(folder.read("short.xyz", "3\nwater\nO 1 2 3\n"), Err(ReadError::Broken { .. })));
    assert!(matches!(folder.read("bare.xyz", b"\0\0\x80\x3f\x01\x02"), Err(ReadError::Unsupported { .. })));
}

#[test]
fn json_of_positions_or_named_arrays() {
    let folder = Folder::new("json");
    let arrays = r#"{"time": 0.5, "Points": [[1, 2, 3], [4, 5, 6]], "vel": [[1, 2, 3], [1, 2, 3]], "id": [7, 8]}"#;
    let columns = r#"{"x": [1, 4], "y": [2, 5], "z": [3, 6], "vx": [1, 1], "vy": [2, 2], "vz": [3, 3], "id": [7, 8]}"#;
    for text in ["[[1,2,3],[4,5,6]]", arrays, columns] {
        let set = folder.read("points.json", text).unwrap();
        assert_eq!(set.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        if text != "[[1,2,3],[4,5,6]]" {
            assert_eq!(attribute(&set, "velocity").values, Values::F32(vec![1.0, 2.0, 3.0, 1.0, 2.0, 3.0]));
            assert_eq!(attribute(&set, "id").values, Values::I64(vec![7, 8]));
        }
    }
    let flat = r#"{"positions": [1, 2, 3, 4, 5, 6], "velocities": [1, 2, 3, 1, 2, 3]}"#;
    let objects =
        r#"[{"position": [1, 2, 3], "vel": [1, 2, 3], "name": "a"}, {"vel": [1, 2, 3], "position": [4, 5, 6]}]"#;
    let within = r#"{"time": 1, "name": "b", "particles": {"x": [[1, 2, 3], [4, 5, 6]], "v": [[1, 2, 3], [1, 2, 3]]}}"#;
    let marked = "\u{feff}{\"p\": [{\"x\": 1, \"y\": 2, \"z\": 3, \"vx\": 1, \"vy\": 2, \"vz\": 3},\
        {\"x\": 4, \"y\": 5, \"z\": 6, \"vx\": 1, \"vy\": 2, \"vz\": 3, \"more\": 1}]}";
    for text in [flat, objects, within, marked] {
        let set = folder.read("points.json", text).unwrap();
        assert_eq!(set.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(set.attributes.len(), 1);
        assert_eq!(attribute(&set, "velocity").values, Values::F32(vec![1.0, 2.0, 3.0, 1.0, 2.0, 3.0]));
    }
    assert!(matches!(folder.read("nan.json", "[[1,2,3],[1,null,3]]"), Err(ReadError::NotFinite { first: 1, .. })));
    let camera = r#"{"camera": {"position": [1, 2, 3]}}"#;
    let unlike = "[[1,2,3],[1,2]]";
    let error = folder.read("unlike.json", unlike).unwrap_err().to_string();
    assert!(error.contains("element 1 of an array is unlike those before"), "{error}");
    let deep = "[".repeat(100_000);
    for broken in [camera, "{", "[[1,2]]", "[[1,2,3],", "{\"bodies\": []}", "hello", "[] []", &deep] {
        let error = folder.read("broken.json", broken).unwrap_err();
        assert!(matches!(error, ReadError::Broken { .. }), "{error}");
    }
}

#[test]
fn npy_of_any_type_and_order() {
    let folder = Folder::new("npy");
    let rows = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0];
    let columns = [1.0_f64, 4.0, 2.0, 5.0, 3.0, 6.0];
    let files = [
        npy("<f4", false, 2, &rows.map(f32::to_le_bytes).concat()),
        npy(">f8", true, 2, &columns.map(f64::to_be_bytes).concat()),
        npy("|u1", false, 2, &[1, 2, 3, 4, 5, 6]),
    ];
    for bytes in files {
        let set = folder.read("points.npy", bytes).unwrap();
        assert_eq!(set.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    }
    // Several scenes at once, of which there is one; records with names, with room between the fields.
    let with_header = |header: &str, data: &[u8]| {
        let length = (header.len() as u16).to_le_bytes();
        [&b"\x93NUMPY\x01\0"[..], &length, header.as_bytes(), data].concat()
    };
    let batch = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 3), }";
    let batch = with_header(batch, &rows.map(f32::to_le_bytes).concat());
    assert_eq!(folder.read("batch.npy", batch).unwrap().positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    let records = "{'descr': [('id', '|u1'), ('', '|V3'), ('pos', '<f4', (3,)), ('rho', '<f8')], 'fortran_order': False, 'shape': (2,), }";
    let data = rows.chunks(3).zip([7, 8]).flat_map(|(row, id)| {
        let row = row.iter().flat_map(|x| x.to_le_bytes());
        [id, 0, 0, 0].into_iter().chain(row).chain(f64::from(id).to_le_bytes()).collect::<Vec<u8>>()
    });
    let records = with_header(records, &data.collect::<Vec<u8>>());
    let set = folder.read("records.npy", &records).unwrap();
    assert_eq!(set.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(attribute(&set, "id").values, Values::I64(vec![7, 8]));
    assert_eq!(attribute(&set, "density").values, Values::F32(vec![7.0, 8.0]));
    for length in 0..records.len() {
        assert!(folder.read("cut.npy", &records[..length]).is_err(), "{length}");
    }
    for broken in [npy("<c8", false, 0, &[]), npy("<f4", false, usize::MAX, &[0; 12]), npy("<f4", false, 0, &[0])] {
        assert!(matches!(folder.read("broken.npy", broken), Err(ReadError::Broken { .. })));
    }
}

#[test]
fn far_scenes_keep_their_digits() {
    let folder = Folder::new("far");
    let header = "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
    let rows = "4500000.001 0 -2e6\n4500000.002 1 -2e6\n4500000.003 2 -2e6\n";
    let set = folder.read("far.ply", ply(header, rows)).unwrap();
    for (index, position) in set.positions.iter().enumerate() {
        let world = set.origin[0] + f64::from(position[0]);
        assert!((world - (4.5e6 + 0.001 * (index + 1) as f64)).abs() < 2e-9, "{world}");
    }
    let bounds = set.bounds().unwrap();
    assert!((bounds.max[0] - 4_500_000.003).abs() < 2e-9 && bounds.max[1] == 2.0);
    // Near ones stay as written.
    let set = folder.read("near.ply", ply(header, "1 0 0\n2 1 0\n3 2 0\n")).unwrap();
    assert_eq!((set.origin, set.positions[2]), ([0.0; 3], [3.0, 2.0, 0.0]));
}

#[test]
fn one_particle() {
    let folder = Folder::new("one");
    let set = folder.read("one.pos", pos(0.25, &[[1.0, 2.0, 3.0]])).unwrap();
    assert_eq!(set.bounds().unwrap().min, [1.0, 2.0, 3.0]);
    assert_eq!(set.radius(None).unwrap().value, 0.25);
}

#[test]
fn pythons_own_objects_are_named() {
    use std::io::Write;
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, kind, shape) in [("version", "<i8", "()"), ("particles", "|O", "()")] {
        archive.start_file(format!("{name}.npy"), zip::write::SimpleFileOptions::default()).unwrap();
        let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        let length = (header.len() as u16).to_le_bytes();
        archive.write_all(&[&b"\x93NUMPY\x01\0"[..], &length, header.as_bytes(), &[0; 8]].concat()).unwrap();
    }
    let error =
        Folder::new("objects").read("dump.npz", archive.finish().unwrap().into_inner()).unwrap_err().to_string();
    assert!(error.contains("array \"particles\" of the type \"object\" cannot be read; load it in Python"), "{error}");
}
