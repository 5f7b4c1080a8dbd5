use clap::Args;
use tracelight_experiment::locus::{self, Marked};
use tracelight_experiment::plane::Plane;
use tracelight_experiment::pzmap;
use tracelight_task::{Failure, Stop};

use super::bounds::reach;
use super::command::{self, LabCommand, OutFile, out_file};
use super::systems::SystemArgs;
use crate::cli::answer::{Answer, Voice};

/// Where the poles of the closed loop go as the open loop's gain rises; which gain makes it as damped as asked
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab locus \"K11 G11\" --damping 0.7 -o locus.svg\n\n\
                  Crosses are the open loop's poles, rings its zeros, dots the closed loop's poles with the gain as it is, or with \
                  --gain, or with the one --damping finds. Arrows point to higher gains; k is the gain where branches meet and where they \
                  become stable or unstable.")]
pub(crate) struct LocusArgs {
    #[command(flatten)]
    plane: PlaneArgs,
    /// Factor on the open loop whose closed poles are marked
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true, conflicts_with = "damping", value_parser = finite)]
    gain: Option<f64>,
    /// Find the largest factor that leaves every closed pole at least so damped, 0 to 1; if there is none, plots and tables are made
    /// without it
    #[arg(long, value_name = "DAMPING", value_parser = damping)]
    damping: Option<f64>,
    /// How many gains at least
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    points: u32,
}

/// Poles and zeros in the complex plane, natural frequency and damping of each
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab pzmap \"K11 G11\" --closed -o poles.svg")]
pub(crate) struct PzmapArgs {
    #[command(flatten)]
    plane: PlaneArgs,
}

/// Systems in the complex plane, and where that goes.
#[derive(Args, Debug)]
pub(super) struct PlaneArgs {
    #[command(flatten)]
    systems: SystemArgs,
    /// Show so far from zero, in 1/s (of samples: of z) [default: all poles and zeros, and the unit circle; a locus without poles far
    /// from all others]
    #[arg(long, value_name = "REACH", value_parser = reach)]
    reach: Option<f64>,
    /// Plot into an SVG or PNG, or write a row a gain (the first system), or a pole or zero, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("{text} is no factor")),
    }
}

fn damping(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1.0).contains(&value) => Ok(value),
        _ => Err(format!("{text} is no damping between 0 and 1")),
    }
}

impl PlaneArgs {
    fn plane(&self) -> Result<Plane, Failure> {
        Ok(Plane { systems: self.systems.systems()?, reach: self.reach })
    }
}

impl LabCommand for LocusArgs {
    fn voice(&self) -> Voice {
        self.plane.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let marked = match (self.gain, self.damping) {
            (Some(gain), _) => Marked::Gain(gain),
            (None, Some(least)) => Marked::Damping(least),
            (None, None) => Marked::Gain(1.0),
        };
        // a plot is of use without the gain too
        let must_have_gain = self.plane.out.is_empty();
        let request =
            locus::Request { plane: self.plane.plane()?, marked, points: self.points, must_have_gain };
        command::plotted(request, &self.plane.out, self.plane.voice, stop)
    }
}

impl LabCommand for PzmapArgs {
    fn voice(&self) -> Voice {
        self.plane.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        command::plotted(pzmap::Request(self.plane.plane()?), &self.plane.out, self.plane.voice, stop)
    }
}
