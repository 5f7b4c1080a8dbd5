use tracelight_control::{Estimate, ObserverConfig, Servo};
use tracelight_rig::{Joint, PanTilt};

use crate::{RigConfig, Tick};

/// Runs an observer over the counts, edges and volts of a recorded run, open loop.
pub fn replay(rig: &RigConfig, ticks: &[Tick], observer: ObserverConfig) -> Vec<PanTilt<Estimate>> {
    let mut config = rig.control_config();
    for joint in Joint::BOTH {
        config.axes[joint].observer = observer;
    }
    let Some(first) = ticks.first() else { return Vec::new() };
    let mut servo = Servo::at_rest(&config, &first.telemetry.measured);
    let mut believed = Vec::with_capacity(ticks.len());
    for (number, tick) in ticks.iter().enumerate() {
        if number > 0 {
            servo.observe(&config, &tick.telemetry.measured);
        }
        servo.apply(&config, tick.telemetry.actuation.command_v);
        believed.push(*servo.estimates());
    }
    believed
}
