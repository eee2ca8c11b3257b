//! The point of a mesh that is nearest to another: a tree of boxes around triangles.

use glam::DVec3;

use super::Triangle;

const LEAF: usize = 4;

pub(super) struct Tree<'a> {
    /// In the order of the leaves.
    triangles: Vec<&'a Triangle>,
    /// The halves of each box follow it: the first at once, the second after all of the first.
    nodes: Vec<Node>,
    /// The triangle found last: the next search is likely to begin near it.
    last: usize,
    stack: Vec<(f64, usize)>,
}

struct Node {
    min: DVec3,
    max: DVec3,
    kind: Kind,
}

enum Kind {
    Leaf(std::ops::Range<usize>),
    /// Where the second half is.
    Halves(usize),
}

impl<'a> Tree<'a> {
    /// Over at least one triangle.
    pub fn over(triangles: &'a [Triangle]) -> Self {
        let mut triangles: Vec<&Triangle> = triangles.iter().collect();
        let mut nodes = Vec::new();
        split(&mut triangles, 0, &mut nodes);
        Self { triangles, nodes, last: 0, stack: Vec::new() }
    }

    /// The triangle, and the weights of its corners at its nearest point.
    pub fn nearest(&mut self, point: DVec3) -> (&'a Triangle, [f64; 3]) {
        let distance_to = |triangle: &Triangle| triangle.at(nearest_in(triangle, point)).distance_squared(point);
        let mut best = distance_to(self.triangles[self.last]);
        self.stack.clear();
        self.stack.push((0.0, 0));
        while let Some((distance, index)) = self.stack.pop() {
            if distance > best {
                continue;
            }
            match &self.nodes[index].kind {
                Kind::Leaf(range) => {
                    for index in range.clone() {
                        let distance = distance_to(self.triangles[index]);
                        if distance < best {
                            (best, self.last) = (distance, index);
                        }
                    }
                }
                Kind::Halves(second) => {
                    let mut halves = [index + 1, *second].map(|half| (self.nodes[half].distance(point), half));
                    halves.sort_by(|a, b| b.0.total_cmp(&a.0));
                    self.stack.extend(halves);
                }
            }
        }
        let triangle = self.triangles[self.last];
        (triangle, nearest_in(triangle, point))
    }
}

impl Node {
    /// The square of the distance from the box.
    fn distance(&self, point: DVec3) -> f64 {
        point.clamp(self.min, self.max).distance_squared(point)
    }
}

/// Adds the box of some triangles, which start at `first` of all, and the boxes in it.
fn split(triangles: &mut [&Triangle], first: usize, nodes: &mut Vec<Node>) {
    let corners = || triangles.iter().flat_map(|triangle| triangle.corners);
    let (min, max) = (corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max));
    let index = nodes.len();
    nodes.push(Node { min, max, kind: Kind::Leaf(first..first + triangles.len()) });
    if triangles.len() <= LEAF {
        return;
    }
    let axis = (max - min).max_position();
    let middle = triangles.len() / 2;
    let centre = |triangle: &Triangle| triangle.corners.iter().map(|corner| corner[axis]).sum::<f64>();
    triangles.select_nth_unstable_by(middle, |a, b| centre(a).total_cmp(&centre(b)));
    let (one, other) = triangles.split_at_mut(middle);
    split(one, first, nodes);
    nodes[index].kind = Kind::Halves(nodes.len());
    split(other, first + middle, nodes);
}

/// The weights of a triangle's corners at its point nearest to another.
fn nearest_in(triangle: &Triangle, point: DVec3) -> [f64; 3] {
    let [a, b, c] = triangle.corners;
    let normal = triangle.doubled_area();
    // The foot of the perpendicular, if it is inside: each corner weighs as much as the triangle across from it.
    let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) / normal.length_squared();
    let weights = [weight(b, c), weight(c, a), weight(a, b)];
    if weights.iter().all(|weight| *weight >= 0.0) {
        return weights;
    }
    // Else it is on an edge.
    let on_edge = |from: usize| {
        let to = (from + 1) % 3;
        let (start, along) = (triangle.corners[from], triangle.corners[to] - triangle.corners[from]);
        let t = (point - start).dot(along) / along.length_squared();
        let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
        let mut weights = [0.0; 3];
        (weights[from], weights[to]) = (1.0 - t, t);
        ((start + along * t).distance_squared(point), weights)
    };
    let edges = [0, 1, 2].map(on_edge);
    edges.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or([1.0, 0.0, 0.0], |(_, weights)| weights)
}
