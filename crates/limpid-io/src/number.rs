//! Decimal numbers, read as the standard library reads them, bit for bit, but several times as fast: nearly all of them have no more
//! digits than a register holds, and no large exponent.

const MOST_DIGITS: usize = 19;

/// Powers of ten that f64 holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// The bits of an f64 that an f32 has no room for, and half of what they can count.
const REST: u64 = (1 << 29) - 1;
const HALF: u64 = 1 << 28;

/// More than the last bits that rounding may have got wrong, when digits became an f64 and when that was scaled.
const DOUBT: u64 = 4;

/// Digits without a point, and the power of ten they stand for.
struct Decimal {
    negative: bool,
    digits: u64,
    exponent: i32,
    length: usize,
}

/// The number that a text begins with and its length; None where it takes the standard library to tell.
pub(crate) fn f32_of(text: &[u8]) -> Option<(f32, usize)> {
    let decimal = decimal(text)?;
    let value = scaled(decimal.digits as f64, decimal.exponent)?;
    // What is nearly half way between two f32 rounds by what the f64 no longer knows, and the smallest f32 have fewer bits.
    let is_sure = (value.to_bits() & REST).abs_diff(HALF) > DOUBT;
    let is_normal = value == 0.0 || (2.0 * f64::from(f32::MIN_POSITIVE)..f64::from(f32::MAX)).contains(&value);
    let value = if decimal.negative { -value } else { value };
    (is_sure && is_normal).then_some((value as f32, decimal.length))
}

/// The same for f64, where one exact number is scaled by another, so that only the result is rounded.
pub(crate) fn f64_of(text: &[u8]) -> Option<(f64, usize)> {
    let decimal = decimal(text)?;
    let value = (decimal.digits < 1 << 53).then(|| scaled(decimal.digits as f64, decimal.exponent))??;
    Some((if decimal.negative { -value } else { value }, decimal.length))
}

fn scaled(digits: f64, exponent: i32) -> Option<f64> {
    let power = *POWERS.get(exponent.unsigned_abs() as usize)?;
    Some(if exponent < 0 { digits / power } else { digits * power })
}

fn decimal(text: &[u8]) -> Option<Decimal> {
    let negative = text.first() == Some(&b'-');
    let mut at = usize::from(negative);
    let mut digits = 0u64;
    let mut found = 0;
    let mut point = None;
    while let Some(byte) = text.get(at) {
        match byte {
            b'0'..=b'9' => {
                digits = digits.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                found += 1;
            }
            b'.' if point.is_none() => point = Some(found),
            _ => break,
        }
        at += 1;
    }
    if found == 0 || found > MOST_DIGITS {
        return None;
    }
    let mut exponent = -((found - point.unwrap_or(found)) as i32);
    if let Some(b'e' | b'E') = text.get(at) {
        at += 1;
        let minus = text.get(at) == Some(&b'-');
        at += usize::from(matches!(text.get(at), Some(b'-' | b'+')));
        // Two digits, or it is nothing for here.
        let first = text.get(at).filter(|byte| byte.is_ascii_digit())?;
        let mut power = i32::from(first - b'0');
        at += 1;
        if let Some(second) = text.get(at).filter(|byte| byte.is_ascii_digit()) {
            power = 10 * power + i32::from(second - b'0');
            at += 1;
        }
        exponent += if minus { -power } else { power };
    }
    Some(Decimal { negative, digits, exponent, length: at })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a number is told of a whole text, it is the standard library's; how many were told.
    fn compare(text: &str) -> u32 {
        let mut told = 0;
        if let Some((value, _)) = f32_of(text.as_bytes()).filter(|(_, length)| *length == text.len()) {
            assert_eq!(value.to_bits(), text.parse::<f32>().unwrap().to_bits(), "{text}");
            told += 1;
        }
        if let Some((value, _)) = f64_of(text.as_bytes()).filter(|(_, length)| *length == text.len()) {
            assert_eq!(value.to_bits(), text.parse::<f64>().unwrap().to_bits(), "{text}");
            told += 1;
        }
        told
    }

    #[test]
    fn numbers_are_the_standard_librarys() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            state >> 24
        };
        let mut told = 0;
        for _ in 0..200_000 {
            let float = f32::from_bits(random() as u32);
            let double = f64::from_bits(random() << 24 ^ random());
            let near = f64::from(float) * (1.0 + 1e-8 * (random() % 100) as f64);
            // Between two neighbours, where rounding is decided by the last digit.
            let middle = (f64::from(float) + f64::from(float.next_up())) / 2.0;
            let small = (random() % 20_000_000) as f64 * 1e-7 - 1.0;
            for text in [
                format!("{float}"),
                format!("{float:e}"),
                format!("{double:e}"),
                format!("{near:e}"),
                format!("{middle:e}"),
                format!("{middle:.20e}"),
                format!("{small}"),
                format!("{small:.9}"),
                format!("{:.6e}", small * 1e5),
                format!("{}.{}", random() % 1000, random()),
                format!("{}e{}", random() % 100_000, random() % 60),
            ] {
                if text.chars().all(|c| !c.is_alphabetic() || c == 'e') {
                    told += compare(&text);
                }
            }
        }
        // Most, or it would be of no use.
        assert!(told > 1_500_000, "{told}");
    }

    #[test]
    fn what_is_odd_is_left_to_the_standard_library() {
        for text in [
            "0",
            "-0",
            "00012",
            "1.",
            ".5",
            "-.5e1",
            "1E5",
            "1e+05",
            "16777217",
            "3.4028235e38",
            "1e-45",
            "1.1754944e-38",
        ] {
            compare(text);
        }
        for text in ["", "-", ".", "+1", "nan", "inf", "e5", "1e", "1e-", "12345678901234567890"] {
            assert!(f32_of(text.as_bytes()).is_none() && f64_of(text.as_bytes()).is_none(), "{text}");
        }
        assert_eq!(f32_of(b"1.5e2x"), Some((150.0, 5)));
        // A third digit of the exponent is no part of the number, so that what follows is no space.
        assert_eq!(f64_of(b"1e100"), Some((1e10, 4)));
    }
}
