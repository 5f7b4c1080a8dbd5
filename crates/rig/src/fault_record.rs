//! What is known of a fault when it is latched.

use core::fmt;

use crate::fault::Fault;
use crate::fault::row::Measure;
use crate::joint::Joint;

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

impl fmt::Display for FaultRecord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.fault.code(), self.fault.row().what)?;
        if self.evidence().is_empty() { Ok(()) } else { write!(f, " Shown by {}.", self.evidence()) }
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
        assert_eq!(late.evidence().to_string(), "2.00 ms that a tick took (bound 1.50)");
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
