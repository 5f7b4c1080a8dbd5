//! Figures of step responses, a system a line: coefficients of the numerator, a semicolon, those of the denominator, highest power first.
//!
//! Prints a line each: final value, rise, settling, overshoot, undershoot, peak, its time, and microseconds taken; `-` where there is none.

use std::io::{BufRead, Write};
use std::time::Instant;

use tracelight_linear::{Ending, Polynomial, StepInfo, Time, TransferFunction};

/// Share of the final value within which a response is settled.
const BAND: f64 = 0.02;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let (above, below) = line.split_once(';').ok_or("a line has no semicolon")?;
        let system = TransferFunction::new(polynomial(above)?, polynomial(below)?, Time::Continuous)?;
        let start = Instant::now();
        let info = system.step_info(BAND);
        let micros = start.elapsed().as_secs_f64() * 1e6;
        match info {
            Ok(info) => writeln!(out, "{} {micros:.1}", figures(&info))?,
            Err(error) => writeln!(out, "error {error}")?,
        }
    }
    Ok(())
}

fn polynomial(text: &str) -> Result<Polynomial, std::num::ParseFloatError> {
    let coefficients: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    Ok(Polynomial::new(coefficients?))
}

fn figures(info: &StepInfo) -> String {
    let goal = match info.ending {
        Ending::Converges(value) => Some(value),
        _ => None,
    };
    let all = [
        goal,
        info.rise_s,
        info.settle_s,
        info.overshoot_percent,
        info.undershoot_percent,
        info.peak.map(|peak| peak.value),
        info.peak.and_then(|peak| peak.time_s),
    ];
    all.map(|figure| figure.map_or("-".to_owned(), |value| format!("{value:e}"))).join(" ")
}
