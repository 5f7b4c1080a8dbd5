use std::f64::consts::{PI, TAU};

use tracelight_maths::{atan, complex, ln};

use crate::binary::{join, split};
use crate::{Complex, Polynomial, Time, TransferFunction};

/// How far an open loop is from oscillating once it is closed by negative feedback.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Margins {
    /// Where the loop's value is real and negative: by what factor its gain may change; those below 1 say how far it may fall.
    pub gain: Vec<GainMargin>,
    /// Where the loop's gain is 1: by how much its phase may change, and for how long it may be late.
    pub phase: Vec<PhaseMargin>,
    /// Where it comes closest to −1.
    pub modulus: Option<ModulusMargin>,
    /// The loop's value is real at every frequency: [`gain`](Self::gain) has the ends alone.
    pub is_always_real: bool,
    /// The loop's gain is 1 at every frequency: none of them stands out.
    pub is_always_one: bool,
}

/// See [`Margins::gain`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainMargin {
    /// Frequency, rad/s.
    pub rad_s: f64,
    /// Factor that makes it −1.
    pub factor: f64,
}

/// See [`Margins::phase`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseMargin {
    /// Frequency, rad/s.
    pub rad_s: f64,
    /// Lag that makes it −1, rad, in (−π, π].
    pub phase_rad: f64,
    /// Delay that does, s.
    pub delay_s: f64,
}

/// See [`Margins::modulus`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModulusMargin {
    /// Frequency, rad/s; infinite where it is nearest at the very end.
    pub rad_s: f64,
    /// Distance from −1: one over the largest sensitivity.
    pub distance: f64,
}

impl Margins {
    /// The gain margin nearest to 1, either way.
    pub fn least_gain(&self) -> Option<GainMargin> {
        self.gain.iter().copied().min_by(|a, b| ln(a.factor).abs().total_cmp(&ln(b.factor).abs()))
    }

    /// The phase margin nearest to 0, either way.
    pub fn least_phase(&self) -> Option<PhaseMargin> {
        self.phase.iter().copied().min_by(|a, b| a.phase_rad.abs().total_cmp(&b.phase_rad.abs()))
    }

    /// The shortest delay that makes it oscillate.
    pub fn least_delay(&self) -> Option<PhaseMargin> {
        self.phase.iter().copied().min_by(|a, b| a.delay_s.total_cmp(&b.delay_s))
    }
}

impl TransferFunction {
    /// Margins of this open loop.
    ///
    /// Crossings are roots of polynomials, none is missed between grid points: squares of absolute values are polynomials
    /// in ω², of samples in tan² ωT/2. Each is then refined on the transfer function itself.
    pub fn margins(&self) -> Margins {
        let along = Along::of(self);
        Margins {
            gain: self.gain_margins(&along),
            phase: self.phase_margins(&along),
            modulus: self.modulus_margin(&along),
            is_always_real: along.is_always_real(),
            is_always_one: along.is_always_one(),
        }
    }

    /// Frequencies at which the absolute value is 1, rad/s, rising.
    pub(crate) fn gain_crossings(&self) -> Vec<f64> {
        self.gain_crossings_along(&Along::of(self))
    }

    fn gain_crossings_along(&self, along: &Along) -> Vec<f64> {
        if along.is_always_one() {
            return Vec::new();
        }
        let crossings = along.frequencies(&(&square(&along.above) - &square(&along.below)));
        crossings
            .into_iter()
            .map(|w| self.refined(w, |value| ln(complex::norm(value)), |slope| slope.re))
            .collect()
    }

    /// The value at a frequency, where it rests from its gain there.
    pub(crate) fn value(&self, rad_s: f64) -> Complex {
        if rad_s == 0.0 { self.dc_gain().into() } else { self.at(self.time().at_frequency(rad_s)) }
    }

    fn phase_margins(&self, along: &Along) -> Vec<PhaseMargin> {
        let margin = |rad_s: f64| {
            let phase_rad = complex::arg(-self.at(self.time().at_frequency(rad_s)));
            let late = if phase_rad < 0.0 { phase_rad + TAU } else { phase_rad };
            PhaseMargin { rad_s, phase_rad, delay_s: late / rad_s }
        };
        self.gain_crossings_along(along).into_iter().filter(|w| *w > 0.0).map(margin).collect()
    }

    /// Frequencies at which the value is real, rad/s, rising, the ends included; the ends alone where it is always real.
    pub(crate) fn real_frequencies(&self) -> Vec<f64> {
        self.real_frequencies_along(&Along::of(self))
    }

    fn real_frequencies_along(&self, along: &Along) -> Vec<f64> {
        // the ends, where every value is real, and the real values between
        let most = self.time().nyquist_rad_s();
        let ends = [0.0, most].into_iter().filter(|w| w.is_finite());
        let across = across(&along.above, &along.below);
        let between =
            if along.is_always_real() { Vec::new() } else { along.frequencies(&across) }.into_iter();
        let refined = between.map(|w| self.refined(w, |value| complex::arg(-value), |slope| slope.im));
        let mut all: Vec<f64> = ends.chain(refined).collect();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * *b);
        all
    }

    fn gain_margins(&self, along: &Along) -> Vec<GainMargin> {
        let margin = |rad_s: f64| {
            let value = self.value(rad_s);
            let negative = value.is_finite() && value.re < 0.0 && value.im.abs() < 1e-6 * value.re.abs();
            negative.then(|| GainMargin { rad_s, factor: -1.0 / value.re })
        };
        self.real_frequencies_along(along).into_iter().filter_map(margin).collect()
    }

    fn modulus_margin(&self, along: &Along) -> Option<ModulusMargin> {
        let (above, below) = (square(&(&along.above + &along.below)), square(&along.below));
        let flat = &(&above.derivative() * &below) - &(&above * &below.derivative());
        let distance = |rad_s: f64| complex::norm(1.0 + self.value(rad_s));
        let mut places: Vec<(f64, f64)> =
            along.frequencies(&flat).into_iter().map(|w| (w, distance(w))).collect();
        places.push((0.0, distance(0.0)));
        match self.time().nyquist_rad_s() {
            most if most.is_finite() => places.push((most, distance(most))),
            most if self.relative_degree() > 0 => places.push((most, 1.0)),
            most if self.relative_degree() == 0 => {
                places.push((most, (1.0 + self.numerator().leading()).abs()))
            }
            _ => {}
        }
        let finite = places.into_iter().filter(|(_, distance)| distance.is_finite());
        let nearest = finite.min_by(|a, b| a.1.total_cmp(&b.1))?;
        // less is what rounding makes of nothing
        let distance = if nearest.1 < 8.0 * f64::EPSILON { 0.0 } else { nearest.1 };
        Some(ModulusMargin { rad_s: nearest.0, distance })
    }

    /// A crossing made exact by Newton's iteration on the transfer function.
    fn refined(&self, rad_s: f64, off: impl Fn(Complex) -> f64, slope: impl Fn(Complex) -> f64) -> f64 {
        let mut best = rad_s;
        for _ in 0..3 {
            let step = off(self.at(self.time().at_frequency(best))) / slope(self.logarithmic_slope(best));
            // further than that it would be another crossing
            if step.is_nan() || step.abs() >= 1e-3 * best {
                break;
            }
            best -= step;
        }
        best
    }
}

/// Numerator and denominator as polynomials of jν that rises along the frequencies: ω, or tan ωT/2 of samples, where
/// z = (1 + jν)/(1 − jν); in a unit of ν, and times a common factor, that keep their squares and fourth powers numbers.
pub(crate) struct Along {
    pub(crate) above: Polynomial,
    pub(crate) below: Polynomial,
    /// Its unit of ν, a power of two.
    unit: i32,
    time: Time,
}

impl Along {
    pub(crate) fn of(system: &TransferFunction) -> Self {
        let time = system.time();
        let (above, below) = (system.numerator(), system.denominator());
        let (above, below) = match time {
            Time::Continuous => (above.clone(), below.clone()),
            Time::Sampled(_) => {
                let (plus, minus) = (Polynomial::new([1.0, 1.0]), Polynomial::new([-1.0, 1.0]));
                let power = above.degree().max(below.degree());
                (above.substituted(&plus, &minus, power), below.substituted(&plus, &minus, power))
            }
        };
        let unit = middle_exponent([&above, &below]);
        let exponents = |p: &Polynomial| {
            let each = p.coefficients().iter().rev().zip(0..).filter(|(c, _)| **c != 0.0);
            each.map(|(c, power)| split(*c).1 + unit * power).max()
        };
        let most = exponents(&above).max(exponents(&below)).unwrap_or(0);
        let scaled = |p: &Polynomial| {
            let parts = p.coefficients().iter().rev().zip(0..).map(|(c, power)| (split(*c), unit * power));
            let low_first = parts.map(|((mantissa, own), more)| join(mantissa, own + more - most));
            Polynomial::new(low_first.collect::<Vec<_>>().into_iter().rev().collect::<Vec<_>>())
        };
        Self { above: scaled(&above), below: scaled(&below), unit, time }
    }

    /// Frequencies, rad/s, rising, between the ends, at which a polynomial in ν² is zero.
    pub(crate) fn frequencies(&self, polynomial: &Polynomial) -> Vec<f64> {
        let real = polynomial.roots().into_iter().filter(|root| root.value.im == 0.0 && root.value.re > 0.0);
        let along = real.map(|root| join(root.value.re.sqrt(), self.unit));
        let mut found: Vec<f64> = match self.time {
            Time::Continuous => along.collect(),
            Time::Sampled(period_s) => along.map(|v| 2.0 * atan(v) / period_s).collect(),
        };
        found.sort_by(f64::total_cmp);
        found
    }

    /// Its unit of ν is 2 to this power.
    pub(crate) const fn unit(&self) -> i32 {
        self.unit
    }

    fn is_always_real(&self) -> bool {
        let ((pe, po), (qe, qo)) = (halves(&self.above), halves(&self.below));
        are_same(&(&po * &qe), &(&pe * &qo))
    }

    fn is_always_one(&self) -> bool {
        are_same(&square(&self.above), &square(&self.below))
    }
}

/// What power of two the roots of some polynomials are about, those at 0 left out.
fn middle_exponent<const N: usize>(polynomials: [&Polynomial; N]) -> i32 {
    let mut product = 0;
    let mut count = 0;
    for p in polynomials {
        let coefficients = p.coefficients();
        let last = coefficients.iter().rposition(|&c| c != 0.0).unwrap_or(0);
        if last > 0 {
            product += split(coefficients[last]).1 - split(coefficients[0]).1;
            count += last as i32;
        }
    }
    if count > 0 { product / count } else { 0 }
}

/// Whether two polynomials are the same but for some roundings of each coefficient.
fn are_same(a: &Polynomial, b: &Polynomial) -> bool {
    let size = a.coefficients().len().max(b.coefficients().len());
    (0..size).all(|power| {
        let (a, b) = (a.coefficient(power), b.coefficient(power));
        (a - b).abs() <= 8.0 * size as f64 * f64::EPSILON * a.abs().max(b.abs())
    })
}

/// p(jω) = e(ω²) + jω o(ω²).
pub(crate) fn halves(p: &Polynomial) -> (Polynomial, Polynomial) {
    let sign = |power: usize| if power % 4 < 2 { 1.0 } else { -1.0 };
    let half = |odd: usize| {
        let count = (p.coefficients().len() + 1 - odd) / 2;
        let terms = (0..count).rev().map(|k| sign(2 * k + odd) * p.coefficient(2 * k + odd));
        Polynomial::new(terms.collect::<Vec<_>>())
    };
    (half(0), half(1))
}

/// |p(jν)|² as a polynomial in ν².
pub(crate) fn square(p: &Polynomial) -> Polynomial {
    let (even, odd) = halves(p);
    &(&even * &even) + &(&odd * &odd).shifted(1)
}

/// Imaginary part of p q̄ at jν over ν, as a polynomial in ν².
fn across(p: &Polynomial, q: &Polynomial) -> Polynomial {
    let ((pe, po), (qe, qo)) = (halves(p), halves(q));
    &(&po * &qe) - &(&pe * &qo)
}

impl PhaseMargin {
    /// In degrees.
    pub const fn degrees(&self) -> f64 {
        self.phase_rad * 180.0 / PI
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Discretization;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    /// 1/(s (s+1)(s+2)): real at √2 rad/s, 1/6 there.
    #[test]
    fn margins_of_the_textbooks_loop() {
        let margins = parse("1/(s(s+1)(s+2))").margins();
        let gain = margins.least_gain().unwrap();
        assert!((gain.factor - 6.0).abs() < 1e-12 && (gain.rad_s - 2.0_f64.sqrt()).abs() < 1e-12, "{gain:?}");
        let phase = margins.least_phase().unwrap();
        assert!(
            (phase.degrees() - 53.4108).abs() < 1e-3 && (phase.rad_s - 0.445_748).abs() < 1e-6,
            "{phase:?}"
        );
        assert!((phase.delay_s - phase.phase_rad / phase.rad_s).abs() < 1e-12);
        let modulus = margins.modulus.unwrap();
        assert!((modulus.distance - 0.637_600).abs() < 1e-6, "{modulus:?}");
    }

    #[test]
    fn a_loop_that_is_stable_only_between_two_gains_has_both_margins() {
        // −270° at first, +180° by two zeros, then down again
        let loops = parse("30 (s+1)^2 / (s^3 (1 + s/50)^2)").margins();
        let factors: Vec<f64> = loops.gain.iter().map(|m| m.factor).collect();
        assert!(factors.len() == 2 && factors[0] < 1.0 && factors[1] > 1.0, "{loops:?}");
        assert!(loops.gain.windows(2).all(|pair| pair[0].rad_s < pair[1].rad_s));
    }

    #[test]
    fn a_sampled_loop_has_nearly_the_margins_of_the_one_it_was() {
        let open = parse("4/(s (s+1)(s+6))");
        let sampled = open.sampled(1e-3, Discretization::ZeroOrderHold).unwrap();
        let (here, there) = (open.margins(), sampled.margins());
        let late = here.least_phase().unwrap().phase_rad - there.least_phase().unwrap().phase_rad;
        // half a sample late
        assert!((late - 0.5e-3 * here.least_phase().unwrap().rad_s).abs() < 1e-6, "{late}");
        let factor = here.least_gain().unwrap().factor / there.least_gain().unwrap().factor;
        assert!((1.0..1.01).contains(&factor), "{factor}");
        assert!((here.modulus.unwrap().distance - there.modulus.unwrap().distance).abs() < 1e-3);
    }

    #[test]
    fn margins_of_loops_far_from_one() {
        // ten poles in one place: the phase is −180° where each turns by 18°
        let margins = parse("2e90/(s+1e9)^10").margins();
        let gain = margins.least_gain().unwrap();
        assert!((gain.rad_s / 1e9 - (PI / 10.0).tan()).abs() < 1e-9, "{gain:?}");
        let crossing = margins.least_phase().unwrap().rad_s;
        assert!((crossing / 1e9 - (2.0_f64.powf(0.2) - 1.0).sqrt()).abs() < 1e-9, "{crossing}");
        for by in [1e-90, 1e-60, 1e60, 1e90] {
            let there = parse(&format!("({by:e})^3/(s(s+{by:e})(s+2*{by:e}))")).margins();
            let factor = there.least_gain().unwrap().factor;
            assert!((factor - 6.0).abs() < 1e-9, "{by:e}: {factor}");
        }
    }

    #[test]
    fn what_is_real_or_one_everywhere_is_said_to_be() {
        let allpass = parse("(1-s)(s^2-s+7)/((1+s)(s^2+s+7))").margins();
        assert!(allpass.is_always_one && !allpass.is_always_real && allpass.phase.is_empty());
        let swing = parse("3/(s^2+1)").margins();
        assert!(swing.is_always_real && !swing.is_always_one && swing.gain.is_empty());
        let constant = parse("-2").margins();
        assert!(constant.is_always_real && constant.least_gain().unwrap().factor == 0.5);
        let usual = parse("1/(s+1)").margins();
        assert!(!usual.is_always_real && !usual.is_always_one);
    }

    /// At rest an integrator amplifies without bounds, sampled or not.
    #[test]
    fn a_sampled_integrator_has_no_gain_margin_at_rest() {
        let open = parse("(0-281) (s+33)(s+98)/((s+250)(s+177)) 13.16/(s(s+0.1316))");
        let sampled = open.sampled(1e-3, Discretization::ZeroOrderHold).unwrap();
        assert!(sampled.margins().gain.iter().all(|m| m.rad_s > 0.0), "{:?}", sampled.margins());
    }

    #[test]
    fn what_never_crosses_has_no_margin() {
        let margins = parse("0.5/(s+1)").margins();
        assert!(margins.gain.is_empty() && margins.phase.is_empty());
        assert_eq!(margins.modulus.unwrap(), ModulusMargin { rad_s: f64::INFINITY, distance: 1.0 });
        let negative = parse("-0.5/(s+1)").margins();
        assert_eq!(negative.least_gain().unwrap(), GainMargin { rad_s: 0.0, factor: 2.0 });
        assert_eq!(parse("0").margins().modulus.unwrap().distance, 1.0);
    }

    /// The nearest place on a fine grid is no nearer.
    #[test]
    fn nothing_is_nearer_than_the_modulus_margin() {
        for text in [
            "281 (s+32.9)(s+97.8)/((s+250)(s+177)) 13.16/(s(s+0.1316))",
            "10/(s^2+0.1s+1)",
            "2 (1-s)/((s+1)(s+2))",
        ] {
            let g = parse(text);
            let found = g.margins().modulus.unwrap();
            let seen = crate::logspace((1e-3, 1e4), 20_000)
                .into_iter()
                .map(|w| complex::norm(1.0 + g.at(Complex::new(0.0, w))));
            let nearest = seen.fold(f64::INFINITY, f64::min);
            assert!(
                found.distance <= nearest && found.distance > nearest - 1e-5,
                "{text}: {found:?} {nearest}"
            );
        }
    }
}
