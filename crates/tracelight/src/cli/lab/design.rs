use std::fmt::Write;

use clap::{Args, Subcommand};
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Pen};
use tracelight_linear::{
    Complex, LeadLagWish, LinearError, LqgWish, Margins, PidWish, Response, Stability, StepInfo, Time,
    TransferFunction, Zpk,
};
use tracelight_task::Failure;
use tracelight_units::Angle;

use super::bode::{frequency, margin_lines, margins_json, stability_name, system_json};
use super::poles::{Poles, poles};
use super::step::{Axis, step};
use super::systems::{OneSystemArgs, four, pairs, percent, pole_lines, seconds};
use super::trial::Trial;
use super::{OutFile, out_file, over_time, write_all};
use crate::cli::{Answer, Voice};

/// Order beyond which digits run out, and time.
const MOST_ORDER: usize = 24;

/// A controller from wishes, and the loop it makes: margins, step, poles
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
pub(super) struct LoopArgs {
    #[command(flatten)]
    system: OneSystemArgs,
    /// Drive this joint of a simulated rig by it, too, from a jump of its setpoint: the head as it is beside the head linearized. The
    /// rig is that of --rig, or report
    #[arg(long = "try", value_name = "JOINT", value_enum)]
    tried: Option<Axis>,
    /// How far it jumps
    #[arg(long, value_name = "ANGLE", default_value = "1deg", allow_hyphen_values = true, requires = "tried", value_parser = step)]
    to: Angle,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0, requires = "tried")]
    seed: u64,
    /// Plot step and input into an SVG or PNG, or write them to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// What was designed, and what it does.
struct Design {
    name: String,
    plant: TransferFunction,
    controller: Zpk,
    /// The controller in its own figures.
    remark: String,
    closed: TransferFunction,
    margins: Margins,
    /// What comes out, and what the controller puts in, after a step of what is wished.
    step: Response,
    input: Response,
    /// The largest of the input.
    peak: f64,
    stability: Stability,
    /// Of what settles.
    info: Option<StepInfo>,
    trial: Option<Trial>,
}

impl DesignArgs {
    pub(super) const fn voice(&self) -> Voice {
        self.loops().voice
    }

    const fn loops(&self) -> &LoopArgs {
        match &self.method {
            MethodArgs::LeadLag(args) => &args.loops,
            MethodArgs::Pid(args) => &args.loops,
            MethodArgs::Lqg(args) => &args.loops,
            MethodArgs::Place(args) => &args.loops,
        }
    }
}

pub(crate) fn run(args: &DesignArgs) -> Result<Answer, Failure> {
    let loops = args.loops();
    let (name, plant) = loops.system.system()?;
    let order = plant.denominator().degree().max(plant.numerator().degree());
    if order > MOST_ORDER {
        let message = format!(
            "{name} is of order {order}; controllers are designed for systems up to order {MOST_ORDER}"
        );
        return Err(Failure::failed("no-such-design", message));
    }
    let failed = |e: LinearError| Failure::failed("no-such-design", format!("{name}: {e}"));
    let (controller, remark) = controller(&args.method, &plant).map_err(failed)?;
    let trial = loops
        .tried
        .map(|axis| Trial::of(loops.system.rig(), axis.joint(), (loops.to, loops.seed), &controller))
        .transpose()?;
    let design = Design { trial, ..Design::of(name.clone(), plant, controller, remark).map_err(failed)? };
    write_all(&loops.out, || figure(loops, &design), || Ok(csv(&design)))?;
    Ok(Answer::either(loops.voice, || text(&design), || json(&design)))
}

fn controller(method: &MethodArgs, plant: &TransferFunction) -> Result<(Zpk, String), LinearError> {
    match method {
        MethodArgs::LeadLag(args) => {
            let wish = LeadLagWish {
                crossover_rad_s: args.crossover,
                phase_margin_rad: args.phase_margin.0,
                lag: args.lag,
            };
            Ok((plant.lead_lag(wish)?, String::new()))
        }
        MethodArgs::Pid(args) => {
            let pid = plant.pid(PidWish {
                crossover_rad_s: args.crossover,
                phase_margin_rad: args.phase_margin.0,
                modulus: args.modulus,
                filter: args.filter,
            })?;
            let remark = format!(
                "kp = {}, ki = {} 1/s, kd = {} s, derivative up to {} rad/s",
                four(pid.kp),
                four(pid.ki),
                four(pid.kd),
                four(pid.filter_rad_s)
            );
            Ok((pid.transfer().zpk(), remark))
        }
        MethodArgs::Lqg(args) => {
            let wish = LqgWish {
                output: args.output,
                input: args.input,
                integral: args.integral,
                disturbance: args.disturbance,
                noise: args.noise,
            };
            Ok((plant.lqg(&wish)?, String::new()))
        }
        MethodArgs::Place(args) => {
            let own = || faster(&args.poles.0, plant);
            let estimator = args.estimator.as_ref().map_or_else(own, |poles| poles.0.clone());
            Ok((plant.placed(&args.poles.0, &estimator)?, String::new()))
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
                    Time::Continuous => -poles[0].norm(),
                    Time::Sampled(_) => poles[0].norm(),
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

impl Design {
    fn of(
        name: String,
        plant: TransferFunction,
        controller: Zpk,
        remark: String,
    ) -> Result<Self, LinearError> {
        let k = controller.transfer();
        let open = k.series(&plant)?;
        let closed = open.closed()?;
        let to_input = k.feedback(&plant)?;
        let stability = closed.stability();
        let (step, info) = settled_step(&closed, stability)?;
        // what a derivative without an end puts in is an impulse: it has no step
        let input = to_input.step_response(step.step_s, step.values.len()).unwrap_or_default();
        // its peak may be over long before the output has settled
        let mut peak = input.peak().0.abs();
        if let Time::Continuous = plant.time() {
            for shorter in (1..=20).map(|k| step.step_s * 0.5_f64.powi(k)) {
                peak = peak.max(
                    to_input.step_response(shorter, step.values.len()).map_or(0.0, |u| u.peak().0.abs()),
                );
            }
        }
        let [step, input] = [step, input].map(shown);
        let margins = open.margins();
        Ok(Self {
            name,
            plant,
            controller,
            remark,
            closed,
            margins,
            step,
            input,
            peak,
            stability,
            info,
            trial: None,
        })
    }
}

/// A step, watched until it has settled; what it is judged by, if it does.
fn settled_step(
    closed: &TransferFunction,
    stability: Stability,
) -> Result<(Response, Option<StepInfo>), LinearError> {
    /// Rows of a step in continuous time, and most samples.
    const ROWS: usize = 2000;
    const MOST_SAMPLES: f64 = 60_000.0;
    /// Within this share of the goal it is settled.
    const BAND: f64 = 0.02;
    /// Times the watch is doubled.
    const DOUBLINGS: i32 = 20;
    let sizes = closed.poles().into_iter().map(|pole| closed.time().continuous(pole));
    let rates = sizes.filter(|s| s.re.is_finite() && s.norm() > 1e-9).map(|s| s.re.abs().max(0.1 * s.norm()));
    // begun with the fastest
    let fastest = rates.fold(0.0, f64::max);
    let begun_s = if fastest > 0.0 { 3.0 / fastest } else { 1.0 };
    let watch = |duration_s: f64| match closed.time() {
        Time::Continuous => closed.step_response(duration_s / ROWS as f64, ROWS + 1),
        Time::Sampled(period_s) => {
            closed.step_response(period_s, (duration_s / period_s).clamp(20.0, MOST_SAMPLES) as usize + 1)
        }
    };
    if stability != Stability::Stable {
        return Ok((watch(4.0 * begun_s)?, None));
    }
    let mut doubling = 0;
    loop {
        let step = watch(begun_s * 2.0_f64.powi(doubling))?;
        let info = step.step_info(Some(closed.dc_gain()), BAND);
        let end_s = step.step_s * (step.values.len() - 1) as f64;
        // some rest after it shows that it is one
        let is_over = info.settle_s.is_some_and(|settle_s| settle_s < 0.6 * end_s);
        if is_over || doubling == DOUBLINGS {
            return Ok((step, Some(info)));
        }
        doubling += 1;
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

fn text(design: &Design) -> String {
    let Design { name, plant, controller, remark, closed, margins, info, .. } = design;
    let mut text = format!("{name} = {plant}\n\nK = {controller}\n");
    if !remark.is_empty() {
        text += &format!("    {remark}\n");
    }
    // writing to a String cannot fail
    let _ = writeln!(text, "\nthe loop\n{}", margin_lines(margins));
    if let Some(info) = info {
        let _ = writeln!(
            text,
            "\na step comes to {}, overshoots by {}, rises in {}, is within 2 % after {}\nfor a step of 1 the input is {} at most",
            four(info.final_value),
            percent(info.overshoot_percent),
            seconds(info.rise_s),
            info.settle_s.map_or_else(
                || format!(
                    "more than the {} s watched",
                    four(design.step.step_s * design.step.values.len() as f64)
                ),
                |s| format!("{} s", four(s))
            ),
            four(design.peak)
        );
    }
    let closed_is = match design.stability {
        Stability::Stable => "stable",
        Stability::Marginal => "at the edge of stability, or nearer to it than rounding lets tell",
        Stability::Growing => "NOT stable: it grows",
    };
    let _ = write!(text, "\nclosed it is {closed_is}\n{}", pole_lines(&closed.poles(), closed.time()));
    if let Some(trial) = &design.trial {
        text += &format!("\n{}", trial.text());
    }
    text.trim_end().to_owned()
}

fn json(design: &Design) -> String {
    let info = design.info;
    let stable = design.stability == Stability::Stable;
    let modulus = design.margins.modulus.filter(|_| stable);
    let zpk = &design.controller;
    json!({
        "system": system_json(&design.name, &design.plant),
        "controller": {
            "text": zpk.to_string(),
            "gain": zpk.gain(),
            "zeros": pairs(zpk.zeros()),
            "poles": pairs(zpk.poles()),
            "num": zpk.transfer().numerator().coefficients(),
            "den": zpk.transfer().denominator().coefficients(),
        },
        "margins": margins_json(&design.margins),
        "closed_poles": pairs(&design.closed.poles()),
        "closed_stable": stable,
        "closed_stability": stability_name(design.stability),
        "bandwidth_rad_s": stable.then(|| design.closed.bandwidth()).flatten(),
        "sensitivity": modulus.map(|m| 1.0 / m.distance).filter(|s| s.is_finite()),
        "complementary_sensitivity": design.closed.peak().map(|peak| peak.gain),
        "step": info.map(|info| json!({
            "final": info.final_value,
            "overshoot_percent": info.overshoot_percent,
            "rise_s": info.rise_s,
            "settle_s": info.settle_s,
        })),
        "trial": design.trial.as_ref().map(Trial::json),
        "input_peak": stable.then_some(design.peak),
    })
    .to_string()
}

fn csv(design: &Design) -> String {
    let mut text = String::from("t_s,output,input\n");
    for (row, output) in design.step.values.iter().enumerate() {
        let input = design.input.values.get(row).map_or(String::new(), |u| format!("{u:.9e}"));
        let _ = writeln!(text, "{:.9e},{output:.9e},{input}", row as f64 * design.step.step_s);
    }
    text
}

fn figure(args: &LoopArgs, design: &Design) -> Result<String, Failure> {
    let curve = |response: &Response| Curve {
        colour: Colour::Blue,
        pen: Pen::Solid,
        points: (0..).zip(&response.values).map(|(k, y)| (f64::from(k) * response.step_s, *y)).collect(),
    };
    let panel =
        |title: &str, level: f64, response: &Response| over_time(title, vec![level], vec![curve(response)]);
    let phase =
        design.margins.least_phase().map_or(String::new(), |m| format!(", {}° of phase", four(m.degrees())));
    let modulus = design.margins.modulus.map_or(String::new(), |m| format!(", modulus {}", four(m.distance)));
    let mut panels = vec![panel("output", 1.0, &design.step), panel("input", 0.0, &design.input)];
    let mut legend = vec![Key { colour: Colour::Blue, name: format!("a step of 1{phase}{modulus}") }];
    if let Some(trial) = &design.trial {
        panels.extend(trial.panels());
        legend.push(Key { colour: Colour::Vermilion, name: trial.name() });
    }
    let figure = Figure {
        title: match design.controller.to_string() {
            text if text.chars().count() <= 70 => format!("{} with K = {text}", design.name),
            _ => format!("{} with a K of order {}", design.name, design.controller.poles().len()),
        },
        legend,
        columns: if panels.len() > 2 { 2 } else { 1 },
        panel: if panels.len() > 2 { (560, 280) } else { (820, 280) },
        panels,
        theme: args.system.theme(),
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
