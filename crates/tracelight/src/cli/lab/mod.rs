//! The control engineer's bench, one file a subcommand.

mod amplifier;
mod backlash;
mod bode;
mod bounds;
mod by_hand;
mod columns;
mod command;
mod design;
mod encoder;
mod frequency;
mod friction;
mod gang;
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
mod rig;
mod rig_out;
mod shape;
mod sigma;
mod simulate;
mod step;
mod systems;
mod trials;
mod tune;
mod velocity;

use clap::{Args, Subcommand};
use tracelight_task::{Failure, Stop};

use self::command::LabCommand;
use crate::cli::answer::{Answer, Performs, Voice};

/// Control-engineering tools: motion profiles, step tests, identification, linear models and plots, controller design, Monte Carlo
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
    Sigma(sigma::SigmaArgs),
    Nyquist(nyquist::NyquistArgs),
    Nichols(nyquist::NicholsArgs),
    #[command(alias = "gangof4", alias = "sensitivity")]
    Gang(gang::GangArgs),
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

/// What is asked of the bench.
enum Asked<'a> {
    One(&'a dyn LabCommand),
    /// The book, which is made of other commands' answers.
    Book(&'a reproduce::ReproduceArgs),
}

impl LabArgs {
    pub(crate) fn voice(&self) -> Voice {
        match self.asked() {
            Asked::One(command) => command.voice(),
            Asked::Book(book) => book.voice,
        }
    }

    fn asked(&self) -> Asked<'_> {
        Asked::One(match &self.action {
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
            LabAction::Sigma(args) => args,
            LabAction::Nyquist(args) => args,
            LabAction::Nichols(args) => args,
            LabAction::Gang(args) => args,
            LabAction::Pzmap(args) => args,
            LabAction::Response(args) => args,
            LabAction::Design(args) => args,
            LabAction::Tune(args) => args.as_ref(),
            LabAction::Relay(args) => args,
            LabAction::Reproduce(args) => return Asked::Book(args),
            LabAction::Lesson(args) => args,
            LabAction::MonteCarlo(args) => args,
        })
    }
}

/// `perform` does what a command line says: the bench knows only its own.
pub(crate) fn run(args: &LabArgs, perform: Performs, stop: &Stop) -> Result<Answer, Failure> {
    match args.asked() {
        Asked::One(command) => command.run(stop),
        Asked::Book(book) => reproduce::run(book, perform, stop),
    }
}
