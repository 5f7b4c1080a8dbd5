use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Theme};
use tracelight_files as files;
use tracelight_lab::{Curves, Uncertain};
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Stop};

use super::friction::trials::{Subject, TrialArgs};
use super::friction::{HOW_SURE, milli};
use super::rig_out;
use crate::cli::{Answer, Voice};

/// Identify what gravity does to tilt, from how voltages turn it against its weight
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab gravity --most 2V --step 0.25V\n\n\
                  The trials are those of `lab friction` on tilt, the head on its feet. Weight comes out in units of what the rig \
                  file says of torque per volt. The folder gets gravity.svg, log.csv, if the head was tried, and rig.toml: what \
                  tilt carries is moved until it weighs so, its mass kept.")]
pub(crate) struct GravityArgs {
    #[command(flatten)]
    trials: TrialArgs,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/gravity")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Weight with the beam level, and upright, and what cables pull.
struct Weight {
    nm: [Uncertain; 2],
    spring_nm_per_rad: Option<Uncertain>,
}

pub(crate) fn run(args: &GravityArgs, stop: &Stop) -> Result<Answer, Failure> {
    if args.trials.fixture {
        return Err(Failure::usage("usage", "in a --fixture gravity turns nothing: leave it out"));
    }
    let rig = args.trials.load()?;
    rig_out::may_save(&args.trials.rig, args.save)?;
    let subjects = args.trials.only(Joint::Tilt)?.subjects(&rig, args.voice.quiet, stop)?;
    args.trials.write_log(&args.out, &subjects)?;
    let subject = subjects.first().ok_or_else(|| Failure::usage("usage", "gravity turns tilt alone"))?;
    let curves = subject.curves()?;
    let nm =
        curves.gravity_nm.ok_or_else(|| Failure::failed("friction", "tilt: nothing tells its weight"))?;
    let weight = Weight { nm, spring_nm_per_rad: curves.spring_nm_per_rad };
    let mut better = rig.clone();
    better.model.set_weight(weight.nm.map(|u| u.value));
    better.model.set_own_inertia(Joint::Tilt, subject.believed.inertia_kg_m2);
    files::write(
        &args.out.join("gravity.svg").display().to_string(),
        figure(&rig, subject, &curves, &weight)?,
    )?;
    let written = rig_out::write(&args.out, &args.trials.rig, args.save, (&rig, &better))?;
    let text = || text(args, &rig, subject, &weight) + &written;
    Ok(Answer::either(args.voice, text, || json(subject, &weight)))
}

fn text(args: &GravityArgs, rig: &RigConfig, subject: &Subject, weight: &Weight) -> String {
    let believed = subject.believed.gravity_nm.unwrap_or_default();
    let spring = rig.quirks_of(Joint::Tilt).cable.spring_nm_per_rad;
    let row = |words: &str, found: Option<Uncertain>, had: f64| {
        format!("\n{words:26} {:>22} {:>17.4}", milli(found), 1e3 * had)
    };
    args.trials.in_words(rig)
        + &format!("\n\n{:26} {:>22} {:>17}", "tilt", "found", "the rig file has")
        + &row("weight, beam level, mNm", Some(weight.nm[0]), believed[0])
        + &row("weight, beam upright, mNm", Some(weight.nm[1]), believed[1])
        + &row("cables, mNm/rad", weight.spring_nm_per_rad, spring)
        + HOW_SURE
}

fn json(subject: &Subject, weight: &Weight) -> String {
    let believed = subject.believed.gravity_nm.unwrap_or_default();
    json!({"tilt": {
        "gravity_level_nm": weight.nm[0].value,
        "gravity_upright_nm": weight.nm[1].value,
        "cable_spring_nm_per_rad": weight.spring_nm_per_rad.map(|u| u.value),
        "within": {
            "gravity_level_nm": weight.nm[0].within,
            "gravity_upright_nm": weight.nm[1].within,
            "cable_spring_nm_per_rad": weight.spring_nm_per_rad.map(|u| u.within),
        },
        "believed": {"gravity_level_nm": believed[0], "gravity_upright_nm": believed[1]},
    }})
    .to_string()
}

/// What holds tilt, over its angle.
fn figure(rig: &RigConfig, subject: &Subject, curves: &Curves, weight: &Weight) -> Result<String, Failure> {
    const MILLI: f64 = 1e3;
    const POINTS: i32 = 200;
    let places = curves.parts.iter().map(|part| (part.angle_rad.to_degrees(), MILLI * part.weight_nm));
    let dots: Vec<(f64, f64)> = places.collect();
    let ends =
        dots.iter().fold((0.0_f64, 0.0_f64), |(low, high), (angle, _)| (low.min(*angle), high.max(*angle)));
    let along = |holds: &dyn Fn(f64) -> f64| {
        let angle = |k: i32| ends.0 + (ends.1 - ends.0) * f64::from(k) / f64::from(POINTS);
        (0..=POINTS).map(|k| (angle(k), MILLI * holds(angle(k).to_radians()))).collect::<Vec<_>>()
    };
    let spring = weight.spring_nm_per_rad.map_or(0.0, |u| u.value);
    let held = |[level, upright]: [f64; 2], spring: f64| {
        move |angle: f64| spring * angle - level * angle.cos() - upright * angle.sin()
    };
    let believed = held(subject.believed.gravity_nm.unwrap_or_default(), 0.0);
    let found = held(weight.nm.map(|u| u.value), spring);
    let figure = Figure {
        title: format!("What holds tilt of rig {} against its weight", rig.name),
        legend: vec![
            Key::new(Colour::Blue, "found (dots: a second each, less friction and what speeds it up)"),
            Key::new(Colour::Black, "dashed: the rig file has"),
        ],
        panels: vec![Panel {
            x_title: "tilt, ° (positive: the beam down)".into(),
            y_title: "torque, mN m".into(),
            curves: vec![
                Curve { colour: Colour::Blue, pen: Pen::Dots, points: dots },
                Curve { colour: Colour::Blue, pen: Pen::Solid, points: along(&found) },
                Curve { colour: Colour::Black, pen: Pen::Dashed, points: along(&believed) },
            ],
            ..Panel::default()
        }],
        columns: 1,
        panel: (820, 420),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
