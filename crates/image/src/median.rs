//! Median.

/// The middle value; 0 of none.
pub fn median(values: &[f64]) -> f64 {
    middle(values.to_vec()).unwrap_or(0.0)
}

/// The middle value; `None` of none.
pub fn middle(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
