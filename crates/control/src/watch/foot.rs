//! Detects motion of the head's base with a gyroscope fixed to it.

use tracelight_rig::{Fault, Joint, PanTilt, TICK_S};

use crate::finding::Finding;

/// Limits and model of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Rate that counts as a bump, rad/s.
    pub jolt_rad_s: f32,
    /// Largest turn after which the foot counts as undisplaced, rad.
    pub turned_rad: f32,
    /// Sway of the base under the head's own motion; `None` if the base is rigid.
    pub sway: Option<Sway>,
}

/// Oscillation of a base that yields when the joints accelerate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sway {
    /// Inertia of what a joint carries, of that of foot and head together.
    pub carried_share: PanTilt<f32>,
    /// How fast it swings, rad/s.
    pub rate_rad_s: f32,
    /// How that is damped, as a share of critical damping.
    pub damping: f32,
}

/// Ticks over which a gyroscope's reading at rest is first found: 2 mrad/s of noise leave 0.1 mrad/s.
const BIAS_TICKS: u32 = 300;
/// Ticks of them after which a reading that differs from their mean as a jolt does is one.
const FIRST_TICKS: u32 = 20;
/// Most that it may be: what is more is motion.
const MOST_BIAS_RAD_S: f32 = 0.06;
/// Ticks over which it is followed, in the end: parts grow warm.
const FOLLOWED_TICKS: u32 = 5000;
/// How far off it may be at first, rad/s, where the head's own motion sways the foot meanwhile.
const UNSURE_BIAS_RAD_S: f32 = 3e-4;
/// Time constant with which a turn is forgotten while nothing bumps, s: what is slower is bias.
const TURN_S: f32 = 1.0;
/// Time constant of the test for standstill of the foot, s.
const QUIET_S: f32 = 0.01;
/// Largest rate at standstill, as a share of the rate of a jolt.
const QUIET_SHARE: f32 = 0.2;
/// Ticks of standstill required.
const QUIET_TICKS: u32 = 200;
/// Error allowed in the predicted sway, as a share of its recent peak.
const SWAY_SHARE: f32 = 0.5;
/// Time over which that peak is remembered, s.
const SWAY_S: f32 = 0.5;

/// Watch on the foot. It learns what the gyroscope reads at rest, slowly, and nothing else.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FootWatch {
    /// There is a gyroscope.
    fitted: bool,
    bias_rad_s: [f32; 3],
    /// Ticks that have gone into it.
    bias_ticks: u32,
    /// Ticks since the beginning, until it is known.
    first_ticks: u32,
    /// Somebody bumped meanwhile.
    early: bool,
    smooth_rad_s: [f32; 3],
    turned_rad: [f32; 3],
    swings: PanTilt<Swing>,
    jolted: bool,
    quiet_ticks: u32,
}

/// How the foot should swing by the head's own motion.
#[derive(Clone, Copy, Debug, Default)]
struct Swing {
    angle_rad: f32,
    rate_rad_s: f32,
    /// Furthest and fastest of late.
    furthest_rad: f32,
    fastest_rad_s: f32,
}

impl FootWatch {
    /// How far the foot has turned since it last stood still, rad about the head's x, y and z, and a little of what was before; `None` without a gyroscope.
    pub(super) fn turned_rad(&self) -> Option<[f32; 3]> {
        self.fitted.then_some(self.turned_rad)
    }

    pub(super) const fn is_fitted(&self) -> bool {
        self.fitted
    }

    /// Whether there is no gyroscope, or one by which the foot stands.
    pub(super) const fn is_steady(&self) -> bool {
        !self.fitted || (self.bias_ticks >= BIAS_TICKS && !self.jolted)
    }

    /// From now on it stands where it stands: the head was found anew, or whoever looks at it says so.
    pub(super) const fn rearm(&mut self) {
        self.turned_rad = [0.0; 3];
    }

    /// One tick in which the joints were sped up so, rad/s². Once it is quiet again after it was bumped: whether it stands elsewhere.
    pub(super) fn tick(
        &mut self,
        foot: &Foot,
        read_rad_s: Option<[f32; 3]>,
        sped_up: PanTilt<f32>,
    ) -> Option<Finding> {
        let Some(read_rad_s) = read_rad_s else {
            // one that says nothing any more has not said that all is well
            (self.jolted, self.quiet_ticks) = (self.fitted, 0);
            return None;
        };
        self.fitted = true;
        if !read_rad_s.iter().all(|rate| rate.is_finite()) {
            return Some(Finding::of(Fault::NotANumber));
        }
        let swings = self.swing(foot, sped_up);
        let mut rate_rad_s = [0.0; 3];
        for (axis, rate) in rate_rad_s.iter_mut().enumerate() {
            *rate = read_rad_s[axis] - swings[axis] - self.bias_rad_s[axis];
        }
        if self.bias_ticks < BIAS_TICKS {
            self.find_bias(foot, rate_rad_s);
            return None;
        }
        self.watch(foot, rate_rad_s)
    }

    /// Rates are those beside what is taken for its reading at rest so far.
    fn find_bias(&mut self, foot: &Foot, rate_rad_s: [f32; 3]) {
        let jolts = self.bias_ticks >= FIRST_TICKS && largest(&rate_rad_s) > foot.jolt_rad_s;
        self.early |= jolts;
        (self.first_ticks, self.bias_ticks) = (self.first_ticks.saturating_add(1), self.bias_ticks + 1);
        let share = 1.0 / self.bias_ticks as f32;
        for (axis, rate) in rate_rad_s.into_iter().enumerate() {
            self.turned_rad[axis] += TICK_S * (rate + self.bias_rad_s[axis]);
            self.bias_rad_s[axis] += share * rate;
        }
        if jolts || largest(&self.bias_rad_s) > MOST_BIAS_RAD_S {
            (self.bias_rad_s, self.bias_ticks) = ([0.0; 3], 0);
        }
        if self.bias_ticks == BIAS_TICKS {
            // what it was bumped by until now is known only now
            let time_s = TICK_S * self.first_ticks as f32;
            for (axis, bias) in self.bias_rad_s.into_iter().enumerate() {
                let turned = self.turned_rad[axis] - time_s * bias;
                self.turned_rad[axis] = if self.early { turned } else { 0.0 };
            }
            self.jolted = self.early;
        }
    }

    fn watch(&mut self, foot: &Foot, rate_rad_s: [f32; 3]) -> Option<Finding> {
        let unsure = |of: fn(&Swing) -> f32| SWAY_SHARE * of(&self.swings.pan).max(of(&self.swings.tilt));
        let most_rad_s = foot.jolt_rad_s + unsure(|swing| swing.fastest_rad_s);
        let bias_s = TURN_S * BIAS_TICKS as f32 / self.bias_ticks as f32;
        let most_rad = foot.turned_rad + unsure(|swing| swing.furthest_rad) + bias_s * UNSURE_BIAS_RAD_S;
        if !self.jolted {
            self.bias_ticks = (self.bias_ticks + 1).min(FOLLOWED_TICKS);
        }
        for (axis, rate) in rate_rad_s.into_iter().enumerate() {
            self.smooth_rad_s[axis] += TICK_S / QUIET_S * (rate - self.smooth_rad_s[axis]);
            self.turned_rad[axis] += TICK_S * rate;
            if !self.jolted {
                self.bias_rad_s[axis] += rate / self.bias_ticks as f32;
                self.turned_rad[axis] -= TICK_S / TURN_S * self.turned_rad[axis];
            }
        }
        let turns = largest(&rate_rad_s) > most_rad_s;
        let turned_rad = largest(&self.turned_rad);
        let turned = turned_rad > most_rad;
        self.jolted |= turns || turned;
        if !self.jolted {
            return None;
        }
        let quiet = !turns && largest(&self.smooth_rad_s) < QUIET_SHARE * most_rad_s;
        self.quiet_ticks = if quiet { self.quiet_ticks + 1 } else { 0 };
        if self.quiet_ticks < QUIET_TICKS {
            return None;
        }
        (self.jolted, self.quiet_ticks) = (false, 0);
        turned.then(|| Finding::beyond(Fault::Bumped, turned_rad, most_rad))
    }

    /// How fast the head's own motion should turn the foot now, rad/s about x, y and z.
    fn swing(&mut self, foot: &Foot, sped_up: PanTilt<f32>) -> [f32; 3] {
        let Some(sway) = &foot.sway else { return [0.0; 3] };
        for j in Joint::BOTH {
            self.swings[j].tick(sway, sway.carried_share[j] * sped_up[j]);
        }
        [0.0, self.swings.tilt.rate_rad_s, self.swings.pan.rate_rad_s]
    }
}

impl Swing {
    fn tick(&mut self, sway: &Sway, thrown_rad_s2: f32) {
        const FADES: f32 = 1.0 - TICK_S / SWAY_S;
        let (rate, damping) = (sway.rate_rad_s, sway.damping);
        let back = rate * rate * self.angle_rad + 2.0 * damping * rate * self.rate_rad_s;
        self.rate_rad_s -= TICK_S * (thrown_rad_s2 + back);
        self.angle_rad += TICK_S * self.rate_rad_s;
        self.furthest_rad = self.angle_rad.abs().max(FADES * self.furthest_rad);
        self.fastest_rad_s = self.rate_rad_s.abs().max(FADES * self.fastest_rad_s);
    }
}

fn largest(axes: &[f32; 3]) -> f32 {
    axes.iter().fold(0.0, |most, axis| most.max(axis.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOOT: Foot = Foot { jolt_rad_s: 0.035, turned_rad: 3e-4, sway: None };
    const STILL: PanTilt<f32> = PanTilt::new(0.0, 0.0);
    const BIAS: [f32; 3] = [0.004, -0.003, 0.002];

    fn read(watch: &mut FootWatch, rate: f32, ticks: u32) -> Option<Finding> {
        let read = [BIAS[0], BIAS[1], BIAS[2] + rate];
        (0..ticks).fold(None, |fault, _| fault.or(watch.tick(&FOOT, Some(read), STILL)))
    }

    fn known() -> FootWatch {
        let mut watch = FootWatch::default();
        assert_eq!(read(&mut watch, 0.0, BIAS_TICKS), None);
        watch
    }

    #[test]
    fn a_foot_without_a_gyroscope_is_taken_for_steady_and_one_whose_gyroscope_is_gone_is_not() {
        let mut none = FootWatch::default();
        none.tick(&FOOT, None, STILL);
        assert!(none.is_steady() && !none.is_fitted() && none.turned_rad().is_none());
        let mut gone = known();
        gone.tick(&FOOT, None, STILL);
        assert!(!gone.is_steady());
        assert_eq!(
            known().tick(&FOOT, Some([f32::NAN, 0.0, 0.0]), STILL),
            Some(Finding::of(Fault::NotANumber))
        );
    }

    #[test]
    fn there_is_no_light_before_it_is_known_what_it_reads_at_rest() {
        let mut watch = FootWatch::default();
        read(&mut watch, 0.0, BIAS_TICKS - 1);
        assert!(!watch.is_steady());
        read(&mut watch, 0.0, 1);
        assert!(watch.is_steady());
        let mut moved = FootWatch::default();
        read(&mut moved, 0.1, 2 * BIAS_TICKS);
        assert!(!moved.is_steady(), "that is no bias");
        let mut early = FootWatch::default();
        read(&mut early, 0.0, 100);
        read(&mut early, 0.1, 30);
        assert_eq!(read(&mut early, 0.0, BIAS_TICKS - 1), None);
        assert!(!early.is_steady());
        assert_eq!(read(&mut early, 0.0, 2 * QUIET_TICKS).map(|found| found.fault), Some(Fault::Bumped));
    }

    #[test]
    fn what_turns_and_stays_so_is_a_fault_and_what_comes_back_is_waited_for() {
        let mut bumped = known();
        read(&mut bumped, 0.2, 1);
        assert!(!bumped.is_steady(), "in the tick");
        read(&mut bumped, 0.2, 19);
        assert_eq!(read(&mut bumped, 0.0, 2 * QUIET_TICKS).map(|found| found.fault), Some(Fault::Bumped));
        let mut came_back = known();
        read(&mut came_back, 0.2, 20);
        read(&mut came_back, -0.2, 20);
        assert!(!came_back.is_steady());
        assert_eq!(read(&mut came_back, 0.0, 2 * QUIET_TICKS), None);
        assert!(came_back.is_steady());
    }

    #[test]
    fn a_slow_turn_is_one_too_and_a_bias_that_drifts_is_none() {
        let mut sinks = known();
        read(&mut sinks, 0.0, FOLLOWED_TICKS);
        assert_eq!(read(&mut sinks, 0.002, 500).map(|found| found.fault), Some(Fault::Bumped));
        let mut warms = known();
        for k in 0..60_000_u16 {
            assert_eq!(read(&mut warms, 1e-8 * f32::from(k), 1), None);
        }
        assert!(warms.is_steady());
    }

    #[test]
    fn the_heads_own_motion_is_no_jolt() {
        let sway = Sway { carried_share: PanTilt::new(0.03, 0.02), rate_rad_s: 50.0, damping: 0.05 };
        let foot = Foot { sway: Some(sway), ..FOOT };
        // as the plant's foot does, with another tenth of inertia
        let mut truth = Swing::default();
        let mut watch = known();
        let mut fastest = 0.0f32;
        for k in 0..4000 {
            let sped_up = if (k / 100) % 2 == 0 { 100.0 } else { -100.0 };
            truth.tick(&Sway { rate_rad_s: 47.0, ..sway }, 0.9 * sway.carried_share.pan * sped_up);
            fastest = fastest.max(truth.rate_rad_s.abs());
            let read = [BIAS[0], BIAS[1], BIAS[2] + truth.rate_rad_s];
            assert_eq!(watch.tick(&foot, Some(read), PanTilt::new(sped_up, 0.0)), None);
            assert!(watch.is_steady(), "tick {k}");
        }
        assert!(fastest > 2.0 * FOOT.jolt_rad_s, "{fastest}");
    }
}
