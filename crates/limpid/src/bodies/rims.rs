//! Where the panes of a glass body meet: without them a tank can hardly be seen.

use super::mesh::{PartSlices, Shared, Vertex};
use glam::{DMat4, DVec3, Vec2, Vec3};

/// Meshes of more triangles are no tanks: their edges are not looked for.
const MOST_TRIANGLES: usize = 20_000;

/// Normals whose cosine is below this meet in an edge.
const SHARP: f32 = 0.8;

/// Half the width of a rim, over the body's size.
const HALF_WIDTH: f64 = 0.0022;

/// A sharp or open edge, in the mesh's space.
#[derive(Debug)]
pub(super) struct Edge {
    ends: [Vec3; 2],
    /// Of the triangles that meet there.
    normals: Vec<Vec3>,
}

/// The edges of a small mesh where its surface ends or turns sharply.
pub(super) fn sharp_edges(parts: &[PartSlices<'_>]) -> Vec<Edge> {
    if parts.iter().map(|part| part.triangles.len()).sum::<usize>() > MOST_TRIANGLES {
        return Vec::new();
    }
    let mut shared = Shared::new();
    for part in parts {
        for triangle in part.usable_triangles() {
            let normal = part.flat_normal(triangle);
            for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                // Vertices are often doubled: places say what is shared. Adding 0 makes -0 one of them.
                let place = |corner: usize| part.positions[triangle[corner]].map(|x| (x + 0.0).to_bits());
                let mut ends = [place(from), place(to)];
                ends.sort_unstable();
                shared.entry(ends).or_default().push(normal);
            }
        }
    }
    let is_sharp = |normals: &[Vec3]| normals.len() < 2 || normals.iter().any(|n| n.dot(normals[0]) < SHARP);
    let mut edges: Vec<_> = shared.into_iter().filter(|(_, normals)| is_sharp(normals)).collect();
    edges.sort_unstable_by_key(|(ends, _)| *ends);
    let place = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
    edges.into_iter().map(|(ends, normals)| Edge { ends: ends.map(place), normals }).collect()
}

/// Bars along the edges, in world axes from the eye: of those behind what the body holds, and of those before it.
pub(super) fn bars(edges: &[Edge], world_from_mesh: &DMat4, eye: DVec3, forward: Option<DVec3>) -> [Vec<Vertex>; 2] {
    let ends: Vec<[DVec3; 2]> =
        edges.iter().map(|edge| edge.ends.map(|end| world_from_mesh.transform_point3(end.as_dvec3()) - eye)).collect();
    let low = ends.iter().flatten().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = ends.iter().flatten().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let half = HALF_WIDTH * (high - low).length();
    let normal_from_mesh = world_from_mesh.inverse().transpose();
    let mut bars = [Vec::new(), Vec::new()];
    for (edge, ends) in edges.iter().zip(ends) {
        let toward = forward.unwrap_or(0.5 * (ends[0] + ends[1]));
        let is_near = |normal: &Vec3| normal_from_mesh.transform_vector3(normal.as_dvec3()).dot(toward) < 0.0;
        bar(ends, half, &mut bars[usize::from(edge.normals.iter().any(is_near))]);
    }
    bars
}

/// A square bar.
fn bar(ends: [DVec3; 2], half: f64, vertices: &mut Vec<Vertex>) {
    let Some(along) = (ends[1] - ends[0]).try_normalize() else { return };
    let side = along.any_orthonormal_vector();
    let other = along.cross(side);
    let corners = [side + other, other - side, -side - other, side - other].map(|corner| half * corner);
    for k in 0..4 {
        let [a, b] = [corners[k], corners[(k + 1) % 4]];
        let quad = [ends[0] + a, ends[1] + a, ends[1] + b, ends[0] + b];
        let normal = (a + b).normalize_or_zero().as_vec3();
        let vertex =
            |corner: usize| Vertex { position: quad[corner].as_vec3(), normal, uv: Vec2::ZERO, color: [1.0; 4] };
        vertices.extend([0, 1, 2, 0, 2, 3].map(vertex));
    }
}
