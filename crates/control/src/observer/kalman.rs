use tracelight_rig::TICK_S;

use super::covariance::{
    BREAK_AWAY, Covariance, DEVIATIONS_SQUARED, FRICTION, INERTIA, LOAD, POSITION, Row, STATES, VELOCITY,
};
use super::edge_table::EdgeTable;
use super::tuning::KalmanTuning;
use crate::axis::AxisConfig;
use crate::crossed::{crossed, last_edge};
use crate::elementary::root;
use crate::estimate::{Effort, Estimate, Learned};
use crate::limit::within;

/// Surprises that a filter begins with: what it knows is to be tried at some edges first.
const BEGUN: f32 = 1.0;

/// How far a joint may be learned to differ from its model, shares of its Coulomb friction and of its inertia.
const LEAST_FRICTION: f32 = -0.6;
const MOST_FRICTION: f32 = 1.5;
const LEAST_BREAK_AWAY: f32 = -0.1;
const MOST_BREAK_AWAY: f32 = 1.0;
const MOST_INERTIA: f32 = 0.6;

/// A Kalman filter whose predictor knows the joint's equation with friction that sticks (the set-valued Coulomb law),
/// and whose measurements are what an incremental encoder really says: *at this instant the joint was exactly on this
/// edge* (an edge with its age), and *now it is somewhere within this count* (a bound).
///
/// What it does not know of the head is part of its state (an extended filter; Jazwinski, *Stochastic Processes and
/// Filtering Theory*, §8): a load, what friction has more than the model, at speed and near standstill, and inertia.
/// Friction turns with the velocity and a load does not, so one reversal tells them apart; what was learned of
/// friction on one side of a reversal is what makes the other side exact, where for tens of milliseconds no edge comes.
///
/// Angles are relative to the centre of the present count, so that `f32` resolves nanoradians.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kalman {
    tuning: KalmanTuning,
    count: i32,
    /// Whether an edge has said where in its count the joint is.
    homed: bool,
    offset_rad: f32,
    velocity_rad_s: f32,
    acceleration_rad_s2: f32,
    since_edge_s: f32,
    edges: EdgeTable,
    /// Edges of late that came where they should not; to begin counts for [`BEGUN`].
    surprises: f32,
    learned: Learned,
    covariance: Covariance,
}

impl Kalman {
    pub(super) fn begin(axis: &AxisConfig, count: i32, speed_rad_s: f32, tuning: KalmanTuning) -> Self {
        let unknown = axis.unknown_nm;
        // anywhere in its count: the deviation of an even distribution
        let anywhere = axis.count_rad / root(12.0);
        let covariance = Covariance::independent(&[
            anywhere,
            speed_rad_s,
            tuning.load.deviation * unknown,
            tuning.friction.deviation * unknown,
            tuning.break_away.deviation * unknown,
            tuning.inertia.deviation,
        ]);
        Self {
            tuning,
            count,
            homed: false,
            offset_rad: 0.0,
            velocity_rad_s: 0.0,
            acceleration_rad_s2: 0.0,
            since_edge_s: 0.0,
            edges: EdgeTable::about(axis.quirks.edges_counts, tuning.edge_noise_counts),
            surprises: BEGUN,
            learned: Learned { break_away_nm: axis.quirks.break_away_nm, ..Learned::default() },
            covariance,
        }
    }

    /// One step of the equation of motion, by the same time stepping as an exact plant would use.
    pub(super) fn predict(&mut self, axis: &AxisConfig, effort: &Effort) {
        /// How sure it has to be that a joint stays at rest, standard deviations.
        const SURE: f32 = 2.0;
        /// The velocity of a joint that is held depends on nothing.
        const HELD: Row = [0.0; STATES];
        let before = self.velocity_rad_s;
        let inertia = effort.inertia_kg_m2 * (1.0 + self.learned.inertia_share);
        let gain = TICK_S / inertia;
        let angle = self.count as f32 * axis.count_rad + self.offset_rad;
        let friction = axis.friction.with_excess(axis.quirks.excess_nm(&self.learned, angle, before));
        let drive = effort.torque_nm - effort.bias_nm + self.learned.load_nm;
        let momentum = inertia * before + TICK_S * drive;
        let after = friction.resolve(momentum, inertia, TICK_S);
        // at rest, nothing surprised the last edges, and whatever is not known of the torques does not break it away
        let held = before == 0.0 && after == 0.0 && self.is_calm() && {
            let doubt = SURE * TICK_S * self.covariance.deviation_of_torque();
            friction.resolve(momentum + doubt, inertia, TICK_S) == 0.0
                && friction.resolve(momentum - doubt, inertia, TICK_S) == 0.0
        };
        // whether it slides or is about to, this is the way it goes or would go
        let against = if momentum < 0.0 { gain } else { -gain };
        let row = [
            0.0,
            1.0,
            gain,
            against,
            against * axis.quirks.break_away_share(before),
            (before - after) / (1.0 + self.learned.inertia_share),
        ];
        self.since_edge_s += TICK_S;
        self.offset_rad += 0.5 * TICK_S * (before + after);
        self.acceleration_rad_s2 = (after - before) / TICK_S;
        self.velocity_rad_s = after;
        self.covariance.predict(if held { &HELD } else { &row }, &self.noise(axis.unknown_nm));
    }

    /// What a tick adds to the variances.
    fn noise(&self, unknown_nm: f32) -> Row {
        let tuning = &self.tuning;
        let level = unknown_nm * unknown_nm;
        let way = TICK_S * self.velocity_rad_s.abs();
        [
            0.0,
            TICK_S * tuning.acceleration_noise,
            TICK_S * tuning.load.drift * level,
            (TICK_S * tuning.friction.drift + way * tuning.friction_change) * level,
            TICK_S * tuning.break_away.drift * level,
            TICK_S * tuning.inertia.drift,
        ]
    }

    /// Takes the joint to be on that count; where it is stays. Counts it passed.
    pub(super) fn take_count(&mut self, axis: &AxisConfig, count: i32) -> i32 {
        let moved = count.wrapping_sub(self.count);
        self.count = count;
        self.offset_rad -= moved as f32 * axis.count_rad;
        moved
    }

    /// Calls the count it is on otherwise.
    pub(super) const fn renumber(&mut self, count: i32) {
        self.count = count;
    }

    /// Takes `moved` edges, the last of them so long ago, or that none came. How well that fits what was expected.
    pub(super) fn correct(
        &mut self,
        axis: &AxisConfig,
        inertia_kg_m2: f32,
        moved: i32,
        age_ticks: Option<f32>,
    ) -> Fit {
        let width = axis.count_rad;
        let edge = if moved == 0 { None } else { Some(self.see_edge(axis, inertia_kg_m2, moved, age_ticks)) };
        let inside = within(self.offset_rad, 0.5 * width);
        let tuning = &self.tuning;
        let mut overdue = None;
        if !self.homed {
            // it began anywhere in its count: that it has not left it says nothing of the model
            self.offset_rad = inside;
        } else if (self.offset_rad - inside).abs() > tuning.bound_slack_counts * width {
            let noise = tuning.bound_noise_counts * width;
            let innovation = self.innovation(inside, 0.0);
            let slack = tuning.bound_slack_counts * width;
            overdue =
                Some(Misfit::of(innovation, self.covariance.variance_of_place(0.0) + slack * slack, width));
            self.observe(axis, innovation, (0.0, noise * noise), false);
        }
        Fit { edge, overdue }
    }

    fn see_edge(
        &mut self,
        axis: &AxisConfig,
        inertia_kg_m2: f32,
        moved: i32,
        age_ticks: Option<f32>,
    ) -> Misfit {
        let width = axis.count_rad;
        let (number, side) = last_edge(self.count, moved);
        let (off, placed) = self.edges.place(number);
        let edge = (side + off) * width;
        let (age_s, blur) = crossed(moved, age_ticks, self.velocity_rad_s);
        let variance = placed * width * width + blur * blur / 12.0;
        let innovation = self.innovation(edge, age_s);
        // the first edge says where in its count the joint began, nothing else
        let misfit = Misfit::of(innovation, self.covariance.variance_of_place(age_s) + variance, width);
        let surprised = misfit.is_surprise();
        let early_rad = innovation.abs() - blur.abs();
        let load_nm = self.explaining_nm(inertia_kg_m2, early_rad);
        let misfit = Misfit { load_nm, ..misfit };
        let pushed = self.homed && surprised && self.is_pushed(axis, load_nm, early_rad);
        if self.homed && !surprised {
            let all = (self.covariance.variance_of_place(age_s) + variance) / (width * width);
            self.edges.learn(number, innovation / width, all);
        }
        self.doubt_edges(surprised);
        self.homed = true;
        self.since_edge_s = age_s;
        self.observe(axis, innovation, (age_s, variance), pushed);
        misfit
    }

    /// Whether it knows where the joint is, and nothing surprised it of late.
    pub(super) fn is_calm(&self) -> bool {
        /// One surprise fades to that over seven edges.
        const CALM: f32 = 0.5;
        self.homed && self.surprises < CALM
    }

    /// Whether it takes the joint to be within the count it is on.
    pub(super) fn is_in_its_count(&self, axis: &AxisConfig) -> bool {
        self.offset_rad.abs() <= 0.5 * axis.count_rad
    }

    /// How fast the joint is taken to turn, rad/s.
    pub(super) const fn velocity_rad_s(&self) -> f32 {
        self.velocity_rad_s
    }

    /// The count the joint is taken to be on.
    pub(super) const fn count(&self) -> i32 {
        self.count
    }

    /// Who pushes surprises some edges; a count that was lost makes every edge one of another kind than it is taken for, and
    /// surprises for ever. Then nothing is known of where edges lie any more.
    fn doubt_edges(&mut self, surprised: bool) {
        /// Weight of an edge relative to the one after it.
        const FADES: f32 = 0.9;
        /// Threshold for lost counts, reached when some ten of the last fifteen edges surprise.
        const LOST: f32 = 6.5;
        /// How far misplaced an edge may be, deviations of one of which nothing is known.
        const ANYWHERE: f32 = 2.0;
        self.surprises = FADES * self.surprises + if surprised { 1.0 } else { 0.0 };
        if self.surprises > LOST {
            self.surprises = BEGUN;
            self.edges = EdgeTable::about([0.0; 4], ANYWHERE * self.tuning.edge_noise_counts);
        }
    }

    /// Whether an edge came so early or late that only somebody who pushes explains it; a load is then suspected that
    /// makes such a difference in the time since the last edge.
    fn is_pushed(&mut self, axis: &AxisConfig, load_nm: f32, early_rad: f32) -> bool {
        /// Counts that neither friction nor two misplaced edges are off from one edge to the next.
        const PUSHED_COUNTS: f32 = 0.4;
        /// Shares of Coulomb friction that break-away and ripple of a worn head stay well under.
        const PUSHED_SHARE: f32 = 3.0;
        let far = early_rad > PUSHED_COUNTS * axis.count_rad;
        let pushed = far && load_nm > PUSHED_SHARE * axis.unknown_nm;
        if pushed {
            self.covariance.suspect_load(within(load_nm, axis.torque_nm_per_v * axis.limit_v));
        }
        pushed
    }

    /// What would have to push since the last edge for this one to come so early or late, N m.
    fn explaining_nm(&self, inertia_kg_m2: f32, early_rad: f32) -> f32 {
        /// Shortest time a load is reckoned over, s: what is faster is a blow.
        const SHORTEST_S: f32 = 0.005;
        let time = self.since_edge_s.max(SHORTEST_S);
        2.0 * early_rad.max(0.0) * inertia_kg_m2 / (time * time)
    }

    /// How far ahead of the estimate the joint was `age_s` ago, if it was there, rad.
    fn innovation(&self, offset_rad: f32, age_s: f32) -> f32 {
        let bend = 0.5 * age_s * age_s * self.acceleration_rad_s2;
        offset_rad - (self.offset_rad - age_s * self.velocity_rad_s + bend)
    }

    /// Kalman update: `age_s` ago the joint was `innovation` ahead of the estimate, ± √`variance`.
    fn observe(&mut self, axis: &AxisConfig, innovation: f32, (age_s, variance): (f32, f32), pushed: bool) {
        self.covariance.expect(innovation, age_s, variance);
        let step = self.covariance.update(age_s, variance, pushed).map(|gain| gain * innovation);
        self.offset_rad += step[POSITION];
        self.velocity_rad_s += step[VELOCITY];
        self.learned.learn(&step, axis.unknown_nm);
    }

    pub(super) fn estimate(&self, count_rad: f32) -> Estimate {
        Estimate {
            // whatever the model says, the joint is in its count
            position_rad: self.count as f32 * count_rad + within(self.offset_rad, 0.5 * count_rad),
            velocity_rad_s: self.velocity_rad_s,
            acceleration_rad_s2: self.acceleration_rad_s2,
            learned: self.learned,
            lost_counts: 0,
            is_doubtful: false,
            torque_deviation_nm: self.covariance.deviation_of_torque(),
        }
    }
}

/// How what an encoder says fits what was expected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// Misfit of the edge that came.
    pub(super) edge: Option<Misfit>,
    /// Misfit of the edge that is overdue.
    pub(super) overdue: Option<Misfit>,
}

/// How far something is off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Misfit {
    /// Of the joint ahead of where it was expected, counts.
    pub(super) counts: f32,
    /// Square of that in standard deviations (the normalized innovation squared).
    pub(super) squared: f32,
    /// Variance it was expected with, counts².
    pub(super) variance: f32,
    /// What would have to push for it to be true, N m.
    pub(super) load_nm: f32,
}

impl Misfit {
    fn of(innovation: f32, variance: f32, width: f32) -> Self {
        let square = width * width;
        Self {
            counts: innovation / width,
            squared: innovation * innovation / variance,
            variance: variance / square,
            load_nm: 0.0,
        }
    }

    /// Beyond three standard deviations.
    pub(super) fn is_surprise(&self) -> bool {
        self.squared > DEVIATIONS_SQUARED
    }
}

impl Learned {
    fn learn(&mut self, step: &Row, unknown_nm: f32) {
        let held = |value: f32, least: f32, most: f32| value.max(least).min(most);
        self.load_nm += step[LOAD];
        self.friction_nm =
            held(self.friction_nm + step[FRICTION], LEAST_FRICTION * unknown_nm, MOST_FRICTION * unknown_nm);
        self.break_away_nm = held(
            self.break_away_nm + step[BREAK_AWAY],
            LEAST_BREAK_AWAY * unknown_nm,
            MOST_BREAK_AWAY * unknown_nm,
        );
        self.inertia_share = within(self.inertia_share + step[INERTIA], MOST_INERTIA);
    }
}
