use std::str::FromStr;

use clap::{Args, ValueEnum};
use tracelight_dynamics::HeadBodies;
use tracelight_lab::{Linearization, Operation};
use tracelight_rig::PanTilt;
use tracelight_task::Failure;
use tracelight_units::{Angle, AngularSpeed};

use crate::named;

/// Which head is linearized, and where.
#[derive(Args, Debug)]
pub(crate) struct HeadArgs {
    /// Masses: the 2006 report's parameter set, with its viscous friction of 0.01 N m s/rad and g = 9.8 m/s² [default: A]
    #[arg(long, value_name = "A|B", value_enum, ignore_case = true, conflicts_with = "rig")]
    set: Option<Set>,
    /// Masses, viscous friction (the mean of both directions) and gravity of what is believed of a rig: a preset's name or a rig
    /// file, instead of a set
    #[arg(long, value_name = "RIG.toml|PRESET")]
    pub(super) rig: Option<String>,
    /// Where it stands [default: 26.565deg,26.565deg, half the report's range of motion]
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true)]
    at: Option<Pair<Angle>>,
    /// How fast it turns, steadily [default: at rest]
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true)]
    rates: Option<Pair<AngularSpeed>>,
    /// Keep poles that a zero takes back but for a ten thousandth
    #[arg(long)]
    pub(super) keep_cancellations: bool,
}

/// One of the report's parameter sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Set {
    /// The model file's
    #[value(name = "A")]
    A,
    /// The simulation's start file's
    #[value(name = "B")]
    B,
}

impl Set {
    /// What it says of the bodies.
    pub(super) const fn bodies(self) -> HeadBodies {
        match self {
            Self::A => HeadBodies::set_a(),
            Self::B => HeadBodies::set_b(),
        }
    }
}

/// One value for pan, one for tilt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair<T>(T, T);

impl<T: FromStr<Err: std::fmt::Display>> FromStr for Pair<T> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((pan, tilt)) = text.split_once(',') else {
            return Err(format!(
                "{text} is no pair; write pan's and tilt's with a comma between, such as 10deg,-5deg"
            ));
        };
        let read = |text: &str| text.parse::<T>().map_err(|e| e.to_string());
        Ok(Self(read(pan)?, read(tilt)?))
    }
}

/// What is linearized, in words and in numbers.
pub(super) struct Head {
    /// What it is.
    pub(super) name: String,
    /// Where pan stands, rad.
    pub(super) pan_rad: f64,
    pub(super) operation: Operation,
}

impl HeadArgs {
    pub(super) fn head(&self) -> Result<Head, Failure> {
        /// atan 1/2: 18 in beside what is 36 in away.
        const HALF_RANGE_RAD: f64 = 0.463_647_609_000_806_1;
        let (name, bodies, viscous) = match &self.rig {
            Some(rig) => {
                let rig = named::rig(rig)?;
                let viscous = rig.model.friction.map(|f| 0.5 * (f.viscous_pos + f.viscous_neg));
                (format!("rig {}", rig.name), rig.model.bodies, viscous)
            }
            None => {
                let (name, bodies) = match self.set {
                    None | Some(Set::A) => ("parameter set A", Set::A.bodies()),
                    Some(Set::B) => ("parameter set B", Set::B.bodies()),
                };
                // what the report's own helper had
                (name.to_owned(), HeadBodies { gravity_m_s2: 9.8, ..bodies }, PanTilt::new(0.01, 0.01))
            }
        };
        let at = self.at.unwrap_or(Pair(Angle(HALF_RANGE_RAD), Angle(HALF_RANGE_RAD)));
        let rates = self.rates.unwrap_or(Pair(AngularSpeed(0.0), AngularSpeed(0.0)));
        let operation = Operation {
            head: bodies.lumped(),
            viscous,
            tilt_rad: at.1.0,
            rate_rad_s: PanTilt::new(rates.0.0, rates.1.0),
        };
        let gravity = bodies.gravity_m_s2;
        let name =
            format!("{name}, viscous {} and {} N m s/rad, g = {gravity} m/s²", viscous.pan, viscous.tilt);
        Ok(Head { name, pan_rad: at.0.0, operation })
    }
}

impl Head {
    pub(super) fn linearize(&self) -> Result<Linearization, Failure> {
        self.operation
            .linearize()
            .map_err(|e| Failure::failed("no-linear-model", format!("{}: {e}", self.name)))
    }

    /// Where it is and how it moves.
    pub(super) fn place(&self) -> String {
        let rates = &self.operation.rate_rad_s;
        let moving = match (rates.pan, rates.tilt) {
            (0.0, 0.0) => "at rest".to_owned(),
            (pan, tilt) => format!("turning with {pan} and {tilt} rad/s"),
        };
        let (pan, tilt) = (self.pan_rad.to_degrees(), self.operation.tilt_rad.to_degrees());
        format!("pan {pan:.3}°, tilt {tilt:.3}°, {moving}")
    }
}
