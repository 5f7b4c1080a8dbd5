use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use tracelight_files as files;
use tracelight_lab::{Identification, JointFit, identify, routine};
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_rig::{Joint, TICK_F64_S, Telemetry};
use tracelight_sim::{RigConfig, SimulatedRig, run_segments};
use tracelight_task::{Failure, Stop, Task};

use super::{make_folder, rig_out, why_unfinished};
use crate::bar::Bar;
use crate::cli::laws::LawArgs;
use crate::cli::{Answer, Voice};
use crate::named;
use crate::record;

/// Identify what the head is made of: inertia, friction, weight, amplifier, where its encoders' edges lie
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab identify --rig worn --out out/worn\n\n\
                  Without a RECORD.csv the rig moves for some 45 s in the dark, both joints through ±26° or what their range \
                  allows. What is found goes to rig.toml in --out, for --rig of all commands. A fit that explains a third of \
                  the motion, kept from it, worse than what is believed already is refused.\n\n\
                  Counts and volts tell ratios only: twice the inertia, friction and weight with twice the torque per volt \
                  move alike. What that leaves open is shared out as if inertia and weight were known within 5 %, the torque \
                  per volt within 20 %. Play between encoder and beam cannot be seen by an encoder.")]
pub(crate) struct IdentifyArgs {
    /// Records of what the rig did, such as a trace.csv; given none, the rig moves
    #[arg(value_name = "RECORD.csv")]
    records: Vec<String>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    #[command(flatten)]
    law: LawArgs,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for rig.toml, and for record.csv where the rig moved
    #[arg(long, value_name = "DIR", default_value = "out/identify")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Least swing that tells anything: twenty counts of the original rig.
const LEAST_SWING_RAD: f64 = 0.05;

pub(crate) fn run(args: &IdentifyArgs, stop: &Stop) -> Result<Answer, Failure> {
    let mut rig = named::rig(&args.rig)?;
    rig_out::may_save(&args.rig, args.save)?;
    args.law.apply(&mut rig);
    let records = if args.records.is_empty() { vec![moved(args, &rig, stop)?] } else { read(args, &rig)? };
    let ticks: usize = records.iter().map(Vec::len).sum();
    let mut found = identify(&rig, &records).map_err(|e| Failure::failed("identify", e))?;
    if Joint::BOTH.iter().any(|&j| found.joints[j].taken) {
        named::date_rig(&mut found.rig);
    }
    let written = write(args, &rig, &found, &records)?;
    Ok(Answer::new(table(&rig, &found, ticks) + &written, json(&rig, &found)))
}

fn read(args: &IdentifyArgs, rig: &RigConfig) -> Result<Vec<Vec<Telemetry>>, Failure> {
    let count_rad = rig.model.encoder.count_rad();
    let mut all = Vec::new();
    for path in &args.records {
        all.extend(record::read(path, count_rad)?);
    }
    Ok(all)
}

/// The routine on the simulated rig, dark.
fn moved(args: &IdentifyArgs, rig: &RigConfig, stop: &Stop) -> Result<Vec<Telemetry>, Failure> {
    let narrow = Joint::BOTH.into_iter().find(|&j| {
        let (lower, upper) = rig.model.geometry.range_rad[j];
        upper.min(-lower) < LEAST_SWING_RAD
    });
    if let Some(joint) = narrow {
        let (lower, upper) = rig.model.geometry.range_rad[joint];
        let message = format!(
            "{joint} may turn from {lower} to {upper} rad, and has to swing {LEAST_SWING_RAD} rad to either side of zero to be \
             identified; give a record of a motion it can make"
        );
        return Err(Failure::failed("identify", message));
    }
    let segments = routine(rig);
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    task.stage("moves", segments.last().map_or(0, |s| u64::from(s.end_tick())));
    let pose = tracelight_aim::HeadPose::square_on(DEFAULT_DISTANCE_M);
    let mut simulated = SimulatedRig::new(&rig.following(), pose, args.seed);
    let run = run_segments(&mut simulated, &segments, true, |_, tick| {
        task.at(u64::from(tick.telemetry.tick));
        if stop.is_wanted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    stop.check()?;
    if !run.is_done() {
        let message = format!(
            "the head did not finish its motion ({}): its model may be too far off; correct torque_per_volt and friction in \
             the rig file, or give a record of a motion it can make",
            why_unfinished(run.fault())
        );
        return Err(Failure::failed("unfinished", message));
    }
    Ok(run.telemetry())
}

fn write(
    args: &IdentifyArgs,
    rig: &RigConfig,
    found: &Identification,
    records: &[Vec<Telemetry>],
) -> Result<String, Failure> {
    make_folder(&args.out, "--out")?;
    let path = |name: &str| args.out.join(name).display().to_string();
    if let ([], [record]) = (args.records.as_slice(), records) {
        files::write(&path("record.csv"), record::write(record))?;
    }
    rig_out::write(&args.out, &args.rig, args.save, (rig, &found.rig))
}

/// A figure of a joint.
type Value = fn(&RigConfig, Joint) -> f64;

/// Name in JSON, where it is plain SI; words for the table; by how much it is multiplied there.
const FIGURES: [(&str, &str, f64, Value); 18] = [
    ("torque_nm_per_v", "torque per volt, mNm", 1e3, |r, j| r.model.motors[j].torque_nm_per_v),
    ("inertia_kg_m2", "inertia, g m²", 1e3, |r, j| r.model.own_inertia_kg_m2()[j]),
    ("viscous_pos", "viscous +, mNms/rad", 1e3, |r, j| r.model.friction[j].viscous_pos),
    ("viscous_neg", "viscous −, mNms/rad", 1e3, |r, j| r.model.friction[j].viscous_neg),
    ("coulomb_pos_nm", "Coulomb +, mNm", 1e3, |r, j| r.model.friction[j].coulomb_pos_nm),
    ("coulomb_neg_nm", "Coulomb −, mNm", 1e3, |r, j| r.model.friction[j].coulomb_neg_nm),
    ("break_away_nm", "on top near standstill, mNm", 1e3, |r, j| r.quirks_of(j).break_away_nm),
    ("break_away_rad_s", "  falls at, mrad/s", 1e3, |r, j| r.quirks_of(j).break_away_rad_s),
    ("ripple_nm", "friction ripples by, mNm", 1e3, |r, j| {
        let ripple = r.quirks_of(j).ripple;
        ripple.sin_nm.hypot(ripple.cos_nm)
    }),
    ("ripple_periods", "  times a turn", 1.0, |r, j| r.quirks_of(j).ripple.periods),
    ("gravity_level_nm", "weight, beam level, mNm", 1e3, |r, j| weight(r, j).0),
    ("gravity_upright_nm", "weight, beam upright, mNm", 1e3, |r, j| weight(r, j).1),
    ("cable_load_nm", "cables at zero, mNm", 1e3, |r, j| r.quirks_of(j).cable.load_nm),
    ("cable_spring_nm_per_rad", "  against the angle, mNm/rad", 1e3, |r, j| {
        r.quirks_of(j).cable.spring_nm_per_rad
    }),
    ("edge_0_counts", "edges 0, 4, 8 … off, 1/1000 count", 1e3, |r, j| r.quirks_of(j).edges_counts[0]),
    ("edge_1_counts", "edges 1, 5, 9 …", 1e3, |r, j| r.quirks_of(j).edges_counts[1]),
    ("edge_2_counts", "edges 2, 6, 10 …", 1e3, |r, j| r.quirks_of(j).edges_counts[2]),
    ("edge_3_counts", "edges 3, 7, 11 …", 1e3, |r, j| r.quirks_of(j).edges_counts[3]),
];

/// Torque that gravity has on a joint, N m: beam level, beam upright. Pan stands upright and feels none.
fn weight(rig: &RigConfig, joint: Joint) -> (f64, f64) {
    let lumped = rig.model.bodies.lumped();
    if joint == Joint::Pan { (0.0, 0.0) } else { (lumped.gravity_c, lumped.gravity_s) }
}

fn table(rig: &RigConfig, found: &Identification, ticks: usize) -> String {
    let JointFit { stretches, edges, .. } = found.joints.pan;
    let tilt = found.joints.tilt;
    let mut text = format!(
        "{}: identified from {:.1} s: {stretches} stretches of pan's motion with {edges} edges, {} of tilt's with {}\n\n\
         {:34} {:>10} {:>10} {:>12} {:>10}",
        rig.name,
        ticks as f64 * TICK_F64_S,
        tilt.stretches,
        tilt.edges,
        "",
        "pan was",
        "is",
        "tilt was",
        "is"
    );
    for (_, words, times, value) in FIGURES {
        let figure = |r: &RigConfig, j: Joint| times * value(r, j);
        // writing to a String cannot fail
        let _ = write!(
            text,
            "\n{words:34} {:10.3} {:10.3} {:12.3} {:10.3}",
            figure(rig, Joint::Pan),
            figure(&found.rig, Joint::Pan),
            figure(rig, Joint::Tilt),
            figure(&found.rig, Joint::Tilt)
        );
    }
    let (pan, tilt) = (&found.joints.pan, &found.joints.tilt);
    let _ = write!(
        text,
        "\n{:34} {:10.3} {:10.3} {:12.3} {:10.3}\n",
        "edges off the model, counts rms",
        pan.before_counts,
        pan.after_counts,
        tilt.before_counts,
        tilt.after_counts
    );
    for j in Joint::BOTH.into_iter().filter(|&j| !found.joints[j].taken) {
        let _ =
            write!(text, "\n{j}: what was found explains its motion no better; what was believed is kept");
    }
    text
}

fn json(rig: &RigConfig, found: &Identification) -> String {
    let joint = |j: Joint| {
        let fit = &found.joints[j];
        let figures = |r: &RigConfig| {
            let pairs = FIGURES.iter().map(|(name, _, _, value)| ((*name).to_owned(), value(r, j).into()));
            serde_json::Value::Object(pairs.collect())
        };
        serde_json::json!({
            "taken": fit.taken,
            "stretches": fit.stretches,
            "edges": fit.edges,
            "residual_counts": { "before": fit.before_counts, "after": fit.after_counts },
            "believed": figures(rig),
            "found": figures(&found.rig),
        })
    };
    serde_json::json!({ "pan": joint(Joint::Pan), "tilt": joint(Joint::Tilt) }).to_string()
}
