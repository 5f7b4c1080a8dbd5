//! Contributions of modes from the coefficients of a transfer function.
//!
//! What a group of poles contributes is the principal part of the output's Laplace transform there, whose coefficients are integrals
//! about the group. They are summed over a circle about it (the trapezoidal rule, which converges geometrically: Trefethen & Weideman,
//! *The exponentially convergent trapezoidal rule*, SIAM Review 56, 2014): no difference of nearly equal poles is divided by.

use std::f64::consts::{LN_2, TAU};

use tracelight_maths::{complex, ln, powi};

use crate::binary::join;
use crate::polynomial::Polynomial;
use crate::roots::accurate_value;
use crate::stability::{Stability, stabilities};
use crate::transient::closed_form::Transient;
use crate::transient::clusters::{Cluster, clusters};
use crate::transient::ending::{Ending, Input};
use crate::transient::taylor::LEVELS;
use crate::transient::term::{Sum, Term};

use crate::{Complex, LinearError, Time, TransferFunction};

/// −ln of what is left out: less than the rounding of a number.
const LEFT_OUT_LN: f64 = 38.0;

/// The output's transform as N / (D sᵇ), in a unit of time that brings its poles about 1.
struct Transform {
    above: Polynomial,
    below: Polynomial,
    at_zero: usize,
    /// The unit is 2^−exponent seconds.
    exponent: i32,
}

/// What a system in continuous time answers.
pub(super) fn continuous(system: &TransferFunction, input: Input) -> Result<Transient, LinearError> {
    let (above, below) = (system.numerator(), system.denominator());
    let most = below.degree() + usize::from(input == Input::Ramp);
    if above.degree() > most {
        let (zeros, poles) = (above.degree(), below.degree());
        return Err(LinearError::Improper { zeros, poles, what: "response" });
    }
    let integrals = match input {
        Input::Impulse => 0,
        Input::Step => 1,
        Input::Ramp => 2,
    };
    let passes = input == Input::Impulse && !above.is_zero() && above.degree() == below.degree();
    let impulse = if passes { above.leading() } else { 0.0 };
    let above = if passes { above - &below.scaled(impulse) } else { above.clone() };
    let (transform, mut hidden) = Transform::of(&above, below, integrals);
    let (sum, ending) = transform.expand(&mut hidden);
    Ok(Transient { ending, impulse, hidden, sum })
}

/// How many roots at 0 there are.
fn zeros_at_zero(polynomial: &Polynomial) -> usize {
    polynomial.coefficients().iter().rev().take_while(|&&c| c == 0.0).count()
}

fn without_last(polynomial: &Polynomial, count: usize) -> Polynomial {
    let coefficients = polynomial.coefficients();
    Polynomial::new(&coefficients[..coefficients.len() - count])
}

impl Transform {
    /// Factors s above and below are cancelled; those of the system's own poles are returned.
    fn of(above: &Polynomial, below: &Polynomial, integrals: usize) -> (Self, Vec<Complex>) {
        let (own, over) = (zeros_at_zero(below), zeros_at_zero(above));
        let cancelled = over.min(own + integrals);
        let hidden = vec![Complex::ZERO; over.min(own)];
        let (above, below) = (without_last(above, cancelled), without_last(below, own));
        let at_zero = own + integrals - cancelled;
        let degree = below.degree() as i32;
        // |p₁ … pₙ| is the constant's
        let exponent = match below.degree() {
            0 => 0,
            _ => (ln(below.constant().abs()) / (LN_2 * f64::from(degree))).round() as i32,
        };
        let scaled = |polynomial: &Polynomial, less: i32| {
            let each = polynomial.coefficients().iter().rev().zip(0..);
            let by = |(&c, power): (&f64, i32)| join(c, exponent * (power - less));
            let mut coefficients: Vec<f64> = each.map(by).collect();
            coefficients.reverse();
            Polynomial::new(coefficients)
        };
        let above = scaled(&above, degree + at_zero as i32 - 1);
        (Self { above, below: scaled(&below, degree), at_zero, exponent }, hidden)
    }

    fn unit(&self) -> f64 {
        powi(2.0, self.exponent)
    }

    /// Value at a place.
    fn at(&self, place: Complex) -> Complex {
        let zero = (0..self.at_zero).fold(Complex::ONE, |product, _| product * place);
        accurate_value(self.above.coefficients(), place)
            / (accurate_value(self.below.coefficients(), place) * zero)
    }

    fn expand(&self, hidden: &mut Vec<Complex>) -> (Sum, Ending) {
        let powers = self.powers();
        let poles = self.below.roots();
        let stability = stabilities(&self.below, Time::Continuous);
        let mut found = Found::of(&powers);
        let mut terms = Vec::new();
        for cluster in clusters(&poles, self.at_zero) {
            let worst = cluster.members.iter().map(|&i| stability[i].1).max().unwrap_or(Stability::Stable);
            if cluster.members.len() == 1 && self.above.may_vanish_at(cluster.centre) {
                let pole = cluster.centre * self.unit();
                hidden.extend([pole, pole.conj()].iter().take(if pole.im == 0.0 { 1 } else { 2 }));
                continue;
            }
            let term = self.term(&cluster, worst);
            found.add(&cluster, worst, &term);
            terms.push(term);
        }
        (Sum { powers, terms, start: self.start(), per_second: self.unit() }, found.ending())
    }

    /// Coefficients of the principal part at 0, as those of powers of time over their factorials.
    fn powers(&self) -> Vec<f64> {
        let coefficient =
            |p: &Polynomial, power: usize| if power <= p.degree() { p.coefficient(power) } else { 0.0 };
        let mut series: Vec<f64> = Vec::with_capacity(self.at_zero);
        for i in 0..self.at_zero {
            let known: f64 = (1..=i).map(|l| coefficient(&self.below, l) * series[i - l]).sum();
            series.push((coefficient(&self.above, i) - known) / self.below.constant());
        }
        series.reverse();
        if series.is_empty() { vec![0.0] } else { series }
    }

    /// The transform as a series in 1/s: derivatives of the output just after time 0.
    fn start(&self) -> [f64; LEVELS] {
        let degree = self.below.degree() + self.at_zero;
        let below = self.below.coefficients();
        let mut start = [0.0; LEVELS];
        for k in 0..LEVELS {
            let above = degree.checked_sub(k + 1).filter(|&power| power <= self.above.degree());
            let own = above.map_or(0.0, |power| self.above.coefficient(power));
            let known: f64 = (1..below.len().min(k + 1)).map(|i| below[i] * start[k - i]).sum();
            start[k] = (own - known) / below[0];
        }
        start
    }

    /// What a group contributes, with its conjugates.
    fn term(&self, cluster: &Cluster, worst: Stability) -> Term {
        let Cluster { mut centre, radius, clearance, .. } = *cluster;
        let size = complex::norm(centre);
        let clearance = clearance.min(4.0 * size.max(radius));
        let decay = if worst == Stability::Stable { -centre.re } else { 0.0 };
        let (around, count) = if cluster.members.len() == 1 {
            (clearance / 8.0, 1)
        } else {
            // rounding on the circle is kept small by what decays as fast as it is wide
            let outer = if decay > 0.0 { clearance.min(1.1 * decay) } else { clearance };
            let around = ((0.25 * outer).max(radius) * outer).sqrt();
            (around, cluster.members.len() + tail(cluster, decay))
        };
        let outward = ln(clearance / around);
        let inward = if radius > 0.0 { ln(around / radius) } else { outward };
        // coefficients as many nodes apart are not told from each other
        let nodes = count + (LEFT_OUT_LN / outward.min(inward)).ceil().clamp(16.0, 1024.0) as usize;
        let mut moments = self.moments(centre, around, 2 * nodes.div_ceil(2), count);
        if decay > 0.0 {
            moments = trimmed(moments, decay);
        }
        if worst == Stability::Marginal && cluster.members.len() == 1 {
            centre.re = 0.0;
        }
        Term::new(centre, moments)
    }

    /// Coefficients of 1/w, 1/w² … of the principal part about a place, w from it on, from values on a circle; twice that if the place
    /// has a conjugate.
    fn moments(&self, centre: Complex, around: f64, nodes: usize, count: usize) -> Vec<Complex> {
        let is_real = centre.im == 0.0;
        let mut sums = vec![Complex::ZERO; count];
        // of what is its own conjugate half the circle says all
        let asked = if is_real { nodes / 2 } else { nodes };
        for node in 0..asked {
            let offset = complex::from_polar(around, TAU * (node as f64 + 0.5) / nodes as f64);
            let mut value = self.at(centre + offset) * offset;
            for sum in &mut sums {
                *sum += value;
                value *= offset;
            }
        }
        let share = 2.0 / nodes as f64;
        sums.into_iter().map(|sum| if is_real { (share * sum.re).into() } else { share * sum }).collect()
    }
}

/// How many more coefficients than poles a group needs: as long as it lasts, no more is left out than a rounding.
fn tail(cluster: &Cluster, decay: f64) -> usize {
    const MOST: f64 = 300.0;
    const OF_WHAT_STAYS: f64 = 12.0;
    const EACH_LN: f64 = 3.0;
    if cluster.radius == 0.0 {
        return 0;
    }
    let ratio = ln(decay / cluster.radius);
    let more = if ratio > 0.0 {
        (LEFT_OUT_LN + EACH_LN * cluster.members.len() as f64) / ratio
    } else {
        OF_WHAT_STAYS
    };
    more.ceil().min(MOST) as usize
}

/// Without the last coefficients, if nothing is seen of them before all has died out.
fn trimmed(mut moments: Vec<Complex>, decay: f64) -> Vec<Complex> {
    /// Share of the largest one that is not seen.
    const UNSEEN: f64 = 1e-18;
    let sizes: Vec<f64> = moments.iter().zip(0..).map(|(&m, i)| complex::norm(m) * powi(decay, -i)).collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let seen = sizes.iter().rposition(|&size| size > UNSEEN * most);
    moments.truncate(seen.map_or(1, |last| last + 1));
    moments
}

/// What is known of the long run.
struct Found {
    about: f64,
    by: f64,
    diverges: bool,
    undecided: bool,
}

impl Found {
    fn of(powers: &[f64]) -> Self {
        let diverges = powers.iter().skip(1).any(|&m| m != 0.0);
        Self { about: powers[0], by: 0.0, diverges, undecided: false }
    }

    fn add(&mut self, cluster: &Cluster, worst: Stability, term: &Term) {
        match worst {
            Stability::Stable => {}
            Stability::Growing => self.diverges = true,
            Stability::Marginal if cluster.centre.im == 0.0 => self.undecided = true,
            Stability::Marginal if cluster.members.len() > 1 => self.diverges = true,
            Stability::Marginal => self.by += term.size(),
        }
    }

    const fn ending(&self) -> Ending {
        match *self {
            Self { diverges: true, .. } => Ending::Diverges,
            Self { undecided: true, .. } => Ending::Undecided,
            Self { about, by, .. } if by > 0.0 => Ending::Oscillates { about, by },
            Self { about, .. } => Ending::Converges(about),
        }
    }
}
