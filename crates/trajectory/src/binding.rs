//! Names the limit that is active in a motion.

use tracelight_rig::Joint;

/// What a limit is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// The motor's torque.
    Torque(Joint),
    /// The acceleration wished for at a joint.
    Acceleration(Joint),
    /// The highest jerk of a joint.
    Jerk(Joint),
    /// The highest speed of a joint.
    JointSpeed(Joint),
    /// The set speed of the spot.
    SpeedCap,
}

impl Binding {
    /// All there are.
    pub const ALL: [Binding; 9] = [
        Binding::SpeedCap,
        Binding::Torque(Joint::Pan),
        Binding::Torque(Joint::Tilt),
        Binding::Acceleration(Joint::Pan),
        Binding::Acceleration(Joint::Tilt),
        Binding::Jerk(Joint::Pan),
        Binding::Jerk(Joint::Tilt),
        Binding::JointSpeed(Joint::Pan),
        Binding::JointSpeed(Joint::Tilt),
    ];
}

impl core::fmt::Display for Binding {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Binding::Torque(joint) => write!(f, "torque {joint}"),
            Binding::Acceleration(joint) => write!(f, "acceleration {joint}"),
            Binding::Jerk(joint) => write!(f, "jerk {joint}"),
            Binding::JointSpeed(joint) => write!(f, "joint speed {joint}"),
            Binding::SpeedCap => f.write_str("speed cap"),
        }
    }
}
