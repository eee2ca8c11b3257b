// Neighbouring pixels of one sheet of fluid.

// Whether two neighbouring pixels hold fluid no farther apart in depth than `step`, in world units.
fn is_sheet(a: f32, b: f32, step: f32) -> bool {
    // |1/a - 1/b| <= step, without the division.
    let limit = step * select(1.0 / view.far, a * b, is_perspective());
    return (abs(a - b) <= limit) & (min(a, b) > 0.0);
}
