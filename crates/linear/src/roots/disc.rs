use tracelight_maths::{complex, powf, powi};

use super::evaluate::Scaled;
use crate::Complex;

/// Radius of a disc about a place that surely holds a root, or as many as are close together there.
///
/// Pellet's theorem: where one term of the expansion about the place outweighs all others together on a circle, |cₘ| rᵐ > Σ |cₖ| rᵏ,
/// there are m roots within. The fewest that can be told from the others are taken. Rounding is added where it makes the bound
/// worse.
pub(super) fn disc(scaled: &Scaled, place: Complex) -> f64 {
    let degree = scaled.degree();
    let (terms, sizes) = expansion(scaled, place);
    let rounding = 4.0 * degree as f64 * f64::EPSILON;
    let most = |k: usize| {
        if k == 0 { scaled.residual(place) } else { complex::norm(terms[k]) + rounding * sizes[k] }
    };
    let least = |k: usize| complex::norm(terms[k]) - rounding * sizes[k];
    let holds = |m: usize| {
        let least = least(m);
        if least <= 0.0 {
            return None;
        }
        // half of the term is for those below it, half for those above
        let share = 2.0 * m as f64 / least;
        let radius = (0..m).map(|k| powf(share * most(k), 1.0 / (m - k) as f64)).fold(0.0, f64::max);
        let above: f64 = (m + 1..=degree).map(|k| most(k) * powi(radius, (k - m) as i32)).sum();
        (2.0 * above < least).then_some(radius)
    };
    // rounding of the place itself
    let own = f64::EPSILON;
    (1..=degree).find_map(holds).map_or(f64::INFINITY, |radius| complex::norm(place) * (radius + own))
}

/// Terms of p(z (1 + h)) / max(1, |z|)ⁿ as powers of h, the lowest first, and of the same with all signs alike.
pub(super) fn expansion(scaled: &Scaled, place: Complex) -> (Vec<Complex>, Vec<f64>) {
    let (coefficients, place) = scaled.near(place);
    let degree = scaled.degree();
    let outside = place.norm_sqr() > 1.0;
    // powers of z or of 1/z, whichever does not grow
    let (base, mut power) = (if outside { place.inv() } else { place }, Complex::ONE);
    let mut terms = vec![Complex::ZERO; degree + 1];
    for i in 0..=degree {
        // highest power first: zⁿ⁻ⁱ / zⁿ = z⁻ⁱ outside
        let at = if outside { i } else { degree - i };
        terms[at] = power * coefficients[at];
        power *= base;
    }
    let mut sizes: Vec<f64> = terms.iter().map(|term| complex::norm(*term)).collect();
    shift(&mut terms);
    shift(&mut sizes);
    terms.reverse();
    sizes.reverse();
    (terms, sizes)
}

/// From powers of t to powers of t − 1, highest first: synthetic division by t − 1, again and again.
fn shift<T: Copy + std::ops::AddAssign>(coefficients: &mut [T]) {
    let size = coefficients.len();
    for end in (1..size).rev() {
        for i in 1..=end {
            let before = coefficients[i - 1];
            coefficients[i] += before;
        }
    }
}
