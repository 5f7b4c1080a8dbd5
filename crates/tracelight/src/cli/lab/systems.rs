use clap::{Args, ValueEnum};
use tracelight_linear::{Complex, Discretization, Time, TransferFunction, Zpk};
use tracelight_rig::Joint;
use tracelight_sim::Compensator;

use super::head::HeadArgs;
use crate::chart::{Colour, Theme};
use crate::failure::Failure;
use crate::units::{TIMES, parse};

/// Systems to plot.
#[derive(Args, Debug)]
pub(crate) struct SystemArgs {
    /// Systems, each a formula: numbers, s, + − * / ^, brackets; what stands side by side is multiplied. G11 and G22 are the head
    /// linearized (see `tracelight lab linearize`), K11 and K22 the 2006 report's compensators as typeset, K11t and K22t the same read
    /// as time constants
    #[arg(value_name = "SYSTEM", required = true)]
    systems: Vec<String>,
    #[command(flatten)]
    head: HeadArgs,
    /// The systems are of samples so far apart, their variable is z
    #[arg(long, value_name = "TIME", value_parser = period, conflicts_with = "sample")]
    period: Option<f64>,
    /// Sample the systems first, so often
    #[arg(long, value_name = "TIME", value_parser = period)]
    sample: Option<f64>,
    /// How they are sampled
    #[arg(long, value_enum, default_value = "hold", requires = "sample")]
    method: Method,
    /// Close each by negative feedback of its output first
    #[arg(long)]
    closed: bool,
    /// Light lines on dark ground
    #[arg(long)]
    dark: bool,
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
}

fn period(text: &str) -> Result<f64, String> {
    let period_s = parse(text, TIMES).map_err(|e| e.to_string())?;
    if period_s > 0.0 { Ok(period_s) } else { Err(format!("{text} is no time between samples")) }
}

/// A system and what it is called.
pub(super) struct Named {
    /// As typed.
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
        const COLOURS: [Colour; 6] =
            [Colour::Blue, Colour::Vermilion, Colour::Green, Colour::Purple, Colour::Orange, Colour::Sky];
        let linear = self.head.head()?.linearize()?;
        let keep = self.head.keep_cancellations;
        let known = |name: &str| match name {
            "G11" | "G22" => {
                let joint = if name == "G11" { Joint::Pan } else { Joint::Tilt };
                let own =
                    if keep { linear.transfer(joint) } else { linear.own_transfer(joint).map(|own| own.0) };
                own.ok()
            }
            "K11" => compensator(Joint::Pan, false),
            "K22" => compensator(Joint::Tilt, false),
            "K11t" => compensator(Joint::Pan, true),
            "K22t" => compensator(Joint::Tilt, true),
            _ => None,
        };
        let time = self.period.map_or(Time::Continuous, Time::Sampled);
        let colours = COLOURS.into_iter().cycle();
        self.systems
            .iter()
            .zip(colours)
            .map(|(name, colour)| self.system(name, colour, time, &known))
            .collect()
    }

    fn system(
        &self,
        name: &str,
        colour: Colour,
        time: Time,
        known: &tracelight_linear::Names<'_>,
    ) -> Result<Named, Failure> {
        let mut system = TransferFunction::parse_with(name, time, known)
            .map_err(|e| Failure::usage("bad-formula", format!("{e}\n  {name}\n  {}^", " ".repeat(e.at))))?;
        let failed = |e| Failure::failed("no-such-system", format!("{name}: {e}"));
        if let Some(period_s) = self.sample {
            system = system.sampled(period_s, self.method.discretization()).map_err(failed)?;
        }
        if self.closed {
            system = system.closed().map_err(failed)?;
        }
        Ok(Named { name: name.to_owned(), system, colour })
    }
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
    if value.is_infinite() {
        return "∞".to_owned();
    }
    let exponent = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    let text = if (-5..7).contains(&exponent) {
        format!("{value:.*}", (3 - exponent).max(0) as usize)
    } else {
        format!("{value:.3e}")
    };
    let (mantissa, power) =
        text.split_once('e').map_or((&text[..], String::new()), |(m, p)| (m, format!("e{p}")));
    let mantissa =
        if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{mantissa}{power}").replace('-', "−")
}

/// A complex number for scripts.
pub(super) fn pairs(values: &[Complex]) -> Vec<[f64; 2]> {
    values.iter().map(|z| [z.re, z.im]).collect()
}
