mod rows;

use std::fmt::Write;

use clap::{ArgAction, Args, ValueEnum};
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Theme};
use tracelight_linear::Zpk;
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{
    Between, Diagram, LawName, MotionArray, ObserverName, RigConfig, ScopeTick, follow_array,
};
use tracelight_task::Failure;
use tracelight_units::{TIMES, TORQUES};

use super::by_hand::ByHandArgs;
use super::head::Set;
use super::shape::switch;
use super::systems::controller;
use super::{OutFile, above_zero, out_file, over_time, write_all};
use crate::cli::laws::{choose, law, observer};
use crate::cli::{Answer, Voice};
use crate::named;

/// Run an array of times and angles through the nonlinear loop: desired, actual and error, as the 2006 report's simulation
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab simulate --random --law state,report-pd -o scopes.svg\n\
                  Example: tracelight lab simulate path.csv --controller '2 + 10 s/(1 + s/50)' '2 + 5 s/(1 + s/50)' --hold off --cap 500Nm\n\n\
                  A row of the array is t,pan,tilt: seconds and radians, with or without names above; pan_deg,tilt_deg are degrees, and a \
                  run's own trace.csv or a plan's CSV does as well. Between rows goes a spline, or lines. The head starts at rest where \
                  the array does.\n\n\
                  A law is the rig's controller as it would be flashed, every millisecond. A --controller is a transfer function for each \
                  joint, from error, rad, to torque, N m, in continuous time, as in the report's block diagram; K11, K22 and K11t, K22t \
                  are the report's own; the head is then new, without a rig's wear. --quantizer off lets it see angles as they are (a law: a million counts a turn), --hold off at \
                  once, not every millisecond.")]
pub(crate) struct SimulateArgs {
    /// Where the joints are to be: a row each t,pan,tilt
    #[arg(value_name = "TRAJ.csv", required_unless_present = "random")]
    array: Option<String>,
    /// Follow a random motion instead, within 15° of straight ahead, for so long
    #[arg(long, value_name = "TIME", num_args = 0..=1, default_missing_value = "10s", value_parser = time, conflicts_with = "array")]
    random: Option<f64>,
    /// What joins the rows
    #[arg(long, value_enum, default_value = "spline")]
    between: Join,
    /// Laws to follow it by, the first alone in the CSV [default: the rig's]
    #[arg(long, value_name = "LAW", value_delimiter = ',', value_parser = law())]
    law: Vec<LawName>,
    /// How counts become position and speed [default: as each law is meant]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    observer: Option<ObserverName>,
    #[command(flatten)]
    by_hand: ByHandArgs,
    /// Transfer functions to follow it by, for pan and for tilt
    #[arg(long, num_args = 2, value_names = ["PAN", "TILT"], allow_hyphen_values = true)]
    controller: Vec<String>,
    /// Masses of one of the report's parameter sets, instead of the rig's
    #[arg(long, value_name = "A|B", value_enum, ignore_case = true)]
    set: Option<Set>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// Whether angles are seen in counts
    #[arg(long, value_name = "on|off", default_value = "on", value_parser = switch, action = ArgAction::Set)]
    quantizer: bool,
    /// Whether they are seen every millisecond only
    #[arg(long, value_name = "on|off", default_value = "on", value_parser = switch, action = ArgAction::Set)]
    hold: bool,
    /// Largest torque of the motors [default: as the rig's amplifiers allow]
    #[arg(long, value_name = "TORQUE", value_parser = torque)]
    cap: Option<f64>,
    /// Rest at the end
    #[arg(long, value_name = "TIME", default_value = "0.5s", value_parser = time)]
    rest: f64,
    /// Seed of what differs from head to head, and of a random motion
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot desired, actual, error and torque into an SVG or PNG, or write the first to a CSV, a row a millisecond; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// What joins rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Join {
    /// The smoothest curve through them
    Spline,
    /// Lines: the speed jumps at each
    Lines,
}

fn time(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    let longest_s = rows::LONGEST_S;
    if time_s <= longest_s { Ok(time_s) } else { Err(format!("{text} is more than {longest_s} s")) }
}

fn torque(text: &str) -> Result<f64, String> {
    const MOST_NM: f64 = 1e6;
    let torque_nm = above_zero(text, TORQUES)?;
    if torque_nm <= MOST_NM { Ok(torque_nm) } else { Err(format!("{text} is more than {MOST_NM} Nm")) }
}

/// Counts a turn of an encoder that hides nothing.
const FINE_COUNTS: u32 = 1_000_000;
/// Of a random motion.
const REACH_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Something the array was followed by, and how.
struct Entry {
    /// A law's name, or each joint's controller.
    by: PanTilt<String>,
    colour: Colour,
    ticks: Vec<ScopeTick>,
    figures: PanTilt<Figures>,
}

impl Entry {
    /// What it was followed by, in one.
    fn name(&self) -> String {
        let PanTilt { pan, tilt } = &self.by;
        if pan == tilt { pan.clone() } else { format!("{pan} on pan, {tilt} on tilt") }
    }
}

/// How a joint followed.
#[derive(Clone, Copy, Debug, Default)]
struct Figures {
    rms_rad: f64,
    max_rad: f64,
    /// Mean over the rest at the end.
    final_rad: f64,
    /// Share of the time that its torque was capped.
    capped: f64,
}

pub(crate) fn run(args: &SimulateArgs) -> Result<Answer, Failure> {
    let mut rig = rig(args)?;
    let laws = args.by_hand.apply(&mut rig, &Joint::BOTH, &args.law)?;
    let array = array(args, &rig)?;
    let entries = entries(args, &rig, &laws, &array)?;
    write_all(&args.out, || figure(args, &rig, &array, &entries), || Ok(csv(&entries)))?;
    Ok(Answer::either(args.voice, || text(args, &rig, &array, &entries), || json(args, &array, &entries)))
}

/// The rig as it is to be simulated.
fn rig(args: &SimulateArgs) -> Result<RigConfig, Failure> {
    let mut rig = named::rig(&args.rig)?;
    if let Some(set) = args.set {
        (rig.model.bodies, rig.truth.model.bodies) = (set.bodies(), set.bodies());
        rig.name += if set == Set::A { ", set A" } else { ", set B" };
    }
    for model in [&mut rig.model, &mut rig.truth.model] {
        if !args.quantizer {
            model.encoder.counts_per_rev = FINE_COUNTS;
        }
        if let Some(cap_nm) = args.cap {
            for joint in Joint::BOTH {
                let motor = &mut model.motors[joint];
                motor.limit_v = cap_nm / motor.torque_nm_per_v;
            }
        }
    }
    Ok(rig)
}

fn array(args: &SimulateArgs, rig: &RigConfig) -> Result<MotionArray, Failure> {
    let range_rad = rig.model.geometry.range_rad;
    let Some(path) = &args.array else {
        let reach = range_rad.map(|(lower, upper)| REACH_RAD.min(upper).min(-lower).max(0.0));
        let length_s = args.random.unwrap_or_default();
        return MotionArray::random(args.seed, length_s, reach)
            .map_err(|e| Failure::failed("motion-array", e));
    };
    let between = match args.between {
        Join::Spline => Between::Spline,
        Join::Lines => Between::Lines,
    };
    rows::read(path, between, range_rad)
}

fn entries(
    args: &SimulateArgs,
    rig: &RigConfig,
    laws: &[LawName],
    array: &MotionArray,
) -> Result<Vec<Entry>, Failure> {
    let mut runs = Vec::new();
    if let [pan, tilt] = args.controller.as_slice() {
        let controllers = PanTilt::new(controller(pan)?, controller(tilt)?);
        let by = PanTilt::new(pan.clone(), tilt.clone());
        runs.push((by, by_controllers(args, rig, array, controllers)?));
    }
    if !args.hold && (runs.is_empty() || !laws.is_empty()) {
        let message = "--hold off is for a --controller: a law is a program that runs every millisecond";
        return Err(Failure::usage("usage", message));
    }
    let own = [rig.control.law];
    let named = if laws.is_empty() && runs.is_empty() { &own[..] } else { laws };
    for &law in named {
        let mut rig = rig.clone();
        choose(&mut rig, law, args.observer);
        runs.push((PanTilt::from_fn(|_| law.name().to_owned()), by_law(args, &rig, array)));
    }
    let entry = |((by, ticks), colour): ((PanTilt<String>, Vec<ScopeTick>), Colour)| {
        let figures = PanTilt::from_fn(|j| figures(args, rig, &ticks, j));
        Entry { by, colour, ticks, figures }
    };
    let sound = |tick: &ScopeTick| {
        Joint::BOTH.iter().all(|&j| tick.angle_rad[j].is_finite() && tick.torque_nm[j].is_finite())
    };
    if let Some((by, _)) = runs.iter().find(|(_, ticks)| !ticks.iter().all(sound)) {
        let message = format!("{}: the angles grow beyond all numbers: less gain, or a lower --cap", by.pan);
        return Err(Failure::failed("no-such-design", message));
    }
    Ok(runs.into_iter().zip(Colour::in_turn()).map(entry).collect())
}

fn by_law(args: &SimulateArgs, rig: &RigConfig, array: &MotionArray) -> Vec<ScopeTick> {
    let ticks = follow_array(rig, array, args.rest, args.seed);
    let shown = |(number, tick): (usize, &tracelight_sim::BenchTick)| ScopeTick {
        set_rad: array.at(number as f64 * TICK_F64_S).map(|motion| motion.position_rad),
        angle_rad: tick.angle_rad,
        torque_nm: PanTilt::from_fn(|j| f64::from(tick.command_v[j]) * rig.model.motors[j].torque_nm_per_v),
    };
    ticks.iter().enumerate().map(shown).collect()
}

fn by_controllers(
    args: &SimulateArgs,
    rig: &RigConfig,
    array: &MotionArray,
    controllers: PanTilt<Zpk>,
) -> Result<Vec<ScopeTick>, Failure> {
    let diagram = Diagram {
        head: rig.truth.model,
        controllers,
        cap_nm: cap_nm(rig),
        quantum_rad: args.quantizer.then(|| rig.truth.model.encoder.count_rad()),
        hold_ticks: args.hold.then_some(1),
    };
    diagram.follow(array, args.rest).map_err(|e| {
        Failure::failed(
            "no-such-design",
            format!("--controller: {e}; give a derivative a filter, such as s/(1 + s/50)"),
        )
    })
}

fn cap_nm(rig: &RigConfig) -> PanTilt<f64> {
    rig.model.motors.map(|motor| motor.torque_limit_nm())
}

fn figures(args: &SimulateArgs, rig: &RigConfig, ticks: &[ScopeTick], joint: Joint) -> Figures {
    let errors = ticks.iter().map(|tick| tick.set_rad[joint] - tick.angle_rad[joint]);
    let (count, cap) = (ticks.len().max(1) as f64, (1.0 - 1e-6) * cap_nm(rig)[joint]);
    let rest = (0.5 * args.rest / TICK_F64_S).ceil() as usize;
    let last = errors.clone().skip(ticks.len().saturating_sub(rest));
    Figures {
        rms_rad: (errors.clone().map(|e| e * e).sum::<f64>() / count).sqrt(),
        max_rad: errors.map(f64::abs).fold(0.0, f64::max),
        final_rad: last.clone().map(f64::abs).sum::<f64>() / last.count().max(1) as f64,
        capped: ticks.iter().filter(|tick| tick.torque_nm[joint].abs() >= cap).count() as f64 / count,
    }
}

fn mm(angle_rad: f64) -> f64 {
    1e3 * DEFAULT_DISTANCE_M * angle_rad
}

fn text(args: &SimulateArgs, rig: &RigConfig, array: &MotionArray, entries: &[Entry]) -> String {
    let what = args.array.clone().unwrap_or_else(|| format!("a random motion (seed {})", args.seed));
    let seen = match (args.quantizer, args.hold) {
        (true, true) => "seen in counts, every millisecond",
        (true, false) => "seen in counts, at once",
        (false, true) => "seen as they are, every millisecond",
        (false, false) => "seen as they are, at once",
    };
    let mut text = format!(
        "{what}, {:.3} s and {} s of rest, on rig {}, angles {seen}\n\n{:28} {:>16} {:>16} {:>16} {:>10}",
        array.length_s(),
        args.rest,
        rig.name,
        "",
        "error rms, mrad",
        "at most, mrad",
        "at rest, mrad",
        "capped, %"
    );
    for entry in entries {
        for joint in Joint::BOTH {
            let figures = &entry.figures[joint];
            let name = format!("{joint}, {}", entry.by[joint]);
            let shown =
                if name.chars().count() > 28 { format!("{name}\n{:28}", "") } else { format!("{name:28}") };
            // writing to a String cannot fail
            let _ = write!(
                text,
                "\n{shown} {:16.3} {:16.3} {:16.3} {:10.1}",
                1e3 * figures.rms_rad,
                1e3 * figures.max_rad,
                1e3 * figures.final_rad,
                100.0 * figures.capped
            );
        }
    }
    text += "\n\nA mrad is 0.91 mm on a target 3 ft away.";
    if !args.controller.is_empty() && rig.truth.wear != tracelight_plant::Wear::NONE {
        text += " The --controller drives a new head: wear is left out.";
    }
    text
}

fn json(args: &SimulateArgs, array: &MotionArray, entries: &[Entry]) -> String {
    let joint = |figures: &Figures| {
        json!({
            "rms_rad": figures.rms_rad, "max_rad": figures.max_rad, "final_error_rad": figures.final_rad,
            "rms_mm": mm(figures.rms_rad), "max_mm": mm(figures.max_rad), "final_error_mm": mm(figures.final_rad),
            "capped_share": figures.capped,
        })
    };
    let one = |entry: &Entry| json!({"by": entry.name(), "pan": joint(&entry.figures.pan), "tilt": joint(&entry.figures.tilt)});
    json!({
        "length_s": array.length_s(),
        "seed": args.seed,
        "runs": entries.iter().map(one).collect::<Vec<_>>(),
    })
    .to_string()
}

fn csv(entries: &[Entry]) -> String {
    let mut text = String::from(
        "t_s,pan_set_rad,tilt_set_rad,pan_rad,tilt_rad,pan_error_rad,tilt_error_rad,pan_nm,tilt_nm\n",
    );
    let first = entries.first().map_or(&[][..], |entry| &entry.ticks);
    for (number, ScopeTick { set_rad, angle_rad, torque_nm }) in first.iter().enumerate() {
        let _ = writeln!(
            text,
            "{:.3},{:.7},{:.7},{:.7},{:.7},{:.7},{:.7},{:.6},{:.6}",
            number as f64 * TICK_F64_S,
            set_rad.pan,
            set_rad.tilt,
            angle_rad.pan,
            angle_rad.tilt,
            set_rad.pan - angle_rad.pan,
            set_rad.tilt - angle_rad.tilt,
            torque_nm.pan,
            torque_nm.tilt,
        );
    }
    text
}

/// Something of a joint in each tick.
type Value = fn(&ScopeTick, Joint) -> f64;

fn figure(
    args: &SimulateArgs,
    rig: &RigConfig,
    array: &MotionArray,
    entries: &[Entry],
) -> Result<String, Failure> {
    // as many points as a panel is wide
    const POINTS: usize = 600;
    let longest = entries.iter().map(|entry| entry.ticks.len()).max().unwrap_or(1);
    let every = (longest / POINTS).max(1);
    let curve = |entry: &Entry, colour: Colour, joint: Joint, value: Value| {
        let ticks = entry.ticks.iter().enumerate().step_by(every);
        let points = ticks.map(|(number, tick)| (number as f64 * TICK_F64_S, value(tick, joint)));
        Curve { colour, pen: Pen::Solid, points: points.collect() }
    };
    let angle: Value = |tick, j| tick.angle_rad[j].to_degrees();
    let error: Value = |tick, j| 1e3 * (tick.set_rad[j] - tick.angle_rad[j]);
    let effort: Value = |tick, j| tick.torque_nm[j];
    let set: Value = |tick, j| tick.set_rad[j].to_degrees();
    let of_all = |joint: Joint, value: Value| -> Vec<Curve> {
        // the first on top
        entries.iter().rev().map(|entry| curve(entry, entry.colour, joint, value)).collect()
    };
    let angles = |joint: Joint| {
        let mut curves = of_all(joint, angle);
        curves.extend(
            entries
                .first()
                .map(|entry| Curve { pen: Pen::Dashed, ..curve(entry, Colour::Black, joint, set) }),
        );
        over_time(format!("{joint}, °"), Vec::new(), curves)
    };
    let errors = |joint: Joint| over_time(format!("{joint} error, mrad"), vec![0.0], of_all(joint, error));
    let efforts = |joint: Joint| over_time(format!("{joint} torque, N m"), Vec::new(), of_all(joint, effort));
    let panels: Vec<Panel> = [Joint::BOTH.map(angles), Joint::BOTH.map(errors), Joint::BOTH.map(efforts)]
        .into_iter()
        .flatten()
        .collect();
    let mut legend: Vec<Key> =
        entries.iter().map(|entry| Key { colour: entry.colour, name: entry.name() }).collect();
    legend.push(Key { colour: Colour::Black, name: "dashed: desired".into() });
    let what = args.array.as_deref().unwrap_or("A random motion");
    let figure = Figure {
        title: format!("{what}, {:.3} s, on rig {}", array.length_s(), rig.name),
        legend,
        panels,
        columns: 2,
        panel: (600, 260),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
