//! Places on the wall, without a picture: `trace --points` of places that are told.

use std::path::PathBuf;

use clap::Args;
use tracelight_pipeline::PointMark;
use tracelight_task::{Failure, Task};
use tracelight_units::{Offset, Speed};

use crate::cli::answer::{Answer, Voice};
use crate::cli::driving::{DrivingArgs, positive_speed};
use crate::cli::request::TraceArgs;
use crate::cli::trace;
use tracelight_flags::FromArgs;
use tracelight_flags::LawArgs;
use tracelight_flags::{each, factor};

/// Mark places on the target one after the other, each until Space, Enter, → or a pedal asks for the next
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight point 30cm,20cm -30cm,20cm --distance 2m --each 5s\n\
                  From the floor and the left edge: tracelight point 1.2m,90cm --from bottom-left --origin -1m,-1m --distance 3m --each 5s\n\n\
                  Without --each a key asks for the next place. The keys are those of `trace --points`; points.csv says which places were ticked off.")]
pub(crate) struct PointArgs {
    /// Places, right and up of the target's middle, or from the edges that --from names, such as 30cm,20cm; in this order
    #[arg(value_name = "X,Y", required = true, num_args = 1..)]
    places: Vec<Offset>,
    /// What marks a place: a cross of that length, or a dot [default: 20mm]
    #[arg(long, value_name = "LENGTH|dot", allow_hyphen_values = true)]
    mark: Option<PointMark>,
    /// Speed of the spot on the mark [default: --speed]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, value_parser = positive_speed)]
    pace: Option<Speed>,
    /// Go on to the next place by itself after this long on one, such as 5s, without a key; without --real-time as fast as the simulation runs
    #[arg(long, value_name = "TIME", value_parser = each, allow_hyphen_values = true)]
    each: Option<f64>,
    /// Run the simulated rig FACTOR times as fast as in real time, from 0.25 to 8 [default: 1, without --each]
    #[arg(long, value_name = "FACTOR", value_parser = factor, allow_hyphen_values = true)]
    real_time: Option<f64>,
    /// Print one JSON object per line while the job runs: states, places, faults, progress
    #[arg(long, conflicts_with = "json")]
    events: bool,
    #[command(flatten, next_help_heading = "Size and place")]
    from: FromArgs,
    /// Where the head stands, as `calibrate corners` or `calibrate head` has found it
    #[arg(help_heading = "Size and place", long, value_name = "FILE.toml", conflicts_with = "distance")]
    head: Option<String>,
    #[command(flatten)]
    driving: DrivingArgs,
    #[command(flatten, next_help_heading = "Rig and law")]
    law: LawArgs,
    /// Everything, with the laser's gate held dark
    #[arg(help_heading = "Rig and law", long)]
    dry_run: bool,
    /// Folder for the results [default: out/point/, or the first of …-2/, …-3/ that is not there yet]
    #[arg(help_heading = "Output", long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Output")]
    pub(crate) voice: Voice,
    /// The command as it was given, without the program's name.
    #[arg(skip)]
    pub(crate) typed: Vec<String>,
}

/// Marks the places; the function reads a command line of `trace`.
pub(crate) fn run(
    args: &PointArgs,
    traced: impl Fn(&[String]) -> Result<TraceArgs, Failure>,
    task: Task<'_>,
) -> Result<Answer, Failure> {
    let mut asked = traced(&["trace", "--points", "point"].map(str::to_owned))?;
    asked.at.clone_from(&args.places);
    (asked.mark, asked.pace) = (args.mark, args.pace);
    (asked.by_hand.real_time, asked.by_hand.events) = (args.real_time, args.events);
    asked.by_hand.each = args.each;
    asked.wall.from = args.from;
    asked.head.clone_from(&args.head);
    (asked.driving, asked.law) = (args.driving.clone(), args.law);
    (asked.dry_run, asked.voice) = (args.dry_run, args.voice);
    asked.out.clone_from(&args.out);
    asked.typed.clone_from(&args.typed);
    trace::run(&asked, None, task)
}
