use clap::Args;
use tracelight_experiment::linearize::Request;
use tracelight_experiment::plant_file::{PlantFormat, write};
use tracelight_files as files;
use tracelight_task::{Failure, Stop};

use super::command::{self, LabCommand};
use super::head::HeadArgs;
use crate::cli::answer::{Answer, Voice};

/// The head near a pose as a linear system: state space, transfer functions G11 and G22 from torque to angle, poles
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab linearize --keep-cancellations\n\n\
                  Without flags it is the 2006 report's own linearization. Coulomb friction has no linear form and is left out. \
                  G11 and G22 go into other commands as they are: tracelight lab bode \"K11 G11\".")]
pub(crate) struct LinearizeArgs {
    #[command(flatten)]
    head: HeadArgs,
    /// Write A, B, C and D there, read back to the bit: .toml, .json, .csv (blocks of rows under A, B, C, D) or .mat (MATLAB's version 5).
    /// May be given several times
    #[arg(short, long, value_name = "FILE.toml|FILE.json|FILE.csv|FILE.mat", value_parser = system_file)]
    out: Vec<(String, PlantFormat)>,
    #[command(flatten)]
    voice: Voice,
}

fn system_file(text: &str) -> Result<(String, PlantFormat), String> {
    let format = PlantFormat::of(text);
    let format = format.ok_or_else(|| format!("{text} ends in none of .toml, .json, .csv and .mat"))?;
    Ok((text.to_owned(), format))
}

impl LabCommand for LinearizeArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let finding = command::tried(Request(self.head.choice()?), self.voice, stop)?;
        self.out
            .iter()
            .try_for_each(|(path, format)| files::write(path, write(finding.system(), *format)))?;
        Ok(command::answer(&finding, self.voice))
    }
}
