//! Flags of what joints are put through, for the commands that tell something from it.

use std::path::Path;

use clap::Args;
use tracelight_experiment::trials::{Seen, Trials};
use tracelight_files as files;
use tracelight_task::Failure;
use tracelight_units::TIMES;

use super::bounds::{above_zero, voltage};
use super::columns::ColumnArgs;
use super::command::{logs, make_folder};
use super::rig::RigArgs;
use super::step::Axis;

/// What joints are put through.
#[derive(Args, Debug)]
pub(super) struct TrialArgs {
    /// Logs of what a head did: axis,volt,time_s,count or axis,torque_nm,velocity_rad_s; given none, the simulated head is tried
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    #[command(flatten)]
    columns: ColumnArgs,
    #[command(flatten)]
    pub(super) rig: RigArgs,
    /// Only this joint [default: both]; the joint of a log that has no column axis
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// The head is in a fixture: the tested axis upright, so that gravity does not turn it, and free to turn on and on
    #[arg(long)]
    fixture: bool,
    /// Highest voltage, either way
    #[arg(long, value_name = "VOLTAGE", default_value = "1V", value_parser = voltage)]
    most: f64,
    /// From one voltage to the next
    #[arg(long, value_name = "VOLTAGE", default_value = "0.05V", value_parser = voltage)]
    step: f64,
    /// How long each voltage is held, at most
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = time)]
    hold: f64,
    /// Voltage of the pulse before each, against stiction, with its sign
    #[arg(long, value_name = "VOLTAGE", default_value = "1V", value_parser = voltage)]
    pulse: f64,
    /// How long that is given
    #[arg(long, value_name = "TIME", default_value = "1s", value_parser = time)]
    pulse_time: f64,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
}

/// Longest hold, s: an hour.
const LONGEST_S: f64 = 3600.0;

fn time(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    if time_s <= LONGEST_S { Ok(time_s) } else { Err(format!("{text} is more than {LONGEST_S} s")) }
}

impl TrialArgs {
    pub(super) fn trials(&self) -> Result<Trials, Failure> {
        Ok(Trials {
            rig: self.rig.config()?,
            logs: logs(&self.logs)?,
            columns: self.columns.columns(),
            only: self.axis.map(Axis::joint),
            fixture: self.fixture,
            most_v: self.most,
            step_v: self.step,
            hold_s: self.hold,
            pulse_v: self.pulse,
            pulse_s: self.pulse_time,
            seed: self.seed,
        })
    }
}

/// Leaves log.csv in a folder, which is made if missing, if the simulated head was tried.
pub(super) fn leave_log(seen: &Seen, out: &Path) -> Result<(), Failure> {
    make_folder(out, "--out")?;
    seen.log().map_or(Ok(()), |log| files::write(&out.join("log.csv").display().to_string(), log))
}
