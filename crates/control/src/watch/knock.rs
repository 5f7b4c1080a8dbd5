//! Detects bumps of the head's base from the encoders.

use tracelight_rig::{Measurement, TICK_S};

use super::scale_filter::Surprise;
use crate::axis::AxisConfig;
use crate::elementary::root;
use crate::estimate::{Effort, Estimate};
use crate::limit::within;

/// Ticks that are remembered.
const KEPT: usize = 128;
/// Ticks from a surprise to the verdict on it.
const VERDICT_TICKS: u32 = 65;
/// Window before the surprise that serves as the reference, ticks.
const BEFORE: (i32, i32) = (-60, -20);
/// Window after the surprise that is compared with it, when a bump is over, ticks.
const AFTER: (i32, i32) = (30, 65);
/// Time at which the positions are compared, in the middle of a bump, ticks after the surprise.
const BUMPED_AT: f32 = 8.0;
/// Time at which the speeds are compared, after the bump, ticks after the surprise.
const OVER_AT: f32 = 47.5;
/// Surprise from which a throw is considered, deviations.
const SURPRISE: f32 = 4.0;
/// Smallest throw of a joint, counts: more than a single lost or spurious count.
const LEAST_COUNTS: f32 = 1.25;
/// Largest change of speed in a throw, over 30 ms and as a share of the throw. A push at the joint itself leaves it with a different speed, or
/// still accelerates it.
const MOST_FASTER: f32 = 0.75;
/// How long that takes, ticks.
const BUMP_TICKS: f32 = 30.0;
/// All of it fits what was computed to so much of that way.
const MOST_UNEXPLAINED: f32 = 0.3;
/// Ticks of calm before the next.
const CALM_TICKS: u32 = 100;
/// Speed over which friction is taken to turn round, rad/s.
const FADE_RAD_S: f32 = 5e-3;

/// Watch on one joint for a throw: whoever bumps into the foot speeds it up and stops it again, and the joint, which stays behind, stands or runs
/// beside by some counts afterwards, no faster than before. What pushes the joint itself changes its speed.
///
/// Only of lit strokes: how a joint speeds up between them is not known well enough of every head. Only the motor's torque and what the model has of gravity and friction are reckoned with; nothing is learned.
#[derive(Clone, Copy, Debug)]
pub(super) struct KnockWatch {
    /// Angle by the encoder as it is read, rad, and how the joint sped up in the tick before, as far as that is known, rad/s²; the oldest at `next`.
    kept: [(f32, f32); KEPT],
    next: usize,
    /// How many of them there are.
    filled: usize,
    /// Ticks since the surprise that is looked into.
    since: Option<u32>,
    inquiry: Inquiry,
    calm_ticks: u32,
}

impl KnockWatch {
    pub(super) const fn new() -> Self {
        Self {
            kept: [(0.0, 0.0); KEPT],
            next: 0,
            filled: 0,
            since: None,
            inquiry: Inquiry::NONE,
            calm_ticks: 0,
        }
    }

    /// One tick; whether it shows that the joint was thrown a moment ago, while it was lit.
    pub(super) fn tick(
        &mut self,
        axis: &AxisConfig,
        effort: &Effort,
        estimate: &Estimate,
        measured: &Measurement,
        (surprise, lit): (Surprise, bool),
    ) -> bool {
        self.keep(axis, effort, estimate, measured);
        let surprised = match surprise {
            Surprise::Edge(deviations) => deviations.abs() >= SURPRISE,
            Surprise::Count => true,
            Surprise::None | Surprise::Placed | Surprise::Creeping(_) => false,
        };
        let calm = self.calm_ticks >= CALM_TICKS;
        self.calm_ticks = if surprised { 0 } else { self.calm_ticks.saturating_add(1) };
        match self.since {
            None if surprised && calm && lit && self.filled == KEPT => {
                (self.since, self.inquiry) = (Some(0), Inquiry::NONE);
            }
            None => {}
            Some(ticks) => {
                let now = ticks + 1;
                self.look_back(now);
                self.since = (now < VERDICT_TICKS).then_some(now);
                return now >= VERDICT_TICKS && self.inquiry.is_thrown(axis);
            }
        }
        false
    }

    fn keep(&mut self, axis: &AxisConfig, effort: &Effort, estimate: &Estimate, measured: &Measurement) {
        let width = axis.count_rad;
        let centre = measured.count as f32 * width;
        // what was put back is no motion
        let believed = estimate.position_rad - estimate.lost_counts as f32 * width;
        let angle = centre + within(believed - centre, 0.5 * width);
        let driven_nm = effort.torque_nm - effort.bias_nm;
        let friction_nm = friction_nm(axis, estimate.velocity_rad_s, driven_nm);
        let sped_up = (driven_nm - friction_nm) / effort.inertia_kg_m2;
        if let Some(place) = self.kept.get_mut(self.next) {
            *place = (angle, sped_up);
        }
        self.next = (self.next + 1) % KEPT;
        self.filled = (self.filled + 1).min(KEPT);
    }

    /// Takes two more of the ticks that were kept about the surprise, so many ticks after it: no tick has them all to do, and at the verdict all are taken.
    fn look_back(&mut self, now: u32) {
        for _ in 0..2 {
            let tick = self.inquiry.next;
            let Some(back) = now.checked_add_signed(-tick) else { return };
            let back = back as usize;
            let kept = self.kept.get((self.next + KEPT - 1 - back.min(KEPT - 1)) % KEPT).copied();
            self.inquiry.take(kept.unwrap_or_default());
        }
    }
}

/// A joint's way about a surprise, as far as it was taken.
#[derive(Clone, Copy, Debug)]
struct Inquiry {
    /// The tick that is taken next, from the surprise.
    next: i32,
    /// Angle in the first.
    origin: f32,
    /// Speed and way that are known since then.
    speed: f32,
    way: f32,
    /// What lies beside that way, before the surprise and after it.
    before: Sums,
    after: Sums,
}

impl Inquiry {
    const NONE: Self =
        Self { next: BEFORE.0, origin: 0.0, speed: 0.0, way: 0.0, before: Sums::NONE, after: Sums::NONE };

    fn take(&mut self, (angle, sped_up): (f32, f32)) {
        let tick = self.next;
        if tick > AFTER.1 {
            return;
        }
        self.next += 1;
        if tick == BEFORE.0 {
            self.origin = angle;
        } else {
            self.way += TICK_S * (self.speed + 0.5 * TICK_S * sped_up);
            self.speed += TICK_S * sped_up;
        }
        let beside = angle - self.origin - self.way;
        if tick <= BEFORE.1 {
            self.before.add(tick as f32 - middle(BEFORE), beside);
        } else if tick >= AFTER.0 {
            self.after.add(tick as f32 - middle(AFTER), beside);
        }
    }

    /// Whether what is beside its way after the surprise is beside by some counts, and no faster.
    fn is_thrown(&self, axis: &AxisConfig) -> bool {
        let before = self.before.fit(middle(BEFORE), false);
        let after = self.after.fit(middle(AFTER), true);
        let counts = (after.at(BUMPED_AT) - before.at(BUMPED_AT)) / axis.count_rad;
        let faster = BUMP_TICKS * (after.slope_at(OVER_AT) - before.slope_at(OVER_AT)) / axis.count_rad;
        let unexplained = after.rms.max(before.rms) / axis.count_rad;
        counts.abs() > LEAST_COUNTS
            && faster.abs() < MOST_FASTER * counts.abs()
            && unexplained < MOST_UNEXPLAINED * counts.abs()
    }
}

fn middle((from, to): (i32, i32)) -> f32 {
    0.5 * (from + to) as f32
}

/// Friction of a joint that turns so and is driven by that torque, N m: what holds it, near standstill.
fn friction_nm(axis: &AxisConfig, rate_rad_s: f32, driven_nm: f32) -> f32 {
    let friction = &axis.friction;
    let held = driven_nm.min(friction.coulomb_pos_nm).max(friction.coulomb_neg_nm);
    let slides = (rate_rad_s.abs() / FADE_RAD_S).min(1.0);
    friction.feedforward(rate_rad_s, FADE_RAD_S) + (1.0 - slides) * held
}

/// Sums of a regression about the middle of its ticks, which lie evenly about it.
#[derive(Clone, Copy, Debug)]
struct Sums {
    n: f32,
    t2: f32,
    t4: f32,
    z: f32,
    tz: f32,
    t2z: f32,
    z2: f32,
}

impl Sums {
    const NONE: Self = Self { n: 0.0, t2: 0.0, t4: 0.0, z: 0.0, tz: 0.0, t2z: 0.0, z2: 0.0 };

    fn add(&mut self, t: f32, z: f32) {
        let t2 = t * t;
        self.n += 1.0;
        self.t2 += t2;
        self.t4 += t2 * t2;
        self.z += z;
        self.tz += t * z;
        self.t2z += t2 * z;
        self.z2 += z * z;
    }

    fn fit(&self, middle: f32, bent: bool) -> Fit {
        let (mean, spread) = (self.z / self.n, self.t2 / self.n);
        let slope = self.tz / self.t2;
        // the parabola that is orthogonal to line and mean
        let norm = self.t4 - self.n * spread * spread;
        let bend = if bent { (self.t2z - spread * self.z) / norm } else { 0.0 };
        let left = self.z2 - self.n * mean * mean - slope * self.tz - bend * bend * norm;
        Fit { middle, mean, slope, bend, spread, rms: root(left.max(0.0) / self.n) }
    }
}

/// A line or parabola over ticks from a surprise.
#[derive(Clone, Copy, Debug)]
struct Fit {
    middle: f32,
    mean: f32,
    slope: f32,
    bend: f32,
    spread: f32,
    /// What it leaves, rad.
    rms: f32,
}

impl Fit {
    fn at(&self, tick: f32) -> f32 {
        let t = tick - self.middle;
        self.mean + self.slope * t + self.bend * (t * t - self.spread)
    }

    /// Per tick.
    fn slope_at(&self, tick: f32) -> f32 {
        self.slope + 2.0 * self.bend * (tick - self.middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(of: impl Fn(f32) -> f32, bent: bool) -> Fit {
        let mut sums = Sums::NONE;
        (-10..=10).for_each(|t: i16| sums.add(f32::from(t), of(f32::from(t))));
        sums.fit(100.0, bent)
    }

    #[test]
    fn a_line_and_a_parabola_are_found_and_what_they_leave() {
        let line = fit(|t| 3.0 + 0.5 * t, false);
        assert!((line.at(120.0) - 13.0).abs() < 1e-4 && (line.slope_at(0.0) - 0.5).abs() < 1e-5);
        assert!(line.rms < 1e-3, "{}", line.rms);
        let parabola = fit(|t| 1.0 - t + 0.1 * t * t, true);
        assert!((parabola.at(120.0) - 21.0).abs() < 1e-3, "{}", parabola.at(120.0));
        assert!((parabola.slope_at(105.0) - 0.0).abs() < 1e-4 && parabola.rms < 2e-3, "{parabola:?}");
        assert!((fit(|t| if t as i32 % 2 == 0 { 1.0 } else { -1.0 }, false).rms - 1.0).abs() < 0.01);
    }
}
