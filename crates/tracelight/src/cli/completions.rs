use clap::Args;
use clap_complete::Shell;
use clap_complete::env::Shells;
use tracelight_task::Failure;

use crate::cli::answer::{Answer, Voice};
use crate::cli::candidates::ASKS;

/// Print completions for a shell: commands, flags and their values, and the rigs, codes, cameras and layers that there are
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight completions bash > /etc/bash_completion.d/tracelight\n\n\
                  What is printed asks the program each time, so that it offers what there is: `tracelight` must be where the shell finds it.")]
pub(crate) struct CompletionsArgs {
    /// Which shell
    #[arg(value_enum)]
    shell: Shell,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run(args: &CompletionsArgs) -> Result<Answer, Failure> {
    const PROGRAM: &str = "tracelight";
    let failed = |why: &str| Failure::failed("internal", format!("{}: {why}", args.shell));
    let all = Shells::builtins();
    let shell = all.completer(&args.shell.to_string()).ok_or_else(|| failed("no script for it"))?;
    let mut script = Vec::new();
    let written = shell.write_registration(ASKS, PROGRAM, PROGRAM, PROGRAM, &mut script);
    written.map_err(|e| failed(&e.to_string()))?;
    let script = String::from_utf8_lossy(&script).into_owned();
    Ok(Answer::new(script.trim_end(), serde_json::json!({ "script": script }).to_string()))
}
