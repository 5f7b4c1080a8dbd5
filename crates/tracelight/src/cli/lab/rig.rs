//! `--rig` and `--set`: the rig of a command of the bench.

use clap::Args;
use tracelight_rigfile::measured;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

use super::head::Set;
use crate::named;

/// Which rig.
#[derive(Args, Clone, Debug)]
pub(super) struct RigArgs {
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    #[command(flatten)]
    set: SetArgs,
}

/// Whose masses, if not the rig's own.
#[derive(Args, Clone, Copy, Debug)]
pub(super) struct SetArgs {
    /// Masses and rotor inertias of one of the 2006 report's two parameter sets, instead of the rig's; everything else stays as the rig
    /// has it: `--set B` alone is `--rig report-b`
    #[arg(long, value_name = "A|B", value_enum, ignore_case = true)]
    set: Option<Set>,
}

impl RigArgs {
    /// Returns the rig, with the masses of `--set`.
    ///
    /// # Errors
    /// A rig file that is missing or wrong.
    pub(super) fn config(&self) -> Result<RigConfig, Failure> {
        self.set.on(named::rig(&self.rig)?)
    }

    /// Returns what was given as `--rig`.
    pub(super) fn name(&self) -> &str {
        &self.rig
    }

    /// Refuses `--save` where there is no file of the user's own, or where it would write masses that are not the file's.
    ///
    /// # Errors
    /// `usage`.
    pub(super) fn may_save(&self, save: bool) -> Result<(), Failure> {
        self.set.may_save(&self.rig, save)
    }
}

impl SetArgs {
    /// Returns a rig with these masses; one without encoders is refused.
    pub(super) fn on(self, rig: RigConfig) -> Result<RigConfig, Failure> {
        measured(&rig, "this `lab` command")?;
        let Some(set) = self.set else { return Ok(rig) };
        Ok(set.set().on(rig))
    }

    /// Refuses `--save` into what comes with the program, and of masses that are not the file's.
    ///
    /// # Errors
    /// `usage`.
    pub(super) fn may_save(self, rig: &str, save: bool) -> Result<(), Failure> {
        let refused = |message: String| Err(Failure::usage("usage", message));
        match (save, self.set) {
            (true, _) if RigConfig::preset(rig).is_some() => {
                refused(format!("--save needs a rig file of your own; {rig} comes with the program"))
            }
            (true, Some(_)) => refused(format!(
                "--save would write what was found with the masses of --set into {rig}, which has its own; leave out one of the two"
            )),
            _ => Ok(()),
        }
    }
}
