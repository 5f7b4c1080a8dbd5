use tracelight_rig::{PanTilt, RateLimit, Segment, TICK_F64_S};

use crate::motion::JointMotion;

/// A quintic from rest to rest is so many times as fast as in the mean at most, and speeds up with so many times its way over its time squared.
const FASTEST: f64 = 1.875;
const MOST_SUDDEN: f64 = 5.774;
/// Shortest and longest, ticks: what a segment holds.
const TICKS: (f64, f64) = (50.0, 30_000.0);
/// How far joints may stray from it, rad.
const STRAY_RAD: f32 = 0.05;

/// Returns one dark segment that turns both joints from rest to rest, rad, no faster than that many rad/s and no more suddenly than that many rad/s² unless it took
/// longer than half a minute.
pub fn turn(
    from_rad: PanTilt<f64>,
    to_rad: PanTilt<f64>,
    (speed_rad_s, acceleration_rad_s2): (f64, f64),
) -> Segment {
    let far_rad = (to_rad.pan - from_rad.pan).abs().max((to_rad.tilt - from_rad.tilt).abs());
    let time_s = (FASTEST * far_rad / speed_rad_s).max((MOST_SUDDEN * far_rad / acceleration_rad_s2).sqrt());
    let ticks = (time_s / TICK_F64_S).ceil().clamp(TICKS.0, TICKS.1);
    let coefficients = PanTilt::from_fn(|j| {
        let there = JointMotion::at_rest(to_rad[j]);
        JointMotion::at_rest(from_rad[j]).quintic_to(&there, ticks).map(|c| c as f32)
    });
    let (tolerance_rad, rate_limit) = (PanTilt::new(STRAY_RAD, STRAY_RAD), RateLimit::PLANNED);
    Segment { start_tick: 0, ticks: ticks as u16, coefficients, tolerance_rad, gate: false, rate_limit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_from_rest_to_rest_within_its_bounds() {
        for (to, most) in [(0.4, (1.5, 4.0)), (-2.0, (0.5, 100.0)), (0.0, (1.0, 1.0))] {
            let turn = turn(PanTilt::new(0.1, 0.2), PanTilt::new(to, 0.2), most);
            let at = |tick: u16| turn.sample(f32::from(tick)).pan;
            let (first, last) = (at(0), at(turn.ticks));
            assert!((f64::from(first.position_rad) - 0.1).abs() < 1e-6 && first.velocity_rad_s.abs() < 1e-6);
            assert!((f64::from(last.position_rad) - to).abs() < 1e-5 && last.velocity_rad_s.abs() < 1e-4);
            let all = || (0..=turn.ticks).map(at);
            let fastest = all().map(|s| f64::from(s.velocity_rad_s.abs())).fold(0.0, f64::max);
            let sudden = all().map(|s| f64::from(s.acceleration_rad_s2.abs())).fold(0.0, f64::max);
            assert!(fastest <= most.0 * 1.001 && sudden <= most.1 * 1.001, "{fastest} {sudden}");
            assert!(fastest > 0.9 * most.0 || sudden > 0.9 * most.1 || to == 0.0, "{fastest} {sudden}");
        }
    }
}
