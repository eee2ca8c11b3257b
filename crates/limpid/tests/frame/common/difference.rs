//! How far two images are apart.

/// Statistics of the differences between two images, over the pixels that count.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Absolute values, sorted.
    sorted: Vec<f64>,
}

impl Difference {
    pub fn new(differences: impl IntoIterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = differences.into_iter().map(f64::abs).collect();
        sorted.sort_by(f64::total_cmp);
        assert!(!sorted.is_empty(), "nothing to compare");
        Self { sorted }
    }

    /// Of two depth images where both have fluid, in world units.
    pub fn of_depth(left: &[f32], right: &[f64]) -> Self {
        Self::new(covered_by_both(left, right).map(|(left, right)| left - right))
    }

    /// Of two depth images where both have fluid, relative.
    pub fn of_relative_depth(left: &[f32], right: &[f64]) -> Self {
        Self::new(covered_by_both(left, right).map(|(left, right)| left / right - 1.0))
    }

    pub fn max(&self) -> f64 {
        self.sorted[self.sorted.len() - 1]
    }

    pub fn rms(&self) -> f64 {
        (self.sorted.iter().map(|d| d * d).sum::<f64>() / self.sorted.len() as f64).sqrt()
    }

    /// What all but 1 in 1000 stay within.
    pub fn permille(&self) -> f64 {
        self.sorted[self.sorted.len() - 1 - self.sorted.len() / 1000]
    }

    /// Prints the figures (seen with --nocapture) and checks them.
    #[track_caller]
    pub fn assert(&self, what: &str, rms: f64, permille: f64) {
        println!("{what}: rms {:.3e}, 99.9 % {:.3e}, max {:.3e}", self.rms(), self.permille(), self.max());
        assert!(self.rms() <= rms, "{what}: RMS {:.3e}, allowed {rms:.3e}", self.rms());
        assert!(self.permille() <= permille, "{what}: 99.9 % within {:.3e}, allowed {permille:.3e}", self.permille());
    }
}

fn covered_by_both(left: &[f32], right: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    assert_eq!(left.len(), right.len());
    let pairs = left.iter().map(|left| f64::from(*left)).zip(right.iter().copied());
    pairs.filter(|(left, right)| left.is_finite() && right.is_finite())
}

/// Silhouettes that differ in at most 2 of 10,000 covered pixels, depths within 1e-5 for 99.9 % of them.
#[track_caller]
pub fn assert_same_depth(what: &str, rendered: &[f32], expected: &[f64]) {
    let covered = expected.iter().filter(|depth| depth.is_finite()).count();
    let strays = rendered.iter().zip(expected).filter(|(r, e)| r.is_finite() != e.is_finite()).count();
    println!("{what}: {covered} pixels covered, silhouettes differ in {strays}");
    assert!(covered > 0, "{what}: nothing to see");
    assert!(strays as f64 <= 2e-4 * covered as f64, "{what}: silhouettes differ in {strays} of {covered} pixels");
    Difference::of_relative_depth(rendered, expected).assert(what, f64::INFINITY, 1e-5);
}
