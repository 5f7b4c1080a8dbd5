//! A controller from wishes, and the loop it makes: margins, step, poles.

pub mod lqr;
mod lqr_view;
mod panels;
pub mod pid;
mod set;
mod view;

use tracelight_chart::Theme;
use tracelight_linear::{
    Complex, DelayMargin, Delayed, Input, LeadLagWish, LinearError, LqgWish, Margins, Response, Stability,
    StepInfo, Time, TransferFunction, Zpk, four_digits,
};
use tracelight_maths::complex;
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Task};

use crate::design::pid::{PidDesign, PidRequest, Weighted};
use crate::design::set::Member;
use crate::finding::Experiment;
use crate::named::Named;
use crate::systems::{OneSystem, controller};
use crate::trial::Trial;

/// A system and the controller that is wished for it.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is controlled.
    pub system: OneSystem,
    /// Others that it has to do for: of a PID the margins hold with each; other controllers are tried with each.
    pub also: Vec<String>,
    /// How the controller is found.
    pub method: Method,
    /// A rig that it drives, too.
    pub tried: Option<TriedOn>,
}

/// How a controller is found.
#[derive(Clone, Debug)]
pub enum Method {
    /// As many leads as the phase margin asks for, and a lag.
    LeadLag(LeadLagWish),
    /// The P, PI, PD or PID with the largest gain that keeps the margins.
    Pid(PidRequest),
    /// State feedback that costs least, the state estimated by a Kalman filter.
    Lqg(LqgWish),
    /// State feedback and an estimator with these poles, pairs complete.
    Place {
        /// Of the regulator: as many as the system has, or one more.
        regulator: Vec<Complex>,
        /// Of the estimator; if not given, those of the regulator, four times as fast.
        estimator: Option<Vec<Complex>>,
    },
    /// One that is given.
    Given(Zpk),
}

/// A simulated rig whose joint a controller drives, from a jump of its setpoint.
#[derive(Clone, Debug)]
pub struct TriedOn {
    /// The rig.
    pub rig: RigConfig,
    /// The joint.
    pub joint: Joint,
    /// How far it jumps, rad.
    pub to_rad: f64,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// Order beyond which digits run out, and time.
const MOST_ORDER: usize = 24;

/// What was designed, and what it does.
pub struct Finding {
    name: String,
    plant: TransferFunction,
    controller: Zpk,
    /// The controller in its own figures, and what its setpoint weights do, if it is a PID.
    pid: Option<(PidDesign, Weighted)>,
    /// The closed loop, and the margins of the open one.
    closed: TransferFunction,
    margins: Margins,
    delay_margin: DelayMargin,
    /// What rational figures of it are worth, if it has a dead time.
    note: String,
    /// What comes out, and what the controller puts in, after a step of what is wished.
    step: Response,
    input: Response,
    /// The largest of the input; none where it is an impulse, or grows.
    peak: Option<f64>,
    stability: Stability,
    /// Figures of the step.
    info: StepInfo,
    trial: Option<Trial>,
    /// The system and the others that it has to do for; none where there are no others.
    set: Vec<Member>,
    theme: Theme,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let named = self.system.system()?;
        let others = self.system.others(&self.also)?;
        let (name, plant) = (named.name.clone(), named.system.clone());
        others.iter().chain([&named]).try_for_each(check_order)?;
        let failed = |e: LinearError| {
            let remedy = match e {
                LinearError::Unbounded { offer_rad_s, .. } => {
                    format!(": the missing wish is --crossover {}rad/s", four_digits(offer_rad_s))
                }
                _ => String::new(),
            };
            Failure::failed("no-such-design", format!("{name}: {e}{remedy}"))
        };
        let tried_with = |joint: Joint, on: TriedOn, controller: &Zpk, pid: Option<&PidDesign>| match pid {
            Some(pid) => Trial::by_pid(on.rig, joint, (on.to_rad, on.seed), (pid, &plant)),
            None => Trial::of(on.rig, joint, (on.to_rad, on.seed), controller),
        };
        let (controller, pid) = self.method.controller(&plant, &rational(&others)).map_err(failed)?;
        let trial = self.tried.map(|on| tried_with(on.joint, on, &controller, pid.as_ref())).transpose()?;
        let designed = Designed { named, controller, pid };
        let finding = Finding::of(designed, trial, self.system.theme).map_err(failed)?;
        finding.with_others(others).map_err(failed)
    }
}

impl Method {
    /// A controller in continuous time that is given as a formula.
    ///
    /// # Errors
    /// `bad-formula`: what is wrong with it, and where.
    pub fn given(formula: &str) -> Result<Self, Failure> {
        controller(formula).map(Self::Given)
    }

    fn controller(
        &self,
        plant: &TransferFunction,
        others: &[TransferFunction],
    ) -> Result<(Zpk, Option<PidDesign>), LinearError> {
        match self {
            Self::LeadLag(wish) => Ok((plant.lead_lag(*wish)?, None)),
            Self::Pid(request) => {
                let design = request.design(plant, others)?;
                Ok((design.pid.transfer_in(plant.time())?.zpk(), Some(design)))
            }
            Self::Given(controller) => Ok((controller.clone(), None)),
            Self::Lqg(wish) => Ok((plant.lqg(wish)?, None)),
            Self::Place { regulator, estimator } => {
                let own = || faster(regulator, plant);
                let estimator = estimator.clone().unwrap_or_else(own);
                Ok((plant.placed(regulator, &estimator)?, None))
            }
        }
    }
}

/// As many poles as the system has, four times as fast as these.
fn faster(poles: &[Complex], plant: &TransferFunction) -> Vec<Complex> {
    let mut poles = poles.to_vec();
    if poles.len() > plant.denominator().degree() {
        // the integral's is not estimated: a real pole less, or one for a pair
        match poles.iter().position(|pole| pole.im == 0.0) {
            Some(real) => drop(poles.remove(real)),
            None => {
                let size = match plant.time() {
                    Time::Continuous => -complex::norm(poles[0]),
                    Time::Sampled(_) => complex::norm(poles[0]),
                };
                poles.splice(..2, [Complex::new(size, 0.0)]);
            }
        }
    }
    let four_times = |pole: &Complex| match plant.time() {
        Time::Continuous => 4.0 * pole,
        Time::Sampled(_) => pole * pole * pole * pole,
    };
    poles.iter().map(four_times).collect()
}

/// Refuses what is of too high an order.
fn check_order(named: &Named) -> Result<(), Failure> {
    let order = named.system.denominator().degree().max(named.system.numerator().degree());
    if order <= MOST_ORDER {
        return Ok(());
    }
    let message = format!(
        "{} is of order {order}; controllers are designed for systems up to order {MOST_ORDER}",
        named.name
    );
    Err(Failure::failed("no-such-design", message))
}

/// Systems for a search; with a dead time nearly the same.
fn rational(systems: &[Named]) -> Vec<TransferFunction> {
    systems.iter().map(|named| named.system.clone()).collect()
}

/// A controller for a plant.
struct Designed {
    named: Named,
    controller: Zpk,
    pid: Option<PidDesign>,
}

impl Finding {
    fn of(designed: Designed, trial: Option<Trial>, theme: Theme) -> Result<Self, LinearError> {
        let Designed { named, controller, pid } = designed;
        let plant = named.system.clone();
        let k = match &pid {
            Some(design) => design.pid.transfer_in(plant.time())?,
            None => controller.transfer(),
        };
        let open = k.series(&plant)?;
        let closed = open.closed()?;
        let to_input = k.feedback(&plant)?;
        let stability = closed.stability();
        let weigh = |design: PidDesign| design.weighted(&plant).map(|weighted| (design, weighted));
        let pid = pid.map(weigh).transpose()?;
        // what the dead time leaves exactly
        let exact = match &named.late {
            Some(late) => late.open.series(&k.clone().into())?,
            None => Delayed::from(open),
        };
        let (step, info) =
            if named.late.is_some() { settled_exactly(&exact)? } else { settled_step(&closed)? };
        // what a derivative without an end puts in is an impulse: it has no step
        let input = to_input.step_response(step.step_s, step.values.len()).unwrap_or_default();
        let peak = input_peak(&to_input, &input);
        let [step, input] = [step, input].map(shown);
        let margins = exact.margins();
        let delay_margin = exact.delay_margin(&margins);
        Ok(Self {
            note: named.approximated(),
            name: named.name,
            delay_margin,
            plant,
            controller,
            pid,
            closed,
            margins,
            step,
            input,
            peak,
            stability,
            info,
            trial,
            set: Vec::new(),
            theme,
        })
    }

    /// What the controller does with other systems, too.
    fn with_others(mut self, others: Vec<Named>) -> Result<Self, LinearError> {
        if others.is_empty() {
            return Ok(self);
        }
        let k = match &self.pid {
            Some((design, _)) => design.pid.transfer_in(self.plant.time())?,
            None => self.controller.transfer(),
        };
        self.set = vec![Member::known(&self.name, self.stability, &self.margins, self.info)];
        for named in others {
            self.set.push(Member::of(named, &k, &self.step)?);
        }
        Ok(self)
    }
}

/// Rows of a step in continuous time.
const ROWS: usize = 2000;
/// Within this share of the final value it is settled.
const BAND: f64 = 0.02;
/// Times the settling time: some rest after it shows that it is one.
const SHOWN: f64 = 1.6;

/// The step of a loop with a dead time, of which this is the open one.
fn settled_exactly(open: &Delayed) -> Result<(Response, StepInfo), LinearError> {
    let lasts_s = open.closed_lasts_s();
    let answer = open.closed_answer(Input::Step, SHOWN * lasts_s)?;
    let info = answer.step_info(BAND)?;
    let duration_s = info.settle_s.filter(|s| *s > 0.0).map_or(lasts_s, |s| SHOWN * s.min(lasts_s));
    let step_s = duration_s / ROWS as f64;
    let values = (0..=ROWS).map(|k| answer.at(k as f64 * step_s)).collect();
    Ok((Response { step_s, values }, info))
}

/// A step, watched until it has settled; what it is judged by.
fn settled_step(closed: &TransferFunction) -> Result<(Response, StepInfo), LinearError> {
    /// Fewest and most samples.
    const SAMPLES: (f64, f64) = (20.0, 60_000.0);
    let info = closed.step_info(BAND)?;
    let duration_s = info.settle_s.filter(|s| *s > 0.0).map_or_else(|| closed.lasts_s(), |s| SHOWN * s);
    let step = match closed.time() {
        Time::Continuous => closed.step_response(duration_s / ROWS as f64, ROWS + 1)?,
        Time::Sampled(period_s) => {
            let samples = (duration_s / period_s).clamp(SAMPLES.0, SAMPLES.1);
            closed.step_response(period_s, samples as usize + 1)?
        }
    };
    Ok((step, info))
}

/// The largest input that a step of 1 asks for; none where it is an impulse, or never ends.
fn input_peak(to_input: &TransferFunction, shown: &Response) -> Option<f64> {
    match to_input.time() {
        Time::Continuous => {
            let peak = to_input.transient(Input::Step).and_then(|transient| transient.peak());
            peak.ok().flatten().map(|peak| peak.value.abs())
        }
        Time::Sampled(_) => Some(shown.peak().0.abs()),
    }
}

/// As far as a plot has room: what grows ends where it is a million.
fn shown(mut response: Response) -> Response {
    let end =
        response.values.iter().position(|y| y.is_nan() || y.abs() >= 1e6).unwrap_or(response.values.len());
    response.values.truncate(end.max(2));
    response.values.iter_mut().for_each(|y| *y = if y.is_finite() { *y } else { 0.0 });
    response
}
