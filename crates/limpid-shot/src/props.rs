//! What stands in the scene beside the fluid: `--mesh` and `--bodies`.

use crate::Error;
use crate::options::Options;
use glam::{DMat3, DMat4, DVec3};
use limpid::{Body, Bounds, Look, Material, PartSlices, TextureSlices};
use limpid_io::Frame;
use serde::Deserialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The bodies of a run.
#[derive(Default)]
pub struct Props {
    meshes: Vec<limpid_mesh::Mesh>,
    bodies: Vec<Prop>,
    /// Poses of the moving ones by frame number.
    frames: Vec<FramePoses>,
    /// Those of the run.
    numbers: Vec<u64>,
    /// What is odd about the files.
    pub warnings: Vec<String>,
}

/// One body.
struct Prop {
    name: String,
    /// Index of its mesh.
    mesh: usize,
    scale: DVec3,
    /// Where it is unless the frame says otherwise.
    pose: Pose,
    is_dynamic: bool,
    look: Look,
}

/// The file of `--bodies`.
#[derive(Deserialize)]
struct Listing {
    bodies: Vec<Entry>,
    #[serde(default)]
    frames: Vec<FramePoses>,
}

#[derive(Deserialize)]
struct Entry {
    name: String,
    /// Relative to the listing.
    mesh: PathBuf,
    scale: Option<[f64; 3]>,
    #[serde(default)]
    dynamic: bool,
    #[serde(default)]
    wall: bool,
    color_linear_rgb: Option<[f32; 3]>,
    #[serde(flatten)]
    pose: Pose,
}

#[derive(Clone, Copy, Deserialize)]
struct Pose {
    #[serde(default)]
    position: [f64; 3],
    /// Rows of a rotation.
    #[serde(rename = "R", default = "unturned")]
    rotation: [[f64; 3]; 3],
}

#[derive(Deserialize)]
struct FramePoses {
    frame: u64,
    #[serde(default)]
    bodies: HashMap<String, Pose>,
}

fn unturned() -> [[f64; 3]; 3] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

impl Pose {
    const STILL: Self = Self { position: [0.0; 3], rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    fn is_finite(&self) -> bool {
        self.position.iter().chain(self.rotation.iter().flatten()).all(|x| x.is_finite())
    }

    /// World = R (scale v) + position.
    fn world_from_mesh(&self, scale: DVec3) -> DMat4 {
        let rotation = DMat3::from_cols_array_2d(&self.rotation).transpose();
        DMat4::from_translation(DVec3::from_array(self.position))
            * DMat4::from_mat3(rotation)
            * DMat4::from_scale(scale)
    }
}

impl Props {
    /// Reads what the options name, for these frames.
    pub fn load(options: &Options, frames: &[Frame]) -> Result<Self, Error> {
        let mut props = Self { numbers: frames.iter().map(number_of).collect(), ..Self::default() };
        let mut given: Vec<PathBuf> = options.mesh.iter().flatten().map(PathBuf::from).collect();
        if let Some(path) = &options.bodies {
            props.load_listing(Path::new(path), &mut given)?;
        }
        for path in given {
            let mesh = props.load_mesh(&path)?;
            props.bodies.push(Prop {
                name: path.display().to_string(),
                mesh,
                scale: DVec3::ONE,
                pose: Pose::STILL,
                is_dynamic: false,
                look: Look::Own,
            });
        }
        Ok(props)
    }

    /// Reads the bodies; takes their meshes out of those `given` where there is one of their name.
    fn load_listing(&mut self, path: &Path, given: &mut Vec<PathBuf>) -> Result<(), Error> {
        let broken = |problem: String| Error::usage(format!("{}: {problem}", path.display()));
        let text = limpid_mesh::files::read(path)
            .map_err(|error| broken(format!("cannot be read ({error}); check --bodies")))?;
        let listing: Listing = serde_json::from_slice(&text)
            .map_err(|error| broken(format!("is no list of bodies ({error}); correct it there")))?;
        let named = |entry: &Entry, path: &Path| entry.mesh.file_name() == path.file_name();
        let mut loaded: HashMap<PathBuf, usize> = HashMap::new();
        for entry in &listing.bodies {
            let scale = DVec3::from_array(entry.scale.unwrap_or([1.0; 3]));
            if !scale.is_finite() || !entry.pose.is_finite() || scale.min_element() == 0.0 && scale.max_element() == 0.0
            {
                return Err(broken(format!("body \"{}\" has no usable place or scale; correct it there", entry.name)));
            }
            let file = given.iter().find(|path| named(entry, path)).cloned();
            let file = file.unwrap_or_else(|| path.parent().unwrap_or(Path::new("")).join(&entry.mesh));
            if !limpid_mesh::files::is_file(&file) {
                return Err(broken(format!(
                    "body \"{}\" has no mesh: there is no file {}; correct the path there or give the file by --mesh",
                    entry.name,
                    file.display()
                )));
            }
            let mesh = match loaded.get(&file) {
                Some(mesh) => *mesh,
                None => self.load_mesh(&file)?,
            };
            loaded.insert(file, mesh);
            self.bodies.push(Prop {
                name: entry.name.clone(),
                mesh,
                scale,
                pose: entry.pose,
                is_dynamic: entry.dynamic,
                look: match entry.color_linear_rgb {
                    _ if entry.wall => Look::Glass,
                    Some(color) => Look::Colored(color),
                    None => Look::Own,
                },
            });
        }
        given.retain(|path| !listing.bodies.iter().any(|entry| named(entry, path)));
        if let Some(frame) = listing.frames.iter().find(|frame| !frame.bodies.values().all(Pose::is_finite)) {
            return Err(broken(format!("frame {} has a pose that is not finite; correct it there", frame.frame)));
        }
        if let Some(body) = self.bodies.iter().find(|body| body.is_dynamic && listing.frames.is_empty()) {
            self.warnings.push(format!(
                "{}: body \"{}\" moves, but there are no frames: it stays where it is",
                path.display(),
                body.name
            ));
        }
        self.frames = listing.frames;
        self.frames.sort_by_key(|frame| frame.frame);
        Ok(())
    }

    fn load_mesh(&mut self, path: &Path) -> Result<usize, Error> {
        let mesh = limpid_mesh::load(path)?;
        self.warnings.extend(mesh.warnings.iter().map(|warning| format!("{}: {warning}", path.display())));
        self.meshes.push(mesh);
        Ok(self.meshes.len() - 1)
    }

    /// Box around all opaque bodies in all frames of the run; None: there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        self.solid().flat_map(|body| self.corners(body)).map(|at| Bounds { min: at, max: at }).reduce(Bounds::union)
    }

    /// The lowest place of opaque bodies that never move, along `up`; None: there are none.
    pub fn lowest(&self, up: DVec3) -> Option<f64> {
        let still = self.solid().filter(|body| !body.is_dynamic);
        still.flat_map(|body| self.corners(body)).map(|at| at.dot(up)).reduce(f64::min)
    }

    fn solid(&self) -> impl Iterator<Item = &Prop> {
        self.bodies.iter().filter(|body| body.look != Look::Glass)
    }

    /// Vertices in the world.
    fn corners<'a>(&'a self, body: &'a Prop) -> impl Iterator<Item = DVec3> + 'a {
        let positions = || self.meshes[body.mesh].parts.iter().flat_map(|part| &part.positions);
        let numbers = if body.is_dynamic { &self.numbers[..] } else { &self.numbers[..1.min(self.numbers.len())] };
        numbers.iter().flat_map(move |number| {
            let world_from_mesh = self.world_from_mesh(body, *number);
            positions().map(move |at| world_from_mesh.transform_point3(DVec3::from_array(at.map(f64::from))))
        })
    }

    /// The meshes on the device, in order.
    pub fn upload(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Vec<limpid::Mesh> {
        let upload = |mesh: &limpid_mesh::Mesh| {
            let parts: Vec<PartSlices<'_>> = mesh.parts.iter().map(slices).collect();
            limpid::Mesh::upload(device, queue, &parts)
        };
        self.meshes.iter().map(upload).collect()
    }

    /// The bodies of a frame.
    pub fn at<'a>(&self, frame: &Frame, meshes: &'a [limpid::Mesh]) -> Vec<Body<'a>> {
        let place = |body: &Prop| Body {
            mesh: &meshes[body.mesh],
            world_from_mesh: self.world_from_mesh(body, number_of(frame)),
            look: body.look,
        };
        self.bodies.iter().map(place).collect()
    }

    /// Moving bodies are where the listing has them in the frame, or in the nearest one that it has.
    fn world_from_mesh(&self, body: &Prop, number: u64) -> DMat4 {
        let poses = self.frames.iter().min_by_key(|poses| poses.frame.abs_diff(number));
        let moved = poses.filter(|_| body.is_dynamic).and_then(|poses| poses.bodies.get(&body.name));
        moved.unwrap_or(&body.pose).world_from_mesh(body.scale)
    }
}

/// Files without a number are the first frame.
fn number_of(frame: &Frame) -> u64 {
    frame.number.unwrap_or(1)
}

fn slices(part: &limpid_mesh::Part) -> PartSlices<'_> {
    let limpid_mesh::Material { base_color, metallic, roughness, .. } = part.material;
    PartSlices {
        positions: &part.positions,
        normals: part.normals.as_deref(),
        uvs: part.uvs.as_deref(),
        colors: part.colors.as_deref(),
        triangles: &part.triangles,
        material: Material {
            base_color,
            metallic,
            roughness,
            base_color_texture: part.material.base_color_texture.as_ref().map(texture),
            metallic_roughness_texture: part.material.metallic_roughness_texture.as_ref().map(texture),
        },
    }
}

fn texture(image: &Arc<limpid_mesh::Texture>) -> TextureSlices<'_> {
    TextureSlices { size: [image.width, image.height], rgba8: &image.rgba8, srgb: image.srgb }
}
