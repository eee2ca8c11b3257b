//! What must be known of all frames before the first is drawn: camera, floor and radius are the same for all of them.

mod findings;

use crate::Error;
use crate::number::{short, significant};
use crate::options::Options;
pub use findings::Findings;
use glam::DVec3;
use limpid::Bounds;
use limpid_io::{ParticleSet, Radius, RadiusSource};
use std::collections::BTreeMap;
use std::sync::Arc;

/// r of a scene without particles, where nothing but the scene's own scale depends on it.
const EMPTY_RADIUS: f64 = 0.1;

/// The frames together: all of them [`Survey::include`]d, then [`Survey::settle`]d.
#[derive(Default)]
pub struct Survey {
    /// Box around the particle centres of all frames but for a few strays; None without particles.
    pub bounds: Option<Bounds>,
    /// Box around all particle centres of all frames.
    pub extent: Option<Bounds>,
    /// What is odd about the files.
    pub warnings: Vec<String>,
    /// Least and greatest number ([`ParticleSet::scalars`]) by what it is of; None: none of them is finite.
    ranges: BTreeMap<String, Option<[f64; 2]>>,
    /// Radius, from the frame with the most particles, the best to estimate one from; None without particles.
    radius: Option<Radius>,
    /// The same where no option says otherwise, once it has been asked for.
    own_radius: Option<Radius>,
    /// That frame.
    largest: Option<Arc<ParticleSet>>,
}

impl Survey {
    /// Of one frame.
    pub fn of(set: &Arc<ParticleSet>, options: &Options) -> Self {
        Self {
            bounds: Bounds::robust(world_positions(set)),
            extent: extent_of(set),
            ranges: ranges_of(set),
            warnings: oddities(set, options),
            largest: Some(Arc::clone(set)),
            ..Self::default()
        }
    }

    /// Takes a frame into account.
    pub fn include(&mut self, set: &Arc<ParticleSet>, options: &Options) {
        self.merge(Self::of(set, options));
    }

    /// Takes other frames into account.
    pub fn merge(&mut self, other: Self) {
        let count = |survey: &Self| survey.largest.as_ref().map(|set| set.len());
        if count(&other) > count(self) {
            (self.largest, self.own_radius) = (other.largest, other.own_radius);
        }
        self.warnings.extend(other.warnings);
        self.bounds = union(self.bounds, other.bounds);
        self.extent = union(self.extent, other.extent);
        for (name, range) in other.ranges {
            let known = self.ranges.entry(name).or_default();
            *known = known.iter().chain(&range).copied().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        }
    }

    /// Decides on the radius by the frames so far. What the files alone say of it is worked out once for each largest frame.
    ///
    /// # Errors
    /// There is no radius, or one that cannot belong to these particles.
    pub fn settle(&mut self, options: &Options) -> Result<(), Error> {
        let Some(set) = self.largest.as_ref().filter(|set| !set.is_empty()) else {
            self.radius = None;
            return Ok(());
        };
        if let (Some(value), Some(extent)) = (options.radius, self.extent) {
            self.radius = Some(set.radius(options.radius)?);
            return check_radius(value, extent, set);
        }
        if self.own_radius.is_none() {
            self.own_radius = Some(set.radius(None)?);
        }
        self.radius = self.own_radius;
        Ok(())
    }

    /// Hands over the frame with the most particles, so that its memory can go, or it need not be read again.
    pub fn take_largest(&mut self) -> Option<Arc<ParticleSet>> {
        self.largest.take()
    }

    /// Whether no frame has any particles.
    pub fn is_empty(&self) -> bool {
        self.extent.is_none()
    }

    /// Whether some frame has this attribute, or a coordinate is meant.
    pub fn has(&self, name: &str) -> bool {
        self.ranges.contains_key(name)
    }

    /// All that particles can be told apart by.
    pub fn names(&self) -> Vec<&str> {
        self.ranges.keys().map(String::as_str).collect()
    }

    /// The least and the greatest of all frames' finite numbers of this name ([`ParticleSet::scalars`]).
    pub fn range(&self, name: &str) -> Option<[f64; 2]> {
        *self.ranges.get(name)?
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

fn ranges_of(set: &ParticleSet) -> BTreeMap<String, Option<[f64; 2]>> {
    let range = |numbers: &mut dyn Iterator<Item = f64>| {
        let finite = numbers.filter(|value| value.is_finite());
        finite.fold(None, |range: Option<[f64; 2]>, value| {
            Some(range.map_or([value; 2], |[low, high]| [low.min(value), high.max(value)]))
        })
    };
    let axes = set.bounds().into_iter().flat_map(|b| [0, 1, 2].map(|k| (["x", "y", "z"][k], [b.min[k], b.max[k]])));
    let axes = axes.map(|(name, range)| (name.to_owned(), Some(range)));
    let attributes = set.attributes.iter().map(|a| (a.name.clone(), range(&mut a.scalars())));
    axes.chain(attributes).collect()
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
fn check_radius(radius_world: f64, extent: Bounds, set: &ParticleSet) -> Result<(), Error> {
    let diagonal = (extent.max - extent.min).length();
    if diagonal == 0.0 || radius_world <= diagonal {
        return Ok(());
    }
    let estimate = set.estimate_spacing().map(|spacing| format!("; {} would fit", short(significant(0.5 * spacing))));
    Err(Error::usage(format!(
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
