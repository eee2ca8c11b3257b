//! What each particle is painted with: a colour, and which of several liquids it is.

use crate::{Absorption, Error, Filter, Optics, Settings};

/// Most liquids in one frame.
pub const MOST_LIQUIDS: usize = 8;

/// A colour and a liquid for each particle; either may be missing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Paint<'a> {
    /// Linear colours, each 0 to 1. Missing: white.
    pub colors: Option<&'a [[f32; 3]]>,
    /// Which liquid each particle is: 0 is [`Settings::optics`], k is place k - 1 of [`Settings::other_liquids`]. Missing: 0.
    pub liquids: Option<&'a [u8]>,
}

/// What the particles' colours do to the liquid's look.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Coloring {
    /// Nothing.
    #[default]
    Off,
    /// They are the base colour of what is scattered, in place of the look's; a clear liquid turns opaque (the "diffuse
    /// texture" of Babylon.js), a metal takes the colour for its reflectance.
    Surface,
    /// They are what white light has become after this depth of liquid in r, 0.01 to 10000: Beer-Lambert absorption in place of the
    /// look's. Channels under 1/255 count as that.
    Absorption(f32),
}

impl Paint<'_> {
    pub(crate) fn check(&self, count: usize) -> Result<(), Error> {
        let bad = |text: String| Err(Error::Particles(text));
        if let Some(len) = self.colors.map(<[_]>::len).filter(|len| *len != count) {
            return bad(format!("{len} colors for {count} positions"));
        }
        if let Some(len) = self.liquids.map(<[_]>::len).filter(|len| *len != count) {
            return bad(format!("{len} numbers of liquids for {count} positions"));
        }
        match self.liquids.and_then(|liquids| liquids.iter().find(|liquid| usize::from(**liquid) >= MOST_LIQUIDS)) {
            Some(liquid) => bad(format!("a particle of liquid {liquid}; there are at most {MOST_LIQUIDS}, from 0")),
            None => Ok(()),
        }
    }

    /// What `paint_sums.wgsl` reads of a particle: red, green, blue, liquid, 16 bits each.
    pub(crate) fn packed(&self, index: usize) -> [u32; 2] {
        let color = self.colors.map_or([1.0; 3], |colors| colors[index]);
        // NaN becomes 0.
        let [r, g, b] = color.map(|value| (value.clamp(0.0, 1.0) * 65535.0 + 0.5) as u32);
        let liquid = self.liquids.map_or(0, |liquids| u32::from(liquids[index]));
        [r | g << 16, b | liquid << 16]
    }

    pub(crate) fn average(&self, count: usize) -> PaintAverage {
        let share = 1.0 / count.max(1) as f64;
        let mut average = PaintAverage { color: [0.0; 3], liquids: [0.0; MOST_LIQUIDS] };
        for index in 0..count {
            let [rg, bl] = self.packed(index);
            let color = [rg & 0xffff, rg >> 16, bl & 0xffff];
            for (sum, value) in average.color.iter_mut().zip(color) {
                *sum += share * f64::from(value) / 65535.0;
            }
            average.liquids[(bl >> 16) as usize] += share;
        }
        average
    }
}

/// Paint of all particles together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PaintAverage {
    pub color: [f64; 3],
    /// Share of each liquid in the particles.
    pub liquids: [f64; MOST_LIQUIDS],
}

impl Settings {
    /// Whether particles are told apart by their [`Paint`].
    pub fn uses_paint(&self) -> bool {
        self.coloring != Coloring::Off || self.liquid_count() > 1
    }

    /// How many liquids there are looks or smoothing lengths for.
    pub fn liquid_count(&self) -> usize {
        let mut others = self.other_liquids.iter().zip(&self.other_strengths);
        let last = others.rposition(|(optics, strength)| optics.is_some() || strength.is_some());
        last.map_or(1, |last| last + 2)
    }

    /// The look of a liquid; that of the first where it has none of its own.
    pub(crate) fn look(&self, liquid: usize) -> &Optics {
        let own = liquid.checked_sub(1).and_then(|other| self.other_liquids.get(other)?.as_ref());
        own.unwrap_or(&self.optics)
    }

    /// The smoothing length of a liquid in r.
    pub(crate) fn strength(&self, liquid: usize) -> f32 {
        let own = liquid.checked_sub(1).and_then(|other| *self.other_strengths.get(other)?);
        own.unwrap_or(self.smoothing.strength)
    }

    /// Whether some liquid is smoothed otherwise than the first.
    pub(crate) fn smooths_liquids_apart(&self) -> bool {
        self.smoothing.filter != Filter::None
            && (1..self.liquid_count()).any(|liquid| self.strength(liquid) != self.smoothing.strength)
    }

    /// What light loses in all liquids stirred together, as far as shadows and caustics are concerned, where r is `radius`.
    pub(crate) fn stirred(&self, average: Option<&PaintAverage>, radius: f32) -> Optics {
        let Some(average) = average.filter(|_| self.uses_paint()) else { return self.optics };
        let mut extinction = [0.0; 3];
        let mut refractive_index = 0.0;
        for (liquid, share) in average.liquids.iter().enumerate() {
            let look = self.colored(self.look(liquid), average.color);
            let own = look.extinction_per_world(radius);
            extinction = [0, 1, 2].map(|k| extinction[k] + share * f64::from(own[k]));
            refractive_index += share * f64::from(look.refractive_index);
        }
        Optics {
            absorption: Absorption::PerWorld(extinction.map(|k| k as f32)),
            scattering: [0.0; 3],
            opaque: false,
            refractive_index: (refractive_index as f32).clamp(1.0, 3.0),
            ..self.optics
        }
    }

    /// A look in one colour.
    fn colored(&self, look: &Optics, color: [f64; 3]) -> Optics {
        match self.coloring {
            Coloring::Off => *look,
            Coloring::Surface => Optics { opaque: look.opaque || look.scattering == [0.0; 3], ..*look },
            Coloring::Absorption(depth) => {
                let absorption = color.map(|c| -c.max(DARKEST).ln() as f32 / depth);
                Optics { absorption: Absorption::PerRadius(absorption), ..*look }
            }
        }
    }
}

/// The darkest channel that absorption makes.
pub(crate) const DARKEST: f64 = 1.0 / 255.0;
