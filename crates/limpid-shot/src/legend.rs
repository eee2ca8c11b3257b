//! A legend in the picture: a bar with the colours, ticks with numbers, what they are and in which unit.

use crate::options::Options;
use crate::tint::{ColorScale, Tint};
use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use limpid_headless::{Aov, Background};

/// Picture heights in a line of text.
const TEXT: f32 = 1.0 / 36.0;
/// Pixels of the smallest text that can be read.
const LEAST_TEXT: f32 = 10.0;
/// Picture heights in the bar.
const BAR: f32 = 0.4;
/// Most ticks along it.
const TICKS: f64 = 6.0;

/// A legend to draw into pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    scale: ColorScale,
    /// Of letters and lines, sRGB.
    ink: u8,
    /// Behind them, sRGB and opacity.
    panel: (u8, f32),
}

/// Pixels of a picture: sRGB with straight alpha.
struct Canvas<'a> {
    rgba: &'a mut [u8],
    size: [u32; 2],
}

/// A rectangle in pixels: left, top, right, bottom.
type Area = [f32; 4];

impl Legend {
    /// The legend of a picture, or of the base colours alone; None: it has none.
    pub fn of(options: &Options, tint: &Tint) -> Option<Self> {
        if !matches!(options.show.map(|show| show.0), None | Some(Aov::Albedo)) {
            return None;
        }
        let scale = tint.scale().filter(|_| options.has_legend())?.clone();
        let (ink, panel) = match options.background() {
            Background::White => (20, (255, 0.75)),
            Background::Black => (235, (0, 0.6)),
            Background::Scene | Background::Transparent => (245, (16, 0.6)),
        };
        Some(Self { scale, ink, panel })
    }

    /// Draws into the picture's upper right corner: sRGB with straight alpha, 4 bytes a pixel.
    pub fn draw(&self, rgba: &mut [u8], size: [u32; 2]) {
        let mut canvas = Canvas { rgba, size };
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).expect("the font that comes with egui");
        let [width, height] = size.map(|side| side as f32);
        let text = (TEXT * height).max(LEAST_TEXT).round();
        let write = Writer { font: &font, px: text };
        let (gap, line) = ((0.5 * text).round(), (0.07 * text).ceil());
        let [bar_width, bar_height] = [text, (BAR * height).max(3.0 * text).round()];
        let ticks = ticks(self.scale.range);
        let title = write.shortened(&self.title(), 0.5 * width);
        let widest = ticks.iter().map(|(_, label)| write.width(label)).fold(0.0, f32::max);
        let inner = (bar_width + gap + widest).max(write.width(&title)).ceil();
        let [right, top] = [width - gap, gap];
        let left = right - inner - 2.0 * gap;
        let bar_top = top + gap + 1.6 * text;
        let panel = [left, top, right, bar_top + bar_height + gap + 0.5 * text];
        canvas.fill(panel, [self.panel.0; 3], self.panel.1);
        write.draw(&mut canvas, &title, [left + gap, top + gap + text], self.ink);
        let bar = [left + gap, bar_top.round(), left + gap + bar_width, bar_top.round() + bar_height];
        canvas.fill([bar[0] - line, bar[1] - line, bar[2] + line, bar[3] + line], [self.ink; 3], 1.0);
        for row in 0..bar_height as u32 {
            let at = 1.0 - (f64::from(row) + 0.5) / f64::from(bar_height);
            let y = bar[1] + row as f32;
            canvas.fill([bar[0], y, bar[2], y + 1.0], self.scale.map.srgb(at), 1.0);
        }
        for (value, label) in &ticks {
            let y = (bar[3] - self.scale.place(*value) as f32 * bar_height - 0.5 * line).round();
            canvas.fill([bar[2], y, bar[2] + 0.6 * gap, y + line], [self.ink; 3], 1.0);
            write.draw(&mut canvas, label, [bar[2] + gap, y + 0.35 * text], self.ink);
        }
    }

    fn title(&self) -> String {
        match &self.scale.unit {
            Some(unit) => format!("{} ({unit})", self.scale.name),
            None => self.scale.name.clone(),
        }
    }
}

/// Round numbers within a range, and how they are written: 1, 2 or 5 times a power of ten apart.
fn ticks(range: [f64; 2]) -> Vec<(f64, String)> {
    let (low, high) = (range[0].min(range[1]), range[0].max(range[1]));
    let least = (high - low) / TICKS;
    let power = 10f64.powf(least.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= least);
    let step = step.unwrap_or(10.0 * power);
    let largest = low.abs().max(high.abs());
    // Digits that tell neighbours apart.
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let digits = (largest.log10().floor() - step.log10().floor()).clamp(0.0, 15.0) as usize;
    let label = |value: f64| {
        let value = if value.abs() < 0.5 * step { 0.0 } else { value };
        let text = match largest {
            _ if value == 0.0 => "0".to_owned(),
            1e-3..1e6 => format!("{value:.decimals$}"),
            _ => format!("{value:.digits$e}"),
        };
        text.replace('-', "\u{2212}")
    };
    // The ends count, whatever rounding makes of them.
    let (first, last) = ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
    let count = (last - first).clamp(0.0, 2.0 * TICKS) as u32;
    (0..=count).map(|i| (first + f64::from(i)) * step).map(|value| (value, label(value))).collect()
}

/// Text of one size.
struct Writer<'a> {
    font: &'a FontRef<'a>,
    px: f32,
}

impl Writer<'_> {
    fn width(&self, text: &str) -> f32 {
        let font = self.font.as_scaled(PxScale::from(self.px));
        text.chars().map(|c| font.h_advance(font.glyph_id(c))).sum()
    }

    /// A text that fits, with dots where it was cut.
    fn shortened(&self, text: &str, width: f32) -> String {
        let mut kept: Vec<char> = text.chars().filter(|c| !c.is_control()).collect();
        let whole = kept.len();
        loop {
            let dots = if kept.len() < whole { "…" } else { "" };
            let shown: String = kept.iter().collect::<String>() + dots;
            if self.width(&shown) <= width || kept.is_empty() {
                return shown;
            }
            kept.pop();
        }
    }

    /// `at`: where the first letter's baseline begins.
    fn draw(&self, canvas: &mut Canvas<'_>, text: &str, at: [f32; 2], ink: u8) {
        let font = self.font.as_scaled(PxScale::from(self.px));
        let mut x = at[0];
        for c in text.chars() {
            let id = font.glyph_id(c);
            let glyph = id.with_scale_and_position(self.px, point(x, at[1]));
            x += font.h_advance(id);
            let Some(outline) = self.font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|column, row, coverage| {
                canvas.blend(
                    [corner.x as i64 + i64::from(column), corner.y as i64 + i64::from(row)],
                    [ink; 3],
                    coverage,
                );
            });
        }
    }
}

impl Canvas<'_> {
    /// Covers whole pixels.
    fn fill(&mut self, area: Area, color: [u8; 3], opacity: f32) {
        let [left, top, right, bottom] = area.map(|edge| edge.round() as i64);
        for y in top..bottom {
            for x in left..right {
                self.blend([x, y], color, opacity);
            }
        }
    }

    /// Lays a colour over a pixel, if it is in the picture.
    fn blend(&mut self, [x, y]: [i64; 2], color: [u8; 3], opacity: f32) {
        let [width, height] = self.size.map(i64::from);
        if x < 0 || y < 0 || x >= width || y >= height {
            return;
        }
        let start = 4 * (y * width + x) as usize;
        let Some(pixel) = self.rgba.get_mut(start..start + 4) else { return };
        let opacity = opacity.clamp(0.0, 1.0);
        let below = f32::from(pixel[3]) / 255.0 * (1.0 - opacity);
        let alpha = opacity + below;
        for (value, new) in pixel.iter_mut().zip(color) {
            let mixed = (opacity * f32::from(new) + below * f32::from(*value)) / alpha.max(1e-6);
            *value = mixed.round() as u8;
        }
        pixel[3] = (255.0 * alpha).round() as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Named;
    use crate::colormap::Colormap;

    const SIZE: [u32; 2] = [640, 360];

    fn tint(range: [f64; 2]) -> Tint {
        Tint::Scale(ColorScale { name: "heat".into(), unit: Some("K".into()), range, map: Colormap::Magma })
    }

    fn drawn(range: [f64; 2], size: [u32; 2]) -> Vec<u8> {
        let mut rgba = vec![0; 4 * (size[0] * size[1]) as usize];
        Legend::of(&Options::default(), &tint(range)).unwrap().draw(&mut rgba, size);
        rgba
    }

    #[test]
    fn ticks_are_round_numbers_of_the_range() {
        let labels = |range: [f64; 2]| ticks(range).into_iter().map(|(_, label)| label).collect::<Vec<_>>().join(" ");
        assert_eq!(labels([0.0, 4.83]), "0 1 2 3 4");
        assert_eq!(labels([4.83, 0.0]), "0 1 2 3 4");
        assert_eq!(labels([-0.35, 0.35]), "−0.2 0 0.2");
        assert_eq!(labels([318.3, 1103.2]), "400 600 800 1000");
        assert_eq!(labels([0.0, 6e-6]), "0 1e−6 2e−6 3e−6 4e−6 5e−6 6e−6");
        assert_eq!(labels([1e9, 1.001e9]), "1.0000e9 1.0002e9 1.0004e9 1.0006e9 1.0008e9 1.0010e9");
        for range in [[0.0, 1e-300], [-1e300, 1e300], [1.0, 1.0 + 1e-12], [7.0, 7.1]] {
            let ticks = ticks(range);
            assert!((2..=8).contains(&ticks.len()), "{range:?}: {ticks:?}");
        }
    }

    #[test]
    fn beside_every_tick_is_the_colour_of_its_number() {
        let range = [-1.0, 5.0];
        let rgba = drawn(range, SIZE);
        let pixel = |x: usize, y: usize| <[u8; 4]>::try_from(&rgba[4 * (y * 640 + x)..][..4]).unwrap();
        let ink = [245, 245, 245, 255];
        // Along its left edge the bar has a line of ink; ticks are ink beyond its right one.
        let text = (TEXT * 360.0_f32).round() as usize;
        let left = (0..640).find(|x| (0..360).filter(|y| pixel(*x, *y) == ink).count() > 100).unwrap() + 1;
        let column = |y: &usize| pixel(left + text + 1, *y) == ink && pixel(left + text + 2, *y) == ink;
        let inside = |y: &usize| pixel(left + 1, *y) != ink;
        let marks: Vec<usize> = (0..360).filter(|y| column(y) && inside(y)).collect();
        let ticks = ticks(range);
        assert_eq!(marks.len(), ticks.len() - 1, "the first is beside the bar's frame");
        for (y, (value, _)) in marks.iter().rev().zip(&ticks[1..]) {
            let expected = Colormap::Magma.srgb((value - range[0]) / 6.0);
            let shown = pixel(left + text / 2, *y);
            // A row of the bar is 1/144 of the map.
            assert!((0..3).all(|k| shown[k].abs_diff(expected[k]) <= 6), "{value}: {shown:?}, not {expected:?}");
        }
    }

    #[test]
    fn a_legend_fits_any_picture() {
        for size in [[1, 1], [16, 9], [4000, 20], [20, 3000]] {
            drawn([0.0, 1.0], size);
        }
        let off = Options { legend: Some(Named(false)), ..Options::default() };
        assert_eq!(Legend::of(&off, &tint([0.0, 1.0])), None);
        assert_eq!(Legend::of(&Options::default(), &Tint::Own), None);
        let depth = Options { show: Some(Named(Aov::Depth)), ..Options::default() };
        assert_eq!(Legend::of(&depth, &tint([0.0, 1.0])), None);
    }
}
