use super::pid::Pid;
use crate::{Discretization, Input, LinearError, Polynomial, Time, TransferFunction};

/// Shares of the setpoint that the terms of a PID see: kp (b r − y) + ki/s (r − y) + kd s / (1 + s/f) (c r − y). They change what a
/// setpoint does, and nothing of what a disturbance does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetpointWeights {
    /// b, of the proportional term.
    pub proportional: f64,
    /// c, of the derivative.
    pub derivative: f64,
}

impl SetpointWeights {
    /// All terms see the error.
    pub const ERROR: Self = Self { proportional: 1.0, derivative: 1.0 };
}

impl Pid {
    /// From the setpoint to its output, over the denominator of [`transfer_in`](Self::transfer_in).
    fn setpoint_transfer(
        &self,
        weights: SetpointWeights,
        time: Time,
    ) -> Result<TransferFunction, LinearError> {
        let Self { kp, ki, kd, filter_rad_s: f } = *self;
        let (p, d) = (weights.proportional * kp, weights.derivative * kd);
        let (above, below) = match (ki == 0.0, kd == 0.0) {
            (true, true) => return Ok(TransferFunction::gain(p, time)),
            (false, true) => (vec![p, ki], vec![1.0, 0.0]),
            (true, false) => (vec![p + d * f, p * f], vec![1.0, f]),
            (false, false) => (vec![p + d * f, p * f + ki, ki * f], vec![1.0, f, 0.0]),
        };
        let continuous =
            TransferFunction::new(Polynomial::new(above), Polynomial::new(below), Time::Continuous)?;
        match time {
            Time::Continuous => Ok(continuous),
            Time::Sampled(period_s) => continuous.sampled(period_s, Discretization::Tustin(None)),
        }
    }
}

impl TransferFunction {
    /// From the setpoint to the output of this plant, and to its input, closed by a PID with such weights.
    ///
    /// # Errors
    /// [`LinearError::AlgebraicLoop`] of a loop without an answer.
    pub fn weighted(
        &self,
        pid: &Pid,
        weights: SetpointWeights,
    ) -> Result<(TransferFunction, TransferFunction), LinearError> {
        let (k, before) = (pid.transfer_in(self.time())?, pid.setpoint_transfer(weights, self.time())?);
        // K and what comes before it have one denominator
        let closed = k.series(self)?.closed()?;
        let below = closed.denominator();
        let to_output = Self::new(before.numerator() * self.numerator(), below.clone(), self.time())?;
        let to_input = Self::new(before.numerator() * self.denominator(), below.clone(), self.time())?;
        Ok((to_output, to_input))
    }

    /// The largest b, without a derivative of the setpoint (c = 0), with which a step of the setpoint overshoots by so much at most, %.
    ///
    /// # Errors
    /// [`LinearError::Wish`] where none does, with the least overshoot that can be had, and of a controller without an integral: its
    /// weights would change where the output comes to rest.
    pub fn largest_weight(&self, pid: &Pid, most_percent: f64) -> Result<SetpointWeights, LinearError> {
        const STEPS: u32 = 50;
        const HALVINGS: usize = 20;
        if pid.ki == 0.0 {
            return Err(LinearError::Wish(
                "without an integral, setpoint weights change where the output comes to rest: ask for a PI or a PID, or for no weights"
                    .into(),
            ));
        }
        let weights = |b: f64| SetpointWeights { proportional: b, derivative: 0.0 };
        let overshoot = |b: f64| -> Result<f64, LinearError> {
            let info = self.weighted(pid, weights(b))?.0.step_info(0.02)?;
            Ok(info.overshoot_percent.unwrap_or(f64::INFINITY))
        };
        let (mut bad, mut least) = (None, (f64::INFINITY, 0.0));
        for step in (0..=STEPS).rev() {
            let b = f64::from(step) / f64::from(STEPS);
            let is = overshoot(b)?;
            if is < least.0 {
                least = (is, b);
            }
            if is > most_percent {
                bad = Some(b);
                continue;
            }
            let (mut good, Some(mut bad)) = (b, bad) else { return Ok(weights(b)) };
            for _ in 0..HALVINGS {
                let middle = 0.5 * (good + bad);
                if overshoot(middle)? <= most_percent { good = middle } else { bad = middle }
            }
            return Ok(weights(good));
        }
        Err(LinearError::Wish(format!(
            "no setpoint weight leaves an overshoot of {most_percent} % or less; {:.2} % can be had, with b = {}: ask for that, or for more margin",
            least.0, least.1
        )))
    }

    /// The largest deviation of the output after a step of 1 at this plant's input, closed by a PID, and where it ends; none where it
    /// comes to no value.
    ///
    /// # Errors
    /// [`LinearError::AlgebraicLoop`] of a loop without an answer.
    pub fn after_load(&self, pid: &Pid) -> Result<Option<(f64, f64)>, LinearError> {
        let loads = self.feedback(&pid.transfer_in(self.time())?)?;
        let info = loads.step_info(0.02)?;
        let Some(end) = info.ending.value() else { return Ok(None) };
        let peak = match self.time() {
            Time::Continuous => loads.transient(Input::Step)?.peak()?.map(|peak| peak.value),
            Time::Sampled(_) => info.peak.map(|peak| peak.value),
        };
        Ok(peak.map(|peak| (peak, end)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PidWish, Terms};

    fn designed(text: &str, time: Time) -> (TransferFunction, Pid) {
        let mut plant = TransferFunction::parse(text, Time::Continuous).unwrap();
        if let Time::Sampled(period_s) = time {
            plant = plant.sampled(period_s, Discretization::ZeroOrderHold).unwrap();
        }
        let wish = PidWish {
            terms: Terms::Pid,
            crossover_rad_s: Some(2.0),
            phase_margin_rad: 50_f64.to_radians(),
            modulus: 0.6,
            filter: 10.0,
            any_zeros: false,
        };
        let pid = plant.pid(wish).unwrap();
        (plant, pid)
    }

    fn overshoot(plant: &TransferFunction, pid: &Pid, weights: SetpointWeights) -> f64 {
        plant.weighted(pid, weights).unwrap().0.step_info(0.02).unwrap().overshoot_percent.unwrap()
    }

    #[test]
    fn weights_of_one_are_the_loop_itself() {
        for time in [Time::Continuous, Time::Sampled(0.05)] {
            let (plant, pid) = designed("1/(s(s+1))", time);
            let closed = plant.series(&pid.transfer_in(time).unwrap()).unwrap().closed().unwrap();
            let is = plant.weighted(&pid, SetpointWeights::ERROR).unwrap().0;
            for (a, b) in is.numerator().coefficients().iter().zip(closed.numerator().coefficients()) {
                assert!((a - b).abs() < 1e-12 * b.abs().max(1.0), "{is} {closed}");
            }
            assert!((is.dc_gain() - 1.0).abs() < 1e-9, "{is}");
        }
    }

    #[test]
    fn a_smaller_weight_overshoots_as_little_as_wished_and_no_less() {
        for time in [Time::Continuous, Time::Sampled(0.05)] {
            let (plant, pid) = designed("1/(s(s+1))", time);
            let full = overshoot(&plant, &pid, SetpointWeights::ERROR);
            assert!(full > 20.0, "{full}");
            let weights = plant.largest_weight(&pid, 5.0).unwrap();
            assert!((overshoot(&plant, &pid, weights) - 5.0).abs() < 1e-3, "{weights:?}");
            let more = SetpointWeights { proportional: weights.proportional + 0.01, ..weights };
            assert!(overshoot(&plant, &pid, more) > 5.0, "{weights:?}");
            // all that the weights do not touch
            let (peak, end) = plant.after_load(&pid).unwrap().unwrap();
            assert!(peak > 0.0 && end.abs() < 1e-9, "{peak} {end}");
        }
        let (plant, pid) = designed("1/s^2", Time::Continuous);
        let none = plant.largest_weight(&pid, -1.0);
        assert!(none.is_err_and(|e| e.to_string().contains("0.00 % can be had, with b = ")));
        assert!(plant.largest_weight(&Pid { ki: 0.0, ..pid }, 5.0).is_err());
    }
}
