//! Motion of one coordinate, and the quintic between two such.

use tracelight_maths::powi;

/// Motion along the path: m, m/s, m/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Along {
    pub(crate) s: f64,
    pub(crate) v: f64,
    pub(crate) a: f64,
}

/// The quintic with the given place, speed and acceleration at both ends of `time`.
pub(crate) fn hermite(from: Along, to: Along, time: f64) -> [f64; 6] {
    let n = time;
    // what the first three coefficients leave over at the far end
    let ds = to.s - from.s - from.v * n - 0.5 * from.a * n * n;
    let dv = (to.v - from.v - from.a * n) * n;
    let da = (to.a - from.a) * n * n;
    [
        from.s,
        from.v,
        0.5 * from.a,
        (10.0 * ds - 4.0 * dv + 0.5 * da) / powi(n, 3),
        (-15.0 * ds + 7.0 * dv - da) / powi(n, 4),
        (6.0 * ds - 3.0 * dv + 0.5 * da) / powi(n, 5),
    ]
}
