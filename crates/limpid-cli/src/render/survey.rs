//! What must be known of all frames before the first is drawn: camera, floor and radius are the same for all of them.

use super::options::Options;
use super::progress::Progress;
use crate::failure::Failure;
use crate::number::{short, significant};
use glam::DVec3;
use limpid::Bounds;
use limpid_io::{Frame, ParticleSet, Radius, RadiusSource};
use std::cell::Cell;
use std::path::Path;

/// r of a scene without particles, where nothing but the scene's own scale depends on it.
const EMPTY_RADIUS: f64 = 0.1;

/// The frames together.
pub struct Survey {
    /// Box around the particle centres of all frames but for a few strays; None without particles.
    pub bounds: Option<Bounds>,
    /// Box around all particle centres of all frames.
    pub extent: Option<Bounds>,
    /// What is odd about the files.
    pub warnings: Vec<String>,
    /// Radius, from the frame with the most particles, the best to estimate one from; None without particles.
    radius: Option<Radius>,
    /// A single frame, so that it is not read twice.
    single: Cell<Option<ParticleSet>>,
}

impl Survey {
    /// Reads all frames.
    pub fn of(frames: &[Frame], options: &Options) -> Result<Self, Failure> {
        let (mut bounds, mut extent): (Option<Bounds>, Option<Bounds>) = (None, None);
        let mut largest: Option<ParticleSet> = None;
        let mut warnings = Vec::new();
        let progress = Progress::new("looking through", frames.len(), options.quiet());
        for frame in frames {
            let set = limpid_io::read(&frame.path)?;
            warnings.extend(oddities(&set, options));
            bounds = union(bounds, Bounds::robust(world_positions(&set)));
            extent = union(extent, extent_of(&set));
            if largest.as_ref().is_none_or(|largest| set.len() > largest.len()) {
                largest = Some(set);
            }
            progress.advance();
        }
        progress.finish();
        let occupied = largest.as_ref().filter(|set| !set.is_empty());
        let radius = occupied.map(|set| set.radius(options.radius)).transpose()?;
        if let (Some(set), Some(value), Some(extent)) = (occupied, options.radius, extent) {
            check_radius(value, extent, set)?;
        }
        let single = Cell::new(largest.filter(|_| frames.len() == 1));
        Ok(Self { bounds, extent, warnings, radius, single })
    }

    /// The particles of a frame.
    pub fn read(&self, path: &Path) -> Result<ParticleSet, Failure> {
        match self.single.take() {
            Some(set) => Ok(set),
            None => Ok(limpid_io::read(path)?),
        }
    }

    /// The r of the scene, world units.
    pub fn radius_world(&self) -> f64 {
        self.radius.map_or(EMPTY_RADIUS, |radius| radius.value)
    }

    /// Whether each frame is to be asked for its own radius or radii.
    pub fn radius_in_files(&self) -> bool {
        self.radius.is_some_and(|radius| radius.source == RadiusSource::File)
    }

    /// Which radius was chosen, and why.
    pub fn radius_note(&self) -> Option<String> {
        let radius = self.radius?;
        let source = match radius.source {
            RadiusSource::Option => "given by --radius",
            RadiusSource::File if radius.per_particle => "from the file, the median of each particle's own",
            RadiusSource::File => "from the file",
            RadiusSource::Estimated => "estimated from the spacing",
        };
        Some(format!("radius {} ({source})", short(significant(radius.value))))
    }
}

fn oddities(set: &ParticleSet, options: &Options) -> Vec<String> {
    let mut oddities = set.warnings.clone();
    let wants_density = options.density_threshold.is_some_and(|threshold| threshold > 0.0);
    if wants_density && !set.is_empty() && set.attribute("density").is_none() {
        oddities.push("has no density, so --density-threshold leaves nothing out".into());
    }
    oddities.into_iter().map(|oddity| format!("{}: {oddity}", set.path.display())).collect()
}

/// Refuses a radius that cannot belong to these particles: most likely it is in another unit.
fn check_radius(radius_world: f64, extent: Bounds, set: &ParticleSet) -> Result<(), Failure> {
    let diagonal = (extent.max - extent.min).length();
    if diagonal == 0.0 || radius_world <= diagonal {
        return Ok(());
    }
    let estimate = set.estimate_spacing().map(|spacing| format!("; {} would fit", short(significant(0.5 * spacing))));
    Err(Failure::usage(format!(
        "--radius is {}, but all particles lie within {}{}: give it in the files' unit",
        short(radius_world),
        short(significant(diagonal)),
        estimate.unwrap_or_default()
    )))
}

fn world_positions(set: &ParticleSet) -> impl Iterator<Item = DVec3> {
    let origin = DVec3::from_array(set.origin);
    set.positions.iter().map(move |position| origin + DVec3::from_array(position.map(f64::from)))
}

fn extent_of(set: &ParticleSet) -> Option<Bounds> {
    set.bounds().map(|b| Bounds { min: DVec3::from_array(b.min), max: DVec3::from_array(b.max) })
}

fn union(a: Option<Bounds>, b: Option<Bounds>) -> Option<Bounds> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (a, b) => a.or(b),
    }
}
