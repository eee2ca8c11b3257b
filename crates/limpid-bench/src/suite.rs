//! What is measured.

use limpid::{Filter, Settings, Smoothing};

/// Every combination of these.
#[derive(Clone, Debug, PartialEq)]
pub struct Suite {
    /// How many particles.
    pub particles: Vec<usize>,
    /// Pixels across and down.
    pub sizes: Vec<[u32; 2]>,
    /// Ways of smoothing.
    pub filters: Vec<Filter>,
    /// Whether particles are ellipsoids.
    pub anisotropy: Vec<bool>,
    /// Frames of each that are measured, after one that is not.
    pub runs: usize,
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// How many particles.
    pub particles: usize,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// How the surface is smoothed.
    pub filter: Filter,
    /// Whether particles are ellipsoids.
    pub anisotropy: bool,
}

impl Suite {
    /// From 10 thousand particles to 16 million, at three sizes: for a GPU.
    pub fn full() -> Self {
        Self {
            particles: vec![10_000, 24_360, 97_440, 389_760, 1_023_120, 4_092_480, 16_369_920],
            sizes: vec![[1024, 768], [1920, 1080], [3840, 2160]],
            filters: vec![
                Filter::None,
                Filter::Gaussian,
                Filter::Bilateral,
                Filter::CurvatureFlow,
                Filter::NarrowRange,
            ],
            anisotropy: vec![false, true],
            runs: 11,
        }
    }

    /// What a driver for the CPU does in a minute or two.
    pub fn quick() -> Self {
        Self { particles: vec![10_000, 24_360, 97_440], sizes: vec![[1024, 768]], runs: 5, ..Self::full() }
    }

    /// All cases; those of equal particles follow each other.
    pub fn cases(&self) -> impl Iterator<Item = Case> {
        let sizes = |particles| self.sizes.iter().map(move |size| (particles, *size));
        let filters = move |(particles, size)| self.filters.iter().map(move |filter| (particles, size, *filter));
        let all = self.particles.iter().flat_map(move |particles| sizes(*particles)).flat_map(filters);
        all.flat_map(|(particles, size, filter)| {
            self.anisotropy.iter().map(move |anisotropy| Case { particles, size, filter, anisotropy: *anisotropy })
        })
    }
}

impl Case {
    /// The papers' frame: one sheet, no layers behind it.
    pub(crate) fn settings(&self) -> Settings {
        let smoothing = Smoothing::of(self.filter);
        if self.anisotropy {
            Settings { smoothing: smoothing.for_ellipsoids(), layers: false, ..Settings::default() }
        } else {
            Settings { smoothing, ..Settings::spheres() }
        }
    }
}
