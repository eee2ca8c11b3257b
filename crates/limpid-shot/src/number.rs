//! Numbers for people.

/// A number in few characters.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value.is_finite() && size != 0.0 && !(1e-4..1e6).contains(&size) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// The digits that mean something: five. An estimate has no more, and more of an f32 are its rounding.
pub fn significant(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.5, 4.0, 1e12, 1e-12, 16384.0].map(short), ["0.5", "4", "1e12", "1e-12", "16384"]);
    }

    #[test]
    fn digits_without_meaning_are_dropped() {
        assert_eq!([0.02500000037, 123456.0, 0.0].map(significant), [0.025, 123460.0, 0.0]);
    }
}
