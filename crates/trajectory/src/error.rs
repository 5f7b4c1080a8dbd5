use tracelight_aim::AimError;
use tracelight_rig::Joint;

/// Why a drawing cannot be planned. Strokes are counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// Nothing to draw.
    #[error("the drawing has no strokes; give one with at least one line")]
    Empty,
    /// Part of a stroke is out of reach.
    #[error(
        "stroke {stroke} leaves the head's reach: {source}; make the picture smaller (--width), shift it (--offset) or step back (--distance)"
    )]
    Aim {
        /// Which stroke.
        stroke: usize,
        /// Where and why.
        source: AimError,
    },
    /// A motor cannot even hold or start its joint.
    #[error(
        "the {joint} motor is too weak: gravity and friction take {needed_nm:.3} N m of the {available_nm:.3} N m a plan may use; raise motion.torque_share or what the rig file says of the motor (motor.limit, stepper.holding_torque or servo.stall_torque), or lower motion.pan_speed and motion.tilt_speed"
    )]
    TooWeak {
        /// Which joint.
        joint: Joint,
        /// Torque needed, N m.
        needed_nm: f64,
        /// Torque there is, N m.
        available_nm: f64,
    },
    /// A stroke cannot be passed at an even speed.
    #[error(
        "stroke {stroke} cannot be run up to, or out of, at {:.0} mm/s: the way there leaves the joints' range or the target, asks too much of the motors, or the stroke is too short for the laser's relay; lower --speed, move the picture away from the edge, or leave --lit-speed at fastest",
        1e3 * speed_m_s
    )]
    NoWayAtSpeed {
        /// Which stroke.
        stroke: usize,
        /// The speed, m/s.
        speed_m_s: f64,
    },
    /// A stroke has a bend too tight for any even speed.
    #[error(
        "stroke {stroke} bends with a radius of {:.4} mm: no even speed is slow enough for that; leave --lit-speed at fastest, or smooth the drawing",
        1e3 * radius_m
    )]
    TooBent {
        /// Which stroke.
        stroke: usize,
        /// Radius of the bend, m.
        radius_m: f64,
    },
    /// More time than a run can be kept in memory.
    #[error(
        "the drawing would take {needed_s:.0} s, a job may take {most_s:.0} s; draw it larger and faster, or in parts"
    )]
    TooLong {
        /// Duration, s.
        needed_s: f64,
        /// Bound, s.
        most_s: f64,
    },
}
