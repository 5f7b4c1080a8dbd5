//! What was identified, as a rig file.

use std::path::Path;

use tracelight_experiment::better::rig_file;
use tracelight_experiment::{Finding, Improved};
use tracelight_files as files;
use tracelight_task::Failure;

use crate::cli::answer::{Answer, Voice};
use crate::named;

/// Writes the better rig of a finding into a folder, and into the rig file itself where that was asked; answers, and says where it is.
pub(super) fn written(
    finding: &impl Improved,
    out: &Path,
    rig: &str,
    save: bool,
    voice: Voice,
) -> Result<Answer, Failure> {
    let path = out.join("rig.toml").display().to_string();
    let own = files::is_same(&path, rig);
    let text = rig_file(finding.better())?;
    if save {
        named::save_rig(rig, finding.rig(), finding.better())?;
    } else if own {
        let message = format!(
            "{path} is the rig file itself: it changes only with --save; choose another folder with --out"
        );
        return Err(Failure::usage("usage", message));
    }
    if !own {
        files::write(&path, text)?;
    }
    let also = if save { format!(", and in {rig}") } else { String::new() };
    Ok(answer(finding, &format!("\n\nrig: {path}{also}"), voice))
}

/// What is printed of a finding, and what was written of it.
pub(super) fn answer(finding: &impl Finding, written: &str, voice: Voice) -> Answer {
    Answer::either(voice, || finding.text() + written, || finding.json())
}
