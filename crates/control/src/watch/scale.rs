//! Checks that an encoder shows the angle its joint turns.

use tracelight_rig::{Fault, Measurement};

use super::scale_filter::{ScaleFilter, Surprise};
use crate::axis::AxisConfig;
use crate::estimate::{Effort, Estimate};
use crate::finding::Finding;
use crate::limit::within;

/// Standard deviation up to which a scale counts as known.
const KNOWN: f32 = 0.045;
/// Standard deviation up to which the first scale counts as well known.
const WELL: f32 = 0.012;
/// How far from its first value it may turn out to be, deviations.
const LIKELY: f32 = 2.0;
/// Mean square of the last surprises, in deviations², up to which it is the scale that they speak of, and not somebody who pushes.
const CLEAN: f32 = 2.5;
/// An edge counts for that share of the mean.
const MEAN_SHARE: f32 = 0.1;
/// Largest difference between a scale and the one found first, as a share: inertia and motors do not change by that.
const CHANGED: f32 = 0.1;
/// Significance required of such a difference, deviations.
const SURE: f32 = 3.0;
/// How sure the first verdict has to be, deviations.
const DEVIATIONS: f32 = 3.0;
/// Largest difference between two tests that show one scale, as a share.
const SAME: f32 = 0.15;
/// Consecutive tests with one scale that are a fault.
const TESTS: u32 = 5;
/// Deviation allowed per surprise in a cumulative sum (Page, *Continuous inspection schemes*, Biometrika 1954). Surprises in one
/// direction add up; each counts only what exceeds this.
const ALLOWED: f32 = 0.7;
/// Largest contribution of one surprise, deviations.
const MOST_OF_ONE: f32 = 4.0;
/// Threshold of the cumulative sum, deviations: healthy heads come to 2, worn ones to 5.
const ENOUGH: f32 = 8.0;
/// Threshold of lost or spurious counts in close succession; each is forgotten over 20 edges.
const MISCOUNTS: f32 = 2.5;
const MISCOUNT_FADES: f32 = 0.05;

/// Watch on how one encoder's counts belong to what its motor does. Beside the observer, which learns what a head is made of
/// so that it can follow it, this one learns nothing but the encoder's scale: a slip that an observer takes for inertia, load or friction
/// is a slip here.
///
/// It does not trust an encoder before it has seen it follow the motor (*untested*), nor after a surprise. Untested, there is no light on
/// a stroke; a move in the dark tells.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaleWatch {
    filter: ScaleFilter,
    trust: Trust,
    /// The scale that was found first since power-up, and its standard deviation.
    first: Option<(f32, f32)>,
    /// Where it may lie, once more is known of it.
    may_be: (f32, f32),
    /// Surprises that add up, either way.
    ahead: f32,
    behind: f32,
    miscounts: f32,
    mean_square: f32,
}

/// What is held of an encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Trust {
    /// The encoder has not yet been seen to follow its motor.
    Untested,
    /// The encoder has followed its motor, without contrary evidence since.
    Tested,
    /// Something spoke against it. There were so many tests since, and so many of them in a row have shown this scale, which is not its own.
    Doubted { tests: u32, shown: f32, times: u32 },
}

impl Trust {
    /// Something spoke against it just now.
    const DOUBTED: Self = Self::Doubted { tests: 0, shown: 0.0, times: 0 };
}

impl ScaleWatch {
    /// Untested.
    pub(super) fn new(axis: &AxisConfig, measured: &Measurement, estimate: &Estimate) -> Self {
        let lost = estimate.lost_counts;
        let count = estimate.count(measured);
        Self {
            filter: ScaleFilter::begin(axis, count, lost, estimate.velocity_rad_s),
            trust: Trust::Untested,
            first: None,
            may_be: (0.0, 0.0),
            ahead: 0.0,
            behind: 0.0,
            miscounts: 0.0,
            mean_square: 0.0,
        }
    }

    /// Keeps the first scale that was found, from the state `before`.
    pub(super) const fn with_first(mut self, before: &Self) -> Self {
        self.first = before.first;
        self.may_be = before.may_be;
        if self.first.is_some() {
            self.trust = Trust::DOUBTED;
        }
        self
    }

    /// Whether the encoder has followed its motor, and nothing spoke against it since.
    pub(super) fn is_tested(&self) -> bool {
        self.trust == Trust::Tested
    }

    /// One tick under what acted on the joint; what it said of the model.
    pub(super) fn tick(
        &mut self,
        axis: &AxisConfig,
        effort: &Effort,
        estimate: &Estimate,
        measured: &Measurement,
    ) -> Surprise {
        let tested = self.is_tested();
        let surprise = self.filter.tick(axis, effort, measured, estimate.lost_counts, tested);
        self.add_up(surprise);
        if tested {
            // between two edges nothing is learned that could change what was held
            if surprise != Surprise::None {
                self.judge();
            }
        } else if self.trust == Trust::Untested && self.is_surely_within(axis) {
            // any motion in the dark will do before the first light
            self.believe();
        }
        surprise
    }

    fn judge(&mut self) {
        if self.is_suspicious() {
            self.trust = Trust::DOUBTED;
        } else {
            self.better_first();
        }
    }

    /// The joint rests, and a move follows that shows what its encoder makes of it.
    pub(super) fn begin_test(&mut self, axis: &AxisConfig) {
        if !self.is_tested() {
            // what a move has told that was not enough adds to the next
            let goes_on =
                matches!(self.trust, Trust::Doubted { tests, .. } if tests > 0) && self.mean_square < CLEAN;
            self.filter.begin_test(axis, goes_on);
            self.clear();
        }
    }

    /// Ends the test move and returns the fault it showed, if any. Several tests must agree: somebody may have pushed, or the supply may
    /// have been weak for a moment.
    pub(super) fn end_test(&mut self, axis: &AxisConfig) -> Option<Finding> {
        if self.is_tested() {
            return None;
        }
        if self.is_conclusive() && self.is_within(axis) {
            self.believe();
            return None;
        }
        let scale = self.filter.scale();
        let (tests, before) = match self.trust {
            Trust::Doubted { tests, shown, times } if (scale - shown).abs() < SAME * shown => (tests, times),
            Trust::Doubted { tests, .. } => (tests, 0),
            Trust::Untested | Trust::Tested => (0, 0),
        };
        let times = if self.is_surely_off(axis) { before + 1 } else { 0 };
        // one that has shown something stands for itself
        let tests = if times > 0 { 0 } else { tests.saturating_add(1) };
        self.trust = Trust::Doubted { tests, shown: scale, times };
        let fault = if self.first.is_some() { Fault::EncoderSlipping } else { Fault::EncoderScale };
        let (off, most) = self.off(axis);
        (times >= TESTS).then(|| Finding::beyond(fault, off, most))
    }

    fn add_up(&mut self, surprise: Surprise) {
        match surprise {
            Surprise::None | Surprise::Placed => {}
            Surprise::Edge(deviations) => self.add_edge(deviations),
            Surprise::Creeping(_) => self.add_edge(0.0),
            Surprise::Count => self.miscounts += 1.0,
        }
    }

    fn add_edge(&mut self, deviations: f32) {
        let one = within(deviations, MOST_OF_ONE);
        self.ahead = (self.ahead + one - ALLOWED).max(0.0);
        self.behind = (self.behind - one - ALLOWED).max(0.0);
        self.miscounts = (self.miscounts - MISCOUNT_FADES).max(0.0);
        self.mean_square += MEAN_SHARE * (deviations * deviations - self.mean_square);
    }

    fn is_suspicious(&self) -> bool {
        let unsure = self.first.map_or(0.0, |(_, deviation)| deviation) + self.filter.scale_deviation();
        let changed = self.change_of_scale() > CHANGED + SURE * unsure;
        self.ahead.max(self.behind) > ENOUGH || self.miscounts > MISCOUNTS || changed
    }

    /// How far the scale is beyond both the one that was found first and the model's, which is one, as a share: whoever pushed while the first was
    /// found made it wrong, and what the model has is right at any time.
    fn change_of_scale(&self) -> f32 {
        let Some((first, _)) = self.first else { return 0.0 };
        let scale = self.filter.scale();
        let nearest = scale.max(first.min(1.0)).min(first.max(1.0));
        (scale / nearest - 1.0).abs()
    }

    /// Whether the scale is known, and nobody pushed who would make it wrong.
    fn is_conclusive(&self) -> bool {
        self.filter.scale_deviation() < KNOWN && self.mean_square < CLEAN
    }

    /// How far the scale is from what it was, or from what the model has where nothing was known of it, and how far it may be: shares.
    fn off(&self, axis: &AxisConfig) -> (f32, f32) {
        match self.first {
            Some((_, deviation)) => (self.change_of_scale(), CHANGED + DEVIATIONS * deviation),
            None => (beside(self.filter.scale()), axis.scale_tolerance),
        }
    }

    fn is_within(&self, axis: &AxisConfig) -> bool {
        let (off, most) = self.off(axis);
        off <= most
    }

    /// Whether the scale is not what it may be, however little is known of it, and nobody pushed.
    fn is_surely_off(&self, axis: &AxisConfig) -> bool {
        let (off, most) = self.off(axis);
        off - DEVIATIONS * self.filter.scale_deviation() > most && self.mean_square < CLEAN
            || (self.is_conclusive() && off > most)
    }

    /// Whether the scale is what the model allows, however little is known of it, and nobody pushed who would make it wrong.
    fn is_surely_within(&self, axis: &AxisConfig) -> bool {
        let most = beside(self.filter.scale()) + DEVIATIONS * self.filter.scale_deviation();
        most <= axis.scale_tolerance && self.mean_square < CLEAN
    }

    fn believe(&mut self) {
        self.trust = Trust::Tested;
        self.better_first();
        self.clear();
    }

    /// What was found first is known better as the joint goes on moving, until it is known well enough: whoever pushes later is not to
    /// change it, nor a slip to take it along.
    fn better_first(&mut self) {
        let (scale, deviation) = (self.filter.scale(), self.filter.scale_deviation());
        let Some((first, before)) = self.first else {
            self.first = Some((scale, deviation));
            self.may_be = (scale - LIKELY * deviation, scale + LIKELY * deviation);
            return;
        };
        let is_likely = self.may_be.0 <= scale && scale <= self.may_be.1;
        if is_likely && before > WELL && deviation < before {
            self.first = Some((scale, deviation));
        } else if beside(scale) + deviation < beside(first) {
            // nearer to the model: it was found wrong
            self.first = None;
            self.better_first();
        }
    }

    fn clear(&mut self) {
        (self.ahead, self.behind, self.miscounts, self.mean_square) = (0.0, 0.0, 0.0, 0.0);
    }
}

/// How far a scale is from one, as a share, whichever way.
fn beside(scale: f32) -> f32 {
    scale.max(1.0 / scale) - 1.0
}
