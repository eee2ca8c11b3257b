//! Foam, spray and bubbles: files of their own beside the fluid's, and stray particles of the fluid.

use crate::Error;
use crate::frame::{FrameParticles, Strays, velocities_of};
use crate::number::short;
use crate::options::Options;
use crate::specks::specks;
use glam::DVec3;
use limpid::{DropletKind, Droplets, Radius};
use limpid_io::{Frame, ParticleSet, Selection};
use std::path::{Path, PathBuf};

/// Where the droplets of a run come from.
pub struct Diffuse {
    sources: Vec<Source>,
    /// What of the options files of droplets are read with.
    selection: Selection,
    limits: StrayLimits,
    /// Radius of droplets whose file has none, and of specks of strays on the average, in particle radii.
    droplet_radius: f32,
    /// r, world units.
    radius: f32,
    is_single: bool,
    warned: bool,
}

/// Files of one kind.
struct Source {
    kind: DropletKind,
    files: Vec<Frame>,
    /// What they are called in messages.
    name: String,
}

/// Which particles of the fluid are spray.
#[derive(Clone, Copy)]
struct StrayLimits {
    /// Those of lower density; 0: none.
    density: f32,
    /// Those with fewer neighbours within 4 r; 0: none.
    neighbours: u32,
}

/// The droplets of one frame.
#[derive(Default)]
pub struct FrameDroplets {
    groups: Vec<Group>,
    /// What a file lacks, and what is done instead: of the first frame that has droplets only.
    pub warnings: Vec<String>,
    /// What there turned out to be.
    pub notes: Vec<String>,
}

/// Droplets of one kind, about the fluid's origin.
struct Group {
    kind: DropletKind,
    positions: Vec<[f32; 3]>,
    radii: Vec<f32>,
    velocities: Option<Vec<[f32; 3]>>,
    life: Option<Vec<f32>>,
}

/// In options and messages, and in names of files beside the fluid's.
fn names(kind: DropletKind) -> (&'static str, &'static str, &'static str) {
    match kind {
        DropletKind::Foam => ("foam", "--foam-particles", "_foam"),
        DropletKind::Spray => ("spray", "--spray-particles", "_spray"),
        DropletKind::Bubbles => ("bubble", "--bubble-particles", "_bubbles"),
    }
}

impl Diffuse {
    /// What the options name, or else what lies beside the files of the fluid. `radius_world`: r.
    ///
    /// # Errors
    /// An input that is not there.
    pub fn find(options: &Options, frames: &[Frame], radius_world: f64) -> Result<Self, Error> {
        let mut sources = Vec::new();
        for kind in DropletKind::ALL {
            let given = match kind {
                DropletKind::Foam => &options.foam_particles,
                DropletKind::Spray => &options.spray_particles,
                DropletKind::Bubbles => &options.bubble_particles,
            };
            let (name, files) = match given.as_deref() {
                Some("none") => continue,
                Some(input) => {
                    let sequence = limpid_io::expand(&[input.to_owned()])
                        .map_err(|error| Error::usage(format!("{} {error}", names(kind).1)))?;
                    (format!("{} {input}", names(kind).1), sequence.frames)
                }
                None => ("its folder".into(), limpid_io::beside(frames, names(kind).2)),
            };
            if !files.is_empty() {
                sources.push(Source { kind, files, name });
            }
        }
        Ok(Self {
            sources,
            selection: Selection { unit_scale: options.unit_scale, clip: options.clip, ..Selection::default() },
            limits: StrayLimits {
                density: options.spray_density.unwrap_or(0.0) as f32,
                neighbours: options.spray_neighbours.unwrap_or(0),
            },
            droplet_radius: options.droplet_radius() as f32,
            radius: radius_world as f32,
            is_single: frames.len() == 1,
            warned: false,
        })
    }

    /// The droplets of a frame, the `index`th of the run. Takes those that are the fluid's own out of its particles.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn advance(
        &mut self,
        frame: &Frame,
        index: usize,
        particles: &mut FrameParticles,
    ) -> Result<FrameDroplets, Error> {
        let mut droplets = FrameDroplets::default();
        for source in &self.sources {
            let noun = names(source.kind).0;
            let Some(path) = source.file_of(frame, index, self.is_single) else {
                let note =
                    format!("{}: no {noun} particles: {} has none of this number", frame.path.display(), source.name);
                droplets.notes.push(note);
                continue;
            };
            let mut set = limpid_io::read(path)?;
            self.selection.apply(&mut set, None)?;
            if set.is_empty() {
                let reason = "the file holds none; foam generators write none until the flow exceeds their limits";
                droplets.notes.push(format!("{}: 0 {noun} particles: {reason}", path.display()));
                continue;
            }
            let group = Group::of(source.kind, &set, particles.origin(), self.droplet_radius * self.radius);
            if group.velocities.is_none() {
                let lack = format!("has no velocity, so its {noun} is drawn round, not stretched along its way");
                droplets.warnings.push(format!("{}: {lack}", path.display()));
            }
            droplets.groups.push(group);
        }
        self.take_strays(frame, particles, &mut droplets);
        if self.warned {
            droplets.warnings.clear();
        }
        self.warned |= !droplets.warnings.is_empty();
        Ok(droplets)
    }

    /// Makes spray of the fluid's strays.
    fn take_strays(&self, frame: &Frame, particles: &mut FrameParticles, droplets: &mut FrameDroplets) {
        let StrayLimits { density, neighbours } = self.limits;
        if density <= 0.0 && neighbours == 0 || particles.is_empty() {
            return;
        }
        let mut lack = |problem: &str| droplets.warnings.push(format!("{}: {problem}", frame.path.display()));
        if density > 0.0 && !particles.has_density() {
            lack("has no density, so --spray-density finds no spray; --spray-neighbours needs none");
        }
        if particles.velocities().is_none() {
            lack("has no velocity, so its spray is drawn round, not stretched along its way");
        }
        let strays = particles.take_strays(density, neighbours);
        if strays.positions.is_empty() {
            let limits =
                [(density > 0.0, "density", f64::from(density)), (neighbours > 0, "neighbours", neighbours.into())];
            let limits = limits.into_iter().filter(|(is_set, ..)| *is_set);
            let limits: Vec<String> =
                limits.map(|(_, what, limit)| format!("--spray-{what} {}", short(limit))).collect();
            let note = format!("{}: 0 spray particles: none is under {}", frame.path.display(), limits.join(" or "));
            droplets.notes.push(note);
            return;
        }
        let Strays { positions, radii, velocities, .. } = specks(&strays, self.droplet_radius);
        droplets.groups.push(Group { kind: DropletKind::Spray, positions, radii, velocities, life: None });
    }
}

impl Source {
    /// The file of the same number; without numbers, of the same place; the only one for an only frame.
    fn file_of(&self, frame: &Frame, index: usize, is_single: bool) -> Option<&Path> {
        let same_number = self.files.iter().find(|file| frame.number.is_some() && file.number == frame.number);
        let found = match (same_number, self.files.as_slice()) {
            (Some(file), _) => Some(file),
            (None, [only]) if is_single => Some(only),
            (None, files) => files.get(index).filter(|file| frame.number.is_none() || file.number.is_none()),
        };
        found.map(|file: &Frame| PathBuf::as_path(&file.path))
    }
}

impl Group {
    fn of(kind: DropletKind, set: &ParticleSet, origin: DVec3, radius: f32) -> Self {
        let offset = DVec3::from_array(set.origin) - origin;
        let local = |p: &[f32; 3]| (offset + DVec3::from_array(p.map(f64::from))).as_vec3().to_array();
        let radii = match (set.radii(), set.file_radius) {
            (Some(radii), _) => radii.to_vec(),
            (None, Some(radius)) => vec![radius as f32; set.len()],
            (None, None) => vec![radius; set.len()],
        };
        let scalars = |name: &str| set.attribute(name).filter(|a| a.components == 1).map(|a| a.values.floats());
        let life = scalars("life").map(|life| match scalars("age") {
            // A span of life, of which a part is over.
            Some(age) => life.iter().zip(age.iter()).map(|(life, age)| life - age).collect(),
            None => life.into_owned(),
        });
        Self { kind, positions: set.positions.iter().map(local).collect(), radii, velocities: velocities_of(set), life }
    }

    fn slices(&self) -> Droplets<'_> {
        Droplets {
            kind: self.kind,
            positions: &self.positions,
            radius: Radius::Each(&self.radii),
            velocities: self.velocities.as_deref(),
            life: self.life.as_deref(),
        }
    }
}

impl FrameDroplets {
    /// The droplets as the renderer takes them.
    pub fn slices(&self) -> Vec<Droplets<'_>> {
        self.groups.iter().map(Group::slices).collect()
    }
}
