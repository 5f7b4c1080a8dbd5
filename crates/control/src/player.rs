use tracelight_rig::{Joint, PanTilt, SPEED_RANGE, Segment, Setpoint, TICK_S, ease_within};

use crate::elementary::root;
use crate::limit::within;

/// Segments that a controller holds ahead of time unless it is told otherwise.
pub const QUEUE_LENGTH: usize = 64;

/// Largest step between the end of one segment and the start of the next that still counts as joined, rad.
const JOIN_RAD: f32 = 2e-4;

/// The plan's clock and the segments it runs through.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Player<const SEGMENTS: usize> {
    queue: [Option<Segment>; SEGMENTS],
    head: usize,
    length: usize,
    /// How many of them want light.
    lit: usize,
    finished: bool,
    /// Plan time: whole ticks and a fraction.
    tick: u32,
    fraction: f32,
    /// Rate of the plan's clock that is asked for.
    asked_rate: f32,
    /// Rate of the plan's clock now.
    rate: f32,
    /// How `rate` changes until the next tick, 1/s.
    rate_slope: f32,
    /// Plan tick in which the gate rose that is open now.
    gate_rose: Option<u32>,
    /// Plan tick in which it fell that is shut now.
    gate_fell: Option<u32>,
    /// Whether the clock is to stop at the end of the stroke that is lit.
    pausing: bool,
    /// Ticks for which the clock runs on, so that light that is still on its way out falls on its stroke.
    runs_on_ticks: u32,
    /// Where the joints rest while there is nothing to play.
    rest: PanTilt<Setpoint>,
    /// End of the newest segment: tick, and position.
    end: Option<(u32, PanTilt<f32>)>,
}

/// What the player has for a tick.
pub(crate) struct Played {
    /// Setpoint now.
    pub(crate) setpoint: PanTilt<Setpoint>,
    /// Setpoint half a tick later.
    pub(crate) ahead: PanTilt<Setpoint>,
    /// The segment they come from; `None` when resting.
    pub(crate) segment: Option<Segment>,
}

impl<const SEGMENTS: usize> Player<SEGMENTS> {
    pub(crate) fn resting_at(position_rad: PanTilt<f32>) -> Self {
        Self {
            queue: [None; SEGMENTS],
            head: 0,
            length: 0,
            lit: 0,
            finished: false,
            tick: 0,
            fraction: 0.0,
            asked_rate: 1.0,
            rate: 1.0,
            rate_slope: 0.0,
            gate_rose: None,
            gate_fell: None,
            pausing: false,
            runs_on_ticks: 0,
            rest: position_rad.map(Setpoint::at_rest),
            end: None,
        }
    }

    /// Forgets its job and rests somewhere, with the speed that was asked for. In place: a queue is too large for the stack of a tick.
    pub(crate) fn rest_at(&mut self, position_rad: PanTilt<f32>) {
        for i in 0..self.length {
            self.queue[(self.head + i) % SEGMENTS] = None;
        }
        let none = Player::<0>::resting_at(position_rad);
        // every field, or it is not compiled
        let Self {
            queue: _,
            asked_rate: _,
            head,
            length,
            lit,
            finished,
            tick,
            fraction,
            rate,
            rate_slope,
            gate_rose,
            gate_fell,
            pausing,
            runs_on_ticks,
            rest,
            end,
        } = self;
        (*head, *length, *lit, *finished) = (none.head, none.length, none.lit, none.finished);
        (*tick, *fraction, *rate) = (none.tick, none.fraction, none.rate);
        (*rate_slope, *gate_rose, *gate_fell) = (none.rate_slope, none.gate_rose, none.gate_fell);
        (*pausing, *runs_on_ticks, *rest, *end) = (none.pausing, none.runs_on_ticks, none.rest, none.end);
    }

    /// Likewise, as one that just begins.
    pub(crate) fn begin_anew(&mut self, position_rad: PanTilt<f32>) {
        self.rest_at(position_rad);
        self.asked_rate = 1.0;
    }

    /// Segments that there is room for.
    pub(crate) const fn room(&self) -> usize {
        SEGMENTS - self.length
    }

    /// Whether another segment fits.
    pub(crate) const fn has_room(&self) -> bool {
        self.length < SEGMENTS
    }

    /// Appends a segment; false when it does not join the one before it in time and place, comes after the last, or ends
    /// later than can be counted.
    pub(crate) fn append(&mut self, segment: Segment) -> bool {
        let from = segment.sample(0.0).map(|s| s.position_rad);
        let (tick, place) = self.end.unwrap_or((self.tick, self.rest.map(|s| s.position_rad)));
        // a first segment may start anywhere within a count of where the head was homed
        let reach = if self.end.is_some() { JOIN_RAD } else { 10.0 * JOIN_RAD };
        let near = |a: f32, b: f32| (a - b).abs() <= reach;
        let joins = segment.start_tick == tick && near(from.pan, place.pan) && near(from.tilt, place.tilt);
        if !joins || !segment.fits() || segment.ticks == 0 || self.finished || !self.has_room() {
            return false;
        }
        self.queue[(self.head + self.length) % SEGMENTS] = Some(segment);
        self.length += 1;
        self.lit += usize::from(segment.gate);
        self.watch_gate();
        let end = segment.sample(f32::from(segment.ticks)).map(|s| s.position_rad);
        self.end = Some((segment.end_tick(), end));
        true
    }

    pub(crate) fn finish(&mut self) {
        self.finished = true;
    }

    /// Makes ready for another job after one that is done.
    pub(crate) fn reopen(&mut self) {
        if self.is_done() {
            self.tick = 0;
            self.fraction = 0.0;
            self.rate = 1.0;
            self.rate_slope = 0.0;
            self.gate_fell = None;
            self.finished = false;
            self.end = None;
        }
    }

    /// Sets the rate of the plan's clock, within its bounds.
    pub(crate) fn ask_rate(&mut self, rate: f32) {
        if !rate.is_nan() {
            self.asked_rate = rate.clamp(SPEED_RANGE.0, SPEED_RANGE.1);
        }
    }

    /// Forgets what is queued; from now on the joints are to rest at zero.
    pub(crate) fn abandon(&mut self) {
        self.rest_at(PanTilt::default());
        self.finished = true;
    }

    /// Whether the plan's clock has left its start.
    pub(crate) fn has_begun(&self) -> bool {
        self.tick > 0 || self.fraction > 0.0
    }

    pub(crate) const fn plan_tick(&self) -> u32 {
        self.tick
    }

    /// Whether light that follows the gate after `delay_ticks` falls where it is wanted.
    pub(crate) fn light_is_due(&self, delay_ticks: u32) -> bool {
        self.gate_rose.is_none_or(|rose| self.since(rose) >= self.later(delay_ticks))
    }

    /// Whether the gate is to be open, of a plan whose gate leads its light by these delays at the plan's own speed. What opens later than the plan's own gate has
    /// to wait for [`light_is_due`](Self::light_is_due).
    pub(crate) fn wants_light(&self, on_ticks: u32, off_ticks: u32) -> bool {
        let Some(segment) = self.current() else { return false };
        if self.rate == 0.0 {
            return segment.gate;
        }
        if segment.gate {
            return !self.changes_within(-self.later(off_ticks));
        }
        let shuts_late = self.gate_fell.is_some_and(|fell| self.since(fell) < self.later(off_ticks));
        shuts_late || self.changes_within(-self.later(on_ticks))
    }

    /// How much later than in the plan, in plan time, the gate changes whose light follows after a delay, ticks. A clock that runs faster needs a longer lead, one that
    /// runs slower a shorter one. The gate changes only at a tick: at the nearest.
    fn later(&self, delay_ticks: u32) -> f32 {
        delay_ticks as f32 * (1.0 - self.rate) - 0.5 * self.rate
    }

    /// Whether the plan's gate changes within so many ticks of its clock.
    fn changes_within(&self, ticks: f32) -> bool {
        let queued = (0..self.length).filter_map(|i| self.queue[(self.head + i) % SEGMENTS]);
        let mut soon = queued.take_while(|segment| -self.since(segment.start_tick) <= ticks);
        soon.next().is_some_and(|now| soon.any(|next| next.gate != now.gate))
    }

    /// Asks the clock to stop at the end of the stroke that is lit, or takes that back.
    pub(crate) fn pause(&mut self, pausing: bool) {
        self.pausing = pausing;
    }

    /// Whether it was asked to stop, and no light of a stroke is on its way out any more.
    pub(crate) fn may_pause(&self, off_ticks: u32) -> bool {
        let is_out = self.gate_fell.is_none_or(|fell| self.since(fell) >= off_ticks as f32);
        self.pausing && is_out && self.current().is_some_and(|segment| !segment.gate)
    }

    /// Stops the clock in so many ticks.
    pub(crate) fn stop_in(&mut self, ticks: u32) {
        self.pausing = false;
        self.runs_on_ticks = ticks;
        if ticks == 0 {
            self.hold();
        }
    }

    /// Whether it is about to stop.
    pub(crate) const fn runs_on(&self) -> bool {
        self.runs_on_ticks > 0
    }

    /// A tick of a clock that is about to stop.
    pub(crate) fn run_on(&mut self) {
        if self.runs_on_ticks > 0 {
            self.advance();
            self.stop_in(self.runs_on_ticks - 1);
        }
    }

    /// Nothing left to play and nothing to come.
    pub(crate) const fn is_done(&self) -> bool {
        self.length == 0 && self.finished
    }

    /// Whether so many ticks of a plan are there, or all of it.
    pub(crate) fn has_ahead(&self, ticks: u32) -> bool {
        self.finished
            || !self.has_room()
            || self.end.is_some_and(|(end, _)| end.saturating_sub(self.tick) >= ticks)
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Whether anything that is queued wants light.
    pub(crate) const fn has_light(&self) -> bool {
        self.lit > 0
    }

    /// Setpoints at the plan's present time.
    pub(crate) fn play(&self) -> Played {
        let Some(segment) = self.current() else {
            return Played { setpoint: self.rest, ahead: self.rest, segment: None };
        };
        let elapsed = self.since(segment.start_tick);
        let later = self.rate + 0.5 * TICK_S * self.rate_slope;
        Played {
            setpoint: self.scaled(segment.sample(elapsed), self.rate),
            ahead: self.scaled(segment.sample(elapsed + 0.5 * later), later),
            segment: Some(segment),
        }
    }

    /// Where the plan will have a joint in so many ticks of true time, if its clock goes on as it does, rad.
    #[cold]
    pub(crate) fn later_rad(&self, joint: Joint, ticks: f32) -> f32 {
        let later = ticks * self.rate;
        let queued = (0..self.length).filter_map(|i| self.queue[(self.head + i) % SEGMENTS].as_ref());
        let mut until = None;
        for segment in queued {
            let elapsed = self.since(segment.start_tick) + later;
            if elapsed < 0.0 {
                break;
            }
            until = Some((segment, elapsed.min(f32::from(segment.ticks))));
        }
        until.map_or(self.rest[joint].position_rad, |(segment, elapsed)| segment.position_rad(joint, elapsed))
    }

    /// Motion by true time of a plan whose clock runs at `rate`: q̇ = q′ρ, q̈ = q″ρ² + q′ρ̇.
    fn scaled(&self, planned: PanTilt<Setpoint>, rate: f32) -> PanTilt<Setpoint> {
        planned.map(|s| Setpoint {
            position_rad: s.position_rad,
            velocity_rad_s: s.velocity_rad_s * rate,
            acceleration_rad_s2: s.acceleration_rad_s2 * rate * rate + s.velocity_rad_s * self.rate_slope,
        })
    }

    /// Stops the plan's clock on the spot. One that has not left its start keeps its speed for it.
    pub(crate) fn hold(&mut self) {
        self.runs_on_ticks = 0;
        if self.has_begun() {
            self.rate = 0.0;
            self.rate_slope = 0.0;
        }
    }

    /// Lets one tick of true time pass; the rate of the plan's clock eases to what is asked.
    pub(crate) fn advance(&mut self) {
        if self.length == 0 {
            return;
        }
        if !self.has_begun() {
            // whatever the rate, it begins at rest
            self.rate = self.highest_rate();
            self.rate_slope = 0.0;
        } else if self.rate == 0.0 {
            self.rate_slope = self.slope();
        }
        let before = self.rate;
        self.rate = before + self.rate_slope * TICK_S;
        if (self.rate - self.asked_rate).abs() < 1e-6 {
            self.rate = self.asked_rate;
        }
        self.fraction += 0.5 * (before + self.rate);
        // back on whole ticks once at full speed would jump; the fraction simply stays
        while self.fraction >= 1.0 {
            self.fraction -= 1.0;
            self.tick = self.tick.saturating_add(1);
        }
        self.drop_passed();
        self.watch_gate();
        self.rate_slope = self.slope();
    }

    /// How the rate changes until the next tick, 1/s.
    fn slope(&self) -> f32 {
        let wanted = self.highest_rate();
        if wanted == self.rate {
            return 0.0;
        }
        let Some(segment) = self.current() else { return 0.0 };
        let planned = segment.sample(self.since(segment.start_tick));
        let most = ease_within(&planned, self.rate, wanted > self.rate);
        within((wanted - self.rate) / TICK_S, most)
    }

    /// The rate that is asked for, or the most that is allowed where the clock will be in a tick.
    fn highest_rate(&self) -> f32 {
        if self.asked_rate <= 1.0 {
            return self.asked_rate;
        }
        let limit = self.current().map_or(1.0, |segment| {
            root(segment.rate_limit_squared(self.since(segment.start_tick) + self.rate))
        });
        self.asked_rate.min(limit)
    }

    fn drop_passed(&mut self) {
        while let Some(segment) = self.current() {
            if self.tick < segment.end_tick() {
                return;
            }
            self.rest = segment.sample(f32::from(segment.ticks)).map(|s| Setpoint::at_rest(s.position_rad));
            self.queue[self.head % SEGMENTS] = None;
            self.head = (self.head + 1) % SEGMENTS;
            self.length -= 1;
            self.lit -= usize::from(segment.gate);
        }
    }

    fn watch_gate(&mut self) {
        let Some(segment) = self.current() else {
            self.gate_rose = None;
            return;
        };
        if segment.gate {
            self.gate_rose = self.gate_rose.or(Some(segment.start_tick));
            self.gate_fell = None;
        } else if self.gate_rose.take().is_some() {
            self.gate_fell = Some(segment.start_tick);
        }
    }

    /// Plan time since a tick, ticks; negative before it.
    fn since(&self, tick: u32) -> f32 {
        self.tick.wrapping_sub(tick).cast_signed() as f32 + self.fraction
    }

    fn current(&self) -> Option<Segment> {
        self.queue[self.head % SEGMENTS]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_whose_end_cannot_be_counted_is_refused() {
        let tolerance_rad = PanTilt::new(1e-3, 1e-3);
        let still = |start_tick, ticks| Segment {
            start_tick,
            ticks,
            coefficients: PanTilt::default(),
            tolerance_rad,
            gate: false,
            rate_limit: tracelight_rig::RateLimit::PLANNED,
        };
        let near_the_end =
            Player::<QUEUE_LENGTH> { tick: u32::MAX - 8, ..Player::resting_at(PanTilt::default()) };
        for (ticks, fits) in [(8, true), (9, false), (u16::MAX, false)] {
            let mut player = near_the_end;
            assert_eq!(player.append(still(u32::MAX - 8, ticks)), fits, "{ticks}");
        }
        // there it ends
        let mut player = near_the_end;
        assert!(player.append(still(u32::MAX - 8, 8)));
        player.finish();
        (0..20).for_each(|_| player.advance());
        assert!(player.is_done());
    }
}
