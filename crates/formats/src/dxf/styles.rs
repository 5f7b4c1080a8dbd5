//! Forms of text: width factors, slants, and the table of styles.

use std::collections::HashMap;

use tracelight_maths::tan;
use tracelight_stroke::Affine;

use super::groups::Record;
use crate::FormatError;

/// Forms of text that MTEXT refers to: width factor and slant, by the style's name.
#[derive(Debug, Default)]
pub(super) struct Styles(HashMap<String, (f64, f64)>);

impl Styles {
    /// Takes a record STYLE of the table.
    ///
    /// # Errors
    /// A factor or angle that is no number.
    pub(super) fn declare(&mut self, record: &Record) -> Result<(), FormatError> {
        let form = (width_factor(record)?, record.number_or(50, 0.0)?.to_radians());
        self.0.insert(record.key(2), form);
        Ok(())
    }

    pub(super) fn get(&self, key: &str) -> (f64, f64) {
        self.0.get(key).copied().unwrap_or((1.0, 0.0))
    }
}

/// A factor of width; what cannot be one is 1.
///
/// # Errors
/// What is no number.
pub(super) fn width_factor(record: &Record) -> Result<f64, FormatError> {
    let factor = record.number_or(41, 1.0)?;
    Ok(if factor > 0.0 { factor } else { 1.0 })
}

/// Leaning to the right.
pub(super) fn slanted(angle_rad: f64) -> Affine {
    const MOST_RAD: f64 = 1.4; // beyond, a line of text is as flat as a line
    Affine::new([1.0, 0.0, tan(angle_rad.clamp(-MOST_RAD, MOST_RAD)), 1.0, 0.0, 0.0])
}
