use tracelight_rig::{Exceeded, Fault, Joint};

/// A fault that a tick shows, before it is latched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finding {
    pub(crate) fault: Fault,
    pub(crate) joint: Option<Joint>,
    pub(crate) exceeded: Option<Exceeded>,
}

impl Finding {
    /// A fault of which there is nothing to measure. Cold, as what follows: the way without a fault is the one that every tick takes.
    #[cold]
    pub(crate) const fn of(fault: Fault) -> Self {
        Self { fault, joint: None, exceeded: None }
    }

    /// A value that went past its bound.
    #[cold]
    pub(crate) const fn beyond(fault: Fault, value: f32, bound: f32) -> Self {
        Self { fault, joint: None, exceeded: Some(Exceeded { value, bound }) }
    }

    /// Ticks that went past their bound.
    pub(crate) const fn after(fault: Fault, ticks: u32, bound: u32) -> Self {
        Self::beyond(fault, ticks as f32, bound as f32)
    }

    /// Shown by this joint.
    #[must_use]
    pub(crate) const fn by(self, joint: Joint) -> Self {
        Self { joint: Some(joint), ..self }
    }
}
