use std::fmt::Write;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Pen, Theme};
use tracelight_lab::{Relay, RelayPid, StepFigures, Swing, swing};
use tracelight_linear::decibels;
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{
    BenchTick, HandTuned, LawName, Mounting, ObserverName, RigConfig, StepReference, StepResponse,
    head_alone, step_response,
};
use tracelight_task::Failure;
use tracelight_units::Angle;

use super::bode::frequency;
use super::step::{Axis, curve, figures, figures_json, heading, row, step, unreachable};
use super::{OutFile, out_file, over_time, rig_out, voltage, write_all};
use crate::cli::laws::observer;
use crate::cli::{Answer, Voice};
use crate::named;

/// Let a relay swing a joint, and tune a PID from how it swings: no model needed
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab relay --axis tilt -o tilt.svg\n\
                  Example: tracelight lab relay --axis pan --rig my-rig.toml --save\n\n\
                  In place of a controller a relay: so many volts one way until the joint is a little beyond its middle, then as many the other way. \
                  Amplitude and period of the swing are a point of the joint's frequency response; the PID takes that point to the phase margin, \
                  and crosses 1 there. Fewer volts swing slower, less hysteresis faster, and tune so; --crossover tunes faster than it swings. Friction damps a small \
                  swing, and the PID counts on that: the linearized head, which has none, overshoots more. Gravity is found out meanwhile. \
                  The gains are those of law hand-tuned: --save writes them and the law into a rig file, comments kept.")]
pub(crate) struct RelayArgs {
    /// Which joint
    #[arg(long, value_enum, default_value = "pan")]
    axis: Axis,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// The relay, either way
    #[arg(long, value_name = "VOLTAGE", default_value = "4V", value_parser = voltage)]
    level: f64,
    /// How far beyond its middle the joint turns the relay over [default: one and a half counts]
    #[arg(long, value_name = "ANGLE", value_parser = step)]
    hysteresis: Option<Angle>,
    /// The joint is in a fixture, its axis upright: nothing pulls
    #[arg(long)]
    fixture: bool,
    /// Where the tuned loop's gain is 1 [default: where the joint swings]; elsewhere the joint is taken for the mass that swings so
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    crossover: Option<f64>,
    /// Phase margin of the tuned loop
    #[arg(long, value_name = "ANGLE", default_value = "55deg", value_parser = margin)]
    phase_margin: Angle,
    /// How many times as slowly as the derivative the integral acts
    #[arg(long, value_name = "FACTOR", default_value_t = 10.0, value_parser = factor)]
    integral: f64,
    /// How counts become position and speed in the tuned loop [default: as the law is meant]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    observer: Option<ObserverName>,
    /// How far the tuned joint is sent to try it
    #[arg(long, value_name = "ANGLE", default_value = "5deg", allow_hyphen_values = true, value_parser = step)]
    to: Angle,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot swing and step into an SVG or PNG, or write the swing, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    /// Write the gains and law hand-tuned into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn margin(text: &str) -> Result<Angle, String> {
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    let degrees = angle.0.to_degrees();
    if (10.0..=85.0).contains(&degrees) {
        Ok(angle)
    } else {
        Err(format!("{text} is not between 10 and 85 degrees"))
    }
}

fn factor(text: &str) -> Result<f64, String> {
    super::by_hand::number("--integral", text, 2.0, 1e4)
}

/// A swing, the gains from it, and what they do.
struct Tuned {
    relay: Relay,
    swing: Swing,
    pid: RelayPid,
    response: StepResponse,
    nonlinear: StepFigures,
    linear: StepFigures,
}

pub(crate) fn run(args: &RelayArgs) -> Result<Answer, Failure> {
    rig_out::may_save(&args.rig, args.save)?;
    let rig = named::rig(&args.rig)?;
    let joint = args.axis.joint();
    let (swing, relay) = swung(args, &rig, joint)?;
    let torque_nm_per_v = rig.model.motors[joint].torque_nm_per_v;
    let pid = swing
        .pid(&relay, torque_nm_per_v, args.crossover, (args.phase_margin.0, args.integral))
        .map_err(|e| Failure::failed("relay", e))?;
    let mut better = rig.clone();
    // an observer that the rig's file names stays
    better.control.law = LawName::HandTuned;
    better.control.observer = args.observer.or(rig.control.observer);
    let by_hand = &mut better.control.hand_tuned[joint];
    *by_hand = HandTuned { kp: pid.kp, ki: pid.ki, kd: pid.kd, ..*by_hand };
    let response = step_response(&better, joint, args.to.0, StepReference::Jump, args.seed)
        .ok_or_else(|| unreachable(joint, args.to))?;
    let (nonlinear, linear) =
        (figures(&response.nonlinear, joint, args.to), figures(&response.linear, joint, args.to));
    let tuned = Tuned { relay, swing, pid, response, nonlinear, linear };
    write_all(&args.out, || figure(args, &rig, &tuned), || Ok(csv(&tuned)))?;
    if args.save {
        named::save_rig(&args.rig, &rig, &better)?;
    }
    Ok(Answer::either(args.voice, || text(args, &rig, &tuned), || json(args, &rig, &tuned)))
}

fn swung(args: &RelayArgs, rig: &RigConfig, joint: Joint) -> Result<(Swing, Relay), Failure> {
    let motor = rig.model.motors[joint];
    let mounting = if args.fixture { Mounting::Fixture } else { Mounting::Standing };
    let pull_nm = match (joint, mounting) {
        (Joint::Tilt, Mounting::Standing) => rig.model.bodies.lumped().gravity(0.0).tilt,
        _ => 0.0,
    };
    let count_rad = rig.model.encoder.count_rad();
    let relay = Relay {
        level_v: args.level,
        hysteresis_rad: args.hysteresis.map_or(1.5 * count_rad, |angle| angle.0.abs()),
        hold_v: motor.volts_for(pull_nm),
        limit_v: motor.limit_v,
        count_rad,
    };
    if args.level + relay.hold_v.abs() > motor.limit_v {
        let message = format!(
            "--level {} V and {:.2} V to hold {joint} are more than the {} V of its amplifier",
            args.level,
            relay.hold_v.abs(),
            motor.limit_v
        );
        return Err(Failure::usage("usage", message));
    }
    let mut head = head_alone(rig, joint, mounting, args.seed);
    let swing = swing(&mut head, joint, &relay).map_err(|e| Failure::failed("relay", e))?;
    Ok((swing, relay))
}

fn text(args: &RelayArgs, rig: &RigConfig, tuned: &Tuned) -> String {
    let Tuned { relay, swing, pid, .. } = tuned;
    let joint = args.axis.joint();
    let torque_nm_per_v = rig.model.motors[joint].torque_nm_per_v;
    let there = swing.response(relay, torque_nm_per_v);
    let (inertia_kg_m2, coulomb_nm) = swing.mass(relay, torque_nm_per_v);
    let mut text = format!(
        "{joint} of rig {} between {:.2} V and {:.2} V, turned over {:.3}° beyond its middle:\n\
         swings by ±{:.3}° in {:.4} s, periods and amplitudes within {:.1} %\n\
         at {:.2} rad/s it answers {:.2} dB and {:.1}°, rad per N m,\n\
         like {:.5} kg m² with {:.4} N m of Coulomb friction\n\n\
         gains for a phase margin of {:.1}° at {:.2} rad/s, as it answers at this amplitude: kp = {:.4} N m/rad, ki = {:.4} N m/(rad s), kd = {:.4} N m s/rad\n\n",
        rig.name,
        swing.hold_v - relay.level_v,
        swing.hold_v + relay.level_v,
        relay.hysteresis_rad.to_degrees(),
        swing.amplitude_rad.to_degrees(),
        swing.period_s,
        100.0 * swing.unevenness,
        swing.rad_s(),
        decibels(there.norm()),
        there.arg().to_degrees(),
        inertia_kg_m2,
        coulomb_nm,
        args.phase_margin.0.to_degrees(),
        args.crossover.unwrap_or(swing.rad_s()),
        pid.kp,
        pid.ki,
        pid.kd,
    );
    text += &heading(rig, joint, args.to);
    text += &row(LawName::HandTuned.name(), &tuned.nonlinear, &tuned.linear, rig);
    text += "\n\nmm on a target 3 ft away.";
    if args.save {
        // writing to a String cannot fail
        let other = if joint == Joint::Pan { Joint::Tilt } else { Joint::Pan };
        let _ = write!(
            text,
            " {} has law hand-tuned now, for both joints, and {joint}'s gains; {other}'s are those of control.hand_tuned.{other}: tune them as well.",
            args.rig
        );
    }
    text
}

fn json(args: &RelayArgs, rig: &RigConfig, tuned: &Tuned) -> String {
    let Tuned { relay, swing, pid, .. } = tuned;
    let mut object = figures_json(&tuned.nonlinear, rig);
    object["linear"] = figures_json(&tuned.linear, rig);
    let torque_nm_per_v = rig.model.motors[args.axis.joint()].torque_nm_per_v;
    let there = swing.response(relay, torque_nm_per_v);
    let (inertia_kg_m2, coulomb_nm) = swing.mass(relay, torque_nm_per_v);
    let swung = json!({
        "axis": args.axis.joint().name(),
        "amplitude_rad": swing.amplitude_rad,
        "period_s": swing.period_s,
        "unevenness": swing.unevenness,
        "hold_v": swing.hold_v,
        "rad_s": swing.rad_s(),
        "magnitude_rad_per_nm": there.norm(),
        "phase_deg": there.arg().to_degrees(),
        "inertia_kg_m2": inertia_kg_m2,
        "coulomb_nm": coulomb_nm,
        "crossover_rad_s": args.crossover.unwrap_or(swing.rad_s()),
        "kp": pid.kp,
        "ki": pid.ki,
        "kd": pid.kd,
        "to_rad": args.to.0,
        "step": object,
    });
    swung.to_string()
}

fn csv(tuned: &Tuned) -> String {
    let mut text = String::from("t_s,volt,angle_rad\n");
    for (number, (volts, angle_rad)) in tuned.swing.ticks.iter().enumerate() {
        let _ = writeln!(text, "{:.3},{volts:.4},{angle_rad:.7}", number as f64 * TICK_F64_S);
    }
    text
}

fn figure(args: &RelayArgs, rig: &RigConfig, tuned: &Tuned) -> Result<String, Failure> {
    let joint = args.axis.joint();
    let swung = |value: &dyn Fn(&(f64, f64)) -> f64| {
        let ticks = tuned.swing.ticks.iter().enumerate();
        let points = ticks.map(|(k, tick)| (k as f64 * TICK_F64_S, value(tick))).collect();
        vec![Curve { colour: Colour::Blue, pen: Pen::Solid, points }]
    };
    let angle = |tick: &BenchTick| tick.angle_rad[joint].to_degrees();
    let volts = |tick: &BenchTick| f64::from(tick.command_v[joint]);
    let of = |ticks, pen, value| curve(Colour::Vermilion, ticks, pen, value);
    let tried = vec![
        of(&tuned.response.nonlinear, Pen::Solid, &angle),
        of(&tuned.response.linear, Pen::Dashed, &angle),
    ];
    let figure = Figure {
        title: format!("{joint} of rig {}: swung by a relay, tuned, tried", rig.name),
        legend: vec![
            Key::new(Colour::Blue, "by the relay"),
            Key::new(Colour::Vermilion, "by the PID tuned from it (dashed: linearized)"),
        ],
        panels: vec![
            over_time("angle, °", vec![0.0], swung(&|(_, angle)| angle.to_degrees())),
            over_time("relay, V", Vec::new(), swung(&|(volts, _)| *volts)),
            over_time("angle, °", vec![args.to.0.to_degrees()], tried),
            over_time("command, V", Vec::new(), vec![of(&tuned.response.nonlinear, Pen::Solid, &volts)]),
        ],
        columns: 2,
        panel: (560, 260),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
