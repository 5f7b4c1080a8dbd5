use clap::Args;
use tracelight_experiment::profile::Request;
use tracelight_experiment::profile_name::ProfileName;
use tracelight_task::{Failure, Stop};
use tracelight_trajectory::{MoveLimits, Ramps};
use tracelight_units::{
    ANGLES, ANGULAR_ACCELERATIONS, ANGULAR_SPEEDS, Angle, AngularAcceleration, AngularSpeed,
};

use super::bounds::within;
use super::command::{self, LabCommand, OutFile, out_file};
use crate::cli::answer::{Answer, Voice};
use tracelight_flags::{profile, ramps};

/// Move one joint from rest to rest, motors left out: durations and peaks of every profile, and plots
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight lab profile --distance 180deg --profile trapezoid,s-curve -o profiles.svg\n\n\
                  The defaults are the 2006 report's: half a turn at 24 rad/s and 100 rad/s², with its S-curve."
)]
pub(crate) struct ProfileArgs {
    /// How far
    #[arg(long, value_name = "ANGLE", default_value = "180deg", allow_hyphen_values = true, value_parser = distance)]
    distance: Angle,
    /// Highest speed
    #[arg(long, value_name = "SPEED", default_value = "24rad/s", allow_hyphen_values = true, value_parser = speed)]
    vmax: AngularSpeed,
    // an angle's alone: `lab move` takes the spot's too, and a drawing's `--amax` is a wish that may be missing
    /// Highest acceleration
    #[arg(long, value_name = "ACCELERATION", default_value = "100rad/s2", allow_hyphen_values = true, value_parser = acceleration)]
    amax: AngularAcceleration,
    /// Highest deceleration [default: as --amax]
    #[arg(long, value_name = "ACCELERATION", allow_hyphen_values = true, value_parser = acceleration)]
    dmax: Option<AngularAcceleration>,
    /// The S-curve's ramps: shares of the acceleration phase over which acceleration builds up and fades, then the same of
    /// the deceleration phase
    #[arg(long, value_name = "PA1,PA2,PB1,PB2", default_value = "0.2,0.2,0.15,0.15", allow_hyphen_values = true, value_parser = ramps)]
    ramps: Ramps,
    /// Which to plot, the first of them in the CSV and first in --json
    #[arg(long, value_delimiter = ',', default_value = "trapezoid,s-curve", value_parser = profile())]
    profile: Vec<ProfileName>,
    /// Plot angle, speed and acceleration into an SVG or PNG, or write them, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

fn distance(text: &str) -> Result<Angle, String> {
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    within(text, angle, angle.0, ANGLES)
}

fn speed(text: &str) -> Result<AngularSpeed, String> {
    let speed: AngularSpeed = text.parse().map_err(|e| format!("{e}"))?;
    within(text, speed, speed.0, ANGULAR_SPEEDS)
}

fn acceleration(text: &str) -> Result<AngularAcceleration, String> {
    let acceleration: AngularAcceleration = text.parse().map_err(|e| format!("{e}"))?;
    within(text, acceleration, acceleration.0, ANGULAR_ACCELERATIONS)
}

impl LabCommand for ProfileArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let limits = MoveLimits {
            speed: self.vmax.0,
            acceleration: self.amax.0,
            deceleration: self.dmax.unwrap_or(self.amax).0,
        };
        let request = Request {
            distance_rad: self.distance.0,
            limits,
            ramps: self.ramps,
            profiles: self.profile.clone(),
        };
        command::plotted(request, &self.out, self.voice, stop)
    }
}
