//! Roots of polynomials that make root finders fail: repeated, far apart, of high order, badly scaled.

use tracelight_linear::{Complex, Polynomial, Root};
use tracelight_maths::complex;

/// Whether the true roots, each as often as it occurs, lie in the discs: as many in each cluster of discs as it is of.
fn check(name: &str, coefficients: &[f64], truth: &[Complex]) {
    let roots = Polynomial::new(coefficients).roots();
    assert_eq!(roots.len(), truth.len(), "{name}");
    let mut left: Vec<Complex> = truth.to_vec();
    for root in &roots {
        assert!(root.radius.is_finite(), "{name}: {root:?}");
        let near = |t: &Complex| complex::norm(t - root.value);
        let place = (0..left.len()).min_by(|&a, &b| near(&left[a]).total_cmp(&near(&left[b]))).unwrap();
        let nearest = left.swap_remove(place);
        assert!(
            near(&nearest) <= 1.0001 * root.radius + 1e-15 * complex::norm(root.value),
            "{name}: {root:?} is off by {:e}",
            near(&nearest)
        );
    }
}

fn real(values: &[f64]) -> Vec<Complex> {
    values.iter().map(|&v| Complex::new(v, 0.0)).collect()
}

/// Π(x − rᵢ) for whole numbers whose products are exact in `f64`.
fn product(roots: &[i64]) -> Vec<f64> {
    let mut coefficients = vec![1.0];
    for &root in roots {
        let mut next = vec![0.0; coefficients.len() + 1];
        for (i, c) in coefficients.iter().enumerate() {
            next[i] += c;
            next[i + 1] -= root as f64 * c;
        }
        coefficients = next;
    }
    assert!(coefficients.iter().all(|c| c.abs() < 9e15), "{coefficients:?} is not exact");
    coefficients
}

fn widest(roots: &[Root]) -> f64 {
    roots.iter().map(|root| root.radius / complex::norm(root.value).max(1e-300)).fold(0.0, f64::max)
}

#[test]
fn whole_numbers_once_or_many_times_lie_in_their_discs() {
    let mut random = oorandom::Rand64::new(3);
    for _ in 0..5000 {
        let count = random.rand_range(1..9);
        let reach = random.rand_range(1..12) as i64;
        let roots: Vec<i64> =
            (0..count).map(|_| random.rand_range(0..2 * reach as u64 + 1) as i64 - reach).collect();
        let truth: Vec<f64> = roots.iter().map(|&r| r as f64).collect();
        check(&format!("{roots:?}"), &product(&roots), &real(&truth));
    }
}

/// Wilkinson's polynomial up to 15, whose coefficients are still exact: relative errors of a companion matrix's eigenvalues are 1e-6.
#[test]
fn wilkinsons_polynomial_is_solved_to_all_its_digits() {
    let truth: Vec<i64> = (1..=15).collect();
    let coefficients = product(&truth);
    let roots = Polynomial::new(coefficients).roots();
    for (root, truth) in roots.iter().zip(&truth) {
        let off = complex::norm(root.value - *truth as f64) / *truth as f64;
        assert!(off < 1e-14 && root.value.im == 0.0, "{root:?} {off:e}");
        assert!(root.radius < 1e-12 * *truth as f64, "{root:?}");
    }
}

#[test]
fn repeated_roots_are_as_close_as_their_coefficients_say() {
    // the coefficients are exact; what limits it are the derivatives, which have no more digits than others
    for (count, most) in [(2, 1e-13), (3, 1e-8), (5, 1e-4), (8, 1e-2)] {
        let roots = Polynomial::new(product(&vec![-1; count])).roots();
        let off = roots.iter().map(|root| complex::norm(root.value + 1.0)).fold(0.0, f64::max);
        assert!(off < most, "{count}: {off:e}");
        check("repeated", &product(&vec![-1; count]), &real(&vec![-1.0; count]));
    }
}

/// Matrices on which an eigenvalue iteration was reported never to end are companion matrices of such polynomials, or like them.
#[test]
fn what_hangs_others_ends() {
    let zeros = |n: usize| [&[1.0][..], &vec![0.0; n]].concat();
    check("x¹², all at zero", &zeros(12), &real(&[0.0; 12]));
    let turns =
        |n: usize| (0..n).map(move |k| complex::from_polar(1.0, std::f64::consts::TAU * k as f64 / n as f64));
    for n in [2, 4, 5, 8, 40] {
        let mut unit = zeros(n);
        unit[n] = -1.0;
        check("roots of unity", &unit, &turns(n).collect::<Vec<_>>());
        check("a cyclotomic sum", &vec![1.0; n], &turns(n).skip(1).collect::<Vec<_>>());
    }
    check("pairs", &[1.0, 0.0, 2.0, 0.0, 1.0], &[1.0, 1.0, -1.0, -1.0].map(|im| Complex::new(0.0, im)));
    let roots = Polynomial::new([1.0, 4.685_985_859_345_735e-16, -1.0, -4.685_985_859_345_736e-16]).roots();
    assert!(widest(&roots[1..]) < 1e-12, "{roots:?}");
}

#[test]
fn roots_far_apart_are_found_to_all_their_digits() {
    // a root each 20 decades
    let truth = [1e-150, -1e-60, 1e-20, 3e20, -1e100, 2e150];
    let mut coefficients = vec![1.0];
    for root in truth {
        // products of numbers that far apart: each coefficient is one of them but for a part in 1e20
        let mut next = vec![0.0; coefficients.len() + 1];
        for (i, c) in coefficients.iter().enumerate() {
            next[i] += c;
            next[i + 1] -= root * c;
        }
        coefficients = next;
    }
    let roots = Polynomial::new(coefficients).roots();
    for (root, truth) in roots.iter().zip(truth) {
        assert!((root.value.re / truth - 1.0).abs() < 1e-14, "{root:?} {truth:e}");
    }
}

#[test]
fn whatever_the_coefficients_it_ends_and_says_how_good_it_is() {
    let mut random = oorandom::Rand64::new(9);
    for round in 0..3000 {
        let degree = random.rand_range(1..41) as usize;
        let spread = [0.0, 3.0, 30.0, 150.0][round % 4];
        let coefficients: Vec<f64> = (0..=degree)
            .map(|_| {
                let sign = if random.rand_float() < 0.5 { -1.0 } else { 1.0 };
                let size = 10_f64.powf(spread * (2.0 * random.rand_float() - 1.0));
                if random.rand_float() < 0.2 { 0.0 } else { sign * size }
            })
            .collect();
        let polynomial = Polynomial::new(coefficients);
        let roots = polynomial.roots();
        assert_eq!(roots.len(), polynomial.degree());
        assert!(roots.iter().all(|root| root.value.is_finite()), "{polynomial:?} {roots:?}");
        let mirrored = roots.iter().all(|r| roots.iter().any(|other| other.value == r.value.conj()));
        assert!(mirrored, "{roots:?}");
        // random coefficients have simple roots
        assert!(widest(&roots) < 1e-6, "{polynomial:?} {roots:?}");
    }
    for nothing in [vec![], vec![0.0], vec![5.0]] {
        assert!(Polynomial::new(nothing).roots().is_empty());
    }
    for strange in [vec![1.0, f64::NAN, 2.0], vec![f64::INFINITY, 1.0]] {
        let roots = Polynomial::new(strange).roots();
        assert!(roots.iter().all(|root| root.value.is_nan() && root.radius == f64::INFINITY));
    }
    let extremes = [5e-324, f64::MAX, -f64::MIN_POSITIVE, f64::MAX, 5e-324];
    let roots = Polynomial::new(extremes).roots();
    assert!(roots.iter().all(|root| !root.value.is_nan()), "{roots:?}");
}
