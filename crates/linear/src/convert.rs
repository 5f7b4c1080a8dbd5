//! One system in three forms: a quotient of polynomials, gain with zeros and poles, state space.

use tracelight_maths::{exp2, log2, powf, powi};

use crate::Matrix;
use crate::error::LinearError;
use crate::polynomial::Polynomial;
use crate::state_space::StateSpace;
use crate::transfer::TransferFunction;
use crate::zpk::Zpk;

impl TransferFunction {
    /// By its gain, zeros and poles.
    pub fn zpk(&self) -> Zpk {
        Zpk::of(self.numerator().leading(), self.zeros(), self.poles(), self.time())
    }

    /// In state space; not possible with more zeros than poles.
    pub fn state_space(&self) -> Result<StateSpace, LinearError> {
        canonical(self)
    }
}

impl Zpk {
    /// Multiplied out.
    pub fn transfer(&self) -> TransferFunction {
        let numerator = Polynomial::from_roots(self.gain(), self.zeros());
        let denominator = Polynomial::from_roots(1.0, self.poles());
        // the denominator is monic and all is finite, unless the products overflow
        TransferFunction::new(numerator, denominator, self.time())
            .unwrap_or_else(|_| TransferFunction::gain(f64::INFINITY, self.time()))
    }
}

impl StateSpace {
    /// The transfer function from one input to one output: all eigenvalues are poles, whether or not the input moves them and the
    /// output sees them.
    pub fn transfer(&self, output: usize, input: usize) -> Result<Zpk, LinearError> {
        let channel = self.channel(output, input)?;
        let (gain, zeros) = channel.gain_and_zeros()?;
        Ok(Zpk::of(gain, zeros, channel.poles()?, self.time()))
    }
}

/// The controllable canonical form of a transfer function, its states scaled so that the matrix is balanced.
fn canonical(transfer: &TransferFunction) -> Result<StateSpace, LinearError> {
    let order = transfer.denominator().degree();
    let zeros = transfer.numerator().degree();
    if zeros > order {
        return Err(LinearError::Improper { zeros, poles: order, what: "state space" });
    }
    let through = transfer.numerator().coefficient(order);
    // states scaled as powers of what a pole is like, so that neither the last row nor the ones above it stand out
    let size = powf(transfer.denominator().constant().abs(), 1.0 / order.max(1) as f64);
    let unit = if size > 0.0 { exp2(log2(size).round()) } else { 1.0 };
    let (mut a, mut b, mut c) =
        (Matrix::zeros(order, order), Matrix::zeros(order, 1), Matrix::zeros(1, order));
    for i in 0..order {
        if i + 1 < order {
            a[(i, i + 1)] = unit;
        }
        let scale = powi(unit, order as i32 - 1 - i as i32);
        a[(order - 1, i)] = -transfer.denominator().coefficient(i) / scale;
        c[(0, i)] =
            (transfer.numerator().coefficient(i) - through * transfer.denominator().coefficient(i)) / scale;
    }
    if order > 0 {
        b[(order - 1, 0)] = 1.0;
    }
    StateSpace::new(a, b, c, Matrix::from_element(1, 1, through), transfer.time())
}
