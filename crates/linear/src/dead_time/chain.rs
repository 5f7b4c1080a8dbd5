//! What a signal goes through once round a loop, and where the input comes in.

use super::Delayed;
use crate::{LinearError, Matrix, StateSpace};

/// A loop with a dead time, cut open where that is: x′ = A x + b v + b d, y = c x + d v + d d, where v is what comes round.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) a: Matrix,
    pub(super) c: Matrix,
    /// How what comes round enters.
    pub(super) round: Entry,
    /// How the input enters.
    pub(super) input: Entry,
    /// What comes round is the output so much earlier, s, times −1, or 1 with a sign of −1.
    pub(super) round_s: f64,
    pub(super) sign: f64,
    /// So much later, s, the output is seen.
    pub(super) late_s: f64,
}

/// A column of B and of D.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) b: Matrix,
    pub(super) d: f64,
}

/// Where the input comes into a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Before the first part.
    Start,
    /// Between the parts.
    Middle,
    /// At the output.
    End,
}

/// A loop of two parts one after the other, whose output comes back to the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts<'a> {
    pub(crate) first: &'a Delayed,
    pub(crate) second: &'a Delayed,
    /// 1 of negative feedback, −1 of positive.
    pub(crate) sign: f64,
    pub(crate) place: Place,
    /// How late the output is, s.
    pub(crate) late_s: f64,
}

impl Chain {
    /// A loop that is closed by negative feedback of its output.
    pub(super) fn of(open: &Delayed) -> Result<Self, LinearError> {
        let whole = states(open)?;
        let entry = Entry { b: whole.b().clone(), d: whole.d()[(0, 0)] };
        Ok(Self {
            a: whole.a().clone(),
            c: whole.c().clone(),
            round: entry.clone(),
            input: entry,
            round_s: open.delay_s,
            sign: 1.0,
            late_s: open.delay_s,
        })
    }

    /// A loop of two parts.
    ///
    /// # Errors
    /// [`LinearError::Improper`] where a part has more zeros than poles.
    pub(super) fn of_parts(parts: Parts<'_>) -> Result<Self, LinearError> {
        let Parts { first, second, sign, place, late_s } = parts;
        if place != Place::Middle {
            // two parts that have as many zeros as poles only together are one here
            let mut chain = Self::of(&first.series(second)?)?;
            if place == Place::End {
                chain.input = Entry { b: Matrix::zeros(chain.a.nrows(), 1), d: 1.0 };
            }
            return Ok(Self { sign, late_s, ..chain });
        }
        let (one, two) = (states(first)?, states(second)?);
        let both = one.series(&two)?;
        let mut b = Matrix::zeros(both.order(), 1);
        b.view_mut((one.order(), 0), (two.order(), 1)).copy_from(two.b());
        Ok(Self {
            a: both.a().clone(),
            c: both.c().clone(),
            round: Entry { b: both.b().clone(), d: both.d()[(0, 0)] },
            input: Entry { b, d: two.d()[(0, 0)] },
            round_s: first.delay_s + second.delay_s,
            sign,
            late_s,
        })
    }
}

fn states(of: &Delayed) -> Result<StateSpace, LinearError> {
    of.rational.zpk().cascade("answer of a closed loop")
}
