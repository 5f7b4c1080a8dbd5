use clap::{Args, ValueEnum};
use tracelight_aim::{HeadGeometry, HeadPose};
use tracelight_sim::RigConfig;
use tracelight_task::Failure;
use tracelight_trajectory::{AccelerationDemand, LitSpeed, Machine, Plan, PlanRequest};
use tracelight_units::{AngularAcceleration, Length, Speed};

use crate::cli::placing::positive_length;
use crate::cli::shapes::ProfileName;
use crate::named;

/// 3 ft: where the original rig's camera stood.
pub(crate) const DEFAULT_DISTANCE_M: f64 = 0.9144;
/// 1 ft/s: what the original rig was to reach.
const DEFAULT_SPEED_M_S: f64 = 0.3048;

/// Where inertia and gravity are taken for remarks on what motors can do: the edge of the original rig's working
/// range, atan(18 in / 36 in).
const WORKING_TILT_RAD: f64 = 0.463_647_609_000_806_1;

/// With what and how a drawing is run.
#[derive(Args, Clone, Debug)]
pub(crate) struct DrivingArgs {
    /// From the head to the target [default: 3ft]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length)]
    pub(crate) distance: Option<Length>,
    /// Speed of the lit spot on the target [default: 1ft/s]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, value_parser = positive_speed)]
    pub(crate) speed: Option<Speed>,
    /// How the lit spot keeps to that speed
    #[arg(long, value_enum, default_value_t = LitSpeedName::Fastest)]
    pub(crate) lit_speed: LitSpeedName,
    /// How far corners may be rounded off where that is faster than to stop there, such as 0.2mm [default: not at all]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = rounding)]
    pub(crate) corner: Option<Length>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    pub(crate) rig: String,
    /// Shape of the dark moves between strokes
    #[arg(long, value_enum, default_value_t = ProfileName::SCurve)]
    pub(crate) profile: ProfileName,
    /// Highest joint acceleration wished for, such as 100rad/s2; the motors decide where they allow less
    #[arg(long, value_name = "ACCELERATION", allow_hyphen_values = true, value_parser = positive_acceleration)]
    pub(crate) amax: Option<AngularAcceleration>,
}

/// What becomes of the speed at corners, stroke ends and tight curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LitSpeedName {
    /// Whatever is quicker at each: to rest there, or past it, with a dark run-up
    Fastest,
    /// One speed for all that is lit, which the tightest curve permits; corners get dark loops
    Exact,
    /// To rest at every corner and stroke end
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

/// What the arguments mean: a rig, where it stands, what is asked of it.
#[derive(Clone)]
pub(crate) struct Driving {
    pub(crate) rig: RigConfig,
    pub(crate) pose: HeadPose,
    pub(crate) machine: Machine,
    pub(crate) request: PlanRequest,
    /// The speed was asked for, not assumed.
    pub(crate) speed_is_asked: bool,
    /// An acceleration was asked for, not taken from the rig.
    acceleration_is_asked: bool,
}

impl Driving {
    /// The head stands elsewhere than was told.
    pub(crate) fn stand(&mut self, pose: HeadPose) {
        self.pose = pose;
        self.machine = self.rig.machine(pose);
    }

    /// The head is built otherwise than was told, and stands elsewhere.
    pub(crate) fn believe(&mut self, geometry: HeadGeometry, pose: HeadPose) {
        self.rig.model.geometry = geometry;
        self.stand(pose);
    }

    /// What the user should know about a plan: wishes the motors do not fulfil, and a speed it never reaches.
    pub(crate) fn remarks(&self, plan: &Plan) -> Vec<String> {
        let wishes = self.machine.impossible_wishes(WORKING_TILT_RAD);
        let asked = wishes.iter().filter(|_| self.acceleration_is_asked);
        let mut remarks: Vec<String> = asked.map(wish_note).collect();
        if let Some(bend) = &plan.tightest {
            // all but straight: it is not the bend that holds it back
            let why = if bend.radius_m < 10.0 {
                format!("bends with a radius of {:.1} mm", 1e3 * bend.radius_m)
            } else {
                "asks most of the joints".to_string()
            };
            remarks.push(format!(
                "lit at {:.4} m/s throughout instead of {:.4}: stroke {} {why} at ({:.1}, {:.1}) mm, and the motors hold no \
                 more there",
                plan.set_speed_m_s,
                self.request.speed_m_s,
                bend.stroke + 1,
                1e3 * bend.point.x,
                1e3 * bend.point.y
            ));
        }
        let (set, top) = (plan.set_speed_m_s, plan.top_speed_m_s());
        if top < REACHED * set {
            remarks.push(format!(
                "{set:.3} m/s is reached nowhere: the lines are too short or too bent; the fastest is {top:.3} m/s"
            ));
        }
        remarks
    }
}

/// A speed counts as reached from this share of it on.
pub(crate) const REACHED: f64 = 0.98;

impl DrivingArgs {
    /// Reads the rig and gathers the rest.
    pub(crate) fn resolve(&self) -> Result<Driving, Failure> {
        let mut rig = named::rig(&self.rig)?;
        if let Some(wish) = self.amax {
            rig.motion.acceleration_limit_rad_s2 = rig.motion.acceleration_limit_rad_s2.map(|_| wish.0);
        }
        let pose = HeadPose::square_on(self.distance.map_or(DEFAULT_DISTANCE_M, |d| d.0));
        let machine = rig.machine(pose);
        let request = PlanRequest {
            speed_m_s: self.speed.map_or(DEFAULT_SPEED_M_S, |s| s.0),
            lit_speed: self.lit_speed.lit_speed(),
            travel: self.profile.dark_move(),
            corner_m: self.corner.map_or(0.0, |c| c.0),
            ..request_of(&rig)
        };
        Ok(Driving {
            rig,
            pose,
            machine,
            request,
            speed_is_asked: self.speed.is_some(),
            acceleration_is_asked: self.amax.is_some(),
        })
    }
}

/// What a rig's own settings ask of a plan; the rest as without any flag.
pub(crate) fn request_of(rig: &RigConfig) -> PlanRequest {
    PlanRequest {
        speed_m_s: DEFAULT_SPEED_M_S,
        lit_speed: LitSpeed::default(),
        travel: ProfileName::SCurve.dark_move(),
        ramp_s: rig.motion.ramp_s,
        settle_s: rig.motion.settle_s,
        tolerance_m: rig.control.tolerance_m,
        corner_m: 0.0,
    }
}

fn wish_note(wish: &AccelerationDemand) -> String {
    let AccelerationDemand { joint, asked_rad_s2, needed_v, limit_v, possible_rad_s2 } = wish;
    format!(
        "{asked_rad_s2:.0} rad/s² on {joint} would need {needed_v:.0} V, its amplifier gives {limit_v:.0} V: planned \
         with what the motor has, about {possible_rad_s2:.1} rad/s² against gravity"
    )
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
