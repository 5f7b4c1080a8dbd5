//! A plant and a controller in a loop.

use crate::{Delayed, LinearError, Polynomial, Time, TransferFunction};

/// A plant P and a controller C in a loop: u = C (r − y) and y = P (u + d), or u = C (r + y) with positive feedback.
#[derive(Clone, Debug, PartialEq)]
pub struct FeedbackLoop {
    pub(super) plant: Delayed,
    pub(super) controller: Delayed,
    /// 1 of negative feedback, −1 of positive.
    pub(super) sign: f64,
    /// P C times the sign: closed by negative feedback this is the loop.
    pub(super) open: Delayed,
}

/// One of the four transfer functions of a loop (the gang of four), with L = P C; of positive feedback 1 − L stands for 1 + L.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopMember {
    /// S = 1/(1 + L), sensitivity: from a disturbance at the plant's output to the output.
    Sensitivity,
    /// T = L/(1 + L), complementary sensitivity: from the setpoint to the output.
    Complementary,
    /// PS = P/(1 + L): from a disturbance at the plant's input, a load, to the output.
    Load,
    /// CS = C/(1 + L): from the setpoint, or measurement noise with its sign changed, to the controller's output.
    Control,
}

impl LoopMember {
    /// All four.
    pub const ALL: [Self; 4] = [Self::Sensitivity, Self::Complementary, Self::Load, Self::Control];
}

impl FeedbackLoop {
    /// A loop of negative feedback, or of positive.
    ///
    /// # Errors
    /// [`LinearError::Sampling`] of parts that do not go together; [`LinearError::AlgebraicLoop`] where 1 + L is 0 at infinite frequency.
    pub fn new(plant: Delayed, controller: Delayed, is_positive: bool) -> Result<Self, LinearError> {
        let sign = if is_positive { -1.0 } else { 1.0 };
        let open = plant.series(&controller)?.scaled(sign);
        if open.delay_s() == 0.0 {
            open.rational().closed()?;
        }
        Ok(Self { plant, controller, sign, open })
    }

    /// A loop of one system, whose output comes back as it is.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of(system: Delayed, is_positive: bool) -> Result<Self, LinearError> {
        let one = TransferFunction::gain(1.0, system.rational().time());
        Self::new(system, one.into(), is_positive)
    }

    /// The open loop P C, of positive feedback −P C: its margins, with −1 as the point to keep away from, are the loop's.
    pub const fn open(&self) -> &Delayed {
        &self.open
    }

    /// What the member has above D + N e^(−sT), where the open loop is N e^(−sT)/D; and how late it is, s.
    pub(super) fn above(&self, member: LoopMember) -> (Polynomial, f64) {
        let [plant, controller] = [self.plant.rational(), self.controller.rational()];
        match member {
            LoopMember::Sensitivity => (plant.denominator() * controller.denominator(), 0.0),
            LoopMember::Complementary => (plant.numerator() * controller.numerator(), self.open.delay_s()),
            LoopMember::Load => (plant.numerator() * controller.denominator(), self.plant.delay_s()),
            LoopMember::Control => (plant.denominator() * controller.numerator(), self.controller.delay_s()),
        }
    }

    pub(super) const fn time(&self) -> Time {
        self.open.rational().time()
    }
}
