use crate::{LinearError, Matrix, Response, StateSpace, Time};

impl StateSpace {
    /// Answers of every output to a step of 1 at every input, the others 0: by output, then by input. Exact at its times, `step_s`
    /// apart (of a sampled system its period).
    ///
    /// # Errors
    /// [`LinearError::Range`] of a step that is not more than 0.
    pub fn step_responses(&self, step_s: f64, count: usize) -> Result<Vec<Vec<Response>>, LinearError> {
        self.each_channel(|channel| channel.step_response(step_s, count))
    }

    /// Answers to an impulse at every input, likewise: in continuous time of area 1, and without the impulse that D lets straight
    /// through; of samples, 1 for one of them.
    ///
    /// # Errors
    /// As [`step_responses`](Self::step_responses).
    pub fn impulse_responses(&self, step_s: f64, count: usize) -> Result<Vec<Vec<Response>>, LinearError> {
        self.each_channel(|channel| channel.impulse(step_s, count))
    }

    fn each_channel(
        &self,
        response: impl Fn(&Self) -> Result<Response, LinearError>,
    ) -> Result<Vec<Vec<Response>>, LinearError> {
        let inputs = 0..self.b().ncols();
        let of = |output| inputs.clone().map(|input| response(&self.channel(output, input)?)).collect();
        (0..self.c().nrows()).map(of).collect()
    }

    fn impulse(&self, step_s: f64, count: usize) -> Result<Response, LinearError> {
        let (on, first, step_s): (Matrix, _, _) = match self.time() {
            Time::Continuous => (
                self.held_over(crate::time::positive("the time from value to value", step_s)?).0,
                None,
                step_s,
            ),
            Time::Sampled(period_s) => (self.a().clone(), Some(self.d()[(0, 0)]), period_s),
        };
        let mut values: Vec<f64> = first.into_iter().collect();
        let mut x = self.b().clone();
        while values.len() < count {
            values.push((self.c() * &x)[(0, 0)]);
            x = &on * x;
        }
        values.truncate(count);
        Ok(Response { step_s, values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_channel_answers_as_it_does_alone() {
        let a = Matrix::from_row_slice(2, 2, &[-1.0, 0.0, 0.0, -3.0]);
        let d = Matrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
        let system =
            StateSpace::new(a, Matrix::identity(2, 2), Matrix::identity(2, 2), d, Time::Continuous).unwrap();
        let (steps, impulses) =
            (system.step_responses(0.1, 11).unwrap(), system.impulse_responses(0.1, 11).unwrap());
        let e = (-3.0_f64).exp();
        assert!(
            (steps[1][1].values[10] - (1.0 - e) / 3.0).abs() < 1e-15
                && (impulses[1][1].values[10] - e).abs() < 1e-15
        );
        assert_eq!((steps[0][1].values[3], steps[1][0].values[3], impulses[0][1].values[3]), (1.0, 0.0, 0.0));
    }
}
