//! Figures for scripts.

/// A value to six decimals: a micrometre, a millionth of a degree.
pub(crate) fn rounded(value: f64) -> f64 {
    (1e6 * value).round() / 1e6
}
