use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Figure, Key, Mark, Panel, Sign, Theme};
use tracelight_lab::{Backlash, SpotPoint, Uncertain, backlash};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{Between, LawName, MotionArray, RigConfig, follow_array};
use tracelight_task::Failure;
use tracelight_units::{LENGTHS, Length};

use super::above_zero;
use super::friction::HOW_SURE;
use super::parts::{self, by_joint, leave, rounded, tell_each};
use super::step::Axis;
use crate::cli::laws::choose;
use crate::cli::{Answer, Voice};
use crate::named;
use crate::table;

/// Identify the play between encoder and beam, and whether the encoder slips, from where the spot rests on a ruler
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab backlash --rig worn --axis pan\n\n\
                  An encoder does not see what lies behind it: play in gears and belts, a disc that slips on its axis, counts that get lost. The spot does. \
                  A joint goes to the same places from below and from above, the other one straight ahead, and each time it rests the spot is read \
                  off a ruler on the target. A log has a row each reading, in order: axis,count,way,spot_m: the encoder's count, 1 or -1 for where it \
                  came from (turning positively or negatively), and where the spot is, x for pan, y for tilt, as this program counts them (right \
                  and up). A joint must rest at its place to a small part of a count, from either side: what stops short looks like play. Given no log, the \
                  simulated head is tried, by law state. The folder gets backlash.svg, and readings.csv, if the head was tried.")]
pub(crate) struct BacklashArgs {
    /// Logs of readings: axis,count,way,spot_m
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// Only this joint [default: both]
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// From the head to the target, square-on
    #[arg(long, value_name = "LENGTH", default_value = "3ft")]
    distance: Length,
    /// What the ruler is read to, where the simulated head is tried
    #[arg(long, value_name = "LENGTH", default_value = "0.5mm", value_parser = fine)]
    ruler: f64,
    /// How often each place is gone to from either side
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=50))]
    cycles: u32,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/backlash")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn fine(text: &str) -> Result<f64, String> {
    above_zero(text, LENGTHS)
}

/// A reading: what a log's row says.
#[derive(Clone, Copy)]
struct Reading {
    count: i32,
    way: i32,
    spot_m: f64,
}

type Found = parts::Found<Reading, Backlash>;

pub(crate) fn run(args: &BacklashArgs) -> Result<Answer, Failure> {
    let rig = named::rig(&args.rig)?;
    if args.distance.0 <= 0.0 {
        return Err(Failure::usage("usage", "--distance must be above zero"));
    }
    let readings =
        if args.logs.is_empty() { PanTilt::from_fn(|joint| tried(args, &rig, joint)) } else { logged(args)? };
    let count_rad = rig.model.encoder.count_rad();
    let tell = |joint: Joint, readings: &[Reading]| {
        let points: Vec<SpotPoint> = readings.iter().map(|r| point(r, count_rad)).collect();
        backlash(&points, args.distance.0).ok_or_else(|| {
            let count = points.len();
            let message = format!(
                "{joint}: {count} readings tell no play; give four at least, from both sides, in turns"
            );
            Failure::failed("backlash", message)
        })
    };
    let nothing = || {
        let message = format!("{}: no reading of the joint that is asked for", args.logs.join(", "));
        Failure::usage("backlash-log", message)
    };
    let found = tell_each(args.axis, readings, tell, nothing)?;
    let mut files = vec![("backlash.svg", figure(args, &rig, &found)?)];
    if args.logs.is_empty() {
        files.push(("readings.csv", csv(&found)));
    }
    leave(&args.out, &files)?;
    Ok(Answer::either(args.voice, || text(args, &rig, &found), || json(args, &rig, &found)))
}

fn point(reading: &Reading, count_rad: f64) -> SpotPoint {
    SpotPoint {
        angle_rad: f64::from(reading.count) * count_rad,
        way: f64::from(reading.way),
        spot_m: reading.spot_m,
    }
}

/// Readings of the simulated head, driven by the law that rests where it should: what rests a little before it, from either side, looks
/// like play.
fn tried(args: &BacklashArgs, rig: &RigConfig, joint: Joint) -> Vec<Reading> {
    let mut rig = rig.clone();
    choose(&mut rig, LawName::State, None);
    let rig = &rig;
    const PLACES: i32 = 9;
    const REACH_RAD: f64 = 0.3;
    /// How far off it goes before it comes from that side, rad.
    const RUN_RAD: f64 = 0.06;
    const MOVE_S: f64 = 0.5;
    const REST_S: f64 = 0.4;
    let (lower, upper) = rig.model.geometry.range_rad[joint];
    let reach = REACH_RAD.min(0.8 * upper).min(-0.8 * lower).max(0.0);
    let places = (0..PLACES).map(|k| reach * f64::from(2 * k - PLACES + 1) / f64::from(PLACES - 1));
    let visits = places.flat_map(|place| [(place, 1), (place, -1)]);
    // two counts further each time, so that the ruler's marks lie elsewhere
    let shifted = |cycle: u32| {
        let by = f64::from(2 * (cycle % 3)) * rig.model.encoder.count_rad();
        visits.clone().map(move |(place, way)| (place + by, way))
    };
    let visits: Vec<(f64, i32)> = (0..args.cycles).flat_map(shifted).collect();
    let mut rows = vec![(0.0, 0.0)];
    let mut rests = Vec::new();
    for &(place, way) in &visits {
        for to in [place - f64::from(way) * RUN_RAD, place] {
            travel(&mut rows, to, (MOVE_S, REST_S));
        }
        rests.push((rows.last().map_or(0.0, |row| row.0), way));
    }
    let with = |angle: f64| {
        let mut both = PanTilt::default();
        both[joint] = angle;
        both
    };
    let rows: Vec<(f64, PanTilt<f64>)> = rows.into_iter().map(|(t, angle)| (t, with(angle))).collect();
    // rows rise and are finite by how they are made
    let Ok(array) = MotionArray::new(&rows, Between::Spline) else { return Vec::new() };
    let ticks = follow_array(rig, &array, 0.1, args.seed);
    let read = |&(time_s, way): &(f64, i32)| {
        let tick = ticks.get((time_s / TICK_F64_S) as usize)?;
        let spot_m = -args.distance.0 * tick.beam_rad[joint].tan();
        let spot_m = (spot_m / args.ruler).round() * args.ruler;
        Some(Reading { count: tick.measured[joint].count, way, spot_m })
    };
    rests.iter().filter_map(read).collect()
}

/// A move from where the rows end, from rest to rest, and a rest.
fn travel(rows: &mut Vec<(f64, f64)>, to: f64, (move_s, rest_s): (f64, f64)) {
    const STEPS: i32 = 20;
    let (start_s, from) = rows.last().copied().unwrap_or_default();
    for k in 1..=STEPS {
        let x = f64::from(k) / f64::from(STEPS);
        let share = x - (TAU * x).sin() / TAU;
        rows.push((start_s + move_s * x, from + share * (to - from)));
    }
    // a rest that a spline keeps
    rows.extend([0.02, 0.5 * rest_s, rest_s].map(|s| (start_s + move_s + s, to)));
}

fn logged(args: &BacklashArgs) -> Result<PanTilt<Vec<Reading>>, Failure> {
    const MOST_M: f64 = 1e3;
    let mut readings: PanTilt<Vec<Reading>> = PanTilt::default();
    for path in &args.logs {
        table::read(
            path,
            "backlash-log",
            |names| names.all(["axis", "count", "way", "spot_m"]),
            |&[axis, count, way, spot], row| {
                let came = row.whole(way)?;
                if came.abs() != 1 {
                    return Err(format!(":{}: way {came} is neither 1 nor -1", row.line));
                }
                readings[row.joint(axis)?].push(Reading {
                    count: row.whole(count)?,
                    way: came,
                    spot_m: row.up_to(spot, MOST_M, "any target is wide")?,
                });
                Ok(())
            },
        )?;
    }
    Ok(readings)
}

fn text(args: &BacklashArgs, rig: &RigConfig, found: &[Found]) -> String {
    let count_rad = rig.model.encoder.count_rad();
    let mut text = if args.logs.is_empty() {
        format!(
            "rig {}, {} ft from the target, a ruler read to {} mm, each place {} times from either side",
            rig.name,
            shortened(args.distance.0 / 0.3048),
            shortened(1e3 * args.ruler),
            args.cycles
        )
    } else {
        format!("{}, on rig {}", args.logs.join(", "), rig.name)
    };
    for Found { joint, told: backlash, seen: readings } in found {
        // writing to a String cannot fail
        let _ = write!(
            text,
            "\n\n{:24} {:>18} {:>18} {:>18}",
            joint.name(),
            "mrad",
            "mm on the target",
            "counts"
        );
        let rows = [
            ("play", backlash.play_rad),
            ("beam ahead of encoder", backlash.zero_rad),
            ("further at the end", backlash.slip_rad),
        ];
        for (what, rad) in rows {
            let cell = |scale: f64| format!("{} ± {:.3}", rounded(scale * rad.value, 3), scale * rad.within);
            let _ = write!(
                text,
                "\n{what:24} {:>18} {:>18} {:>18}",
                cell(1e3),
                cell(1e3 * args.distance.0),
                cell(1.0 / count_rad)
            );
        }
        let _ = write!(
            text,
            "\n{} readings, {:.3} mm rms beside this.{}",
            readings.len(),
            1e3 * args.distance.0 * backlash.left_rad,
            verdict(backlash)
        );
    }
    text + HOW_SURE
}

/// A number without zeros behind it.
fn shortened(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn verdict(backlash: &Backlash) -> String {
    let sure = |u: Uncertain| u.value.abs() > u.within;
    let play = if backlash.play_rad.value > backlash.play_rad.within {
        ""
    } else {
        " No play that these readings could tell."
    };
    let slip = if sure(backlash.slip_rad) {
        " The encoder slips, or loses counts: its disc, its set-screw, its cable."
    } else {
        " The encoder does not slip."
    };
    format!("{play}{slip}")
}

fn json(args: &BacklashArgs, rig: &RigConfig, found: &[Found]) -> String {
    let count_rad = rig.model.encoder.count_rad();
    let one = |Found { joint, told: backlash, seen: readings }: &Found| {
        let object = json!({
            "play_rad": backlash.play_rad.value,
            "play_mm": 1e3 * args.distance.0 * backlash.play_rad.value,
            "zero_rad": backlash.zero_rad.value,
            "slip_rad": backlash.slip_rad.value,
            "slip_counts": backlash.slip_rad.value / count_rad,
            "slips": backlash.slip_rad.value.abs() > backlash.slip_rad.within,
            "left_rad": backlash.left_rad,
            "readings": readings.len(),
            "within": {
                "play_rad": backlash.play_rad.within,
                "zero_rad": backlash.zero_rad.within,
                "slip_rad": backlash.slip_rad.within,
            },
        });
        (*joint, object)
    };
    by_joint(found.iter().map(one))
}

fn csv(found: &[Found]) -> String {
    let mut text = String::from("axis,count,way,spot_m\n");
    for Found { joint, seen: readings, .. } in found {
        for reading in readings {
            let _ = writeln!(text, "{joint},{},{},{:.6}", reading.count, reading.way, reading.spot_m);
        }
    }
    text
}

/// How far the beam is ahead of the encoder, reading by reading, from the mean of each place.
fn figure(args: &BacklashArgs, rig: &RigConfig, found: &[Found]) -> Result<String, Failure> {
    let panel = |Found { joint, seen: readings, told: backlash }: &Found| {
        let mark = |(number, (reading, beside)): (usize, (&Reading, &Option<f64>))| {
            let colour = if reading.way > 0 { Colour::Blue } else { Colour::Vermilion };
            let at = (number as f64 + 1.0, 1e3 * args.distance.0 * (*beside)?);
            Some(Mark { colour, sign: Sign::Dot, at })
        };
        let half = 500.0 * args.distance.0 * backlash.play_rad.value;
        let shown = readings.iter().zip(&backlash.beside_rad).enumerate();
        Panel {
            x_title: format!("{joint}: reading"),
            y_title: "beam ahead of encoder, from its place's mean, mm".into(),
            marks: shown.filter_map(mark).collect(),
            levels: vec![-half, half],
            ..Panel::default()
        }
    };
    let figure = Figure {
        title: format!("Play and slip of rig {}", rig.name),
        legend: vec![
            Key::new(Colour::Blue, "come turning positively"),
            Key::new(Colour::Vermilion, "come turning negatively"),
        ],
        panels: found.iter().map(panel).collect(),
        columns: found.len(),
        panel: (560, 320),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
