//! Roots as they can be told apart: what rounding alone moves off an axis is on it, and what it alone keeps apart is one root, so many
//! times.

use tracelight_maths::complex;

use super::disc::{disc, expansion};
use super::evaluate::Scaled;
use crate::{Complex, Polynomial, Root};

/// A root that can be told from the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistinctRoot {
    /// Where it is. Its real or imaginary part is 0 where it cannot be told from 0.
    pub value: Complex,
    /// How far off it may be.
    pub radius: f64,
    /// How many times it is one.
    pub count: usize,
}

impl Polynomial {
    /// Roots that can be told apart, conjugate pairs exactly so, the smallest first; none of constants.
    ///
    /// Roots whose error discs overlap are one where the polynomial has so many roots at one place to within rounding of its coefficients.
    pub fn distinct_roots(&self) -> Vec<DistinctRoot> {
        let mut found: Vec<DistinctRoot> = Vec::new();
        for members in overlapping(&self.roots()) {
            match self.as_one(&members) {
                Some(one) => found.push(one),
                None => found.extend(members.iter().copied().map(DistinctRoot::from)),
            }
        }
        // stable: pairs stay together
        found.sort_by(|a, b| complex::norm(a.value).total_cmp(&complex::norm(b.value)));
        found
    }

    /// All of a group as one root; none where the polynomial says otherwise.
    fn as_one(&self, members: &[Root]) -> Option<DistinctRoot> {
        let [first, others @ ..] = members else { return None };
        if others.is_empty() {
            return Some((*first).into());
        }
        let count = members.len();
        let mean = members.iter().map(|root| root.value).sum::<Complex>() / count as f64;
        if mean == Complex::ZERO {
            let at_zero = members.iter().all(|root| root.value == mean);
            return at_zero.then_some(DistinctRoot { value: mean, radius: 0.0, count });
        }
        let zeros = self.coefficients().iter().rev().take_while(|&&c| c == 0.0).count();
        let scaled = Scaled::new(&self.coefficients()[..self.coefficients().len() - zeros]);
        let place = centred(&scaled, mean, count)?;
        let on_axis = [Complex::new(0.0, place.im), Complex::new(place.re, 0.0)];
        let value = on_axis.into_iter().find(|at| has_so_many(&scaled, *at, count)).unwrap_or(place);
        Some(DistinctRoot { value, radius: disc(&scaled, value), count })
    }
}

/// The place of so many roots in one, looked for from one near it; none if there is no such place.
fn centred(scaled: &Scaled, near: Complex, count: usize) -> Option<Complex> {
    /// Newton's steps for the one root of a derivative: from so near two suffice.
    const ROUNDS: usize = 4;
    let mut place = near;
    for _ in 0..ROUNDS {
        if has_so_many(scaled, place, count) {
            return Some(place);
        }
        let (terms, _) = expansion(scaled, place);
        place *= 1.0 - terms[count - 1] / (terms[count] * count as f64);
    }
    None
}

/// Whether the value and all derivatives but the last are no more than rounding of the coefficients.
fn has_so_many(scaled: &Scaled, place: Complex, count: usize) -> bool {
    let rounding = 4.0 * scaled.degree() as f64 * f64::EPSILON;
    let (terms, sizes) = expansion(scaled, place);
    place != Complex::ZERO && (0..count).all(|k| complex::norm(terms[k]) <= rounding * sizes[k])
}

impl From<Root> for DistinctRoot {
    /// One root, once.
    fn from(Root { value, radius }: Root) -> Self {
        // a pair stays one: its imaginary parts are known to differ from 0
        Self { value: Complex::new(part(value.re, radius), value.im), radius, count: 1 }
    }
}

/// Groups of roots with discs that overlap, in the order of their first.
fn overlapping(roots: &[Root]) -> Vec<Vec<Root>> {
    let mut groups: Vec<Vec<Root>> = Vec::new();
    for root in roots {
        let touches = |other: &Root| {
            root.radius.is_finite() && complex::norm(root.value - other.value) <= root.radius + other.radius
        };
        let (mut joined, apart): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group| group.iter().any(touches));
        groups = apart;
        let group = match joined.is_empty() {
            true => vec![*root],
            false => {
                let mut whole = joined.remove(0);
                whole.extend(joined.into_iter().flatten());
                whole.push(*root);
                whole
            }
        };
        groups.push(group);
    }
    groups
}

const fn part(value: f64, radius: f64) -> f64 {
    // what is no number stays none
    if value.abs() <= radius { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use crate::{Time, TransferFunction};

    fn of(text: &str) -> Vec<(f64, f64, usize)> {
        let system = TransferFunction::parse(&format!("1/({text})"), Time::Continuous).unwrap();
        let all = system.denominator().distinct_roots();
        all.into_iter().map(|root| (root.value.re, root.value.im, root.count)).collect()
    }

    #[test]
    fn a_multiple_root_is_one() {
        assert_eq!(of("(s^2+1)^2"), [(0.0, 1.0, 2), (0.0, -1.0, 2)]);
        for count in [2, 3, 5, 12, 20, 40, 60] {
            let found = of(&format!("(s+1)^{count}"));
            assert_eq!(found.len(), 1, "{count}: {found:?}");
            assert!((found[0].0 + 1.0).abs() < 1e-9 && found[0].1 == 0.0 && found[0].2 == count, "{found:?}");
        }
        let found = of("(s+3)^4 (s^2+2s+5)^3 s^2");
        let counts: Vec<usize> = found.iter().map(|root| root.2).collect();
        assert_eq!(counts, [2, 3, 3, 4], "{found:?}");
    }

    #[test]
    fn roots_that_are_told_apart_stay_apart() {
        assert_eq!(of("(s+1)(s+1.001)").len(), 2);
        assert_eq!(of("(s+1)^20+0.1").len(), 20);
        assert_eq!(of("(s+1)^12+0.001").len(), 12);
    }

    #[test]
    fn what_rounding_moves_off_an_axis_is_on_it() {
        for root in of("(s^2+2)(s^2+3)(s+1)") {
            assert!(root.0 == 0.0 || root.1 == 0.0, "{root:?}");
        }
        // a little damping is no rounding
        assert!(of("s^2+1e-9s+1").iter().all(|root| root.0 < 0.0));
    }
}
