use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::cli::answer::{Answer, Voice};

/// Print completions for a shell
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight completions bash > /etc/bash_completion.d/tracelight")]
pub(crate) struct CompletionsArgs {
    /// Which shell
    #[arg(value_enum)]
    shell: Shell,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run<C: CommandFactory>(args: &CompletionsArgs) -> Answer {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut C::command(), "tracelight", &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    Answer::new(script.trim_end(), serde_json::json!({ "script": script }).to_string())
}
