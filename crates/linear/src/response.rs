use tracelight_maths::complex;

use crate::{Complex, LinearError, Matrix, StateSpace, Time, TransferFunction};

/// What a system of one input and one output does over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Response {
    /// Time from one value to the next, s.
    pub step_s: f64,
    /// The output, from time 0 on.
    pub values: Vec<f64>,
}

impl TransferFunction {
    /// Answer to a step of 1 at time 0, a value every `step_s` (of a sampled system: its period), exact at these times.
    pub fn step_response(&self, step_s: f64, count: usize) -> Result<Response, LinearError> {
        match self.time() {
            Time::Continuous => self.zpk().cascade("response")?.step_response(step_s, count),
            Time::Sampled(_) => self.response(step_s, &vec![1.0; count]),
        }
    }

    /// Answer to an input that is held from one value to the next.
    pub fn response(&self, step_s: f64, input: &[f64]) -> Result<Response, LinearError> {
        match self.time() {
            Time::Continuous => self.zpk().cascade("response")?.response(step_s, input),
            Time::Sampled(period_s) => Ok(Response { step_s: period_s, values: self.recursion(input)? }),
        }
    }

    /// The difference equation of a sampled system.
    fn recursion(&self, input: &[f64]) -> Result<Vec<f64>, LinearError> {
        let (above, below) = (self.numerator(), self.denominator().coefficients());
        let order = below.len() - 1;
        if above.degree() > order {
            return Err(LinearError::Improper { zeros: above.degree(), poles: order, what: "response" });
        }
        let above: Vec<f64> = (0..=order).rev().map(|power| above.coefficient(power)).collect();
        let mut output = Vec::with_capacity(input.len());
        for k in 0..input.len() {
            let ago = |values: &[f64], i: usize| k.checked_sub(i).map_or(0.0, |at| values[at]);
            let taken: f64 = (0..=order).map(|i| above[i] * ago(input, i)).sum();
            let kept: f64 = (1..=order).map(|i| below[i] * ago(&output, i)).sum();
            output.push(taken - kept);
        }
        Ok(output)
    }
}

impl StateSpace {
    /// Answer of one input and one output to a step of 1 at time 0, from rest; exact at these times.
    pub fn step_response(&self, step_s: f64, count: usize) -> Result<Response, LinearError> {
        let Discrete { a, b, c, d, step_s } = self.discrete(step_s)?;
        let n = a.nrows();
        // with what comes in as a state that stays, it goes on by itself
        let mut whole = Matrix::identity(n + 1, n + 1);
        whole.view_mut((0, 0), (n, n)).copy_from(&a);
        whole.view_mut((0, n), (n, 1)).copy_from(&b);
        let seen = Matrix::from_fn(1, n + 1, |_, j| if j < n { c[(0, j)] } else { d });
        Ok(Response { step_s, values: autonomous(&whole, seen, count) })
    }

    /// Answer of one input and one output to an input that is held from one value to the next, from rest; exact at these times.
    pub fn response(&self, step_s: f64, input: &[f64]) -> Result<Response, LinearError> {
        let Discrete { a, b, c, d, step_s } = self.discrete(step_s)?;
        Ok(Response { step_s, values: recursion(&a, b.as_slice(), c.as_slice(), d, input) })
    }

    /// As it goes on from value to value; a sampled system does so by itself.
    fn discrete(&self, step_s: f64) -> Result<Discrete, LinearError> {
        if (self.b().ncols(), self.c().nrows()) != (1, 1) {
            return Err(LinearError::Shape("a response is from one input to one output: take a channel"));
        }
        let ((a, b), step_s) = match self.time() {
            Time::Continuous => {
                (self.held_over(crate::time::positive("the time from value to value", step_s)?), step_s)
            }
            Time::Sampled(period_s) => ((self.a().clone(), self.b().clone()), period_s),
        };
        Ok(Discrete { a, b, c: self.c().clone(), d: self.d()[(0, 0)], step_s })
    }
}

/// yₖ = c xₖ + d uₖ, xₖ₊₁ = A xₖ + b uₖ.
struct Discrete {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    d: f64,
    step_s: f64,
}

/// yₖ = c Aᵏ x₀ where the last state is 1 at first and the others 0: many values at once from one state, and then on to the state as
/// many values later.
fn autonomous(a: &Matrix, mut seen: Matrix, count: usize) -> Vec<f64> {
    const AT_ONCE: usize = 16;
    let n = a.nrows();
    let mut rows = Matrix::zeros(AT_ONCE, n);
    for i in 0..AT_ONCE {
        rows.row_mut(i).copy_from(&seen.row(0));
        seen = &seen * a;
    }
    let on = a.pow(AT_ONCE as u32);
    let (mut x, mut next) = (Matrix::zeros(n, 1), Matrix::zeros(n, 1));
    x[(n - 1, 0)] = 1.0;
    let mut values = vec![0.0; count.next_multiple_of(AT_ONCE)];
    for block in values.chunks_exact_mut(AT_ONCE) {
        for (column, x) in rows.as_slice().chunks_exact(AT_ONCE).zip(x.iter()) {
            block.iter_mut().zip(column).for_each(|(y, c)| *y += c * x);
        }
        on.mul_to(&x, &mut next);
        std::mem::swap(&mut x, &mut next);
    }
    values.truncate(count);
    values
}

/// From rest.
fn recursion(a: &Matrix, b: &[f64], c: &[f64], d: f64, input: &[f64]) -> Vec<f64> {
    let n = a.nrows();
    let (mut x, mut next) = (vec![0.0; n], vec![0.0; n]);
    let mut values = Vec::with_capacity(input.len());
    for &u in input {
        values.push(c.iter().zip(&x).map(|(c, x)| c * x).sum::<f64>() + d * u);
        next.iter_mut().zip(b).for_each(|(next, b)| *next = b * u);
        for (column, x) in a.as_slice().chunks_exact(n.max(1)).zip(&x) {
            next.iter_mut().zip(column).for_each(|(next, a)| *next += a * x);
        }
        std::mem::swap(&mut x, &mut next);
    }
    values
}

impl Response {
    /// Largest distance from zero, with its sign, and when, s.
    pub fn peak(&self) -> (f64, f64) {
        let larger =
            |best: (f64, usize), (i, &v): (usize, &f64)| if v.abs() > best.0.abs() { (v, i) } else { best };
        let (value, place) = self.values.iter().enumerate().fold((0.0, 0), larger);
        (value, place as f64 * self.step_s)
    }

    /// When a function of the value first becomes positive, s, between two values as a line would.
    pub(crate) fn first(&self, above: impl Fn(f64) -> f64) -> Option<f64> {
        let place = self.values.iter().position(|&value| above(value) >= 0.0)?;
        let Some(before) = place.checked_sub(1) else { return Some(0.0) };
        let (low, high) = (above(self.values[before]), above(self.values[place]));
        Some((before as f64 + low / (low - high)) * self.step_s)
    }
}

/// How a pole alone would answer: what oscillates, how fast it dies out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// The pole.
    pub pole: Complex,
    /// Natural frequency, rad/s.
    pub natural_rad_s: f64,
    /// Damping, 1 of what does not oscillate, negative of what grows.
    pub damping: f64,
}

impl Mode {
    /// Of a pole. What is over at once, as a pole at z = 0, has an infinite frequency; what stays, at 0, none.
    pub fn of(pole: Complex, time: Time) -> Self {
        let s = time.continuous(pole);
        let natural_rad_s = complex::norm(s);
        let oscillates = natural_rad_s > 0.0 && natural_rad_s.is_finite();
        Self { pole, natural_rad_s, damping: if oscillates { -s.re / natural_rad_s } else { 1.0 } }
    }
}

impl TransferFunction {
    /// Natural frequency and damping of each pole.
    pub fn modes(&self) -> Vec<Mode> {
        self.poles().into_iter().map(|pole| Mode::of(pole, self.time())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    #[test]
    fn a_pair_of_poles_answers_as_the_textbook_says() {
        let (w, zeta) = (20.0_f64, 0.5_f64);
        let g = parse("400/(s^2 + 20 s + 400)");
        let response = g.step_response(1e-3, 2000).unwrap();
        let damped = w * (1.0 - zeta * zeta).sqrt();
        for (k, value) in response.values.iter().enumerate() {
            let t = k as f64 * 1e-3;
            let swing = (damped * t).cos() + zeta * w / damped * (damped * t).sin();
            assert!((value - (1.0 - (-zeta * w * t).exp() * swing)).abs() < 1e-13, "{t}");
        }
        let info = g.step_info(0.02).unwrap();
        let expected = 100.0 * (-std::f64::consts::PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
        assert!((info.overshoot_percent.unwrap() - expected).abs() < 1e-11, "{info:?}");
        let peak_s = info.peak.and_then(|peak| peak.time_s).unwrap();
        assert!((peak_s - std::f64::consts::PI / damped).abs() < 1e-8, "{info:?}");
        assert!(
            (info.rise_s.unwrap() - 0.0819).abs() < 1e-4 && (info.settle_s.unwrap() - 0.4038).abs() < 1e-4
        );
        assert!((g.modes()[0].damping - 0.5).abs() < 1e-12);
    }

    #[test]
    fn integrators_go_on_and_what_goes_straight_through_is_there_at_once() {
        let ramp = parse("2/s").step_response(0.5, 4).unwrap();
        assert_eq!(ramp.values, [0.0, 1.0, 2.0, 3.0]);
        let lead = parse("(s+4)/(s+2)").step_response(0.1, 100).unwrap();
        assert!((lead.values[0] - 1.0).abs() < 1e-15 && (lead.values[99] - 2.0).abs() < 1e-8);
        assert!(parse("s").step_response(0.1, 3).is_err() && parse("1/s").step_response(0.0, 3).is_err());
        assert_eq!(parse("3").step_response(0.1, 2).unwrap().values, [3.0, 3.0]);
    }

    #[test]
    fn a_sampled_system_answers_as_the_one_it_was_sampled_from() {
        let g = parse("5 (s+3)/((s+1)(s^2+s+40))");
        let sampled = g.sampled(0.05, crate::Discretization::ZeroOrderHold).unwrap();
        let (here, there) = (g.step_response(0.05, 300).unwrap(), sampled.step_response(1.0, 300).unwrap());
        assert_eq!(there.step_s, 0.05);
        assert!(here.values.iter().zip(&there.values).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn slow_and_fast_keep_their_digits() {
        // 1e-3 and 1e5 rad/s beside each other
        let response = parse("100/((s+1e-3)(s+1e5))").step_response(100.0, 200).unwrap();
        // squaring an exponential 23 times leaves eight digits of the slow one
        for (k, value) in response.values.iter().enumerate().skip(1) {
            let t = 100.0 * k as f64;
            // the fast part is over at once
            let expected = 1.0 - (-1e-3 * t).exp() * (1e5 / (1e5 - 1e-3));
            assert!((value - expected).abs() < 1e-8, "{t}: {value} {expected}");
        }
    }
}
