mod log;
mod plot;
pub(super) mod trials;

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};
use tracelight_files as files;
use tracelight_lab::{Curves, Line, Side, Steady, SteadyPoint, Uncertain, curves, steady, steady_of};
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Stop};

use super::parts::by_joint;
use super::rig_out;
use crate::cli::{Answer, Voice};
use trials::{Subject, TrialArgs};

/// Identify friction as the 2006 report did, by voltages held, say what is wrong with that, and identify it from the whole curves
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab friction --fixture --out out/friction\n\n\
                  The report gives a joint −1 to 1 V in steps of 0.05 V, 30 s each after a pulse of 1 V, takes the last speeds for \
                  steady, and lays a line through torque over speed for each direction: viscous friction its slope, Coulomb friction \
                  its intercept. Both are shown: that, and what the whole of each curve tells, steady or not. With --fixture each \
                  axis stands upright and may turn on and on, as the report had it; without, the joint goes to and fro within its \
                  range, what is believed of gravity is balanced on top of each voltage, and gravity is fitted as well.\n\n\
                  Friction comes out in units of what the rig file says of torque per volt. The folder gets friction.svg, log.csv \
                  (which can be given back as LOG.csv) and rig.toml. In a log, a time that goes back begins a new trial, and volt is \
                  the mean voltage until the next row.")]
pub(crate) struct FrictionArgs {
    #[command(flatten)]
    trials: TrialArgs,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/friction")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// What was found of a joint.
struct Found {
    subject: Subject,
    /// Without points where no voltage was held to its end.
    steady: Steady,
    /// `None` where torques and speeds were given, not motion.
    curves: Option<Curves>,
}

pub(crate) fn run(args: &FrictionArgs, stop: &Stop) -> Result<Answer, Failure> {
    let rig = args.trials.load()?;
    rig_out::may_save(&args.trials.rig, args.save)?;
    let subjects = args.trials.subjects(&rig, args.voice.quiet, stop)?;
    args.trials.write_log(&args.out, &subjects)?;
    let found = subjects
        .into_iter()
        .map(|subject| found(subject, args.trials.holds()))
        .collect::<Result<Vec<_>, _>>()?;
    let mut better = rig.clone();
    found.iter().for_each(|one| one.tell(&mut better));
    let plot = plot::figure(&rig, &found)?;
    files::write(&args.out.join("friction.svg").display().to_string(), plot)?;
    let written = rig_out::write(&args.out, &args.trials.rig, args.save, (&rig, &better))?;
    Ok(Answer::either(args.voice, || text(args, &rig, &found) + &written, || json(&found)))
}

fn found(subject: Subject, holds: bool) -> Result<Found, Failure> {
    let trials: Vec<_> = subject.trials.iter().collect();
    let believed = &subject.believed;
    if trials.is_empty() {
        let steady = steady_of(subject.points.clone());
        if steady.pos.is_none() && steady.neg.is_none() {
            let message = format!(
                "{}: three torques at speeds that differ are needed in one direction at least",
                subject.joint
            );
            return Err(Failure::failed("friction", message));
        }
        return Ok(Found { steady, curves: None, subject });
    }
    let held = if holds { trials.as_slice() } else { &[] };
    let steady = steady(held, believed.torque_nm_per_v, believed.count_rad);
    let curves = subject.curves()?;
    Ok(Found { steady, curves: Some(curves), subject })
}

impl Subject {
    /// What the whole of its motion tells.
    pub(super) fn curves(&self) -> Result<Curves, Failure> {
        if self.trials.is_empty() {
            let message = format!(
                "{}: torques and speeds do not tell this: give motion, axis,volt,time_s,count",
                self.joint
            );
            return Err(Failure::failed("friction", message));
        }
        let trials: Vec<_> = self.trials.iter().collect();
        curves(self.joint, &trials, &self.believed).map_err(|e| Failure::failed("friction", e))
    }
}

impl Found {
    /// The best that is known, forwards and backwards.
    fn sides(&self) -> [Option<Side>; 2] {
        match &self.curves {
            Some(curves) => [curves.pos, curves.neg],
            None => self.as_the_report(),
        }
    }

    /// Lines through the last speeds.
    fn as_the_report(&self) -> [Option<Side>; 2] {
        [self.steady.pos, self.steady.neg].map(|line| line.map(|line| line.side()))
    }

    /// Share that is explained.
    fn r2(&self) -> f64 {
        let lines = [self.steady.pos, self.steady.neg].into_iter().flatten();
        self.curves.as_ref().map_or_else(|| lines.map(|l| l.r2).fold(1.0, f64::min), |curves| curves.r2)
    }

    /// Time in which a speed comes to what its voltage allows but for 1/e, s.
    fn time_constant_s(&self) -> Option<f64> {
        let curves = self.curves.as_ref()?;
        let inertia = curves.inertia_kg_m2.map_or(self.subject.believed.inertia_kg_m2, |j| j.value);
        let viscous = [curves.pos, curves.neg].into_iter().flatten().map(|side| side.viscous.value);
        let slowest = viscous.fold(f64::INFINITY, f64::min);
        (slowest > 0.0).then_some(inertia / slowest)
    }

    /// Puts it into a model. Friction that comes out below nothing is nothing.
    fn tell(&self, rig: &mut RigConfig) {
        let friction = &mut rig.model.friction[self.subject.joint];
        let [pos, neg] = self.sides();
        if let Some(pos) = pos {
            (friction.viscous_pos, friction.coulomb_pos_nm) =
                (pos.viscous.value.max(0.0), pos.coulomb_nm.value.max(0.0));
        }
        if let Some(neg) = neg {
            (friction.viscous_neg, friction.coulomb_neg_nm) =
                (neg.viscous.value.max(0.0), neg.coulomb_nm.value.min(0.0));
        }
    }
}

/// What the intervals of a table mean.
pub(super) const HOW_SURE: &str = "\n\n± has the true value in 95 of 100 cases, if the model is right.";

/// A value and its interval, times a thousand.
pub(super) fn milli(value: Option<Uncertain>) -> String {
    value.map_or("–".to_owned(), |u| {
        // two digits of how well it is known
        let digits = (1.0 - (1e3 * u.within).log10().floor()).clamp(0.0, 6.0);
        if !u.within.is_finite() {
            return format!("{:.4} ± ?", 1e3 * u.value);
        }
        let digits = if u.within > 0.0 { digits as usize } else { 4 };
        format!("{:.digits$} ± {:.digits$}", 1e3 * u.value, 1e3 * u.within)
    })
}

fn text(args: &FrictionArgs, rig: &RigConfig, found: &[Found]) -> String {
    let mut text = args.trials.in_words(rig);
    for one in found {
        text += &table(rig, one);
        if let Some(curves) = &one.curves {
            let trials = one.subject.trials.len();
            // writing to a String cannot fail
            let _ = write!(text, "\n{} of {trials} trials turned it.", curves.trials);
            text += &verdict(one).map_or(String::new(), |verdict| format!(" {verdict}"));
            text += &against_gravity(rig, one);
            text += &below_nothing(one);
        }
    }
    text + HOW_SURE
}

/// A joint's figures: a column for each way they were told.
fn table(rig: &RigConfig, one: &Found) -> String {
    let friction = &rig.model.friction[one.subject.joint];
    let believed = &one.subject.believed;
    let viscous: fn(Side) -> Uncertain = |side| side.viscous;
    let coulomb: fn(Side) -> Uncertain = |side| side.coulomb_nm;
    let of =
        |sides: [Option<Side>; 2], side: usize, value: fn(Side) -> Uncertain| milli(sides[side].map(value));
    let (literal, best) = (one.as_the_report(), one.sides());
    let lines = [
        ("viscous +, mNms/rad", 0, viscous, friction.viscous_pos),
        ("viscous −, mNms/rad", 1, viscous, friction.viscous_neg),
        ("Coulomb +, mNm", 0, coulomb, friction.coulomb_pos_nm),
        ("Coulomb −, mNm", 1, coulomb, friction.coulomb_neg_nm),
    ];
    let mut rows: Vec<[String; 4]> = lines
        .map(|(words, side, value, had)| {
            [words.into(), of(literal, side, value), of(best, side, value), format!("{:.4}", 1e3 * had)]
        })
        .into();
    let r2 = |line: Option<Line>| line.map_or("–".to_owned(), |line| format!("{:.6}", line.r2));
    let r2s = format!("{}, {}", r2(one.steady.pos), r2(one.steady.neg));
    rows.push(["r²".into(), r2s, format!("{:.8}", one.r2()), String::new()]);
    if let Some(curves) = &one.curves {
        let mut known = |words: &str, value: Option<Uncertain>, had: f64| {
            rows.push([words.into(), String::new(), milli(value), format!("{:.4}", 1e3 * had)]);
        };
        known("inertia, g m²", curves.inertia_kg_m2, believed.inertia_kg_m2);
        if let Some([level, upright]) = believed.gravity_nm {
            known("weight, beam level, mNm", curves.gravity_nm.map(|g| g[0]), level);
            known("weight, upright, mNm", curves.gravity_nm.map(|g| g[1]), upright);
        }
        if believed.cables {
            let had = rig.quirks_of(one.subject.joint).cable.spring_nm_per_rad;
            known("cables, mNm/rad", curves.spring_nm_per_rad, had);
        }
    }
    let heads = [one.subject.joint.name(), "as the report did", "from whole curves", "the rig file has"];
    rows.insert(0, heads.map(str::to_owned));
    let shown = |column: usize| match column {
        1 => !one.steady.points.is_empty(),
        2 => one.curves.is_some(),
        _ => true,
    };
    let line = |row: &[String; 4]| {
        let cell = |column: usize| match column {
            0 => format!("{:24}", row[0]),
            3 => format!("{:>17}", row[3]),
            _ => format!("{:>22}", row[column]),
        };
        (0..4).filter(|&column| shown(column)).map(cell).collect::<String>()
    };
    "\n\n".to_owned() + &rows.iter().map(|row| line(row).trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

/// By how much lines through the last speeds are too steep, and why.
fn verdict(one: &Found) -> Option<String> {
    const AS_GOOD: f64 = 1.05;
    let of = |sides: [Option<Side>; 2]| sides.map(|side| side.map(|side| side.viscous.value));
    let pairs = of(one.as_the_report()).into_iter().zip(of(one.sides()));
    let steep = pairs.filter_map(|(last, whole)| Some(last? / whole?)).find(|steep| steep.is_finite())?;
    let constant_s = one.time_constant_s()?;
    let said =
        format!("Within J/Fv = {constant_s:.0} s a speed comes to all but 1/e of what a voltage allows");
    if (1.0 / AS_GOOD..AS_GOOD).contains(&steep) {
        return Some(format!("{said}: the last speeds\nare as good as steady."));
    }
    Some(format!(
        "{said}: the last speeds\nare not steady, and a line through them, straight as it is, is {steep:.1} times too steep."
    ))
}

/// What is found below nothing and cannot be written so.
fn below_nothing(one: &Found) -> String {
    let [pos, neg] = one.sides();
    let viscous = [pos, neg].into_iter().flatten().any(|side| side.viscous.value < 0.0);
    let coulomb = pos.is_some_and(|side| side.coulomb_nm.value < 0.0)
        || neg.is_some_and(|side| side.coulomb_nm.value > 0.0);
    if viscous || coulomb {
        "\nFriction that drives is none: rig.toml has 0 for it.".to_owned()
    } else {
        String::new()
    }
}

/// What the highest voltage can do against weight, where the head stands on its feet.
fn against_gravity(rig: &RigConfig, one: &Found) -> String {
    let lumped = rig.model.bodies.lumped();
    let weight_nm = lumped.gravity_c.hypot(lumped.gravity_s);
    let volts = one.steady.points.iter().filter_map(|p| p.volts).fold(0.0, |most: f64, v| most.max(v.abs()));
    let torque_nm = volts * one.subject.believed.torque_nm_per_v;
    if one.subject.joint == Joint::Pan || torque_nm == 0.0 || torque_nm > weight_nm {
        return String::new();
    }
    format!(
        "\nOn its feet it would only hang: {volts:.2} V are {torque_nm:.3} N m, and it weighs {weight_nm:.3}."
    )
}

fn json(found: &[Found]) -> String {
    by_joint(found.iter().map(|one| (one.subject.joint, joint_json(one))))
}

fn joint_json(one: &Found) -> Value {
    let mut object = sides_json(one.sides());
    object["r2"] = one.r2().into();
    let mut steady = sides_json(one.as_the_report());
    steady["r2_pos"] = one.steady.pos.map(|line| line.r2).into();
    steady["r2_neg"] = one.steady.neg.map(|line| line.r2).into();
    let point =
        |p: &SteadyPoint| json!({"volt": p.volts, "torque_nm": p.torque_nm, "velocity_rad_s": p.rate_rad_s});
    steady["points"] = one.steady.points.iter().map(point).collect();
    object["steady"] = steady;
    object["time_constant_s"] = one.time_constant_s().into();
    if let Some(curves) = &one.curves {
        object["inertia_kg_m2"] = curves.inertia_kg_m2.map(|u| u.value).into();
        object["within"]["inertia_kg_m2"] = curves.inertia_kg_m2.map(|u| u.within).into();
        object["gravity_level_nm"] = curves.gravity_nm.map(|g| g[0].value).into();
        object["gravity_upright_nm"] = curves.gravity_nm.map(|g| g[1].value).into();
        object["cable_spring_nm_per_rad"] = curves.spring_nm_per_rad.map(|u| u.value).into();
        object["trials"] = one.subject.trials.len().into();
        object["turned"] = curves.trials.into();
    }
    object
}

fn sides_json([pos, neg]: [Option<Side>; 2]) -> Value {
    let value = |side: Option<Side>, of: fn(Side) -> f64| side.map(of);
    json!({
        "viscous_pos": value(pos, |s| s.viscous.value),
        "viscous_neg": value(neg, |s| s.viscous.value),
        "coulomb_pos": value(pos, |s| s.coulomb_nm.value),
        "coulomb_neg": value(neg, |s| s.coulomb_nm.value),
        "within": {
            "viscous_pos": value(pos, |s| s.viscous.within),
            "viscous_neg": value(neg, |s| s.viscous.within),
            "coulomb_pos": value(pos, |s| s.coulomb_nm.within),
            "coulomb_neg": value(neg, |s| s.coulomb_nm.within),
        },
    })
}
