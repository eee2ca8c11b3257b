//! The bar above the picture: saving, undo and redo, comparing.

use crate::chromium::Chromium;
use crate::layout::{COMPARE, MIDDLE, REDO, ROOM_WIDTH, SAVE, SAVE_COMMAND, SAVE_PICTURE, SAVE_SETTINGS, UNDO};
use crate::picture::{Folder, limpid};
use crate::restore;
use std::path::Path;
use std::process::Command;

/// Each entry gives what is shown: the picture, the settings, and a command line that makes the picture.
pub fn what_is_shown_can_be_saved(page: &mut Chromium) {
    restore(page);
    let folder = Folder::new("saved");
    page.permit(&folder.0);
    let shown = page.picture();
    let mut choose = |entry: (f64, f64)| {
        page.click(SAVE);
        page.pause(300);
        page.click(entry);
    };
    choose(SAVE_PICTURE);
    assert!(image::load_from_memory(&arrived(&folder.0.join("limpid.png"))).unwrap().to_rgba8() == shown);
    choose(SAVE_SETTINGS);
    let settings = String::from_utf8(arrived(&folder.0.join("shot.toml"))).unwrap();
    choose(SAVE_COMMAND);
    assert_eq!(settings, page.text("viewer.toml()"));
    let line = page.text("navigator.clipboard.readText()");
    assert!(line.starts_with("limpid render ") && line.lines().count() == 1, "{line}");
    // The page knows its files by their names alone.
    let (program, [first, ..]) = limpid();
    std::fs::copy(first, folder.0.join("jet_32.bgeo")).unwrap();
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(line.replacen("limpid", &program.display().to_string(), 1)).current_dir(&folder.0);
    assert!(shell.output().unwrap().status.success(), "{line}");
    let made = image::open(folder.0.join("picture.png")).unwrap().to_rgba8();
    let differ = made.pixels().zip(shown.pixels()).filter(|(a, b)| (0..4).any(|c| a.0[c].abs_diff(b.0[c]) > 6)).count();
    assert!(made.dimensions() == shown.dimensions() && differ * 100 < shown.pixels().count(), "{differ} pixels differ");
}

/// A download, once it is whole.
fn arrived(path: &Path) -> Vec<u8> {
    for _ in 0..600 {
        if let Ok(bytes) = std::fs::read(path)
            && !bytes.is_empty()
        {
            return bytes;
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    panic!("{} has not come", path.display());
}

pub fn steps_can_be_taken_back_and_again(page: &mut Chromium) {
    restore(page);
    page.run(&format!("viewer.setToml({:?})", crate::SHOT.replace("pool", "milk")));
    page.wait("viewer.isSettled && viewer.toml().includes('\"milk\"')");
    let milk = page.text("viewer.toml()");
    page.click(MIDDLE);
    page.key("z", 2, 30);
    page.wait("viewer.isSettled && viewer.toml().includes('\"pool\"')");
    page.key("z", 10, 30);
    page.wait("viewer.isSettled && viewer.toml().includes('\"milk\"')");
    assert_eq!(page.text("viewer.toml()"), milk);
    page.click(UNDO);
    page.wait("viewer.isSettled && viewer.toml().includes('\"pool\"')");
    page.click(REDO);
    page.wait("viewer.isSettled && viewer.toml().includes('\"milk\"')");
}

/// The kept settings stay left of the line, wherever it is.
pub fn two_settings_can_be_compared(page: &mut Chromium) {
    restore(page);
    page.click(COMPARE);
    page.run(&format!("viewer.setToml({:?})", crate::SHOT.replace("pool", "milk")));
    page.wait("viewer.isSettled && viewer.toml().includes('\"milk\"')");
    let middle = 0.5 * ROOM_WIDTH;
    let split = screen_with_line(page, middle);
    // Where the picture has no line: over the whole of a third of it.
    page.drag((middle, 500.0), (0.25 * ROOM_WIDTH, 500.0));
    let moved = screen_with_line(page, 0.25 * ROOM_WIDTH);
    // The picture is scaled to its room: its parts by other numbers than the whole.
    let is_other = |(x, y): &(u32, u32)| {
        let (a, b) = (split.get_pixel(*x, *y), moved.get_pixel(*x, *y));
        (0..3).any(|c| a.0[c].abs_diff(b.0[c]) > 6)
    };
    let changed = |from: f64, to: f64| {
        let columns = (from * ROOM_WIDTH) as u32..(to * ROOM_WIDTH) as u32;
        columns.flat_map(|x| (200..500).map(move |y| (x, y))).filter(is_other).count()
    };
    // What lies between the two lines has changed sides; the rest has not.
    assert!(changed(0.27, 0.48) > 1000, "{}", changed(0.27, 0.48));
    assert_eq!((changed(0.02, 0.22), changed(0.53, 0.98)), (0, 0));
    page.click(COMPARE);
}

/// The screen, which has the line there: white from the top to the bottom of the picture.
fn screen_with_line(page: &mut Chromium, x: f64) -> image::RgbaImage {
    for _ in 0..100 {
        page.pause(200);
        let screen = page.screen();
        let is_white = |x: u32| (300..450).all(|y| screen.get_pixel(x, y).0[..3].iter().all(|channel| *channel > 250));
        if (x as u32 - 3..x as u32 + 4).any(is_white) {
            return screen;
        }
    }
    panic!("there is no line at {x}");
}
