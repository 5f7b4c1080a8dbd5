//! What one controller does with each of several systems, and with which it does worst.

use serde_json::{Value, json};
use tracelight_linear::{
    Delayed, Input, LinearError, Margins, Response, Stability, StepInfo, TransferFunction, decibels,
};

use crate::named::Named;
use crate::numbers::four;

/// A system's loop with the controller.
pub(super) struct Member {
    name: String,
    stability: Stability,
    margins: Margins,
    info: StepInfo,
    /// What comes out after a step, at the times of the first system's.
    pub(super) step: Vec<f64>,
}

impl Member {
    /// The loop of a system with `k`, its step at the times of `like`.
    ///
    /// # Errors
    /// [`LinearError::AlgebraicLoop`], [`LinearError::Sampling`] of times that do not go together, and as [`Delayed::closed_answer`].
    pub(super) fn of(named: Named, k: &TransferFunction, like: &Response) -> Result<Self, LinearError> {
        const BAND: f64 = 0.02;
        let open = k.series(&named.system)?;
        let times = (0..like.values.len()).map(|i| i as f64 * like.step_s);
        let (exact, stability, info, step) = match &named.late {
            Some(late) => {
                let exact = late.open.series(&k.clone().into())?;
                let answer = exact.closed_answer(Input::Step, like.step_s * like.values.len() as f64)?;
                let stability = exact.closed_growing().stability().unwrap_or(Stability::Growing);
                (exact, stability, answer.step_info(BAND)?, times.map(|t| answer.at(t)).collect())
            }
            None => {
                let closed = open.closed()?;
                let step = closed.step_response(like.step_s, like.values.len())?.values;
                let (stability, info) = (closed.stability(), closed.step_info(BAND)?);
                (Delayed::from(open), stability, info, step)
            }
        };
        Ok(Self { name: named.name, stability, margins: exact.margins(), info, step })
    }

    /// The figures of a loop that was looked at already.
    pub(super) fn known(name: &str, stability: Stability, margins: &Margins, info: StepInfo) -> Self {
        Self { name: name.to_owned(), stability, margins: margins.clone(), info, step: Vec::new() }
    }

    fn is_stable(&self) -> bool {
        self.stability == Stability::Stable
    }

    /// A figure; none where there is none, or where the loop is not stable.
    fn figure(&self, which: Figure) -> Option<f64> {
        let value = match which {
            Figure::Phase => self.margins.least_phase().map(|m| m.degrees()),
            Figure::Gain => self.margins.least_gain().map(|m| decibels(m.factor)),
            Figure::Sensitivity => self.margins.modulus.map(|m| 1.0 / m.distance),
            Figure::Crossover => self.margins.least_phase().map(|m| m.rad_s),
            Figure::Overshoot => self.info.overshoot_percent,
            Figure::Settling => self.info.settle_s,
        };
        value.filter(|value| value.is_finite() && self.is_stable())
    }
}

/// What a loop is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Figure {
    Phase,
    Gain,
    Sensitivity,
    Crossover,
    Overshoot,
    Settling,
}

impl Figure {
    const ALL: [Self; 6] =
        [Self::Phase, Self::Gain, Self::Sensitivity, Self::Crossover, Self::Overshoot, Self::Settling];

    const fn title(self) -> &'static str {
        match self {
            Self::Phase => "phase, °",
            Self::Gain => "gain, dB",
            Self::Sensitivity => "Ms",
            Self::Crossover => "at, rad/s",
            Self::Overshoot => "over, %",
            Self::Settling => "settle, s",
        }
    }

    const fn key(self) -> &'static str {
        match self {
            Self::Phase => "phase_deg",
            Self::Gain => "gain_db",
            Self::Sensitivity => "sensitivity",
            Self::Crossover => "crossover_rad_s",
            Self::Overshoot => "overshoot_percent",
            Self::Settling => "settle_s",
        }
    }

    /// How bad a value is; none where neither way is worse.
    fn badness(self, value: f64) -> Option<f64> {
        match self {
            Self::Phase | Self::Gain => Some(-value.abs()),
            Self::Sensitivity | Self::Overshoot | Self::Settling => Some(value),
            Self::Crossover => None,
        }
    }

    /// The number of the worst of several.
    fn worst(self, members: &[Member]) -> Option<usize> {
        let bad = |(number, member): (usize, &Member)| Some((number, self.badness(member.figure(self)?)?));
        let all = members.iter().enumerate().filter_map(bad);
        all.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(number, _)| number)
    }
}

/// A line for each system, the worst of each figure marked.
pub(super) fn lines(members: &[Member]) -> String {
    let width = members.iter().map(|member| member.name.chars().count()).max().unwrap_or(0).max(6);
    let mut text = format!("\nwith each system\n    {:width$}", "system");
    for figure in Figure::ALL {
        text += &format!(" {:>9}", figure.title());
    }
    for (number, member) in members.iter().enumerate() {
        text += &format!("\n    {:width$}", member.name);
        if !member.is_stable() {
            text += "  NOT stable once it is closed";
            continue;
        }
        for figure in Figure::ALL {
            let mark = if figure.worst(members) == Some(number) { "*" } else { " " };
            let value = member.figure(figure).map_or("–".to_owned(), four);
            text += &format!(" {:>9}", value + mark);
        }
    }
    text + "\n    * the worst of all systems\n"
}

/// The systems for scripts, and which has the worst of each figure.
pub(super) fn json(members: &[Member]) -> Value {
    let one = |member: &Member| {
        let mut object = json!({"name": member.name, "closed_stable": member.is_stable()});
        for figure in Figure::ALL {
            object[figure.key()] = member.figure(figure).into();
        }
        object
    };
    let mut worst = json!({});
    for figure in Figure::ALL.into_iter().filter(|figure| *figure != Figure::Crossover) {
        worst[figure.key()] = figure.worst(members).map(|number| members[number].name.clone()).into();
    }
    json!({"each": members.iter().map(one).collect::<Vec<_>>(), "worst": worst})
}
