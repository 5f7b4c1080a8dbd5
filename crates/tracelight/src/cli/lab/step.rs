use std::fmt::Write;

use clap::{Args, ValueEnum};
use tracelight_chart::{Colour, Curve, Figure, Key, Pen, Theme};
use tracelight_lab::StepFigures;
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{
    BenchTick, LawName, ObserverName, RigConfig, StepReference, StepResponse, step_response,
};
use tracelight_task::Failure;
use tracelight_units::Angle;

use super::by_hand::ByHandArgs;
use super::{OutFile, out_file, over_time, write_all};
use crate::cli::laws::{choose, law, observer};
use crate::cli::{Answer, Voice};
use crate::named;

/// Send one joint from rest at zero to an angle: overshoot, settling, what stays, on the head as it is and linearized
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight lab step --axis tilt --to 15deg --law state,report-zpk -o steps.svg\n\
                  Example: tracelight lab step --gains kp=20,kd=1.5 -o mine.svg\n\n\
                  state and pid-ff shape their reference: they are given a move as fast as the rig's limits allow; the other \
                  laws a jump, unless --reference says which. The linear response is of the joint by itself, linearized where the step ends, without \
                  Coulomb friction, quantizer and amplifier's limit."
)]
pub(crate) struct StepArgs {
    /// Which joint
    #[arg(long, value_enum, default_value = "pan")]
    axis: Axis,
    /// How far
    #[arg(long, value_name = "ANGLE", default_value = "15deg", allow_hyphen_values = true, value_parser = step)]
    to: Angle,
    /// Laws, the first of them first in --json and alone in the CSV [default: the rig's]
    #[arg(long, value_name = "LAW", value_delimiter = ',', value_parser = law())]
    law: Vec<LawName>,
    /// How counts become position and speed [default: as each law is meant]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    observer: Option<ObserverName>,
    /// How the joint is told [default: as each law is meant]
    #[arg(long, value_enum)]
    reference: Option<Told>,
    #[command(flatten)]
    by_hand: ByHandArgs,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot the responses into an SVG or PNG, or write the first, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// How a joint is told to go somewhere else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Told {
    /// The setpoint is there at once
    Jump,
    /// It goes there as fast as the rig's limits allow
    Move,
}

/// A joint on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Axis {
    /// About the vertical
    Pan,
    /// Up and down
    Tilt,
}

impl Axis {
    pub(super) const fn joint(self) -> Joint {
        match self {
            Axis::Pan => Joint::Pan,
            Axis::Tilt => Joint::Tilt,
        }
    }
}

pub(super) fn step(text: &str) -> Result<Angle, String> {
    // less than a count of the original rig shows nothing but where in its count the joint was
    const LEAST_RAD: f64 = 1.5e-3;
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    if (LEAST_RAD..=std::f64::consts::PI).contains(&angle.0.abs()) {
        Ok(angle)
    } else {
        Err(format!("{text} is not between {LEAST_RAD} rad and half a turn, either way"))
    }
}

/// One law's responses and what they are like.
struct Entry {
    law: LawName,
    response: StepResponse,
    nonlinear: StepFigures,
    linear: StepFigures,
}

pub(crate) fn run(args: &StepArgs) -> Result<Answer, Failure> {
    let mut rig = named::rig(&args.rig)?;
    let mut laws = args.by_hand.apply(&mut rig, &[args.axis.joint()], &args.law)?;
    if laws.is_empty() {
        laws.push(rig.control.law);
    }
    let entries =
        laws.iter().map(|&law| respond(args, &rig, law)).collect::<Result<Vec<Entry>, Failure>>()?;
    let Some(first) = entries.first() else {
        return Err(Failure::usage("usage", "--law names no law"));
    };
    write_all(&args.out, || figure(args, &entries), || Ok(csv(args, first)))?;
    Ok(Answer::new(table(args, &rig, &entries), json(args, &rig, &entries)))
}

fn respond(args: &StepArgs, rig: &RigConfig, law: LawName) -> Result<Entry, Failure> {
    let mut rig = rig.clone();
    choose(&mut rig, law, args.observer);
    let joint = args.axis.joint();
    let reference = match args.reference {
        Some(Told::Jump) => StepReference::Jump,
        Some(Told::Move) => StepReference::Move,
        None => law.reference(),
    };
    let response = step_response(&rig, joint, args.to.0, reference, args.seed)
        .ok_or_else(|| unreachable(joint, args.to))?;
    let figures = |ticks: &[BenchTick]| figures(ticks, joint, args.to);
    let (nonlinear, linear) = (figures(&response.nonlinear), figures(&response.linear));
    Ok(Entry { law, response, nonlinear, linear })
}

fn error_mm(figures: &StepFigures) -> f64 {
    1e3 * DEFAULT_DISTANCE_M * figures.final_error
}

fn table(args: &StepArgs, rig: &RigConfig, entries: &[Entry]) -> String {
    let mut text = heading(rig, args.axis.joint(), args.to);
    for entry in entries {
        text += &row(entry.law.name(), &entry.nonlinear, &entry.linear, rig);
    }
    text + "\n\nmm on a target 3 ft away."
}

/// What is above the rows.
pub(super) fn heading(rig: &RigConfig, joint: Joint, to: Angle) -> String {
    format!(
        "{joint} from rest at 0 to {:.4} rad ({:.2}°) on rig {}; settled: within 2 %\n\n\
         law         overshoot, %  settles, s  final error, mm  counts    linear: overshoot, %  settles, s",
        to.0,
        to.0.to_degrees(),
        rig.name
    )
}

/// A law's row: the head as it is, and linearized.
pub(super) fn row(law: &str, is: &StepFigures, linear: &StepFigures, rig: &RigConfig) -> String {
    format!(
        "\n{law:10} {:13.2} {:>11} {:16.3} {:7.2} {:22.2} {:>11}",
        is.overshoot_percent,
        seconds(is.settle_s),
        error_mm(is),
        is.final_error / rig.truth.model.encoder.count_rad(),
        linear.overshoot_percent,
        seconds(linear.settle_s),
    )
}

/// What a response is like.
pub(super) fn figures(ticks: &[BenchTick], joint: Joint, to: Angle) -> StepFigures {
    let angles: Vec<f64> = ticks.iter().map(|tick| tick.angle_rad[joint]).collect();
    StepFigures::of(&angles, to.0, TICK_F64_S)
}

/// Why there is no response.
pub(super) fn unreachable(joint: Joint, to: Angle) -> Failure {
    let message = format!(
        "{joint} cannot be sent to {:.4} rad: that is out of its range, or its motor is too weak to hold or move it; see \
         `tracelight rigs show`",
        to.0
    );
    Failure::failed("unreachable", message)
}

/// Figures for scripts.
pub(super) fn figures_json(figures: &StepFigures, rig: &RigConfig) -> serde_json::Value {
    serde_json::json!({
        "overshoot_percent": figures.overshoot_percent,
        "settle_s": figures.settle_s,
        "final_error_mm": error_mm(figures),
        "final_error_counts": figures.final_error / rig.truth.model.encoder.count_rad(),
    })
}

fn seconds(settle_s: Option<f64>) -> String {
    settle_s.map_or_else(|| "never".to_owned(), |s| format!("{s:.3}"))
}

fn json(args: &StepArgs, rig: &RigConfig, entries: &[Entry]) -> String {
    let of = |figures: &StepFigures| figures_json(figures, rig);
    let whole = |entry: &Entry| {
        let mut object = of(&entry.nonlinear);
        object["law"] = entry.law.name().into();
        object["linear"] = of(&entry.linear);
        object
    };
    let mut flat = entries.first().map(whole).unwrap_or_default();
    flat["axis"] = args.axis.joint().name().into();
    flat["to_rad"] = args.to.0.into();
    flat["laws"] = entries.iter().map(whole).collect();
    flat.to_string()
}

fn csv(args: &StepArgs, entry: &Entry) -> String {
    let joint = args.axis.joint();
    let mut text = String::from("t_s,set_rad,angle_rad,est_rad,est_rad_s,count,command_v,linear_rad\n");
    let both = entry.response.nonlinear.iter().zip(&entry.response.linear);
    for (number, (is, linear)) in both.enumerate() {
        let estimate = &is.estimates[joint];
        let _ = writeln!(
            text,
            "{:.3},{:.7},{:.7},{:.7},{:.6},{},{:.4},{:.7}",
            number as f64 * TICK_F64_S,
            is.setpoint[joint].position_rad,
            is.angle_rad[joint],
            estimate.position_rad,
            estimate.velocity_rad_s,
            is.measured[joint].count,
            is.command_v[joint],
            linear.angle_rad[joint],
        );
    }
    text
}

/// Something of each tick, over time.
pub(super) fn curve(
    colour: Colour,
    ticks: &[BenchTick],
    pen: Pen,
    value: &dyn Fn(&BenchTick) -> f64,
) -> Curve {
    let points = ticks.iter().enumerate().map(|(k, tick)| (k as f64 * TICK_F64_S, value(tick)));
    Curve { colour, pen, points: points.collect() }
}

/// The colour of a law in every plot.
const fn colour(law: LawName) -> Colour {
    match law {
        LawName::State => Colour::Blue,
        LawName::PidFeedforward => Colour::Green,
        LawName::Pid => Colour::Sky,
        LawName::HandTuned => Colour::Grey,
        LawName::LeadLag => Colour::Purple,
        LawName::ReportZpk => Colour::Vermilion,
        LawName::ReportTimeConstants => Colour::Orange,
        LawName::ReportPd => Colour::Black,
    }
}

fn figure(args: &StepArgs, entries: &[Entry]) -> Result<String, Failure> {
    let joint = args.axis.joint();
    let angle = |tick: &BenchTick| tick.angle_rad[joint].to_degrees();
    let volts = |tick: &BenchTick| f64::from(tick.command_v[joint]);
    let of_head = |value: &dyn Fn(&BenchTick) -> f64| {
        entries
            .iter()
            .map(|e| curve(colour(e.law), &e.response.nonlinear, Pen::Solid, value))
            .collect::<Vec<_>>()
    };
    let mut angles = of_head(&angle);
    angles.extend(entries.iter().map(|e| curve(colour(e.law), &e.response.linear, Pen::Dashed, &angle)));
    let figure = Figure {
        title: format!(
            "{joint} sent to {:.2}°: the head (solid), linearized (dashed)",
            args.to.0.to_degrees()
        ),
        legend: entries
            .iter()
            .map(|e| Key {
                colour: colour(e.law),
                name: format!("{}, {:.2} % over", e.law.name(), e.nonlinear.overshoot_percent),
            })
            .collect(),
        panels: vec![
            over_time("angle, °", vec![args.to.0.to_degrees()], angles),
            over_time("command, V", Vec::new(), of_head(&volts)),
        ],
        columns: 1,
        panel: (760, 300),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
