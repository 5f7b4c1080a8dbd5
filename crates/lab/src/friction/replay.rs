//! Speeds that a found friction and inertia make of the volts alone, beside those that were seen.

use tracelight_maths::{exp, sin_cos};

use super::{Believed, Curves, Sample, Side, Trial};

/// Time over which speeds are compared, s.
const OVER_S: f64 = 0.1;

/// Share of the speeds' variance about their mean that the equation of motion makes of the volts alone, over all trials in which the
/// joint turned: nothing is known of a trial but its volts and the speed at its start. `None` where nothing turned, or something
/// that is needed was not found.
pub fn replayed(trials: &[Trial], believed: &Believed, found: &Curves) -> Option<f64> {
    let motion = Motion::of(believed, found)?;
    let (mut pairs, least) = (Vec::new(), 2.0 * believed.step_rad / OVER_S);
    for trial in trials.iter().filter(|trial| trial.samples.len() > 4) {
        let seen = trial.speeds(believed.count_rad, OVER_S);
        if seen.iter().all(|(_, rate)| rate.abs() <= least) {
            continue;
        }
        let made = motion.like(trial, &seen);
        pairs.extend(seen.iter().zip(&made).map(|(seen, made)| (seen.1, made.1)));
    }
    let mean = pairs.iter().map(|(seen, _)| seen).sum::<f64>() / pairs.len().max(1) as f64;
    let (left, total) = pairs.iter().fold((0.0, 0.0), |(left, total), (seen, made)| {
        (left + (seen - made) * (seen - made), total + (seen - mean) * (seen - mean))
    });
    (total > 0.0).then(|| 1.0 - left / total)
}

/// The equation of motion, in numbers.
struct Motion<'a> {
    believed: &'a Believed,
    found: &'a Curves,
    inertia: f64,
    /// Viscous and Coulomb friction forwards and backwards; what nothing was told of is like the other.
    sides: [(f64, f64); 2],
}

impl<'a> Motion<'a> {
    fn of(believed: &'a Believed, found: &'a Curves) -> Option<Self> {
        let known = (!believed.another).then_some(believed.inertia_kg_m2);
        let inertia = found.inertia_kg_m2.map(|inertia| inertia.value).or(known)?;
        let numbers = |side: Side| (side.viscous.value, side.coulomb_nm.value);
        let (pos, neg) = (found.pos.map(numbers), found.neg.map(numbers));
        let mirrored = |side: Option<(f64, f64)>| side.map(|(viscous, coulomb)| (viscous, -coulomb));
        let sides = [pos.or(mirrored(neg))?, neg.or(mirrored(pos))?];
        (inertia > 0.0).then_some(Self { believed, found, inertia, sides })
    }

    /// Speeds of a trial made again, its first speed the one with which they fit best.
    fn like(&self, trial: &Trial, seen: &[(f64, f64)]) -> Vec<(f64, f64)> {
        /// What is started with otherwise to see what the start does, as a share.
        const OTHERWISE: f64 = 0.01;
        let first = seen.first().map_or(0.0, |(_, rate)| *rate);
        let other = first + OTHERWISE * seen.iter().map(|(_, rate)| rate.abs()).fold(0.0, f64::max);
        let (one, two) = (self.run(trial, first), self.run(trial, other));
        let (mut along, mut square) = (0.0, 0.0);
        for ((seen, one), two) in seen.iter().zip(&one).zip(&two) {
            along += (two.1 - one.1) * (seen.1 - one.1);
            square += (two.1 - one.1) * (two.1 - one.1);
        }
        let share = if square > 0.0 { along / square } else { 0.0 };
        let start = first + share * (other - first);
        // a start on the other side of rest is none that was seen
        if start * first < 0.0 { one } else { self.run(trial, start) }
    }

    /// A trial made again from a speed, and the speeds of it.
    fn run(&self, trial: &Trial, start_rad_s: f64) -> Vec<(f64, f64)> {
        let count_rad = self.believed.count_rad;
        let mut rate = start_rad_s;
        let mut samples = trial.samples.clone();
        for k in 1..samples.len() {
            let before: Sample = samples[k - 1];
            let (way, next) = self.step(&before, rate, samples[k].time_s - before.time_s);
            samples[k].count = before.count + way / count_rad;
            rate = next;
        }
        Trial { joint: trial.joint, samples }.speeds(count_rad, OVER_S)
    }

    /// Way and speed after a time under one voltage: exact while the speed keeps its sign.
    fn step(&self, from: &Sample, rate: f64, time_s: f64) -> (f64, f64) {
        let angle = from.count * self.believed.count_rad;
        let drive = self.believed.torque_nm(from.volts) - self.weight(angle);
        let [pos, neg] = self.sides;
        let (viscous, coulomb) = match rate {
            r if r > 0.0 || (r == 0.0 && drive > pos.1) => pos,
            r if r < 0.0 || drive < neg.1 => neg,
            _ => return (0.0, 0.0),
        };
        let torque = drive - coulomb;
        let decay = viscous / self.inertia;
        let x = -decay * time_s;
        // (e^x − 1)/x, which is 1 for a small x
        let mean = if x.abs() < 1e-6 { 1.0 + 0.5 * x } else { (exp(x) - 1.0) / x };
        let next = rate + mean * time_s * (torque / self.inertia - decay * rate);
        if rate != 0.0 && next * rate <= 0.0 {
            // it comes to rest within the step
            return (0.25 * rate * time_s, 0.0);
        }
        (0.5 * (rate + next) * time_s, next)
    }

    /// What weight and cables take of the motor's torque, N m.
    fn weight(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let gravity =
            self.found.gravity_nm.map_or(0.0, |[level, upright]| level.value * cos + upright.value * sin);
        self.found.spring_nm_per_rad.map_or(0.0, |spring| spring.value * angle_rad) - gravity
    }
}
