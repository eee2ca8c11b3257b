//! Every knob of the fluid's look. Lengths are in particle radii (r) unless a name says otherwise, so that a scene in
//! millimetres looks like the same scene in metres.

use crate::{Coloring, Detail, Droplet, Error};

/// How the fluid is drawn. `Settings::default()` looks good untouched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Drawn radius over particle radius, 0.5 to 4, default 1.5: at 1 a settled lattice seen from above has holes.
    /// Thickness is normalised, so this never makes a body of liquid look deeper.
    pub splat_scale: f32,
    /// Particles of lower density (in the file's unit) are stray and left out; 0, the default, keeps all
    /// (van der Laan 2009, section 3.1).
    pub density_threshold: f32,
    /// Whether to leave out particles that provably cannot show, default yes: the depth is the same to the bit, sooner.
    /// In the thickness they are spheres.
    pub skip_hidden: bool,
    /// Resolution of the thickness image, default half.
    pub thickness_scale: Scale,
    /// Whether the thickness is blurred within the fluid, default true; false shows the plain sum.
    pub thickness_blur: bool,
    /// Every pixel of the fluid counts as this many r thick, 0.001 to 1000000, and the thickness is neither measured nor
    /// blurred: the cheap mode of Babylon.js. None, the default: the fluid's own thickness.
    pub fixed_thickness: Option<f32>,
    /// Where the fluid is thinner than this many r the background shows; 0, the default, shows all fluid.
    pub min_thickness: f32,
    /// How particles are stretched along the surface.
    pub anisotropy: Anisotropy,
    /// How the surface is smoothed.
    pub smoothing: Smoothing,
    /// Resolution at which the fluid is splatted, smoothed and shaded, default full; the shaded colour is blended up to
    /// the picture's (van der Laan 2009, section 3.5.1).
    pub filter_scale: Scale,
    /// Whether light is followed through the back of the first sheet of liquid too, and on to what lies beyond the air behind it:
    /// more liquid, or the scene; default yes. Where the picture lacks what the light meets, the
    /// [`crate::Environment`] stands in. Gaps of less than 3 r are no air. One texel for each 2 x 2 pixels, or as
    /// coarse as `filter_scale`; a pixel where there is no refraction.
    pub layers: bool,
    /// Neighbouring pixels farther apart than this many r belong to different sheets when normals are taken;
    /// default 3.
    pub normal_step: f32,
    /// Noise and foam on the surface.
    pub detail: Detail,
    /// How foam, spray and bubbles that are particles of their own look ([`crate::Particles::set_droplets`]).
    pub droplet: Droplet,
    /// What light does in and on the liquid.
    pub optics: Optics,
    /// Looks of the liquids after the first ([`crate::Paint::liquids`]); None: as the first. Default: there is one liquid.
    // A literal: rustc 1.95 fails on the constant here.
    pub other_liquids: [Option<Optics>; 7],
    /// Smoothing lengths of the liquids after the first in r, 0 to 20, in place of [`Smoothing::strength`]; None, the default:
    /// that. One filter smooths all liquids as one surface, by what their shares at each pixel mix to.
    pub other_strengths: [Option<f32>; 7],
    /// What the particles' colours ([`crate::Paint::colors`]) do, default nothing.
    pub coloring: Coloring,
    /// What shading computes, default the colour.
    pub shading: Shading,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            splat_scale: 1.5,
            density_threshold: 0.0,
            skip_hidden: true,
            thickness_scale: Scale::Half,
            thickness_blur: true,
            fixed_thickness: None,
            min_thickness: 0.0,
            anisotropy: Anisotropy::default(),
            smoothing: Smoothing::default().for_ellipsoids(),
            filter_scale: Scale::Full,
            layers: true,
            normal_step: 3.0,
            detail: Detail::default(),
            droplet: Droplet::default(),
            optics: Optics::default(),
            other_liquids: [None; 7],
            other_strengths: [None; 7],
            coloring: Coloring::default(),
            shading: Shading::default(),
        }
    }
}

impl Settings {
    /// The defaults for particles drawn as spheres: the look of the 2009 paper.
    pub fn spheres() -> Self {
        let anisotropy = Anisotropy { enabled: false, ..Anisotropy::default() };
        Self { anisotropy, smoothing: Smoothing::default(), layers: false, ..Self::default() }
    }

    /// Smoothing lengths where balls are spheres over those where they are ellipsoids.
    pub(crate) fn sphere_factor(&self) -> f32 {
        if self.anisotropy.enabled { 1.0 / Smoothing::ELLIPSOIDS_SHARE } else { 1.0 }
    }

    /// Resolution of what [`Self::layers`] finds behind the front surface: bent light hides that it is coarse. Without a
    /// bend every pixel has its own, since its picture is composited over other backgrounds then.
    pub(crate) fn layers_scale(&self) -> Scale {
        let is_bent = self.optics.refraction > 0.0;
        if is_bent && self.filter_scale == Scale::Full { Scale::Half } else { self.filter_scale }
    }
}

/// What of the light [`crate::FrameBuffers::shaded`] holds, premultiplied by how much of the pixel is fluid.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shading {
    /// The fluid as it is seen.
    #[default]
    Color,
    /// The share of red, green and blue light that goes straight through the body of liquid along the view ray (Beer and
    /// Lambert), surfaces left aside; the last channel is the coverage.
    Transmittance,
    /// The base colour of what the liquid scatters; 0 for a clear one. The last channel is the coverage.
    Albedo,
    /// Shares of the first three liquids ([`Settings::other_liquids`]) at the surface; of all of them they sum to 1. The last channel is
    /// the coverage.
    Liquids,
}

/// Ellipsoids in place of spheres (Xu et al. 2022, after Yu and Turk 2013): each particle is stretched along the surface as
/// its neighbours lie, with its volume kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anisotropy {
    /// Whether to, default yes; else particles are spheres ([`Settings::spheres`]). Ellipsoids want less smoothing:
    /// [`Smoothing::for_ellipsoids`].
    pub enabled: bool,
    /// Largest ratio of a ball's longest axis to its shortest, 1 to 16, default 4 (Xu et al. 2022, section 4.2).
    pub kappa: f32,
    /// Neighbours are particles within this many of a particle's own radius, 2 to 12, default 5.3: a particle at rest has
    /// about 70 there. Wider is smoother, but the surface then lags behind what moves. A particle of more than twice the
    /// median radius looks no farther than one of twice the median.
    pub support: f32,
    /// Particles with fewer neighbours turn round, wholly so at half as many; 1 to 200, default 22 (20 and 25 in the two
    /// papers). Neighbours count by their weight: as one on average, as nothing at the support's edge, so that none pops.
    pub min_neighbours: f32,
    /// How far centres move to where the mean of their neighbours has them, which evens the surface out; 0 to 1, default 1
    /// (lambda of Yu and Turk 2013, Eq. 6, but a flat surface is not drawn in).
    pub center_smoothing: f32,
    /// Particles of a smaller radius than this in the picture, 0 to 1000 pixels, default 1.5, are spheres, and smoothed as
    /// spheres are, by the strength / [`Smoothing::ELLIPSOIDS_SHARE`]: their shape is nothing to see and costs most of the time
    /// where there are millions. From here to 4/3 of it they turn into ellipsoids. 0: all are.
    pub min_radius_px: f32,
}

impl Default for Anisotropy {
    fn default() -> Self {
        Self {
            enabled: true,
            kappa: 4.0,
            support: 5.3,
            min_neighbours: 22.0,
            center_smoothing: 1.0,
            min_radius_px: 1.5,
        }
    }
}

/// Resolution of an image relative to the picture's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scale {
    /// Every pixel.
    Full,
    /// One texel for 2 x 2 pixels.
    Half,
    /// One texel for 4 x 4 pixels.
    Quarter,
}

impl Scale {
    /// Pixels along one side of a texel: 1, 2 or 4.
    pub const fn divisor(self) -> u32 {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Quarter => 4,
        }
    }

    /// Size in texels of an image that covers `size` pixels.
    pub const fn of(self, size: [u32; 2]) -> [u32; 2] {
        [size[0].div_ceil(self.divisor()), size[1].div_ceil(self.divisor())]
    }
}

/// A way of smoothing the depth image.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The splats as they are.
    None,
    /// A plain Gaussian over all fluid pixels, across silhouettes too: the papers' baseline.
    Gaussian,
    /// A Gaussian over the picture times one over depth, in two passes along the axes
    /// (Green 2010, "Screen Space Fluid Rendering for Games").
    Bilateral,
    /// Van der Laan et al. 2009, "Screen Space Fluid Rendering with Curvature Flow".
    CurvatureFlow,
    /// Truong and Yuksel 2018, "A Narrow-Range Filter for Screen-Space Fluid Rendering".
    #[default]
    NarrowRange,
}

impl Filter {
    /// What the program's options and reports call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Gaussian => "gaussian",
            Self::Bilateral => "bilateral",
            Self::CurvatureFlow => "curvature-flow",
            Self::NarrowRange => "narrow-range",
        }
    }
}

/// How curvature flow advances in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CurvatureFlow {
    /// A few semi-implicit steps, stable at any length: each solves whole rows, then columns, or the other way round.
    #[default]
    Implicit,
    /// Many explicit steps, as in the paper. A step is never longer than is stable at its pixel, so that a large strength
    /// is the paper's form, whose iterations smooth by pixels: 100 of them by some 7.
    Explicit,
}

/// Settings of the smoothing pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    /// Which filter.
    pub filter: Filter,
    /// Smoothing length in r, 0 to 20, for spheres 1.6 by default (Gaussian 1.3, bilateral 1.5, curvature flow 2.1), for ellipsoids
    /// [`Smoothing::ELLIPSOIDS_SHARE`] of it: the standard deviation of the filter's Gaussian over the surface, the same
    /// meaning for every filter.
    pub strength: f32,
    /// How often the filter is applied, 1 to 1000, default 2 (Gaussian and bilateral: 1, curvature flow: 9, or 100 in the explicit form). They
    /// share the smoothing length: more of them do not smooth more.
    pub iterations: u32,
    /// Largest half-width of the filter in pixels, 1 to 256, default 100: bounds the cost of a close-up.
    pub max_radius_px: u32,
    /// What belongs to one surface, in r. Narrow-range: depths within this of the surface already accepted, default 3.
    /// Bilateral: the standard deviation of its Gaussian over depth, default 6. Curvature flow: neighbouring pixels within
    /// this, default 10.
    pub range: f32,
    /// Narrow-range only: samples behind the range count as this many r behind the centre; default 1.5.
    pub clamp: f32,
    /// Bilateral only: the exact filter in two dimensions instead of its two passes; slow, to compare with. Default off.
    pub exact_2d: bool,
    /// Curvature flow only: how it advances in time, default implicit.
    pub curvature_flow: CurvatureFlow,
}

impl Default for Smoothing {
    fn default() -> Self {
        Self::of(Filter::default())
    }
}

impl Smoothing {
    /// Share of a filter's default strength that makes ellipsoids ([`Anisotropy`]) about as smooth as all of it makes
    /// spheres.
    pub const ELLIPSOIDS_SHARE: f32 = 0.5;

    /// These settings, meant for spheres, as ellipsoids want them.
    pub fn for_ellipsoids(self) -> Self {
        Self { strength: Self::ELLIPSOIDS_SHARE * self.strength, ..self }
    }

    /// The defaults of one filter for spheres, chosen by docs/quality.md's figures. Narrow-range goes twice over the picture: once
    /// leaves streaks along the axes where a sheet is thin.
    pub const fn of(filter: Filter) -> Self {
        let narrow_range = Self {
            filter,
            strength: 1.6,
            iterations: 2,
            max_radius_px: 100,
            range: 3.0,
            clamp: 1.5,
            exact_2d: false,
            curvature_flow: CurvatureFlow::Implicit,
        };
        match filter {
            Filter::None => Self { iterations: 1, ..narrow_range },
            Filter::NarrowRange => narrow_range,
            Filter::Gaussian => Self { strength: 1.3, iterations: 1, ..narrow_range },
            Filter::Bilateral => Self { strength: 1.5, iterations: 1, range: 6.0, ..narrow_range },
            Filter::CurvatureFlow => Self::flow(CurvatureFlow::Implicit),
        }
    }

    /// One iteration's share of the strength: variances add up.
    pub(crate) fn per_iteration(&self) -> f32 {
        1.0 / (self.iterations as f32).sqrt()
    }

    /// The defaults of one form of curvature flow.
    pub const fn flow(form: CurvatureFlow) -> Self {
        let iterations = match form {
            CurvatureFlow::Implicit => 9,
            CurvatureFlow::Explicit => 100,
        };
        Self {
            filter: Filter::CurvatureFlow,
            strength: 2.1,
            iterations,
            range: 10.0,
            curvature_flow: form,
            ..Self::of(Filter::None)
        }
    }
}

/// The liquid's optics (van der Laan 2009, Eq. 13-15, with the exact dielectric Fresnel term).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optics {
    /// Index of refraction, 1 to 3, default 1.333 (water).
    pub refractive_index: f32,
    /// How the index decides what is reflected, default exact.
    pub fresnel: Fresnel,
    /// Reflectance of a metal's surface at normal incidence, by Schlick's formula towards grazing angles; each 0 to 1,
    /// default 0: no metal, reflectance by the index.
    pub metal: [f32; 3],
    /// What blurs mirror images of the surroundings: ripples too fine to see. 0 to 1, default 0.1; its square is the
    /// alpha of the GGX distribution (Walter et al. 2007).
    pub roughness: f32,
    /// Beer-Lambert absorption of red, green and blue; default (0.045, 0.015, 0.0075) per r.
    pub absorption: Absorption,
    /// How much of red, green and blue is scattered instead, in the unit of the absorption; each 0 or more, default 0: a
    /// clear liquid. Scattered light is replaced by what falls in from around, so that milk is white.
    pub scattering: [f32; 3],
    /// Base colour of what is scattered, and of an opaque liquid; each 0 to 1, default 1.
    pub albedo: [f32; 3],
    /// Whether nothing shines through, however thin the liquid, default no.
    pub opaque: bool,
    /// Linear light that a body of liquid sends out by itself where it is so deep that nothing shines through: C_fluid of
    /// Eq. 14; each 0 to 1000, default (0.007, 0.048, 0.085).
    pub color: [f32; 3],
    /// gamma of Eq. 15: how much of Snell's bend the background is shifted by; 0 to 4, default 0.5.
    pub refraction: f32,
    /// k_s of Eq. 13: strength of the sun's highlight, 0 to 4, default 1.
    pub specular: f32,
    /// alpha of Eq. 13: the highlight's exponent, 1 to 4096, default 300; higher is smaller and sharper.
    pub shininess: f32,
}

impl Default for Optics {
    fn default() -> Self {
        Self {
            refractive_index: 1.333,
            fresnel: Fresnel::default(),
            metal: [0.0; 3],
            roughness: 0.1,
            absorption: Absorption::PerRadius([0.045, 0.015, 0.0075]),
            scattering: [0.0; 3],
            albedo: [1.0; 3],
            opaque: false,
            color: [0.007, 0.048, 0.085],
            refraction: 0.5,
            specular: 1.0,
            shininess: 300.0,
        }
    }
}

/// Reflectance of an interface between air and liquid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Fresnel {
    /// Fresnel's equations for unpolarised light.
    #[default]
    Exact,
    /// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", Eq. 15.
    Schlick,
}

/// Beer-Lambert absorption coefficients of red, green and blue, each 0 or more, and their unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absorption {
    /// Per particle radius of depth: the same look whatever the scene's unit.
    PerRadius([f32; 3]),
    /// Per world unit of depth: a physical liquid.
    PerWorld([f32; 3]),
}

impl Settings {
    /// Refuses values outside their documented ranges.
    ///
    /// # Errors
    /// [`Error::Setting`] for the first such value.
    pub fn check(&self) -> Result<(), Error> {
        let Self { anisotropy, smoothing, .. } = self;
        within("splat scale", self.splat_scale, 0.5..=4.0, "from 0.5 to 4")?;
        within("density threshold", self.density_threshold, 0.0..=f32::MAX, "0 or more")?;
        within("min thickness", self.min_thickness, 0.0..=f32::MAX, "0 or more")?;
        if let Some(thickness) = self.fixed_thickness {
            within("fixed thickness", thickness, 0.001..=1e6, "from 0.001 to 1000000")?;
        }
        within("normal step", self.normal_step, 0.01..=1000.0, "from 0.01 to 1000")?;
        within("kappa", anisotropy.kappa, 1.0..=16.0, "from 1 to 16")?;
        within("support", anisotropy.support, 2.0..=12.0, "from 2 to 12")?;
        within("min neighbours", anisotropy.min_neighbours, 1.0..=200.0, "from 1 to 200")?;
        within("center smoothing", anisotropy.center_smoothing, 0.0..=1.0, "from 0 to 1")?;
        within("min radius", anisotropy.min_radius_px, 0.0..=1000.0, "from 0 to 1000 pixels")?;
        within("strength", smoothing.strength, 0.0..=20.0, "from 0 to 20")?;
        for strength in self.other_strengths.into_iter().flatten() {
            within("strength of a liquid", strength, 0.0..=20.0, "from 0 to 20")?;
        }
        within("iterations", smoothing.iterations as f32, 1.0..=1000.0, "from 1 to 1000")?;
        within("max radius", smoothing.max_radius_px as f32, 1.0..=256.0, "from 1 to 256")?;
        within("range", smoothing.range, 0.01..=1000.0, "from 0.01 to 1000")?;
        within("clamp", smoothing.clamp, 0.0..=1000.0, "from 0 to 1000")?;
        self.detail.check()?;
        self.droplet.check()?;
        if let Coloring::Absorption(depth) = self.coloring {
            within("depth of colors", depth, 0.01..=1e4, "from 0.01 to 10000")?;
        }
        self.other_liquids.iter().flatten().chain([&self.optics]).try_for_each(Optics::check)
    }
}

impl Optics {
    fn check(&self) -> Result<(), Error> {
        let optics = self;
        within("refractive index", optics.refractive_index, 1.0..=3.0, "from 1 to 3")?;
        let (Absorption::PerRadius(absorption) | Absorption::PerWorld(absorption)) = optics.absorption;
        for value in absorption {
            within("absorption", value, 0.0..=f32::MAX, "0 or more")?;
        }
        for value in optics.scattering {
            within("scattering", value, 0.0..=f32::MAX, "0 or more")?;
        }
        for value in optics.albedo {
            within("albedo", value, 0.0..=1.0, "from 0 to 1")?;
        }
        for value in optics.metal {
            within("metal", value, 0.0..=1.0, "from 0 to 1")?;
        }
        within("roughness", optics.roughness, 0.0..=1.0, "from 0 to 1")?;
        for value in optics.color {
            within("color", value, 0.0..=1000.0, "from 0 to 1000")?;
        }
        within("refraction", optics.refraction, 0.0..=4.0, "from 0 to 4")?;
        within("specular", optics.specular, 0.0..=4.0, "from 0 to 4")?;
        within("shininess", optics.shininess, 1.0..=4096.0, "from 1 to 4096")
    }

    /// Scattering coefficients per world unit for particles of this radius.
    pub(crate) fn scattering_per_world(&self, radius: f32) -> [f32; 3] {
        self.scattering.map(|k| k / self.absorption.unit(radius))
    }

    /// What a shadow loses of the light per world unit; opaque liquids let nothing of note through a ball.
    pub(crate) fn extinction_per_world(&self, radius: f32) -> [f32; 3] {
        let (absorption, scattering) = (self.absorption.per_world(radius), self.scattering_per_world(radius));
        std::array::from_fn(|i| if self.opaque { 4.0 / radius } else { absorption[i] + scattering[i] })
    }
}

impl Absorption {
    /// Coefficients per world unit for particles of this radius.
    pub(crate) fn per_world(self, radius: f32) -> [f32; 3] {
        let (Self::PerRadius(rgb) | Self::PerWorld(rgb)) = self;
        rgb.map(|k| k / self.unit(radius))
    }

    /// World units of depth that the coefficients are for.
    fn unit(self, radius: f32) -> f32 {
        match self {
            Self::PerRadius(_) => radius,
            Self::PerWorld(_) => 1.0,
        }
    }
}

/// NaN is within nothing.
pub(crate) fn within(
    name: &'static str,
    value: f32,
    range: std::ops::RangeInclusive<f32>,
    text: &'static str,
) -> Result<(), Error> {
    if range.contains(&value) { Ok(()) } else { Err(Error::Setting { name, value: value.into(), range: text }) }
}
