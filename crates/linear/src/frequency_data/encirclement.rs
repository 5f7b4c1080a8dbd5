//! Stability of a loop that is closed, from the data of the open one: by how often they go round −1.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use tracelight_maths::complex;

use crate::frequency_data::data::FrequencyData;
use crate::{Complex, LinearError};

/// Halvings of the way from point to point on which the loop may turn round −1.
const MOST_HALVINGS: u32 = 24;

impl FrequencyData {
    /// How many poles the loop has outside the stable region when this open loop, which has so many there itself, is closed by
    /// negative feedback: Nyquist's criterion. Poles of the open loop at 0 are seen in the data and are not told.
    ///
    /// # Errors
    /// [`LinearError::Data`] says why the data do not tell: they begin too high or end too low (above them the gain has to stay below
    /// 1), pass through −1, or contradict the number told.
    pub fn unstable_when_closed(&self, unstable_open: usize) -> Result<usize, LinearError> {
        let turned = self.turned_before()? + self.turned_inside()? + self.turned_after()?;
        let half_turns = (turned / PI).round();
        let closed = unstable_open as f64 - half_turns;
        if (turned / PI - half_turns).abs() > 1e-6 || closed < 0.0 {
            return Err(LinearError::Data(format!(
                "the data turn by {half_turns} half turns round −1, which an open loop with {unstable_open} unstable poles cannot"
            )));
        }
        Ok(closed as usize)
    }

    /// By how much 1 + G turns from frequency 0, past integrators on their right, to the first point, rad.
    fn turned_before(&self) -> Result<f64, LinearError> {
        let (places, sizes) = (self.size.places(), self.size.values());
        let fall = -(sizes[1] - sizes[0]) / (places[1] - places[0]);
        let integrators = fall.round();
        let value = self.values()[0];
        let begins = complex::arg(1.0 + value);
        if (integrators < 0.0 || self.at_rest().is_some()) && complex::norm(value) < 1.0 {
            return Ok(begins);
        }
        let too_high = || {
            LinearError::Data(format!(
                "the data begin at {} rad/s, where the loop is not yet like k/s^n: how it goes round −1 below is not known",
                self.band().0
            ))
        };
        // k/(jω)^n times j^n is k
        let own = complex::arg(value) + integrators * FRAC_PI_2;
        let off = (own / PI - (own / PI).round()).abs() * PI;
        if (fall - integrators).abs() > 0.25 || off > PI / 6.0 {
            return Err(too_high());
        }
        if integrators > 0.0 {
            // a small half circle to the right of 0 is a large one, from the real axis on
            if complex::norm(value) < 2.0 {
                return Err(too_high());
            }
            let start = if (own / PI).round().rem_euclid(2.0) == 0.0 { 0.0 } else { PI };
            let expected = start - integrators * FRAC_PI_2;
            return Ok(expected + turn(begins - expected) - start);
        }
        let start = if 1.0 + value.re > 0.0 { 0.0 } else { PI };
        if turn(begins - start).abs() > PI / 4.0 {
            return Err(too_high());
        }
        Ok(turn(begins - start))
    }

    /// By how much 1 + G turns along the data, rad.
    fn turned_inside(&self) -> Result<f64, LinearError> {
        let mut all = 0.0;
        for ends in self.size.places().windows(2) {
            all += self.turned_between((ends[0], self.away(ends[0])), (ends[1], self.away(ends[1])), 0)?;
        }
        Ok(all)
    }

    fn away(&self, place: f64) -> Complex {
        1.0 + self.there(place)
    }

    fn turned_between(
        &self,
        from: (f64, Complex),
        to: (f64, Complex),
        depth: u32,
    ) -> Result<f64, LinearError> {
        let middle = 0.5 * (from.0 + to.0);
        let between = self.away(middle);
        let (first, second) = (complex::arg(between / from.1), complex::arg(to.1 / between));
        if !(first.is_finite() && second.is_finite()) || depth >= MOST_HALVINGS {
            return Err(LinearError::Data(format!(
                "the data pass through −1 near {} rad/s: the loop is at the edge of stability there",
                tracelight_maths::exp(middle)
            )));
        }
        if first.abs() < PI / 4.0 && second.abs() < PI / 4.0 {
            return Ok(first + second);
        }
        let middle = (middle, between);
        Ok(self.turned_between(from, middle, depth + 1)? + self.turned_between(middle, to, depth + 1)?)
    }

    /// By how much 1 + G turns above the last point, where the gain stays below 1, rad.
    fn turned_after(&self) -> Result<f64, LinearError> {
        let value = self.values()[self.values().len() - 1];
        let sizes = self.size.values();
        if complex::norm(value) >= 0.7 || sizes[sizes.len() - 1] > sizes[sizes.len() - 2] + 1e-9 {
            return Err(LinearError::Data(format!(
                "the data end at {} rad/s, where the gain is {:.3}: it has to be below 0.7 there, and falling",
                self.band().1,
                complex::norm(value)
            )));
        }
        Ok(-complex::arg(1.0 + value))
    }
}

/// An angle less whole turns, from −π to π.
fn turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Time, TransferFunction, logspace};

    #[test]
    fn the_count_is_that_of_the_closed_loops_poles() {
        for text in [
            "1/(s(s+1)(s+2))",
            "7/(s(s+1)(s+2))",
            "30 (s+1)^2 / (s^3 (1 + s/50)^2)",
            "3 (s+1)^2 / (s^3 (1 + s/50)^2)",
            "2/(s-1)",
            "0.5/(s-1)",
            "-0.5/(s+1)",
            "-2/(s+1)",
            "10 (s+1)/((s-1)(s-2)(s+20))",
            "200 (s+1)/((s-1)(s-2)(s+20))",
            "20/(s+1)^4",
            "s/((s+1)^3)",
            "-30 s/((s+1)^3)",
            "-1/(s (s+1))",
            "4 (s+3)/(s^2 (s+20))",
            "100/((s^2+0.1s+1)(s+1))",
            "40/((s^2-s+9)(s+5))",
        ] {
            let g = TransferFunction::parse(text, Time::Continuous).unwrap();
            let unstable = |g: &TransferFunction| g.poles().iter().filter(|p| p.re > 1e-9).count();
            let truth = unstable(&g.closed().unwrap());
            for count in [60, 400] {
                let response = g.frequency_response(logspace((1e-3, 1e3), count));
                let data = FrequencyData::new(response.rad_s, response.values).unwrap();
                assert_eq!(data.unstable_when_closed(unstable(&g)), Ok(truth), "{text}, {count} points");
            }
        }
    }

    #[test]
    fn data_that_do_not_tell_are_refused() {
        let data = |text: &str, band| {
            let g = TransferFunction::parse(text, Time::Continuous).unwrap();
            let response = g.frequency_response(logspace(band, 100));
            FrequencyData::new(response.rad_s, response.values).unwrap()
        };
        for (text, band, unstable, says) in [
            ("7/(s(s+1)(s+2))", (1e-3, 1.0), 0, "end at 1 rad/s"),
            ("7/(s(s+1)(s+2))", (1.2, 1e3), 0, "begin at 1.2 rad/s"),
            ("2/(s-1)", (1e-3, 1e3), 0, "cannot"),
            ("2 (s+3)/(s+1)^2", (1e-3, 0.5), 0, "end at"),
        ] {
            let error = data(text, band).unstable_when_closed(unstable).unwrap_err().to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
