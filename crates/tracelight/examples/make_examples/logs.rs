//! `motor.csv`, `amplifier.csv`, `edges.csv`: what a laboratory would log of a head in a fixture, each by the simulated one; `board.csv`:
//! what a small board would.

use std::error::Error;

use tracelight_experiment::columns::Columns;
use tracelight_experiment::trials::Trials;
use tracelight_experiment::{Experiment, Filed, amplifier, encoder};
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;
use tracelight_task::{NoProgress, Stop, Task};

use super::Example;

/// The four logs.
pub(super) fn logs() -> Result<Vec<Example>, Box<dyn Error>> {
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    let turned = turned().seen(task).map_err(|e| e.message)?.log().ok_or("no log of the board")?;
    let motor = motor().seen(task).map_err(|e| e.message)?.log().ok_or("no log of the motor")?;
    let readings = amplifier().run(task).map_err(|e| e.message)?;
    let edges = edges().run(task).map_err(|e| e.message)?;
    Ok(vec![
        ("motor.csv", motor.into_bytes()),
        ("board.csv", board(&turned).into_bytes()),
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
        columns: Columns::default(),
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

/// Pan alone, −3 to 3 V in steps of a quarter of that, each held for 2 s.
fn turned() -> Trials {
    Trials {
        only: Some(Joint::Pan),
        most_v: 3.0,
        step_v: 0.75,
        hold_s: 2.0,
        pulse_v: 3.0,
        pulse_s: 0.3,
        ..motor()
    }
}

/// A log of this program as a small board would write it: milliseconds since it woke up, speed by what was counted in the last 50 ms, the
/// drive as a PWM register, of which 255 are 3 V.
fn board(log: &str) -> String {
    const BACK: usize = 5;
    let row = |line: &str| -> Option<(f64, f64, f64)> {
        let mut cells = line.split(',').skip(1).map(|cell| cell.parse().ok());
        Some((cells.next()??, cells.next()??, cells.next()??))
    };
    let rows: Vec<(f64, f64, f64)> = log.lines().filter_map(row).collect();
    let mut text = String::from("Timestamp(ms),Speed(RPM),PWM\n");
    let mut woken_ms = 12_345.0;
    for trial in rows.chunk_by(|a, b| b.1 > a.1) {
        for (k, (volts, time_s, count)) in trial.iter().enumerate() {
            let before = trial[k.saturating_sub(BACK)];
            let over_s = (time_s - before.1).max(0.01);
            let rpm = (count - before.2) / 4096.0 * 60.0 / over_s;
            text += &format!("{:.0},{rpm:.2},{:.0}\n", woken_ms + 1e3 * time_s, volts * 255.0 / 3.0);
        }
        woken_ms += 1e3 * trial[trial.len() - 1].1 + 2_000.0;
    }
    text
}

/// Both amplifiers of the worn rig, read by an ammeter to a milliampere.
fn amplifier() -> amplifier::Request {
    amplifier::Request {
        rig: RigConfig::worn(),
        logs: Vec::new(),
        columns: Columns::default(),
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
        columns: Columns::default(),
        only: Some(Joint::Pan),
        speed_rad_s: 3.0,
        turns: 2,
        seed: 0,
    }
}
