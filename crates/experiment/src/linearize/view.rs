//! A linear system, as it is shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_linear::{Complex, Matrix, Time};
use tracelight_rig::Joint;

use super::{Finding, Own};
use crate::finding;
use crate::numbers::four;
use crate::systems::{place, pole_lines};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let Self { head, linear, both } = self;
        let holding = &linear.holding_nm;
        let mut text = format!(
            "{}\n{}; {} and {} N m keep it so\n",
            head.name,
            head.place(),
            four(holding.pan),
            four(holding.tilt)
        );
        for (name, joint) in [("G11", Joint::Pan), ("G22", Joint::Tilt)] {
            let Own { transfer, cancelled } = &both[joint];
            // writing to a String cannot fail
            let _ = writeln!(text, "\n{name}, {joint} angle over {joint} torque, rad/(N m)\n    {transfer}");
            let factors = transfer.factored();
            if factors != transfer.to_string() {
                let _ = writeln!(text, "    = {factors}");
            }
            if !cancelled.is_empty() {
                let places: Vec<String> =
                    cancelled.iter().filter(|z| z.im >= 0.0).map(|z| place(*z)).collect();
                let _ =
                    writeln!(text, "    cancelled: {} (kept with --keep-cancellations)", places.join(", "));
            }
        }
        let _ = write!(
            text,
            "\n{}",
            pole_lines(&linear.system.distinct_poles().unwrap_or_default(), Time::Continuous)
        );
        let _ = write!(
            text,
            "\nx = (pan, tilt, pan rate, tilt rate), u = (pan torque, tilt torque), y = (pan, tilt)\n\nA =\n{}\nB =\n{}",
            matrix(linear.system.a()),
            matrix(linear.system.b())
        );
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let Self { head, linear, both } = self;
        let pair = |z: &Complex| json!([z.re, z.im]);
        let own = |Own { transfer, cancelled }: &Own| {
            json!({
                "num": transfer.numerator().coefficients(),
                "den": transfer.denominator().coefficients(),
                "cancelled": cancelled.iter().map(pair).collect::<Vec<_>>(),
            })
        };
        let rows = |m: &Matrix| {
            m.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>()).collect::<Vec<_>>()
        };
        let system = &linear.system;
        json!({
            "head": head.name,
            "pan_rad": head.pan_rad,
            "tilt_rad": head.operation.tilt_rad,
            "rates_rad_s": [head.operation.rate_rad_s.pan, head.operation.rate_rad_s.tilt],
            "holding_nm": [linear.holding_nm.pan, linear.holding_nm.tilt],
            "G11": own(&both.pan),
            "G22": own(&both.tilt),
            "poles": system.poles().unwrap_or_default().iter().map(pair).collect::<Vec<_>>(),
            "A": rows(system.a()),
            "B": rows(system.b()),
            "C": rows(system.c()),
            "D": rows(system.d()),
            "period_s": null,
            "states": ["pan_rad", "tilt_rad", "pan_rad_s", "tilt_rad_s"],
            "inputs": ["pan_nm", "tilt_nm"],
            "outputs": ["pan_rad", "tilt_rad"],
        })
        .to_string()
    }
}

fn matrix(matrix: &Matrix) -> String {
    matrix.row_iter().fold(String::new(), |mut text, row| {
        for entry in row.iter() {
            let _ = write!(text, " {:12.6}", entry + 0.0);
        }
        text + "\n"
    })
}
