use clap::{Args, Subcommand, ValueEnum};
use tracelight_experiment::design::lqr;
use tracelight_experiment::design::pid::{AntiWindup, PidRequest, SetpointWish};
use tracelight_experiment::design::{Method, Request, TriedOn};
use tracelight_linear::{LeadLagWish, LqgWish, PidWish, SetpointWeights, Terms};
use tracelight_task::{Failure, Stop};
use tracelight_units::{Angle, TIMES, parse};

use super::bounds::frequency;
use super::by_hand::{number, settings};
use super::command::{self, LabCommand, OutFile, out_file};
use super::poles::{Poles, poles};
use super::step::{Axis, step};
use super::systems::OneSystemArgs;
use crate::cli::answer::{Answer, Voice};

/// Design a controller from a specification: its loop's margins, step response and poles
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight lab design pid G11 --crossover 60rad/s --phase-margin 55deg -o loop.svg\n\
                  Example: tracelight lab design pid G22 --crossover 20rad/s --also 0.7*G22 --also 1.4*G22\n\n\
                  The controller acts on the error: from what is measured, subtracted from what is wished, to the system's input. Its formula \
                  can be pasted into lab bode, locus, pzmap (of samples four digits are too few for that: --json has all).\n\n\
                  On a rig (--try) motors have a limit, joints stick, and a controller that integrates winds up while a motor is at its limit: \
                  small jumps show friction, large ones the limit."
)]
pub(crate) struct DesignArgs {
    #[command(subcommand)]
    method: MethodArgs,
}

#[derive(Subcommand, Debug)]
enum MethodArgs {
    LeadLag(LeadLagArgs),
    Pid(PidArgs),
    Lqg(LqgArgs),
    Place(PlaceArgs),
    Given(GivenArgs),
    Lqr(LqrArgs),
}

/// Lead and lag compensator; as many leads as the phase margin needs
#[derive(Args, Debug)]
struct LeadLagArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// Crossover: the frequency at which the loop gain is 1
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    crossover: f64,
    /// Phase margin at the crossover
    #[arg(long, value_name = "ANGLE")]
    phase_margin: Angle,
    /// Factor by which the lag raises the gain at low frequencies
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    lag: f64,
}

/// P, PI, PD or PID with the largest gain that keeps the margins; with an integral term, the largest integral gain
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab design pid \"1/(s+1)^3\" --type pi --overshoot 5\n\
                  Example: tracelight lab design pid G11 --sample 1ms --crossover 40rad/s --try pan --to 20deg\n\n\
                  Margins are kept at least; where they cannot be had, the nearest that can are named. With --sample the margins are those of \
                  the sampled loop. On a rig (--try) the integral is brought back while the amplifier is at its limit (back-calculation).")]
struct PidArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// Terms of the controller
    #[arg(long = "type", value_name = "TYPE", value_enum, default_value = "pid")]
    terms: TermsArg,
    /// Crossover: the frequency at which the loop gain is 1 [default: the one with the largest gain; required if the margins leave the gain unbounded]
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    crossover: Option<f64>,
    /// Smallest phase margin
    #[arg(long, value_name = "ANGLE", default_value = "55deg")]
    phase_margin: Angle,
    /// Smallest modulus margin: distance of the Nyquist curve from −1, which is 1/Ms
    #[arg(long, value_name = "DISTANCE", default_value_t = 0.6)]
    modulus: f64,
    /// Corner frequency of the derivative's filter, as a multiple of the crossover; for a sampled controller at most 2/T
    #[arg(long, value_name = "FACTOR", default_value_t = 10.0)]
    filter: f64,
    /// Allow complex zeros: more integral gain, but an oscillating closed loop
    #[arg(long)]
    complex_zeros: bool,
    /// Setpoint weights b,c: the share of the setpoint in the proportional and in the derivative term. The response to disturbances does not
    /// change
    #[arg(long, value_name = "b=0.6,c=0", value_parser = weights, conflicts_with = "overshoot")]
    weights: Option<SetpointWeights>,
    /// Choose the largest setpoint weight b (with c = 0) whose overshoot is at most this, %
    #[arg(long, value_name = "PERCENT", value_parser = share)]
    overshoot: Option<f64>,
    /// Time constant of the anti-windup on the rig, or off [default: √(Ti Td), of a PI Ti]
    #[arg(long, value_name = "TIME|off", requires = "tried", value_parser = tracking)]
    tracking: Option<AntiWindup>,
}

/// The terms of a controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TermsArg {
    /// Proportional
    P,
    /// Proportional and integral
    Pi,
    /// Proportional and derivative
    Pd,
    /// All three
    Pid,
}

impl TermsArg {
    const fn terms(self) -> Terms {
        match self {
            Self::P => Terms::P,
            Self::Pi => Terms::Pi,
            Self::Pd => Terms::Pd,
            Self::Pid => Terms::Pid,
        }
    }
}

fn weights(text: &str) -> Result<SetpointWeights, String> {
    let mut weights = SetpointWeights { proportional: 1.0, derivative: 0.0 };
    for (name, value) in settings(text)? {
        let field = match name {
            "b" => &mut weights.proportional,
            "c" => &mut weights.derivative,
            _ => return Err(format!("{name} is neither b nor c")),
        };
        *field = number(name, value, 0.0, 1.0)?;
    }
    Ok(weights)
}

fn share(text: &str) -> Result<f64, String> {
    number("the overshoot, %,", text.trim_end_matches('%').trim(), 0.0, 100.0)
}

fn tracking(text: &str) -> Result<AntiWindup, String> {
    if text == "off" {
        return Ok(AntiWindup::Off);
    }
    let tracking_s = parse(text, TIMES).map_err(|e| e.to_string())?;
    if tracking_s > 0.0 {
        Ok(AntiWindup::Tracking(tracking_s))
    } else {
        Err(format!("{text} is no time constant"))
    }
}

/// State feedback by LQR, with weights on the states
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab design lqr G11 --q 1000,1 --r 1\n\
                  Example: tracelight lab design lqr G11 --most y=0.02 --most-input 0.6 --integral 0.01\n\n\
                  The states are the output and its derivatives (y, dy, d2y, …); of a system with zeros x1, x2, …, each the derivative of the one \
                  before. --most is Bryson's rule: weights of 1 over the square of the largest allowed deviation; what is reached from the first \
                  of them is told, and if the input needs more than allowed, the nearest that keeps it.")]
struct LqrArgs {
    #[command(flatten)]
    system: OneSystemArgs,
    /// Weight of each state, or of states by name
    #[arg(long, value_name = "1,0,10|y=1", value_parser = entries, required_unless_present = "most")]
    q: Option<Entries>,
    /// Weight of the input
    #[arg(long, value_name = "WEIGHT", default_value_t = 1.0, conflicts_with = "most", value_parser = above_zero)]
    r: f64,
    /// Largest allowed deviation of each state, or of states by name (0: no weight)
    #[arg(long, value_name = "0.02,1|y=0.02", value_parser = entries, conflicts_with = "q", requires = "most_input")]
    most: Option<Entries>,
    /// Largest allowed deviation of the input
    #[arg(long, value_name = "SIZE", requires = "most", value_parser = above_zero)]
    most_input: Option<f64>,
    /// Weight of the output's integral, or with --most its largest allowed value. With it a constant disturbance leaves no error
    #[arg(long, value_name = "WEIGHT|SIZE", value_parser = above_zero)]
    integral: Option<f64>,
    /// Output file: step response and input as a plot (.svg, .png) or a table (.csv); repeatable
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

/// Numbers of states.
#[derive(Clone, Debug)]
struct Entries(Vec<lqr::Entry>);

fn entries(text: &str) -> Result<Entries, String> {
    const MOST: f64 = 1e30;
    if text.contains('=') {
        let named = settings(text)?.into_iter();
        return named
            .map(|(name, value)| Ok((Some(name.to_owned()), number(name, value, 0.0, MOST)?)))
            .collect::<Result<_, String>>()
            .map(Entries);
    }
    let each = text.split(',').map(|value| Ok((None, number("a state", value.trim(), 0.0, MOST)?)));
    each.collect::<Result<_, String>>().map(Entries)
}

fn above_zero(text: &str) -> Result<f64, String> {
    number("it", text, f64::MIN_POSITIVE, 1e30).map_err(|_| format!("{text} is not more than zero"))
}

impl LqrArgs {
    fn request(&self) -> Result<lqr::Request, Failure> {
        let entries =
            |entries: &Option<Entries>| entries.as_ref().map(|all| all.0.clone()).unwrap_or_default();
        let weights = match self.most_input {
            Some(most_input) => lqr::Weights::Largest(entries(&self.most), most_input),
            None => lqr::Weights::Given(entries(&self.q), self.r),
        };
        Ok(lqr::Request { system: self.system.system()?, weights, integral: self.integral })
    }
}

/// LQG: state feedback by LQR, with the state estimated by a Kalman filter
#[derive(Args, Debug)]
struct LqgArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// Output error that costs as much as the input of --input
    #[arg(long, value_name = "SIZE", default_value_t = 0.001)]
    output: f64,
    /// Input that costs as much as the output error of --output
    #[arg(long, value_name = "SIZE", default_value_t = 1.0)]
    input: f64,
    /// Integral of the output that costs as much as these. With it a constant disturbance leaves no error
    #[arg(long, value_name = "SIZE")]
    integral: Option<f64>,
    /// Disturbance of the input that the estimator assumes, as a standard deviation
    #[arg(long, value_name = "SIZE", default_value_t = 1.0)]
    disturbance: f64,
    /// Noise of the output that the estimator assumes, as a standard deviation
    #[arg(long, value_name = "SIZE", default_value_t = 0.0001)]
    noise: f64,
}

/// State feedback and an estimator by pole placement
#[derive(Args, Debug)]
struct PlaceArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// Closed-loop poles of the regulator, such as -30,-40+20j; for a sampled system in z. A complex pole stands for the pair. One pole per state; one more
    /// adds an integrator
    #[arg(long, value_name = "POLES", allow_hyphen_values = true, value_parser = poles)]
    poles: Poles,
    /// Poles of the estimator, one per state [default: the regulator's, four times as fast]
    #[arg(long, value_name = "POLES", allow_hyphen_values = true, value_parser = poles)]
    estimator: Option<Poles>,
}

/// Test a given controller with the system and with others
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab design given K11t G11 --also 0.8*G11 --also 1.2*G11")]
struct GivenArgs {
    /// Controller, a formula in s. K11, K22, K11t and K22t are those of the 2006 report
    #[arg(value_name = "CONTROLLER")]
    controller: String,
    #[command(flatten)]
    loops: LoopArgs,
}

/// The system, and the output files.
#[derive(Args, Debug)]
struct LoopArgs {
    #[command(flatten)]
    system: OneSystemArgs,
    /// Further system, a formula or a file; repeatable. A PID keeps its margins with all of them (the crossover is that of SYSTEM). Other
    /// controllers are designed for SYSTEM and tested with each
    #[arg(long, value_name = "SYSTEM")]
    also: Vec<String>,
    /// Also apply a setpoint step to this joint of a simulated rig, and compare the nonlinear with the linearized response. The rig is
    /// that of --rig; otherwise report, with the masses of --set
    #[arg(long = "try", value_name = "JOINT", value_enum)]
    tried: Option<Axis>,
    /// Size of that step
    #[arg(long, value_name = "ANGLE", default_value = "1deg", allow_hyphen_values = true, requires = "tried", value_parser = step)]
    to: Angle,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0, requires = "tried")]
    seed: u64,
    /// Output file: step response and input as a plot (.svg, .png) or a table (.csv); repeatable
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for DesignArgs {
    fn voice(&self) -> Voice {
        match &self.method {
            MethodArgs::Lqr(args) => args.voice,
            MethodArgs::LeadLag(LeadLagArgs { loops, .. })
            | MethodArgs::Pid(PidArgs { loops, .. })
            | MethodArgs::Lqg(LqgArgs { loops, .. })
            | MethodArgs::Place(PlaceArgs { loops, .. })
            | MethodArgs::Given(GivenArgs { loops, .. }) => loops.voice,
        }
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let (loops, method) = match &self.method {
            MethodArgs::Lqr(args) => return command::plotted(args.request()?, &args.out, args.voice, stop),
            MethodArgs::LeadLag(args) => (&args.loops, args.method()),
            MethodArgs::Pid(args) => (&args.loops, args.method()),
            MethodArgs::Lqg(args) => (&args.loops, args.method()),
            MethodArgs::Place(args) => (&args.loops, args.method()),
            MethodArgs::Given(args) => (&args.loops, Method::given(&args.controller)?),
        };
        let request = Request {
            system: loops.system.system_beside(&loops.also)?,
            also: loops.also.clone(),
            method,
            tried: loops.tried.map(|axis| loops.tried_on(axis)).transpose()?,
        };
        command::plotted(request, &loops.out, loops.voice, stop)
    }
}

impl LoopArgs {
    fn tried_on(&self, axis: Axis) -> Result<TriedOn, Failure> {
        let rig = self.system.tried_rig()?;
        Ok(TriedOn { rig, joint: axis.joint(), to_rad: self.to.0, seed: self.seed })
    }
}

impl LeadLagArgs {
    const fn method(&self) -> Method {
        Method::LeadLag(LeadLagWish {
            crossover_rad_s: self.crossover,
            phase_margin_rad: self.phase_margin.0,
            lag: self.lag,
        })
    }
}

impl PidArgs {
    fn method(&self) -> Method {
        let setpoint = match (self.weights, self.overshoot) {
            (Some(weights), _) => SetpointWish::Given(weights),
            (None, Some(most_percent)) => SetpointWish::Overshoot(most_percent),
            (None, None) => SetpointWish::Error,
        };
        Method::Pid(PidRequest {
            wish: PidWish {
                terms: self.terms.terms(),
                crossover_rad_s: self.crossover,
                phase_margin_rad: self.phase_margin.0,
                modulus: self.modulus,
                filter: self.filter,
                any_zeros: self.complex_zeros,
            },
            setpoint,
            anti_windup: self.tracking.unwrap_or(AntiWindup::Usual),
        })
    }
}

impl LqgArgs {
    const fn method(&self) -> Method {
        Method::Lqg(LqgWish {
            output: self.output,
            input: self.input,
            integral: self.integral,
            disturbance: self.disturbance,
            noise: self.noise,
        })
    }
}

impl PlaceArgs {
    fn method(&self) -> Method {
        Method::Place {
            regulator: self.poles.0.clone(),
            estimator: self.estimator.as_ref().map(|poles| poles.0.clone()),
        }
    }
}
