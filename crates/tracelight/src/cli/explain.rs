use clap::Args;
use tracelight_task::{Failure, codes, nearest};

use crate::cli::answer::{Answer, Voice};

/// Say what a code in a message, a summary or a log means, and what to do
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight explain following-error")]
pub(crate) struct ExplainArgs {
    /// The code; without it all of them are listed
    code: Option<String>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run(args: &ExplainArgs) -> Result<Answer, Failure> {
    let all = codes();
    let Some(code) = &args.code else {
        let lines: Vec<String> = all.iter().map(|(code, words)| format!("{code:18}  {words}")).collect();
        return Ok(Answer::new(lines.join("\n"), json(&all)));
    };
    let near = nearest(code, all.iter().map(|(code, _)| *code));
    let found: Vec<_> = all.into_iter().filter(|(c, _)| c == code).collect();
    let Some((_, words)) = found.first() else {
        let hint = near.map_or_else(String::new, |near| format!(" did you mean {near}?"));
        let message = format!("{code} is no code;{hint} `tracelight explain` lists all of them");
        return Err(Failure::usage("usage", message));
    };
    Ok(Answer::new(words, json(&found)))
}

fn json(codes: &[(&'static str, String)]) -> String {
    let entries: Vec<_> = codes.iter().map(|(c, w)| serde_json::json!({ "code": c, "meaning": w })).collect();
    serde_json::json!({ "codes": entries }).to_string()
}
