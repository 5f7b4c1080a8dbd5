use std::f64::consts::{PI, TAU};

use tracelight_maths::{complex, exp, ln, log10};

use crate::frequency_data::curve::Curve;
use crate::{Complex, FrequencyResponse, LinearError};

/// A frequency response at given frequencies, with an interpolation between them.
///
/// Between two points, ln |G| and the unwrapped phase are cubics in ln ω whose slopes are those of a quartic through five neighbours,
/// limited so that no rise or fall of the data is overshot. Outside the data nothing is known.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyData {
    rad_s: Vec<f64>,
    values: Vec<Complex>,
    at_rest: Option<f64>,
    /// Points that were measured and are not trusted.
    left_out: Vec<(f64, Complex)>,
    /// ln |G| and phase, rad, over ln ω.
    pub(super) size: Curve,
    pub(super) phase: Curve,
}

/// How far apart the points of a frequency response are, where they are furthest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spacing {
    /// Longest way from one frequency to the next, decades.
    pub decades: f64,
    /// Where that begins, rad/s.
    pub decades_rad_s: f64,
    /// Largest change of the phase from one point to the next, rad; near π a turn may have been missed.
    pub phase_rad: f64,
    /// Where that begins, rad/s.
    pub phase_rad_s: f64,
}

impl FrequencyData {
    /// Most points.
    pub const MOST: usize = 1_000_000;

    /// Values at frequencies, rad/s, that rise; a first one at 0 is what the system rests at.
    ///
    /// # Errors
    /// [`LinearError::Data`] with the number of the point: fewer than two points above 0 or more than [`MOST`](Self::MOST), frequencies
    /// that do not rise, values of 0 or beyond all numbers.
    pub fn new(mut rad_s: Vec<f64>, mut values: Vec<Complex>) -> Result<Self, LinearError> {
        if rad_s.len() != values.len() {
            return Err(LinearError::Data(format!("{} frequencies, {} values", rad_s.len(), values.len())));
        }
        check(&rad_s, &values)?;
        let mut at_rest = None;
        if rad_s.first() == Some(&0.0) {
            rad_s.remove(0);
            at_rest = Some(values.remove(0).re);
        }
        if rad_s.len() < 2 {
            return Err(LinearError::Data(format!(
                "{} frequencies above 0; a response needs at least two",
                rad_s.len()
            )));
        }
        let at: Vec<f64> = rad_s.iter().map(|w| ln(*w)).collect();
        if at.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err(LinearError::Data("two frequencies are the same to fifteen digits".into()));
        }
        let size = Curve::new(at.clone(), values.iter().map(|value| ln(complex::norm(*value))).collect());
        let phase = Curve::new(at, unwrapped(&values));
        Ok(Self { rad_s, values, at_rest, left_out: Vec::new(), size, phase })
    }

    /// The data with points that were measured as well, rad/s and value, and are not trusted: they go along, and no figure is of them.
    #[must_use]
    pub fn with_left_out(self, left_out: Vec<(f64, Complex)>) -> Self {
        Self { left_out, ..self }
    }

    /// Points that were measured and are not trusted: frequency, rad/s, and value.
    pub fn left_out(&self) -> &[(f64, Complex)] {
        &self.left_out
    }

    /// The frequencies, rad/s, rising, more than 0.
    pub fn rad_s(&self) -> &[f64] {
        &self.rad_s
    }

    /// The value at each.
    pub fn values(&self) -> &[Complex] {
        &self.values
    }

    /// The gain at frequency 0, if the data have it.
    pub const fn at_rest(&self) -> Option<f64> {
        self.at_rest
    }

    /// First and last frequency above 0, rad/s.
    pub fn band(&self) -> (f64, f64) {
        (self.rad_s[0], self.rad_s[self.rad_s.len() - 1])
    }

    /// The value at a frequency, rad/s, interpolated; none outside the [`band`](Self::band).
    pub fn at(&self, rad_s: f64) -> Option<Complex> {
        let (first, last) = self.band();
        (first..=last).contains(&rad_s).then(|| self.there(ln(rad_s)))
    }

    /// The unwrapped phase at a frequency, rad, interpolated; none outside the [`band`](Self::band). The first is in (−π, π].
    pub fn phase(&self, rad_s: f64) -> Option<f64> {
        let (first, last) = self.band();
        (first..=last).contains(&rad_s).then(|| self.phase.at(ln(rad_s)))
    }

    /// The data themselves, with their unwrapped phase.
    pub fn response(&self) -> FrequencyResponse {
        FrequencyResponse {
            rad_s: self.rad_s.clone(),
            values: self.values.clone(),
            phases_rad: self.phase.values().to_vec(),
        }
    }

    /// How far apart the points are.
    pub fn spacing(&self) -> Spacing {
        let widest = |steps: &dyn Fn(usize) -> f64| {
            let all = (0..self.rad_s.len() - 1).map(|i| (i, steps(i)));
            all.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
        };
        let phases = self.phase.values();
        let (decades_at, decades) = widest(&|i| log10(self.rad_s[i + 1] / self.rad_s[i]));
        let (phase_at, phase_rad) = widest(&|i| (phases[i + 1] - phases[i]).abs());
        let (decades_rad_s, phase_rad_s) = (self.rad_s[decades_at], self.rad_s[phase_at]);
        Spacing { decades, decades_rad_s, phase_rad, phase_rad_s }
    }

    /// Times a number other than 0.
    ///
    /// # Errors
    /// As [`new`](Self::new), where a product is no number.
    pub fn scaled(&self, by: f64) -> Result<Self, LinearError> {
        self.mapped(|_, value| value * by)
    }

    /// Each value times what a function has at its frequency, rad/s: data times a controller, say.
    ///
    /// # Errors
    /// As [`new`](Self::new), where a product is 0 or no number.
    pub fn times(&self, factor: impl Fn(f64) -> Complex) -> Result<Self, LinearError> {
        self.mapped(|rad_s, value| value * factor(rad_s))
    }

    /// Closed by negative feedback of its output: G / (1 + G).
    ///
    /// # Errors
    /// As [`new`](Self::new), where 1 + G is 0.
    pub fn closed(&self) -> Result<Self, LinearError> {
        self.mapped(|_, value| value / (1.0 + value))
    }

    /// Each value as a function of its frequency, rad/s, and of itself: what a loop makes of it, say.
    ///
    /// # Errors
    /// As [`new`](Self::new), where a result is 0 or no number.
    pub fn mapped(&self, map: impl Fn(f64, Complex) -> Complex) -> Result<Self, LinearError> {
        let rest = self.at_rest.map(|gain| (0.0, map(0.0, gain.into())));
        let others = self.rad_s.iter().zip(&self.values).map(|(&w, &value)| (w, map(w, value)));
        // a rest that became 0 or infinite is no rest
        let rest = rest.filter(|(_, value)| value.re != 0.0 && value.is_finite());
        let (rad_s, values) = rest.into_iter().chain(others).unzip();
        let left_out = self.left_out.iter().map(|&(w, value)| (w, map(w, value)));
        let left_out = left_out.filter(|(_, value)| value.is_finite()).collect();
        Ok(Self::new(rad_s, values)?.with_left_out(left_out))
    }

    /// The value at a place on the scale of ln ω.
    pub(super) fn there(&self, at: f64) -> Complex {
        complex::from_polar(exp(self.size.at(at)), self.phase.at(at))
    }
}

fn check(rad_s: &[f64], values: &[Complex]) -> Result<(), LinearError> {
    let refused = |number: usize, what: &str| {
        Err(LinearError::Data(format!("point {}, at {} rad/s, {what}", number + 1, rad_s[number])))
    };
    if rad_s.len() > FrequencyData::MOST {
        let most = FrequencyData::MOST;
        return Err(LinearError::Data(format!("{} frequencies; at most {most} are taken", rad_s.len())));
    }
    for (i, (w, value)) in rad_s.iter().zip(values).enumerate() {
        if !(*w >= 0.0 && w.is_finite()) {
            return refused(i, "has no frequency of 0 or more");
        }
        if i > 0 && *w <= rad_s[i - 1] {
            return refused(i, &format!("does not come above the one before it, {} rad/s", rad_s[i - 1]));
        }
        let size = complex::norm(*value);
        if !size.is_finite() {
            return refused(i, "has a value beyond all numbers");
        }
        if *w > 0.0 && size < f64::MIN_POSITIVE {
            return refused(i, "has a value of 0, which has no phase: leave it out");
        }
    }
    Ok(())
}

/// Arguments without jumps of more than half a turn.
fn unwrapped(values: &[Complex]) -> Vec<f64> {
    let mut last = 0.0_f64;
    let mut phases = Vec::with_capacity(values.len());
    for (i, value) in values.iter().enumerate() {
        let own = complex::arg(*value);
        let phase = match i {
            0 if own == -PI => PI,
            0 => own,
            _ => own + TAU * ((last - own) / TAU).round(),
        };
        phases.push(phase);
        last = phase;
    }
    phases
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Time, TransferFunction, logspace};

    fn sampled(text: &str, band: (f64, f64), count: usize) -> (TransferFunction, FrequencyData) {
        let g = TransferFunction::parse(text, Time::Continuous).unwrap();
        let response = g.frequency_response(logspace(band, count));
        (g, FrequencyData::new(response.rad_s, response.values).unwrap())
    }

    #[test]
    fn between_points_it_is_what_the_system_is() {
        for (count, most) in [(50, 5e-2), (200, 1e-3), (1000, 1e-4)] {
            let (g, data) = sampled("10 (s+3)/(s(s+1)(s^2+2s+25))", (0.01, 1e3), count);
            let off = |w: f64| {
                let truth = g.at(Complex::new(0.0, w));
                complex::norm(data.at(w).unwrap() - truth) / complex::norm(truth)
            };
            let worst = logspace((0.02, 500.0), 3457).into_iter().map(off).fold(0.0, f64::max);
            assert!(worst < most, "{count} points: off by {worst:e}");
        }
    }

    #[test]
    fn at_its_points_it_is_the_data() {
        let (_, data) = sampled("1/(s(s+1)(s+2))", (0.1, 10.0), 20);
        for (w, value) in data.rad_s().iter().zip(data.values()) {
            assert!(complex::norm(data.at(*w).unwrap() - value) < 1e-13 * complex::norm(*value));
        }
        assert_eq!((data.at(0.0999), data.at(10.01)), (None, None));
        assert!((data.phase(10.0).unwrap().to_degrees() + 252.98).abs() < 0.01);
    }

    #[test]
    fn how_far_apart_points_are_is_said() {
        let data = FrequencyData::new(
            vec![0.0, 1.0, 10.0, 20.0],
            vec![2.0.into(), 1.0.into(), Complex::I, Complex::new(0.0, 2.0)],
        )
        .unwrap();
        let spacing = data.spacing();
        assert_eq!((spacing.decades, spacing.decades_rad_s, spacing.phase_rad_s), (1.0, 1.0, 1.0));
        assert!((spacing.phase_rad - PI / 2.0).abs() < 1e-15);
        assert_eq!(data.at_rest(), Some(2.0));
    }

    #[test]
    fn what_is_no_response_is_refused_with_its_point() {
        let one = Complex::ONE;
        for (rad_s, values, says) in [
            (vec![1.0], vec![one], "at least two"),
            (vec![1.0, 1.0], vec![one, one], "point 2, at 1 rad/s"),
            (vec![2.0, 1.0], vec![one, one], "point 2"),
            (vec![-1.0, 1.0], vec![one, one], "point 1"),
            (vec![1.0, f64::NAN], vec![one, one], "point 2"),
            (vec![1.0, 2.0], vec![one, Complex::ZERO], "point 2, at 2 rad/s, has a value of 0"),
            (vec![1.0, 2.0], vec![one, f64::INFINITY.into()], "beyond"),
            (vec![1.0, 2.0], vec![one], "2 frequencies, 1 values"),
            (vec![0.0, 2.0], vec![one, one], "at least two"),
        ] {
            let error = FrequencyData::new(rad_s, values).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
