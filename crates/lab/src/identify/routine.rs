//! Motion to identify a head by.

use std::f64::consts::{PI, TAU};

use tracelight_maths::{hypot, powi, sin};
use tracelight_rig::{Joint, PanTilt, RateLimit, Segment, TICK_F64_S};
use tracelight_sim::{Model, RigConfig};

/// Length of a segment, ticks: short against the fastest swing.
const SEGMENT_TICKS: u16 = 20;
/// Widest swing to either side, rad: the original rig's working range.
const WIDEST_RAD: f64 = 0.45;
/// Share of a joint's range that swings stay within.
const RANGE_SHARE: f64 = 0.8;
/// Share of a motor's torque, less friction and weight, that a swing may take: the model that says so is what is in doubt.
const TORQUE_SHARE: f64 = 0.4;
/// Share of the speed limit.
const SPEED_SHARE: f64 = 0.5;
/// How far a joint may stray from the routine before that is a fault, rad; nothing is lit.
const TOLERANCE_RAD: f64 = 0.05;

/// One part of the routine: both joints swing, pan so often and tilt so often, to this share of the widest.
struct Swings {
    pan: f64,
    tilt: f64,
    share: f64,
    lasts_s: f64,
}

/// Slow for friction, faster for what grows with speed, fast for inertia; small ones for many reversals. The joints' periods
/// never fit each other, so that either passes every place at every speed of the other.
const PARTS: [Swings; 4] = [
    Swings { pan: 1.0, tilt: 2.0, share: 1.0, lasts_s: 12.0 },
    Swings { pan: 3.0, tilt: 2.0, share: 0.9, lasts_s: 8.0 },
    Swings { pan: 5.0, tilt: 4.0, share: 0.5, lasts_s: 6.0 },
    Swings { pan: 5.0, tilt: 4.0, share: 0.15, lasts_s: 14.0 },
];

/// Dark motion, 40 s or longer where motors are weak, from which [`identify`](super::identify) tells what a head is made of:
/// segments for a rig that rests at zero and is [following](RigConfig::following): one that hops does not show how it breaks away.
pub fn routine(rig: &RigConfig) -> Vec<Segment> {
    let mut segments = Vec::new();
    let mut start_tick = 0;
    for part in &PARTS {
        let lasts = (part.lasts_s * part.stretch(rig) / TICK_F64_S / f64::from(SEGMENT_TICKS)).ceil() as u32;
        let lasts_s = f64::from(lasts) * f64::from(SEGMENT_TICKS) * TICK_F64_S;
        for number in 0..lasts {
            let from_s = f64::from(number) * f64::from(SEGMENT_TICKS) * TICK_F64_S;
            let joint = |j: Joint| part.coefficients(rig, j, from_s, lasts_s);
            segments.push(Segment {
                start_tick,
                ticks: SEGMENT_TICKS,
                coefficients: PanTilt::from_fn(joint),
                tolerance_rad: PanTilt::new(TOLERANCE_RAD as f32, TOLERANCE_RAD as f32),
                gate: false,
                rate_limit: RateLimit::PLANNED,
            });
            start_tick += u32::from(SEGMENT_TICKS);
        }
    }
    segments
}

impl Swings {
    fn times(&self, joint: Joint) -> f64 {
        match joint {
            Joint::Pan => self.pan,
            Joint::Tilt => self.tilt,
        }
    }

    fn widest_rad(&self, rig: &RigConfig, joint: Joint) -> f64 {
        let (lower, upper) = rig.model.geometry.range_rad[joint];
        self.share * WIDEST_RAD.min(RANGE_SHARE * upper.min(-lower))
    }

    /// How much longer than planned it takes with these motors.
    fn stretch(&self, rig: &RigConfig) -> f64 {
        let joint = |j: Joint| {
            let rate = TAU * self.times(j) / self.lasts_s;
            let widest = self.widest_rad(rig, j);
            let speed = rate * widest / (SPEED_SHARE * rig.speed_limit_rad_s(j));
            // the envelope adds to it: half as much again at most
            let most_rad_s2 = (TORQUE_SHARE * possible_rad_s2(&rig.model, j, rig.speed_limit_rad_s(j)))
                .min(rig.motion.acceleration_limit_rad_s2[j]);
            let acceleration = 1.5 * rate * rate * widest / most_rad_s2;
            speed.max(acceleration.sqrt())
        };
        joint(Joint::Pan).max(joint(Joint::Tilt)).max(1.0)
    }

    /// Where a joint is to be, rad: sin² of the whole part lets it begin and end at rest at zero.
    fn angle_rad(&self, rig: &RigConfig, joint: Joint, time_s: f64, lasts_s: f64) -> f64 {
        let phase = time_s / lasts_s;
        let envelope = powi(sin(PI * phase), 2);
        let full = (1.0 - powi(1.0 - envelope, 3)).clamp(0.0, 1.0);
        self.widest_rad(rig, joint) * full * sin(TAU * self.times(joint) * phase)
    }

    /// A quintic with the angle, speed and acceleration of both ends, in ticks.
    fn coefficients(&self, rig: &RigConfig, joint: Joint, from_s: f64, lasts_s: f64) -> [f32; 6] {
        const STEP_S: f64 = 1e-4;
        let at = |time_s: f64| self.angle_rad(rig, joint, time_s, lasts_s);
        let ends = [from_s, from_s + f64::from(SEGMENT_TICKS) * TICK_F64_S].map(|t| {
            let (before, now, after) = (at(t - STEP_S), at(t), at(t + STEP_S));
            let per_tick = TICK_F64_S / STEP_S;
            (now, 0.5 * (after - before) * per_tick, (after - 2.0 * now + before) * per_tick * per_tick)
        });
        quintic(ends[0], ends[1], f64::from(SEGMENT_TICKS)).map(|c| c as f32)
    }
}

/// The quintic over n ticks between two states (angle, speed a tick, acceleration a tick²).
fn quintic(from: (f64, f64, f64), to: (f64, f64, f64), n: f64) -> [f64; 6] {
    let (x, v, a) = from;
    let position = to.0 - (x + n * (v + 0.5 * n * a));
    let speed = to.1 - (v + n * a);
    let acceleration = to.2 - a;
    let c3 = (10.0 * position - 4.0 * n * speed + 0.5 * n * n * acceleration) / powi(n, 3);
    let c4 = (-15.0 * position + 7.0 * n * speed - n * n * acceleration) / powi(n, 4);
    let c5 = (6.0 * position - 3.0 * n * speed + 0.5 * n * n * acceleration) / powi(n, 5);
    [x, v, 0.5 * a, c3, c4, c5]
}

/// What a motor can do besides holding friction and weight at its share of a speed, rad/s².
fn possible_rad_s2(model: &Model, joint: Joint, speed_rad_s: f64) -> f64 {
    let lumped = model.bodies.lumped();
    let weight = match joint {
        Joint::Pan => 0.0,
        Joint::Tilt => hypot(lumped.gravity_c, lumped.gravity_s),
    };
    let motor = &model.motors[joint];
    // where it is fastest the motor's own voltage takes its part
    let own = motor.back_emf_nm_s_per_rad() * SPEED_SHARE * speed_rad_s;
    let left = motor.torque_limit_nm() - weight - model.friction[joint].coulomb_nm() - own;
    (left / model.own_inertia_kg_m2()[joint]).max(0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_join_and_begin_and_end_at_rest_at_zero() {
        let segments = routine(&RigConfig::report());
        let end = |s: &Segment| s.sample(f32::from(s.ticks));
        for pair in segments.windows(2) {
            let (before, after) = (end(&pair[0]), pair[1].sample(0.0));
            for j in Joint::BOTH {
                assert_eq!(pair[0].end_tick(), pair[1].start_tick);
                assert!((before[j].position_rad - after[j].position_rad).abs() < 1e-6);
                assert!((before[j].velocity_rad_s - after[j].velocity_rad_s).abs() < 1e-3);
            }
        }
        let (first, last) = (segments[0].sample(0.0), end(&segments[segments.len() - 1]));
        for state in [first, last] {
            assert!(state.pan.position_rad.abs() + state.tilt.position_rad.abs() < 1e-6, "{state:?}");
            assert!(state.pan.velocity_rad_s.abs() + state.tilt.velocity_rad_s.abs() < 1e-3, "{state:?}");
        }
    }
}
