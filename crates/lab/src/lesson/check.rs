//! What a simulation must come to.

/// A figure of the simulation, and what it must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Which figure.
    pub what: String,
    /// Its unit.
    pub unit: &'static str,
    /// What it was; NaN where it never was anything.
    pub value: f64,
    /// The least it must be,
    pub least: f64,
    /// and the most.
    pub most: f64,
    /// What helps when it is too small,
    pub if_less: &'static str,
    /// and when it is too large, or never was anything.
    pub if_more: &'static str,
}

impl Check {
    pub(super) fn at_most(
        what: impl Into<String>,
        value: f64,
        most: f64,
        unit: &'static str,
        hint: &'static str,
    ) -> Self {
        Self { what: what.into(), unit, value, least: f64::NEG_INFINITY, most, if_less: "", if_more: hint }
    }

    /// Whether it is.
    pub fn is_met(&self) -> bool {
        (self.least..=self.most).contains(&self.value)
    }

    /// What helps.
    pub fn hint(&self) -> &'static str {
        if self.value < self.least { self.if_less } else { self.if_more }
    }
}
