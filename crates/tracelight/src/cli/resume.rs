use std::path::{Path, PathBuf};

use clap::Args;
use tracelight_files::ResultFolder;
use tracelight_operator::Seat;
use tracelight_results::{Before, Kept, NOTHING_LEFT, check_newest, read};
use tracelight_task::{Failure, Task};

use crate::cli::answer::{Answer, Voice};
use crate::cli::request::TraceArgs;
use crate::cli::trace;
use crate::job::{self, Earlier};
use tracelight_flags::ByHandArgs;

/// Go on with a run that ended on its way: killed, stopped, after a fault or a power cut
///
/// The head begins from zero and draws what is left, from the place that the light had reached. The results go into a new folder; those of the run before
/// stay as they are. The files that the run was read from must be unchanged.
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight resume out/house")]
pub(crate) struct ResumeArgs {
    /// The run's folder, such as out/house; `tracelight runs` lists them
    #[arg(value_name = "DIR")]
    dir: PathBuf,
    #[command(flatten, next_help_heading = "At the wall")]
    by_hand: ByHandArgs,
    /// Folder for the results [default: DIR-2, or the first of DIR-3 … that is not there yet]
    #[arg(help_heading = "Output", long, value_name = "OUT")]
    out: Option<PathBuf>,
    /// Show the report in the browser when done
    #[arg(help_heading = "Output", long)]
    open: bool,
    #[command(flatten, next_help_heading = "Output")]
    pub(crate) voice: Voice,
}

/// Reads a command that was given earlier.
type Traced = fn(&[String]) -> Result<TraceArgs, Failure>;

pub(crate) fn run(
    args: &ResumeArgs,
    traced: Traced,
    seat: Option<&dyn Seat>,
    task: Task<'_>,
) -> Result<Answer, Failure> {
    let dir = std::fs::canonicalize(&args.dir).unwrap_or_else(|_| args.dir.clone());
    let Kept { asked, progress } = read(&args.dir)?;
    // nobody else goes on with it meanwhile
    let _held = ResultFolder::hold(&dir)?;
    check_newest(&dir)?;
    let mut request = traced(&asked.arguments)?;
    request.by_hand = args.by_hand.clone();
    // what went wrong then does not go wrong again
    request.follow.sim_trouble.clear();
    request.open = args.open;
    // it is of the run before
    request.film = None;
    request.out = args.out.as_deref().map(whole).transpose()?;
    request.voice = args.voice;
    if let Some(why) = request.cannot_resume() {
        let message = format!("cannot go on with {}: {why}", args.dir.display());
        return Err(Failure::usage("cannot-resume", message));
    }
    if request.out.as_deref().is_some_and(|out| std::fs::canonicalize(out).is_ok_and(|out| out == dir)) {
        let message = format!(
            "--out {0} is the run that is to be gone on with: give another folder",
            args.dir.display()
        );
        return Err(Failure::usage("usage", message));
    }
    asked.check_inputs()?;
    // its names are those of there, unless all of them say where from the root
    if !asked.is_from_root() {
        std::env::set_current_dir(&asked.folder).map_err(|e| {
            let message =
                format!("cannot go on: the run was begun in {}, and there: {e}", asked.folder.display());
            Failure::usage("changed", message)
        })?;
    }
    let plan_tick = progress.map_or(0, |progress| progress.plan_tick);
    let earlier = asked.before.iter().cloned().chain([Before { folder: dir.clone(), plan_tick }]).collect();
    match job::resume(
        &request,
        &Earlier { asked: &asked, runs: earlier, beside: &ResultFolder::unnumbered(&dir) },
        seat,
        task,
    ) {
        Err(none) if none.code == NOTHING_LEFT => {
            let json = serde_json::json!({ "folder": args.dir, "finished": true });
            Ok(Answer::new(format!("{}: nothing is left to draw", args.dir.display()), json.to_string()))
        }
        outcome => trace::answered(&request, outcome?),
    }
}

/// A path from the root, also of what is not there yet.
fn whole(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(|e| {
        Failure::usage("usage", format!("cannot use {} as --out: {e}; name a folder", path.display()))
    })
}
