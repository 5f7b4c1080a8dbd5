use std::f64::consts::TAU;
use std::path::Path;

use clap::{Args, ValueEnum};
use tracelight_chart::Theme;
use tracelight_experiment::plant_file::is_plant_name;
use tracelight_experiment::plants::SystemFile;
use tracelight_experiment::systems::{OneSystem, Reading, Systems};
use tracelight_linear::Discretization;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;
use tracelight_units::{FREQUENCIES, TIMES, parse};

use super::bounds::frequency;
use super::command::log;
use super::head::HeadArgs;

/// Systems to plot.
#[derive(Args, Debug)]
pub(crate) struct SystemArgs {
    /// Systems, each a formula: numbers, s, + − * / ^, brackets, dead times as exp(-0.2s) or pade(0.2, 3); factors side by side are multiplied. Or a file with a system: .toml, .json, .csv, .mat. G11 and G22 are the linearized head
    /// (see `tracelight lab linearize`). K11 and K22 are the 2006 report's compensators as printed (poles and zeros); K11t and K22t take
    /// the same numbers as time constants
    #[arg(value_name = "SYSTEM", required = true)]
    systems: Vec<String>,
    #[command(flatten)]
    how: HowArgs,
    /// Close each by unity feedback of its output, negative unless --positive is given, after it is discretized
    #[arg(long)]
    closed: bool,
    /// The feedback is positive: an open loop G is shown as −G, of which −1 is the critical point
    #[arg(long)]
    positive: bool,
    /// Light lines on dark ground
    #[arg(long)]
    dark: bool,
}

/// Plants of loops.
#[derive(Args, Debug)]
pub(super) struct PlantArgs {
    /// Plants, each a formula: numbers, s, + − * / ^, brackets, dead times as exp(-0.2s) or pade(0.2, 3); factors side by side are multiplied. Or a file with a system or a measured frequency response: .toml, .json, .csv, .mat.
    /// G11 and G22 are the linearized head (see `tracelight lab linearize`)
    #[arg(value_name = "PLANT", required = true)]
    plants: Vec<String>,
    #[command(flatten)]
    how: HowArgs,
    /// The feedback is positive: 1 − PC stands for 1 + PC
    #[arg(long)]
    positive: bool,
    /// Light lines on dark ground
    #[arg(long)]
    dark: bool,
}

/// One system.
#[derive(Args, Debug)]
pub(super) struct OneSystemArgs {
    /// The system, a formula: numbers, s, + − * / ^, brackets, dead times as exp(-0.2s) or pade(0.2, 3); factors side by side are multiplied. Or a file with a system: .toml, .json, .csv, .mat. G11 and G22 are the linearized head
    /// (see `tracelight lab linearize`)
    #[arg(value_name = "SYSTEM")]
    system: String,
    #[command(flatten)]
    how: HowArgs,
    /// Light lines on dark ground
    #[arg(long)]
    dark: bool,
}

/// What a formula's names and its variable are.
#[derive(Args, Debug)]
struct HowArgs {
    #[command(flatten)]
    head: HeadArgs,
    /// The formula is discrete-time, in z, with this sample period
    #[arg(long, value_name = "TIME", value_parser = period, conflicts_with = "sample")]
    period: Option<f64>,
    /// Discretize with this sample period
    #[arg(long, value_name = "TIME", value_parser = period)]
    sample: Option<f64>,
    /// A system from a file, and its name in formulas; P21 is output 2 from input 1 of one with several. Of several systems in a file
    /// CHOICE names one; may be given again
    #[arg(long = "with", value_name = "NAME=FILE[:CHOICE]", value_parser = named_file)]
    with: Vec<NamedFile>,
    /// Approximate a dead time in this order, 1 to 15, where only a rational system will do [default: the least whose phase is right to 1°]
    #[arg(long, value_name = "ORDER", value_parser = clap::value_parser!(u8).range(1..=15))]
    pade: Option<u8>,
    /// How it is discretized
    #[arg(long, value_enum, default_value = "hold", requires = "sample")]
    method: Method,
    /// Frequency at which --method tustin keeps the value exactly (pre-warping), below half the sampling frequency
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency, requires = "sample")]
    prewarp: Option<f64>,
}

/// A file and what it is called in formulas.
#[derive(Clone, Debug)]
struct NamedFile {
    name: String,
    file: String,
}

fn named_file(text: &str) -> Result<NamedFile, String> {
    const TAKEN: [&str; 9] = ["e", "exp", "pade", "G11", "G22", "K11", "K22", "K11t", "K22t"];
    let (name, file) = text.split_once('=').ok_or_else(|| format!("{text} is not NAME=FILE"))?;
    let is_word = name.chars().all(char::is_alphanumeric) && name.starts_with(char::is_alphabetic);
    if !is_word || name.starts_with(['s', 'z']) || TAKEN.contains(&name) {
        return Err(format!(
            "{name} cannot be a name in a formula: take a letter other than s and z, and letters and digits behind it, such as P"
        ));
    }
    if file.is_empty() {
        return Err(format!("{text} names no file"));
    }
    Ok(NamedFile { name: name.to_owned(), file: file.to_owned() })
}

impl NamedFile {
    fn read(&self) -> Result<SystemFile, Failure> {
        // a file's own name may have a colon
        let parted = self.file.rsplit_once(':').filter(|(file, _)| is_plant_name(file));
        let (file, choice) = match parted {
            Some((file, choice)) if !Path::new(&self.file).exists() => (file, Some(choice.to_owned())),
            _ => (self.file.as_str(), None),
        };
        Ok(SystemFile { name: self.name.clone(), log: log(file)?, choice })
    }
}

/// A way to sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// Zero-order hold, for plants
    Hold,
    /// First-order (triangle) hold, for inputs that are smooth
    Foh,
    /// Impulse response sampled
    Impulse,
    /// Tustin's bilinear rule, for controllers
    Tustin,
    /// Poles and zeros mapped by z = e^(sT)
    Matched,
}

impl Method {
    const fn discretization(self, prewarp: Option<f64>) -> Discretization {
        match self {
            Self::Hold => Discretization::ZeroOrderHold,
            Self::Foh => Discretization::FirstOrderHold,
            Self::Impulse => Discretization::Impulse,
            Self::Tustin => Discretization::Tustin(prewarp),
            Self::Matched => Discretization::Matched,
        }
    }
}

fn period(text: &str) -> Result<f64, String> {
    // as a time, or as how often a second
    let rate_hz =
        text.strip_suffix("Hz").and_then(|_| parse(text, FREQUENCIES).ok()).map(|rad_s| rad_s / TAU);
    let period_s =
        rate_hz.map_or_else(|| parse(text, TIMES).map_err(|e| e.to_string()), |hz| Ok(1.0 / hz))?;
    if period_s > 0.0 { Ok(period_s) } else { Err(format!("{text} is no time between samples")) }
}

const fn theme(dark: bool) -> Theme {
    if dark { Theme::Dark } else { Theme::Light }
}

impl SystemArgs {
    pub(super) fn systems(&self) -> Result<Systems, Failure> {
        self.systems_beside(&[])
    }

    /// The systems; others may be files as well.
    pub(super) fn systems_beside(&self, others: &[String]) -> Result<Systems, Failure> {
        let all: Vec<String> = self.systems.iter().chain(others).cloned().collect();
        Ok(Systems {
            formulas: self.systems.clone(),
            how: self.how.reading(&all)?,
            closed: self.closed,
            positive: self.positive,
            unstable: None,
            theme: theme(self.dark),
        })
    }
}

impl PlantArgs {
    pub(super) fn systems(&self, controllers: &[String]) -> Result<Systems, Failure> {
        let all: Vec<String> = self.plants.iter().chain(controllers).cloned().collect();
        Ok(Systems {
            formulas: self.plants.clone(),
            how: self.how.reading(&all)?,
            closed: false,
            positive: self.positive,
            unstable: None,
            theme: theme(self.dark),
        })
    }
}

impl OneSystemArgs {
    /// The rig that a design is tried on: the one that is linearized, or the preset `report` with the masses that are.
    pub(super) fn tried_rig(&self) -> Result<RigConfig, Failure> {
        self.how.head.tried_rig()
    }

    pub(super) fn system(&self) -> Result<OneSystem, Failure> {
        self.system_beside(&[])
    }

    /// The system, with the files of others that are read as it is.
    pub(super) fn system_beside(&self, others: &[String]) -> Result<OneSystem, Failure> {
        let all: Vec<String> = std::iter::once(&self.system).chain(others).cloned().collect();
        let how = self.how.reading(&all)?;
        Ok(OneSystem { formula: self.system.clone(), how, theme: theme(self.dark) })
    }
}

impl HowArgs {
    fn reading(&self, systems: &[String]) -> Result<Reading, Failure> {
        if self.prewarp.is_some() && self.method != Method::Tustin {
            let message = "--prewarp is of --method tustin; the other methods keep no frequency";
            return Err(Failure::usage("usage", message.to_owned()));
        }
        let own = systems.iter().map(|text| text.trim()).filter(|text| is_plant_name(text));
        let own = own.map(|text| Ok(SystemFile { name: text.to_owned(), log: log(text)?, choice: None }));
        let files = own.chain(self.with.iter().map(NamedFile::read)).collect::<Result<_, Failure>>()?;
        Ok(Reading {
            files,
            head: self.head.choice()?,
            period_s: self.period,
            pade: self.pade.map(usize::from),
            sampling: self.sample.map(|period_s| (period_s, self.method.discretization(self.prewarp))),
        })
    }
}
