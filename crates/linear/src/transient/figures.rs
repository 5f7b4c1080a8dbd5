//! What a response to a step is judged by.

use crate::LinearError;
use crate::transient::closed_form::Transient;
use crate::transient::ending::Ending;
use crate::transient::sweep::Sweep;

/// A largest or smallest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// When it is first reached, s; none if it is only approached.
    pub time_s: Option<f64>,
}

/// What a response to a step is judged by. What has no final value has none of these figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepInfo {
    /// What it ends in.
    pub ending: Ending,
    /// From the first 10 % to the first 90 % of the final value, s; none of a final value of 0.
    pub rise_s: Option<f64>,
    /// When it first is at 10 % of the final value, s: where the rise begins; none of a final value of 0.
    pub rise_from_s: Option<f64>,
    /// Last moment at which it is not within the band about the final value, s; none of a final value of 0.
    pub settle_s: Option<f64>,
    /// Furthest excursion beyond the final value, % of it; none of a final value of 0.
    pub overshoot_percent: Option<f64>,
    /// Furthest excursion to the other side of zero, % of the final value; none of a final value of 0.
    pub undershoot_percent: Option<f64>,
    /// Value furthest from zero.
    pub peak: Option<Extreme>,
}

impl StepInfo {
    /// Of what has no final value.
    pub(crate) const fn none(ending: Ending) -> Self {
        Self {
            ending,
            rise_s: None,
            rise_from_s: None,
            settle_s: None,
            overshoot_percent: None,
            undershoot_percent: None,
            peak: None,
        }
    }
}

impl Transient {
    /// Figures of a response to a step; settled is within that share of the final value.
    ///
    /// # Errors
    /// [`LinearError::NotConverged`] if it swings for too long to be looked at everywhere.
    pub fn step_info(&self, band: f64) -> Result<StepInfo, LinearError> {
        let Some(goal) = self.ending.value() else { return Ok(StepInfo::none(self.ending)) };
        let sign = if goal < 0.0 { -1.0 } else { 1.0 };
        let beyond = self.largest(sign)?;
        let below = self.largest(-sign)?;
        // of two alike the one that is reached
        let peak = if below.value.abs() > beyond.value.abs() { below } else { beyond };
        let mut info = StepInfo { peak: Some(peak), ..StepInfo::none(self.ending) };
        if goal != 0.0 {
            info.overshoot_percent = Some(100.0 * (beyond.value / goal - 1.0).max(0.0));
            info.undershoot_percent = Some(100.0 * (-below.value / goal).max(0.0));
            let from_s = self.first_at(0.1 * goal)?;
            info.rise_s = Some(self.first_at(0.9 * goal)? - from_s);
            info.rise_from_s = Some(from_s);
            info.settle_s = Some(self.last_at(band)?);
        }
        Ok(info)
    }

    /// Value furthest from zero, if it converges.
    ///
    /// # Errors
    /// As for [`step_info`](Self::step_info).
    pub fn peak(&self) -> Result<Option<Extreme>, LinearError> {
        if self.ending.value().is_none() {
            return Ok(None);
        }
        let [above, below] = [self.largest(1.0)?, self.largest(-1.0)?];
        Ok(Some(if below.value.abs() > above.value.abs() { below } else { above }))
    }

    fn goal(&self) -> f64 {
        self.ending.value().unwrap_or_default()
    }

    /// The sweep over its modes, judged by how far it goes.
    fn sweep(&self) -> Option<Sweep<'_>> {
        Sweep::new(&self.sum, self.goal().abs().max(self.at(0.0).abs()))
    }

    fn seconds(&self, time: f64) -> f64 {
        time / self.sum.per_second
    }

    /// Furthest value to one side.
    fn largest(&self, sign: f64) -> Result<Extreme, LinearError> {
        let goal = self.goal();
        let Some(mut sweep) = self.sweep() else { return Ok(Extreme { value: goal, time_s: Some(0.0) }) };
        let (most, time) = sweep.largest(sign)?;
        Ok(Extreme { value: goal + sign * most, time_s: time.map(|time| self.seconds(time)) })
    }

    /// When the output first is at a level between 0 and its final value, s.
    fn first_at(&self, level: f64) -> Result<f64, LinearError> {
        let goal = self.goal();
        let sign = goal.signum();
        let reached = self.sweep().map_or(Ok(0.0), |mut sweep| sweep.first_at(sign * (level - goal), sign));
        reached.map(|time| self.seconds(time))
    }

    /// When it last is a share of its final value away from it, s.
    fn last_at(&self, band: f64) -> Result<f64, LinearError> {
        let limit = band * self.goal().abs();
        let last = self.sweep().map_or(Ok(0.0), |mut sweep| sweep.last_at(limit));
        last.map(|time| self.seconds(time))
    }

    /// How long a plot of it has to be, s: see [`TransferFunction::lasts_s`](crate::TransferFunction::lasts_s); 0 of a constant.
    pub fn lasts_s(&self) -> f64 {
        const SHARE: f64 = 1e-3;
        self.seconds(self.sum.lasts(SHARE))
    }
}
