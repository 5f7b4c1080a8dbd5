//! `lab friction`: its flags, and where what is found goes.

use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::friction::Request;
use tracelight_task::{Failure, Stop};

use super::command::{self, LabCommand};
use super::rig_out;
use super::trials::{TrialArgs, leave_log};
use crate::cli::answer::{Answer, Voice, watched};

/// Identify friction from constant-voltage tests as in the 2006 report, show the flaw of that method, and fit the full curves instead
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab friction examples/motor.csv --out out/friction\n\
                  Example: tracelight lab friction examples/board.csv --axis pan --fixture --columns volt=PWM*3/255\n\n\
                  The report gives a joint −1 to 1 V in steps of 0.05 V, 30 s each after a pulse of 1 V, takes the last speeds for \
                  steady, and lays a line through torque over speed for each direction: viscous friction its slope, Coulomb friction \
                  its intercept. Both are shown: that, and what the whole of each curve tells, steady or not. With --fixture each \
                  axis stands upright and may turn on and on, as the report had it; without, the joint goes to and fro within its \
                  range, what is believed of gravity is balanced on top of each voltage, and gravity is fitted as well.\n\n\
                  Friction comes out in units of what the rig file says of torque per volt. The folder gets friction.svg, log.csv \
                  (which can be given back as LOG.csv) and rig.toml. In a log, a time that goes back begins a new trial, and volt is \
                  the mean voltage until the next row.")]
pub(crate) struct FrictionArgs {
    #[command(flatten)]
    trials: TrialArgs,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/friction")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for FrictionArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        self.trials.rig.may_save(self.save)?;
        let trials = self.trials.trials()?;
        let seen = watched(self.voice, stop, |task| trials.seen(task))?;
        leave_log(&seen, &self.out)?;
        let finding = command::tried(Request(seen), self.voice, stop)?;
        command::leave(&finding, &self.out)?;
        rig_out::written(&finding, &self.out, self.trials.rig.name(), self.save, self.voice)
    }
}
