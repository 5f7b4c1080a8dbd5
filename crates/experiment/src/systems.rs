//! Systems on paper: formulas, the head linearized among their names, and what is shown of each.

use std::fmt::Write;

use tracelight_chart::{Colour, Theme};
use tracelight_lab::Linearization;
use tracelight_linear::{
    Complex, Delayed, Discretization, DistinctRoot, FormulaError, FrequencyData, LinearError, Mode, Names,
    StateSpace, Time, TransferFunction, Zpk,
};
use tracelight_maths::complex;
use tracelight_rig::Joint;
use tracelight_sim::Compensator;
use tracelight_task::Failure;

use crate::closing;
use crate::head::HeadChoice;
use crate::named::Named;
use crate::numbers::four;
use crate::plants::{Plants, SystemFile, Whole};

/// Systems to plot.
#[derive(Clone, Debug)]
pub struct Systems {
    /// Each a formula in which G11 and G22 are the head linearized, K11, K22, K11t and K22t the 2006 report's compensators.
    pub formulas: Vec<String>,
    /// How they are read.
    pub how: Reading,
    /// Close each by feedback of its output, after it is sampled.
    pub closed: bool,
    /// The feedback is positive: an open loop G is taken as −G, whose turns round −1 are those of G round +1.
    pub positive: bool,
    /// How many unstable poles each open loop has that was measured, if that is known.
    pub unstable: Option<usize>,
    /// How they are plotted.
    pub theme: Theme,
}

/// One system.
#[derive(Clone, Debug)]
pub struct OneSystem {
    /// Its formula, as in [`Systems`].
    pub formula: String,
    /// How it is read.
    pub how: Reading,
    /// How it is plotted.
    pub theme: Theme,
}

/// What a formula's names and its variable are.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The head that G11 and G22 are.
    pub head: HeadChoice,
    /// The formula is of samples so far apart, s, its variable is z.
    pub period_s: Option<f64>,
    /// Sample it: how often, s, and how.
    pub sampling: Option<(f64, Discretization)>,
    /// Order in which a dead time is approximated where only a rational system will do, 1 to 15; if not given, the least whose phase is
    /// off by no more than a degree where it matters.
    pub pade: Option<usize>,
    /// Systems from files, and what they are called.
    pub files: Vec<SystemFile>,
}

fn words(method: Discretization) -> String {
    let words = match method {
        Discretization::Tustin(Some(rad_s)) => {
            return format!("Tustin's rule, pre-warped at {} rad/s", four(rad_s));
        }
        Discretization::ZeroOrderHold => "a hold",
        Discretization::Tustin(None) => "Tustin's rule",
        Discretization::FirstOrderHold => "a first-order hold",
        Discretization::Impulse => "its impulse response",
        Discretization::Matched => "matching",
    };
    words.to_owned()
}

impl Systems {
    /// All systems, as they are to be plotted; none of them measured.
    pub(crate) fn systems(&self) -> Result<Vec<Named>, Failure> {
        self.with_data()?.into_iter().map(not_measured).collect()
    }

    /// All systems, as they are to be plotted, measured ones among them.
    pub(crate) fn with_data(&self) -> Result<Vec<Named>, Failure> {
        let all = self.opened()?.into_iter();
        if self.closed {
            return all.map(|named| closing::closed(named, self.positive)).collect();
        }
        if self.positive {
            return all.map(closing::negated).collect();
        }
        Ok(all.collect())
    }

    /// All systems before they are closed.
    ///
    /// # Errors
    /// As [`Systems::with_data`]; `usage` where it is said how many unstable poles what was measured has, and nothing was.
    pub(crate) fn opened(&self) -> Result<Vec<Named>, Failure> {
        let all = self.read()?;
        if self.unstable.is_some() && all.iter().all(|named| named.data.is_none()) {
            let message = "--unstable is of what was measured; of a formula the poles are known";
            return Err(Failure::usage("usage", message.to_owned()));
        }
        Ok(all)
    }

    /// All systems before they are closed, beside others of which one may be what was measured.
    pub(crate) fn beside<'a>(
        &self,
        mut others: impl Iterator<Item = &'a Named>,
    ) -> Result<Vec<Named>, Failure> {
        if others.any(|named| named.data.is_some()) { self.read() } else { self.opened() }
    }

    fn read(&self) -> Result<Vec<Named>, Failure> {
        let reader = self.how.reader()?;
        let all = self.formulas.iter().map(|text| text.trim()).zip(Colour::in_turn());
        all.map(|(text, colour)| Ok(Named { unstable: self.unstable, ..reader.read(text, colour)? }))
            .collect()
    }

    /// Other formulas, read as these are, but sampled by Tustin's rule: controllers.
    pub(crate) fn controllers(&self, formulas: &[String]) -> Result<Vec<Named>, Failure> {
        let sampling = self.how.sampling.map(|(period_s, method)| match method {
            Discretization::Tustin(_) => (period_s, method),
            _ => (period_s, Discretization::Tustin(None)),
        });
        let how = Reading { sampling, ..self.how.clone() };
        let reader = how.reader()?;
        formulas.iter().map(|text| reader.read(text.trim(), Colour::Black)).collect()
    }
}

impl OneSystem {
    /// Its states, of any number of inputs and outputs: of a file, of a product of files, or of a formula.
    pub(crate) fn states(&self) -> Result<States, Failure> {
        let reader = self.how.reader()?;
        let text = self.formula.trim();
        let failed = |e: LinearError| no_such_system(text, &e);
        let Some(product) = reader.plants.product(text) else {
            let named = not_measured(reader.read(text, Colour::Black)?)?;
            let system = named.system.state_space().map_err(failed)?;
            return Ok(States { note: named.approximated(), name: named.name, system });
        };
        let (system, name) = (product.map_err(failed)?, text.to_owned());
        Ok(match self.how.sampling {
            None => States { name, system, note: String::new() },
            Some((period_s, method)) => States {
                name: sampled_name(name, period_s, method),
                system: system.sampled(period_s, method).map_err(failed)?,
                note: String::new(),
            },
        })
    }

    /// Other systems, read as it is.
    pub(crate) fn others(&self, formulas: &[String]) -> Result<Vec<Named>, Failure> {
        let reader = self.how.reader()?;
        formulas.iter().map(|text| not_measured(reader.read(text.trim(), Colour::Grey)?)).collect()
    }

    /// Its name and what it is.
    pub(crate) fn system(&self) -> Result<Named, Failure> {
        not_measured(self.how.reader()?.read(self.formula.trim(), Colour::Black)?)
    }
}

/// A system of any number of inputs and outputs.
pub(crate) struct States {
    /// As typed, and what was made of it.
    pub(crate) name: String,
    /// What it is; with a dead time nearly that.
    pub(crate) system: StateSpace,
    /// What that is worth, a line; nothing where it is exact.
    pub(crate) note: String,
}

fn sampled_name(name: String, period_s: f64, method: Discretization) -> String {
    name + &format!(", sampled every {} ms by {}", four(1e3 * period_s), words(method))
}

/// Refuses what was measured: it has no poles and no equations.
pub(crate) fn not_measured(named: Named) -> Result<Named, Failure> {
    if named.data.is_none() {
        return Ok(named);
    }
    let message = format!(
        "{} was measured, and has no poles and no equations; lab bode, nyquist and nichols take it",
        named.name
    );
    Err(Failure::failed("no-such-system", message))
}

pub(crate) fn no_such_system(text: &str, error: &LinearError) -> Failure {
    Failure::failed("no-such-system", format!("{text}: {error}"))
}

/// A controller in continuous time: a formula, in which K11, K22, K11t and K22t are the report's.
pub(crate) fn controller(text: &str) -> Result<Zpk, Failure> {
    let read = parsed(text, Time::Continuous, &the_reports)?;
    match read.delay_s() {
        0.0 => Ok(read.rational().zpk()),
        delay_s => {
            let message = format!(
                "{text}: a controller has no dead time of {delay_s} s; approximate it by pade({delay_s}, 2)"
            );
            Err(Failure::usage("bad-formula", message))
        }
    }
}

/// A formula read; what is wrong with it is pointed at.
fn parsed(text: &str, time: Time, named: &Names<'_>) -> Result<Delayed, Failure> {
    let pointed = |e: FormulaError| {
        let names = names_instead(text, e.at, named);
        format!("{e}{names}\n  {text}\n  {}^", " ".repeat(e.at))
    };
    Delayed::parse_with(text, time, named).map_err(|e| Failure::usage("bad-formula", pointed(e)))
}

/// Which names there are, where a name stands that is none of them.
fn names_instead(text: &str, at: usize, named: &Names<'_>) -> String {
    const NAMES: [&str; 6] = ["G11", "G22", "K11", "K22", "K11t", "K22t"];
    let word: String = text.chars().skip(at).take_while(|c| c.is_alphanumeric()).collect();
    if word.chars().count() < 2 || word.starts_with(|c: char| c.is_ascii_digit()) || named(&word).is_some() {
        return String::new();
    }
    let known: Vec<_> = NAMES.into_iter().filter(|name| named(name).is_some()).collect();
    format!("; the names are {}", known.join(", "))
}

/// The report's compensators by name.
fn the_reports(name: &str) -> Option<Delayed> {
    let system = match name {
        "K11" => compensator(Joint::Pan, false),
        "K22" => compensator(Joint::Tilt, false),
        "K11t" => compensator(Joint::Pan, true),
        "K22t" => compensator(Joint::Tilt, true),
        _ => None,
    };
    system.map(Delayed::from)
}

/// What formulas are read with.
struct Reader<'a> {
    how: &'a Reading,
    head: Linearization,
    plants: Plants,
}

impl Reading {
    fn reader(&self) -> Result<Reader<'_>, Failure> {
        Ok(Reader { how: self, head: self.head.head().linearize()?, plants: Plants::read(&self.files)? })
    }
}

impl Reader<'_> {
    /// The system that a formula names; for what was measured stands a number.
    fn named(&self, name: &str, measured: f64) -> Option<Delayed> {
        let keep = self.how.head.keep_cancellations;
        let own = |joint: Joint| match keep {
            true => self.head.transfer(joint).ok(),
            false => self.head.own_transfer(joint).ok().map(|own| own.0),
        };
        match name {
            "G11" => own(Joint::Pan).map(Delayed::from),
            "G22" => own(Joint::Tilt).map(Delayed::from),
            _ => the_reports(name).or_else(|| self.plants.named(name, measured)),
        }
    }

    /// What a formula or a file is, and what was made of it.
    fn read(&self, text: &str, colour: Colour) -> Result<Named, Failure> {
        let time = self.how.period_s.map_or(Time::Continuous, Time::Sampled);
        let read = match self.plants.whole(text)? {
            Some(Whole::System(system)) => system.into(),
            Some(Whole::Data(data)) => return self.measured(text, data, colour),
            None => {
                self.plants.refuse_several(text)?;
                let read = parsed(text, time, &|name| self.named(name, 1.0))?;
                if let Some(data) = self.plants.data_in(text) {
                    let twice = parsed(text, time, &|name| self.named(name, 2.0))?;
                    return self.measured(text, product(text, &read, &twice, data)?, colour);
                }
                read
            }
        };
        let name = text.to_owned();
        if let Some((period_s, method)) = self.how.sampling {
            let system = read.sampled(period_s, method).map_err(|e| no_such_system(text, &e))?;
            return Ok(Named::rational(sampled_name(name, period_s, method), system, colour));
        }
        if read.delay_s() == 0.0 {
            return Ok(Named::rational(name, read.rational().clone(), colour));
        }
        closing::late(name, read, self.how.pade, colour)
    }

    fn measured(&self, text: &str, data: FrequencyData, colour: Colour) -> Result<Named, Failure> {
        match self.how.sampling {
            None => Ok(Named::measured(text.to_owned(), data, colour)),
            Some(_) => {
                let message = format!("{text} was measured: it cannot be sampled; leave --sample out");
                Err(Failure::usage("usage", message))
            }
        }
    }
}

/// Measured data times a formula, which was read with 1 and with 2 in their place.
fn product(
    text: &str,
    once: &Delayed,
    twice: &Delayed,
    data: &FrequencyData,
) -> Result<FrequencyData, Failure> {
    let is_factor = twice.rational() == &once.rational().scaled(2.0) && twice.delay_s() == once.delay_s();
    if !is_factor {
        let message = format!("{text}: what was measured may stand in a product, once");
        return Err(Failure::usage("bad-formula", message));
    }
    data.times(|rad_s| once.at_frequency(rad_s)).map_err(|e| no_such_system(text, &e))
}

/// Refuses what would take more memory than a plot is worth: so many numbers in all.
pub(crate) fn bounded(points: u32, others: usize) -> Result<(), Failure> {
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

/// A pole or zero and its mirror, for people.
pub(crate) fn place(root: Complex) -> String {
    match (root.re, root.im) {
        (re, 0.0) => four(re),
        (0.0, im) => format!("±{}j", four(im.abs())),
        (re, im) => format!("{} ± {}j", four(re), four(im.abs())),
    }
}

/// Poles for people: a line each, with natural frequency and damping; how often one is a pole, and how well it is known where fewer
/// digits are than are shown.
pub(crate) fn pole_lines(poles: &[DistinctRoot], time: Time) -> String {
    /// Share of a pole's size that four digits cannot show.
    const SHOWN: f64 = 5e-4;
    let mut text = format!("    {:28} {:>16} {:>10}\n", "pole", "natural, rad/s", "damping");
    for DistinctRoot { value, radius, count } in poles.iter().filter(|pole| pole.value.im >= 0.0) {
        let Mode { natural_rad_s, damping, .. } = Mode::of(*value, time);
        let damping = match natural_rad_s {
            0.0 => "–".to_owned(),
            // without the sign that a zero may have
            _ => format!("{:.4}", damping + 0.0).replace('-', "−"),
        };
        let times = if *count > 1 { format!("  {count} times") } else { String::new() };
        let size = complex::norm(*value);
        let within = match size > 0.0 && *radius > SHOWN * size {
            true if *count > 1 => format!(", all within {}", four(*radius)),
            true => format!("  within {}", four(*radius)),
            false => String::new(),
        };
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "    {:28} {:>16} {damping:>10}{times}{within}",
            place(*value),
            four(natural_rad_s)
        );
    }
    text
}
