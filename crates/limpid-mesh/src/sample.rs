//! Points from a mesh, so that anyone has particles to render: inside it, or on its surface.
//!
//! Both are worked out in f64 and depend on nothing but the mesh and the spacing: the same input gives the same points.

mod closed;
mod color;
mod cover;
mod fill;
mod nearest;

use glam::DVec3;
use thiserror::Error;

use crate::Mesh;
use color::Painter;

/// More points than anyone means to make: at so many a spacing is taken for a mistake.
pub const MOST_POINTS: u64 = 20_000_000;

/// Points of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// Positions in the mesh's coordinates.
    pub positions: Vec<[f32; 3]>,
    /// Red, green and blue in sRGB of each point, if the mesh is not plain white.
    pub colors: Option<Vec<[u8; 3]>>,
}

/// Why a mesh gives no points. Every message is one line with a remedy; the file's name is for the caller to add.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SampleError {
    /// A spacing that no points can have.
    #[error("the spacing of points must be a positive number, not {0}; correct --spacing")]
    BadSpacing(f64),
    /// More than [`MOST_POINTS`].
    #[error("so small a spacing would take more than {MOST_POINTS} points; give --spacing {enough} or more")]
    TooMany {
        /// A spacing that will do.
        enough: f64,
    },
    /// A mesh with no inside.
    #[error(
        "the mesh is not closed ({0} of its edges border no second triangle), so that nothing is inside; \
         close its holes, or cover its surface with --cover"
    )]
    Open(usize),
    /// A mesh whose triangles disagree about the outside.
    #[error(
        "the mesh's triangles are not turned the same way (along {0} edges), so that no side is its inside; \
         recalculate its normals, or cover its surface with --cover"
    )]
    Turned(usize),
    /// A mesh too thin for the spacing.
    #[error("no point of a lattice of spacing {0} is inside the mesh; give a smaller --spacing, or --cover")]
    None(f64),
}

/// A triangle, wherever in the mesh it comes from.
struct Triangle {
    corners: [DVec3; 3],
    part: usize,
    index: usize,
}

impl Triangle {
    fn all(mesh: &Mesh) -> Vec<Self> {
        let of_part = |(part, p): (usize, &crate::Part)| {
            let corner = |vertex: u32| DVec3::from_array(p.positions[vertex as usize].map(f64::from));
            let triangles = p.triangles.iter().enumerate();
            triangles.map(|(index, corners)| Self { corners: corners.map(corner), part, index }).collect::<Vec<_>>()
        };
        mesh.parts.iter().enumerate().flat_map(of_part).collect()
    }

    /// Along the normal, as long as twice the area.
    fn doubled_area(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    fn at(&self, weights: [f64; 3]) -> DVec3 {
        (0..3).map(|corner| self.corners[corner] * weights[corner]).sum()
    }
}

/// Points of a cubic lattice of this spacing inside the mesh, centred on its bounds: each stands for a cube of the spacing's
/// width, so that there are as many as the volume has such cubes.
///
/// Inside is where the winding number is not 0. The mesh must be closed: along each edge as many triangles go one way as the other, vertices
/// at the same place counting as one. Then the winding number is a whole number, which is counted exactly however rays
/// graze edges; shells may overlap, contain each other or be turned inside out.
pub fn fill(mesh: &Mesh, spacing: f64) -> Result<Points, SampleError> {
    check_spacing(spacing)?;
    let triangles = Triangle::all(mesh);
    closed::check(&triangles)?;
    let volume = closed::volume(&triangles);
    check_count(volume, 3, spacing)?;
    let positions = fill::lattice(&triangles, spacing)?;
    if positions.is_empty() {
        return Err(SampleError::None(spacing));
    }
    let colors = Painter::of(mesh).map(|painter| {
        let mut tree = nearest::Tree::over(&triangles);
        positions
            .iter()
            .map(|position| {
                let (triangle, weights) = tree.nearest(DVec3::from_array(position.map(f64::from)));
                painter.color(triangle, weights)
            })
            .collect()
    });
    Ok(Points { positions, colors })
}

/// Points on the mesh's surface, about as many as it has squares of the spacing's width, and nowhere nearer to each other than
/// 0.775 of it: darts thrown at random but always the same, each kept if none before is near.
pub fn cover(mesh: &Mesh, spacing: f64) -> Result<Points, SampleError> {
    check_spacing(spacing)?;
    let triangles = Triangle::all(mesh);
    let area: f64 = triangles.iter().map(|triangle| 0.5 * triangle.doubled_area().length()).sum();
    check_count(area, 2, spacing)?;
    let darts = cover::darts(&triangles, area, spacing);
    let positions = darts.iter().map(|dart| dart.position.as_vec3().to_array()).collect();
    let color = |painter: Painter<'_>| {
        darts.iter().map(|dart| painter.color(&triangles[dart.triangle], dart.weights)).collect()
    };
    Ok(Points { positions, colors: Painter::of(mesh).map(color) })
}

fn check_spacing(spacing: f64) -> Result<(), SampleError> {
    if spacing.is_finite() && spacing > 0.0 { Ok(()) } else { Err(SampleError::BadSpacing(spacing)) }
}

/// Refuses a size, in the given power of world units, that takes more than [`MOST_POINTS`].
fn check_count(size: f64, power: i32, spacing: f64) -> Result<(), SampleError> {
    let enough = (size / MOST_POINTS as f64).powf(1.0 / f64::from(power));
    if spacing >= enough {
        return Ok(());
    }
    // Up to the next of two digits.
    let digit = 10_f64.powf(enough.log10().floor() - 1.0);
    let enough = format!("{:.1e}", (enough / digit).ceil() * digit).parse().unwrap_or(enough);
    Err(SampleError::TooMany { enough })
}
