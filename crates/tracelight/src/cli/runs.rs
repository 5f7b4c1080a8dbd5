use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;
use tracelight_results::{ListedRun, runs};
use tracelight_task::{Failure, counted};
use unicode_width::UnicodeWidthStr;

use crate::cli::answer::{Answer, Voice};

/// Where runs go unless another folder is given.
const OUT: &str = "out";

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
        || text(&args.dir, &runs),
        || json!({ "runs": runs.iter().map(ListedRun::json).collect::<Vec<_>>() }).to_string(),
    ))
}

/// What a line of the table says.
fn cells(run: &ListedRun) -> [String; 6] {
    let mm = |m: f64| 1e3 * m;
    let [width, height] = run.asked.size_m;
    let time = run.summary["run"]["duration_s"].as_f64();
    [
        run.dir.display().to_string(),
        run.asked.begun.clone(),
        format!("{:.0} × {:.0} mm", mm(width), mm(height)),
        time.map_or_else(|| "–".to_owned(), |s| format!("{s:.1} s")),
        run.rms_mm().map_or_else(|| "–".to_owned(), |mm| format!("{mm:.3} mm")),
        run.how_far(),
    ]
}

/// A table with a head, as wide as it needs to be.
fn text(dir: &Path, runs: &[ListedRun]) -> String {
    if runs.is_empty() {
        return format!("no runs in {}: tracelight trace PICTURE makes one", dir.display());
    }
    let head = ["folder", "begun (UTC)", "size", "time", "rms error", "how far"].map(str::to_owned);
    let lines: Vec<[String; 6]> = std::iter::once(head).chain(runs.iter().map(cells)).collect();
    let widths: [usize; 6] =
        std::array::from_fn(|i| lines.iter().map(|line| line[i].width()).max().unwrap_or_default());
    let shown = |line: &[String; 6]| {
        let cells = line.iter().zip(widths).map(|(cell, width)| {
            // by what it takes on a screen
            format!("{cell}{}", " ".repeat(width - cell.width()))
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let left = runs.iter().filter(|run| !run.is_finished()).count();
    let hint = match left {
        0 => String::new(),
        _ => format!("\n{} not finished: tracelight resume FOLDER goes on with one", counted(left, "run")),
    };
    lines.iter().map(shown).collect::<Vec<_>>().join("\n") + &hint
}
