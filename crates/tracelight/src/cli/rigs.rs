use clap::{Args, Subcommand};
use tracelight_rigfile as rigfile;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

use crate::cli::answer::{Answer, Voice};
use crate::named;

/// List the rigs that come with the program, or print one as a file
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight rigs show report > my-rig.toml")]
pub(crate) struct RigsArgs {
    #[command(subcommand)]
    action: Option<RigsAction>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

#[derive(Subcommand, Debug)]
enum RigsAction {
    /// Print a rig as a rig file
    #[command(after_help = "Example: tracelight rigs show worn > worn.toml")]
    Show {
        /// A preset's name or a rig file
        name: String,
    },
}

impl RigsArgs {
    /// Whether a rig file is printed.
    pub(crate) const fn shows_file(&self) -> bool {
        self.action.is_some()
    }
}

pub(crate) fn run(args: &RigsArgs) -> Result<Answer, Failure> {
    match &args.action {
        None => Ok(list()),
        Some(RigsAction::Show { name }) => {
            let text = rigfile::write(&named::rig(name)?);
            let json = serde_json::json!({ "name": name, "toml": text }).to_string();
            Ok(Answer::new(text.trim_end(), json))
        }
    }
}

fn list() -> Answer {
    let presets = RigConfig::presets();
    let lines: Vec<String> = presets.iter().map(|p| format!("{:10}  {}", p.name, p.description)).collect();
    let json: Vec<_> =
        presets.iter().map(|p| serde_json::json!({ "name": p.name, "description": p.description })).collect();
    Answer::new(lines.join("\n"), serde_json::json!({ "rigs": json }).to_string())
}
