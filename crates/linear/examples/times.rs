//! What it costs: medians in microseconds as one JSON object, for `bench/peers/lab/run.sh`.

#![allow(clippy::print_stdout, reason = "it prints what it measured")]

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use tracelight_linear::{Complex, Discretization, Matrix, Polynomial, Time, TransferFunction, logspace};
use tracelight_maths::powi;

/// The report's pan loop, nothing cancelled.
const K11_G11: &str = "281 (s+32.9)(s+97.8)/((s+250)(s+177)) (13.16 s^2 + 1.754 s + 10.29)/(s^4 + 0.2649 s^3 + 0.7997 s^2 + 0.1029 s)";
const K22_G22: &str = "144 (s+31.5)(s+33.4)/((s+194)(s+83.5)) 13.33/(s^2 + 0.1333 s + 0.7822)";

fn main() -> Result<(), Box<dyn Error>> {
    let [pan, tilt] = [K11_G11, K22_G22].map(|text| TransferFunction::parse(text, Time::Continuous));
    let (pan, tilt) = (pan?, tilt?);
    let closed = pan.closed().unwrap_or_else(|_| pan.clone());
    let gains = logspace((1e-3, 10.0), 1000);
    let frequencies = logspace((1e-2, 1e3), 1000);
    let plant = tilt.state_space()?;
    let (one, weight) = (Matrix::identity(1, 1), Matrix::identity(4, 4));
    let places: Vec<Complex> = [-10.0, -20.0, -30.0, -40.0].map(|re| Complex::new(re, 0.0)).to_vec();
    let mut lines = vec![
        median("root locus, 1000 gains", || pan.root_locus(black_box(gains.clone()))),
        median("frequency response, 1000 points", || pan.frequency_response(black_box(frequencies.clone()))),
        median("all margins, pan", || black_box(&pan).margins()),
        median("all margins, tilt", || black_box(&tilt).margins()),
        median("step, 3001 points", || black_box(&closed).step_response(1e-3, 3001)),
        median("poles", || black_box(&pan).poles()),
        median("feedback", || black_box(&pan).closed()),
        median("Tustin", || black_box(&pan).sampled(1e-3, Discretization::Tustin(None))),
        median("LQR, 4 states", || black_box(&plant).lqr(&weight, &one)),
        median("pole placement, 4 states", || black_box(&plant).place(&places)),
        median("zero-order hold", || black_box(&pan).sampled(1e-3, Discretization::ZeroOrderHold)),
    ];
    for (name, polynomial) in hostile() {
        lines.push(median(&format!("roots of {name}"), || black_box(&polynomial).roots()));
    }
    println!("{{{}}}", lines.join(","));
    Ok(())
}

/// Polynomials that make root finders slow, wrong or endless.
fn hostile() -> Vec<(&'static str, Polynomial)> {
    let repeated = |root: f64, times: usize| {
        (0..times).fold(Polynomial::one(), |p, _| &p * &Polynomial::new([1.0, -root]))
    };
    let wilkinson = (1..=20).fold(Polynomial::one(), |p, k| &p * &Polynomial::new([1.0, -f64::from(k)]));
    let spread = (0..40).fold(Polynomial::one(), |p, k| &p * &Polynomial::new([1.0, powi(10.0, k - 20)]));
    let mut unity = vec![0.0; 41];
    (unity[0], unity[40]) = (1.0, -1.0);
    vec![
        ("(x + 1)⁴⁰", repeated(-1.0, 40)),
        ("Wilkinson's of order 20", wilkinson),
        ("40 roots a decade apart", spread),
        ("x⁴⁰ − 1", Polynomial::new(unity)),
        ("x⁴⁰ + … + 1", Polynomial::new(vec![1.0; 41])),
        (
            "alternating 1e±150, order 40",
            Polynomial::new((0..41).map(|i| if i % 2 == 0 { 1e150 } else { -1e-150 }).collect::<Vec<_>>()),
        ),
    ]
}

/// `"name": microseconds`: the median of many runs, some hundred milliseconds of them.
fn median<T>(name: &str, mut work: impl FnMut() -> T) -> String {
    let mut times: Vec<f64> = Vec::new();
    let begun = Instant::now();
    while times.len() < 5 || (times.len() < 2000 && begun.elapsed().as_millis() < 300) {
        let start = Instant::now();
        black_box(work());
        times.push(start.elapsed().as_secs_f64() * 1e6);
    }
    times.sort_by(f64::total_cmp);
    format!("\"{name}\":{:.3}", times[times.len() / 2])
}
