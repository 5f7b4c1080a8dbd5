//! `lab identify`: its flags, and where what is found goes.

use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::identify::Request;
use tracelight_task::{Failure, Stop};

use super::columns::ColumnArgs;
use super::command::{self, LabCommand, logs};
use super::rig::RigArgs;
use super::rig_out;
use super::step::Axis;
use crate::cli::answer::{Answer, Voice};
use crate::named;
use tracelight_flags::LawArgs;

/// Identify the head's parameters: inertia, friction, weight, amplifier, positions of its encoders' edges
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab identify --rig worn --out out/worn\n\n\
                  Without a RECORD.csv the rig moves for some 45 s in the dark, both joints through ±26° or what their range \
                  allows. What is found goes to rig.toml in --out, for --rig of all commands. One third of \
                  the data is held out; a fit that predicts it worse than the current model is refused.\n\n\
                  Only ratios are observable from counts and volts: doubling inertia, friction and weight together with the torque \
                  per volt changes nothing that is measured. The common scale is fixed by assuming that inertia and weight are known \
                  within 5 %, the torque per volt within 20 %. Play between encoder and beam cannot be seen by an encoder.")]
pub(crate) struct IdentifyArgs {
    /// Records of what the rig did, such as a trace.csv; given none, the rig moves
    #[arg(value_name = "RECORD.csv")]
    records: Vec<String>,
    #[command(flatten)]
    rig: RigArgs,
    #[command(flatten)]
    columns: ColumnArgs,
    /// The joint of a record of somebody else's, which tells one joint alone
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    #[command(flatten)]
    law: LawArgs,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for rig.toml, and for record.csv where the rig moved
    #[arg(long, value_name = "DIR", default_value = "out/identify")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for IdentifyArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let finding = command::tried(self.request()?, self.voice, stop)?;
        command::leave(&finding, &self.out)?;
        rig_out::written(&finding, &self.out, self.rig.name(), self.save, self.voice)
    }
}

impl IdentifyArgs {
    fn request(&self) -> Result<Request, Failure> {
        let mut rig = self.rig.config()?;
        self.rig.may_save(self.save)?;
        self.law.apply(&mut rig)?;
        Ok(Request {
            rig,
            records: logs(&self.records)?,
            columns: self.columns.columns(),
            axis: self.axis.map(Axis::joint),
            seed: self.seed,
            day: named::today(),
        })
    }
}
