use tracelight_maths::{complex, cos, exp, exp_m1, log2, powi, sin, tan};

use crate::eigen::balanced;
use crate::time::positive;
use crate::twofold::Twofold;
use crate::{Complex, LinearError, Matrix, Polynomial, StateSpace, Time, TransferFunction};

/// How a system in continuous time becomes one of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Discretization {
    /// s = (2/T) (z − 1)/(z + 1); with a frequency, rad/s, at which both then are the same.
    Tustin(Option<f64>),
    /// Its input is held from sample to sample: exact for a plant behind a converter.
    ZeroOrderHold,
    /// Its input goes straight from sample to sample: exact for what is piecewise linear, and nearer to a smooth input.
    FirstOrderHold,
    /// Its impulse response is sampled, times T; only of what lets nothing straight through.
    Impulse,
    /// Poles and zeros go by z = e^(sT); a zero at infinity, all but one, to −1; gains agree where nothing changes.
    Matched,
}

impl TransferFunction {
    /// A sample every `period_s`. Already sampled systems are refused, and so are more zeros than poles where there is no way to
    /// have them.
    pub fn sampled(&self, period_s: f64, how: Discretization) -> Result<Self, LinearError> {
        let time = Time::sampled(period_s)?;
        self.time().with(Time::Continuous)?;
        match how {
            Discretization::Tustin(prewarp) => self.tustin(tustin_rate(period_s, prewarp)?, time),
            Discretization::ZeroOrderHold => self.held(period_s, time),
            Discretization::FirstOrderHold | Discretization::Impulse => self.by_states(period_s, how, time),
            Discretization::Matched => self.matched(period_s, time),
        }
    }

    fn tustin(&self, rate: f64, time: Time) -> Result<Self, LinearError> {
        let (above, below) = (Polynomial::new([rate, -rate]), Polynomial::new([1.0, 1.0]));
        let power = self.numerator().degree().max(self.denominator().degree());
        let [numerator, denominator] =
            [self.numerator(), self.denominator()].map(|p| p.substituted(&above, &below, power));
        Self::new(numerator, denominator, time)
    }

    fn held(&self, period_s: f64, time: Time) -> Result<Self, LinearError> {
        let system = self.zpk().cascade("zero-order hold")?;
        let impulse = system.impulse_samples(period_s, system.order() + 1)?;
        self.with_samples(&impulse, period_s, time)
    }

    /// Sampled in state space.
    fn by_states(&self, period_s: f64, how: Discretization, time: Time) -> Result<Self, LinearError> {
        let system = self.zpk().cascade("samples")?.sampled(period_s, how)?;
        let mut impulse = vec![system.d()[(0, 0)]];
        let mut x = system.b().clone();
        while impulse.len() <= system.order() {
            impulse.push((system.c() * &x)[(0, 0)]);
            x = system.a() * x;
        }
        self.with_samples(&impulse, period_s, time)
    }

    /// Of those first samples of its impulse response, one more than its order.
    fn with_samples(&self, impulse: &[f64], period_s: f64, time: Time) -> Result<Self, LinearError> {
        let order = impulse.len() - 1;
        let denominator = Polynomial::from_roots(1.0, &mapped(&self.poles(), period_s)?);
        // the numerator is what makes the first samples of the impulse response right
        let numerator: Vec<f64> = (0..=order)
            .map(|k| (0..=k).map(|j| denominator.coefficients()[j] * impulse[k - j]).sum())
            .collect();
        Self::new(Polynomial::new(numerator), denominator, time)
    }

    fn matched(&self, period_s: f64, time: Time) -> Result<Self, LinearError> {
        let (zeros, poles) = (self.zeros(), self.poles());
        if zeros.len() > poles.len() {
            return Err(LinearError::Improper {
                zeros: zeros.len(),
                poles: poles.len(),
                what: "matched samples",
            });
        }
        let (mut there, poles_there) = (mapped(&zeros, period_s)?, mapped(&poles, period_s)?);
        there.resize(poles.len().saturating_sub(1).max(zeros.len()), Complex::new(-1.0, 0.0));
        // where nothing changes, s and (z − 1)/T are alike: what a factor s − root is there over what z − e^(root T) is
        let ratio = |root: &Complex| match *root {
            Complex::ZERO => Complex::from(1.0 / period_s),
            root => root / less_one(root * period_s),
        };
        let ratios = |roots: &[Complex]| roots.iter().map(ratio).collect::<Vec<_>>();
        // one of a zero for one of a pole, so that no product leaves the range of numbers
        let (above, below) = (ratios(&zeros), ratios(&poles));
        let added = (there.len() - zeros.len()) as i32;
        let pairs = (0..above.len().max(below.len())).map(|i| {
            let of = |ratios: &[Complex]| ratios.get(i).copied().unwrap_or(Complex::ONE);
            of(&above) / of(&below)
        });
        let gain = self.numerator().leading() * pairs.product::<Complex>().re / powi(2.0, added);
        Self::new(Polynomial::from_roots(gain, &there), Polynomial::from_roots(1.0, &poles_there), time)
    }
}

/// e^(sT) of each; what grows beyond all numbers from sample to sample has none.
fn mapped(roots: &[Complex], period_s: f64) -> Result<Vec<Complex>, LinearError> {
    let mapped: Vec<Complex> = roots.iter().map(|root| complex::exp(root * period_s)).collect();
    if mapped.iter().all(|root| root.is_finite()) { Ok(mapped) } else { Err(LinearError::NotFinite) }
}

/// e^z − 1, to all digits where z is small.
fn less_one(z: Complex) -> Complex {
    let half = sin(0.5 * z.im);
    Complex::new(exp_m1(z.re) * cos(z.im) - 2.0 * half * half, exp(z.re) * sin(z.im))
}

impl StateSpace {
    /// A sample every `period_s`; [`Discretization::Matched`] is of transfer functions alone.
    pub fn sampled(&self, period_s: f64, how: Discretization) -> Result<Self, LinearError> {
        let time = Time::sampled(period_s)?;
        self.time().with(Time::Continuous)?;
        match how {
            Discretization::ZeroOrderHold => {
                let (a, b) = self.held_over(period_s);
                Self::new(a, b, self.c().clone(), self.d().clone(), time)
            }
            Discretization::Tustin(prewarp) => self.tustin(tustin_rate(period_s, prewarp)?, time),
            Discretization::FirstOrderHold => self.ramped(period_s, time),
            Discretization::Impulse => {
                if self.d().iter().any(|entry| *entry != 0.0) {
                    return Err(LinearError::Shape(
                        "what goes straight through has an impulse that no sample can be: hold it instead",
                    ));
                }
                let (a, _) = self.held_over(period_s);
                let b = &a * self.b() * period_s;
                Self::new(a, b, self.c().clone(), self.c() * self.b() * period_s, time)
            }
            Discretization::Matched => Err(LinearError::Shape("only a transfer function is matched")),
        }
    }

    /// (s − A)⁻¹ with s replaced, such that a sample is what a held input makes of the one before (Franklin, Powell & Workman,
    /// *Digital Control of Dynamic Systems*, §6.1).
    fn tustin(&self, rate: f64, time: Time) -> Result<Self, LinearError> {
        let n = self.order();
        let one = Matrix::identity(n, n);
        let singular = LinearError::Shape("a pole is at 2/T, where Tustin's rule has none");
        let inverse = (&one * rate - self.a()).try_inverse().ok_or(singular)?;
        let a = (&one * rate + self.a()) * &inverse;
        let root = (2.0 * rate).sqrt();
        let b = &inverse * self.b() * root;
        let c = self.c() * &inverse * root;
        Self::new(a, b, c, self.d() + self.c() * &inverse * self.b(), time)
    }

    /// With the slope of the input as one more state: e of [A, B, 0; 0, 0, 1/T; 0, 0, 0] T (Franklin, Powell & Workman, *Digital Control of
    /// Dynamic Systems*, §6.3.2), then in states that do not need the next input.
    fn ramped(&self, period_s: f64, time: Time) -> Result<Self, LinearError> {
        let (n, inputs) = (self.order(), self.b().ncols());
        let mut a = Matrix::zeros(n + inputs, n + inputs);
        a.view_mut((0, 0), (n, n)).copy_from(self.a());
        a.view_mut((0, n), (n, inputs)).copy_from(self.b());
        let mut b = Matrix::zeros(n + inputs, inputs);
        b.view_mut((n, 0), (inputs, inputs)).copy_from(&(Matrix::identity(inputs, inputs) / period_s));
        let whole =
            Self::new(a, b, Matrix::zeros(1, n + inputs), Matrix::zeros(1, inputs), Time::Continuous)?;
        let (on, rise) = whole.held_over(period_s);
        let a = on.view((0, 0), (n, n)).into_owned();
        let (held, risen) = (on.view((0, n), (n, inputs)).into_owned(), rise.rows(0, n).into_owned());
        let b = &a * &risen + held - &risen;
        Self::new(a, b, self.c().clone(), self.d() + self.c() * risen, time)
    }

    /// e^(A t) and ∫ e^(A τ) B dτ from 0 to t: both from one exponential (Van Loan, *Computing integrals involving the matrix
    /// exponential*, IEEE Trans. Autom. Control 23, 1978).
    pub(crate) fn held_over(&self, time_s: f64) -> (Matrix, Matrix) {
        let (n, inputs) = (self.order(), self.b().ncols());
        let mut whole = Matrix::zeros(n + inputs, n + inputs);
        whole.view_mut((0, 0), (n, n)).copy_from(&(self.a() * time_s));
        whole.view_mut((0, n), (n, inputs)).copy_from(&(self.b() * time_s));
        // balanced, its norm is about that of its eigenvalues: the less has to be squared
        let (whole, scales) = balanced(whole);
        let mut whole = exponential(&whole);
        for (i, scale) in scales.iter().enumerate() {
            whole.row_mut(i).iter_mut().for_each(|entry| *entry *= scale);
            whole.column_mut(i).iter_mut().for_each(|entry| *entry /= scale);
        }
        (whole.view((0, 0), (n, n)).into_owned(), whole.view((0, n), (n, inputs)).into_owned())
    }

    /// What a pulse of a held 1 comes out as, sample by sample, of one input and one output.
    fn impulse_samples(&self, period_s: f64, count: usize) -> Result<Vec<f64>, LinearError> {
        let (a, mut x) = self.held_over(period_s);
        let mut samples = vec![self.d()[(0, 0)]];
        while samples.len() < count {
            samples.push((self.c() * &x)[(0, 0)]);
            x = &a * x;
        }
        if samples.iter().all(|sample| sample.is_finite()) {
            Ok(samples)
        } else {
            Err(LinearError::NotFinite)
        }
    }
}

/// e^A by its series on a small part of A, squared again and again, in twice the digits: each squaring doubles what rounding has
/// left, and of poles decades apart the slow one is squared some twenty times.
///
/// Padé's quotient would be as good beside the largest entry. Here small entries count: at the end of a chain of integrators one is
/// a high power of the time, and the series has it to all digits.
pub(crate) fn exponential(a: &Matrix) -> Matrix {
    /// 1/28! of a norm of at most 1 is less than rounding in twice the digits.
    const TERMS: usize = 28;
    let n = a.nrows();
    let norm = a.row_iter().map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = if norm > 1.0 { log2(norm).ceil().min(1100.0) as i32 } else { 0 };
    let small = Twofold::of(a * powi(0.5, halvings));
    let mut term = Twofold::of(Matrix::identity(n, n));
    let mut sum = term.clone();
    for k in 1..=TERMS {
        term = term.times(&small).over(k as f64);
        sum = sum.plus(&term);
    }
    (0..halvings).fold(sum, |power, _| power.times(&power)).rounded()
}

/// What s becomes a multiple of.
fn tustin_rate(period_s: f64, prewarp_rad_s: Option<f64>) -> Result<f64, LinearError> {
    let Some(prewarp) = prewarp_rad_s else { return Ok(2.0 / period_s) };
    let prewarp = positive("the frequency of the pre-warp, rad/s,", prewarp)?;
    if prewarp * period_s >= std::f64::consts::PI {
        let below =
            format!(" and less than half the sampling frequency, {} rad/s", std::f64::consts::PI / period_s);
        return Err(LinearError::Range {
            name: "the frequency of the pre-warp, rad/s,",
            value: prewarp,
            below,
        });
    }
    Ok(prewarp / tan(0.5 * prewarp * period_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    fn near(a: &Polynomial, b: &[f64], name: &str) {
        assert_eq!(a.coefficients().len(), b.len(), "{name}: {a}");
        let size = b.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        for (x, y) in a.coefficients().iter().zip(b) {
            assert!((x - y).abs() < 1e-13 * size, "{name}: {a} is not {b:?}");
        }
    }

    #[test]
    fn an_integrator_and_a_lag_become_what_the_textbook_says() {
        let period = 0.1;
        let e = (-2.0_f64 * period).exp();
        let hold = Discretization::ZeroOrderHold;
        let double = parse("1/s^2").sampled(period, hold).unwrap();
        near(double.numerator(), &[0.005, 0.005], "double integrator");
        near(double.denominator(), &[1.0, -2.0, 1.0], "double integrator");
        let lag = parse("3/(s+2)").sampled(period, hold).unwrap();
        near(lag.numerator(), &[1.5 * (1.0 - e)], "lag");
        near(lag.denominator(), &[1.0, -e], "lag");
        let tustin = parse("3/(s+2)").sampled(period, Discretization::Tustin(None)).unwrap();
        near(tustin.numerator(), &[3.0 / 22.0, 3.0 / 22.0], "Tustin");
        near(tustin.denominator(), &[1.0, -18.0 / 22.0], "Tustin");
        let matched = parse("3/(s+2)").sampled(period, Discretization::Matched).unwrap();
        near(matched.numerator(), &[1.5 * (1.0 - e)], "matched");
        let through = parse("(s+5)/(s+2)").sampled(period, hold).unwrap();
        near(through.numerator(), &[1.0, 1.5 * (1.0 - e) - e], "what goes straight through");
    }

    /// A ramp is met at every sample, and a lag is what the textbook's triangle hold makes of it.
    #[test]
    fn a_first_order_hold_is_exact_for_straight_inputs() {
        let g = parse("(2s+7)/((s+1)(s^2+s+4))");
        let (period, slope) = (0.3, 0.8);
        let ramp: Vec<f64> = (0..40).map(|k| slope * period * f64::from(k)).collect();
        let ours =
            g.sampled(period, Discretization::FirstOrderHold).unwrap().response(period, &ramp).unwrap();
        let truth = g.series(&parse("0.8/s")).unwrap().step_response(period, 40).unwrap();
        for (a, b) in ours.values.iter().zip(&truth.values) {
            assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} {b}");
        }
        let lag = parse("1/(s+1)").sampled(1.0, Discretization::FirstOrderHold).unwrap();
        let e = (-1.0_f64).exp();
        near(lag.numerator(), &[e, 1.0 - 2.0 * e], "lag");
    }

    #[test]
    fn an_invariant_impulse_is_that_of_the_samples() {
        let sampled = parse("3/(s+2)").sampled(0.1, Discretization::Impulse).unwrap();
        near(sampled.numerator(), &[0.3, 0.0], "lag");
        near(sampled.denominator(), &[1.0, -(-0.2_f64).exp()], "lag");
        assert!(parse("(s+5)/(s+2)").sampled(0.1, Discretization::Impulse).is_err());
    }

    #[test]
    fn a_pre_warp_makes_one_frequency_agree() {
        let g = parse("100 (s+1)/(s^2 + 2 s + 100)");
        let sampled = g.sampled(0.1, Discretization::Tustin(Some(10.0))).unwrap();
        let (here, there) =
            (g.at(Complex::new(0.0, 10.0)), sampled.at(Time::Sampled(0.1).at_frequency(10.0)));
        assert!(complex::norm(here - there) < 1e-11 * complex::norm(here), "{here} {there}");
        assert!(g.sampled(0.1, Discretization::Tustin(Some(40.0))).is_err());
    }

    #[test]
    fn state_space_and_transfer_functions_agree() {
        let g = parse("7 (s+3)/((s+1)(s^2 + s + 4))");
        for how in [
            Discretization::ZeroOrderHold,
            Discretization::FirstOrderHold,
            Discretization::Tustin(None),
            Discretization::Tustin(Some(2.0)),
            Discretization::Impulse,
        ] {
            let one = g.sampled(0.2, how).unwrap();
            let other =
                g.state_space().unwrap().sampled(0.2, how).unwrap().transfer(0, 0).unwrap().transfer();
            for turn in [0.1, 1.0, 3.0] {
                let at = complex::from_polar(1.0, turn);
                assert!(
                    complex::norm(one.at(at) - other.at(at)) < 1e-11 * complex::norm(one.at(at)),
                    "{how:?}"
                );
            }
        }
    }

    #[test]
    fn matched_gains_agree_where_nothing_changes() {
        let g = parse("5 (s+3)/(s (s+1)(s+9))");
        let sampled = g.sampled(0.01, Discretization::Matched).unwrap();
        assert_eq!(sampled.zeros().len(), 2);
        // both rise by 5·3/9 a second
        let slope = |g: &TransferFunction, at: Complex, by: Complex| (g.at(at) * by).re;
        let here = slope(&g, Complex::new(1e-5, 0.0), Complex::new(1e-5, 0.0));
        let there = slope(&sampled, Complex::new(1.0 + 1e-7, 0.0), Complex::new(1e-5, 0.0));
        assert!((here / there - 1.0).abs() < 1e-5, "{here} {there}");
    }

    #[test]
    fn what_cannot_be_sampled_is_refused() {
        let g = parse("s");
        assert!(g.sampled(0.1, Discretization::ZeroOrderHold).is_err());
        assert!(g.sampled(0.1, Discretization::Matched).is_err());
        assert!(g.sampled(0.0, Discretization::Tustin(None)).is_err());
        assert!(g.sampled(f64::NAN, Discretization::Tustin(None)).is_err());
        for how in [Discretization::ZeroOrderHold, Discretization::Matched] {
            assert_eq!(parse("0/(s-1)").sampled(1000.0, how), Err(LinearError::NotFinite));
        }
        let sampled = parse("1/(s+1)").sampled(0.1, Discretization::ZeroOrderHold).unwrap();
        assert!(sampled.sampled(0.1, Discretization::ZeroOrderHold).is_err());
    }
}
