//! Linetypes: the table LTYPE.

use std::collections::HashMap;

use super::groups::Record;
use crate::FormatError;

/// Where an entity's linetype comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LineFrom {
    Layer,
    Block,
    /// Its number.
    Of(usize),
}

/// Number of the linetype without gaps.
pub(super) const CONTINUOUS: usize = 0;

/// Lengths of a linetype at most. AutoCAD takes twelve.
const MOST_LENGTHS: usize = 64;

/// The linetypes by number; names differ in more than case.
pub(super) struct Lines {
    /// Lengths of each: dashes positive, gaps negative, dots zero, in the drawing's unit.
    all: Vec<Vec<f64>>,
    by_key: HashMap<String, usize>,
}

impl Default for Lines {
    fn default() -> Self {
        let mut lines = Self { all: Vec::new(), by_key: HashMap::new() };
        lines.numbered("continuous");
        lines
    }
}

impl Lines {
    /// The number of a linetype by its key; some are named before they are declared, or declared nowhere: these have no
    /// gaps.
    pub(super) fn numbered(&mut self, key: &str) -> usize {
        let key = if key.is_empty() { "continuous" } else { key };
        if let Some(&known) = self.by_key.get(key) {
            return known;
        }
        self.by_key.insert(key.to_owned(), self.all.len());
        self.all.push(Vec::new());
        self.all.len() - 1
    }

    /// Where an entity's linetype comes from, by the key that it has of it.
    pub(super) fn of(&mut self, key: &str) -> LineFrom {
        match key {
            "" | "bylayer" => LineFrom::Layer,
            "byblock" => LineFrom::Block,
            key => LineFrom::Of(self.numbered(key)),
        }
    }

    /// Takes a record LTYPE of the table. Texts and shapes in a line are left out; the gaps for them stay.
    ///
    /// # Errors
    /// A length that is no number.
    pub(super) fn declare(&mut self, record: &Record) -> Result<(), FormatError> {
        let number = self.numbered(&record.key(2));
        let mut lengths = record.numbers(49)?;
        lengths.truncate(MOST_LENGTHS);
        let has_gap = lengths.iter().any(|&l| l < 0.0);
        self.all[number] = if has_gap { lengths } else { Vec::new() };
        Ok(())
    }

    /// The lengths of a linetype; none where it has no gaps.
    pub(super) fn lengths(&self, number: usize) -> &[f64] {
        &self.all[number]
    }
}
