use tracelight_rig::{Fault, Measurement, TICK_S};

use crate::axis::AxisConfig;
use crate::estimate::{Effort, Estimate};
use crate::finding::Finding;
use crate::limit::within;

/// Share of Coulomb friction that must be overcome before a joint is expected to move: stiction and ripple of worn
/// heads stay under it.
const BREAK_AWAY_MARGIN: f32 = 1.6;
/// Further margin over the estimated load and friction, standard deviations: somebody who pushed a moment ago may push differently now.
const LOAD_DEVIATIONS: f32 = 2.0;
/// Upper limit of all these margins, as a share of the motor's torque, so that a line cut after a push is still detected.
const MOST_HOLDING: f32 = 0.6;
/// Predicted motion without any edge that makes an encoder doubtful, counts.
const DOUBT_COUNTS: f32 = 4.0;
/// Ticks of doubt after which the encoder counts as dead. Somebody who holds the head looks alike.
pub(super) const DOUBT_TICKS: u32 = 20;
/// Counts beside where the joint can be that mean it jumped: a kick that moves a joint by one count within a tick
/// gives it 3000 rad/s², and breaks it. An observer that knows no more than the count is half a count off by itself, and
/// noise of a count either way is not a jump. A jump of three counts is always seen, of two if the joint was near an edge.
const JUMP_COUNTS: f32 = 1.5;
/// Counts beside it that are a surprise: an observer that knows no more than the count is half a count off at every edge.
const SURPRISE_COUNTS: f32 = 0.6;
/// Surprises back and forth together that mean noise, counts; what was is forgotten by a share of a 50th a tick. Whoever
/// pushes a joint surprises too, but in one direction.
const NOISE_COUNTS: f32 = 3.0;
const NOISE_FADES: f32 = 1.0 / 50.0;
/// How much more speed than counts, over some 20 ticks, means that an observer has lost its joint, counts. The slowest
/// observer, 64 ticks of differences, is 3.4 off while a joint speeds up with 8 rad/s².
const DIVERGED_COUNTS: f32 = 6.0;
const DIVERGENCE_FADES: f32 = 1.0 / 20.0;
/// Counts put back that make an encoder a bad one, each forgotten by a share of a 5000th a tick: three within some seconds.
const BAD_COUNTS: f32 = 2.5;
const BAD_FADES: f32 = 1.0 / 5000.0;

/// Watch on one encoder: what a following-error limit alone never sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct EncoderWatch {
    count: i32,
    believed: Estimate,
    expected: Expectation,
    surprises: f32,
    /// Counts put back of late.
    put_back: f32,
    /// Speed believed beyond what was counted, rad.
    gap_rad: f32,
    /// The observer put a count back a moment ago.
    recounts: bool,
    doubtful_ticks: u32,
}

impl EncoderWatch {
    pub(super) fn new(measured: &Measurement, estimate: &Estimate) -> Self {
        Self {
            count: measured.count,
            believed: *estimate,
            expected: Expectation::default(),
            surprises: 0.0,
            put_back: 0.0,
            gap_rad: 0.0,
            recounts: false,
            doubtful_ticks: 0,
        }
    }

    /// One tick under what acted on the joint; the fault it shows, if any.
    pub(super) fn tick(
        &mut self,
        axis: &AxisConfig,
        effort: &Effort,
        estimate: &Estimate,
        measured: &Measurement,
    ) -> Option<Finding> {
        let moved = measured.count.wrapping_sub(self.count);
        self.count = measured.count;
        let before = core::mem::replace(&mut self.believed, *estimate);
        let surprise = surprise_counts(axis, &before, before.count(measured));
        if surprise > JUMP_COUNTS {
            return Some(Finding::beyond(Fault::EncoderJumped, surprise, JUMP_COUNTS));
        }
        let back = moved.signum() * self.expected.way < 0;
        self.surprises -= NOISE_FADES * self.surprises;
        self.surprises += if back && surprise > SURPRISE_COUNTS { surprise } else { 0.0 };
        let put_back = estimate.lost_counts.wrapping_sub(before.lost_counts).unsigned_abs();
        self.put_back += put_back as f32 - BAD_FADES * self.put_back;
        if self.surprises > NOISE_COUNTS {
            return Some(Finding::beyond(Fault::EncoderNoisy, self.surprises, NOISE_COUNTS));
        }
        if self.put_back > BAD_COUNTS {
            return Some(Finding::beyond(Fault::EncoderNoisy, self.put_back, BAD_COUNTS));
        }
        self.recounts = estimate.is_doubtful;
        self.doubt(axis, effort, estimate, moved);
        if self.doubtful_ticks > DOUBT_TICKS {
            let counts = self.expected.travel_rad.abs() / axis.count_rad;
            return Some(Finding::beyond(Fault::EncoderDead, counts, DOUBT_COUNTS));
        }
        self.watch_gap(axis, estimate, moved);
        let (gap_rad, most_rad) = (self.gap_rad.abs(), DIVERGED_COUNTS * axis.count_rad);
        (gap_rad > most_rad)
            .then(|| Finding::beyond(Fault::EstimateDiverged, gap_rad / axis.count_rad, DIVERGED_COUNTS))
    }

    /// Whether the laser is better dark until an edge comes.
    pub(super) const fn is_doubtful(&self) -> bool {
        self.doubtful_ticks > 0 || self.recounts
    }

    fn doubt(&mut self, axis: &AxisConfig, effort: &Effort, estimate: &Estimate, moved: i32) {
        if moved != 0 {
            self.expected.begin(moved, axis, estimate);
        }
        let threshold = self.expected.holding_nm.max(BREAK_AWAY_MARGIN * axis.unknown_nm);
        // who pushed may have let go
        let (alone, loaded) = (effort.torque_nm - effort.bias_nm, self.expected.load_nm);
        let net = nearer(beyond(alone, threshold), beyond(alone + loaded, threshold));
        self.expected.tick(net / effort.inertia_kg_m2, threshold / effort.inertia_kg_m2);
        let missing = self.expected.travel_rad.abs() > DOUBT_COUNTS * axis.count_rad;
        self.doubtful_ticks = if missing { self.doubtful_ticks.saturating_add(1) } else { 0 };
    }

    fn watch_gap(&mut self, axis: &AxisConfig, estimate: &Estimate, moved: i32) {
        self.gap_rad -= DIVERGENCE_FADES * self.gap_rad;
        self.gap_rad += estimate.velocity_rad_s * TICK_S - moved as f32 * axis.count_rad;
    }
}

/// How far from where the joint was to be expected a tick later the nearest end of a count is, counts.
fn surprise_counts(axis: &AxisConfig, before: &Estimate, count: i32) -> f32 {
    let expected = (before.position_rad + TICK_S * before.velocity_rad_s) / axis.count_rad;
    ((expected - count as f32).abs() - 0.5).max(0.0)
}

/// Cautious open-loop prediction of one joint since its last edge, from the speed it had there.
#[derive(Clone, Copy, Debug, Default)]
struct Expectation {
    rate_rad_s: f32,
    travel_rad: f32,
    /// Load that was known at the last edge, N m. What is taken for one later may be how a dead encoder looks.
    load_nm: f32,
    /// Torque that friction and what is not known of the load may hold, N m.
    holding_nm: f32,
    /// Which way the last edge was crossed.
    way: i32,
    /// How long ago, ticks.
    since: f32,
}

impl Expectation {
    /// At an edge: the observer's speed, but no more than this edge and the one before it show. Some observers take a
    /// single count for a speed of radians a second.
    fn begin(&mut self, moved: i32, axis: &AxisConfig, estimate: &Estimate) {
        let shown = moved.unsigned_abs() as f32 * axis.count_rad / (self.since.max(1.0) * TICK_S);
        let way = moved.signum();
        let most = if way == self.way { shown } else { 0.0 };
        let (rate_rad_s, load_nm) = (within(estimate.velocity_rad_s, most), estimate.learned.load_nm);
        let unknown = axis.unknown_nm
            + (estimate.learned.friction_nm + estimate.learned.break_away_nm).max(0.0)
            + LOAD_DEVIATIONS * estimate.torque_deviation_nm;
        let holding_nm = unknown.min(MOST_HOLDING * axis.torque_nm_per_v * axis.limit_v);
        *self = Self { rate_rad_s, travel_rad: 0.0, load_nm, holding_nm, way, since: 0.0 };
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

/// The one nearer to zero; zero if they lie on either side of it.
fn nearer(a: f32, b: f32) -> f32 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() < b.abs() {
        a
    } else {
        b
    }
}

/// What of `value` lies beyond ±`threshold`.
fn beyond(value: f32, threshold: f32) -> f32 {
    value - within(value, threshold)
}
