use std::f64::consts::{PI, TAU};

use tracelight_maths::complex;

use crate::stability::{Stability, stabilities};
use crate::{Complex, Polynomial, Time, TransferFunction};

/// What each zero and pole turns, seen from where it turns by less than half a turn, so that nothing has to be followed from
/// frequency to frequency. What is at the edge of stability counts as stable, and turns by half a turn at its frequency.
pub(crate) struct Turns {
    time: Time,
    /// Whether what does not turn is negative: half a turn, backwards.
    is_negative: bool,
    /// In continuous time.
    quadratics: Vec<Quadratic>,
    /// Of samples.
    factors: Vec<Factor>,
    /// Of samples: how many factors were divided by z, which turns with the frequency.
    by_variable: f64,
}

/// Two roots that turn the same way, or one, in continuous time: (|p| + jω)(|q| + jω) = c₀ − c₂ ω² + j c₁ ω turns by no more than
/// half a turn.
struct Quadratic {
    forwards: bool,
    c0: f64,
    c1: f64,
    c2: f64,
}

/// What a zero or pole of samples turns, as a number whose real part is positive at all frequencies, or 0 at the edge: 1 − root/at
/// inside, 1 − at/root outside.
struct Factor {
    root: Complex,
    is_inside: bool,
    is_zero: bool,
}

impl Turns {
    pub(crate) fn of(system: &TransferFunction) -> Self {
        let time = system.time();
        let factors = |p: &Polynomial, is_zero: bool| {
            let factor = move |(root, stability): (Complex, Stability)| {
                let root = match (stability, time) {
                    (Stability::Marginal, Time::Continuous) => Complex::new(0.0, root.im),
                    (Stability::Marginal, Time::Sampled(_)) => root / complex::norm(root),
                    _ => root,
                };
                Factor { root, is_inside: stability != Stability::Growing, is_zero }
            };
            stabilities(p, time).into_iter().map(factor)
        };
        let factors: Vec<Factor> =
            factors(system.numerator(), true).chain(factors(system.denominator(), false)).collect();
        let swaps = factors.iter().filter(|f| !f.is_inside && f.root.re > 0.0).count();
        let is_negative = (swaps % 2 == 1) != (system.numerator().leading() < 0.0);
        let inside = factors.iter().filter(|f| f.is_inside);
        let by_variable = inside.map(|f| if f.is_zero { 1.0 } else { -1.0 }).sum();
        let quadratics = if time == Time::Continuous { quadratics(&factors) } else { Vec::new() };
        Self { time, is_negative, quadratics, factors, by_variable }
    }

    /// Phases of these values at these frequencies, which rise: their arguments, and so many whole turns.
    pub(crate) fn phases(&self, rad_s: &[f64], values: &[Complex]) -> Vec<f64> {
        const BLOCK: usize = 16;
        let mut phases = Vec::with_capacity(values.len());
        for (rad_s, values) in rad_s.chunks(BLOCK).zip(values.chunks(BLOCK)) {
            let known = if self.turn_little(rad_s) { 1 } else { values.len() };
            for (i, (&w, &value)) in rad_s.iter().zip(values).enumerate() {
                let about = match phases.last() {
                    Some(last) if i >= known => *last,
                    _ => self.about(w),
                };
                phases.push(nearest(about, value));
            }
        }
        phases
    }

    /// Whether all together turn by less than half a turn from the first of these frequencies to the last, on no way by more: in
    /// continuous time each turns but one way.
    fn turn_little(&self, rad_s: &[f64]) -> bool {
        let (Some(&first), Some(&last)) = (rad_s.first(), rad_s.last()) else { return false };
        let turned = |forwards: bool| {
            let [from, to] = [first, last].map(|w| self.turned(w, |q| q.forwards == forwards));
            (complex::arg(to.product) - complex::arg(from.product) + TAU * f64::from(to.turns - from.turns))
                .abs()
        };
        self.time == Time::Continuous && rad_s.is_sorted() && turned(true) + turned(false) < 0.9 * PI
    }

    /// Phase at a frequency where the value is that.
    pub(crate) fn phase(&self, rad_s: f64, value: Complex) -> f64 {
        nearest(self.about(rad_s), value)
    }

    /// Phase to an eighth of a turn.
    fn about(&self, rad_s: f64) -> f64 {
        let own = if self.is_negative { -PI } else { 0.0 };
        let (turned, by_variable) = match self.time {
            Time::Continuous => (self.turned(rad_s, |_| true), 0.0),
            Time::Sampled(period_s) => {
                let at = self.time.at_frequency(rad_s);
                let mut turned = Turned::default();
                for factor in &self.factors {
                    let by = factor.at(at);
                    turned.by(by, by.im >= 0.0);
                }
                (turned, self.by_variable * rad_s * period_s)
            }
        };
        own + by_variable + turned.octant_rad() + TAU * f64::from(turned.turns)
    }

    /// By some of the quadratics.
    fn turned(&self, rad_s: f64, which: impl Fn(&Quadratic) -> bool) -> Turned {
        let mut turned = Turned::default();
        for quadratic in self.quadratics.iter().filter(|q| which(q)) {
            turned.by(quadratic.at(rad_s), quadratic.forwards);
        }
        turned
    }
}

/// The value's argument and so many whole turns that it is near an angle; at a zero or a pole, where it has none, that angle. Roots are
/// a little off, the value is not.
fn nearest(about: f64, value: Complex) -> f64 {
    if value == Complex::ZERO || !value.is_finite() {
        return about;
    }
    let exact = complex::arg(value);
    exact + TAU * ((about - exact) / TAU).round()
}

fn quadratics(factors: &[Factor]) -> Vec<Quadratic> {
    let mut quadratics = Vec::new();
    for forwards in [true, false] {
        let sign = if forwards { 1.0 } else { -1.0 };
        let ours = || factors.iter().filter(|f| (f.is_inside == f.is_zero) == forwards);
        let pairs = ours().filter(|f| f.root.im > 0.0).map(|f| f.root);
        quadratics.extend(pairs.map(|root| Quadratic {
            forwards,
            c0: root.norm_sqr(),
            c1: sign * 2.0 * root.re.abs(),
            c2: 1.0,
        }));
        let real: Vec<f64> = ours().filter(|f| f.root.im == 0.0).map(|f| f.root.re.abs()).collect();
        quadratics.extend(real.chunks(2).map(|some| match some {
            [p, q] => Quadratic { forwards, c0: p * q, c1: sign * (p + q), c2: 1.0 },
            _ => Quadratic { forwards, c0: some[0], c1: sign, c2: 0.0 },
        }));
    }
    quadratics
}

impl Quadratic {
    fn at(&self, rad_s: f64) -> Complex {
        Complex::new(self.c0 - self.c2 * rad_s * rad_s, self.c1 * rad_s)
    }
}

impl Factor {
    fn at(&self, at: Complex) -> Complex {
        // 1/at is its conjugate
        let turned = if self.is_inside { 1.0 - self.root * at.conj() } else { 1.0 - at / self.root };
        if self.is_zero { turned } else { turned.conj() }
    }
}

/// A product of factors that turn by no more than half a turn each, and how often it has gone round. Its argument is in [−π, π).
struct Turned {
    product: Complex,
    turns: i32,
}

impl Default for Turned {
    fn default() -> Self {
        Self { product: Complex::ONE, turns: 0 }
    }
}

/// Whether an argument is in [0, π).
fn is_above(z: Complex) -> bool {
    z.im > 0.0 || (z.im == 0.0 && z.re >= 0.0)
}

impl Turned {
    /// Turned on by a factor: forwards by up to π, or backwards.
    fn by(&mut self, factor: Complex, forwards: bool) {
        if factor == Complex::ZERO {
            return;
        }
        let mut next = self.product * factor;
        match (is_above(self.product), is_above(next)) {
            (true, false) if forwards => self.turns += 1,
            (false, true) if !forwards => self.turns -= 1,
            _ => {}
        }
        let size = next.re.abs().max(next.im.abs());
        if !(1e-100..1e100).contains(&size) {
            next /= size;
        }
        self.product = next;
    }

    /// The middle of the eighth of a turn its argument is in.
    fn octant_rad(&self) -> f64 {
        let Complex { re, im } = self.product;
        let first = if im.abs() < re.abs() { PI / 8.0 } else { 3.0 * PI / 8.0 };
        let about = if re < 0.0 { PI - first } else { first };
        if is_above(self.product) { about } else { -about }
    }
}
