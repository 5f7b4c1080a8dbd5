//! Watches on the encoders: what a following-error limit alone never sees.

use tracelight_rig::{Fault, Joint, Measurement, PanTilt, TICK_S};

use crate::limit::within;
use crate::{Config, Effort, Estimate};

/// Share of Coulomb friction that must be overcome before a joint is expected to move: stiction and ripple of worn
/// heads stay under it.
const BREAK_AWAY_MARGIN: f32 = 1.6;
/// Predicted motion without any edge that means the encoder is dead, counts.
const DEAD_COUNTS: f32 = 4.0;
/// Count change a tick over what the fastest joint could make that means it jumped; noise of one edge either way is
/// not.
const JUMP_MARGIN: f32 = 1.5;
/// Nothing turns a head of this kind faster, whatever a plan may ask, rad/s: four turns a second.
const FASTEST_RAD_S: f32 = 24.0;

/// Cautious open-loop prediction of one joint since its last edge, from the speed it had there.
#[derive(Clone, Copy, Debug, Default)]
struct Expectation {
    rate_rad_s: f32,
    travel_rad: f32,
    /// Which way the last edge was crossed.
    way: i32,
    /// How long ago, ticks.
    since: f32,
}

/// State of both watches.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EncoderWatch {
    counts: PanTilt<i32>,
    expected: PanTilt<Expectation>,
}

impl EncoderWatch {
    pub(crate) fn new(measured: &PanTilt<Measurement>) -> Self {
        Self { counts: measured.map(|m| m.count), expected: PanTilt::default() }
    }

    /// One tick under what acted on the joints; the fault it shows, if any.
    pub(crate) fn tick(
        &mut self,
        config: &Config,
        efforts: &PanTilt<Effort>,
        estimates: &PanTilt<Estimate>,
        measured: &PanTilt<Measurement>,
    ) -> Option<Fault> {
        for joint in Joint::BOTH {
            let axis = &config.axes[joint];
            let moved = measured[joint].count.wrapping_sub(self.counts[joint]);
            self.counts[joint] = measured[joint].count;
            let fastest = axis.limits.speed_rad_s.max(FASTEST_RAD_S);
            let most = 1.0 + JUMP_MARGIN * fastest * TICK_S / axis.count_rad;
            if moved.unsigned_abs() as f32 > most {
                return Some(Fault::EncoderJumped);
            }
            let threshold = BREAK_AWAY_MARGIN * axis.friction.coulomb_nm();
            let Effort { torque_nm, bias_nm, inertia_kg_m2: inertia } = efforts[joint];
            let net = beyond(torque_nm - bias_nm, threshold);
            let expected = &mut self.expected[joint];
            if moved != 0 {
                expected.begin(moved, estimates[joint].velocity_rad_s, axis.count_rad);
            }
            expected.tick(net / inertia, threshold / inertia);
            if expected.travel_rad.abs() > DEAD_COUNTS * axis.count_rad {
                return Some(Fault::EncoderDead);
            }
        }
        None
    }
}

impl Expectation {
    /// At an edge: the observer's speed, but no more than this edge and the one before it show. Some observers take a
    /// single count for a speed of radians a second.
    fn begin(&mut self, moved: i32, rate_rad_s: f32, count_rad: f32) {
        let shown = moved.unsigned_abs() as f32 * count_rad / (self.since.max(1.0) * TICK_S);
        let way = moved.signum();
        let most = if way == self.way { shown } else { 0.0 };
        *self = Self { rate_rad_s: within(rate_rad_s, most), travel_rad: 0.0, way, since: 0.0 };
    }

    /// Friction brakes what moves whether or not the effort drives it on.
    fn tick(&mut self, acceleration: f32, braking: f32) {
        self.since += 1.0;
        if acceleration * self.rate_rad_s <= 0.0 {
            self.rate_rad_s = beyond(self.rate_rad_s, braking * TICK_S);
        }
        self.rate_rad_s += acceleration * TICK_S;
        self.travel_rad += self.rate_rad_s * TICK_S;
    }
}

/// What of `value` lies beyond ±`threshold`.
fn beyond(value: f32, threshold: f32) -> f32 {
    value - within(value, threshold)
}
