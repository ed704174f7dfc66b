//! Numbers in text.

/// The number of a token, including all spellings of `nan` and `inf`.
pub fn number(token: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    text.parse().ok().or_else(|| {
        // Output of C libraries: nan(ind), -1.#IND, 1.#QNAN, 1.#INF. None is finite, so the point is dropped.
        let odd = ["nan(", "-nan(", "+nan(", "1.#", "-1.#", "+1.#"];
        odd.iter()
            .any(|start| text.get(..start.len()).is_some_and(|text| text.eq_ignore_ascii_case(start)))
            .then_some(f64::NAN)
    })
}
