//! The material libraries of OBJ files.

use std::collections::HashMap;
use std::path::Path;

use crate::{Material, texture};

/// Adds the materials of a library. What is missing or odd becomes a warning: the mesh has its shape without.
pub(crate) fn read(path: &Path, materials: &mut HashMap<String, Material>, warnings: &mut Vec<String>) {
    let text = match crate::files::read(path) {
        Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
        Err(error) => {
            warnings.push(format!("material library {} cannot be read ({error}): left out", path.display()));
            return;
        }
    };
    let mut name = String::new();
    for line in text.lines() {
        let (key, value) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        let value = value.trim();
        if key == "newmtl" {
            name = value.to_owned();
            materials.insert(name.clone(), Material::default());
        } else if let Some(material) = materials.get_mut(&name) {
            set(material, key, value, path, warnings);
        }
    }
}

fn set(material: &mut Material, key: &str, value: &str, path: &Path, warnings: &mut Vec<String>) {
    let numbers: Vec<f32> = value.split_ascii_whitespace().map_while(|word| word.parse().ok()).collect();
    let unit = |value: f32| if value.is_finite() { value.clamp(0.0, 1.0) } else { 0.0 };
    match (key, &numbers[..]) {
        ("Kd", &[grey]) => material.base_color[..3].fill(unit(grey)),
        ("Kd", &[r, g, b, ..]) => material.base_color[..3].copy_from_slice(&[unit(r), unit(g), unit(b)]),
        ("d", &[alpha]) => material.base_color[3] = unit(alpha),
        ("Tr", &[transparency]) => material.base_color[3] = 1.0 - unit(transparency),
        // A Phong exponent n has the highlight of the GGX width alpha = sqrt(2 / (n + 2)), and roughness is its root.
        ("Ns", &[exponent]) if exponent >= 0.0 => material.roughness = unit((2.0 / (exponent + 2.0)).powf(0.25)),
        ("Pr", &[roughness]) => material.roughness = unit(roughness),
        ("Pm", &[metallic]) => material.metallic = unit(metallic),
        ("map_Kd", _) => match texture::load(&texture::beside(path, file_name(value)), true) {
            Ok(texture) => material.base_color_texture = Some(texture),
            Err(warning) => warnings.push(warning),
        },
        _ => {}
    }
}

/// The file of a map: what follows its options (`-s 1 1 1 wood.png`). Names may have spaces where there are no options.
fn file_name(value: &str) -> &str {
    if value.starts_with('-') { value.split_ascii_whitespace().next_back().unwrap_or(value) } else { value }
}
