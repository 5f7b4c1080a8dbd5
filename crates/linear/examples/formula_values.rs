//! Values of formulas, one a line from standard input, at s = 0.7 + 1.3j: `re im`, or `refused` and why.

use std::io::{BufRead, Write};

use tracelight_linear::{Complex, Time, TransferFunction};

fn main() -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    let named = |name: &str| match name {
        "G1" => TransferFunction::parse("2/(s+3)", Time::Continuous).ok().map(Into::into),
        "K2" => TransferFunction::parse("(s+1)/(s^2+4)", Time::Continuous).ok().map(Into::into),
        _ => None,
    };
    for line in std::io::stdin().lock().lines() {
        match TransferFunction::parse_with(&line?, Time::Continuous, &named) {
            Ok(system) => {
                let value = system.at(Complex::new(0.7, 1.3));
                writeln!(out, "{:e} {:e}", value.re, value.im)?;
            }
            Err(error) => writeln!(out, "refused {error}")?,
        }
    }
    Ok(())
}
