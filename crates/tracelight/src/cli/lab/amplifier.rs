//! `lab amplifier`: its flags, and where what is found goes.

use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::amplifier::Request;
use tracelight_task::{Failure, Stop};
use tracelight_units::{CURRENTS, TORQUE_CONSTANTS};

use super::bounds::{above_zero, voltage};
use super::columns::ColumnArgs;
use super::command::{self, LabCommand, logs};
use super::rig::RigArgs;
use super::rig_out;
use super::step::Axis;
use crate::cli::answer::{Answer, Voice};

/// Identify an amplifier's gain and its motor's back-EMF
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight lab amplifier examples/amplifier.csv --rig examples/rig.toml\n\n\
                  A log has a row each reading: axis,volt,ampere, and velocity_rad_s if somebody looked at the speed: volts at the amplifier's input, \
                  amperes through the motor. Who divides amperes by volts with the motor turning reads too little: its own voltage (back-EMF) \
                  works against the amplifier. Given the speeds, both are told apart. Given no log, the simulated head is tried in a \
                  fixture, each axis upright and free. The folder gets amplifier.svg, readings.csv, if the head was tried, and rig.toml, its torque per \
                  volt that of the amperes."
)]
pub(crate) struct AmplifierArgs {
    /// Logs of readings: axis,volt,ampere[,velocity_rad_s]
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    #[command(flatten)]
    columns: ColumnArgs,
    #[command(flatten)]
    rig: RigArgs,
    /// Only this joint [default: both]; the joint of a log that has no column axis
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// Torque at the joint for each ampere: the motor's constant times its gears and belt [default: the 2006 report's]
    #[arg(long, value_name = "TORQUE", default_value = "0.77388696Nm/A", value_parser = torque_constant)]
    torque_per_ampere: f64,
    /// Highest voltage, either way, that the simulated head is tried with
    #[arg(long, value_name = "VOLTAGE", default_value = "2V", value_parser = voltage)]
    most: f64,
    /// What the ammeter shows: its last digit
    #[arg(long, value_name = "CURRENT", default_value = "1mA", value_parser = current)]
    ammeter: f64,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/amplifier")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    voice: Voice,
}

fn torque_constant(text: &str) -> Result<f64, String> {
    above_zero(text, TORQUE_CONSTANTS)
}

fn current(text: &str) -> Result<f64, String> {
    above_zero(text, CURRENTS)
}

impl LabCommand for AmplifierArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let request = self.request()?;
        let finding = command::tried(request, self.voice, stop)?;
        command::leave(&finding, &self.out)?;
        rig_out::written(&finding, &self.out, self.rig.name(), self.save, self.voice)
    }
}

impl AmplifierArgs {
    fn request(&self) -> Result<Request, Failure> {
        let rig = self.rig.config()?;
        self.rig.may_save(self.save)?;
        Ok(Request {
            rig,
            logs: logs(&self.logs)?,
            columns: self.columns.columns(),
            only: self.axis.map(Axis::joint),
            torque_nm_per_a: self.torque_per_ampere,
            most_v: self.most,
            ammeter_a: self.ammeter,
            seed: self.seed,
        })
    }
}
