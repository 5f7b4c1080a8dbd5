use std::fmt;

use crate::{Discretization, LinearError, Polynomial, Time, TransferFunction};

/// A PID: kp + ki/s + kd s / (1 + s/f).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid {
    /// Proportional.
    pub kp: f64,
    /// Integral, 1/s.
    pub ki: f64,
    /// Derivative, s.
    pub kd: f64,
    /// Where the derivative ends, f, rad/s.
    pub filter_rad_s: f64,
}

/// Which terms a controller has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Terms {
    /// Proportional alone.
    P,
    /// Proportional and integral.
    Pi,
    /// Proportional and derivative.
    Pd,
    /// All three.
    Pid,
}

impl fmt::Display for Terms {
    /// `PI`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::P => "P",
            Self::Pi => "PI",
            Self::Pd => "PD",
            Self::Pid => "PID",
        })
    }
}

/// What a PID is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PidWish {
    /// The terms it has.
    pub terms: Terms,
    /// Where the loop's gain is 1, rad/s; none: where the integral gain can be largest, without an integral the proportional gain.
    pub crossover_rad_s: Option<f64>,
    /// Its least phase margin, rad.
    pub phase_margin_rad: f64,
    /// The least distance of the loop from −1: one over the largest sensitivity.
    pub modulus: f64,
    /// How many times the crossover the derivative ends at; of samples at 2/T at most, where it is the difference of two samples.
    pub filter: f64,
    /// Whether zeros may be complex: more integral, and closed poles that swing.
    pub any_zeros: bool,
}

impl Pid {
    /// As a transfer function; without poles and zeros that cancel each other where a gain is 0.
    pub fn transfer(&self) -> TransferFunction {
        let Self { kp, ki, kd, filter_rad_s: f } = *self;
        let (above, below) = match (ki == 0.0, kd == 0.0) {
            (true, true) => (vec![kp], vec![1.0]),
            (false, true) => (vec![kp, ki], vec![1.0, 0.0]),
            (true, false) => (vec![kp + kd * f, kp * f], vec![1.0, f]),
            (false, false) => (vec![kp + kd * f, kp * f + ki, ki * f], vec![1.0, f, 0.0]),
        };
        let gain = TransferFunction::gain(kp, Time::Continuous);
        TransferFunction::new(Polynomial::new(above), Polynomial::new(below), Time::Continuous)
            .unwrap_or(gain)
    }

    /// As a transfer function in that time; of samples by Tustin's rule.
    ///
    /// # Errors
    /// [`LinearError::NotFinite`] of gains that are no numbers.
    pub fn transfer_in(&self, time: Time) -> Result<TransferFunction, LinearError> {
        match time {
            Time::Continuous => Ok(self.transfer()),
            Time::Sampled(period_s) if self.ki == 0.0 && self.kd == 0.0 => {
                Ok(TransferFunction::gain(self.kp, Time::Sampled(period_s)))
            }
            Time::Sampled(period_s) => self.transfer().sampled(period_s, Discretization::Tustin(None)),
        }
    }

    /// With other signs.
    pub(super) fn negative(self) -> Self {
        Self { kp: -self.kp, ki: -self.ki, kd: -self.kd, ..self }
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::complex;

    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    fn wish(crossover_rad_s: Option<f64>) -> PidWish {
        PidWish {
            terms: Terms::Pid,
            crossover_rad_s,
            phase_margin_rad: 55_f64.to_radians(),
            modulus: 0.6,
            filter: 10.0,
            any_zeros: false,
        }
    }

    #[test]
    fn crossover_and_margins_are_as_wished() {
        for (text, w) in
            [("13.16/(s(s+0.1316))", 60.0), ("13.33/(s^2+0.1333s+0.7822)", 30.0), ("1/(s+1)^3", 0.8)]
        {
            let plant = parse(text);
            let pid = plant.pid(wish(Some(w))).unwrap();
            let margins = plant.series(&pid.transfer()).unwrap().margins();
            let phase = margins.least_phase().unwrap();
            assert!(
                (phase.rad_s / w - 1.0).abs() < 1e-9 && (phase.degrees() - 55.0).abs() < 1e-6,
                "{margins:?}"
            );
            // the integral is the largest: the circle is touched, or the zeros are about to swing
            let touches = (margins.modulus.unwrap().distance - 0.6).abs() < 1e-4;
            let zeros = pid.transfer().zeros();
            let is_double = complex::norm(zeros[0] / zeros[1] - 1.0) < 1e-2;
            assert!(touches || is_double, "{text} {pid:?} {margins:?}");
            assert!(zeros.iter().all(|zero| zero.im == 0.0), "{text}: {zeros:?}");
        }
    }

    /// With one system alone the margins of the others fall below what is wished; with all of them none does.
    #[test]
    fn a_controller_for_several_systems_keeps_its_margins_with_each() {
        let plant = parse("1/(s+1)^3");
        let others = ["1.5/(s+1)^3", "0.7/(s+1)^3", "1/((s+1)^2(1.4s+1))"].map(parse);
        let keeps = |pid: &Pid, plant: &TransferFunction| {
            let open = plant.series(&pid.transfer()).unwrap();
            let margins = open.margins();
            let phase = margins.least_phase().map_or(180.0, |m| m.degrees());
            open.closes_stable() && phase >= 55.0 - 1e-4 && margins.modulus.unwrap().distance >= 0.6 - 1e-9
        };
        for crossover in [None, Some(0.4)] {
            let alone = plant.pid(wish(crossover)).unwrap();
            assert!(keeps(&alone, &plant) && !others.iter().all(|other| keeps(&alone, other)), "{alone:?}");
            let all = plant.pid_for_all(&others, wish(crossover)).unwrap();
            assert!(others.iter().chain([&plant]).all(|one| keeps(&all, one)), "{crossover:?}: {all:?}");
            // what more has to be kept costs some
            assert!(all.ki < alone.ki && all.ki > 0.1 * alone.ki, "{all:?} {alone:?}");
        }
        // a motor that turns the other way cannot be driven by the same controller
        let refused = plant.pid_for_all(&[parse("-1/(s+1)^3")], wish(Some(0.8)));
        assert!(refused.is_err_and(|e| e.to_string().contains("with every system")));
    }

    #[test]
    fn the_best_crossover_has_no_better_neighbour() {
        let plant = parse("1/(s+1)^4");
        let best = plant.pid(wish(None)).unwrap();
        for w in crate::logspace((0.05, 5.0), 60) {
            if let Ok(other) = plant.pid(wish(Some(w))) {
                assert!(other.ki <= best.ki * 1.001, "{w}: {other:?} {best:?}");
            }
        }
    }

    #[test]
    fn what_cannot_be_had_is_refused() {
        assert!(parse("1/(s(s+1))").pid(wish(None)).is_err_and(|e| e.to_string().contains("choose one")));
        assert!(parse("1/(s+1)^4").pid(wish(Some(50.0))).is_err());
        let (up, down) =
            (parse("1/(s+1)^3").pid(wish(None)).unwrap(), parse("-1/(s+1)^3").pid(wish(None)).unwrap());
        assert_eq!((up.kp, up.ki, up.kd), (-down.kp, -down.ki, -down.kd));
        let much = PidWish { modulus: 0.95, ..wish(None) };
        assert!(parse("1/(s+1)").pid(much).is_err_and(|e| e.to_string().contains("at most")));
    }
}
