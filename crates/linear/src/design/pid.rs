use std::f64::consts::PI;

use tracelight_maths::{complex, exp, ln, powi, sin};

use super::in_continuous_time;
use crate::notation::four_digits;
use crate::time::positive;
use crate::{Complex, LinearError, Polynomial, Time, TransferFunction};

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

/// The same wish with wider and wider phase margins.
fn wider(wish: &PidWish) -> impl Iterator<Item = PidWish> {
    const STEP_RAD: f64 = 5.0 * PI / 180.0;
    const STEPS: u32 = 12;
    let wish = *wish;
    let wider = (0..=STEPS).map(move |k| wish.phase_margin_rad + f64::from(k) * STEP_RAD);
    wider.filter(|rad| *rad < PI).map(move |phase_margin_rad| PidWish { phase_margin_rad, ..wish })
}

/// What a PID is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PidWish {
    /// Where the loop's gain is 1, rad/s; none: where the integral can be largest.
    pub crossover_rad_s: Option<f64>,
    /// Its least phase margin, rad.
    pub phase_margin_rad: f64,
    /// The least distance of the loop from −1: one over the largest sensitivity.
    pub modulus: f64,
    /// How many times the crossover the derivative ends at.
    pub filter: f64,
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
}

impl TransferFunction {
    /// The PID with the largest integral gain, which rejects a load best, of those that give the open loop that crossover, at least that
    /// phase margin and that distance from −1, and have real zeros (the criterion of Åström & Hägglund, *Advanced PID Control*, 2006,
    /// §6.8).
    ///
    /// Where no positive gains do, all of them may be negative.
    ///
    /// # Errors
    /// [`LinearError::Wish`] where there is none, with the nearest margins that can be had.
    pub fn pid(&self, wish: PidWish) -> Result<Pid, LinearError> {
        let negative = || {
            let Pid { kp, ki, kd, filter_rad_s } = self.scaled(-1.0).positive_pid(wish).ok()?;
            Some(Pid { kp: -kp, ki: -ki, kd: -kd, filter_rad_s })
        };
        self.positive_pid(wish).or_else(|why| negative().ok_or(why))
    }

    fn positive_pid(&self, wish: PidWish) -> Result<Pid, LinearError> {
        in_continuous_time(self.time(), "a PID")?;
        let PidWish { phase_margin_rad, modulus, filter, .. } = wish;
        positive("the filter's ratio", filter)?;
        if !(0.0..PI).contains(&phase_margin_rad) || !(0.0..1.0).contains(&modulus) {
            let message = "a phase margin is between 0 and 180°, a modulus margin between 0 and 1";
            return Err(LinearError::Wish(message.into()));
        }
        // the circle of that modulus margin about −1 lies where the phase margin is this at least
        if modulus > 2.0 * sin(0.5 * phase_margin_rad) {
            return Err(LinearError::Wish(format!(
                "a phase margin of {:.1}° leaves a modulus margin of {:.3} at most: ask for more of the one or less of the other",
                phase_margin_rad.to_degrees(),
                2.0 * sin(0.5 * phase_margin_rad)
            )));
        }
        match wish.crossover_rad_s {
            Some(w) => {
                let w = positive("the crossover, rad/s,", w)?;
                self.largest_at(w, &wish).ok_or_else(|| {
                    let what = format!("a crossover of {} rad/s, ", four_digits(w));
                    self.nearest_margins(&wish, &what, |wish| self.largest_at(w, wish).is_some())
                })
            }
            None => self.best_pid(&wish),
        }
    }

    /// At that crossover the largest integral gain of all phase margins that are wide enough.
    fn largest_at(&self, w: f64, wish: &PidWish) -> Option<Pid> {
        let all = wider(wish).filter_map(|wish| self.pid_at(w, &wish));
        all.max_by(|a, b| a.ki.total_cmp(&b.ki))
    }

    /// Why there is none, with the largest share of both margins that there is.
    fn nearest_margins(&self, wish: &PidWish, what: &str, has: impl Fn(&PidWish) -> bool) -> LinearError {
        /// Halvings of the range of shares.
        const HALVINGS: usize = 6;
        let less = |share: f64| PidWish {
            phase_margin_rad: share * wish.phase_margin_rad,
            modulus: share * wish.modulus,
            ..*wish
        };
        let (mut good, mut bad) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (good + bad);
            if has(&less(middle)) { good = middle } else { bad = middle }
        }
        let asked = format!(
            "no PID gives {what}{:.1}° of phase margin and a modulus margin of {}",
            wish.phase_margin_rad.to_degrees(),
            four_digits(wish.modulus)
        );
        let nearest = less(good);
        LinearError::Wish(if good > 0.0 {
            format!(
                "{asked}; {:.1}° and {} can be had: ask for these or less{}",
                nearest.phase_margin_rad.to_degrees(),
                four_digits(nearest.modulus),
                if what.is_empty() { "" } else { ", or for another crossover" }
            )
        } else {
            format!(
                "{asked}, nor a hundredth of these: {}",
                if what.is_empty() { "no PID will do" } else { "ask for another crossover" }
            )
        })
    }

    /// Of all crossovers and phase margins those whose integral gain is largest.
    fn best_pid(&self, wish: &PidWish) -> Result<Pid, LinearError> {
        const FEW: usize = 24;
        let is_possible =
            |wish: &PidWish| self.crossovers(FEW).iter().any(|&w| self.largest_at(w, wish).is_some());
        let mut best: Option<Pid> = None;
        for wish in wider(wish) {
            match self.best_with(&wish) {
                Ok(pid) if best.is_none_or(|best| pid.ki > best.ki) => best = Some(pid),
                Err(why)
                    if best.is_none() && !matches!(&why, LinearError::Wish(words) if words.is_empty()) =>
                {
                    return Err(why);
                }
                // wider still is no better
                _ if best.is_some() => break,
                _ => {}
            }
        }
        best.ok_or_else(|| self.nearest_margins(wish, "", is_possible))
    }

    fn crossovers(&self, count: usize) -> Vec<f64> {
        crate::logspace(self.band(), count)
    }

    /// Of the crossovers the one whose integral gain is largest, with just that phase margin; a wish without words where there is none.
    fn best_with(&self, wish: &PidWish) -> Result<Pid, LinearError> {
        const CROSSOVERS: usize = 80;
        let crossovers = self.crossovers(CROSSOVERS);
        let all: Vec<Option<Pid>> = crossovers.iter().map(|&w| self.pid_at(w, wish)).collect();
        let ki = |i: usize| all[i].map_or(f64::NEG_INFINITY, |pid| pid.ki);
        let best = (0..CROSSOVERS).max_by(|&a, &b| ki(a).total_cmp(&ki(b))).filter(|&i| all[i].is_some());
        let Some(best) = best else { return Err(LinearError::Wish(String::new())) };
        let high = crossovers[CROSSOVERS - 1];
        if best + 1 == CROSSOVERS {
            return Err(LinearError::Wish(format!(
                "the faster the better, up to {} rad/s and beyond: nothing in the system bounds the crossover; choose one",
                four_digits(high)
            )));
        }
        // between the neighbours, by golden section
        let (mut from, mut to) = (ln(crossovers[best.saturating_sub(1)]), ln(crossovers[best + 1]));
        let mut found = all[best];
        for _ in 0..24 {
            let at = |share: f64| self.pid_at(exp(from + share * (to - from)), wish);
            let (one, other) = (at(0.382), at(0.618));
            let ki = |pid: &Option<Pid>| pid.map_or(f64::NEG_INFINITY, |pid| pid.ki);
            if ki(&one) > ki(&other) {
                to = from + 0.618 * (to - from)
            } else {
                from += 0.382 * (to - from)
            }
            for pid in [one, other] {
                if ki(&pid) > ki(&found) {
                    found = pid;
                }
            }
        }
        found.ok_or(LinearError::NotConverged)
    }

    /// With that crossover and phase margin, and the most integral that leaves the modulus margin.
    fn pid_at(&self, w: f64, wish: &PidWish) -> Option<Pid> {
        /// Shares of the controller's size at the crossover that the integral has: a step of 8 %.
        const STEPS: i32 = 100;
        let share = |k: i32| if k == STEPS { 0.0 } else { 5.0 * powi(0.92, k) };
        let ok = |share: f64| self.pid_with(w, share, wish).filter(|pid| self.is_calm(pid, wish));
        let first = (0..=STEPS).find(|&k| ok(share(k)).is_some())?;
        let (mut good, mut bad) = (share(first), share((first - 1).max(0)));
        for _ in 0..if first == 0 { 0 } else { 20 } {
            let middle = 0.5 * (good + bad);
            if ok(middle).is_some() { good = middle } else { bad = middle }
        }
        ok(good)
    }

    /// The controller's value at the crossover is given: with that share of it as the integral the two other gains follow.
    fn pid_with(&self, w: f64, share: f64, wish: &PidWish) -> Option<Pid> {
        let value = -complex::from_polar(1.0, wish.phase_margin_rad) / self.at(Complex::new(0.0, w));
        let f = wish.filter * w;
        let of_derivative = Complex::new(w, f) * (w * f / (w * w + f * f));
        let ki = share * w * complex::norm(value);
        let kd = (value.im + ki / w) / of_derivative.im;
        let kp = value.re - kd * of_derivative.re;
        // less than rounding is none
        let kd = if kd.abs() * w < 1e-12 * complex::norm(value) { 0.0 } else { kd };
        // zeros that swing would leave poles that do
        let is_calm = powi(kp * f + ki, 2) >= 4.0 * ki * f * (kp + kd * f);
        let makes_sense =
            is_calm && kp >= 0.0 && kd >= 0.0 && (kp + ki + kd).is_finite() && complex::norm(value) > 0.0;
        makes_sense.then_some(Pid { kp, ki, kd, filter_rad_s: f })
    }

    /// Whether the loop is stable, keeps its distance from −1, and the phase margin is not less anywhere else.
    fn is_calm(&self, pid: &Pid, wish: &PidWish) -> bool {
        let Ok(open) = self.series(&pid.transfer()) else { return false };
        let margins = open.margins();
        let far = margins.modulus.is_some_and(|m| m.distance >= wish.modulus);
        let late = margins.least_phase().is_some_and(|m| m.phase_rad.abs() >= wish.phase_margin_rad - 1e-6);
        far && late && open.closes_stable()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    fn wish(crossover_rad_s: Option<f64>) -> PidWish {
        PidWish { crossover_rad_s, phase_margin_rad: 55_f64.to_radians(), modulus: 0.6, filter: 10.0 }
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
