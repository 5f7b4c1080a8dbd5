use tracelight_rig::Measurement;

use super::kalman::{Fit, Kalman, Misfit};
use super::tuning::KalmanTuning;
use crate::axis::AxisConfig;
use crate::estimate::{Effort, Estimate};

/// [`Kalman`] filters that notice when their encoder lost a count or made one up, and put it back.
///
/// A wrong count looks like nothing else: the joint seems to jump by up to a whole count, and goes on as fast as before. Whoever
/// pushes it changes its speed. So when an edge surprises, or is overdue, a rival filter begins that takes the count to be wrong, and
/// for some edges both see the same. The rival is believed when it is much likelier (a test of two hypotheses by their
/// likelihoods; Bar-Shalom, Li & Kirubarajan, *Estimation with Applications to Tracking and Navigation*, §11.6), and either nobody
/// could have pushed as hard as the other one needs, or some edges in a row came just where it expected them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recount {
    believed: Hypothesis,
    contest: Option<Contest>,
}

/// A filter that takes so many counts to be lost.
#[derive(Clone, Copy, Debug)]
struct Hypothesis {
    filter: Kalman,
    lost: i32,
    /// By how much an edge has been overdue since the last one, squares of standard deviations.
    overdue: f32,
}

/// Two that see the same.
#[derive(Clone, Copy, Debug)]
struct Contest {
    rival: Hypothesis,
    /// Whether this hypothesis was believed before and may be restored.
    was_believed: bool,
    ticks: u32,
    edges: u32,
    /// Twice the logarithm of the odds in the rival's favour.
    evidence: f32,
    /// What would have had to push the believed one at most, N m.
    load_nm: f32,
    /// How far an edge was off the rival at most, counts.
    off_counts: f32,
    /// Something was beyond three standard deviations of the rival.
    is_surprised: bool,
}

impl Recount {
    pub(super) fn begin(axis: &AxisConfig, count: i32, speed_rad_s: f32, tuning: KalmanTuning) -> Self {
        let filter = Kalman::begin(axis, count, speed_rad_s, tuning);
        Self { believed: Hypothesis { filter, lost: 0, overdue: 0.0 }, contest: None }
    }

    /// Takes `lost_counts` counts to be lost.
    pub(super) fn with_lost(mut self, lost_counts: i32) -> Self {
        let Hypothesis { filter, lost, .. } = &mut self.believed;
        filter.renumber(filter.count().wrapping_add(lost_counts.wrapping_sub(*lost)));
        *lost = lost_counts;
        self
    }

    pub(super) fn tick(&mut self, axis: &AxisConfig, effort: &Effort, measured: &Measurement) {
        let moved = self.believed.predict(axis, effort, measured);
        let before =
            (self.contest.is_none() && self.believed.may_surprise(axis, moved)).then_some(self.believed);
        let (fit, cost) = self.believed.correct(axis, effort, moved, measured);
        let moved = if let Some(contest) = &mut self.contest {
            contest.rival.predict(axis, effort, measured)
        } else {
            let (Some(before), Some((by, truly))) = (before, explained(&fit, moved)) else { return };
            let contest = self.contest.insert(Contest::of(before));
            contest.rival.lose(axis, by);
            if fit.edge.is_none() {
                contest.rival.overdue = 0.0;
            }
            truly
        };
        let Some(contest) = &mut self.contest else { return };
        let (rival_fit, less) = contest.rival.correct(axis, effort, moved, measured);
        contest.weigh(&fit, &rival_fit, cost - less);
        let decided = contest.is_open() && contest.is_won(axis);
        if decided {
            core::mem::swap(&mut self.believed, &mut contest.rival);
        }
        // what is won back is not contested again
        if decided && !contest.was_believed {
            contest.turn();
        } else if decided || !contest.is_open() {
            self.contest = None;
        }
    }

    pub(super) fn estimate(&self, axis: &AxisConfig) -> Estimate {
        let is_doubtful = self.contest.is_some_and(|contest| contest.was_believed);
        Estimate {
            lost_counts: self.believed.lost,
            is_doubtful,
            ..self.believed.filter.estimate(axis.count_rad)
        }
    }
}

impl Contest {
    /// Evidence that outweighs how rare a wrong count is: what five standard deviations are worth.
    const ENOUGH: f32 = 25.0;
    /// Edges that have to fit where it may have been a push.
    const FEW: u32 = 3;

    fn of(rival: Hypothesis) -> Self {
        Self {
            rival,
            was_believed: false,
            ticks: 0,
            edges: 0,
            evidence: 0.0,
            off_counts: 0.0,
            load_nm: 0.0,
            is_surprised: false,
        }
    }

    /// What was believed is the rival now.
    fn turn(&mut self) {
        *self = Self { was_believed: true, evidence: -self.evidence, ..Self::of(self.rival) };
    }

    /// Takes how a tick fitted the believed one and the rival, and how much more it cost the former.
    fn weigh(&mut self, fit: &Fit, rival_fit: &Fit, cost: f32) {
        /// What is off by less may be a misplaced edge, counts.
        const FAR: f32 = 0.4;
        self.ticks = self.ticks.saturating_add(1);
        self.evidence += cost;
        self.edges += u32::from(rival_fit.edge.is_some());
        if let Some(edge) = fit.edge.filter(|edge| edge.is_surprise() && edge.counts.abs() > FAR) {
            self.load_nm = self.load_nm.max(edge.load_nm);
        }
        self.is_surprised |= [rival_fit.edge, rival_fit.overdue].iter().flatten().any(Misfit::is_surprise);
        if let Some(edge) = rival_fit.edge {
            self.off_counts = self.off_counts.max(edge.counts.abs());
        }
    }

    /// Whether the rival is to be believed from now on.
    fn is_won(&self, axis: &AxisConfig) -> bool {
        /// Nobody pushes with so many times what a motor can.
        const STRONGER: f32 = 3.0;
        /// A push of this share of it is not so weak that a joint would go on as before.
        const FIRM: f32 = 0.25;
        /// Edges of a joint that was pushed are not all this close to where the rival expects them, counts.
        const CLOSE: f32 = 0.2;
        let most_nm = axis.torque_nm_per_v * axis.limit_v;
        let enough = |edges, evidence, share| {
            self.edges >= edges
                && self.evidence > evidence
                && self.load_nm > share * most_nm
                && self.off_counts < CLOSE
        };
        if self.was_believed {
            return self.evidence > Self::ENOUGH;
        }
        enough(0, Self::ENOUGH, STRONGER) || enough(Self::FEW, 2.0 * Self::ENOUGH, FIRM)
    }

    fn is_open(&self) -> bool {
        /// Edges after which a rival has lost, however close it is.
        const MANY: u32 = 12;
        /// Ticks after which what was believed has lost: a joint may come to rest meanwhile, and light waits.
        const SOON: u32 = 50;
        /// Ticks after which a rival has lost.
        const LATE: u32 = 500;
        if self.was_believed {
            self.edges < Self::FEW && self.ticks < SOON
        } else {
            !self.is_surprised && self.evidence > -Self::ENOUGH && self.edges < MANY && self.ticks < LATE
        }
    }
}

impl Hypothesis {
    /// A tick passes; edges that it sees in it.
    fn predict(&mut self, axis: &AxisConfig, effort: &Effort, measured: &Measurement) -> i32 {
        self.filter.predict(axis, effort);
        self.filter.take_count(axis, measured.count.wrapping_add(self.lost))
    }

    /// Takes them; how that fitted, and minus twice the logarithm of its likelihood.
    fn correct(
        &mut self,
        axis: &AxisConfig,
        effort: &Effort,
        moved: i32,
        measured: &Measurement,
    ) -> (Fit, f32) {
        /// One edge says no more than that.
        const MOST: f32 = 100.0;
        let fit = self.filter.correct(axis, effort.inertia_kg_m2, moved, measured.edge_age_ticks);
        let mut cost = 0.0;
        if let Some(edge) = fit.edge {
            cost += edge.squared.min(MOST) + libm::logf(edge.variance);
            self.overdue = 0.0;
        }
        if let Some(overdue) = fit.overdue {
            // what is overdue for many ticks is so once
            let most = overdue.squared.min(MOST).max(self.overdue);
            cost += most - self.overdue;
            self.overdue = most;
        }
        (fit, cost)
    }

    /// Whether what it then sees may be a wrong count: it is known where the joint is, on it goes, and it is not where it was.
    fn may_surprise(&self, axis: &AxisConfig, moved: i32) -> bool {
        /// A joint slower than this, counts/s, may just have stalled.
        const SLOW_COUNTS_S: f32 = 30.0;
        let leaves = moved != 0 || !self.filter.is_in_its_count(axis);
        let creeps = self.filter.velocity_rad_s().abs() < SLOW_COUNTS_S * axis.count_rad;
        leaves && !creeps && self.filter.is_calm()
    }

    /// Becomes one that explains what did not fit it, with so many more counts lost, before it sees the edges that truly came.
    fn lose(&mut self, axis: &AxisConfig, by: i32) {
        self.lost = self.lost.wrapping_add(by);
        let _ = self.filter.take_count(axis, self.filter.count().wrapping_add(by));
    }
}

/// How many counts more than is believed are lost, if a tick that did not fit is to be explained, and how many edges then truly came in it.
fn explained(fit: &Fit, moved: i32) -> Option<(i32, i32)> {
    /// What is off a whole count by more than this many standard deviations squared is not off by a whole count.
    const WHOLE: f32 = 9.0;
    match (fit.edge, fit.overdue) {
        (Some(edge), _) if edge.is_surprise() => {
            let early = edge.counts * moved as f32 > 0.0;
            let beside = edge.counts.abs() - 1.0;
            Some(if early && beside * beside > WHOLE * edge.variance {
                // it came from nowhere, or one of them did
                (-moved.signum(), moved - moved.signum())
            } else {
                (if edge.counts > 0.0 { -1 } else { 1 }, moved)
            })
        }
        // it came, and was not counted
        (None, Some(overdue)) => Some((if overdue.counts > 0.0 { -1 } else { 1 }, 0)),
        _ => None,
    }
}
