//! Systems from files among the names of formulas.

use tracelight_linear::{Delayed, FrequencyData, LinearError, StateSpace, Time, TransferFunction};
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
                let named = format!("give it a name, --with P={text}, and write");
                Whole::System(one_of(system, "").ok_or_else(|| several(text, system, ("P", &named)))?)
            }
        }))
    }

    /// Refuses a formula that names a system of several inputs or outputs as a whole.
    ///
    /// # Errors
    /// `no-such-system`: how one channel is named, and which command takes all of them.
    pub(crate) fn refuse_several(&self, text: &str) -> Result<(), Failure> {
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).collect();
        let whole = self.0.iter().find_map(|(name, plant)| match plant {
            PlantFile::StateSpace(system) if words.contains(&name.as_str()) => Some((name, system)),
            _ => None,
        });
        match whole.filter(|(_, system)| system.d().shape() != (1, 1)) {
            Some((name, system)) => Err(several(name, system, (name, "write"))),
            None => Ok(()),
        }
    }

    /// The product of systems in state space, the last being the first that the input meets; none where a factor is no such system.
    pub(crate) fn product(&self, text: &str) -> Option<Result<StateSpace, LinearError>> {
        let of_name = |word: &str| {
            self.0.iter().find_map(|(name, plant)| match plant {
                PlantFile::StateSpace(system) if name == word => Some(system),
                _ => None,
            })
        };
        if let Some(whole) = of_name(text) {
            return Some(Ok(whole.clone()));
        }
        let words = text.split(|c: char| c == '*' || c.is_whitespace()).filter(|word| !word.is_empty());
        let factors: Vec<&StateSpace> = words.map(of_name).collect::<Option<_>>()?;
        let (last, others) = factors.split_last()?;
        Some(others.iter().rev().try_fold((*last).clone(), |first, next| first.series(next)))
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

/// What is said of a system of several inputs or outputs where one of each is needed; a name for its channels and how to use that.
fn several(text: &str, system: &StateSpace, (name, how): (&str, &str)) -> Failure {
    let (outputs, inputs) = system.d().shape();
    let message = format!(
        "{text} has {inputs} inputs and {outputs} outputs: lab sigma takes all of it; for a channel {how} {name}11 for output 1 from input 1, up \
         to {name}{outputs}{inputs}"
    );
    Failure::usage("no-such-system", message)
}

/// Output 2 from input 1 for `21`, the only one for no digits; without the modes that this channel neither moves nor shows.
fn one_of(system: &StateSpace, which: &str) -> Option<TransferFunction> {
    let digits: Option<Vec<usize>> = which.chars().map(|c| c.to_digit(10).map(|d| d as usize)).collect();
    let (output, input) = match digits?[..] {
        [] if system.d().shape() == (1, 1) => (1, 1),
        [output, input] => (output, input),
        _ => return None,
    };
    let channel = system.channel(output.checked_sub(1)?, input.checked_sub(1)?).ok()?;
    // what the input does not move and the output does not show would be poles that a zero hides
    let own = channel.minimal().map_or(channel, |minimal| minimal.system);
    Some(own.transfer(0, 0).ok()?.transfer())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, file: &str, text: &str) -> Plants {
        let log = Log { name: file.to_owned(), bytes: text.as_bytes().to_vec() };
        Plants::read(&[SystemFile { name: name.to_owned(), log, choice: None }]).unwrap()
    }

    const TWO: &str =
        "A = [[-1, 0], [0, -2]]\nB = [[1, 0], [0, 4]]\nC = [[1, 0], [0, 1]]\nD = [[0, 0], [0, 0]]\n";

    #[test]
    fn a_channel_is_named_by_its_output_and_input() {
        let plants = read("P", "two.toml", TWO);
        let text = |name: &str| plants.named(name, 1.0).map(|system| system.to_string());
        // the other mode is neither moved nor seen
        assert_eq!(text("P11").as_deref(), Some("1 / (s + 1)"));
        assert_eq!(text("P22").as_deref(), Some("4 / (s + 2)"));
        for none in ["P", "P1", "P31", "P10", "P111", "Q11", "Px1"] {
            assert_eq!(text(none), None, "{none}");
        }
        let itself = read("two.toml", "two.toml", TWO);
        let told = itself.whole("two.toml").err().unwrap().message;
        assert!(told.contains("2 inputs and 2 outputs") && told.contains("--with P=two.toml"), "{told}");
    }

    #[test]
    fn a_file_of_one_channel_stands_for_itself() {
        let one = read("one.toml", "one.toml", "num = [2]\nden = [1, 3]\n");
        let Ok(Some(Whole::System(system))) = one.whole("one.toml") else { panic!("it is one") };
        assert_eq!(system.to_string(), "2 / (s + 3)");
        assert!(one.whole("G11").unwrap().is_none());
    }

    #[test]
    fn measured_data_are_found_by_their_name() {
        let text = "Frequency (rad/s),Gain (dB),Phase (deg)\n1,0,-90\n2,-6,-120\n4,-12,-150\n8,-20,-180\n";
        let data = read("P", "data.csv", text);
        assert!(data.data_in("K11 P").is_some() && data.data_in("K11 P2").is_none());
        assert_eq!(data.named("P", 2.0).unwrap().to_string(), "2");
    }
}
