//! Places between two others, by halves and thirds.

/// The place of the largest value between two, where it has one peak.
pub(crate) fn highest(value: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    for _ in 0..100 {
        let third = (to - from) / 3.0;
        if value(from + third) > value(to - third) {
            to -= third;
        } else {
            from += third;
        }
    }
    0.5 * (from + to)
}

/// Where something begins to hold, between a place where it does not and one where it does.
pub(super) fn turned(holds: impl Fn(f64) -> bool, mut from: f64, mut to: f64) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            break;
        }
        if holds(middle) {
            to = middle;
        } else {
            from = middle;
        }
    }
    to
}
