//! `lab gravity`: its flags, and where what is found goes.

use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::gravity::{Request, of_tilt};
use tracelight_task::{Failure, Stop};

use super::command::{self, LabCommand};
use super::rig_out;
use super::trials::{TrialArgs, leave_log};
use crate::cli::answer::{Answer, Voice, watched};

/// Identify what gravity does to tilt, from how voltages turn it against its weight
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab gravity --most 2V --step 0.25V\n\n\
                  The trials are those of `lab friction` on tilt, the head on its feet. Weight comes out in units of what the rig \
                  file says of torque per volt. The folder gets gravity.svg, log.csv, if the head was tried, and rig.toml: what \
                  tilt carries is moved until it weighs so, its mass kept.")]
pub(crate) struct GravityArgs {
    #[command(flatten)]
    trials: TrialArgs,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/gravity")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for GravityArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let trials = of_tilt(self.trials.trials()?)?;
        self.trials.rig.may_save(self.save)?;
        let seen = watched(self.voice, stop, |task| trials.seen(task))?;
        leave_log(&seen, &self.out)?;
        let finding = command::tried(Request(seen), self.voice, stop)?;
        command::leave(&finding, &self.out)?;
        rig_out::written(&finding, &self.out, self.trials.rig.name(), self.save, self.voice)
    }
}
