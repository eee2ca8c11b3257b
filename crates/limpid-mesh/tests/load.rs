//! Meshes of every format, whole and broken.

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::path::{Path, PathBuf};
use std::{env, fs, process};

use base64::Engine;
use limpid_mesh::{Error, Mesh, load};

/// A folder that is removed with its value.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = env::temp_dir().join(format!("limpid-mesh-{name}-{}", process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn load(&self, name: &str, contents: impl AsRef<[u8]>) -> Result<Mesh, Error> {
        let path = self.0.join(name);
        let _ = fs::remove_file(&path);
        fs::write(&path, contents).unwrap();
        let result = load(&path);
        if let Err(error) = &result {
            let message = error.to_string();
            assert!(!message.contains('\n') && message.contains(name), "one line that names the file: {message}");
        }
        result
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

const OBJ: &str = "# a square\r\nmtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl other\nf -4 -3 -2\n";

fn ply(format: &str, body: &[u8]) -> Vec<u8> {
    let head = format!(
        "ply\nformat {format} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\nproperty float t\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    );
    [head.as_bytes(), body].concat()
}

fn little_ply() -> Vec<u8> {
    let mut body = Vec::new();
    for corner in CORNERS {
        corner.iter().for_each(|x| body.extend(x.to_le_bytes()));
        body.extend([255, 128, 0]);
        body.extend([corner[0], corner[1]].iter().flat_map(|x| x.to_le_bytes()));
    }
    body.push(4);
    (0..4_i32).for_each(|index| body.extend(index.to_le_bytes()));
    ply("binary_little_endian", &body)
}

fn stl() -> Vec<u8> {
    let mut bytes = b"solid, but binary".to_vec();
    bytes.resize(80, 0);
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend([0; 12]);
    CORNERS[..3].iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes.extend([0; 2]);
    bytes
}

/// A square in glTF: positions at byte 0, 16-bit indices at byte 48, a picture of one pixel at byte 60.
fn gltf_parts() -> (serde_json::Value, Vec<u8>) {
    let mut buffer: Vec<u8> = CORNERS.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    [0_u16, 1, 2, 0, 2, 3].iter().for_each(|index| buffer.extend(index.to_le_bytes()));
    let mut picture = Vec::new();
    let pixel = image::RgbaImage::from_pixel(1, 1, image::Rgba([10, 20, 30, 255]));
    pixel.write_to(&mut std::io::Cursor::new(&mut picture), image::ImageFormat::Png).unwrap();
    buffer.extend(&picture);
    let document = serde_json::json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [
            {"children": [1], "translation": [10, 0, 0]},
            {"mesh": 0, "scale": [2, 2, -2], "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2]}
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
            {"buffer": 0, "byteOffset": 60, "byteLength": picture.len()}
        ],
        "buffers": [{"byteLength": buffer.len()}],
        "materials": [{"pbrMetallicRoughness": {
            "baseColorFactor": [0.5, 0.25, 1.0, 1.0], "metallicFactor": 0.25, "baseColorTexture": {"index": 0}
        }}],
        "textures": [{"source": 0}], "images": [{"bufferView": 2, "mimeType": "image/png"}]
    });
    (document, buffer)
}

fn glb(document: &serde_json::Value, buffer: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((12 + 8 + text.len() as u32 + 8 + buffer.len() as u32).to_le_bytes());
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(&text);
    bytes.extend((buffer.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(buffer);
    bytes
}

#[test]
fn the_obstacles_are_closed_surfaces() {
    let volumes =
        [("box", 1.0), ("sphere", 4.0 / 3.0 * PI), ("cylinder", PI), ("torus", 0.5 * PI * PI), ("wedge", 0.5)];
    for (name, volume) in volumes {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../data/obstacles/{name}.obj"));
        let mesh = load(&data).unwrap();
        let part = &mesh.parts[0];
        // By the divergence theorem; positive only if triangles are counter-clockwise from outside.
        let six_volumes: f64 = part
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|i| glam::Vec3::from_array(part.positions[i as usize]).as_dvec3());
                a.dot(b.cross(c))
            })
            .sum();
        assert!((six_volumes / 6.0 - volume).abs() < 0.05 * volume, "{name}: {}", six_volumes / 6.0);
    }
}

#[test]
fn obj_has_materials_and_polygons() {
    let folder = Folder::new("obj");
    fs::write(folder.0.join("m.mtl"), "newmtl red\nKd 0.5 0 0\nd 0.5\nmap_Kd no such.png\n").unwrap();
    let mesh = folder.load("a.obj", OBJ).unwrap();
    let [red, other] = &mesh.parts[..] else { panic!("two materials") };
    assert_eq!(red.positions, CORNERS);
    assert_eq!(red.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(red.uvs.as_ref().unwrap()[3], [0.0, 0.0]);
    assert_eq!(red.normals.as_ref().unwrap()[0], [0.0, 0.0, 1.0]);
    assert_eq!(red.colors.as_ref().unwrap()[1], [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(red.material.base_color, [0.5, 0.0, 0.0, 0.5]);
    assert_eq!(other.triangles, [[0, 1, 2]]);
    assert!(other.uvs.is_none() && other.normals.is_none());
    assert!(mesh.warnings.len() == 1 && mesh.warnings[0].contains("no such.png"), "{:?}", mesh.warnings);
}

#[test]
fn gltf_applies_transforms_and_keeps_materials() {
    let folder = Folder::new("gltf");
    let (mut document, buffer) = gltf_parts();
    let binary = folder.load("a.glb", glb(&document, &buffer)).unwrap();
    let part = &binary.parts[0];
    // Doubled, turned by 90 degrees about z, moved by 10 along x.
    for (corner, expected) in part.positions.iter().zip([[10.0, 0.0], [10.0, 2.0], [8.0, 2.0], [8.0, 0.0]]) {
        assert!((corner[0] - expected[0]).abs() < 1e-5 && (corner[1] - expected[1]).abs() < 1e-5, "{corner:?}");
    }
    assert_eq!(part.triangles, [[0, 2, 1], [0, 3, 2]], "a mirrored node turns its triangles round");
    assert_eq!((part.material.base_color, part.material.metallic), ([0.5, 0.25, 1.0, 1.0], 0.25));
    let texture = part.material.base_color_texture.as_ref().unwrap();
    assert_eq!((texture.width, texture.height, &texture.rgba8[..], texture.srgb), (1, 1, &[10, 20, 30, 255][..], true));

    let data = base64::engine::general_purpose::STANDARD.encode(&buffer);
    document["buffers"][0]["uri"] = format!("data:application/octet-stream;base64,{data}").into();
    assert_eq!(folder.load("a.gltf", document.to_string()).unwrap(), binary);
    fs::write(folder.0.join("my buffer.bin"), &buffer).unwrap();
    document["buffers"][0]["uri"] = "my%20buffer.bin".into();
    assert_eq!(folder.load("a.gltf", document.to_string()).unwrap(), binary);
    document["buffers"][0]["uri"] = "missing.bin".into();
    assert!(folder.load("a.gltf", document.to_string()).unwrap_err().to_string().contains("missing.bin"));
}

#[test]
fn ply_and_stl() {
    let folder = Folder::new("ply");
    let text = ply(
        "ascii",
        b"0 0 0 255 128 0 0 0\n1 0 0 255 128 0 1 0\n1 1 0 255 128 0 1 1\n0 1 0 255 128 0 0 1\n4 0 1 2 3\n",
    );
    let mesh = folder.load("a.ply", text).unwrap();
    assert_eq!(mesh, folder.load("b.ply", little_ply()).unwrap());
    let part = &mesh.parts[0];
    assert_eq!((&part.positions[..], &part.triangles[..]), (&CORNERS[..], &[[0, 1, 2], [0, 2, 3]][..]));
    assert!((part.colors.as_ref().unwrap()[0][1] - 0.2158).abs() < 1e-3, "sRGB becomes linear");
    assert_eq!(part.uvs.as_ref().unwrap()[2], [1.0, 0.0]);

    let text = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid s\n";
    assert_eq!(folder.load("a.stl", text).unwrap(), folder.load("b.stl", stl()).unwrap());
}

#[test]
fn mistakes_are_one_line() {
    let folder = Folder::new("mistakes");
    let mut counted = stl();
    counted[80..84].copy_from_slice(&100_000_000_u32.to_le_bytes());
    let claim = String::from_utf8(ply("ascii", b"")).unwrap().replace("face 1", "face 100000000");
    let (document, buffer) = gltf_parts();
    let broken = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut document = document.clone();
        change(&mut document);
        glb(&document, &buffer)
    };
    let files = [
        ("empty.obj", vec![]),
        ("none.obj", b"v 0 0 0\n".to_vec()),
        ("range.obj", b"v 0 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 4\n".to_vec()),
        ("zero.obj", b"v 0 0 0\nf 0 0 0\n".to_vec()),
        ("nan.obj", b"v 0 0 nan\nv 0 0 1\nv 0 1 0\nf 1 2 3\n".to_vec()),
        ("word.obj", b"v 0 0 x\n".to_vec()),
        ("counted.stl", counted),
        ("claim.ply", claim.into_bytes()),
        ("text.glb", b"hello".to_vec()),
        ("count.glb", broken(&|d| d["accessors"][0]["count"] = 100_000_000.into())),
        (
            "zeros.glb",
            broken(&|d| {
                d["accessors"][0]["count"] = 100_000_000.into();
                d["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            }),
        ),
        (
            "indices.glb",
            broken(&|d| {
                d["accessors"][1]["bufferView"] = 0.into();
                d["accessors"][1]["byteOffset"] = 12.into();
            }),
        ),
        ("view.glb", broken(&|d| d["bufferViews"][0]["byteLength"] = 1_000_000.into())),
        ("cycle.glb", broken(&|d| d["nodes"][1]["children"] = serde_json::json!([0]))),
        ("far.glb", broken(&|d| d["nodes"][0]["scale"] = serde_json::json!([3e38, 3e38, 3e38]))),
        ("type.glb", broken(&|d| d["accessors"][0]["type"] = "VEC2".into())),
        ("mesh.glb", broken(&|d| d["nodes"][1]["mesh"] = 7.into())),
    ];
    for (name, bytes) in files {
        assert!(folder.load(name, bytes).is_err(), "{name}");
    }
    let draco = broken(&|d| d["extensionsRequired"] = serde_json::json!(["KHR_draco_mesh_compression"]));
    assert!(matches!(folder.load("draco.glb", draco), Err(Error::Unsupported { .. })));
    assert!(matches!(folder.load("a.fbx", b"Kaydara FBX Binary"), Err(Error::Unsupported { .. })));
    assert!(matches!(load("no/such.obj".as_ref()), Err(Error::Io { .. })));
    let image = folder.load("image.glb", broken(&|d| d["bufferViews"][2]["byteLength"] = 9.into())).unwrap();
    assert!(image.warnings.len() == 1 && image.parts[0].material.base_color_texture.is_none(), "{image:?}");
}

#[test]
fn no_damage_panics() {
    let folder = Folder::new("damage");
    let (document, buffer) = gltf_parts();
    for (name, bytes) in
        [("a.obj", OBJ.into()), ("a.ply", little_ply()), ("a.stl", stl()), ("a.glb", glb(&document, &buffer))]
    {
        for end in 0..bytes.len() {
            let _ = folder.load(name, &bytes[..end]);
            let mut damaged = bytes.clone();
            for value in [0, 0xff, bytes[end] ^ 1, b'9'] {
                damaged[end] = value;
                let _ = folder.load(name, &damaged);
            }
        }
    }
}
