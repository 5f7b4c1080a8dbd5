//! Systems from files among the names of formulas.

use tracelight_linear::{Delayed, FrequencyData, StateSpace, Time, TransferFunction};
use tracelight_task::Failure;

use crate::plant_file::{self, PlantFile};
use crate::table::Log;

/// A file with a system.
#[derive(Clone, Debug)]
pub struct SystemFile {
    /// What it is called in formulas; the file's own name where it stands for itself.
    pub name: String,
    /// Its name and bytes.
    pub log: Log,
    /// Which of several systems in it, as [`plant_file::read`] takes it.
    pub choice: Option<String>,
}

/// Systems that were read from files.
pub(crate) struct Plants(Vec<(String, PlantFile)>);

/// A file that stands for itself.
pub(crate) enum Whole {
    System(TransferFunction),
    Data(FrequencyData),
}

impl Plants {
    pub(crate) fn read(files: &[SystemFile]) -> Result<Self, Failure> {
        let one = |file: &SystemFile| {
            let plant = plant_file::read(&file.log, file.choice.as_deref())?;
            Ok((file.name.clone(), plant.system))
        };
        files.iter().map(one).collect::<Result<_, _>>().map(Self)
    }

    /// The system of a name, `P`, or of several inputs and outputs `P21`: output 2 from input 1. For what was measured stands a number.
    pub(crate) fn named(&self, name: &str, measured: f64) -> Option<Delayed> {
        let system = self.0.iter().find_map(|(own, plant)| {
            let which = name.strip_prefix(own.as_str())?;
            match plant {
                PlantFile::Transfer(system) => which.is_empty().then(|| system.clone()),
                PlantFile::Frequencies(_) => {
                    which.is_empty().then(|| TransferFunction::gain(measured, Time::Continuous))
                }
                PlantFile::StateSpace(system) => one_of(system, which),
            }
        });
        system.map(Delayed::from)
    }

    /// A file that stands for itself, if the text is its name.
    ///
    /// # Errors
    /// `no-such-system` of several inputs or outputs: how one of them is named.
    pub(crate) fn whole(&self, text: &str) -> Result<Option<Whole>, Failure> {
        let is_file = |name: &str| name == text && plant_file::is_plant_name(name);
        let Some((_, plant)) = self.0.iter().find(|(name, _)| is_file(name)) else { return Ok(None) };
        Ok(Some(match plant {
            PlantFile::Transfer(system) => Whole::System(system.clone()),
            PlantFile::Frequencies(data) => Whole::Data(data.clone()),
            PlantFile::StateSpace(system) => {
                let (outputs, inputs) = system.d().shape();
                let several = || {
                    let message = format!(
                        "{text} has {inputs} inputs and {outputs} outputs: give it a name, --with P={text}, and write P11 for output 1 \
                         from input 1, up to P{outputs}{inputs}"
                    );
                    Failure::usage("no-such-system", message)
                };
                Whole::System(one_of(system, "").ok_or_else(several)?)
            }
        }))
    }

    /// Measured data that a formula names.
    pub(crate) fn data_in(&self, text: &str) -> Option<&FrequencyData> {
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).collect();
        self.0.iter().find_map(|(name, plant)| match plant {
            PlantFile::Frequencies(data) if words.contains(&name.as_str()) => Some(data),
            _ => None,
        })
    }
}

/// Output 2 from input 1 for `21`; the only one for no digits.
fn one_of(system: &StateSpace, which: &str) -> Option<TransferFunction> {
    let digits: Option<Vec<usize>> = which.chars().map(|c| c.to_digit(10).map(|d| d as usize)).collect();
    let (output, input) = match digits?[..] {
        [] if system.d().shape() == (1, 1) => (1, 1),
        [output, input] => (output, input),
        _ => return None,
    };
    let zpk = system.transfer(output.checked_sub(1)?, input.checked_sub(1)?).ok()?;
    Some(zpk.transfer())
}
