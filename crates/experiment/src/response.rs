//! What transfer functions answer to a step, an impulse or a ramp.

mod view;

use tracelight_linear::{Complex, Ending, Extreme, LinearError, Response, StepInfo, Time, TransferFunction};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::systems::{Named, Systems, bounded};

/// Systems and what comes into them.
#[derive(Clone, Debug)]
pub struct Request {
    /// The systems.
    pub systems: Systems,
    /// What comes in, from rest at time 0.
    pub input: Input,
    /// For how long, s; if not given, until the slowest that dies out has done so.
    pub duration_s: Option<f64>,
    /// How many values, evenly over that time; of samples each of them counts instead.
    pub points: u32,
}

/// What comes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// 1 from then on.
    Step,
    /// All at once, its integral over time 1; of samples one sample of 1.
    Impulse,
    /// Rising by 1 a second.
    Ramp,
}

/// What each system answers.
pub struct Finding {
    of: Request,
    entries: Vec<Entry>,
}

/// A system and its answer.
struct Entry {
    named: Named,
    /// What is plotted.
    response: Response,
    /// What it ends in, where that is known.
    ending: Option<Ending>,
    /// Its value furthest from zero, of all time.
    peak: Option<Extreme>,
    /// Of a step.
    info: Option<StepInfo>,
    /// Area of the impulse that goes straight through.
    impulse: f64,
    /// Poles that the output does not show.
    hidden: Vec<Complex>,
}

impl Input {
    const fn input(self) -> tracelight_linear::Input {
        match self {
            Self::Step => tracelight_linear::Input::Step,
            Self::Impulse => tracelight_linear::Input::Impulse,
            Self::Ramp => tracelight_linear::Input::Ramp,
        }
    }
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let systems = self.systems.systems()?;
        bounded(self.points, systems.len())?;
        let own = systems.iter().map(|named| named.system.lasts_s()).fold(0.0, f64::max);
        let duration_s = self.duration_s.unwrap_or(own);
        let entries =
            systems.into_iter().map(|named| self.entry(named, duration_s)).collect::<Result<_, _>>()?;
        Ok(Finding { of: self, entries })
    }
}

impl Request {
    fn entry(&self, named: Named, duration_s: f64) -> Result<Entry, Failure> {
        let name = named.name.clone();
        let failed = |message: String| Failure::failed("no-such-system", format!("{name}: {message}"));
        let count = match named.system.time() {
            Time::Continuous => f64::from(self.points),
            Time::Sampled(period_s) => (duration_s / period_s).floor() + 1.0,
        };
        if !(2.0..=100_000.0).contains(&count) {
            return Err(failed(format!(
                "{duration_s} s are {count} samples; between 2 and 100000 of them are shown: choose another --duration"
            )));
        }
        let step_s = duration_s / f64::from(self.points - 1);
        let entry = match named.system.time() {
            Time::Continuous => continuous(named, self.input, step_s, count as usize),
            Time::Sampled(_) => sampled(named, self.input, count as usize),
        };
        entry.map_err(|e| failed(e.to_string()))
    }
}

/// Within this share of its final value it is settled.
const BAND: f64 = 0.02;

fn continuous(named: Named, input: Input, step_s: f64, count: usize) -> Result<Entry, LinearError> {
    let transient = named.system.transient(input.input())?;
    let values = (0..count).map(|k| transient.at(k as f64 * step_s)).collect();
    let info = if input == Input::Step { Some(transient.step_info(BAND)?) } else { None };
    Ok(Entry {
        response: Response { step_s, values },
        ending: Some(transient.ending()),
        peak: info.map_or_else(|| transient.peak(), |info| Ok(info.peak))?,
        info,
        impulse: transient.impulse(),
        hidden: transient.hidden().to_vec(),
        named,
    })
}

fn sampled(named: Named, input: Input, count: usize) -> Result<Entry, LinearError> {
    let response = samples(&named.system, input, count)?;
    let info = if input == Input::Step { Some(named.system.step_info(BAND)?) } else { None };
    let (ending, peak) = (info.map(|info| info.ending), info.and_then(|info| info.peak));
    Ok(Entry { named, response, ending, peak, info, impulse: 0.0, hidden: Vec::new() })
}

fn samples(system: &TransferFunction, input: Input, count: usize) -> Result<Response, LinearError> {
    let period_s = match system.time() {
        Time::Continuous => 1.0,
        Time::Sampled(period_s) => period_s,
    };
    let input = |k: usize| match input {
        Input::Step => 1.0,
        Input::Impulse if k == 0 => 1.0,
        Input::Impulse => 0.0,
        Input::Ramp => k as f64 * period_s,
    };
    system.response(period_s, &(0..count).map(input).collect::<Vec<_>>())
}
