use tracelight_maths::{complex, exp, ln, powi};

use crate::state_space::stack;
use crate::time::positive;
use crate::{Complex, LinearError, Matrix, Polynomial, StateSpace, TransferFunction, Zpk};

/// What a regulator with an estimated state is to weigh against what (LQG). Each is a size: that much of the one is as bad as that much of
/// the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LqgWish {
    /// Of the output.
    pub output: f64,
    /// Of the input.
    pub input: f64,
    /// Of the output's integral over time; none: a constant disturbance leaves an error.
    pub integral: Option<f64>,
    /// Of the disturbance at the input, for the estimator.
    pub disturbance: f64,
    /// Of the noise on the output.
    pub noise: f64,
}

impl TransferFunction {
    /// The controller that costs least by these weights, closed by negative feedback: the plant's state estimated and fed back.
    pub fn lqg(&self, wish: &LqgWish) -> Result<Zpk, LinearError> {
        for (name, size) in [
            ("the output's size", wish.output),
            ("the input's size", wish.input),
            ("the disturbance's size", wish.disturbance),
            ("the noise's size", wish.noise),
            ("the integral's size", wish.integral.unwrap_or(1.0)),
        ] {
            positive(name, size)?;
        }
        let plant = self.state_space()?;
        if plant.order() == 0 {
            return Err(LinearError::Wish("it has no states: there is nothing to estimate".into()));
        }
        let one = |size: f64| Matrix::from_element(1, 1, size);
        let input = one(powi(wish.input, -2));
        let regulator = match wish.integral {
            None => plant.lqr_of_outputs(&one(powi(wish.output, -2)), &input)?,
            Some(integral) => {
                let weights = [powi(wish.output, -2), powi(integral, -2)];
                let weights = Matrix::from_diagonal(&weights.to_vec().into());
                plant.with_integrals()?.lqr_of_outputs(&weights, &input)?
            }
        };
        let pushed = plant.b() * plant.b().transpose() * powi(wish.disturbance, 2);
        let estimator = plant.kalman(&pushed, &one(powi(wish.noise, 2)))?;
        let controller = estimated(&plant, &regulator.gain, &estimator.gain)?;
        self.checked(controller, regulator.poles.into_iter().chain(estimator.poles))
    }

    /// The controller that puts the closed loop's poles there: the plant's state estimated, the estimate's error dying out by the poles
    /// of `estimator`, as many as the plant has. With one pole more in `poles` it integrates.
    pub fn placed(&self, poles: &[Complex], estimator: &[Complex]) -> Result<Zpk, LinearError> {
        let plant = self.state_space()?;
        let whole = if poles.len() == plant.order() + 1 { plant.with_integrals()? } else { plant.clone() };
        let gain = whole.place(poles)?;
        let dual = StateSpace::new(
            plant.a().transpose(),
            plant.c().transpose(),
            plant.b().transpose(),
            plant.d().transpose(),
            plant.time(),
        )?;
        let errors = dual.place(estimator)?.transpose();
        let controller = estimated(&plant, &gain, &errors)?;
        self.checked(controller, poles.iter().chain(estimator).copied())
    }

    /// The controller, if it closes the loop with these poles: those of regulator and estimator, whatever rounding did on the way.
    fn checked(&self, controller: Zpk, poles: impl Iterator<Item = Complex>) -> Result<Zpk, LinearError> {
        let poles: Vec<Complex> = poles.collect();
        let wanted = Polynomial::from_roots(1.0, &poles);
        let closed = controller.transfer().series(self)?.closed()?;
        // as coefficients in the unit of the poles' mean size: repeated poles scatter; of samples in z − 1
        let edge = self.time().at_rest();
        let n = poles.len() as f64;
        let size =
            exp(poles.iter().map(|z| ln(complex::norm(z - edge).max(f64::MIN_POSITIVE))).sum::<f64>() / n);
        let shift = Polynomial::new([size, edge.re]);
        let [is, should] =
            [closed.denominator(), &wanted].map(|p| p.substituted(&shift, &Polynomial::one(), p.degree()));
        let most = should.coefficients().iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        let off = (&is - &should).coefficients().iter().fold(0.0_f64, |most, c| most.max(c.abs())) / most;
        if closed.denominator().degree() == poles.len() && off < 1e-4 {
            return Ok(controller);
        }
        Err(LinearError::Wish(format!(
            "the closed loop's poles are off by {off:.0e} of their polynomial: too few digits for a system of that order, or for weights so far apart"
        )))
    }
}

/// From the output to the input: u = −K x̂, and the output's integral fed back, too, where K has one column more than there are states.
fn estimated(plant: &StateSpace, gain: &Matrix, estimator: &Matrix) -> Result<Zpk, LinearError> {
    let n = plant.order();
    let states = gain.columns(0, n).into_owned();
    let inner = plant.compensator(&states, estimator)?;
    if gain.ncols() == n {
        return inner.transfer(0, 0);
    }
    let integral = gain.columns(n, 1).into_owned();
    // what the integral does to the plant is told to the estimate
    let told = (estimator * plant.d() - plant.b()) * &integral;
    let (kept, step) = plant.time().integral();
    let a = stack(&[&[inner.a(), &told], &[&Matrix::zeros(1, n), &Matrix::from_element(1, 1, kept)]]);
    let b = stack(&[&[inner.b()], &[&Matrix::from_element(1, 1, step)]]);
    let c = stack(&[&[&states, &integral]]);
    StateSpace::new(a, b, c, Matrix::zeros(1, 1), plant.time())?.transfer(0, 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Discretization, Time};

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    const WISH: LqgWish = LqgWish { output: 1e-3, input: 1.0, integral: None, disturbance: 1.0, noise: 1e-4 };

    #[test]
    fn an_estimated_state_settles_a_head() {
        for text in
            ["13.16/(s(s+0.1316))", "13.33/(s^2+0.1333s+0.7822)", "5(s+2)/((s-1)(s^2+s+9))", "(s+2)/(s+1)"]
        {
            for integral in [None, Some(1e-4)] {
                let plant = parse(text);
                let controller = plant.lqg(&LqgWish { integral, ..WISH }).unwrap();
                assert_eq!(
                    controller.poles().contains(&Complex::ZERO),
                    integral.is_some(),
                    "{text}: {controller}"
                );
                let closed = plant.series(&controller.transfer()).unwrap().closed().unwrap();
                assert!(closed.poles().iter().all(|pole| pole.re < 0.0), "{text}: {closed}");
            }
        }
        let sampled = parse("13.16/(s(s+0.1316))").sampled(1e-3, Discretization::ZeroOrderHold).unwrap();
        let controller = sampled.lqg(&LqgWish { integral: Some(1e-4), ..WISH }).unwrap();
        let closed = sampled.series(&controller.transfer()).unwrap().closed().unwrap();
        assert!(closed.poles().iter().all(|pole| complex::norm(*pole) < 1.0), "{closed}");
        assert!(parse("1/s").lqg(&LqgWish { noise: 0.0, ..WISH }).is_err());
    }

    #[test]
    fn closed_poles_are_those_that_were_wished() {
        let plant = parse("13.16/(s(s+0.1316))");
        let real = |values: &[f64]| values.iter().map(|&re| Complex::new(re, 0.0)).collect::<Vec<_>>();
        let pair = [Complex::new(-40.0, 30.0), Complex::new(-40.0, -30.0)];
        for more in [&[][..], &[-15.0][..]] {
            let wanted = [&pair[..], &real(more)].concat();
            let controller = plant.placed(&wanted, &real(&[-200.0, -220.0])).unwrap();
            let closed = plant.series(&controller.transfer()).unwrap().closed().unwrap();
            for pole in wanted.iter().chain(&real(&[-200.0, -220.0])) {
                let nearest =
                    closed.poles().iter().map(|z| complex::norm(z - pole)).fold(f64::INFINITY, f64::min);
                assert!(nearest < 1e-6 * complex::norm(*pole), "{pole}: {:?}", closed.poles());
            }
        }
        assert!(plant.placed(&pair[..1], &pair).is_err());
    }
}
