use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use tracelight_lab::{Curves, Uncertain};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Stop};

use super::friction::trials::{Subject, TrialArgs};
use super::friction::{HOW_SURE, milli};
use super::parts::by_joint;
use super::rig_out;
use crate::cli::{Answer, Voice};

/// Identify what each joint's inertia is, from how fast voltages speed it up
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab inertia --fixture --most 3V --step 0.5V --hold 5s\n\n\
                  The trials are those of `lab friction`. Inertia comes out in units of what the rig file says of torque per volt. \
                  The folder gets log.csv, if the head was tried, and rig.toml: bodies keep theirs, the rotor gets the rest.")]
pub(crate) struct InertiaArgs {
    #[command(flatten)]
    trials: TrialArgs,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/inertia")]
    out: PathBuf,
    /// Write what was found into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    pub(super) voice: Voice,
}

pub(crate) fn run(args: &InertiaArgs, stop: &Stop) -> Result<Answer, Failure> {
    let rig = args.trials.load()?;
    rig_out::may_save(&args.trials.rig, args.save)?;
    let subjects = args.trials.subjects(&rig, args.voice.quiet, stop)?;
    args.trials.write_log(&args.out, &subjects)?;
    let found = subjects.iter().map(|s| Ok((s, s.curves()?))).collect::<Result<Vec<_>, Failure>>()?;
    let told =
        found.iter().map(|(s, curves)| Ok((*s, told(s, curves)?))).collect::<Result<Vec<_>, Failure>>()?;
    let mut better = rig.clone();
    told.iter().for_each(|(subject, inertia)| better.model.set_own_inertia(subject.joint, inertia.value));
    let written = rig_out::write(&args.out, &args.trials.rig, args.save, (&rig, &better))?;
    let text = || text(args, &rig, &told) + &written;
    Ok(Answer::either(args.voice, text, || json(&told)))
}

fn told(subject: &Subject, curves: &Curves) -> Result<Uncertain, Failure> {
    curves.inertia_kg_m2.ok_or_else(|| {
        let message = format!(
            "{}: its speed hardly changes in what was seen, so nothing tells its inertia: give voltages that speed it up",
            subject.joint
        );
        Failure::failed("friction", message)
    })
}

fn text(args: &InertiaArgs, rig: &RigConfig, told: &[(&Subject, Uncertain)]) -> String {
    let mut text = args.trials.in_words(rig);
    let _ = write!(
        text,
        "\n\n{:10} {:>22} {:>17} {:>17}",
        "", "inertia, g m²", "the rig file has", "of it the rotor"
    );
    for (subject, inertia) in told {
        let (had, rotor) = (subject.believed.inertia_kg_m2, rig.model.bodies.rotor_kg_m2[subject.joint]);
        let cell = milli(Some(*inertia));
        // writing to a String cannot fail
        let _ = write!(
            text,
            "\n{:10} {cell:>22} {:>17.4} {:>17.4}",
            subject.joint.name(),
            1e3 * had,
            1e3 * rotor
        );
    }
    text + HOW_SURE
}

fn json(told: &[(&Subject, Uncertain)]) -> String {
    let one = |(subject, inertia): &(&Subject, Uncertain)| {
        let object = json!({
            "inertia_kg_m2": inertia.value,
            "within": inertia.within,
            "believed_kg_m2": subject.believed.inertia_kg_m2,
        });
        (subject.joint, object)
    };
    by_joint(told.iter().map(one))
}
