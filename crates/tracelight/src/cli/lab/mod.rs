//! The control engineer's bench, one file a subcommand.

mod amplifier;
mod backlash;
mod bode;
mod by_hand;
mod command;
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
mod trials;
mod tune;
mod velocity;

use clap::{Args, Subcommand};
use tracelight_task::{Failure, Stop};
use tracelight_units::{Unit, VOLTAGES, parse};

use self::command::LabCommand;
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
    pub(crate) fn voice(&self) -> Voice {
        self.command().voice()
    }

    fn command(&self) -> &dyn LabCommand {
        match &self.action {
            LabAction::Profile(args) => args,
            LabAction::Move(args) => args,
            LabAction::Step(args) => args,
            LabAction::Simulate(args) => args.as_ref(),
            LabAction::Velocity(args) => args,
            LabAction::Identify(args) => args,
            LabAction::Friction(args) => args,
            LabAction::Inertia(args) => args,
            LabAction::Gravity(args) => args,
            LabAction::Amplifier(args) => args,
            LabAction::Backlash(args) => args,
            LabAction::Encoder(args) => args,
            LabAction::Frequency(args) => args,
            LabAction::Linearize(args) => args,
            LabAction::Locus(args) => args,
            LabAction::Bode(args) => args,
            LabAction::Nyquist(args) => args,
            LabAction::Nichols(args) => args,
            LabAction::Pzmap(args) => args,
            LabAction::Response(args) => args,
            LabAction::Design(args) => args,
            LabAction::Tune(args) => args.as_ref(),
            LabAction::Relay(args) => args,
            LabAction::Reproduce(args) => args,
            LabAction::Lesson(args) => args,
            LabAction::MonteCarlo(args) => args,
        }
    }
}

pub(crate) fn run(args: &LabArgs, stop: &Stop) -> Result<Answer, Failure> {
    args.command().run(stop)
}

/// A value with its unit, in SI, that is more than none.
fn above_zero(text: &str, units: &'static [Unit]) -> Result<f64, String> {
    let value = parse(text, units).map_err(|e| e.to_string())?;
    if value > 0.0 { Ok(value) } else { Err(format!("{text} is not above zero")) }
}

fn voltage(text: &str) -> Result<f64, String> {
    above_zero(text, VOLTAGES)
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
