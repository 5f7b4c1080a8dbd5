use std::fmt::Write;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Mark, Panel, Pen, Scale, Sign, Theme};
use tracelight_files as files;
use tracelight_lab::{Excitation, Excited, FrequencyPoint, Multisine, excite, frequency_response};
use tracelight_linear::{Discretization, FrequencyResponse, LinearError, TransferFunction, decibels};
use tracelight_linear::{Polynomial, Time};
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{Mounting, RigConfig, head_alone};
use tracelight_task::Failure;
use tracelight_units::{ANGULAR_SPEEDS, TIMES};

use super::step::Axis;
use super::{OutFile, above_zero, out_file, voltage, write_all};
use crate::cli::{Answer, Voice};
use crate::named;
use crate::record::MOST_V;
use crate::table;

/// Measure a joint's frequency response with many sines at once, its coherence, and hold it against the model
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab frequency --axis tilt -o tilt.svg\n\n\
                  The joint stands in a fixture, its axis upright and free, and turns one way under a steady voltage: friction that does not change \
                  sides is a constant, and what is left of the joint is linear. On top come sines, whole periods of each in a period of all, at \
                  phases that keep their sum low. What the voltage does to the angle is told from the drift by which the joint \
                  turns meanwhile; coherence, from how periods differ, says how much of it is so. The model is the rig file's inertia, friction and torque \
                  per volt, sampled behind a hold as the counts are.\n\n\
                  A real head is measured by --volts: a period of the sines on top of the steady voltage, to be played again and again while the \
                  head turns; its log, axis,time_s,volt,count, a row a millisecond from when it turns evenly, is then given here, with the same --period. Any \
                  volts that repeat with the period do.")]
pub(crate) struct FrequencyTrialArgs {
    /// Log of what a head did: axis,time_s,volt,count; given none, the simulated head is tried
    #[arg(value_name = "LOG.csv")]
    log: Option<String>,
    /// Which joint
    #[arg(long, value_enum, default_value = "pan")]
    axis: Axis,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// Lowest frequency
    #[arg(long, value_name = "FREQUENCY", default_value = "0.7rad/s", value_parser = frequency)]
    from: f64,
    /// Highest frequency
    #[arg(long, value_name = "FREQUENCY", default_value = "600rad/s", value_parser = frequency)]
    to: f64,
    /// Most sines
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u32).range(1..=1000))]
    sines: u32,
    /// All of them together are as strong as one of this amplitude
    #[arg(long, value_name = "VOLTAGE", default_value = "2V", value_parser = voltage)]
    amplitude: f64,
    /// Speed at which the joint turns meanwhile; the steady voltage is what holds it by the model
    #[arg(long, value_name = "SPEED", default_value = "10rad/s", allow_hyphen_values = true, value_parser = speed)]
    speed: f64,
    /// Period of all
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = period)]
    period: f64,
    /// Periods that are watched, after one that is not
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(2..=200))]
    periods: u32,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Write a period of the volts, t_s,volt, to be played to a head
    #[arg(long, value_name = "FILE.csv", conflicts_with = "log")]
    volts: Option<String>,
    /// Write what the simulated head did, as a log
    #[arg(long, value_name = "FILE.csv", conflicts_with = "log")]
    record: Option<String>,
    /// Plot amplification, phase and coherence into an SVG or PNG, or write them to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn frequency(text: &str) -> Result<f64, String> {
    const MOST_RAD_S: f64 = 1500.0; // four ticks a period
    let rad_s = above_zero(text, ANGULAR_SPEEDS)?;
    if rad_s <= MOST_RAD_S {
        Ok(rad_s)
    } else {
        Err(format!("{text} is more than {MOST_RAD_S} rad/s, which a tick a millisecond can carry"))
    }
}

fn speed(text: &str) -> Result<f64, String> {
    let rad_s = tracelight_units::parse(text, ANGULAR_SPEEDS).map_err(|e| e.to_string())?;
    if (0.5..=100.0).contains(&rad_s.abs()) {
        Ok(rad_s)
    } else {
        Err(format!("{text} is not between 0.5 and 100 rad/s, either way"))
    }
}

fn period(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    if (0.1..=100.0).contains(&time_s) {
        Ok(time_s)
    } else {
        Err(format!("{text} is not between 0.1 and 100 s"))
    }
}

/// What was measured, and what the model says.
struct Found {
    points: Vec<FrequencyPoint>,
    model: FrequencyResponse,
    /// The voltage that held the speed, V.
    bias_v: f64,
    one_way: bool,
}

pub(crate) fn run(args: &FrequencyTrialArgs) -> Result<Answer, Failure> {
    let rig = named::rig(&args.rig)?;
    let found = match &args.log {
        Some(path) => logged(args, &rig, path)?,
        None => measure(args, &rig)?,
    };
    write_all(&args.out, || figure(args, &rig, &found), || Ok(csv(&found)))?;
    Ok(Answer::either(args.voice, || text(args, &rig, &found), || json(args, &found)))
}

/// Sines that fit into the period.
fn check_range(args: &FrequencyTrialArgs) -> Result<(), Failure> {
    if args.from >= args.to {
        return Err(Failure::usage("usage", "--from must be below --to"));
    }
    if args.from < std::f64::consts::TAU / args.period {
        let least = std::f64::consts::TAU / args.period;
        let message =
            format!("--from must be {least:.3} rad/s at least: one turn in a --period of {} s", args.period);
        return Err(Failure::usage("usage", message));
    }
    Ok(())
}

fn measure(args: &FrequencyTrialArgs, rig: &RigConfig) -> Result<Found, Failure> {
    check_range(args)?;
    let joint = args.axis.joint();
    let motor = rig.model.motors[joint];
    let bias_v = motor.volts_for(rig.model.friction[joint].torque(args.speed));
    if bias_v.abs() + args.amplitude > motor.limit_v {
        let message = format!(
            "{:.2} V to turn with {} rad/s and {} V of sines are more than the {} V of the amplifier",
            bias_v.abs(),
            args.speed,
            args.amplitude,
            motor.limit_v
        );
        return Err(Failure::usage("usage", message));
    }
    let multisine = Multisine::new((args.from, args.to), args.sines as usize, args.period, args.amplitude);
    let how = Excitation {
        bias_v,
        start_v: 0.5 * motor.limit_v.copysign(args.speed),
        rate_rad_s: args.speed,
        count_rad: rig.model.encoder.count_rad(),
        settling: 1,
        watched: args.periods as usize,
    };
    let mut head = head_alone(rig, joint, Mounting::Fixture, args.seed);
    if let Some(path) = &args.volts {
        files::write(path, played(&multisine, bias_v))?;
    }
    let seen = excite(&mut head, joint, &multisine, &how);
    if let Some(path) = &args.record {
        files::write(path, log(joint, &seen, how.count_rad))?;
    }
    found(args, rig, &multisine, (&seen, bias_v))
}

fn found(
    args: &FrequencyTrialArgs,
    rig: &RigConfig,
    multisine: &Multisine,
    (seen, bias_v): (&Excited, f64),
) -> Result<Found, Failure> {
    let model = model(rig, args.axis.joint(), args.speed.copysign(bias_v))
        .map_err(|e| Failure::failed("no-linear-model", format!("rig {}: {e}", rig.name)))?;
    Ok(Found {
        points: frequency_response(multisine, &seen.angles_rad),
        model: model.frequency_response(multisine.rad_s().collect()),
        bias_v,
        one_way: seen.one_way,
    })
}

/// A period of volts.
fn played(multisine: &Multisine, bias_v: f64) -> String {
    let mut text = String::from("t_s,volt\n");
    for (number, volts) in multisine.volts().iter().enumerate() {
        // writing to a String cannot fail
        let _ = writeln!(text, "{:.3},{:.6}", number as f64 * TICK_F64_S, bias_v + volts);
    }
    text
}

/// What was seen, as a log.
fn log(joint: Joint, seen: &Excited, count_rad: f64) -> String {
    let mut text = String::from("axis,time_s,volt,count\n");
    for (number, (angle_rad, volts)) in seen.angles_rad.iter().zip(&seen.volts).enumerate() {
        let count = (angle_rad / count_rad).round();
        let _ = writeln!(text, "{joint},{:.3},{volts:.6},{count}", number as f64 * TICK_F64_S);
    }
    text
}

/// What a log says.
fn logged(args: &FrequencyTrialArgs, rig: &RigConfig, path: &str) -> Result<Found, Failure> {
    const CODE: &str = "frequency-log";
    let joint = args.axis.joint();
    let count_rad = rig.model.encoder.count_rad();
    let mut seen = Excited { angles_rad: Vec::new(), volts: Vec::new(), one_way: true };
    let mut last_s = None;
    table::read(
        path,
        CODE,
        |names| names.all(["axis", "time_s", "volt", "count"]),
        |&[axis, time, volt, count], row| {
            let time_s = row.number(time)?;
            if row.joint(axis)? != joint {
                return Ok(());
            }
            if let Some(before) = last_s.replace(time_s)
                && (time_s - before - TICK_F64_S).abs() > 0.01 * TICK_F64_S
            {
                let (line, apart) = (row.line, 1e3 * (time_s - before));
                return Err(format!(
                    ":{line}: {time_s} s comes {apart:.4} ms after the row before; rows must be 1 ms apart"
                ));
            }
            seen.volts.push(row.up_to(volt, MOST_V, "any amplifier takes, V")?);
            seen.angles_rad.push(f64::from(row.whole(count)?) * count_rad);
            Ok(())
        },
    )?;
    let period_ticks = (args.period / TICK_F64_S).round() as usize;
    const LONGEST_TICKS: usize = 20_000; // its sines are told one by one
    if period_ticks > LONGEST_TICKS {
        let message = format!("a log's --period may have {} s at most", LONGEST_TICKS as f64 * TICK_F64_S);
        return Err(Failure::usage("usage", message));
    }
    let multisine = Multisine::in_record(period_ticks, &seen.volts).ok_or_else(|| {
        let message = format!(
            "{path}: {} rows of {joint} hold no two periods of {} s of volts that change: give a longer log, or its own --period",
            seen.volts.len(),
            args.period
        );
        Failure::usage(CODE, message)
    })?;
    let bias_v = seen.volts.iter().sum::<f64>() / seen.volts.len() as f64;
    // over a twentieth of a second, as the simulated head is watched
    let turned = seen.angles_rad.windows(51).step_by(50).map(|span| span[50] - span[0]);
    seen.one_way = turned.into_iter().all(|rad| rad * bias_v > 0.0);
    found(args, rig, &multisine, (&seen, bias_v))
}

/// From volts to the angle, as counts see it.
fn model(rig: &RigConfig, joint: Joint, speed_rad_s: f64) -> Result<TransferFunction, LinearError> {
    let friction = &rig.model.friction[joint];
    let viscous = if speed_rad_s > 0.0 { friction.viscous_pos } else { friction.viscous_neg };
    let above = Polynomial::new(vec![rig.model.motors[joint].torque_nm_per_v]);
    let below = Polynomial::new(vec![rig.model.own_inertia_kg_m2()[joint], viscous, 0.0]);
    TransferFunction::new(above, below, Time::Continuous)?.sampled(TICK_F64_S, Discretization::ZeroOrderHold)
}

impl Found {
    /// The phase that was measured, turned as often as the model's.
    fn phase_deg(&self, number: usize) -> f64 {
        let (measured, model) = (self.points[number].response.arg(), self.model.phases_rad[number]);
        let turns = ((model - measured) / std::f64::consts::TAU).round();
        (measured + turns * std::f64::consts::TAU).to_degrees()
    }

    /// Up to which frequency the angle follows the voltage, rad/s.
    fn coherent_to(&self) -> Option<f64> {
        const COHERENT: f64 = 0.9;
        self.points.iter().take_while(|point| point.coherence >= COHERENT).last().map(|point| point.rad_s)
    }
}

/// What was done.
fn in_words(args: &FrequencyTrialArgs, rig: &RigConfig, found: &Found) -> String {
    let (joint, sines) = (args.axis.joint(), found.points.len());
    match &args.log {
        Some(path) => format!(
            "{joint} by {path}, on rig {}: {sines} sines that repeat each {} s, about {:.3} V",
            rig.name, args.period, found.bias_v
        ),
        None => format!(
            "{joint} of rig {} in a fixture, turning with {} rad/s under {:.3} V, {sines} sines together like one of {} V, {} periods of {} s",
            rig.name, args.speed, found.bias_v, args.amplitude, args.periods, args.period
        ),
    }
}

fn text(args: &FrequencyTrialArgs, rig: &RigConfig, found: &Found) -> String {
    let mut text = format!(
        "{}\n\n{:>10} {:>14} {:>10} {:>12} {:>10} {:>11} {:>12}",
        in_words(args, rig, found),
        "rad/s",
        "amplified, dB",
        "model, dB",
        "phase, °",
        "model, °",
        "coherence",
        "known to, %"
    );
    for (number, point) in found.points.iter().enumerate() {
        // writing to a String cannot fail
        let _ = write!(
            text,
            "\n{:10.3} {:14.2} {:10.2} {:12.1} {:10.1} {:11.4} {:12.2}",
            point.rad_s,
            decibels(point.response.norm()),
            decibels(found.model.values[number].norm()),
            found.phase_deg(number),
            found.model.phases_rad[number].to_degrees(),
            point.coherence,
            100.0 * point.deviation
        );
    }
    let to = found.coherent_to().map_or("nowhere".to_owned(), |rad_s| format!("to {rad_s:.1} rad/s"));
    text += &format!(
        "\n\nThe angle follows the voltage {to} (coherence 0.9); above, a count hides it: more volts, or more periods."
    );
    if !found.one_way {
        text += "\nIt stood or turned back on the way, so friction was no constant: more --speed, or less --amplitude.";
    }
    text
}

fn json(args: &FrequencyTrialArgs, found: &Found) -> String {
    let one = |(number, point): (usize, &FrequencyPoint)| {
        let model = found.model.values[number];
        json!({
            "rad_s": point.rad_s,
            "magnitude": point.response.norm(),
            "phase_deg": found.phase_deg(number),
            "coherence": point.coherence,
            "deviation": point.deviation,
            "model_magnitude": model.norm(),
            "model_phase_deg": found.model.phases_rad[number].to_degrees(),
        })
    };
    json!({
        "axis": args.axis.joint().name(),
        "bias_v": found.bias_v,
        "one_way": found.one_way,
        "coherent_to_rad_s": found.coherent_to(),
        "points": found.points.iter().enumerate().map(one).collect::<Vec<_>>(),
    })
    .to_string()
}

fn csv(found: &Found) -> String {
    let mut text = String::from(
        "rad_s,magnitude_rad_per_v,phase_deg,coherence,deviation,model_magnitude,model_phase_deg\n",
    );
    for (number, point) in found.points.iter().enumerate() {
        let _ = writeln!(
            text,
            "{:.6},{:.6e},{:.3},{:.6},{:.6},{:.6e},{:.3}",
            point.rad_s,
            point.response.norm(),
            found.phase_deg(number),
            point.coherence,
            point.deviation,
            found.model.values[number].norm(),
            found.model.phases_rad[number].to_degrees()
        );
    }
    text
}

fn figure(args: &FrequencyTrialArgs, rig: &RigConfig, found: &Found) -> Result<String, Failure> {
    let numbers = 0..found.points.len();
    let rad_s = |number: usize| found.points[number].rad_s;
    let dots = |value: &dyn Fn(usize) -> f64| -> Vec<Mark> {
        numbers
            .clone()
            .map(|k| Mark { colour: Colour::Blue, sign: Sign::Dot, at: (rad_s(k), value(k)) })
            .collect()
    };
    let line = |value: &dyn Fn(usize) -> f64| {
        let points = numbers.clone().map(|k| (rad_s(k), value(k))).collect();
        vec![Curve { colour: Colour::Black, pen: Pen::Dashed, points }]
    };
    let panel = |title: &str, marks: Vec<Mark>, curves: Vec<Curve>| Panel {
        x_title: "frequency, rad/s".into(),
        y_title: title.into(),
        marks,
        curves,
        scale: Scale::LogX,
        ..Panel::default()
    };
    let coherence = |k: usize| found.points[k].coherence;
    let panels = vec![
        panel(
            "angle per volt, dB",
            dots(&|k| decibels(found.points[k].response.norm())),
            line(&|k| decibels(found.model.values[k].norm())),
        ),
        panel("phase, °", dots(&|k| found.phase_deg(k)), line(&|k| found.model.phases_rad[k].to_degrees())),
        panel(
            "coherence",
            dots(&coherence),
            vec![Curve { colour: Colour::Blue, ..line(&coherence).remove(0) }],
        ),
    ];
    let figure = Figure {
        title: format!("Frequency response of {}, rig {}", args.axis.joint(), rig.name),
        legend: vec![
            Key::new(Colour::Blue, "dots: measured"),
            Key::new(Colour::Black, "dashed: the rig file's model"),
        ],
        panels,
        columns: 1,
        panel: (820, 250),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
