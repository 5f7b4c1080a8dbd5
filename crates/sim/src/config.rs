use tracelight_aim::HeadGeometry;
use tracelight_dynamics::{Friction, HeadBodies, Motor};
use tracelight_plant::{EncoderConfig, RelayConfig, Wear};
use tracelight_rig::PanTilt;

use crate::{LawName, ObserverName};

/// A rig, whole: what we believe it is, what it really is (in simulation), and how it is to be driven.
#[derive(Clone, Debug, PartialEq)]
pub struct RigConfig {
    /// Short name, as in `--rig`.
    pub name: String,
    /// One line on what it is.
    pub description: String,
    /// What trajectory and control believe.
    pub model: Model,
    /// What the simulated plant is.
    pub truth: Truth,
    /// How the controller is set.
    pub control: ControlSettings,
    /// How the planner is set.
    pub motion: MotionSettings,
}

/// A head in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// Masses and gravity.
    pub bodies: HeadBodies,
    /// Friction as identified at speed.
    pub friction: PanTilt<Friction>,
    /// Amplifiers and motors.
    pub motors: PanTilt<Motor>,
    /// Encoders.
    pub encoder: EncoderConfig,
    /// The laser's relay.
    pub relay: RelayConfig,
    /// Where the beam leaves, and how far the joints turn.
    pub geometry: HeadGeometry,
}

/// The simulated plant: a head and its wear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// The head as it really is.
    pub model: Model,
    /// What is worse than its equations.
    pub wear: Wear,
}

/// Settings of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlSettings {
    /// From error to torque.
    pub law: LawName,
    /// From counts to position and velocity; none is the one the law is meant for.
    pub observer: Option<ObserverName>,
    /// Bandwidth of each loop, rad/s: how far its closed-loop poles lie from the origin. The 2006 report's laws have
    /// their own.
    pub bandwidth_rad_s: PanTilt<f64>,
    /// Distance on the target beyond which the laser is darkened, m.
    pub tolerance_m: f64,
    /// How long the head may need to come back to its stroke, s.
    pub hold_limit_s: f64,
    /// How long a host may be silent, s.
    pub host_silence_s: f64,
    /// Share of its amplifier's limit that a motor stands for ever.
    pub motor_continuous: f64,
    /// Time constant of a motor's temperature, s.
    pub motor_heating_s: f64,
}

impl ControlSettings {
    /// The observer that is chosen, or the one the law is meant for.
    pub fn observer_in_use(&self) -> ObserverName {
        self.observer.unwrap_or(self.law.observer())
    }
}

/// Settings of the planner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSettings {
    /// Share of the motors' torque a plan may use; the rest is the feedback's.
    pub torque_share: f64,
    /// Highest joint speed, rad/s.
    pub speed_limit_rad_s: PanTilt<f64>,
    /// Highest joint acceleration that is wished for, rad/s²; the motors decide where they allow less.
    pub acceleration_limit_rad_s2: PanTilt<f64>,
    /// Highest jerk of each joint, from one tick to the next, rad/s³; so high that it binds nothing where there is none.
    pub jerk_limit_rad_s3: PanTilt<f64>,
    /// Time over which the acceleration along a lit stroke builds up, s: the S of its run-up and run-down.
    pub ramp_s: f64,
    /// Rest before a stroke is lit, s.
    pub settle_s: f64,
}
