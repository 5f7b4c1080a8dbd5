//! What is known of a fault when it is latched.

use core::fmt;

use crate::{Fault, Joint};

/// A latched fault with what showed it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultRecord {
    /// Which it is.
    pub fault: Fault,
    /// How many faults were latched since power-up, with this one.
    pub number: u32,
    /// Tick in which it was seen; that which followed, where a command showed it.
    pub tick: u32,
    /// The joint that showed it, where one did.
    pub joint: Option<Joint>,
    /// What was measured and the bound that it went past, where that is a number.
    pub exceeded: Option<Exceeded>,
}

/// A value past its bound, both in the base unit of the fault's [`Measure`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// What was measured; may be no number.
    pub value: f32,
    /// What it may be.
    pub bound: f32,
}

/// What a fault measures, for words.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Measure {
    /// Unit in which it is told.
    pub unit: &'static str,
    /// What it is; no sentence.
    pub what: &'static str,
    /// How many of that unit are one of the base unit: ticks, radians, counts or shares.
    pub factor: f32,
    /// Digits after the point.
    pub digits: u8,
}

impl Measure {
    /// Of faults that are no number's.
    pub const NONE: Self = Self { unit: "", what: "", factor: 1.0, digits: 0 };

    /// Counts of an encoder.
    pub(super) const fn counts(what: &'static str) -> Self {
        Self { unit: "counts", what, factor: 1.0, digits: 1 }
    }

    /// Ticks, told in ms.
    pub(super) const fn ticks(what: &'static str) -> Self {
        Self { unit: "ms", what, factor: 1.0, digits: 1 }
    }

    /// Radians, told in degrees.
    pub(super) const fn angle(what: &'static str) -> Self {
        Self { unit: "degrees", what, factor: 180.0 / core::f32::consts::PI, digits: 2 }
    }

    /// A share, told in percent.
    pub(super) const fn share(what: &'static str) -> Self {
        Self { unit: "%", what, factor: 100.0, digits: 1 }
    }
}

/// A value past its bound, in the unit in which it is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// What was measured; may be no number.
    pub value: f32,
    /// What it may be.
    pub bound: f32,
    /// Unit of both.
    pub unit: &'static str,
}

impl FaultRecord {
    /// What was measured, for scripts; `None` where that is no number's.
    pub fn told(&self) -> Option<Told> {
        let Measure { unit, factor, .. } = self.fault.row().measure;
        self.exceeded.map(|Exceeded { value, bound }| Told {
            value: value * factor,
            bound: bound * factor,
            unit,
        })
    }

    /// What showed it, in words: "pan, 12.3 counts from where the joint was expected (bound 1.5)"; empty where nothing is known but the fault.
    pub const fn evidence(&self) -> Evidence<'_> {
        Evidence(self)
    }
}

/// What showed a fault, to be printed.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a>(&'a FaultRecord);

impl Evidence<'_> {
    /// Whether there is nothing to print.
    pub const fn is_empty(&self) -> bool {
        self.0.joint.is_none() && self.0.exceeded.is_none()
    }
}

impl fmt::Display for Evidence<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FaultRecord { fault, joint, .. } = self.0;
        if let Some(joint) = joint {
            write!(f, "{joint}")?;
        }
        let Some(Told { value, bound, unit }) = self.0.told() else { return Ok(()) };
        let Measure { what, digits, .. } = fault.row().measure;
        let (separator, digits) = (if joint.is_some() { ", " } else { "" }, usize::from(digits));
        write!(f, "{separator}{value:.digits$} {unit} {what} (bound {bound:.digits$})")
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::string::ToString;

    #[test]
    fn evidence_names_joint_value_unit_and_bound() {
        let jumped = FaultRecord {
            fault: Fault::EncoderJumped,
            number: 1,
            tick: 3204,
            joint: Some(Joint::Pan),
            exceeded: Some(Exceeded { value: 12.34, bound: 1.5 }),
        };
        let words = jumped.evidence().to_string();
        assert_eq!(words, "pan, 12.3 counts from where the joint was expected (bound 1.5)");
        let late = FaultRecord {
            fault: Fault::TickLate,
            joint: None,
            exceeded: Some(Exceeded { value: 2.0, bound: 1.5 }),
            ..jumped
        };
        assert_eq!(late.evidence().to_string(), "2.0 ms that a tick took (bound 1.5)");
        let stop = FaultRecord { fault: Fault::EmergencyStop, joint: None, exceeded: None, ..jumped };
        assert!(stop.evidence().is_empty() && stop.evidence().to_string().is_empty());
    }

    #[test]
    fn what_measures_something_says_what() {
        for row in Fault::TABLE {
            assert_eq!(row.measure.unit.is_empty(), row.measure.what.is_empty(), "{}", row.code);
            assert_eq!(row.measure == Measure::NONE, row.measure.unit.is_empty(), "{}", row.code);
        }
    }
}
