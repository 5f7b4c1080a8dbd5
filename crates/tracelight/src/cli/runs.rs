use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;
use tracelight_results::{ListedRun, compare, runs, table};
use tracelight_task::Failure;

use crate::cli::answer::{Answer, Voice};

/// Where runs go unless another folder is given.
const OUT: &str = "out";

/// Compare two runs: what they were asked, and how they came out
///
/// The difference is the second less the first.
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight compare out/house out/house-2")]
pub(crate) struct CompareArgs {
    /// A run's folder, such as out/house; `tracelight runs` lists them
    #[arg(value_name = "DIR")]
    first: PathBuf,
    /// Another one's
    #[arg(value_name = "DIR")]
    second: PathBuf,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run_compare(args: &CompareArgs) -> Result<Answer, Failure> {
    let compared = compare(&args.first, &args.second)?;
    Ok(Answer::either(args.voice, || compared.text(), || compared.json().to_string()))
}

/// List the runs in a folder: when, how large, how exact, how far they came
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight runs")]
pub(crate) struct RunsArgs {
    /// Folder whose subfolders hold the results of runs
    #[arg(value_name = "DIR", default_value = OUT)]
    dir: PathBuf,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run(args: &RunsArgs) -> Result<Answer, Failure> {
    // before the first run there is none
    let is_to_come = args.dir == Path::new(OUT) && !args.dir.exists();
    let runs = if is_to_come { Vec::new() } else { runs(&args.dir)? };
    Ok(Answer::either(
        args.voice,
        || match runs.is_empty() {
            true => format!("no runs in {}: tracelight trace PICTURE makes one", args.dir.display()),
            false => table(&runs),
        },
        || json!({ "runs": runs.iter().map(ListedRun::json).collect::<Vec<_>>() }).to_string(),
    ))
}
