use clap::{Args, Subcommand};
use tracelight_experiment::design::{Method, Request, TriedOn};
use tracelight_linear::{LeadLagWish, LqgWish, PidWish};
use tracelight_task::{Failure, Stop};
use tracelight_units::Angle;

use super::bode::frequency;
use super::command::{self, LabCommand, OutFile, out_file};
use super::poles::{Poles, poles};
use super::step::{Axis, step};
use super::systems::OneSystemArgs;
use crate::cli::answer::{Answer, Voice};

/// Design a controller from a specification: its loop's margins, step response and poles
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight lab design pid G11 --crossover 60rad/s --phase-margin 55deg -o loop.svg\n\n\
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
}

/// As many leads as the phase margin asks for, and a lag
#[derive(Args, Debug)]
struct LeadLagArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// Where the loop's gain is 1
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    crossover: f64,
    /// Phase margin there
    #[arg(long, value_name = "ANGLE")]
    phase_margin: Angle,
    /// How many times more it amplifies what hardly changes
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    lag: f64,
}

/// The PID with the largest integral gain that keeps the margins
#[derive(Args, Debug)]
struct PidArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// Where the loop's gain is 1 [default: where the integral can be largest]
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    crossover: Option<f64>,
    /// Phase margin there
    #[arg(long, value_name = "ANGLE", default_value = "55deg")]
    phase_margin: Angle,
    /// Least distance of the loop from −1: one over the largest sensitivity
    #[arg(long, value_name = "DISTANCE", default_value_t = 0.6)]
    modulus: f64,
    /// How many times the crossover the derivative ends at
    #[arg(long, value_name = "FACTOR", default_value_t = 10.0)]
    filter: f64,
}

/// State feedback that costs least, the state estimated by a Kalman filter
#[derive(Args, Debug)]
struct LqgArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// An error of the output so large costs as much as …
    #[arg(long, value_name = "SIZE", default_value_t = 0.001)]
    output: f64,
    /// … an input so large
    #[arg(long, value_name = "SIZE", default_value_t = 1.0)]
    input: f64,
    /// … or an integral of the output so large; given, nothing constant leaves an error
    #[arg(long, value_name = "SIZE")]
    integral: Option<f64>,
    /// The estimator takes the input to be disturbed by so much …
    #[arg(long, value_name = "SIZE", default_value_t = 1.0)]
    disturbance: f64,
    /// … and the output to be noisy by so much
    #[arg(long, value_name = "SIZE", default_value_t = 0.0001)]
    noise: f64,
}

/// State feedback and an estimator with these poles
#[derive(Args, Debug)]
struct PlaceArgs {
    #[command(flatten)]
    loops: LoopArgs,
    /// Poles of the regulator, such as -30,-40+20j, of samples in z; a complex one stands for its pair. As many as the system has, or one more: then it
    /// integrates
    #[arg(long, value_name = "POLES", allow_hyphen_values = true, value_parser = poles)]
    poles: Poles,
    /// Poles of the estimator, as many as the system has [default: those of the regulator, four times as fast]
    #[arg(long, value_name = "POLES", allow_hyphen_values = true, value_parser = poles)]
    estimator: Option<Poles>,
}

/// The system, and where results go.
#[derive(Args, Debug)]
struct LoopArgs {
    #[command(flatten)]
    system: OneSystemArgs,
    /// Drive this joint of a simulated rig by it, too, from a jump of its setpoint: the head as it is beside the head linearized. The
    /// rig is that of --rig; without it, report, with the masses of --set
    #[arg(long = "try", value_name = "JOINT", value_enum)]
    tried: Option<Axis>,
    /// How far it jumps
    #[arg(long, value_name = "ANGLE", default_value = "1deg", allow_hyphen_values = true, requires = "tried", value_parser = step)]
    to: Angle,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0, requires = "tried")]
    seed: u64,
    /// Plot step and input into an SVG or PNG, or write them to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for DesignArgs {
    fn voice(&self) -> Voice {
        self.method.loops().voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let loops = self.method.loops();
        let request = Request {
            system: loops.system.system()?,
            method: self.method.method(),
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

impl MethodArgs {
    const fn loops(&self) -> &LoopArgs {
        match self {
            Self::LeadLag(args) => &args.loops,
            Self::Pid(args) => &args.loops,
            Self::Lqg(args) => &args.loops,
            Self::Place(args) => &args.loops,
        }
    }

    fn method(&self) -> Method {
        match self {
            Self::LeadLag(args) => Method::LeadLag(LeadLagWish {
                crossover_rad_s: args.crossover,
                phase_margin_rad: args.phase_margin.0,
                lag: args.lag,
            }),
            Self::Pid(args) => Method::Pid(PidWish {
                crossover_rad_s: args.crossover,
                phase_margin_rad: args.phase_margin.0,
                modulus: args.modulus,
                filter: args.filter,
            }),
            Self::Lqg(args) => Method::Lqg(LqgWish {
                output: args.output,
                input: args.input,
                integral: args.integral,
                disturbance: args.disturbance,
                noise: args.noise,
            }),
            Self::Place(args) => Method::Place {
                regulator: args.poles.0.clone(),
                estimator: args.estimator.as_ref().map(|poles| poles.0.clone()),
            },
        }
    }
}
