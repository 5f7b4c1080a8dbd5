use tracelight_operator::Seat;
use tracelight_task::{Failure, Task};

use crate::cli::answer::Answer;
use crate::cli::request::TraceArgs;
use crate::job::{self, Outcome};

/// Traces, attended by somebody elsewhere if he has a seat.
pub(crate) fn run(args: &TraceArgs, seat: Option<&dyn Seat>, task: Task<'_>) -> Result<Answer, Failure> {
    answered(args, job::trace(args, seat, task)?)
}

/// What a run that is over is answered with.
pub(crate) fn answered(args: &TraceArgs, outcome: Outcome) -> Result<Answer, Failure> {
    let Outcome { summary, dir, failure } = outcome;
    if args.open {
        open(&dir.join("report.html"));
    }
    let json = summary.json();
    let text = match args.by_hand.events {
        true => summary_event(&json),
        false => format!("{}\nreport: {}", summary.words(), dir.join("report.html").display()),
    };
    Ok(Answer { text, json, failure })
}

/// The figures as the last event.
fn summary_event(json: &str) -> String {
    let summary = serde_json::from_str(json).unwrap_or(serde_json::Value::Null);
    serde_json::json!({ "event": "summary", "summary": summary }).to_string()
}

/// Hands a page to whatever shows pages here. Failing to is not worth an error: the path is printed.
pub(crate) fn open(page: &std::path::Path) {
    let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let quiet = std::process::Stdio::null;
    drop(std::process::Command::new(opener).arg(page).stdout(quiet()).stderr(quiet()).spawn());
}
