//! `motor.csv`, `amplifier.csv`, `edges.csv`: what a laboratory would log of a head in a fixture, each by the simulated one.

use std::error::Error;

use tracelight_experiment::trials::Trials;
use tracelight_experiment::{Experiment, Filed, amplifier, encoder};
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;
use tracelight_task::{NoProgress, Stop, Task};

use super::Example;

/// The three logs.
pub(super) fn logs() -> Result<Vec<Example>, Box<dyn Error>> {
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    let motor = motor().seen(task).map_err(|e| e.message)?.log().ok_or("no log of the motor")?;
    let readings = amplifier().run(task).map_err(|e| e.message)?;
    let edges = edges().run(task).map_err(|e| e.message)?;
    Ok(vec![
        ("motor.csv", motor.into_bytes()),
        ("amplifier.csv", named(&readings, "readings.csv")?),
        ("edges.csv", named(&edges, "edges.csv")?),
    ])
}

/// One file of a finding.
fn named(finding: &impl Filed, name: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let files = finding.files().map_err(|e| e.message)?;
    let (_, text) = files.into_iter().find(|(n, _)| *n == name).ok_or("no such table")?;
    Ok(text.into_bytes())
}

/// Pan and tilt, −1 to 1 V in steps of a quarter, each held for 3 s.
fn motor() -> Trials {
    Trials {
        rig: RigConfig::report(),
        logs: Vec::new(),
        only: None,
        fixture: true,
        most_v: 1.0,
        step_v: 0.25,
        hold_s: 3.0,
        pulse_v: 1.0,
        pulse_s: 1.0,
        seed: 0,
    }
}

/// Both amplifiers of the worn rig, read by an ammeter to a milliampere.
fn amplifier() -> amplifier::Request {
    amplifier::Request {
        rig: RigConfig::worn(),
        logs: Vec::new(),
        only: None,
        // the default of `lab amplifier`
        torque_nm_per_a: 0.773_886_96,
        most_v: 2.0,
        ammeter_a: 1e-3,
        seed: 0,
    }
}

/// Pan of the worn rig, two turns each way.
fn edges() -> encoder::Request {
    encoder::Request {
        rig: RigConfig::worn(),
        logs: Vec::new(),
        only: Some(Joint::Pan),
        speed_rad_s: 3.0,
        turns: 2,
        seed: 0,
    }
}
