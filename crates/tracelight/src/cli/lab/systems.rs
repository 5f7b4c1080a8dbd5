use std::fmt::Write;

use clap::{Args, ValueEnum};
use tracelight_chart::{Colour, Theme};
use tracelight_lab::Linearization;
use tracelight_linear::{
    Complex, Discretization, FormulaError, LinearError, Mode, Names, Time, TransferFunction, Zpk, four_digits,
};
use tracelight_rig::Joint;
use tracelight_sim::Compensator;
use tracelight_task::Failure;
use tracelight_units::{TIMES, parse};

use super::head::HeadArgs;

/// Systems to plot.
#[derive(Args, Debug)]
pub(crate) struct SystemArgs {
    /// Systems, each a formula: numbers, s, + − * / ^, brackets; what stands side by side is multiplied. G11 and G22 are the head
    /// linearized (see `tracelight lab linearize`), K11 and K22 the 2006 report's compensators as typeset, K11t and K22t the same read
    /// as time constants
    #[arg(value_name = "SYSTEM", required = true)]
    systems: Vec<String>,
    #[command(flatten)]
    how: HowArgs,
    /// Close each by negative feedback of its output, after it is sampled
    #[arg(long)]
    closed: bool,
    /// Light lines on dark ground
    #[arg(long)]
    dark: bool,
}

/// One system.
#[derive(Args, Debug)]
pub(super) struct OneSystemArgs {
    /// The system, a formula: numbers, s, + − * / ^, brackets; what stands side by side is multiplied. G11 and G22 are the head linearized
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
    /// The formula is of samples so far apart, its variable is z
    #[arg(long, value_name = "TIME", value_parser = period, conflicts_with = "sample")]
    period: Option<f64>,
    /// Sample it, so often
    #[arg(long, value_name = "TIME", value_parser = period)]
    sample: Option<f64>,
    /// How it is sampled
    #[arg(long, value_enum, default_value = "hold", requires = "sample")]
    method: Method,
}

/// A way to sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// The input is held from sample to sample: a plant behind a converter
    Hold,
    /// Tustin's rule: a controller
    Tustin,
    /// Poles and zeros by z = e^(sT)
    Matched,
}

impl Method {
    const fn discretization(self) -> Discretization {
        match self {
            Self::Hold => Discretization::ZeroOrderHold,
            Self::Tustin => Discretization::Tustin(None),
            Self::Matched => Discretization::Matched,
        }
    }

    const fn words(self) -> &'static str {
        match self {
            Self::Hold => "a hold",
            Self::Tustin => "Tustin's rule",
            Self::Matched => "matching",
        }
    }
}

fn period(text: &str) -> Result<f64, String> {
    let period_s = parse(text, TIMES).map_err(|e| e.to_string())?;
    if period_s > 0.0 { Ok(period_s) } else { Err(format!("{text} is no time between samples")) }
}

/// A system and what it is called.
pub(super) struct Named {
    /// As typed, and what was made of it.
    pub(super) name: String,
    pub(super) system: TransferFunction,
    pub(super) colour: Colour,
}

impl SystemArgs {
    pub(super) const fn theme(&self) -> Theme {
        if self.dark { Theme::Dark } else { Theme::Light }
    }

    /// All systems, as they are to be plotted.
    pub(super) fn systems(&self) -> Result<Vec<Named>, Failure> {
        let reader = self.how.reader()?;
        let all = self.systems.iter().zip(Colour::in_turn());
        all.map(|(text, colour)| {
            let (mut name, mut system) = reader.read(text)?;
            if self.closed {
                system = system.closed().map_err(|e| no_such_system(text, &e))?;
                name += ", closed";
            }
            Ok(Named { name, system, colour })
        })
        .collect()
    }
}

impl OneSystemArgs {
    pub(super) const fn theme(&self) -> Theme {
        if self.dark { Theme::Dark } else { Theme::Light }
    }

    /// The rig whose masses are linearized, if one is named.
    pub(super) fn rig(&self) -> Option<&str> {
        self.how.head.rig.as_deref()
    }

    /// Its name and what it is.
    pub(super) fn system(&self) -> Result<(String, TransferFunction), Failure> {
        self.how.reader()?.read(&self.system)
    }
}

fn no_such_system(text: &str, error: &LinearError) -> Failure {
    Failure::failed("no-such-system", format!("{text}: {error}"))
}

/// A controller in continuous time: a formula, in which K11, K22, K11t and K22t are the report's.
pub(super) fn controller(text: &str) -> Result<Zpk, Failure> {
    Ok(parsed(text, Time::Continuous, &the_reports)?.zpk())
}

/// A formula read; what is wrong with it is pointed at.
fn parsed(text: &str, time: Time, named: &Names<'_>) -> Result<TransferFunction, Failure> {
    let pointed = |e: FormulaError| format!("{e}\n  {text}\n  {}^", " ".repeat(e.at));
    TransferFunction::parse_with(text, time, named).map_err(|e| Failure::usage("bad-formula", pointed(e)))
}

/// The report's compensators by name.
fn the_reports(name: &str) -> Option<TransferFunction> {
    match name {
        "K11" => compensator(Joint::Pan, false),
        "K22" => compensator(Joint::Tilt, false),
        "K11t" => compensator(Joint::Pan, true),
        "K22t" => compensator(Joint::Tilt, true),
        _ => None,
    }
}

/// What formulas are read with.
struct Reader<'a> {
    how: &'a HowArgs,
    head: Linearization,
}

impl HowArgs {
    fn reader(&self) -> Result<Reader<'_>, Failure> {
        Ok(Reader { how: self, head: self.head.head()?.linearize()? })
    }
}

impl Reader<'_> {
    /// The system that a formula names.
    fn named(&self, name: &str) -> Option<TransferFunction> {
        let keep = self.how.head.keep_cancellations;
        let own = |joint: Joint| match keep {
            true => self.head.transfer(joint).ok(),
            false => self.head.own_transfer(joint).ok().map(|own| own.0),
        };
        match name {
            "G11" => own(Joint::Pan),
            "G22" => own(Joint::Tilt),
            _ => the_reports(name),
        }
    }

    /// What a formula is, and what was made of it.
    fn read(&self, text: &str) -> Result<(String, TransferFunction), Failure> {
        let time = self.how.period.map_or(Time::Continuous, Time::Sampled);
        let mut system = parsed(text, time, &|name| self.named(name))?;
        let mut name = text.to_owned();
        if let Some(period_s) = self.how.sample {
            let method = self.how.method;
            system =
                system.sampled(period_s, method.discretization()).map_err(|e| no_such_system(text, &e))?;
            name += &format!(", sampled every {} ms by {}", four(1e3 * period_s), method.words());
        }
        Ok((name, system))
    }
}

/// Refuses what would take more memory than a plot is worth: so many numbers in all.
pub(super) fn bounded(points: u32, others: usize) -> Result<(), Failure> {
    const MOST: usize = 1_000_000;
    let most = MOST / others.max(1);
    if points as usize <= most {
        return Ok(());
    }
    let message = format!("--points {points} would make more than {MOST} numbers; here {most} is the most");
    Err(Failure::usage("usage", message))
}

/// The report's compensator of a joint, in one of its readings.
fn compensator(joint: Joint, time_constants: bool) -> Option<TransferFunction> {
    let Compensator { gain, zeros, poles } = Compensator::of_the_report(joint);
    let left = |roots: [f64; 2]| roots.map(|root| Complex::new(-root, 0.0)).to_vec();
    let (zeros, poles) = (left(zeros), left(poles));
    let zpk = match time_constants {
        true => Zpk::from_time_constants(gain, zeros, poles),
        false => Zpk::new(gain, zeros, poles, Time::Continuous),
    };
    zpk.ok().map(|zpk| zpk.transfer())
}

/// A number for people: four digits, without idle zeros.
pub(super) fn four(value: f64) -> String {
    if value.is_infinite() { "∞".to_owned() } else { four_digits(value).replace('-', "−") }
}

/// A time, for people.
pub(super) fn seconds(seconds: Option<f64>) -> String {
    seconds.map_or("never".to_owned(), |s| format!("{} s", four(s)))
}

/// A share, for people.
pub(super) fn percent(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |p| format!("{} %", four(p)))
}

/// A pole or zero and its mirror, for people.
pub(super) fn place(root: Complex) -> String {
    if root.im == 0.0 { four(root.re) } else { format!("{} ± {}j", four(root.re), four(root.im.abs())) }
}

/// Poles for people: a line each, with natural frequency and damping.
pub(super) fn pole_lines(poles: &[Complex], time: Time) -> String {
    let mut text = format!("    {:28} {:>16} {:>10}\n", "pole", "natural, rad/s", "damping");
    for pole in poles.iter().filter(|pole| pole.im >= 0.0) {
        let Mode { natural_rad_s, damping, .. } = Mode::of(*pole, time);
        let damping = match natural_rad_s {
            0.0 => "–".to_owned(),
            _ => format!("{damping:.4}").replace('-', "−"),
        };
        // writing to a String cannot fail
        let _ = writeln!(text, "    {:28} {:>16} {damping:>10}", place(*pole), four(natural_rad_s));
    }
    text
}

/// A complex number for scripts.
pub(super) fn pairs(values: &[Complex]) -> Vec<[f64; 2]> {
    values.iter().map(|z| [z.re, z.im]).collect()
}
