use clap::Args;
use tracelight_experiment::Improved;
use tracelight_experiment::relay::Request;
use tracelight_rig::Joint;
use tracelight_sim::{Mounting, ObserverName};
use tracelight_task::{Failure, Stop};
use tracelight_units::Angle;

use super::bounds::{frequency, voltage};
use super::command::{self, LabCommand, OutFile, out_file};
use super::rig::RigArgs;
use super::rig_out;
use super::step::{Axis, step};
use crate::cli::answer::{Answer, Voice};
use crate::named;
use tracelight_flags::observer;

/// Let a relay swing a joint, and tune a PID from how it swings: no model needed
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab relay --axis tilt -o tilt.svg\n\
                  Example: tracelight lab relay --axis pan --rig examples/rig.toml\n\n\
                  In place of a controller a relay: so many volts one way until the joint is a little beyond its middle, then as many the other way. \
                  Amplitude and period of the swing are a point of the joint's frequency response; the PID takes that point to the phase margin, \
                  and crosses 1 there. Fewer volts swing slower, less hysteresis faster, and tune so; --crossover tunes faster than it swings. Friction damps a small \
                  swing, and the PID counts on that: the linearized head, which has none, overshoots more. Gravity is found out meanwhile. \
                  The gains are those of law hand-tuned: --save writes them and the law into a rig file, comments kept.")]
pub(crate) struct RelayArgs {
    /// Which joint
    #[arg(long, value_enum, default_value = "pan")]
    axis: Axis,
    #[command(flatten)]
    rig: RigArgs,
    /// The relay, either way
    #[arg(long, value_name = "VOLTAGE", default_value = "4V", value_parser = voltage)]
    level: f64,
    /// How far beyond its middle the joint turns the relay over [default: one and a half counts]
    #[arg(long, value_name = "ANGLE", value_parser = step)]
    hysteresis: Option<Angle>,
    /// The joint is in a fixture, its axis upright: nothing pulls
    #[arg(long)]
    fixture: bool,
    /// Where the tuned loop's gain is 1 [default: where the joint swings]; elsewhere the joint is taken for the mass that swings so
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    crossover: Option<f64>,
    /// Phase margin of the tuned loop
    #[arg(long, value_name = "ANGLE", default_value = "55deg", value_parser = margin)]
    phase_margin: Angle,
    /// How many times as slowly as the derivative the integral acts
    #[arg(long, value_name = "FACTOR", default_value_t = 10.0, value_parser = factor)]
    integral: f64,
    /// How counts become position and speed in the tuned loop [default: as the law is meant]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    observer: Option<ObserverName>,
    /// How far the tuned joint is sent to try it
    #[arg(long, value_name = "ANGLE", default_value = "5deg", allow_hyphen_values = true, value_parser = step)]
    to: Angle,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot swing and step into an SVG or PNG, or write the swing, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    /// Write the gains and law hand-tuned into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    voice: Voice,
}

fn margin(text: &str) -> Result<Angle, String> {
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    let degrees = angle.0.to_degrees();
    if (10.0..=85.0).contains(&degrees) {
        Ok(angle)
    } else {
        Err(format!("{text} is not between 10 and 85 degrees"))
    }
}

fn factor(text: &str) -> Result<f64, String> {
    super::by_hand::number("--integral", text, 2.0, 1e4)
}

impl LabCommand for RelayArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        self.rig.may_save(self.save)?;
        let finding = command::tried(self.request()?, self.voice, stop)?;
        self.out.iter().try_for_each(|file| file.write(&finding))?;
        if self.save {
            named::save_rig(self.rig.name(), finding.rig(), finding.better())?;
        }
        Ok(rig_out::answer(&finding, &self.saved(), self.voice))
    }
}

impl RelayArgs {
    fn request(&self) -> Result<Request, Failure> {
        Ok(Request {
            rig: self.rig.config()?,
            joint: self.axis.joint(),
            level_v: self.level,
            hysteresis_rad: self.hysteresis.map(|angle| angle.0),
            mounting: if self.fixture { Mounting::Fixture } else { Mounting::Standing },
            crossover_rad_s: self.crossover,
            phase_margin_rad: self.phase_margin.0,
            integral: self.integral,
            observer: self.observer,
            to_rad: self.to.0,
            seed: self.seed,
        })
    }

    /// What the rig file has now.
    fn saved(&self) -> String {
        if !self.save {
            return String::new();
        }
        let joint = self.axis.joint();
        let other = if joint == Joint::Pan { Joint::Tilt } else { Joint::Pan };
        format!(
            " {} has law hand-tuned now, for both joints, and {joint}'s gains; {other}'s are those of control.hand_tuned.{other}: tune them as well.",
            self.rig.name()
        )
    }
}
