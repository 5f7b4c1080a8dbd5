use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Figure, Key, Mark, Panel, Sign, Theme};
use tracelight_lab::{EdgeTime, EncoderTable, Spin, encoder_table, spin};
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{Mounting, RigConfig, head_alone};
use tracelight_task::{Failure, counted};
use tracelight_units::{ANGULAR_SPEEDS, parse};

use super::friction::HOW_SURE;
use super::parts::{self, by_joint, leave, rounded, tell_each};
use super::step::Axis;
use crate::cli::{Answer, Voice};
use crate::named;
use crate::table;

/// Identify what an encoder reads wrong: where its four kinds of edges lie, a disc beside its axis, counts it lost
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab encoder --rig worn\n\n\
                  A joint turns evenly, once each way, and every edge is stamped with its time; a smooth motion through the edges about an edge tells \
                  how far that one lies beside its place. Misplaced edges repeat every four counts, a disc that sits beside its axis every turn; counts \
                  that are lost shift all that follow. A log has a row each edge: axis,time_s,count: when it came, and what the counter said then; a \
                  time that goes back begins another run. Given no log, the simulated head is tried in a fixture, each axis upright and free; its ticks \
                  tell the last edge of each. Without stamps an edge is known to a tick: turn slowly. Counts lost between two runs no edge can tell: `tracelight lab backlash` can. \
                  The folder gets encoder.svg, and edges.csv, if the head was tried.")]
pub(crate) struct EncoderArgs {
    /// Logs of edges: axis,time_s,count
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// Only this joint [default: both]
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// How fast the simulated head turns
    #[arg(long, value_name = "SPEED", default_value = "3rad/s", value_parser = speed)]
    speed: f64,
    /// How many turns each way
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=200))]
    turns: u32,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/encoder")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn speed(text: &str) -> Result<f64, String> {
    let rad_s = parse(text, ANGULAR_SPEEDS).map_err(|e| e.to_string())?;
    if (0.05..=50.0).contains(&rad_s) {
        Ok(rad_s)
    } else {
        Err(format!("{text} is not between 0.05 and 50 rad/s"))
    }
}

type Found = parts::Found<Vec<EdgeTime>, EncoderTable>;

pub(crate) fn run(args: &EncoderArgs) -> Result<Answer, Failure> {
    let rig = named::rig(&args.rig)?;
    let runs =
        if args.logs.is_empty() { PanTilt::from_fn(|joint| tried(args, &rig, joint)) } else { logged(args)? };
    let count_rad = rig.model.encoder.count_rad();
    let tell = |joint: Joint, runs: &[Vec<EdgeTime>]| {
        encoder_table(runs, count_rad).ok_or_else(|| {
            let most = runs.iter().map(Vec::len).max().unwrap_or_default();
            let message = format!(
                "{joint}: the longest run one way has {most} edges; 192 are needed, at times that rise, of all four kinds: turn it further"
            );
            Failure::failed("encoder", message)
        })
    };
    let nothing = || {
        let message = format!("{}: no edge of the joint that is asked for", args.logs.join(", "));
        Failure::usage("encoder-log", message)
    };
    let found = tell_each(args.axis, runs, tell, nothing)?;
    let mut files = vec![("encoder.svg", figure(&rig, &found)?)];
    if args.logs.is_empty() {
        files.push(("edges.csv", csv(&found)));
    }
    leave(&args.out, &files)?;
    Ok(Answer::either(args.voice, || text(args, &rig, &found), || json(&found)))
}

/// The simulated head turned one way and the other.
fn tried(args: &EncoderArgs, rig: &RigConfig, joint: Joint) -> Vec<Vec<EdgeTime>> {
    let motor = rig.model.motors[joint];
    let mut head = head_alone(rig, joint, Mounting::Fixture, args.seed);
    let mut turn = |rate_rad_s: f64| {
        let hold_v = motor.volts_for(rig.model.friction[joint].torque(rate_rad_s));
        // gently, where it is to turn slowly
        let start_v = (2.0 + rate_rad_s.abs()) * hold_v.abs().max(0.01 * motor.limit_v);
        let how = Spin {
            start_v: start_v.min(0.5 * motor.limit_v).copysign(rate_rad_s),
            hold_v,
            rate_rad_s,
            count_rad: rig.model.encoder.count_rad(),
            turns: f64::from(args.turns),
        };
        spin(&mut head, joint, &how)
    };
    vec![turn(args.speed), turn(-args.speed)]
}

/// Where a log's last row of a joint was.
#[derive(Clone, Copy)]
struct Last {
    time_s: f64,
    count: i32,
    /// Which way it had come there; 0 if nobody knows.
    way: i32,
}

fn logged(args: &EncoderArgs) -> Result<PanTilt<Vec<Vec<EdgeTime>>>, Failure> {
    let mut runs: PanTilt<Vec<Vec<EdgeTime>>> = PanTilt::default();
    for path in &args.logs {
        let mut before: PanTilt<Option<Last>> = PanTilt::default();
        table::read(
            path,
            "encoder-log",
            |names| names.all(["axis", "time_s", "count"]),
            |&[axis, time, count], row| {
                let joint = row.joint(axis)?;
                let (time_s, count) = (row.number(time)?, row.whole(count)?);
                let last = before[joint].replace(Last { time_s, count, way: 0 });
                // a time that goes back begins a run, of which the first row tells no way
                let Some(last) = last.filter(|last| last.time_s <= time_s) else {
                    runs[joint].push(Vec::new());
                    return Ok(());
                };
                let way = (i64::from(count) - i64::from(last.count)).signum() as i32;
                before[joint] = Some(Last { time_s, count, way: if way == 0 { last.way } else { way } });
                if way == 0 {
                    return Ok(());
                }
                if way == -last.way {
                    runs[joint].push(Vec::new());
                }
                // the edge that was crossed last is on the side it came from
                let edge = EdgeTime { time_s, edge: if way > 0 { count } else { count.wrapping_add(1) } };
                runs[joint].last_mut().into_iter().for_each(|run| run.push(edge));
                Ok(())
            },
        )?;
    }
    for joint in Joint::BOTH {
        runs[joint].retain(|run| !run.is_empty());
    }
    Ok(runs)
}

fn text(args: &EncoderArgs, rig: &RigConfig, found: &[Found]) -> String {
    let mut text = if args.logs.is_empty() {
        let stamps = if rig.model.encoder.edge_stamps { "" } else { ", edges not stamped" };
        format!(
            "rig {}, in a fixture, {} each way at about {} rad/s{stamps}",
            rig.name,
            counted(args.turns as usize, "turn"),
            args.speed
        )
    } else {
        format!("{}, on rig {}", args.logs.join(", "), rig.name)
    };
    for Found { joint, told: table, .. } in found {
        // writing to a String cannot fail
        let _ = write!(text, "\n\n{:44} {:>18}", joint.name(), "found, counts");
        for (kind, edge) in table.kinds_counts.iter().enumerate() {
            let what = format!("edges below counts {kind}, {}, {} … lie beyond", kind + 4, kind + 8);
            let _ = write!(
                text,
                "\n{what:44} {:>18}",
                format!("{} ± {:.4}", rounded(edge.value, 4), edge.within)
            );
        }
        match table.eccentricity {
            Some((amplitude, at_rad)) => {
                let cell = format!("{:.4} ± {:.4}", amplitude.value, amplitude.within);
                let what = format!("disc beside its axis: most at {:.0}°", at_rad.to_degrees());
                let _ = write!(text, "\n{what:44} {cell:>18}");
            }
            None => text += "\nless than two turns one way tell nothing of a disc beside its axis",
        }
        let _ = write!(text, "\n{} edges, {:.4} counts rms beside this. ", table.edges, table.left_counts);
        text += &lost(table);
    }
    text + HOW_SURE
}

fn lost(table: &EncoderTable) -> String {
    const SHOWN: usize = 5;
    if table.lost.is_empty() {
        return "No count was lost on the way.".into();
    }
    let one = |lost: &tracelight_lab::Lost| {
        let (size, what) = (lost.counts.abs(), if lost.counts > 0 { "lost" } else { "too many" });
        format!("{size} {what} at {:.3} s (count {})", lost.time_s, lost.count)
    };
    let shown: Vec<String> = table.lost.iter().take(SHOWN).map(one).collect();
    let more = table.lost.len().saturating_sub(SHOWN);
    let more = if more > 0 { format!(", and {more} times more") } else { String::new() };
    format!("Counts: {}{more}.", shown.join("; "))
}

fn json(found: &[Found]) -> String {
    let one = |Found { joint, told: table, .. }: &Found| {
        let lost = |lost: &tracelight_lab::Lost| json!({"t_s": lost.time_s, "count": lost.count, "counts": lost.counts});
        let object = json!({
            "edges": table.edges,
            "kinds_counts": table.kinds_counts.map(|u| u.value),
            "eccentricity_counts": table.eccentricity.map(|(u, _)| u.value),
            "eccentricity_at_rad": table.eccentricity.map(|(_, at)| at),
            "lost": table.lost.iter().map(lost).collect::<Vec<_>>(),
            "left_counts": table.left_counts,
            "within": {
                "kinds_counts": table.kinds_counts.map(|u| u.within),
                "eccentricity_counts": table.eccentricity.map(|(u, _)| u.within),
            },
        });
        (*joint, object)
    };
    by_joint(found.iter().map(one))
}

fn csv(found: &[Found]) -> String {
    let mut text = String::from("axis,time_s,count\n");
    for Found { joint, seen: runs, .. } in found {
        for run in runs {
            let up = run.first().zip(run.last()).is_some_and(|(first, last)| last.edge >= first.edge);
            for edge in run {
                let count = if up { edge.edge } else { edge.edge.wrapping_sub(1) };
                let _ = writeln!(text, "{joint},{:.8},{count}", edge.time_s);
            }
        }
    }
    text
}

/// What each kind lies beyond its place.
fn figure(rig: &RigConfig, found: &[Found]) -> Result<String, Failure> {
    let panel = |Found { joint, told: table, .. }: &Found| {
        let marks = table.kinds_counts.iter().enumerate().flat_map(|(kind, edge)| {
            let at = |value: f64, sign| Mark { colour: Colour::Blue, sign, at: (kind as f64, value) };
            [
                at(edge.value, Sign::Dot),
                at(edge.value - edge.within, Sign::Cross),
                at(edge.value + edge.within, Sign::Cross),
            ]
        });
        let widest = table.kinds_counts.iter().map(|k| k.value.abs() + k.within).fold(0.02, f64::max);
        Panel {
            x_title: format!("{joint}: count below which the edge lies, mod 4"),
            y_title: "beyond its place, counts".into(),
            marks: marks.collect(),
            levels: vec![0.0],
            view: Some([(-0.5, 3.5), (-1.2 * widest, 1.2 * widest)]),
            ..Panel::default()
        }
    };
    let figure = Figure {
        title: format!("Encoder edges of rig {}", rig.name),
        legend: vec![Key::new(Colour::Blue, "found (crosses: 95 of 100 cases)")],
        panels: found.iter().map(panel).collect(),
        columns: found.len(),
        panel: (520, 340),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
