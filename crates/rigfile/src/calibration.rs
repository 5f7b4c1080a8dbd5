//! A calibration file of which it is not known whether it is of a camera, a lens or a head.

use tracelight_task::Failure;

use crate::calibrated::Calibrated;
use crate::text::{Kind, text_of};
use crate::{camera, head};

/// Largest calibration file, bytes.
const MOST_BYTES: usize = 1 << 18;
const KIND: Kind = Kind { name: "calibration", code: "camera-file", most_bytes: MOST_BYTES };

/// Reads what a file says of itself: one that `calibrate` has written, of a camera, a lens or a head.
///
/// # Errors
/// `camera-file`, `head-file`: what is no such file.
pub fn read(path: &str, bytes: Vec<u8>) -> Result<Calibrated, Failure> {
    let text = text_of(&KIND, path, bytes)?;
    let document: toml_edit::DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| {
        KIND.wrong(path, &format!("no calibration file: {}", e.to_string().trim_end()))
    })?;
    // only a head has axes
    if document.contains_key("built") {
        head::calibrated(path, text.into_bytes())
    } else if document.contains_key("lens") {
        camera::calibrated(path, text.into_bytes())
    } else {
        Err(KIND.wrong(
            path,
            "no calibration file: those that `tracelight calibrate` writes have a table [lens] or [built]",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_calibration_is_told_so() {
        for text in ["", "name = \"x\"\n", "not toml at all"] {
            let told = read("x.toml", text.as_bytes().to_vec()).unwrap_err();
            assert!(told.message.contains("no calibration file"), "{}", told.message);
        }
    }
}
