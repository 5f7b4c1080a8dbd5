//! `lab inertia`: its flags, and where what is found goes.

use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::inertia::Request;
use tracelight_task::{Failure, Stop};

use super::command::{self, LabCommand};
use super::rig_out;
use super::trials::{TrialArgs, leave_log};
use crate::cli::answer::{Answer, Voice, watched};

/// Identify what each joint's inertia is, from how fast voltages speed it up
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab inertia --fixture --most 3V --step 0.5V --hold 5s\n\n\
                  The trials are those of `lab friction`. Inertia comes out in units of what the rig file says of torque per volt. \
                  The folder gets log.csv, if the head was tried, and rig.toml: bodies keep theirs, the rotor gets the rest.")]
pub(crate) struct InertiaArgs {
    #[command(flatten)]
    trials: TrialArgs,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/inertia")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for InertiaArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        self.trials.rig.may_save(self.save)?;
        let trials = self.trials.trials()?;
        let seen = watched(self.voice, stop, |task| trials.seen(task))?;
        leave_log(&seen, &self.out)?;
        let finding = command::tried(Request(seen), self.voice, stop)?;
        rig_out::written(&finding, &self.out, self.trials.rig.name(), self.save, self.voice)
    }
}
