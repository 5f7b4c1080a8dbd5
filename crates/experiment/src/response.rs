//! What transfer functions answer to a step, an impulse or a ramp.

mod view;

use tracelight_linear::{LinearError, Polynomial, Response, StepInfo, Time, TransferFunction};
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
    response: Response,
    /// Of a step.
    info: Option<StepInfo>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let systems = self.systems.systems()?;
        bounded(self.points, systems.len())?;
        let own = systems.iter().map(|named| named.system.settling_horizon_s()).fold(0.0, f64::max);
        let duration_s = self.duration_s.unwrap_or(own);
        let entries =
            systems.into_iter().map(|named| self.entry(named, duration_s)).collect::<Result<_, _>>()?;
        Ok(Finding { of: self, entries })
    }
}

impl Request {
    fn entry(&self, named: Named, duration_s: f64) -> Result<Entry, Failure> {
        let failed =
            |message: String| Failure::failed("no-such-system", format!("{}: {message}", named.name));
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
        let response =
            answer(&named.system, self.input, step_s, count as usize).map_err(|e| failed(e.to_string()))?;
        // within this share of the goal it is settled
        const BAND: f64 = 0.02;
        let info =
            (self.input == Input::Step).then(|| response.step_info(Some(named.system.dc_gain()), BAND));
        Ok(Entry { named, response, info })
    }
}

fn answer(
    system: &TransferFunction,
    input: Input,
    step_s: f64,
    count: usize,
) -> Result<Response, LinearError> {
    let variable = Polynomial::new([1.0, 0.0]);
    match (system.time(), input) {
        (_, Input::Step) => system.step_response(step_s, count),
        // an impulse is a step's slope, a ramp its integral
        (Time::Continuous, Input::Impulse) => {
            let slope = TransferFunction::new(variable, Polynomial::one(), Time::Continuous)?;
            system.series(&slope)?.step_response(step_s, count)
        }
        (Time::Continuous, Input::Ramp) => {
            let integral = TransferFunction::new(Polynomial::one(), variable, Time::Continuous)?;
            system.series(&integral)?.step_response(step_s, count)
        }
        (Time::Sampled(_), Input::Impulse) => {
            let first: Vec<f64> = (0..count).map(|k| if k == 0 { 1.0 } else { 0.0 }).collect();
            system.response(step_s, &first)
        }
        (Time::Sampled(period_s), Input::Ramp) => {
            let rising: Vec<f64> = (0..count).map(|k| k as f64 * period_s).collect();
            system.response(step_s, &rising)
        }
    }
}
