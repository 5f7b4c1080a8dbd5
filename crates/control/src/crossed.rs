//! The edge that an encoder crossed last, derived from one reading.

use tracelight_rig::TICK_S;

/// The last edge that was crossed on the way to `count`, `moved` counts from the one before: the number of the count above it, and on which side of
/// `count` it lies, counts from its centre.
pub(crate) const fn last_edge(count: i32, moved: i32) -> (i32, f32) {
    // it is the one on the side the joint came from
    if moved > 0 { (count, -0.5) } else { (count.wrapping_add(1), 0.5) }
}

/// How long ago it was crossed, s, and over how much of its way the joint may have been beside it then, rad, at that rate, rad/s.
pub(crate) fn crossed(moved: i32, age_ticks: Option<f32>, rate_rad_s: f32) -> (f32, f32) {
    match age_ticks {
        Some(age) => (age * TICK_S, 0.0),
        // without a stamp it was some time in the last of the tick's equal parts
        None => {
            let part = TICK_S / moved.unsigned_abs() as f32;
            (0.5 * part, rate_rad_s * part)
        }
    }
}
