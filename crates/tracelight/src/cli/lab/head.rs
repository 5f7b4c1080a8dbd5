use std::str::FromStr;

use clap::{Args, ValueEnum};
use tracelight_experiment::head::{self, HeadChoice, Masses};
use tracelight_rig::PanTilt;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;
use tracelight_units::{Angle, AngularSpeed};

use crate::named;

/// Which head is linearized, and where.
#[derive(Args, Debug)]
pub(crate) struct HeadArgs {
    /// Masses and rotor inertias of one of the 2006 report's two parameter sets, linearized as the report does: with its viscous friction
    /// of 0.01 N m s/rad and g = 9.8 m/s² [default: A]
    #[arg(long, value_name = "A|B", value_enum, ignore_case = true, conflicts_with = "rig")]
    set: Option<Set>,
    /// Masses, viscous friction (mean of both directions) and gravity from the [model] of this rig, a preset's name or a rig file,
    /// instead of a set
    #[arg(long, value_name = "RIG.toml|PRESET")]
    rig: Option<String>,
    /// Joint angles at which it is linearized [default: 26.565deg,26.565deg, half the report's range of motion]
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true)]
    at: Option<Pair<Angle>>,
    /// Joint rates at which it is linearized [default: at rest]
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true)]
    rates: Option<Pair<AngularSpeed>>,
    /// Keep pole-zero pairs that cancel within 1e-4 of their size
    #[arg(long)]
    keep_cancellations: bool,
}

/// One of the report's parameter sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Set {
    /// From the report's model file
    #[value(name = "A")]
    A,
    /// From its simulation start-up file
    #[value(name = "B")]
    B,
}

impl Set {
    pub(super) const fn set(self) -> head::Set {
        match self {
            Self::A => head::Set::A,
            Self::B => head::Set::B,
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

impl<T> Pair<T> {
    /// In SI, by what its unit is worth.
    fn si(self, value: impl Fn(T) -> f64) -> PanTilt<f64> {
        PanTilt::new(value(self.0), value(self.1))
    }
}

impl HeadArgs {
    /// Returns the rig of `--rig`, or the preset `report` with the masses of `--set`.
    ///
    /// # Errors
    /// A rig file that is missing or wrong.
    pub(super) fn tried_rig(&self) -> Result<RigConfig, Failure> {
        match &self.rig {
            Some(rig) => named::rig(rig),
            None => Ok(self.set.map_or(RigConfig::report(), |set| set.set().on(RigConfig::report()))),
        }
    }

    pub(super) fn choice(&self) -> Result<HeadChoice, Failure> {
        let masses = match &self.rig {
            Some(rig) => Masses::Rig(Box::new(named::rig(rig)?)),
            None => Masses::Set(self.set.map_or(head::Set::A, Set::set)),
        };
        Ok(HeadChoice {
            masses,
            at_rad: self.at.map(|at| at.si(|angle| angle.0)),
            rates_rad_s: self.rates.map_or(PanTilt::default(), |rates| rates.si(|rate| rate.0)),
            keep_cancellations: self.keep_cancellations,
        })
    }
}
