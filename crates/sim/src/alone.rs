use tracelight_dynamics::Friction;
use tracelight_plant::Plant;
use tracelight_rig::{Actuation, Head, Joint};

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
    plant_alone(rig, tested, mounting, seed)
}

fn plant_alone(rig: &RigConfig, tested: Joint, mounting: Mounting, seed: u64) -> Plant {
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

/// A joint under a voltage at some moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorReading {
    /// V.
    pub volts: f64,
    /// What the motor's current makes at the joint, mean over the last [`READ_TICKS`], N m.
    pub motor_nm: f64,
    /// Counts it went meanwhile.
    pub counts: i32,
}

/// Ticks between two readings.
pub const READ_TICKS: usize = 100;

/// Holds each voltage for this many readings, one after the other, and reads the motor's current as well.
pub fn motor_readings(
    rig: &RigConfig,
    tested: Joint,
    mounting: Mounting,
    volts: &[f64],
    (readings, seed): (usize, u64),
) -> Vec<MotorReading> {
    let mut plant = plant_alone(rig, tested, mounting, seed);
    let mut before = plant.measured()[tested].count;
    let mut read = |volts: f64| {
        let mut actuation = Actuation::default();
        actuation.command_v[tested] = volts as f32;
        let mut sum_nm = 0.0;
        for _ in 0..READ_TICKS {
            plant.exchange(&actuation);
            sum_nm += plant.motor_nm()[tested];
        }
        let after = plant.measured()[tested].count;
        let counts = after.wrapping_sub(std::mem::replace(&mut before, after));
        MotorReading { volts, motor_nm: sum_nm / READ_TICKS as f64, counts }
    };
    volts.iter().flat_map(|&volts| vec![volts; readings]).map(&mut read).collect()
}

#[cfg(test)]
mod tests {
    use tracelight_rig::PanTilt;

    use super::*;

    fn counts(mounting: Mounting, volts: f32) -> PanTilt<i32> {
        let mut head = head_alone(&RigConfig::report(), Joint::Tilt, mounting, 0);
        let actuation = Actuation { command_v: PanTilt::new(volts, volts), ..Actuation::default() };
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
