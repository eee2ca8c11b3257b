//! How even the raw surface is.

use crate::fluid::Fluid;
use crate::scenes::{SIZE, from_above, marked, slab, stretched};
use limpid::{Anisotropy, Settings};

/// RMS of the raw top of a slab jittered by 0.12 r each way (RMS of each coordinate), seen from above; every pixel is covered.
fn roughness(anisotropy: Anisotropy) -> f64 {
    let settings = Settings { anisotropy, splat_scale: 1.5, ..stretched() };
    let jitter = 0.12 * 3f32.sqrt();
    let drawn = Fluid::new().draw(&marked(slab(18, 8, jitter)), &from_above(24.0), SIZE, &settings);
    let mean = drawn.depth.iter().map(|d| f64::from(*d)).sum::<f64>() / drawn.depth.len() as f64;
    assert!(mean.is_finite(), "the surface has holes");
    let variance: f64 = drawn.depth.iter().map(|d| (f64::from(*d) - mean).powi(2)).sum();
    (variance / drawn.depth.len() as f64).sqrt()
}

#[test]
fn ellipsoids_are_more_even_than_spheres() {
    let spheres = roughness(Anisotropy { enabled: false, ..stretched().anisotropy });
    let still = roughness(Anisotropy { center_smoothing: 0.0, ..stretched().anisotropy });
    let default = roughness(stretched().anisotropy);
    println!("spheres {spheres:.3} r, ellipsoids {still:.3}, with centres smoothed {default:.3}");
    assert!(still < spheres / 2.0);
    assert!(default < spheres / 3.0);
}
