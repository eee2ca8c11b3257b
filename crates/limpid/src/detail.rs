//! Detail below the particle size: settings of the advected noise and of the foam made from it.

use crate::settings::within;
use crate::{Error, Scale};

/// Noise and foam that ride with the particles (van der Laan 2009, section 3.4). Off by default, and free then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Height of the ripples in r, RMS over a calm surface of one octave; 0 to 1, default 0: none. 0.05 is lively water.
    pub noise: f32,
    /// Wavelength of the first octave in r, 0.25 to 8, default 2. Ripples too fine for the noise image fade out.
    pub wavelength: f32,
    /// Octaves of noise in each particle's pattern, 1 to 4, default 2; each has half the wavelength and half the height
    /// of the one before.
    pub octaves: u32,
    /// Resolution of the noise image, default half; never finer than the fluid's own ([`crate::Settings::filter_scale`]).
    pub scale: Scale,
    /// How much higher the ripples of a fully agitated particle are: 1 + this times; 0 to 16, default 2.
    pub agitated_gain: f32,
    /// Where foam is.
    pub foam: Foam,
    /// Opacity of full foam, 0 to 1, default 0.9.
    pub foam_opacity: f32,
    /// Linear albedo of foam, each 0 to 1000, default (0.9, 0.93, 0.95).
    pub foam_color: [f32; 3],
    /// [`Foam::Speed`] only: speeds, world units per second, at which foam begins and is full; default 1.8 and 6
    /// (Babylon.js, for metres). If foam would be full before it begins, it begins full.
    pub foam_speed: [f32; 2],
}

/// Where foam is. It lies along the lines at which the noise is 0, so it rides with the particles too: threads where there is
/// little, a mat with holes where there is much; where the noise image cannot hold its lines, an even cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Foam {
    /// Nowhere.
    #[default]
    Off,
    /// Where particles are agitated ([`crate::Agitation`]; van der Laan 2009, Fig. 3).
    Agitation,
    /// Where particles are fast: simple, needs no state (Babylon.js).
    Speed,
}

impl Default for Detail {
    fn default() -> Self {
        Self {
            noise: 0.0,
            wavelength: 2.0,
            octaves: 2,
            scale: Scale::Half,
            agitated_gain: 2.0,
            foam: Foam::Off,
            foam_opacity: 0.9,
            foam_color: [0.9, 0.93, 0.95],
            foam_speed: [1.8, 6.0],
        }
    }
}

impl Detail {
    /// Whether there is anything to draw.
    pub fn is_on(&self) -> bool {
        self.noise > 0.0 || self.foam != Foam::Off
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        within("noise", self.noise, 0.0..=1.0, "from 0 to 1")?;
        within("noise wavelength", self.wavelength, 0.25..=8.0, "from 0.25 to 8")?;
        within("noise octaves", self.octaves as f32, 1.0..=4.0, "from 1 to 4")?;
        within("agitated gain", self.agitated_gain, 0.0..=16.0, "from 0 to 16")?;
        within("foam opacity", self.foam_opacity, 0.0..=1.0, "from 0 to 1")?;
        for value in self.foam_color {
            within("foam color", value, 0.0..=1000.0, "from 0 to 1000")?;
        }
        let [low, high] = self.foam_speed;
        within("speed of the first foam", low, 0.0..=f32::MAX, "0 or more")?;
        within("speed of full foam", high, 0.0..=f32::MAX, "0 or more")
    }
}
