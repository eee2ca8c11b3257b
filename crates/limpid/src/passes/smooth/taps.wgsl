// What filters with a Gaussian window share: the ping-pong, and a window that follows the projected particle.

@group(1) @binding(1) var<storage, read> input: array<f32>;
@group(1) @binding(2) var<storage, read_write> output: array<f32>;

// Half-width of the window in standard deviations.
const REACH: f32 = 3.0;

struct Window {
    center: f32,
    falloff: f32, // 1 / (2 sigma^2), per square pixel
    half_px: f32,
    taps: i32, // on each side
    empty: bool, // no fluid, or nothing to smooth with
}

// `sigma_world`: the smoothing length at the pixel.
fn window_around(pixel: TilePixel, sigma_world: f32) -> Window {
    if !pixel.inside {
        return Window(0.0, 0.0, 0.0, 0, true);
    }
    let center = input[pixel.index];
    let sigma = sigma_world * px_per_world(depth_of(center));
    if min(center, sigma) <= 0.0 {
        return Window(center, 0.0, 0.0, 0, true);
    }
    let half = min(REACH * sigma, settings.max_radius_px);
    return Window(center, 0.5 / (sigma * sigma), half, i32(ceil(half)), false);
}

// The share of a tap that the window covers: its border is a fraction of a pixel, so that nothing pops as it grows.
fn border(window: Window, distance: f32) -> f32 {
    return clamp(window.half_px - distance + 1.0, 0.0, 1.0);
}
