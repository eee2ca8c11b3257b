//! Colours for numbers: maps whose every step looks as large as the next.

use limpid_mesh::linear_of_srgb;

/// A perceptually even map from 0..1 to colours, dark to light, by the `colorous` crate's tables. The first four are those of matplotlib
/// (van der Walt and Smith 2015); cividis looks the same to those who see no red or no green (Nuñez et al. 2018).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colormap {
    /// Blue to yellow by green.
    #[default]
    Viridis,
    /// Black to pale yellow by purple.
    Magma,
    /// Black to pale yellow by red.
    Inferno,
    /// Blue to yellow by red.
    Plasma,
    /// Blue to yellow by grey.
    Cividis,
}

impl Colormap {
    /// The colour as screens show it (sRGB); what lies outside of 0..1 has the colour of that end.
    pub fn srgb(self, at: f64) -> [u8; 3] {
        let gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Magma => colorous::MAGMA,
            Self::Inferno => colorous::INFERNO,
            Self::Plasma => colorous::PLASMA,
            Self::Cividis => colorous::CIVIDIS,
        };
        gradient.eval_continuous(at).as_array()
    }

    /// The same as light, each 0 to 1.
    pub fn linear(self, at: f64) -> [f32; 3] {
        self.srgb(at).map(|byte| linear_of_srgb(f32::from(byte) / 255.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;

    /// CIE 1976 L*a*b* of linear sRGB under D65.
    fn lab(rgb: [f32; 3]) -> [f64; 3] {
        let [r, g, b] = rgb.map(f64::from);
        let f = |t: f64| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
        let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
        let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
        let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn every_map_grows_lighter_evenly() {
        for (name, map) in Colormap::ALL {
            let lightness: Vec<f64> = (0..=10).map(|i| lab(map.linear(f64::from(i) / 10.0))[0]).collect();
            let steps: Vec<f64> = lightness.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let mean = steps.iter().sum::<f64>() / 10.0;
            for step in &steps {
                assert!((0.6..1.5).contains(&(step / mean)), "{name}: {steps:.1?}");
            }
            assert_eq!([map.srgb(-3.0), map.srgb(7.0)], [map.srgb(0.0), map.srgb(1.0)], "{name}");
        }
    }
}
