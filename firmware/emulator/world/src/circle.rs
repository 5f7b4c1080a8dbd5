//! A circle that is drawn again and again: at every moment both joints, or one of them, move, and there is light.

use tracelight_maths::{cos, sin};
use tracelight_rig::{PanTilt, RateLimit, Segment};

/// Radius, rad, and how fast it is gone round, rad/s.
const RADIUS_RAD: f64 = 0.2;
const ROUND_RAD_S: f64 = 2.0;
/// Time until the head is on it, s.
const OUT_S: f64 = 0.5;
/// Ticks of a segment.
const TICKS: u16 = 50;
/// How far light may be off it, rad.
const TOLERANCE_RAD: f32 = 5e-3;

/// Position, speed and acceleration of both joints, in ticks.
fn at(tick: u32) -> PanTilt<[f64; 3]> {
    let t = f64::from(tick) * 1e-3;
    let u = (t / OUT_S).min(1.0);
    // 10 u³ − 15 u⁴ + 6 u⁵: from rest at the middle
    let out = RADIUS_RAD * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
    let out_rate = RADIUS_RAD * 30.0 * u * u * (1.0 - u) * (1.0 - u) / OUT_S;
    let out_rate_rate = RADIUS_RAD * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (OUT_S * OUT_S);
    let (sine, cosine) = (sin(ROUND_RAD_S * t), cos(ROUND_RAD_S * t));
    let motion = |way: f64, rate: f64| {
        let rate_rate = -ROUND_RAD_S * ROUND_RAD_S * way;
        [
            out * way,
            1e-3 * (out_rate * way + out * rate),
            1e-6 * (out_rate_rate * way + 2.0 * out_rate * rate + out * rate_rate),
        ]
    };
    PanTilt::new(motion(cosine, -ROUND_RAD_S * sine), motion(sine, ROUND_RAD_S * cosine))
}

/// The quintic between two motions.
fn quintic([x0, v0, a0]: [f64; 3], [x1, v1, a1]: [f64; 3]) -> [f32; 6] {
    let n = f64::from(TICKS);
    let n3 = n * n * n;
    let (x, v, a) = (x1 - x0 - v0 * n - 0.5 * a0 * n * n, (v1 - v0 - a0 * n) * n, (a1 - a0) * n * n);
    let (third, fourth, fifth) =
        (10.0 * x - 4.0 * v + 0.5 * a, -15.0 * x + 7.0 * v - a, 6.0 * x - 3.0 * v + 0.5 * a);
    [x0, v0, 0.5 * a0, third / n3, fourth / (n3 * n), fifth / (n3 * n * n)].map(|c| c as f32)
}

/// The so-many-eth segment.
pub fn segment(number: u32) -> Segment {
    let start_tick = number * u32::from(TICKS);
    let (from, to) = (at(start_tick), at(start_tick + u32::from(TICKS)));
    Segment {
        start_tick,
        ticks: TICKS,
        coefficients: PanTilt::new(quintic(from.pan, to.pan), quintic(from.tilt, to.tilt)),
        tolerance_rad: PanTilt::new(TOLERANCE_RAD, TOLERANCE_RAD),
        gate: f64::from(start_tick) * 1e-3 >= OUT_S,
        rate_limit: RateLimit::PLANNED,
    }
}
