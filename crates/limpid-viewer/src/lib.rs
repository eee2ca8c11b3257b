//! The viewer: particles as a liquid, live, in a window or on a web page.
//!
//! Both are one application (`app`); what differs is how files come in and go out (`native`, `web`). Options, defaults
//! and drawing are those of `limpid render`: the settings saved here make the same picture there.

mod app;
mod book;
mod camera;
mod controls;
mod desk;
mod fingers;
mod frames;
mod held;
mod link;
mod pace;
mod picture;
mod playback;
mod read;
mod save;
mod screen;
mod stand;
mod times;

#[cfg(target_arch = "wasm32")]
mod fluid;
#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(target_arch = "wasm32")]
mod web;

#[cfg(not(target_arch = "wasm32"))]
pub use native::{Opening, run};
#[cfg(not(target_arch = "wasm32"))]
use native::{page_address, receive_dropped, show_address};
#[cfg(target_arch = "wasm32")]
use web::{page_address, receive_dropped, show_address};
