use tracelight_dynamics::Friction;
use tracelight_plant::Plant;
use tracelight_rig::{Head, Joint};

use crate::RigConfig;

/// How a head is held while one of its joints is tested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mounting {
    /// On its feet: gravity pulls, cables hang, stops limit.
    #[default]
    Standing,
    /// In a fixture: the tested axis upright, so that gravity does not turn it; no cables.
    Fixture,
}

/// What a clamp holds, N m: no motor moves it.
const CLAMP_NM: f64 = 1e6;

/// A rig's simulated head without its controller: one joint free, the other clamped straight ahead. `seed` draws what differs from
/// head to head.
pub fn head_alone(rig: &RigConfig, tested: Joint, mounting: Mounting, seed: u64) -> impl Head + use<> {
    let mut config = rig.plant_config();
    if mounting == Mounting::Fixture {
        config.bodies.gravity_m_s2 = 0.0;
        config.wear.cable_nm_per_rad = 0.0;
    }
    let clamped = match tested {
        Joint::Pan => Joint::Tilt,
        Joint::Tilt => Joint::Pan,
    };
    config.friction[clamped] = Friction::symmetric(0.0, CLAMP_NM);
    Plant::new(&config, seed)
}

#[cfg(test)]
mod tests {
    use tracelight_rig::{Actuation, PanTilt};

    use super::*;

    fn counts(mounting: Mounting, volts: f32) -> PanTilt<i32> {
        let mut head = head_alone(&RigConfig::report(), Joint::Tilt, mounting, 0);
        let actuation = Actuation { command_v: PanTilt::new(volts, volts), gate: false };
        let seen = (0..1000).map(|_| head.exchange(&actuation)).last();
        seen.map(|s| s.encoders.map(|e| e.count)).unwrap_or_default()
    }

    #[test]
    fn only_the_tested_joint_turns_and_in_a_fixture_nothing_pulls() {
        let standing = counts(Mounting::Standing, 0.0);
        assert!(standing.tilt > 300 && standing.pan == 0, "it falls: {standing:?}");
        assert_eq!(counts(Mounting::Fixture, 0.0), PanTilt::new(0, 0));
        let driven = counts(Mounting::Fixture, 2.0);
        assert!(driven.tilt > 300 && driven.pan == 0, "{driven:?}");
    }
}
