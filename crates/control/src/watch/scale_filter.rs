//! Estimates the scale between an encoder's angle and its joint's.

use tracelight_rig::{Measurement, TICK_S};

use crate::axis::AxisConfig;
use crate::crossed::{crossed, last_edge};
use crate::elementary::root;
use crate::estimate::{Effort, Learned};
use crate::limit::within;

const STATES: usize = 4;
const PLACE: usize = 0;
const SPEED: usize = 1;
const LOAD: usize = 2;
const SCALE: usize = 3;

/// One number a quantity.
type Row = [f32; STATES];

/// Standard deviation of where an edge lies, counts.
const EDGE_COUNTS: f32 = 0.07;
/// Spectral density of unexplained accelerations, (rad/s²)²·s.
const ANY_ACCELERATION: f32 = 7.5e-4;
/// Share of planned accelerations that belts and unknown inertia may add, and how long it lasts, s.
const SWINGING_SHARE: f32 = 0.08;
const SWINGING_S: f32 = 0.01;
/// Drift of the unknown torque per second, in shares² of that torque.
const LOAD_DRIFT: f32 = 5e-4;
/// Drift per radian of motion.
const LOAD_CHANGE: f32 = 0.2;
/// Drift per second near standstill, where friction lies anywhere between sliding and break-away.
const LOAD_STICKING: f32 = 4.0;
/// Drift at each reversal, where a friction error changes its sign.
const LOAD_REVERSED: f32 = 0.4;
/// Near standstill: slower than that, rad/s.
const STICKING_RAD_S: f32 = 0.06;
/// In motion, where friction is what it slides with: faster than that, rad/s.
const FAST_RAD_S: f32 = 0.12;
/// Slower, a joint creeps, rad/s, and how its edges come says nothing of the model.
const CREEPING_RAD_S: f32 = 0.02;
/// Most of it that may be unknown, shares².
const MOST_LOAD: f32 = 4.0;
/// What acts on a joint somebody pushes, deviations of the unknown torque.
const PUSH: f32 = 5.0;
/// How fast a joint may turn that counts as at rest, rad/s.
const RESTING_RAD_S: f32 = 0.01;
/// Standard deviation of the scale of an encoder of which nothing is known.
const ANY_SCALE: f32 = 0.5;
/// How slowly a scale may change that is known, 1/√s of motion.
const SCALE_DRIFT: f32 = 0.01;
/// Scales a filter keeps to: numbers must not run out.
const LEAST_SCALE: f32 = 0.02;
const MOST_SCALE: f32 = 20.0;

/// An extended Kalman filter of one joint's place, its true speed, the torque its model does not know, and the *scale* of its encoder:
/// the angle it shows over the angle the joint turns. It learns nothing else of the head, and the unknown torque only within
/// what friction can be: so what it cannot explain is either somebody who pushes or an encoder that slips.
///
/// The place is relative to the centre of the present count.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaleFilter {
    count: i32,
    lost_counts: i32,
    /// Whether an edge has said where in its count the joint is.
    placed: bool,
    offset_rad: f32,
    speed_rad_s: f32,
    load_nm: f32,
    scale: f32,
    covariance: [Row; STATES],
}

/// What a tick said of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Surprise {
    /// No edge came, and none is overdue.
    None,
    /// The first edge came, and says where in its count the joint is.
    Placed,
    /// An edge came, or is overdue, by so many standard deviations ahead of where it was expected.
    Edge(f32),
    /// An edge came, or is overdue, while the joint creeps and its friction is unpredictable.
    Creeping(f32),
    /// An edge came a whole count beside where it was expected, and is taken for its neighbour.
    Count,
}

impl ScaleFilter {
    /// Of a joint that reads that count and turns with that speed, rad/s, as far as is known.
    pub(super) fn begin(axis: &AxisConfig, count: i32, lost_counts: i32, speed_rad_s: f32) -> Self {
        let mut filter = Self {
            count,
            lost_counts,
            placed: false,
            offset_rad: 0.0,
            speed_rad_s,
            load_nm: 0.0,
            scale: 1.0,
            covariance: [[0.0; STATES]; STATES],
        };
        filter.open(axis, speed_rad_s.abs(), 1.0);
        filter
    }

    /// Of a joint at rest: forgets what acts on it, which may be somebody who leans on it, and the scale, unless that `goes_on`.
    pub(super) fn begin_test(&mut self, axis: &AxisConfig, goes_on: bool) {
        let (scale, variance) = (self.scale, self.covariance[SCALE][SCALE]);
        (self.load_nm, self.speed_rad_s, self.scale) = (0.0, 0.0, 1.0);
        self.open(axis, RESTING_RAD_S, PUSH);
        if goes_on {
            self.scale = scale;
            self.covariance[SCALE][SCALE] = variance;
        }
    }

    fn open(&mut self, axis: &AxisConfig, speed_rad_s: f32, torque: f32) {
        /// Of a joint that is at rest, rad/s.
        const STILL_RAD_S: f32 = 1e-3;
        let deviations = [axis.count_rad, speed_rad_s.max(STILL_RAD_S), torque * axis.unknown_nm, ANY_SCALE];
        for (i, deviation) in deviations.into_iter().enumerate() {
            self.covariance[i] = [0.0; STATES];
            self.covariance[i][i] = deviation * deviation;
        }
    }

    /// Shown angle over true angle.
    pub(super) const fn scale(&self) -> f32 {
        self.scale
    }

    /// Standard deviation of that.
    pub(super) fn scale_deviation(&self) -> f32 {
        root(self.covariance[SCALE][SCALE])
    }

    /// One tick. A scale that is `known` hardly drifts, and what surprises it is not explained by torques friction cannot have.
    pub(super) fn tick(
        &mut self,
        axis: &AxisConfig,
        effort: &Effort,
        measured: &Measurement,
        lost_counts: i32,
        known: bool,
    ) -> Surprise {
        self.predict(axis, effort, known);
        let count = measured.count.wrapping_add(lost_counts);
        // what was put back is no motion
        let put_back = lost_counts.wrapping_sub(self.lost_counts);
        let moved = count.wrapping_sub(self.count).wrapping_sub(put_back);
        (self.count, self.lost_counts) = (count, lost_counts);
        self.offset_rad -= moved as f32 * axis.count_rad;
        if moved == 0 {
            self.see_none(axis, known)
        } else {
            self.see_edge(axis, moved, measured.edge_age_ticks, known)
        }
    }

    fn predict(&mut self, axis: &AxisConfig, effort: &Effort, known: bool) {
        let (inertia, before) = (effort.inertia_kg_m2, self.speed_rad_s);
        let momentum = inertia * before + TICK_S * (effort.torque_nm - effort.bias_nm + self.load_nm);
        let angle = self.count as f32 * axis.count_rad + self.offset_rad;
        let as_identified = Learned { break_away_nm: axis.quirks.break_away_nm, ..Learned::default() };
        let friction = axis.friction.with_excess(axis.quirks.excess_nm(&as_identified, angle, before));
        let after = friction.resolve(momentum, inertia, TICK_S);
        let way = 0.5 * TICK_S * (before + after);
        self.offset_rad += self.scale * way;
        self.speed_rad_s = after;
        let sticks = before == 0.0 && after == 0.0;
        // a joint that is held does not turn faster for a little more torque
        let by_torque = if sticks { 0.0 } else { TICK_S / inertia };
        self.spread(way, by_torque, sticks);
        self.add_noise(axis.unknown_nm, (before, after), known);
    }

    /// P ← F P Fᵀ: the speed changes by the load, the place by the mean speed times the scale.
    fn spread(&mut self, way: f32, by_torque: f32, sticks: bool) {
        let p = &mut self.covariance;
        let half = 0.5 * TICK_S * self.scale;
        let keeps = if sticks { 0.0 } else { 1.0 };
        let (mut place, mut speed): (Row, Row) = ([0.0; STATES], [0.0; STATES]);
        for i in 0..STATES {
            speed[i] = keeps * p[SPEED][i] + by_torque * p[LOAD][i];
            place[i] = p[PLACE][i] + half * (p[SPEED][i] + speed[i]) + way * p[SCALE][i];
        }
        let crossed = keeps * place[SPEED] + by_torque * place[LOAD];
        let own = place[PLACE] + half * (place[SPEED] + crossed) + way * place[SCALE];
        speed[SPEED] = keeps * speed[SPEED] + by_torque * speed[LOAD];
        (speed[PLACE], place[SPEED], place[PLACE]) = (crossed, crossed, own);
        for i in 0..STATES {
            (p[PLACE][i], p[i][PLACE]) = (place[i], place[i]);
        }
        for i in 0..STATES {
            (p[SPEED][i], p[i][SPEED]) = (speed[i], speed[i]);
        }
    }

    fn add_noise(&mut self, unknown_nm: f32, (before, after): (f32, f32), known: bool) {
        let p = &mut self.covariance;
        let unknown = unknown_nm * unknown_nm;
        let way = 0.5 * TICK_S * (before + after).abs();
        let swinging = SWINGING_SHARE * (after - before) / TICK_S;
        p[SPEED][SPEED] += TICK_S * (ANY_ACCELERATION + SWINGING_S * swinging * swinging);
        let mut load = TICK_S * LOAD_DRIFT + way * LOAD_CHANGE;
        if after != 0.0 && after.abs() < STICKING_RAD_S {
            load += TICK_S * LOAD_STICKING;
        }
        let turns = before * after <= 0.0 && before != after;
        load += if turns { LOAD_REVERSED } else { 0.0 };
        p[LOAD][LOAD] += load * unknown;
        if known {
            p[LOAD][LOAD] = p[LOAD][LOAD].min(MOST_LOAD * unknown);
            p[SCALE][SCALE] += if after != 0.0 { TICK_S * SCALE_DRIFT * SCALE_DRIFT } else { 0.0 };
        }
    }

    fn see_edge(&mut self, axis: &AxisConfig, moved: i32, age_ticks: Option<f32>, known: bool) -> Surprise {
        let width = axis.count_rad;
        let (number, side) = last_edge(self.count, moved);
        let edge = (side + axis.quirks.edges_counts[(number & 3) as usize]) * width;
        let shown = self.scale * self.speed_rad_s;
        let (age_s, blur) = crossed(moved, age_ticks, shown);
        let noise = EDGE_COUNTS * width;
        let variance = noise * noise + blur * blur / 12.0;
        let mut innovation = edge - (self.offset_rad - age_s * shown);
        let miscounted = known && self.is_miscount(axis, innovation);
        if miscounted {
            let by = if innovation > 0.0 { width } else { -width };
            self.offset_rad += by;
            innovation -= by;
        }
        let creeps = known && self.speed_rad_s.abs() < CREEPING_RAD_S;
        let deviations = self.correct(innovation, variance);
        let first = !core::mem::replace(&mut self.placed, true);
        match (miscounted, first) {
            (true, _) => Surprise::Count,
            (false, true) => Surprise::Placed,
            (false, false) if creeps => Surprise::Creeping(deviations),
            (false, false) => Surprise::Edge(deviations),
        }
    }

    /// Whether a joint in fast motion shows an edge about a whole count beside where it is expected: a count was lost or made up.
    fn is_miscount(&self, axis: &AxisConfig, innovation: f32) -> bool {
        const FROM_COUNTS: f32 = 0.6;
        const TO_COUNTS: f32 = 1.4;
        let counts = innovation.abs() / axis.count_rad;
        self.speed_rad_s.abs() > FAST_RAD_S && (FROM_COUNTS..TO_COUNTS).contains(&counts)
    }

    /// No edge in this tick: the joint is still within its count.
    fn see_none(&mut self, axis: &AxisConfig, known: bool) -> Surprise {
        /// Slack for an overdue edge near standstill, counts: edges are often late there.
        const SLACK_COUNTS: f32 = 0.1;
        /// Slack in motion, counts, so that one lost count is tolerated.
        const FAST_SLACK_COUNTS: f32 = 1.3;
        /// Standard deviation of what that says, counts.
        const OVERDUE_COUNTS: f32 = 0.3;
        let inside = within(self.offset_rad, 0.5 * axis.count_rad);
        if !self.placed {
            self.offset_rad = inside;
            return Surprise::None;
        }
        let fast = known && self.speed_rad_s.abs() > STICKING_RAD_S;
        let slack = if fast { FAST_SLACK_COUNTS } else { SLACK_COUNTS } * axis.count_rad;
        if (self.offset_rad - inside).abs() <= slack {
            return Surprise::None;
        }
        let noise = OVERDUE_COUNTS * axis.count_rad;
        let creeps = known && self.speed_rad_s.abs() < CREEPING_RAD_S;
        let deviations = self.correct(inside - self.offset_rad, noise * noise);
        if creeps { Surprise::Creeping(deviations) } else { Surprise::Edge(deviations) }
    }

    /// Kalman update: the place is `innovation` ahead of the estimate, ± √`variance`. How many deviations that is.
    fn correct(&mut self, innovation: f32, variance: f32) -> f32 {
        /// Rounding must not make a variance negative.
        const LEAST: f32 = 1e-14;
        let p = &mut self.covariance;
        let seen = p.map(|line| line[PLACE]);
        let total = seen[PLACE] + variance;
        let gain = seen.map(|entry| entry / total);
        for (i, line) in p.iter_mut().enumerate() {
            for (j, entry) in line.iter_mut().enumerate() {
                *entry -= gain[i] * seen[j];
            }
            line[i] = line[i].max(LEAST);
        }
        self.offset_rad += gain[PLACE] * innovation;
        self.speed_rad_s += gain[SPEED] * innovation;
        self.load_nm += gain[LOAD] * innovation;
        self.scale = (self.scale + gain[SCALE] * innovation).clamp(LEAST_SCALE, MOST_SCALE);
        innovation / root(total)
    }
}
