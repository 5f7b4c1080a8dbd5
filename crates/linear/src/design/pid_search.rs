use std::f64::consts::PI;

use tracelight_maths::{complex, exp, ln, powi, sin, tan};

use super::pid::{Pid, PidWish, Terms};
use crate::golden::lowest;
use crate::notation::four_digits;
use crate::time::positive;
use crate::{Complex, LinearError, Time, TransferFunction};

/// Phase margins from what is wished upwards, rad.
const WIDER_RAD: f64 = 5.0 * PI / 180.0;
const WIDER_STEPS: i32 = 12;
/// Crossovers that are tried, evenly over the logarithm of the system's band.
const CROSSOVERS: usize = 80;

impl TransferFunction {
    /// The controller with the largest integral gain, which rejects a load best, without an integral that with the largest proportional
    /// gain, of those that give the open loop that crossover, at least that phase margin and that distance from −1, and have real
    /// zeros unless any will do (the criterion of Åström & Hägglund, *Advanced PID Control*, 2006, §6.8). Of a sampled system it is that
    /// of the samples, by Tustin's rule, and the margins are those of the sampled loop.
    ///
    /// Where no positive gains do, all of them may be negative.
    ///
    /// # Errors
    /// [`LinearError::Wish`] where there is none, with the nearest margins that can be had; [`LinearError::Unbounded`] if no crossover
    /// is wished and none is too high, with one that will do.
    pub fn pid(&self, wish: PidWish) -> Result<Pid, LinearError> {
        self.pid_for_all(&[], wish)
    }

    /// The controller of [`pid`](Self::pid) that keeps the margins, and the loop stable, with every other system, too. The crossover is
    /// that of this one; what has a gain below 1 everywhere has any phase margin.
    ///
    /// # Errors
    /// As [`pid`](Self::pid), the nearest margins being those that can be had with every system.
    pub fn pid_for_all(&self, others: &[Self], wish: PidWish) -> Result<Pid, LinearError> {
        let least_rad = wish.phase_margin_rad;
        let negative = || {
            let others: Vec<Self> = others.iter().map(|other| other.scaled(-1.0)).collect();
            let search = Search { plant: &self.scaled(-1.0), others: &others, least_rad, wish };
            search.found().ok().map(Pid::negative)
        };
        Search { plant: self, others, least_rad, wish }.found().or_else(|why| match why {
            LinearError::Unbounded { .. } => Err(why),
            why => negative().ok_or(why),
        })
    }
}

/// A system and what is wished of its controller.
#[derive(Clone, Copy)]
struct Search<'a> {
    plant: &'a TransferFunction,
    /// Systems that it has to do for as well.
    others: &'a [TransferFunction],
    /// Phase margin with each of those, rad: what was wished, while wider ones are tried with the first.
    least_rad: f64,
    wish: PidWish,
}

impl Search<'_> {
    fn found(&self) -> Result<Pid, LinearError> {
        let PidWish { phase_margin_rad, modulus, filter, .. } = self.wish;
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
        let Some(w) = self.wish.crossover_rad_s else { return self.best() };
        let w = positive("the crossover, rad/s,", w)?;
        let nyquist = self.plant.time().nyquist_rad_s();
        if w >= nyquist {
            let below = format!(" and less than {} rad/s, half the sampling frequency", four_digits(nyquist));
            return Err(LinearError::Range { name: "the crossover, rad/s,", value: w, below });
        }
        self.largest_at(w).ok_or_else(|| {
            let what = format!("a crossover of {} rad/s, ", four_digits(w));
            self.nearest_margins(&what, |search| search.largest_at(w).is_some())
        })
    }

    /// What is to be large.
    fn score(&self, pid: &Pid) -> f64 {
        match self.wish.terms {
            Terms::P | Terms::Pd => pid.kp,
            Terms::Pi | Terms::Pid => pid.ki,
        }
    }

    fn score_of(&self, pid: Option<&Pid>) -> f64 {
        pid.map_or(f64::NEG_INFINITY, |pid| self.score(pid))
    }

    fn better(&self, one: Option<Pid>, other: Option<Pid>) -> Option<Pid> {
        if self.score_of(other.as_ref()) > self.score_of(one.as_ref()) { other } else { one }
    }

    /// With that phase margin more.
    fn wider(&self, rad: f64) -> Option<Self> {
        let phase_margin_rad = self.wish.phase_margin_rad + rad;
        (phase_margin_rad < PI).then_some(Self { wish: PidWish { phase_margin_rad, ..self.wish }, ..*self })
    }

    fn at_margin(&self, w: f64, more_rad: f64) -> Option<Pid> {
        self.wider(more_rad)?.pid_at(w)
    }

    /// At that crossover the best of all phase margins that are wide enough: by steps, then between the neighbours of the best.
    fn largest_at(&self, w: f64) -> Option<Pid> {
        if self.wish.terms == Terms::P {
            return self.pid_at(w);
        }
        let steps = (0..=WIDER_STEPS).map(|k| WIDER_RAD * f64::from(k));
        let all: Vec<(f64, Option<Pid>)> = steps.map(|more| (more, self.at_margin(w, more))).collect();
        let (more, found) = all.into_iter().fold((0.0, None), |best: (f64, Option<Pid>), (more, pid)| {
            if self.score_of(pid.as_ref()) > self.score_of(best.1.as_ref()) { (more, pid) } else { best }
        });
        let found = found?;
        let (from, to) = ((more - WIDER_RAD).max(0.0), more + WIDER_RAD);
        self.better(Some(found), self.golden((from, to), |more| self.at_margin(w, more)))
    }

    /// The best between two places, by golden section.
    fn golden(&self, range: (f64, f64), pid: impl Fn(f64) -> Option<Pid>) -> Option<Pid> {
        const SECTIONS: usize = 20;
        let mut best = None;
        let cost = |at: f64| {
            let found = pid(at);
            best = self.better(best, found);
            -self.score_of(found.as_ref())
        };
        lowest(cost, range, SECTIONS);
        best
    }

    /// Why there is none, with the largest share of both margins that there is.
    fn nearest_margins(&self, what: &str, has: impl Fn(&Self) -> bool) -> LinearError {
        /// Halvings of the range of shares.
        const HALVINGS: usize = 6;
        let less = |share: f64| PidWish {
            phase_margin_rad: share * self.wish.phase_margin_rad,
            modulus: share * self.wish.modulus,
            ..self.wish
        };
        let (mut good, mut bad) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (good + bad);
            let (least_rad, wish) = (middle * self.least_rad, less(middle));
            if has(&Self { least_rad, wish, ..*self }) { good = middle } else { bad = middle }
        }
        let terms = self.wish.terms;
        let asked = format!(
            "no {terms} gives {what}{:.1}° of phase margin and a modulus margin of {}{}",
            self.wish.phase_margin_rad.to_degrees(),
            four_digits(self.wish.modulus),
            if self.others.is_empty() { "" } else { " with every system" }
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
            let remedy = match (what.is_empty(), terms) {
                (false, _) => "ask for another crossover",
                (true, Terms::P) => "try a PD or a PID",
                (true, Terms::Pi | Terms::Pd) => "try a PID",
                (true, Terms::Pid) => "no PID will do",
            };
            format!("{asked}, nor a hundredth of these: {remedy}")
        })
    }

    fn crossovers(&self, count: usize) -> Vec<f64> {
        let (low, high) = self.plant.band();
        // of samples the gain at half the sampling frequency is no crossing
        crate::logspace((low, high.min(0.999 * self.plant.time().nyquist_rad_s())), count)
    }

    /// Of all crossovers and phase margins the best.
    fn best(&self) -> Result<Pid, LinearError> {
        const FEW: usize = 24;
        let crossovers = self.crossovers(CROSSOVERS);
        let margins = || (0..=WIDER_STEPS).map(|k| WIDER_RAD * f64::from(k));
        let coarse = |w: f64| {
            let all = margins().filter_map(|more| self.at_margin(w, more));
            all.max_by(|a, b| self.score(a).total_cmp(&self.score(b)))
        };
        let all: Vec<Option<Pid>> = crossovers.iter().map(|&w| coarse(w)).collect();
        let score = |i: usize| self.score_of(all[i].as_ref());
        let best = (0..CROSSOVERS).max_by(|&a, &b| score(a).total_cmp(&score(b)));
        let Some((best, found)) = best.and_then(|i| all[i].map(|pid| (i, pid))) else {
            if let Some(quiet) = self.quiet() {
                return Ok(quiet);
            }
            let has =
                |search: &Search<'_>| search.crossovers(FEW).iter().any(|&w| search.largest_at(w).is_some());
            return Err(self.nearest_margins("", has));
        };
        if best + 1 == CROSSOVERS && self.plant.time() == Time::Continuous {
            let likely = self.plant.likely_crossover();
            let near = |i: &usize| ln(crossovers[*i] / likely).abs();
            let offer =
                (0..CROSSOVERS).filter(|&i| all[i].is_some()).min_by(|a, b| near(a).total_cmp(&near(b)));
            let offer_rad_s = match self.largest_at(likely) {
                Some(_) => likely,
                None => offer.map_or(likely, |i| crossovers[i]),
            };
            return Err(LinearError::Unbounded { to_rad_s: crossovers[best], offer_rad_s });
        }
        let range = (ln(crossovers[best.saturating_sub(1)]), ln(crossovers[(best + 1).min(CROSSOVERS - 1)]));
        Ok(self.better(Some(found), self.golden(range, |at| self.largest_at(exp(at)))).unwrap_or(found))
    }

    /// The best without an integral whose loop has a gain below 1 at every frequency: it has no crossover, and any phase margin.
    fn quiet(&self) -> Option<Pid> {
        const RATIOS: usize = 40;
        let of_ratio = |kd_over_kp_s: f64| {
            let none =
                Pid { kp: 1.0, ki: 0.0, kd: kd_over_kp_s, filter_rad_s: self.wish.filter / kd_over_kp_s };
            self.largest_quiet(&none)
        };
        let alone = Pid { kp: 1.0, ki: 0.0, kd: 0.0, filter_rad_s: 1.0 };
        match self.wish.terms {
            Terms::Pi | Terms::Pid => None,
            Terms::P => self.largest_quiet(&alone),
            Terms::Pd => {
                let times = self.crossovers(RATIOS).into_iter().map(|w| of_ratio(1.0 / w));
                times.fold(self.largest_quiet(&alone), |best, pid| self.better(best, pid))
            }
        }
    }

    /// The largest multiple of a controller, of gain 1, whose loop has a gain below 1 at every frequency and keeps its distance.
    fn largest_quiet(&self, unit: &Pid) -> Option<Pid> {
        const HALVINGS: usize = 50;
        let open = self.plant.series(&unit.transfer_in(self.plant.time()).ok()?).ok()?;
        let peak = open.peak().filter(|peak| peak.gain.is_finite() && peak.gain > 0.0)?;
        let times = |factor: f64| Pid { kp: factor, kd: factor * unit.kd, ..*unit };
        let is_calm = |factor: f64| {
            let loops = open.scaled(factor);
            let far = loops.margins().modulus.is_some_and(|m| m.distance >= self.wish.modulus);
            far && loops.closes_stable() && self.is_calm_with_others(&times(factor))
        };
        let (mut good, mut bad) = (0.0, 1.0 / peak.gain);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (good + bad);
            if is_calm(middle) { good = middle } else { bad = middle }
        }
        (good > 0.0).then(|| times(good))
    }

    /// With that crossover and phase margin, and the most integral that leaves the modulus margin.
    fn pid_at(&self, w: f64) -> Option<Pid> {
        /// Shares of the controller's size at the crossover that the integral has: a step of 8 %.
        const STEPS: i32 = 100;
        let calm = |pid: Option<Pid>| pid.filter(|pid| self.is_calm(pid));
        if self.wish.terms != Terms::Pid {
            return calm(self.two_terms(w));
        }
        let share = |k: i32| if k == STEPS { 0.0 } else { 5.0 * powi(0.92, k) };
        let ok = |share: f64| calm(self.pid_with(w, share));
        let first = (0..=STEPS).find(|&k| ok(share(k)).is_some())?;
        let (mut good, mut bad) = (share(first), share((first - 1).max(0)));
        for _ in 0..if first == 0 { 0 } else { 20 } {
            let middle = 0.5 * (good + bad);
            if ok(middle).is_some() { good = middle } else { bad = middle }
        }
        ok(good)
    }

    /// What the controller's value at the crossover has to be.
    fn value(&self, w: f64) -> Complex {
        -complex::from_polar(1.0, self.wish.phase_margin_rad)
            / self.plant.at(self.plant.time().at_frequency(w))
    }

    /// The frequency at which a controller in continuous time is what it is at `w` once it is sampled by Tustin's rule; where its derivative
    /// ends; and what s / (1 + s/f) is there.
    fn derivative(&self, w: f64) -> (f64, f64, Complex) {
        let (at, most) = match self.plant.time() {
            Time::Continuous => (w, f64::INFINITY),
            Time::Sampled(period_s) => (2.0 / period_s * tan(0.5 * w * period_s), 2.0 / period_s),
        };
        let f = (self.wish.filter * w).min(most);
        (at, f, Complex::new(at, f) * (at * f / (at * at + f * f)))
    }

    /// Two terms have just one way to have that value, one term has the size alone.
    fn two_terms(&self, w: f64) -> Option<Pid> {
        let value = self.value(w);
        let (at, f, of_derivative) = self.derivative(w);
        let none = Pid { kp: 0.0, ki: 0.0, kd: 0.0, filter_rad_s: f };
        let pid = match self.wish.terms {
            Terms::P => Pid { kp: complex::norm(value), ..none },
            Terms::Pi => Pid { kp: value.re, ki: -value.im * at, ..none },
            Terms::Pd | Terms::Pid => {
                let kd = value.im / of_derivative.im;
                Pid { kp: value.re - kd * of_derivative.re, kd, ..none }
            }
        };
        self.makes_sense(pid, value)
    }

    /// The controller's value at the crossover is given: with that share of it as the integral the two other gains follow.
    fn pid_with(&self, w: f64, share: f64) -> Option<Pid> {
        let value = self.value(w);
        let (at, f, of_derivative) = self.derivative(w);
        let ki = share * at * complex::norm(value);
        let kd = (value.im + ki / at) / of_derivative.im;
        self.makes_sense(Pid { kp: value.re - kd * of_derivative.re, ki, kd, filter_rad_s: f }, value)
    }

    fn makes_sense(&self, pid: Pid, value: Complex) -> Option<Pid> {
        let Pid { kp, ki, kd, filter_rad_s: f } = pid;
        let size = complex::norm(value);
        // less than rounding is none
        let rounded = |gain: f64, unit: f64| if gain.abs() * unit < 1e-12 * size { 0.0 } else { gain };
        let (kp, ki, kd) = (rounded(kp, 1.0), rounded(ki, 1.0 / f), rounded(kd, f));
        // zeros that swing would leave poles that do
        let is_calm = self.wish.any_zeros || powi(kp * f + ki, 2) >= 4.0 * ki * f * (kp + kd * f);
        let is_positive = kp >= 0.0 && ki >= 0.0 && kd >= 0.0 && size > 0.0;
        (is_calm && is_positive && (kp + ki + kd).is_finite()).then_some(Pid { kp, ki, kd, filter_rad_s: f })
    }

    /// Whether the loop is stable, keeps its distance from −1, and the phase margin is not less anywhere else.
    fn is_calm(&self, pid: &Pid) -> bool {
        let open = pid.transfer_in(self.plant.time()).and_then(|k| self.plant.series(&k));
        let Ok(open) = open else { return false };
        let margins = open.margins();
        let far = margins.modulus.is_some_and(|m| m.distance >= self.wish.modulus);
        let least_rad = self.wish.phase_margin_rad - 1e-6;
        let late = margins.least_phase().is_some_and(|m| m.phase_rad.abs() >= least_rad);
        far && late && open.closes_stable() && self.is_calm_with_others(pid)
    }

    /// Whether the same holds with every other system; one whose gain is below 1 everywhere is never late.
    fn is_calm_with_others(&self, pid: &Pid) -> bool {
        let least_rad = self.least_rad - 1e-6;
        self.others.iter().all(|other| {
            let Ok(open) = pid.transfer_in(other.time()).and_then(|k| other.series(&k)) else { return false };
            let margins = open.margins();
            let far = margins.modulus.is_some_and(|m| m.distance >= self.wish.modulus);
            let late = margins.least_phase().is_none_or(|m| m.phase_rad.abs() >= least_rad);
            far && late && open.closes_stable()
        })
    }
}

impl TransferFunction {
    /// A crossover for a system that does not bound it: where its own gain last is 1, three times its bandwidth where that is nowhere,
    /// else the middle of what matters, rad/s.
    fn likely_crossover(&self) -> f64 {
        let (low, high) = self.band();
        let own = self.gain_crossings().last().copied();
        own.or_else(|| self.bandwidth().map(|w| 3.0 * w)).unwrap_or_else(|| (low * high).sqrt())
    }
}
