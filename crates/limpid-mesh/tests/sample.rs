//! Points of meshes: how many, where, and in which colours.

use std::path::Path;
use std::sync::Arc;

use limpid_mesh::sample::{SampleError, cover, fill};
use limpid_mesh::{Material, Mesh, Part, Texture, load};

fn obstacle(name: &str) -> Mesh {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/obstacles").join(name)).unwrap()
}

/// A box from `min` to `max` with outward triangles.
fn cuboid(min: [f32; 3], max: [f32; 3]) -> Part {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { min[axis] } else { max[axis] });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Part {
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Part::default()
    }
}

fn of(parts: impl IntoIterator<Item = Part>) -> Mesh {
    Mesh { parts: parts.into_iter().collect(), warnings: Vec::new() }
}

fn length(v: [f32; 3]) -> f32 {
    v.iter().map(|x| x * x).sum::<f32>().sqrt()
}

#[test]
fn a_filled_box_has_a_point_for_each_cube_of_the_spacing() {
    let points = fill(&of([cuboid([-1.0, 0.0, 2.0], [1.0, 0.5, 3.0])]), 0.125).unwrap();
    assert_eq!(points.positions.len(), 16 * 4 * 8);
    assert_eq!(points.colors, None);
    for p in &points.positions {
        // Centres of cubes: odd multiples of half the spacing.
        assert!(p.iter().all(|x| (x / 0.0625).rem_euclid(2.0) == 1.0), "{p:?}");
        assert!(p[0].abs() < 1.0 && p[1] > 0.0 && p[1] < 0.5 && p[2] > 2.0 && p[2] < 3.0, "{p:?}");
    }
}

#[test]
fn filled_shapes_have_their_volume_and_nothing_outside() {
    let sphere = fill(&obstacle("sphere.obj"), 0.05).unwrap();
    let expected = 4.0 / 3.0 * std::f64::consts::PI / 0.05_f64.powi(3);
    // The mesh's corners are on the sphere, so that the mesh is a little smaller.
    let ratio = sphere.positions.len() as f64 / expected;
    assert!((0.98..=1.0).contains(&ratio), "{ratio}");
    assert!(sphere.positions.iter().all(|p| length(*p) < 1.0));
    // Every place of the lattice that is surely inside is there.
    let near = sphere.positions.iter().filter(|p| length(**p) < 0.9).count();
    let expected = 4.0 / 3.0 * std::f64::consts::PI * (0.9_f64 / 0.05).powi(3);
    assert!((near as f64 / expected - 1.0).abs() < 0.01, "{near} {expected}");
}

#[test]
fn rays_through_edges_and_corners_slip_nowhere() {
    // Faces, diagonals and corners all on the lattice's rays.
    for steps in 2..12 {
        let width = steps as f32;
        let one = fill(&of([cuboid([0.0; 3], [width; 3])]), 1.0).unwrap();
        assert_eq!(one.positions.len(), steps * steps * steps);
        let octahedron = Part {
            positions: vec![
                [width, 0.0, 0.0],
                [0.0, width, 0.0],
                [-width, 0.0, 0.0],
                [0.0, -width, 0.0],
                [0.0, 0.0, width],
                [0.0, 0.0, -width],
            ],
            triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]],
            ..Part::default()
        };
        let octahedron = fill(&of([octahedron]), 1.0).unwrap().positions;
        // Its lattice is at half steps, and every place with |x| + |y| + |z| < width, for which equality never comes.
        let inside = |p: &[f32; 3]| p.iter().map(|x| x.abs()).sum::<f32>() < width + 1e-5;
        assert!(octahedron.iter().all(inside));
        let half = |i: i32| i as f32 + 0.5;
        let range = -(steps as i32)..steps as i32;
        let places = range.clone().flat_map(|x| {
            let range = range.clone();
            range.clone().flat_map(move |y| range.clone().map(move |z| [half(x), half(y), half(z)]))
        });
        let surely = |p: &[f32; 3]| p.iter().map(|x| x.abs()).sum::<f32>() < width - 1e-5;
        let expected: Vec<_> = places.filter(surely).collect();
        assert!(expected.iter().all(|place| octahedron.contains(place)), "{steps}");
    }
}

#[test]
fn shells_may_overlap_contain_each_other_and_be_inside_out() {
    let outer = cuboid([0.0; 3], [8.0; 3]);
    let mut cavity = cuboid([2.0; 3], [6.0; 3]);
    cavity.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert_eq!(fill(&of([outer.clone(), cavity]), 1.0).unwrap().positions.len(), 512 - 64);
    let overlapping = cuboid([4.0, 0.0, 0.0], [12.0, 8.0, 8.0]);
    assert_eq!(fill(&of([outer.clone(), overlapping]), 1.0).unwrap().positions.len(), 12 * 64);
    let mut turned = outer;
    turned.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert_eq!(fill(&of([turned]), 1.0).unwrap().positions.len(), 512);
}

#[test]
fn a_covered_surface_has_a_point_for_each_square_and_none_too_near() {
    for (name, area) in [("sphere.obj", 12.55), ("box.obj", 6.0), ("cylinder.obj", 12.53)] {
        let mesh = obstacle(name);
        let points = cover(&mesh, 0.05).unwrap();
        let ratio = points.positions.len() as f64 * 0.05 * 0.05 / area;
        assert!((ratio - 1.0).abs() < 0.05, "{name} {ratio}");
        for (index, p) in points.positions.iter().enumerate() {
            let near = |q: &&[f32; 3]| length([0, 1, 2].map(|axis| p[axis] - q[axis])) < 0.775 * 0.05 - 1e-6;
            assert!(!points.positions[..index].iter().any(|q| near(&q)), "{name} {p:?}");
        }
        assert_eq!(cover(&mesh, 0.05).unwrap(), points, "the same every time");
    }
    assert!(
        cover(&obstacle("sphere.obj"), 0.1).unwrap().positions.iter().all(|p| (0.99..=1.0001).contains(&length(*p)))
    );
}

/// A box whose faces across x = 0 and x = 4 are painted in two colours by a texture, and whose colours of vertices halve
/// the light above.
fn painted() -> Mesh {
    let mut part = cuboid([0.0; 3], [4.0; 3]);
    // Blue to the right of the middle, red to its left.
    let texture = Texture { width: 2, height: 1, rgba8: vec![255, 0, 0, 255, 0, 0, 255, 255], srgb: true };
    part.uvs = Some(part.positions.iter().map(|p| [if p[0] == 0.0 { 0.25 } else { 0.75 }, 0.5]).collect());
    part.colors = Some(part.positions.iter().map(|_| [0.5, 0.5, 0.5, 1.0]).collect());
    part.material = Material { base_color_texture: Some(Arc::new(texture)), ..Material::default() };
    of([part])
}

#[test]
fn textures_and_colours_of_vertices_are_kept() {
    let mesh = painted();
    // Half of the light is 188 in sRGB.
    let check = |position: &[f32; 3], color: &[u8; 3]| {
        let [x, y, z] = *position;
        if x < 0.8 && (1.0..3.0).contains(&y) && (1.0..3.0).contains(&z) {
            assert!(color[0] > 170 && color[2] < 128, "{position:?} {color:?}");
        }
        if x == 0.0 {
            assert_eq!(*color, [188, 0, 0], "{position:?}");
        }
        if x == 4.0 {
            assert_eq!(*color, [0, 0, 188], "{position:?}");
        }
    };
    for points in [fill(&mesh, 0.5).unwrap(), cover(&mesh, 0.25).unwrap()] {
        let colors = points.colors.unwrap();
        assert_eq!(colors.len(), points.positions.len());
        points.positions.iter().zip(&colors).for_each(|(position, color)| check(position, color));
    }
}

#[test]
fn inner_points_take_the_colour_of_the_nearest_surface() {
    let mut parts = [cuboid([0.0; 3], [4.0; 3]), cuboid([10.0, 0.0, 0.0], [14.0, 4.0, 4.0])];
    parts[0].material.base_color = [1.0, 0.0, 0.0, 1.0];
    parts[1].material.base_color = [0.0, 0.0, 1.0, 1.0];
    let points = fill(&of(parts), 0.5).unwrap();
    for (position, color) in points.positions.iter().zip(points.colors.unwrap()) {
        assert_eq!(color, if position[0] < 5.0 { [255, 0, 0] } else { [0, 0, 255] }, "{position:?}");
    }
}

#[test]
fn what_has_no_inside_says_so() {
    let mut open = cuboid([0.0; 3], [1.0; 3]);
    open.triangles.pop();
    assert_eq!(fill(&of([open.clone()]), 0.1), Err(SampleError::Open(3)));
    assert!(cover(&of([open]), 0.1).is_ok());
    let mut turned = cuboid([0.0; 3], [1.0; 3]);
    turned.triangles[3].swap(0, 1);
    assert_eq!(fill(&of([turned]), 0.1), Err(SampleError::Turned(3)));
    // A square on both sides: closed, but empty.
    let flat = Part {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2], [2, 1, 0]],
        ..Part::default()
    };
    assert_eq!(fill(&of([flat]), 0.1), Err(SampleError::None(0.1)));
}

#[test]
fn spacings_that_nobody_means_are_refused() {
    let mesh = of([cuboid([0.0; 3], [1.0; 3])]);
    for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(fill(&mesh, spacing), Err(SampleError::BadSpacing(_))));
        assert!(matches!(cover(&mesh, spacing), Err(SampleError::BadSpacing(_))));
    }
    assert_eq!(fill(&mesh, 1e-4), Err(SampleError::TooMany { enough: 0.0037 }));
    assert_eq!(cover(&mesh, 1e-300), Err(SampleError::TooMany { enough: 0.00055 }));
    // Hardly any volume, but a wide base to search.
    let sheet = of([cuboid([0.0; 3], [1e6, 1e6, 1e-6])]);
    assert!(matches!(fill(&sheet, 0.5), Err(SampleError::TooMany { .. })));
}
