//! Counts in lines that people read.

/// A count with separators of thousands: `1,234,567`.
pub fn thousands(count: u64) -> String {
    let digits = count.to_string();
    let (first, rest) = digits.split_at(digits.len() % 3);
    let groups = rest.as_bytes().chunks(3).map(|group| String::from_utf8_lossy(group).into_owned());
    let all = Some(first.to_owned()).filter(|first| !first.is_empty()).into_iter().chain(groups);
    all.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::thousands;

    #[test]
    fn groups_of_three_digits_are_separated() {
        let texts = [0, 7, 999, 1000, 35_947, 100_000, 1_234_567, u64::MAX].map(thousands);
        let expected =
            ["0", "7", "999", "1,000", "35,947", "100,000", "1,234,567", "18,446,744,073,709,551,615"];
        assert_eq!(texts, expected);
    }
}
