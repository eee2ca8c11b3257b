//! Foam, spray and bubbles as particles of their own, beside those of the fluid.

use crate::settings::within;
use crate::{Error, Radius};

/// Where droplets belong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DropletKind {
    /// On the surface: those up to [`FOAM_AFLOAT`] r behind it are still before it.
    Foam,
    /// In the air.
    Spray,
    /// In the liquid: those up to [`BUBBLES_UNDER`] r before the surface are still behind it.
    Bubbles,
}

impl DropletKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Foam, Self::Spray, Self::Bubbles];
}

/// How far foam floats up, in r.
pub const FOAM_AFLOAT: f32 = 2.0;
/// How far bubbles are kept down, in r.
pub const BUBBLES_UNDER: f32 = 1.0;

/// Droplets of one kind, as foam generators make them. Arrays of the host's, not copied.
#[derive(Clone, Copy, Debug)]
pub struct Droplets<'a> {
    /// What they are.
    pub kind: DropletKind,
    /// Positions in the local space of the fluid's particles, world units. Those that are not finite are not drawn.
    pub positions: &'a [[f32; 3]],
    /// Radii, world units; those that are not finite and above 0 are not drawn.
    pub radius: Radius<'a>,
    /// World units per second: droplets are stretched along their way during [`Droplet::shutter`]. Missing: all are round.
    pub velocities: Option<&'a [[f32; 3]]>,
    /// Seconds that each has left: it fades out in the last [`Droplet::fade`]. Missing: none fades.
    pub life: Option<&'a [f32]>,
}

/// How droplets are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Droplet {
    /// Opacity in the middle of one that does not move, 0 to 0.99, default 0.9.
    pub opacity: f32,
    /// Seconds for which the picture is exposed, 0 to 1000, default 0.006: drops stay drops.
    pub shutter: f32,
    /// Seconds before the end of its life in which a droplet fades, 0 to 1000000, default 0.5.
    pub fade: f32,
    /// Linear colour in full light, each 0 to 1000, default (0.9, 0.93, 0.95).
    pub color: [f32; 3],
}

impl Default for Droplet {
    fn default() -> Self {
        Self { opacity: 0.9, shutter: 0.006, fade: 0.5, color: [0.9, 0.93, 0.95] }
    }
}

impl Droplet {
    pub(crate) fn check(&self) -> Result<(), Error> {
        within("droplet opacity", self.opacity, 0.0..=0.99, "from 0 to 0.99")?;
        within("shutter", self.shutter, 0.0..=1000.0, "from 0 to 1000 seconds")?;
        within("droplet fade", self.fade, 0.0..=1e6, "from 0 to 1000000 seconds")?;
        self.color.iter().try_for_each(|value| within("droplet color", *value, 0.0..=1000.0, "from 0 to 1000"))
    }
}

impl Droplets<'_> {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let count = self.positions.len();
        let radii = match self.radius {
            Radius::Uniform(_) => None,
            Radius::Each(radii) => Some(radii.len()),
        };
        let lengths =
            [("radii", radii), ("velocities", self.velocities.map(<[_]>::len)), ("lives", self.life.map(<[_]>::len))];
        match lengths.into_iter().find(|(_, len)| len.is_some_and(|len| len != count)) {
            Some((what, len)) => {
                Err(Error::Particles(format!("{} {what} for {count} droplets", len.unwrap_or_default())))
            }
            None => Ok(()),
        }
    }

    /// What `droplets_splat.wgsl` reads of each that can be drawn.
    pub(crate) fn packed(&self) -> impl Iterator<Item = PackedDroplet> {
        let kind = match self.kind {
            DropletKind::Foam => 0.0,
            DropletKind::Spray => 1.0,
            DropletKind::Bubbles => 2.0,
        };
        let packed = move |(index, place): (usize, &[f32; 3])| {
            let radius = match self.radius {
                Radius::Uniform(radius) => radius,
                Radius::Each(radii) => radii[index],
            };
            // The square of a radius must stay a normal float32.
            let usable = radius > 1e-18 && radius < 1e18 && place.iter().all(|x| x.is_finite());
            let velocity = self.velocities.map_or([0.0; 3], |v| v[index]);
            let velocity = velocity.map(|x| if x.is_finite() { x } else { 0.0 });
            // A life that nobody knows of does not end.
            let life = self.life.map_or(LONGEST_LIFE, |life| life[index]);
            let life = if life.is_nan() { LONGEST_LIFE } else { life.clamp(0.0, LONGEST_LIFE) };
            let [life, kind] = [life, kind].map(|value| u32::from(half::f16::from_f32(value).to_bits()));
            let droplet = PackedDroplet { place: *place, radius, velocity, life_kind: life | kind << 16 };
            usable.then_some(droplet)
        };
        self.positions.iter().enumerate().filter_map(packed)
    }
}

/// Seconds; the most that an f16 holds, about.
const LONGEST_LIFE: f32 = 65000.0;

/// `droplets_splat.wgsl`'s `Droplet`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct PackedDroplet {
    pub place: [f32; 3],
    pub radius: f32,
    pub velocity: [f32; 3],
    /// Two f16.
    pub life_kind: u32,
}
