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
    for name in ["R", "G", "B", "A", "depth.Z", "normal.X", "normal.Y", "normal.Z", "thickness.Y"] {
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
fn a_buffer_is_no_layered_picture() {
    let folder = Folder::new();
    folder.write_pos("a.pos", &common::cube(2, 0.0));
    let (_, line) = folder.fail(&["render", "a.pos", "-o", "a.exr", "--show", "depth"]);
    assert!(line.contains("--show"), "{line}");
}
