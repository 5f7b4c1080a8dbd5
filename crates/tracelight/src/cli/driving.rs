use clap::{Args, ValueEnum};
use tracelight_aim::HeadPose;
use tracelight_experiment::profile_name::ProfileName;
use tracelight_pipeline::{Asked, DEFAULT_DISTANCE_M, DEFAULT_SPEED_M_S, DistanceFrom, Driving, request_of};
use tracelight_port::At;
use tracelight_rigfile::head::KnownHead;
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Task};
use tracelight_trajectory::{LitSpeed, PlanRequest};
use tracelight_units::{AngularAcceleration, Length, Speed};

use crate::named;
use tracelight_flags::positive_length;
use tracelight_flags::profile;

/// With what and how a drawing is run.
#[derive(Args, Clone, Debug)]
pub(crate) struct DrivingArgs {
    /// Distance from the head to the target [default: as the head file says, else 3ft is assumed, and said]
    #[arg(help_heading = "Size and place", long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length)]
    pub(crate) distance: Option<Length>,
    /// Speed of the lit spot on the target [default: 1ft/s]
    #[arg(help_heading = "Time and order", long, value_name = "SPEED", allow_hyphen_values = true, value_parser = positive_speed)]
    pub(crate) speed: Option<Speed>,
    /// How the lit spot keeps this speed
    #[arg(help_heading = "Time and order", long, value_enum, default_value_t = LitSpeedName::Fastest)]
    pub(crate) lit_speed: LitSpeedName,
    /// Largest rounding of corners, such as 0.2mm; used where it is faster than a stop [default: none]
    #[arg(help_heading = "Time and order", long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = rounding)]
    pub(crate) corner: Option<Length>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file; emulated or emulated:RIG drives it by a board behind a wire. PORT or PORT:RIG, such as
    /// /dev/ttyACM0:my-head.toml, is the head at a board's port, for the commands that drive one; grbl:/dev/ttyUSB0:my-head.toml or grbl:tcp:HOST:my-head.toml one
    /// on a Grbl board
    #[arg(help_heading = "Rig and law", long, value_name = "RIG.toml|PRESET|PORT", default_value = "report")]
    pub(crate) rig: String,
    /// Shape of the dark moves between strokes
    #[arg(help_heading = "Time and order", long, default_value = ProfileName::SCurve.name(), value_parser = profile())]
    pub(crate) profile: ProfileName,
    /// Upper limit for the joint acceleration, such as 100rad/s2; lower where the motors cannot reach it
    #[arg(help_heading = "Time and order", long, value_name = "ACCELERATION", allow_hyphen_values = true, value_parser = positive_acceleration)]
    pub(crate) amax: Option<AngularAcceleration>,
}

/// What becomes of the speed at corners, stroke ends and tight curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LitSpeedName {
    /// At each corner and stroke end, the quicker of stopping there or passing with a dark run-up
    Fastest,
    /// One constant speed on all lit lines, limited by the tightest curve; corners get dark loops
    Exact,
    /// Stop at every corner and stroke end
    Stops,
}

impl LitSpeedName {
    const fn lit_speed(self) -> LitSpeed {
        match self {
            LitSpeedName::Fastest => LitSpeed::Fastest,
            LitSpeedName::Exact => LitSpeed::Exact,
            LitSpeedName::Stops => LitSpeed::Stops,
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            LitSpeedName::Fastest => "fastest",
            LitSpeedName::Exact => "exact",
            LitSpeedName::Stops => "stops",
        }
    }
}

impl DrivingArgs {
    /// Reads the rig and gathers the rest.
    pub(crate) fn resolve(&self) -> Result<Driving, Failure> {
        Ok(self.resolve_on(named::rig(&self.rig)?))
    }

    /// Likewise of a rig that may be at a port, and that: within what its board allows.
    pub(crate) fn resolve_head(&self, task: Task<'_>) -> Result<(Driving, Option<At>), Failure> {
        let (rig, at) = named::rig_or_port(&self.rig)?;
        let Some(at) = at else { return Ok((self.resolve_on(rig), None)) };
        let (rig, notes) = at.fitted(self.limited(rig), task.stop)?;
        notes.iter().for_each(|note| task.say(&format!("note: {note}")));
        Ok((self.resolve_limited(rig), Some(at)))
    }

    /// Gathers the rest for a rig that was read: a plan is made for its masses.
    pub(crate) fn resolve_on(&self, rig: RigConfig) -> Driving {
        self.resolve_limited(self.limited(rig))
    }

    fn limited(&self, mut rig: RigConfig) -> RigConfig {
        if let Some(wish) = self.amax {
            rig.motion.acceleration_limit_rad_s2 = rig.motion.acceleration_limit_rad_s2.map(|_| wish.0);
        }
        rig
    }

    fn resolve_limited(&self, rig: RigConfig) -> Driving {
        let pose = HeadPose::square_on(self.distance.map_or(DEFAULT_DISTANCE_M, |d| d.0));
        let request = PlanRequest {
            speed_m_s: self.speed.map_or(DEFAULT_SPEED_M_S, |s| s.0),
            lit_speed: self.lit_speed.lit_speed(),
            travel: self.profile.dark_move(),
            corner_m: self.corner.map_or(0.0, |c| c.0),
            ..request_of(&rig)
        };
        let distance = if self.distance.is_some() { DistanceFrom::Asked } else { DistanceFrom::Assumed };
        let asked = Asked { speed: self.speed.is_some(), acceleration: self.amax.is_some(), distance };
        Driving::new(rig, pose, request, asked)
    }
}

/// Puts a rig up where a head file says that it stands; a simulated one is built and stands truly so.
pub(crate) fn stand_by(driving: &mut Driving, known: &KnownHead) {
    driving.rig.truth.model.geometry = known.geometry;
    driving.believe(known.geometry, known.pose);
    driving.asked.distance = DistanceFrom::File;
    driving.head_date = Some(known.date.clone());
}

pub(crate) fn positive_speed(text: &str) -> Result<Speed, String> {
    const MOST_M_S: f64 = 1000.0;
    let speed: Speed = text.parse().map_err(|e| format!("{e}"))?;
    if 0.0 < speed.0 && speed.0 <= MOST_M_S {
        Ok(speed)
    } else {
        Err(format!("{text} is not between 0 and {MOST_M_S} m/s; give a speed such as 1ft/s or 0.3m/s"))
    }
}

fn rounding(text: &str) -> Result<Length, String> {
    const MOST_M: f64 = 0.01;
    let length: Length = text.parse().map_err(|e| format!("{e}"))?;
    if 0.0 <= length.0 && length.0 <= MOST_M {
        Ok(length)
    } else {
        Err(format!("{text} is not between 0 and {} mm; give a length such as 0.2mm", 1e3 * MOST_M))
    }
}

fn positive_acceleration(text: &str) -> Result<AngularAcceleration, String> {
    const MOST_RAD_S2: f64 = 1e6;
    let wish: AngularAcceleration = text.parse().map_err(|e| format!("{e}"))?;
    if 0.0 < wish.0 && wish.0 <= MOST_RAD_S2 {
        Ok(wish)
    } else {
        Err(format!("{text} is not between 0 and {MOST_RAD_S2} rad/s2; give one such as 100rad/s2"))
    }
}
