use tracelight_rig::{Setpoint, TICK_S};

use crate::elementary::root;
use crate::estimate::Estimate;
use crate::limit::within;

/// Motion along a plan that is slower than stick–slip friction permits.
///
/// At such speeds friction falls with speed: a joint that is to creep is unstable by itself, and between two edges, a count
/// apart, nothing says that it stalled. One at rest is held by the same friction, whatever little is wrong. So it goes from rest
/// to rest, a fraction of a count at a time, by pulses beside which friction is small, and sees in between how far it is behind
/// (Yang & Tomizuka, *Adaptive pulse width control for precise positioning under the influence of stiction and Coulomb
/// friction*, ASME J. Dyn. Syst. Meas. Control 110, 1988).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Creep {
    /// Speed below which it hops, rad/s.
    pub below_rad_s: f32,
    /// A plan that gets faster than that within this time, s, only turns round, and is followed.
    pub turn_s: f32,
    /// Length of a hop where the plan is slow, rad.
    pub hop_rad: f32,
    /// Most acceleration of a hop, rad/s²; as much as it brakes.
    pub acceleration_rad_s2: f32,
}

/// What a joint that may creep does.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Pace {
    /// Follows its plan.
    #[default]
    Follow,
    /// Rests there, rad.
    Rest(f32),
    /// Hops.
    Hop(Hop),
}

impl Pace {
    /// Where the joint is to be now and half a tick later, given where its plan has it, and in so many ticks, rad.
    #[expect(
        clippy::inline_always,
        reason = "a hundred instructions of every tick: nothing of it need be put by"
    )]
    #[inline(always)]
    pub(crate) fn tick(
        &mut self,
        creep: &Creep,
        estimate: &Estimate,
        (now, ahead): (&Setpoint, &Setpoint),
        later_rad: impl Fn(f32) -> f32,
    ) -> (Setpoint, Setpoint) {
        *self = self.next(creep, estimate, now, later_rad);
        match self {
            Self::Follow => (*now, *ahead),
            Self::Rest(position_rad) => {
                let rest = Setpoint { position_rad: *position_rad, ..Setpoint::default() };
                (rest, rest)
            }
            Self::Hop(hop) => hop.tick(),
        }
    }

    #[expect(clippy::inline_always, reason = "as of what calls it")]
    #[inline(always)]
    fn next(
        self,
        creep: &Creep,
        estimate: &Estimate,
        now: &Setpoint,
        later_rad: impl Fn(f32) -> f32,
    ) -> Self {
        match self {
            Self::Follow if creep.begins(now) => Self::Rest(estimate.position_rad),
            Self::Rest(_) | Self::Hop(_) if creep.ends(now) => Self::Follow,
            Self::Rest(_) if creep.is_behind(estimate, now) => {
                Self::Hop(creep.hop(estimate, &as_planned(now, later_rad)))
            }
            Self::Hop(hop) if hop.is_over() => Self::Rest(hop.end_rad()),
            same => same,
        }
    }
}

impl Creep {
    /// What is this much faster is not slow any more.
    const FASTER: f32 = 1.25;
    /// A plan so slow that it takes longer than this for half a hop, s, is gone ahead of by as much as it goes in that time.
    const LEAD_S: f32 = 0.06;

    fn begins(&self, now: &Setpoint) -> bool {
        now.velocity_rad_s.abs() + self.turn_s * now.acceleration_rad_s2.abs() < self.below_rad_s
    }

    fn ends(&self, now: &Setpoint) -> bool {
        now.velocity_rad_s.abs() + 0.5 * self.turn_s * now.acceleration_rad_s2.abs()
            > Self::FASTER * self.below_rad_s
    }

    /// Whether the plan will be half a hop ahead of the joint amid the next one, or a whole one the other way.
    fn is_behind(&self, estimate: &Estimate, now: &Setpoint) -> bool {
        let half_s = root(self.hop_rad / self.acceleration_rad_s2);
        let lag = after(now, half_s).position_rad - estimate.position_rad;
        let forward = lag * now.velocity_rad_s > 0.0;
        lag.abs() >= if forward { 0.5 * self.hop_rad } else { self.hop_rad }
    }

    /// The shortest from where the joint is to half a hop ahead of where the plan then is, or as far towards it as a hop reaches.
    fn hop(&self, estimate: &Estimate, now: &Setpoint) -> Hop {
        const SHORTEST: u16 = 2;
        const LONGEST: u16 = 28;
        let half = 0.5 * self.hop_rad;
        let lead = within(Self::LEAD_S * now.velocity_rad_s, half);
        let mut half_ticks = SHORTEST;
        loop {
            let target = after(now, f32::from(2 * half_ticks) * TICK_S).position_rad + lead;
            let hop = Hop::new(estimate, target, half_ticks);
            if hop.most_rad_s2() <= self.acceleration_rad_s2 {
                return hop;
            }
            if half_ticks == LONGEST {
                let half_s = f32::from(half_ticks) * TICK_S;
                let way = within(target - estimate.position_rad, half_s * half_s * self.acceleration_rad_s2);
                return Hop::new(estimate, estimate.position_rad + way, half_ticks);
            }
            half_ticks += 1;
        }
    }
}

/// A motion to rest with one acceleration for half its time and another for the other half.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hop {
    from: Setpoint,
    second_rad_s2: f32,
    half_ticks: u16,
    tick: u16,
}

impl Hop {
    fn new(estimate: &Estimate, target_rad: f32, half_ticks: u16) -> Self {
        let half_s = f32::from(half_ticks) * TICK_S;
        let (at, speed) = (estimate.position_rad, estimate.velocity_rad_s);
        let first = (target_rad - at - 1.5 * half_s * speed) / (half_s * half_s);
        Self {
            from: Setpoint { position_rad: at, velocity_rad_s: speed, acceleration_rad_s2: first },
            second_rad_s2: -speed / half_s - first,
            half_ticks,
            tick: 0,
        }
    }

    fn most_rad_s2(&self) -> f32 {
        self.from.acceleration_rad_s2.abs().max(self.second_rad_s2.abs())
    }

    const fn is_over(&self) -> bool {
        self.tick >= 2 * self.half_ticks
    }

    fn end_rad(&self) -> f32 {
        self.at(f32::from(2 * self.half_ticks)).position_rad
    }

    /// Now and half a tick later.
    fn tick(&mut self) -> (Setpoint, Setpoint) {
        let tick = f32::from(self.tick);
        self.tick += 1;
        (self.at(tick), self.at(tick + 0.5))
    }

    fn at(&self, tick: f32) -> Setpoint {
        let half = f32::from(self.half_ticks);
        if tick < half {
            return after(&self.from, tick * TICK_S);
        }
        let turn = Setpoint { acceleration_rad_s2: self.second_rad_s2, ..after(&self.from, half * TICK_S) };
        after(&turn, (tick - half) * TICK_S)
    }
}

/// So far ahead it is seen what a plan does, ticks: most hops are over then.
const SEEN_TICKS: f32 = 16.0;

/// The plan now, with no more acceleration than takes it where it will be: a push that is soon over takes it nowhere, and one that is to come is the next hop's.
#[cold]
fn as_planned(now: &Setpoint, later_rad: impl Fn(f32) -> f32) -> Setpoint {
    let time_s = SEEN_TICKS * TICK_S;
    let as_now_rad = after(now, time_s).position_rad - now.position_rad;
    let planned_rad = later_rad(SEEN_TICKS) - now.position_rad;
    if as_now_rad.abs() <= planned_rad.abs() && as_now_rad * planned_rad >= 0.0 {
        return *now;
    }
    let acceleration_rad_s2 = 2.0 * (planned_rad - time_s * now.velocity_rad_s) / (time_s * time_s);
    Setpoint { acceleration_rad_s2, ..*now }
}

/// A motion that goes on as it is.
fn after(now: &Setpoint, time_s: f32) -> Setpoint {
    let faster = time_s * now.acceleration_rad_s2;
    Setpoint {
        position_rad: now.position_rad + time_s * (now.velocity_rad_s + 0.5 * faster),
        velocity_rad_s: now.velocity_rad_s + faster,
        acceleration_rad_s2: now.acceleration_rad_s2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CREEP: Creep = Creep { below_rad_s: 0.02, turn_s: 0.02, hop_rad: 9e-5, acceleration_rad_s2: 5.0 };

    fn estimate(setpoint: &Setpoint) -> Estimate {
        Estimate {
            position_rad: setpoint.position_rad,
            velocity_rad_s: setpoint.velocity_rad_s,
            ..Estimate::default()
        }
    }

    /// A joint that does what it is told follows this plan, angle and speed over time: how it went, tick by tick.
    fn followed(plan: impl Fn(f32) -> Setpoint, ticks: usize) -> impl Iterator<Item = (Setpoint, Setpoint)> {
        let (mut pace, mut at) = (Pace::default(), plan(0.0));
        (0..ticks).map(move |tick| {
            let time_s = tick as f32 * TICK_S;
            let planned = plan(time_s);
            let later_rad = |ticks: f32| plan(time_s + ticks * TICK_S).position_rad;
            let ahead = plan(time_s + 0.5 * TICK_S);
            let (now, _) = pace.tick(&CREEP, &estimate(&at), (&planned, &ahead), later_rad);
            at = now;
            (planned, now)
        })
    }

    fn steady(speed: f32) -> impl Fn(f32) -> Setpoint {
        move |time_s| Setpoint {
            position_rad: speed * time_s,
            velocity_rad_s: speed,
            acceleration_rad_s2: 0.0,
        }
    }

    #[test]
    fn a_slow_plan_is_followed_from_rest_to_rest_within_two_thirds_of_a_hop() {
        for speed in [0.0005, -0.002, 0.005, -0.01] {
            let (mut rests, mut hops) = (0, 0);
            for (planned, now) in followed(steady(speed), 2000) {
                let off = now.position_rad - planned.position_rad;
                assert!(off.abs() <= 0.67 * CREEP.hop_rad, "{speed}: {off}");
                assert!(now.velocity_rad_s * speed >= -1e-9, "{speed}: back by {now:?}");
                assert!(now.acceleration_rad_s2.abs() <= 1.001 * CREEP.acceleration_rad_s2, "{now:?}");
                *if now.velocity_rad_s == 0.0 { &mut rests } else { &mut hops } += 1;
            }
            assert!(rests > 100 && hops > 50, "{speed}: {rests} {hops}");
        }
    }

    #[test]
    fn a_plan_that_is_not_slow_or_only_turns_round_is_followed_as_it_is() {
        let turning = |time_s: f32| {
            let left = time_s - 0.5;
            Setpoint { position_rad: 0.6 * left * left, velocity_rad_s: 1.2 * left, acceleration_rad_s2: 1.2 }
        };
        for (planned, now) in followed(steady(0.03), 1000).chain(followed(turning, 1000)) {
            assert_eq!(planned, now);
        }
    }

    /// A slow plan that is pushed at a moment, for some ticks there and as many back, as where a camera has moved two segments.
    fn pushed(begins_s: f32) -> impl Fn(f32) -> Setpoint {
        const PUSH_RAD_S2: f32 = 1.5;
        const LASTS_S: f32 = 3e-3;
        move |time_s| {
            let since = |part: f32| (time_s - begins_s - part * LASTS_S).max(0.0);
            let sum = |of: &dyn Fn(f32) -> f32| of(since(0.0)) - 2.0 * of(since(1.0)) + of(since(2.0));
            let slow = steady(0.004)(time_s);
            Setpoint {
                position_rad: slow.position_rad + sum(&|t| 0.5 * PUSH_RAD_S2 * t * t),
                velocity_rad_s: slow.velocity_rad_s + sum(&|t| PUSH_RAD_S2 * t),
                acceleration_rad_s2: sum(&|t| if t > 0.0 { PUSH_RAD_S2 } else { 0.0 }),
            }
        }
    }

    #[test]
    fn a_push_that_is_soon_over_is_not_gone_ahead_of() {
        let ahead = |begins_s: f32| {
            let way = followed(pushed(begins_s), 800);
            way.map(|(planned, now)| now.position_rad - planned.position_rad).fold(0.0, f32::max)
        };
        let furthest = (0..60).map(|k| ahead(0.4 + 1e-3 * k as f32)).fold(0.0, f32::max);
        assert!(furthest <= CREEP.hop_rad, "{furthest}");
    }

    #[test]
    fn a_hop_ends_at_rest_where_it_was_to_end() {
        for (target, speed) in [(1e-4, 0.0), (-3e-3, 0.0), (2e-4, 0.01), (0.0, -0.01)] {
            let hop = Hop::new(&Estimate { velocity_rad_s: speed, ..Estimate::default() }, target, 6);
            let end = hop.at(12.0);
            assert!((end.position_rad - target).abs() < 1e-8 && end.velocity_rad_s.abs() < 1e-6, "{end:?}");
        }
    }
}
