//! What it says of systems: a JSON object a line in, one out, for `bench/peers/lab/live.py`.

#![allow(clippy::print_stdout, reason = "it prints what it found")]

use std::error::Error;
use std::io::{BufRead, stdin};

use serde::Deserialize;
use serde_json::json;
use tracelight_linear::{Complex, Discretization, Matrix, Polynomial, Time, TransferFunction};

#[derive(Deserialize)]
struct Question {
    num: Vec<f64>,
    den: Vec<f64>,
    period: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    for line in stdin().lock().lines() {
        let Question { num, den, period } = serde_json::from_str(&line?)?;
        let system = TransferFunction::new(Polynomial::new(num), Polynomial::new(den), Time::Continuous)?;
        let pairs = |roots: &[Complex]| roots.iter().map(|z| [z.re, z.im]).collect::<Vec<_>>();
        let sampled = |how| -> Result<_, Box<dyn Error>> {
            let there = system.sampled(period, how)?;
            Ok(json!({"num": there.numerator().coefficients(), "den": there.denominator().coefficients()}))
        };
        let margins = system.margins();
        let one = Matrix::identity(1, 1);
        let regulator =
            system.state_space()?.lqr_of_outputs(&one, &one).map(|regulator| pairs(&regulator.poles));
        let answer = json!({
            "poles": pairs(&system.poles()),
            "zeros": pairs(&system.zeros()),
            "tustin": sampled(Discretization::Tustin(None))?,
            "hold": sampled(Discretization::ZeroOrderHold)?,
            "phase": margins.phase.iter().map(|m| m.phase_rad).collect::<Vec<_>>(),
            "gain": margins.gain.iter().map(|m| m.factor).collect::<Vec<_>>(),
            "modulus": margins.modulus.map(|m| m.distance),
            "regulator": regulator.ok(),
        });
        println!("{answer}");
    }
    Ok(())
}
