use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use clap::Args;
use tracelight_files::written_whole;
use tracelight_report::recover;
use tracelight_task::Failure;

use crate::cli::answer::{Answer, Voice};
use crate::cli::ending::ends_in;

/// Repair the run log of a killed program, so that every MCAP viewer opens it
///
/// A log grows record by record, and gets its index, which viewers ask for, when its run ends. All whole records stay, in their order.
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight recover out/house/run.mcap")]
pub(crate) struct RecoverArgs {
    /// The log, such as out/house/run.mcap
    #[arg(value_name = "RUN.mcap")]
    log: String,
    /// Where the whole one goes [default: in its place]
    #[arg(short, long, value_name = "FILE.mcap", value_parser = log)]
    output: Option<String>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

fn log(text: &str) -> Result<String, String> {
    ends_in(text, "mcap", "a run log is an MCAP file: end it in .mcap")
}

pub(crate) fn run(args: &RecoverArgs) -> Result<Answer, Failure> {
    let log = &args.log;
    let output = args.output.as_ref().unwrap_or(log);
    let bare = File::open(log).map_err(|e| {
        Failure::usage("unreadable", format!("cannot read {log}: {e}; check the name and the permissions"))
    })?;
    let found = written_whole(Path::new(output), |part| {
        let failed =
            |e: std::io::Error| Failure::failed("cannot-write", format!("cannot write {output}: {e}"));
        let indexed = BufWriter::new(File::create(part).map_err(failed)?);
        recover(bare, indexed).map_err(|e| {
            Failure::usage(
                "not-a-log",
                format!("{log} is no run log, or has no whole record: {e}; give a run.mcap"),
            )
        })
    })?;
    let rest = if found.torn { "; what follows them is no whole record, and was left out" } else { "" };
    let text = format!("{output}: {} messages, indexed{rest}", found.messages);
    let json =
        serde_json::json!({ "path": output, "messages": found.messages, "torn": found.torn }).to_string();
    Ok(Answer::new(text, json))
}
