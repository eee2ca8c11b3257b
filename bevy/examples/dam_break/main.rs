//! Water in a Bevy scene: `cargo run --example dam_break OUT.png` makes a picture, without a window; with `--features window` and
//! no OUT.png it opens one.

mod scene;

use bevy::prelude::*;
use scene::Options;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::new(UVec2::new(960, 540))?;
    match std::env::args().nth(1) {
        Some(output) => Ok(scene::picture(&options)?.save(output)?),
        None => open_window(options),
    }
}

#[cfg(not(feature = "window"))]
fn open_window(_: Options) -> Result<(), Box<dyn Error>> {
    Err("usage: dam_break OUT.png (or build it with --features window)".into())
}

#[cfg(feature = "window")]
fn open_window(options: Options) -> Result<(), Box<dyn Error>> {
    App::new()
        .add_plugins((DefaultPlugins, bevy_limpid::LimpidPlugin))
        .insert_resource(scene::sky())
        .insert_resource(options)
        .add_systems(Startup, (scene::spawn, spawn_camera))
        .add_systems(Update, orbit)
        .run();
    Ok(())
}

#[cfg(feature = "window")]
fn spawn_camera(mut commands: Commands, options: Res<Options>) {
    commands.spawn(scene::camera(&options));
}

/// Once around in half a minute.
#[cfg(feature = "window")]
fn orbit(time: Res<Time>, mut cameras: Query<&mut Transform, With<Camera3d>>) {
    for mut transform in &mut cameras {
        transform.rotate_around(Vec3::ZERO, Quat::from_rotation_y(0.2 * time.delta_secs()));
    }
}
