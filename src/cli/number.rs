//! Formatting of numbers.

/// Formats a number with at most six significant digits; very small and very large ones in scientific notation.
pub fn significant(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    // Rounding first removes trailing zeros.
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if (1e-4..1e9).contains(&size) || !size.is_finite() => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::significant;

    #[test]
    fn numbers_are_short() {
        let values =
            [0.0, 1.0 / 3.0, 2e-5 / 3.0, 1234567.0, 40.0, -0.5, f64::INFINITY, 1e12].map(significant);
        assert_eq!(values, ["0", "0.333333", "6.66667e-6", "1234570", "40", "-0.5", "inf", "1e12"]);
    }
}
