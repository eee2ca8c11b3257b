//! Several samples in a pixel.

use crate::common::{Cloud, above, shot_of, unsmoothed, with_gpu};
use limpid::{Optics, Settings};
use limpid_headless::{Aov, Shot};

#[test]
fn an_outline_covers_parts_of_pixels() {
    const SIZE: [u32; 2] = [64, 64];
    let cloud = Cloud::uniform(vec![[0.013, 0.0, -0.021]], 0.25);
    let settings = Settings { optics: Optics { opaque: true, ..Optics::default() }, ..unsmoothed() };
    let alphas = |samples| {
        let shot = Shot { samples, ..shot_of(&cloud, above(8.0, 1.0, SIZE), SIZE, settings) };
        let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Picture])).unwrap();
        let of_light = picture.aovs[0].values.as_chunks::<4>().0.iter().map(|pixel| f64::from(pixel[3]));
        let of_shown = picture.rgba.as_chunks::<4>().0.iter().map(|pixel| f64::from(pixel[3]) / 255.0);
        (of_light.collect::<Vec<_>>(), of_shown.collect::<Vec<_>>())
    };
    // The ball is drawn 24 pixels in radius; the share of each pixel that its disc covers, by 32 x 32 points.
    let center = [32.0 + 0.013 * 64.0, 32.0 - 0.021 * 64.0];
    let covered = |i: usize| {
        let points = (0..32 * 32).map(|k| [(k % 32) as f64 + 0.5, (k / 32) as f64 + 0.5].map(|v| v / 32.0));
        let inside = points.filter(|[x, y]| {
            let (dx, dy) = ((i % 64) as f64 + x - center[0], (i / 64) as f64 + y - center[1]);
            dx * dx + dy * dy < 24.0 * 24.0
        });
        inside.count() as f64 / 1024.0
    };
    let (one, _) = alphas(1);
    let (light, shown) = alphas(64);
    let worst = |alphas: &[f64]| (0..64 * 64).map(|i| (alphas[i] - covered(i)).abs()).fold(0.0, f64::max);
    println!("worst pixel: {} with one sample, {} with 64", worst(&one), worst(&light));
    assert!(worst(&one) > 0.4, "one sample has steps");
    assert!(worst(&light) < 0.08 && worst(&shown) < 0.08);
}
