//! Pictures in linear light, with their buffers as layers.

mod common;

use common::{Folder, data};
use exr::prelude::*;
use std::path::Path;

/// The channels of a file.
fn channels(path: &Path) -> Vec<(String, Vec<f32>)> {
    let image = read_all_flat_layers_from_file(path).unwrap();
    let list = image.layer_data.into_iter().flat_map(|layer| layer.channel_data.list);
    list.map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect())).collect()
}

fn render(folder: &Folder, name: &str, options: &[&str]) -> Vec<(String, Vec<f32>)> {
    let fluid = data("rigid_coupling/ParticleData_Fluid_22.bgeo");
    let fixed = ["render", &fluid, "-o", name, "--size", "160x90", "--quiet", "--refraction", "0"];
    folder.succeed(&[&fixed, options].concat());
    channels(&folder.path(name))
}

fn named<'a>(channels: &'a [(String, Vec<f32>)], name: &str) -> &'a [f32] {
    &channels.iter().find(|(other, _)| other == name).unwrap_or_else(|| panic!("no {name}")).1
}

#[test]
fn every_layer_has_its_name() {
    let layers = render(&Folder::new(), "a.exr", &[]);
    let transmittance = ["transmittance.R", "transmittance.G", "transmittance.B"];
    let others = ["R", "G", "B", "A", "depth.Z", "normal.X", "normal.Y", "normal.Z", "thickness.Y", "albedo.R"];
    for name in transmittance.into_iter().chain(others).chain(["forward.u", "forward.v"]) {
        assert_eq!(named(&layers, name).len(), 160 * 90, "{name}");
    }
    assert!(named(&layers, "A").iter().all(|alpha| *alpha == 1.0), "the built-in scene is opaque");
}

#[test]
fn with_grey_absorption_alpha_alone_composites() {
    let folder = Folder::new();
    let grey = ["--absorption", "0.03,0.03,0.03", "--background"];
    let over = |background| render(&folder, "a.exr", &[&grey[..], &[background]].concat());
    let [free, white] = ["transparent", "white"].map(over);
    for name in ["R", "G", "B"] {
        let expected = named(&white, name).iter();
        let composited = named(&free, name).iter().zip(named(&free, "A")).map(|(color, alpha)| color + (1.0 - alpha));
        let off = composited.zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off <= 1e-3, "{name} is off by {off}");
    }
    assert!(named(&free, "A").iter().any(|alpha| *alpha > 0.3) && named(&free, "A").contains(&0.0));
}

#[test]
fn color_and_transmittance_composite_over_any_background() {
    let folder = Folder::new();
    let sphere = data("obstacles/sphere.obj");
    for bodies in [&[][..], &["--mesh", &sphere]] {
        let over = |background| render(&folder, "a.exr", &[&["--background", background], bodies].concat());
        let [free, white, black] = ["transparent", "white", "black"].map(over);
        for (behind, value) in [(&white, 1.0), (&black, 0.0)] {
            for name in ["R", "G", "B"] {
                let transmittance = named(&free, &format!("transmittance.{name}"));
                let composited = named(&free, name).iter().zip(transmittance).map(|(color, t)| color + t * value);
                let off = composited.zip(named(behind, name)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(off <= 1e-3, "{name} over {value} is off by {off}");
            }
        }
        let (red, blue) = (named(&free, "transmittance.R"), named(&free, "transmittance.B"));
        assert!(red.iter().zip(blue).any(|(red, blue)| blue - red > 0.05), "water absorbs red");
    }
}

#[test]
fn motion_is_that_of_the_particles() {
    // A ball of particles that moves to the right and up, straight before an orthographic camera.
    let folder = Folder::new();
    let rows = common::cube(6, 0.0).into_iter().map(|[x, y, z]| format!("{x},{y},{z},2,1,0\n"));
    folder.write("a.csv", format!("x,y,z,vx,vy,vz\n{}", rows.collect::<String>()));
    let camera = ["--camera-eye", "0.5,0.5,9", "--camera-target", "0.5,0.5,0", "--ortho", "4", "--fps", "50"];
    let fixed = ["render", "a.csv", "-o", "a.exr", "--size", "100x80", "--quiet", "--radius", "0.1"];
    folder.succeed(&[&fixed[..], &camera].concat());
    let layers = channels(&folder.path("a.exr"));
    // 20 pixels a unit, 50 frames a second.
    let mut covered = 0;
    for ((depth, u), v) in
        named(&layers, "depth.Z").iter().zip(named(&layers, "forward.u")).zip(named(&layers, "forward.v"))
    {
        let expected = if depth.is_finite() { [0.8, 0.4] } else { [0.0; 2] };
        covered += usize::from(depth.is_finite());
        assert!((u - expected[0]).abs() < 1e-4 && (v - expected[1]).abs() < 1e-4, "{u}, {v} at depth {depth}");
    }
    assert!(covered > 400, "{covered} pixels covered");
}

#[test]
fn a_buffer_is_no_layered_picture() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &common::cube(2, 0.0));
    let (_, line) = folder.fail(&["render", "a.pos", "-o", "a.exr", "--show", "depth"]);
    assert!(line.contains("--show"), "{line}");
}
