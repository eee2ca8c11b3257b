//! Where things are in a page of 1024 x 768.

/// Points across the picture's room, left of the settings.
pub const ROOM_WIDTH: f64 = 689.0;
/// In the picture.
pub const MIDDLE: (f64, f64) = (340.0, 400.0);
/// The timeline's ends.
pub const TIMELINE: [(f64, f64); 2] = [(234.0, 733.0), (925.0, 733.0)];
/// Beside it, and the first of the speeds to choose from.
pub const LOOP: (f64, f64) = (140.0, 733.0);
pub const SPEED: (f64, f64) = (195.0, 733.0);
pub const SLOWEST: (f64, f64) = (200.0, 592.0);
/// The slider of the drawn radius: where its handle is by default, and farther right.
pub const SPLAT_SCALE: [(f64, f64); 2] = [(878.0, 116.0), (910.0, 116.0)];
/// Menu and its entries.
pub const SAVE: (f64, f64) = (93.0, 15.0);
pub const SAVE_PICTURE: (f64, f64) = (110.0, 42.0);
pub const SAVE_SETTINGS: (f64, f64) = (110.0, 65.0);
pub const SAVE_COMMAND: (f64, f64) = (110.0, 88.0);
/// Buttons.
pub const OPEN: (f64, f64) = (38.0, 15.0);
pub const UNDO: (f64, f64) = (143.0, 15.0);
pub const REDO: (f64, f64) = (194.0, 15.0);
pub const COMPARE: (f64, f64) = (422.0, 15.0);
pub const TIMINGS: (f64, f64) = (491.0, 15.0);
/// The same in a window that is too narrow for all of them in one row.
pub const TIMINGS_480: (f64, f64) = (38.0, 38.0);
pub const TIMINGS_390: (f64, f64) = (205.0, 38.0);
