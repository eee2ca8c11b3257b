//! What is seen in the window, pixel by pixel.

use crate::common::{Folder, cube};
use crate::desktop::{CTRL, Desktop, TAP, wait_for};
use crate::user::Viewer;
use image::{RgbImage, RgbaImage};

/// The two greys of the checkerboard behind transparent pictures.
const CHECKS: [u8; 2] = [105, 150];

/// Steps of 255 by which roundings differ: the screen's, and the dithering of the checkerboard.
const ROUNDING: i32 = 2;

/// A picture that fills its room is seen as it is saved, on a checkerboard where it is transparent.
#[test]
fn the_screen_shows_the_picture_pixel_by_pixel() {
    for background in ["scene", "transparent"] {
        let folder = Folder::new();
        folder.write_pos("cube.pos", &cube(6, 0.0));
        let desktop = Desktop::new();
        let viewer = Viewer::open(&desktop, &folder, &["cube.pos", "--background", background]);
        desktop.press(&[CTRL, 's'.into()], TAP);
        let path = folder.path("limpid_0001.png");
        wait_for("the saved picture", || path.is_file().then_some(()));
        let saved = image::open(path).unwrap().to_rgba8();
        // Below the bar, whose height is egui's matter.
        let is_seen = || (20..60).any(|top| shows(&desktop.picture(viewer.window), &saved, top));
        wait_for("the same on the screen", || is_seen().then_some(()));
    }
}

/// Whether the screen has what was saved, from so far below its top on.
fn shows(seen: &RgbImage, saved: &RgbaImage, top: u32) -> bool {
    saved.enumerate_pixels().all(|(x, y, pixel)| {
        let (seen, [red, green, blue, alpha]) = (seen.get_pixel(x, top + y).0, pixel.0);
        CHECKS.iter().any(|check| {
            let over = |c: u8| (i32::from(c) * i32::from(alpha) + i32::from(*check) * (255 - i32::from(alpha))) / 255;
            let expected = [over(red), over(green), over(blue)];
            (0..3).all(|c| (i32::from(seen[c]) - expected[c]).abs() <= ROUNDING)
        })
    })
}
