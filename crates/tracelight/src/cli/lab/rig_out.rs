//! What was identified, as a rig file.

use std::path::Path;

use tracelight_experiment::Finding;
use tracelight_experiment::better::rig_file;
use tracelight_files as files;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

use crate::cli::{Answer, Voice};
use crate::named;

/// Refuses to write into what comes with the program.
pub(super) fn may_save(rig: &str, save: bool) -> Result<(), Failure> {
    if save && RigConfig::preset(rig).is_some() {
        let message = format!("--save needs a rig file of your own; {rig} comes with the program");
        return Err(Failure::usage("usage", message));
    }
    Ok(())
}

/// Writes the better rig into a folder, and into the rig file itself where that was asked; says where it is.
pub(super) fn write(
    out: &Path,
    rig: &str,
    save: bool,
    (before, after): (&RigConfig, &RigConfig),
) -> Result<String, Failure> {
    let path = out.join("rig.toml").display().to_string();
    let own = files::is_same(&path, rig);
    let text = rig_file(after)?;
    if save {
        named::save_rig(rig, before, after)?;
    } else if own {
        let message = format!(
            "{path} is the rig file itself: it changes only with --save; choose another folder with --out"
        );
        return Err(Failure::usage("usage", message));
    }
    if !own {
        files::write(&path, text)?;
    }
    Ok(format!("\n\nrig: {path}{}", if save { format!(", and in {rig}") } else { String::new() }))
}

/// What is printed of a finding, and where the better rig is.
pub(super) fn answer(finding: &impl Finding, written: &str, voice: Voice) -> Answer {
    Answer::either(voice, || finding.text() + written, || finding.json())
}
