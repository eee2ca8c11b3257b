// Neighbouring pixels of one sheet of fluid.

// Whether two neighbouring pixels hold fluid no farther apart in depth than `step`, in world units.
fn is_sheet(a: Reals, b: Reals, step: f32) -> Bools {
    // |1/a - 1/b| <= step, without the division.
    let limit = step * select(Reals(1.0 / view.far), a * b, is_perspective());
    return (abs(a - b) <= limit) & (min(a, b) > Reals(0.0));
}
