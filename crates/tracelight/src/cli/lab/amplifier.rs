use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Theme};
use tracelight_lab::{Amplifier, CurrentPoint, Uncertain, amplifier};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{MotorReading, Mounting, READ_TICKS, RigConfig, motor_readings};
use tracelight_task::Failure;
use tracelight_units::{CURRENTS, TORQUE_CONSTANTS};

use super::friction::{HOW_SURE, milli};
use super::parts::{self, by_joint, leave, tell_each};
use super::step::Axis;
use super::{above_zero, rig_out, voltage};
use crate::cli::{Answer, Voice};
use crate::named;
use crate::record::MOST_V;
use crate::table;

/// Identify what an amplifier makes of a volt, and what the turning motor's own voltage takes away
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab amplifier readings.csv --rig my-rig.toml --save\n\n\
                  A log has a row each reading: axis,volt,ampere, and velocity_rad_s if somebody looked at the speed: volts at the amplifier's input, \
                  amperes through the motor. Who divides amperes by volts with the motor turning reads too little: its own voltage (back-EMF) \
                  works against the amplifier. Given the speeds, both are told apart. Given no log, the simulated head is tried in a \
                  fixture, each axis upright and free. The folder gets amplifier.svg, readings.csv, if the head was tried, and rig.toml, its torque per \
                  volt that of the amperes.")]
pub(crate) struct AmplifierArgs {
    /// Logs of readings: axis,volt,ampere[,velocity_rad_s]
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// Only this joint [default: both]
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// Torque at the joint for each ampere: the motor's constant times its gears and belt [default: the 2006 report's]
    #[arg(long, value_name = "TORQUE", default_value = "0.77388696Nm/A", value_parser = torque_constant)]
    torque_per_ampere: f64,
    /// Highest voltage, either way, that the simulated head is tried with
    #[arg(long, value_name = "VOLTAGE", default_value = "2V", value_parser = voltage)]
    most: f64,
    /// What the ammeter shows: its last digit
    #[arg(long, value_name = "CURRENT", default_value = "1mA", value_parser = current)]
    ammeter: f64,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/amplifier")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn torque_constant(text: &str) -> Result<f64, String> {
    above_zero(text, TORQUE_CONSTANTS)
}

fn current(text: &str) -> Result<f64, String> {
    above_zero(text, CURRENTS)
}

/// A joint's readings and what they say.
type Found = parts::Found<CurrentPoint, Amplifier>;

pub(crate) fn run(args: &AmplifierArgs) -> Result<Answer, Failure> {
    let rig = named::rig(&args.rig)?;
    rig_out::may_save(&args.rig, args.save)?;
    let readings = if args.logs.is_empty() { tried(args, &rig) } else { logged(args)? };
    let tell = |joint: Joint, points: &[CurrentPoint]| {
        amplifier(points).ok_or_else(|| {
            let count = points.len();
            let message = format!(
                "{joint}: {count} readings tell no amplifier; give three at least, at different volts"
            );
            Failure::failed("amplifier", message)
        })
    };
    let nothing = || {
        let message = format!("{}: no reading of the joint that is asked for", args.logs.join(", "));
        Failure::usage("amplifier-log", message)
    };
    let found = tell_each(args.axis, readings, tell, nothing)?;
    let mut files = vec![("amplifier.svg", figure(&rig, &found)?)];
    if args.logs.is_empty() {
        files.push(("readings.csv", csv(&found)));
    }
    leave(&args.out, &files)?;
    let mut better = rig.clone();
    for Found { joint, told: amplifier, .. } in &found {
        better.model.motors[*joint].torque_nm_per_v = amplifier.gain.value * args.torque_per_ampere;
    }
    let written = rig_out::write(&args.out, &args.rig, args.save, (&rig, &better))?;
    Ok(Answer::either(args.voice, || text(args, &rig, &found) + &written, || json(args, &found)))
}

/// Readings of the simulated head: each voltage held for three seconds, up and down.
fn tried(args: &AmplifierArgs, rig: &RigConfig) -> PanTilt<Vec<CurrentPoint>> {
    const VOLTAGES: i32 = 8;
    const READINGS: usize = 30;
    let count_rad = rig.model.encoder.count_rad();
    PanTilt::from_fn(|joint| {
        let most = args.most.min(rig.model.motors[joint].limit_v);
        let volts: Vec<f64> = (1..=VOLTAGES)
            .flat_map(|k| [1.0, -1.0].map(|way| way * most * f64::from(k) / f64::from(VOLTAGES)))
            .collect();
        let seen = motor_readings(rig, joint, Mounting::Fixture, &volts, (READINGS, args.seed));
        let read = |reading: &MotorReading| CurrentPoint {
            volts: reading.volts,
            amperes: (reading.motor_nm / args.torque_per_ampere / args.ammeter).round() * args.ammeter,
            rate_rad_s: Some(f64::from(reading.counts) * count_rad / (READ_TICKS as f64 * TICK_F64_S)),
        };
        // each second: readings beside each other are rounded alike, and tell no more than one of them
        seen.chunks(READINGS).flat_map(|held| held.iter().skip(4).step_by(10)).map(read).collect()
    })
}

fn logged(args: &AmplifierArgs) -> Result<PanTilt<Vec<CurrentPoint>>, Failure> {
    /// More than any motor of such a head takes, A, and turns with, rad/s.
    const MOST: f64 = 1e4;
    let mut points: PanTilt<Vec<CurrentPoint>> = PanTilt::default();
    for path in &args.logs {
        table::read(
            path,
            "amplifier-log",
            |names| Ok((names.all(["axis", "volt", "ampere"])?, names.find("velocity_rad_s"))),
            |&([axis, volt, ampere], rate), row| {
                let rate_rad_s = rate.filter(|&column| !row.text(column).is_empty());
                points[row.joint(axis)?].push(CurrentPoint {
                    volts: row.up_to(volt, MOST_V, "any amplifier takes")?,
                    amperes: row.up_to(ampere, MOST, "any motor takes")?,
                    rate_rad_s: rate_rad_s
                        .map(|column| row.up_to(column, MOST, "any joint turns with"))
                        .transpose()?,
                });
                Ok(())
            },
        )?;
    }
    for joint in Joint::BOTH {
        let blind = points[joint].iter().filter(|point| point.rate_rad_s.is_none()).count();
        if blind > 0 && blind < points[joint].len() {
            let message = format!(
                "{}: {blind} of {} readings of {joint} have no velocity_rad_s: give it in each, or leave the column out",
                args.logs.join(", "),
                points[joint].len()
            );
            return Err(Failure::usage("amplifier-log", message));
        }
    }
    Ok(points)
}

fn text(args: &AmplifierArgs, rig: &RigConfig, found: &[Found]) -> String {
    let mut text = if args.logs.is_empty() {
        format!(
            "rig {}, in a fixture, each axis upright and free: to ±{} V, an ammeter that shows {} mA",
            rig.name,
            args.most,
            1e3 * args.ammeter
        )
    } else {
        format!("{}, on rig {}", args.logs.join(", "), rig.name)
    };
    for Found { joint, told: amplifier, .. } in found {
        let had = rig.model.motors[*joint].torque_nm_per_v;
        let torque = args.torque_per_ampere;
        let scaled = |u: Uncertain| Uncertain { value: torque * u.value, within: torque * u.within };
        let rows = [
            ("amplifier, mA/V", milli(Some(amplifier.gain)), None),
            ("back-EMF, mA s/rad", milli(amplifier.back_emf), None),
            ("at 0 V, mA", milli(Some(amplifier.offset)), None),
            ("torque, mNm/V", milli(Some(scaled(amplifier.gain))), Some(1e3 * had)),
            ("back-EMF as friction, mNms/rad", milli(amplifier.back_emf.map(scaled)), None),
        ];
        // writing to a String cannot fail
        let _ = write!(text, "\n\n{:32} {:>22} {:>17}", joint.name(), "found", "the rig file has");
        for (what, found, had) in rows {
            let had = had.map_or(String::new(), |had| format!(" {had:>17.4}"));
            let _ = write!(text, "\n{what:32} {found:>22}{had}");
        }
        let _ = write!(
            text,
            "\namperes divided by volts, speed or not: {:.4} mA/V. {} readings, {:.2} mA rms beside this, r² {:.6}.",
            1e3 * amplifier.as_read,
            amplifier.points,
            1e3 * amplifier.left_a,
            amplifier.r2
        );
        if amplifier.back_emf.is_none() {
            text +=
                " No speeds tell the back-EMF: with the motor turning the amplifier looks weaker than it is.";
        }
    }
    text + HOW_SURE
}

fn json(args: &AmplifierArgs, found: &[Found]) -> String {
    let one = |Found { joint, told: amplifier, .. }: &Found| {
        let object = json!({
            "a_per_v": amplifier.gain.value,
            "back_emf_a_s_per_rad": amplifier.back_emf.map(|u| u.value),
            "offset_a": amplifier.offset.value,
            "torque_nm_per_v": amplifier.gain.value * args.torque_per_ampere,
            "as_read_a_per_v": amplifier.as_read,
            "r2": amplifier.r2,
            "readings": amplifier.points,
            "within": {
                "a_per_v": amplifier.gain.within,
                "back_emf_a_s_per_rad": amplifier.back_emf.map(|u| u.within),
                "offset_a": amplifier.offset.within,
            },
        });
        (*joint, object)
    };
    by_joint(found.iter().map(one))
}

fn csv(found: &[Found]) -> String {
    let mut text = String::from("axis,volt,ampere,velocity_rad_s\n");
    for Found { joint, seen: points, .. } in found {
        for point in points {
            let rate = point.rate_rad_s.unwrap_or_default();
            let _ = writeln!(text, "{joint},{:.4},{:.6},{rate:.5}", point.volts, point.amperes);
        }
    }
    text
}

/// Amperes over volts: as read, and with the motor's own voltage given back.
fn figure(rig: &RigConfig, found: &[Found]) -> Result<String, Failure> {
    const MILLI: f64 = 1e3;
    let panel = |Found { joint, seen: points, told: amplifier }: &Found| {
        let dots =
            |of: &dyn Fn(&CurrentPoint) -> f64| points.iter().map(|p| (p.volts, MILLI * of(p))).collect();
        let back = amplifier.back_emf.map_or(0.0, |u| u.value);
        let ends = points.iter().fold((0.0_f64, 0.0_f64), |(l, h), p| (l.min(p.volts), h.max(p.volts)));
        let line = [ends.0, ends.1].map(|v| (v, MILLI * (amplifier.gain.value * v + amplifier.offset.value)));
        let still = |p: &CurrentPoint| p.amperes + back * p.rate_rad_s.unwrap_or_default();
        Panel {
            x_title: format!("{joint}: volts"),
            y_title: "mA".into(),
            curves: vec![
                Curve { colour: Colour::Vermilion, pen: Pen::Dots, points: dots(&|p| p.amperes) },
                Curve { colour: Colour::Blue, pen: Pen::Dots, points: dots(&still) },
                Curve { colour: Colour::Blue, pen: Pen::Solid, points: line.to_vec() },
            ],
            ..Panel::default()
        }
    };
    let figure = Figure {
        title: format!("Amplifiers of rig {}", rig.name),
        legend: vec![
            Key::new(Colour::Vermilion, "as read, the motor turning or not"),
            Key::new(Colour::Blue, "as with the motor at rest; line: A/V found"),
        ],
        panels: found.iter().map(panel).collect(),
        columns: found.len(),
        panel: (520, 360),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
