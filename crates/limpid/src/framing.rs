//! A camera and surroundings for a fluid of which nothing else is known.

use crate::View;
use glam::{DVec3, dvec3};

/// Axis-aligned box in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box around points, leaving out those few strays (up to 1 in 500 in each direction) that lie farther out than
    /// half the size of the rest, so that one lost drop does not shrink the picture. None without points.
    pub fn robust(points: impl Iterator<Item = DVec3>) -> Option<Self> {
        let points: Vec<DVec3> = points.collect();
        if points.is_empty() {
            return None;
        }
        let (mut min, mut max) = (DVec3::ZERO, DVec3::ZERO);
        let strays = points.len() / 500;
        for axis in 0..3 {
            let mut values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
            let inner_min = *values.select_nth_unstable_by(strays, f64::total_cmp).1;
            let last = values.len() - 1 - strays;
            let inner_max = *values.select_nth_unstable_by(last, f64::total_cmp).1;
            let slack = 0.5 * (inner_max - inner_min);
            let within = values.iter().copied().filter(|v| *v >= inner_min - slack && *v <= inner_max + slack);
            (min[axis], max[axis]) = within.fold((inner_min, inner_max), |(lo, hi), v| (lo.min(v), hi.max(v)));
        }
        Some(Self { min, max })
    }

    /// The smallest box that holds both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Grown by `margin` on every side.
    pub fn grown(self, margin: f64) -> Self {
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// Its eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
            dvec3(pick(0), pick(1), pick(2))
        })
    }
}

/// Where to stand and where to look so that all of a box is in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// The camera's position.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
}

impl Framing {
    /// Looks at the box from the front, to the right and above, close enough that it fills the picture.
    /// `fov_y` in radians, `aspect` is width over height, `up` a unit vector.
    pub fn of(bounds: &Bounds, up: DVec3, fov_y: f64, aspect: f64) -> Self {
        let target = 0.5 * (bounds.min + bounds.max);
        let front = if up.z.abs() > 0.9 { dvec3(0.0, -1.0, 0.0) } else { DVec3::Z.reject_from(up).normalize() };
        let right = up.cross(front).normalize();
        let away = (front + 0.5 * right + 0.42 * up).normalize();
        let side = up.cross(away).normalize();
        let above = away.cross(side);
        let (tan_y, tan_x) = ((0.5 * fov_y).tan() * 0.95, (0.5 * fov_y).tan() * aspect * 0.95);
        // The nearest distance at which every corner is inside the view's four planes.
        let needed = |corner: DVec3| {
            let d = corner - target;
            d.dot(away) + (d.dot(side).abs() / tan_x).max(d.dot(above).abs() / tan_y)
        };
        let distance = bounds.corners().into_iter().map(needed).fold(f64::MIN_POSITIVE, f64::max);
        Self { eye: target + distance * away, target }
    }

    /// A perspective view from here. The near plane lies in front of everything within `bounds` or, where the camera is
    /// inside, a thousandth of the box away.
    pub fn view(&self, up: DVec3, fov_y: f64, aspect: f64, near: f64) -> View {
        View::perspective(self.eye, self.target, up, fov_y, aspect, near)
    }
}
