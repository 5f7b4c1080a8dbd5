use std::path::PathBuf;

use clap::{Args, Subcommand};
use tracelight_aim::HeadPose;
use tracelight_eye::room::left;
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_port::{Serving, serve, share};
use tracelight_rig::wire::Greeting;
use tracelight_sim::SimulatedRig;
use tracelight_task::{Failure, Stop};

use crate::cli::answer::{Answer, Voice, watched};
use crate::named;
use tracelight_flags::each;

/// Emulate a board, or share a real one, for programs that speak the wire's language
#[derive(Args, Debug)]
pub(crate) struct RigArgs {
    #[command(subcommand)]
    action: RigAction,
}

#[derive(Subcommand, Debug)]
enum RigAction {
    /// Emulate a board with its head at a pseudo-terminal, in real time
    #[command(after_help = "Example: tracelight rig serve --pty out/head --for 2s")]
    Serve(ServeArgs),
    /// Hold the port of a board for other programs: one drives at a time, any number watch
    #[command(after_help = "Example: tracelight rig share /dev/ttyACM0 --for 10min\n\n\
                            Other programs on this computer go on to name the port: tracelight trace PICTURE --rig /dev/ttyACM0. Who says nothing for 2 s drives no more.")]
    Share(ShareArgs),
}

#[derive(Args, Debug)]
struct ServeArgs {
    /// Where the pseudo-terminal is to be: nothing may be there yet
    #[arg(long, value_name = "PATH")]
    pty: PathBuf,
    /// Head: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// How long, such as 30s [default: until Ctrl-C]
    #[arg(long = "for", value_name = "TIME", value_parser = each)]
    lasts_s: Option<f64>,
    /// Draws what differs from head to head
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The head was just powered up anywhere, and does not know where it points
    #[arg(long)]
    sim_unhomed: bool,
    /// The board says that it is a Pico 2, to practise with: whoever drives its head asks a person to arm
    #[arg(long)]
    sim_real: bool,
    /// Somebody holds the head where it is until its motors do; it sinks otherwise
    #[arg(long)]
    sim_held: bool,
    #[command(flatten)]
    voice: Voice,
}

#[derive(Args, Debug)]
struct ShareArgs {
    /// Port of the board, such as /dev/ttyACM0
    #[arg(value_name = "PORT")]
    port: String,
    /// How long, such as 30s [default: until Ctrl-C]
    #[arg(long = "for", value_name = "TIME", value_parser = each)]
    lasts_s: Option<f64>,
    #[command(flatten)]
    voice: Voice,
}

impl RigArgs {
    /// How it answers.
    pub(crate) const fn voice(&self) -> Voice {
        match &self.action {
            RigAction::Serve(args) => args.voice,
            RigAction::Share(args) => args.voice,
        }
    }
}

pub(crate) fn run(args: &RigArgs, stop: &Stop) -> Result<Answer, Failure> {
    match &args.action {
        RigAction::Serve(args) => run_serve(args, stop),
        RigAction::Share(args) => {
            let told = watched(args.voice, stop, |task| share(&named::port(&args.port), args.lasts_s, task))?;
            Ok(Answer::new(told.text(), told.json().to_string()))
        }
    }
}

fn run_serve(args: &ServeArgs, stop: &Stop) -> Result<Answer, Failure> {
    let config = named::rig(&args.rig)?;
    let put_up = if args.sim_unhomed { left } else { SimulatedRig::new };
    let rig = put_up(&config, HeadPose::square_on(DEFAULT_DISTANCE_M), args.seed).served();
    let rig = if args.sim_real { rig.posing_as(Greeting::PICO_2) } else { rig };
    let rig = if args.sim_held { rig.held() } else { rig };
    let serving = Serving { rig, name: &config.name, at: &args.pty, lasts_s: args.lasts_s };
    let served = watched(args.voice, stop, |task| serve(serving, task))?;
    Ok(Answer::new(served.text(), served.json().to_string()))
}
