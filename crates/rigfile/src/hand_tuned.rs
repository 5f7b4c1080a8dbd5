//! Keys of law hand-tuned, and all keys that are not of a head.

use tracelight_sim::{Feedforward, RigConfig};
use tracelight_units::Unit;

use crate::homing::HOMING_KEYS;
use crate::keys::{Choice, Key, PURE, RIG_KEYS, STIFFNESS, VISCOUS, choice, flag, real};
use crate::safety::SAFETY_KEYS;

const INTEGRAL_GAIN: &[Unit] = &[("Nm/rad/s", 1.0)];
/// More than any motor of a head like this asks for, and less than `f32` bears.
pub const HIGHEST_GAIN: f64 = 1e6;

/// The names of what a PID set by hand may have from the model.
pub const FEEDFORWARDS: [(&str, Feedforward); 3] =
    [("none", Feedforward::None), ("gravity", Feedforward::Gravity), ("model", Feedforward::Model)];

/// A joint's PID.
macro_rules! by_hand {
    ($joint:ident) => {
        [
            real(
                concat!("control.hand_tuned.", stringify!($joint), ".kp"),
                STIFFNESS,
                (0.0, HIGHEST_GAIN),
                "law hand-tuned: its proportional gain",
                (|r| &mut r.control.hand_tuned.$joint.kp) as fn(&mut RigConfig) -> &mut f64,
            ),
            real(
                concat!("control.hand_tuned.", stringify!($joint), ".ki"),
                INTEGRAL_GAIN,
                (0.0, HIGHEST_GAIN),
                "its integral gain",
                |r| &mut r.control.hand_tuned.$joint.ki,
            ),
            real(
                concat!("control.hand_tuned.", stringify!($joint), ".kd"),
                VISCOUS,
                (0.0, HIGHEST_GAIN),
                "its derivative gain",
                |r| &mut r.control.hand_tuned.$joint.kd,
            ),
            real(
                concat!("control.hand_tuned.", stringify!($joint), ".position_weight"),
                PURE,
                (0.0, 1.0),
                "share of the setpoint that kp sees",
                |r| &mut r.control.hand_tuned.$joint.position_weight,
            ),
            real(
                concat!("control.hand_tuned.", stringify!($joint), ".velocity_weight"),
                PURE,
                (0.0, 1.0),
                "share of the setpoint's speed that kd sees",
                |r| &mut r.control.hand_tuned.$joint.velocity_weight,
            ),
            flag(
                concat!("control.hand_tuned.", stringify!($joint), ".anti_windup"),
                "whether the integral waits while the amplifier is at its limit",
                |r| &mut r.control.hand_tuned.$joint.anti_windup,
            ),
            choice(
                concat!("control.hand_tuned.", stringify!($joint), ".feedforward"),
                "what the model adds",
                Choice {
                    names: || FEEDFORWARDS.map(|(name, _)| name).to_vec(),
                    get: |r| named(r.control.hand_tuned.$joint.feedforward),
                    set: |r, name| {
                        let found = FEEDFORWARDS.iter().find(|(known, _)| *known == name);
                        r.control.hand_tuned.$joint.feedforward =
                            found.map_or(Feedforward::None, |(_, is)| *is);
                    },
                },
            ),
        ]
    };
}

fn named(feedforward: Feedforward) -> &'static str {
    FEEDFORWARDS.iter().find(|(_, is)| *is == feedforward).map_or("none", |(name, _)| name)
}

/// Keys of `[truth.wear]`, `[control]`, `[motion]`, `[laser]`, `[safety]` and `[homing]`.
pub(crate) fn rig_keys() -> Vec<Key<RigConfig>> {
    let mut keys = RIG_KEYS.to_vec();
    keys.extend(SAFETY_KEYS);
    keys.extend(HOMING_KEYS);
    keys.extend(by_hand!(pan));
    keys.extend(by_hand!(tilt));
    keys
}
