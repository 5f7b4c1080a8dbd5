//! Roots of a polynomial, all at once, in bounded time.

mod disc;
mod distinct;
mod evaluate;
mod start;

use tracelight_maths::complex;

use crate::{Complex, Polynomial};
use disc::disc;
use evaluate::{Scaled, Step};

pub use distinct::DistinctRoot;
pub(crate) use evaluate::accurate_value;
use start::starts;

/// One root, and how far off it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Where it is.
    pub value: Complex,
    /// A disc of that radius about it holds a true root of the polynomial whose coefficients are exactly these; where discs
    /// overlap, as many true roots as it is about (Pellet's theorem). Infinite where the coefficients are no numbers.
    pub radius: f64,
}

/// Rounds of the iteration; from good starts it takes some ten, double roots some thirty.
const MOST_ROUNDS: usize = 80;

impl Polynomial {
    /// All roots, conjugate pairs exactly so, the smallest first; none of constants.
    ///
    /// Ehrlich and Aberth's iteration, a Newton step for each root away from all others (Aberth, *Iteration methods for finding
    /// all zeros of a polynomial simultaneously*, Math. Comp. 27, 1973), from starts on the Newton polygon (Bini, *Numerical
    /// computation of polynomial zeros by means of Aberth's method*, Numer. Algorithms 13, 1996); at last with values in twice
    /// the digits (Graillat & Langlois's compensated Horner scheme). It ends after a number of rounds, whatever it is given.
    pub fn roots(&self) -> Vec<Root> {
        if !self.is_finite() {
            let value = Complex::new(f64::NAN, f64::NAN);
            let nowhere = Root { value, radius: f64::INFINITY };
            return vec![nowhere; self.degree()];
        }
        let zeros = self.coefficients().iter().rev().take_while(|&&c| c == 0.0).count().min(self.degree());
        let rest = &self.coefficients()[..self.coefficients().len() - zeros];
        let mut roots = vec![Root { value: Complex::ZERO, radius: 0.0 }; zeros];
        if rest.len() > 1 {
            let scaled = Scaled::new(rest);
            let mut places = starts(rest);
            approach(&scaled, &mut places, Scaled::step);
            approach(&scaled, &mut places, Scaled::accurate_step);
            let found = places.iter().map(|&place| Root { value: place, radius: disc(&scaled, place) });
            roots.extend(mirrored(found.collect()));
        }
        roots
    }

    /// Roots found from places near them, in their order; none of coefficients that are no numbers, or if two places are one.
    pub(crate) fn roots_near(&self, places: &[Complex]) -> Option<Vec<Complex>> {
        let apart = |i: usize| places[..i].iter().all(|other| *other != places[i]);
        let fits = self.is_finite() && self.constant() != 0.0 && places.len() == self.degree();
        if !(fits && !places.is_empty() && (0..places.len()).all(apart)) {
            return None;
        }
        let scaled = Scaled::new(self.coefficients());
        let mut places = places.to_vec();
        approach(&scaled, &mut places, Scaled::accurate_step).then_some(places)
    }

    /// Whether it may be zero there if each coefficient is off by some roundings, as those that were computed are.
    pub(crate) fn may_vanish_at(&self, place: Complex) -> bool {
        let constant = self.constant();
        if !self.is_finite() || place == Complex::ZERO || constant == 0.0 {
            return !self.is_finite() || self.is_zero() || (place == Complex::ZERO && constant == 0.0);
        }
        self.degree() > 0 && Scaled::new(self.coefficients()).may_vanish_at(place)
    }

    /// Where its roots are, without bounds.
    pub fn root_values(&self) -> Vec<Complex> {
        self.roots().into_iter().map(|root| root.value).collect()
    }
}

/// Moves each place towards its root until rounding says that it is there; whether all are.
fn approach(scaled: &Scaled, places: &mut [Complex], step: fn(&Scaled, Complex) -> Step) -> bool {
    let mut settled = vec![false; places.len()];
    for _ in 0..MOST_ROUNDS {
        for i in 0..places.len() {
            if settled[i] {
                continue;
            }
            let place = places[i];
            let Step { newton, is_settled } = step(scaled, place);
            let moved = correction(newton, repulsion(places, i));
            if moved.is_finite() {
                places[i] -= moved;
            }
            settled[i] = is_settled || complex::norm(moved) <= f64::EPSILON * complex::norm(place);
        }
        if settled.iter().all(|&done| done) {
            return true;
        }
    }
    false
}

/// Aberth's correction of Newton's step.
fn correction(newton: Complex, repulsion: Complex) -> Complex {
    newton / (1.0 - newton * repulsion)
}

/// Σ 1 / (zᵢ − zⱼ) over the others; those at the very same place push nowhere.
fn repulsion(places: &[Complex], i: usize) -> Complex {
    let here = places[i];
    let away = |there: &Complex| {
        let apart = here - there;
        // squares of what is far apart would overflow
        let size = apart.re.abs().max(apart.im.abs());
        (apart / size).inv() / size
    };
    let others = places.iter().enumerate().filter(|&(j, there)| j != i && *there != here);
    others.map(|(_, there)| away(there)).sum()
}

/// Roots of real coefficients: real ones, and pairs that mirror each other; the smallest first. Those that mirror each other best
/// become pairs, or are their own mirrors.
fn mirrored(roots: Vec<Root>) -> Vec<Root> {
    let ways = |i: usize| (i..roots.len()).map(move |j| (i, j));
    let apart = |(i, j): (usize, usize)| complex::norm(roots[i].value - roots[j].value.conj());
    // a root that is alone in a disc that reaches the real axis is real
    let alone = |i: usize| {
        let apart = |j: usize| complex::norm(roots[i].value - roots[j].value);
        (0..roots.len()).all(|j| j == i || apart(j) > roots[i].radius + roots[j].radius)
    };
    let real: Vec<bool> =
        (0..roots.len()).map(|i| roots[i].value.im.abs() <= roots[i].radius && alone(i)).collect();
    let cost = |(i, j): (usize, usize)| if i == j && real[i] { 0.0 } else { apart((i, j)) };
    let mut pairs: Vec<(usize, usize)> = (0..roots.len()).flat_map(ways).collect();
    pairs.sort_by(|a, b| cost(*a).total_cmp(&cost(*b)));
    let mut taken = vec![false; roots.len()];
    let mut done = Vec::with_capacity(roots.len());
    for (i, j) in pairs {
        if taken[i] || taken[j] {
            continue;
        }
        (taken[i], taken[j]) = (true, true);
        let value = 0.5 * (roots[i].value + roots[j].value.conj());
        let radius = roots[i].radius.max(roots[j].radius) + 0.5 * cost((i, j));
        let upper = Complex::new(value.re, value.im.abs());
        done.push(Root { value: upper, radius });
        if i != j {
            done.push(Root { value: upper.conj(), radius });
        }
    }
    // stable: pairs stay together
    done.sort_by(|a, b| complex::norm(a.value).total_cmp(&complex::norm(b.value)));
    done
}
