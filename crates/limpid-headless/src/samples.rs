//! Several samples in each pixel: frames whose view is shifted within the pixel, averaged. It smooths silhouettes, highlights and
//! what is seen through the liquid, costs no memory, and leaves every length in pixels as it is.

use crate::{Aov, Image, Picture};

/// Where sample `index` lies in the pixel, from its centre, -0.5 to 0.5 pixels to the right and downwards; the first is the
/// centre. Additive recurrence by the plastic number (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"):
/// even for any number of samples.
pub fn sample_offset_px(index: u32) -> [f64; 2] {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    [1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC)].map(|step| (0.5 + f64::from(index) * step).fract() - 0.5)
}

/// The mean of several pictures of one size. Of buffers that do not mix, such as depth, the first counts.
pub(crate) struct Mean {
    first: Picture,
    /// Linear premultiplied sums of what is shown.
    shown: Vec<[f32; 4]>,
    count: u32,
}

impl Mean {
    pub fn of(first: Picture) -> Self {
        let shown = first.rgba.as_chunks::<4>().0.iter().map(|pixel| premultiplied(*pixel)).collect();
        Self { first, shown, count: 1 }
    }

    /// `aovs`: what `picture` has beside what is shown, all of them mixing.
    pub fn add(&mut self, picture: &Picture, aovs: &[Aov], all: &[Aov]) {
        for (sum, pixel) in self.shown.iter_mut().zip(picture.rgba.as_chunks::<4>().0) {
            let added = premultiplied(*pixel);
            sum.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
        }
        for (aov, image) in aovs.iter().zip(&picture.aovs) {
            let sums = all.iter().zip(&mut self.first.aovs).filter(|(other, _)| *other == aov).map(|(_, image)| image);
            for Image { values, .. } in sums {
                values.iter_mut().zip(&image.values).for_each(|(sum, value)| *sum += value);
            }
        }
        self.count += 1;
    }

    /// The mean; `all` are the first picture's buffers.
    pub fn picture(mut self, all: &[Aov]) -> Picture {
        if self.count == 1 {
            return self.first;
        }
        let share = 1.0 / self.count as f32;
        self.first.rgba = self.shown.iter().flat_map(|sum| straight(sum.map(|value| value * share))).collect();
        for (_, image) in all.iter().zip(&mut self.first.aovs).filter(|(aov, _)| mixes(**aov)) {
            image.values.iter_mut().for_each(|value| *value *= share);
        }
        self.first
    }
}

/// The mean of sRGB pictures with straight alpha of one size, as [`crate::Offscreen::render`] takes it of its samples.
pub fn mean_of(size: [u32; 2], pictures: Vec<Vec<u8>>) -> Vec<u8> {
    let mut pictures = pictures.into_iter().map(|rgba| Picture { size, rgba, aovs: Vec::new() });
    let Some(first) = pictures.next() else { return Vec::new() };
    let mut mean = Mean::of(first);
    pictures.for_each(|picture| mean.add(&picture, &[], &[]));
    mean.picture(&[]).rgba
}

/// Whether the mean over a pixel is what the pixel shows.
pub(crate) fn mixes(aov: Aov) -> bool {
    matches!(aov, Aov::Color | Aov::Picture | Aov::Passage)
}

fn premultiplied([red, green, blue, alpha]: [u8; 4]) -> [f32; 4] {
    let alpha = f32::from(alpha) / 255.0;
    let light = |value: u8| decode(f32::from(value) / 255.0) * alpha;
    [light(red), light(green), light(blue), alpha]
}

fn straight([red, green, blue, alpha]: [f32; 4]) -> [u8; 4] {
    let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
    let shown = |light: f32| byte(encode(light / alpha.max(1e-6)));
    [shown(red), shown(green), shown(blue), byte(alpha)]
}

/// The inverse of the sRGB transfer function.
fn decode(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB transfer function.
pub(crate) fn encode(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(rgba: [u8; 4], aovs: &[f32]) -> Picture {
        let image = |value: &f32| Image { size: [1, 1], channels: 1, values: vec![*value] };
        Picture { size: [1, 1], rgba: rgba.to_vec(), aovs: aovs.iter().map(image).collect() }
    }

    #[test]
    fn samples_are_even_about_the_centre() {
        assert_eq!(sample_offset_px(0), [0.0, 0.0]);
        for count in [4, 9, 16, 64] {
            for axis in 0..2 {
                let mean = (0..count).map(|i| sample_offset_px(i)[axis]).sum::<f64>() / f64::from(count);
                assert!(mean.abs() < 0.5 / f64::from(count).sqrt(), "axis {axis} of {count} samples: {mean}");
            }
        }
    }

    #[test]
    fn light_is_averaged_and_depth_is_not() {
        let all = [Aov::Depth, Aov::Picture];
        let mut mean = Mean::of(picture([0, 0, 0, 255], &[2.0, 1.0]));
        mean.add(&picture([255, 255, 255, 255], &[3.0]), &[Aov::Picture], &all);
        let shown = mean.picture(&all);
        // Half the light of white.
        assert_eq!(shown.rgba, [188, 188, 188, 255]);
        assert_eq!((shown.aovs[0].values[0], shown.aovs[1].values[0]), (2.0, 2.0));
    }

    #[test]
    fn what_is_transparent_has_no_colour_to_give() {
        let mut mean = Mean::of(picture([10, 20, 30, 255], &[]));
        mean.add(&picture([255, 255, 255, 0], &[]), &[], &[]);
        assert_eq!(mean.picture(&[]).rgba, [10, 20, 30, 128]);
    }
}
