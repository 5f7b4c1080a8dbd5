//! The control engineer's bench, one file a subcommand.

mod amplifier;
mod backlash;
mod bode;
mod by_hand;
mod design;
mod encoder;
mod frequency;
mod friction;
mod gravity;
mod head;
mod identify;
mod inertia;
mod lesson;
mod linearize;
mod locus;
mod montecarlo;
mod moves;
mod nyquist;
mod parts;
mod poles;
mod profile;
mod relay;
mod reproduce;
mod response;
mod rig_out;
mod shape;
mod simulate;
mod step;
mod systems;
mod trial;
mod tune;
mod velocity;

use std::path::Path;

use clap::{Args, Subcommand};
use tracelight_chart as chart;
use tracelight_chart::{Colour, Curve, Panel, Scale};
use tracelight_files as files;
use tracelight_rig::Fault;
use tracelight_task::{Failure, Stop};
use tracelight_units::{Unit, VOLTAGES, parse};

use crate::cli::shapes::ProfileName;
use crate::cli::{Answer, Voice};

/// The control engineer's bench: profiles, moves, steps, friction and all else a head is made of, linear models, Bode, Nyquist and locus, controllers designed, many heads at once
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab profile --distance 180deg -o profiles.svg")]
pub(crate) struct LabArgs {
    #[command(subcommand)]
    action: LabAction,
}

#[derive(Subcommand, Debug)]
enum LabAction {
    Profile(profile::ProfileArgs),
    Move(moves::MoveArgs),
    Step(step::StepArgs),
    Simulate(Box<simulate::SimulateArgs>),
    Velocity(velocity::VelocityArgs),
    Identify(identify::IdentifyArgs),
    Friction(friction::FrictionArgs),
    Inertia(inertia::InertiaArgs),
    Gravity(gravity::GravityArgs),
    Amplifier(amplifier::AmplifierArgs),
    Backlash(backlash::BacklashArgs),
    Encoder(encoder::EncoderArgs),
    Frequency(frequency::FrequencyTrialArgs),
    Linearize(linearize::LinearizeArgs),
    Locus(locus::LocusArgs),
    Bode(bode::BodeArgs),
    Nyquist(nyquist::NyquistArgs),
    Nichols(nyquist::NicholsArgs),
    Pzmap(locus::PzmapArgs),
    Response(response::ResponseArgs),
    Design(design::DesignArgs),
    Tune(Box<tune::TuneArgs>),
    Relay(relay::RelayArgs),
    Reproduce(reproduce::ReproduceArgs),
    Lesson(lesson::LessonArgs),
    #[command(name = "montecarlo")]
    MonteCarlo(montecarlo::MonteCarloArgs),
}

impl LabArgs {
    pub(crate) const fn voice(&self) -> Voice {
        match &self.action {
            LabAction::Profile(args) => args.voice,
            LabAction::Move(args) => args.voice(),
            LabAction::Step(args) => args.voice,
            LabAction::Simulate(args) => args.voice,
            LabAction::Velocity(args) => args.voice,
            LabAction::Identify(args) => args.voice,
            LabAction::Friction(args) => args.voice,
            LabAction::Inertia(args) => args.voice,
            LabAction::Gravity(args) => args.voice,
            LabAction::Amplifier(args) => args.voice,
            LabAction::Backlash(args) => args.voice,
            LabAction::Encoder(args) => args.voice,
            LabAction::Frequency(args) => args.voice,
            LabAction::Linearize(args) => args.voice,
            LabAction::Locus(args) => args.plane.voice,
            LabAction::Bode(args) => args.over.voice,
            LabAction::Nyquist(args) => args.over.voice,
            LabAction::Nichols(args) => args.over.voice,
            LabAction::Pzmap(args) => args.plane.voice,
            LabAction::Response(args) => args.voice,
            LabAction::Design(args) => args.voice(),
            LabAction::Tune(args) => args.voice,
            LabAction::Relay(args) => args.voice,
            LabAction::Reproduce(args) => args.voice,
            LabAction::Lesson(args) => args.voice,
            LabAction::MonteCarlo(args) => args.voice,
        }
    }
}

pub(crate) fn run(args: &LabArgs, stop: &Stop) -> Result<Answer, Failure> {
    match &args.action {
        LabAction::Profile(args) => profile::run(args),
        LabAction::Move(args) => moves::run(args, stop),
        LabAction::Step(args) => step::run(args),
        LabAction::Simulate(args) => simulate::run(args),
        LabAction::Velocity(args) => velocity::run(args, stop),
        LabAction::Identify(args) => identify::run(args, stop),
        LabAction::Friction(args) => friction::run(args, stop),
        LabAction::Inertia(args) => inertia::run(args, stop),
        LabAction::Gravity(args) => gravity::run(args, stop),
        LabAction::Amplifier(args) => amplifier::run(args),
        LabAction::Backlash(args) => backlash::run(args),
        LabAction::Encoder(args) => encoder::run(args),
        LabAction::Frequency(args) => frequency::run(args),
        LabAction::Linearize(args) => linearize::run(args),
        LabAction::Locus(args) => locus::run(args, stop),
        LabAction::Bode(args) => bode::run(args),
        LabAction::Nyquist(args) => nyquist::run(args),
        LabAction::Nichols(args) => nyquist::run_nichols(args),
        LabAction::Pzmap(args) => locus::run_pzmap(args),
        LabAction::Response(args) => response::run(args),
        LabAction::Design(args) => design::run(args),
        LabAction::Tune(args) => tune::run(args, stop),
        LabAction::Relay(args) => relay::run(args),
        LabAction::Reproduce(args) => reproduce::run(args, stop),
        LabAction::Lesson(args) => lesson::run(args),
        LabAction::MonteCarlo(args) => montecarlo::run(args, stop),
    }
}

/// A file to write; its ending says what goes into it.
#[derive(Clone, Debug)]
struct OutFile {
    path: String,
    kind: OutKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OutKind {
    Plot,
    /// The plot as pixels.
    Pixels,
    Table,
}

fn out_file(text: &str) -> Result<OutFile, String> {
    let ending = text.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    let kind = match ending.as_deref() {
        Some("svg") => OutKind::Plot,
        Some("png") => OutKind::Pixels,
        Some("csv") => OutKind::Table,
        _ => return Err(format!("{text} ends in none of .svg, .png (a plot) and .csv (a table)")),
    };
    Ok(OutFile { path: text.into(), kind })
}

/// Writes every file that was asked for.
fn write_all(
    files: &[OutFile],
    plot: impl Fn() -> Result<String, Failure>,
    table: impl Fn() -> Result<String, Failure>,
) -> Result<(), Failure> {
    files.iter().try_for_each(|file| {
        let bytes = match file.kind {
            OutKind::Plot => plot()?.into_bytes(),
            OutKind::Pixels => chart::pixels(&plot()?).map_err(|e| Failure::failed("internal", e))?,
            OutKind::Table => table()?.into_bytes(),
        };
        files::write(&file.path, bytes)
    })
}

/// A value with its unit, in SI, that is more than none.
fn above_zero(text: &str, units: &'static [Unit]) -> Result<f64, String> {
    let value = parse(text, units).map_err(|e| e.to_string())?;
    if value > 0.0 { Ok(value) } else { Err(format!("{text} is not above zero")) }
}

fn voltage(text: &str) -> Result<f64, String> {
    above_zero(text, VOLTAGES)
}

/// Makes the folder that a flag names.
fn make_folder(folder: &Path, flag: &str) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|e| {
        let message = format!("cannot write {}: {e}; choose another with {flag}", folder.display());
        Failure::failed("cannot-write", message)
    })
}

/// A panel of curves over time.
fn over_time(title: impl Into<String>, levels: Vec<f64>, curves: Vec<Curve>) -> Panel {
    Panel {
        x_title: "time, s".into(),
        y_title: title.into(),
        curves,
        levels,
        scale: Scale::Free,
        ..Panel::default()
    }
}

/// Why a run is not done, given the fault it ended with.
fn why_unfinished(fault: Option<Fault>) -> &'static str {
    fault.map_or("held again and again", |fault| fault.code())
}

/// What limits of moves may be, in SI: more is no head's, and less takes for ever.
const LEAST: f64 = 1e-6;
const MOST: f64 = 1e6;

/// `value` if it is within reason.
fn within<T>(text: &str, value: T, number: f64, units: &[Unit]) -> Result<T, String> {
    let unit = units.first().map_or("", |unit| unit.0);
    if (LEAST..=MOST).contains(&number) {
        Ok(value)
    } else {
        Err(format!("{text} is not between {LEAST} and {MOST} {unit}"))
    }
}

/// The colour of a profile in every plot.
const fn colour(profile: ProfileName) -> Colour {
    match profile {
        ProfileName::Trapezoid => Colour::Vermilion,
        ProfileName::SCurve => Colour::Blue,
        ProfileName::Sine => Colour::Green,
        ProfileName::Cycloid => Colour::Purple,
        ProfileName::Sigmoid => Colour::Orange,
        ProfileName::Quintic => Colour::Sky,
        ProfileName::Optimal => Colour::Black,
    }
}
