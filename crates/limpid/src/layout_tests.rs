//! Structs shared with WGSL lie in memory as naga lays them out.

use crate::bodies::BodyUniform;
use crate::caustics::LensUniform;
use crate::display::DisplayUniform;
use crate::environment::{EnvironmentUniform, LightUniform};
use crate::passes::{
    DetailUniform, DropletsUniform, GatherUniform, LengthsUniform, LiquidsUniform, OpticsUniform, PaintUniform,
};
use crate::renderer::SettingsUniform;
use crate::view::ViewUniform;
use std::mem::offset_of;
use wgpu::naga;

/// Shading's module has all structs of the frame.
const SHADE: &str = concat!(
    include_str!("frame.wgsl"),
    include_str!("passes/tile_pixel.wgsl"),
    include_str!("light_maps.wgsl"),
    include_str!("environment.wgsl"),
    include_str!("elaborate.wgsl"),
    include_str!("scene_depth.wgsl"),
    include_str!("passes/interface.wgsl"),
    include_str!("passes/body.wgsl"),
    include_str!("passes/layers.wgsl"),
    include_str!("passes/through.wgsl"),
    include_str!("passes/thickness_levels.wgsl"),
    include_str!("passes/paint_sums.wgsl"),
    include_str!("passes/paint_shares.wgsl"),
    include_str!("passes/paint_optics.wgsl"),
    include_str!("passes/droplets_image.wgsl"),
    include_str!("passes/droplets_behind.wgsl"),
    include_str!("passes/detail_image.wgsl"),
    include_str!("passes/lamps.wgsl"),
    include_str!("passes/shade.wgsl"),
);

/// The noise image's structs; the functions need the frame's.
const DETAIL: &str = concat!(include_str!("frame.wgsl"), include_str!("passes/detail_image.wgsl"));

/// The caustics' own struct.
const LENS: &str = concat!(
    include_str!("frame.wgsl"),
    include_str!("light_maps.wgsl"),
    include_str!("lens.wgsl"),
    include_str!("caustics_resolve.wgsl")
);

/// Name and offset of the members of a WGSL struct, and its size.
fn wgsl_layout(source: &str, name: &str) -> (Vec<(String, usize)>, usize) {
    let module =
        naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some(naga::TypeInner::Struct { members, span }) = found.map(|(_, ty)| &ty.inner) else {
        panic!("no struct {name}")
    };
    let member = |m: &naga::StructMember| (m.name.clone().unwrap(), m.offset as usize);
    (members.iter().map(member).collect(), *span as usize)
}

/// Name and offset of the fields of a Rust struct, and its size.
macro_rules! rust_layout {
    ($ty:ident { $($field:ident),+ $(,)? }) => {{
        // Names every field, or does not compile.
        let _ = |$ty { $($field: _),+ }: $ty| ();
        (vec![$((stringify!($field).to_owned(), offset_of!($ty, $field))),+], size_of::<$ty>())
    }};
}

fn assert_same((mut rust, rust_size): (Vec<(String, usize)>, usize), wgsl: (Vec<(String, usize)>, usize)) {
    // WGSL pads at the end by itself.
    if wgsl.0.len() < rust.len() {
        rust.retain(|(name, _)| name != "padding");
    }
    assert_eq!((rust, rust_size), wgsl);
}

#[test]
fn view() {
    let rust =
        rust_layout!(ViewUniform { view_from_local, world_from_view, px_zero, px_step, depth_row, size, near, far });
    assert_same(rust, wgsl_layout(SHADE, "View"));
}

#[test]
fn settings() {
    let rust = rust_layout!(SettingsUniform {
        radius,
        splat_scale,
        density_threshold,
        thickness_unit,
        thickness_size,
        thickness_levels,
        thickness_divisor,
        strength,
        sphere_strength,
        ellipsoid_px,
        max_radius_px,
        range,
        clamp,
        normal_step,
        min_thickness,
        has_scene_depth,
        background,
        picture_size,
        fluid_scale,
        shading,
        fixed_thickness,
        layers_px,
        own_lengths,
        padding,
    });
    assert_same(rust, wgsl_layout(SHADE, "Settings"));
}

#[test]
fn light() {
    assert_same(rust_layout!(LightUniform { toward, first, east, padding, color }), wgsl_layout(SHADE, "Light"));
}

#[test]
fn lens() {
    let rust =
        rust_layout!(LensUniform { floor, shadow_texels, scene_texels, first, sun_tangent, absorption, padding });
    assert_same(rust, wgsl_layout(LENS, "Lens"));
}

#[test]
fn optics() {
    let rust = rust_layout!(OpticsUniform {
        absorption,
        refractive_index,
        color,
        refraction,
        scattering,
        specular,
        albedo,
        shininess,
        metal,
        roughness,
        fresnel,
        opacity,
        padding,
    });
    assert_same(rust, wgsl_layout(SHADE, "Optics"));
}

#[test]
fn liquids() {
    assert_same(rust_layout!(LiquidsUniform { paint, looks }), wgsl_layout(SHADE, "Liquids"));
}

#[test]
fn paint() {
    let rust = rust_layout!(PaintUniform {
        planes,
        first_liquid,
        liquids,
        coloring,
        surface_first,
        body_first,
        absorption,
        layer,
        mean_color,
        padding,
    });
    assert_same(rust, wgsl_layout(SHADE, "Paint"));
}

#[test]
fn detail() {
    let rust = rust_layout!(DetailUniform {
        size,
        divisor,
        octaves,
        height,
        frequency,
        agitated_gain,
        foam,
        foam_color,
        foam_opacity,
        foam_begins,
        foam_full,
        has_motion,
        padding
    });
    assert_same(rust, wgsl_layout(DETAIL, "Detail"));
}

#[test]
fn droplets() {
    let rust = rust_layout!(DropletsUniform { color, density, shutter, fade, foam_lift, bubble_lift });
    assert_same(rust, wgsl_layout(SHADE, "Droplets"));
}

#[test]
fn environment() {
    let rust = rust_layout!(EnvironmentUniform {
        up,
        eye_height,
        sun,
        tile,
        east,
        tile_fade,
        eye_from_center,
        extent,
        shadow_texels,
        scene_texels,
        light_count,
        sun_tangent,
        shadow_absorption,
        sun_strength,
        map_east,
        map_levels,
        map_middle,
        map_alpha,
        shadow_radius,
        caustic_texels,
        caustic_first,
        padding,
        lights,
    });
    assert_same(rust, wgsl_layout(SHADE, "Environment"));
}

#[test]
fn gather() {
    let rust = rust_layout!(GatherUniform {
        position_offset,
        position_stride,
        radius_offset,
        radius_stride,
        density_offset,
        density_stride,
        has_radii,
        has_densities,
        radius,
        padding,
    });
    let (mut members, size) = wgsl_layout(include_str!("passes/gather.wgsl"), "Gather");
    // A uniform's size is a multiple of 16 bytes.
    members.push(("padding".to_owned(), 36));
    assert_same(rust, (members, size.next_multiple_of(16)));
}

#[test]
fn display() {
    let rust = rust_layout!(DisplayUniform { exposure, tone_map });
    assert_same(rust, wgsl_layout(include_str!("display.wgsl"), "Display"));
}

#[test]
fn body() {
    let rust = rust_layout!(BodyUniform {
        clip_from_mesh,
        eye_from_mesh,
        normal_from_mesh,
        base_color,
        metallic,
        roughness,
        alpha,
        padding,
    });
    let source = concat!(
        include_str!("frame.wgsl"),
        include_str!("light_maps.wgsl"),
        include_str!("environment.wgsl"),
        include_str!("elaborate.wgsl"),
        include_str!("bodies/body.wgsl")
    );
    assert_same(rust, wgsl_layout(source, "Body"));
}

#[test]
fn liquid_lengths() {
    let source = concat!(
        include_str!("frame.wgsl"),
        include_str!("passes/tile_pixel.wgsl"),
        include_str!("passes/paint_sums.wgsl"),
        include_str!("passes/paint_shares.wgsl"),
        include_str!("passes/smooth/liquid_lengths.wgsl")
    );
    let (mut rust, size) = rust_layout!(LengthsUniform { paint, strengths, sphere_factor, padding });
    rust.retain(|(name, _)| name != "padding");
    assert_same((rust, size), wgsl_layout(source, "Liquids"));
}
