use tracelight_rig::{PanTilt, Segment, Setpoint, TICK_S};

/// Segments the controller can hold ahead of time.
pub const QUEUE_LENGTH: usize = 64;

/// Shortest time in which the plan's clock returns to full speed after a hold, s.
const RESUME_S: f32 = 0.15;

/// Acceleration that makes this time longer for fast motion: a quarter of what the weaker motor can do, rad/s². At 1 ft/s on a target
/// 3 ft away both times are alike.
const RESUME_RAD_S2: f32 = 2.2;

/// Largest step between the end of one segment and the start of the next that still counts as joined, rad.
const JOIN_RAD: f32 = 2e-4;

/// The plan's clock and the segments it runs through.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Player {
    queue: [Option<Segment>; QUEUE_LENGTH],
    head: usize,
    length: usize,
    /// How many of them want light.
    lit: usize,
    finished: bool,
    /// Plan time: whole ticks and a fraction.
    tick: u32,
    fraction: f32,
    /// Speed of the plan's clock, 0 to 1.
    rate: f32,
    /// Change of `rate`, 1/s.
    rate_slope: f32,
    /// Plan tick in which the gate rose that is open now.
    gate_rose: Option<u32>,
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

impl Player {
    pub(crate) fn resting_at(position_rad: PanTilt<f32>) -> Self {
        Self {
            queue: [None; QUEUE_LENGTH],
            head: 0,
            length: 0,
            lit: 0,
            finished: false,
            tick: 0,
            fraction: 0.0,
            rate: 1.0,
            rate_slope: 0.0,
            gate_rose: None,
            rest: position_rad.map(at_rest),
            end: None,
        }
    }

    /// Whether another segment fits.
    pub(crate) const fn has_room(&self) -> bool {
        self.length < QUEUE_LENGTH
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
        self.queue[(self.head + self.length) % QUEUE_LENGTH] = Some(segment);
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
            self.finished = false;
            self.end = None;
        }
    }

    /// Forgets what is queued; from now on the joints are to rest at zero.
    pub(crate) fn abandon(&mut self) {
        *self = Self { finished: true, ..Self::resting_at(PanTilt::default()) };
    }

    /// Whether the plan's clock has left its start.
    pub(crate) fn has_begun(&self) -> bool {
        self.tick > 0 || self.fraction > 0.0
    }

    pub(crate) const fn plan_tick(&self) -> u32 {
        self.tick
    }

    /// Whether light that follows the gate after `delay_ticks` falls where it is wanted. A plan's gate rises that much before its
    /// stroke; a clock that gets under way from within that lead is too slow for it, and the gate has to wait.
    pub(crate) fn light_is_due(&self, delay_ticks: u32) -> bool {
        let Some(rose) = self.gate_rose else { return true };
        self.since(rose) + self.rate * delay_ticks as f32 >= delay_ticks as f32
    }

    /// Nothing left to play and nothing to come.
    pub(crate) const fn is_done(&self) -> bool {
        self.length == 0 && self.finished
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

    /// Motion by true time of a plan whose clock runs at `rate`: q̇ = q′ρ, q̈ = q″ρ² + q′ρ̇.
    fn scaled(&self, planned: PanTilt<Setpoint>, rate: f32) -> PanTilt<Setpoint> {
        planned.map(|s| Setpoint {
            position_rad: s.position_rad,
            velocity_rad_s: s.velocity_rad_s * rate,
            acceleration_rad_s2: s.acceleration_rad_s2 * rate * rate + s.velocity_rad_s * self.rate_slope,
        })
    }

    /// Stops the plan's clock on the spot. One that has not left its start keeps its full speed for it.
    pub(crate) fn hold(&mut self) {
        if self.has_begun() {
            self.rate = 0.0;
            self.rate_slope = 0.0;
        }
    }

    /// Lets one tick of true time pass; after a hold the plan's clock speeds up gently.
    pub(crate) fn advance(&mut self) {
        if self.length == 0 {
            return;
        }
        let before = self.rate;
        if before == 0.0 {
            self.rate_slope = 1.0 / RESUME_S.max(self.planned_rad_s() / RESUME_RAD_S2);
        }
        self.rate += self.rate_slope * TICK_S;
        if self.rate >= 1.0 {
            self.rate = 1.0;
            self.rate_slope = 0.0;
        }
        self.fraction += 0.5 * (before + self.rate);
        // back on whole ticks once at full speed would jump; the fraction simply stays
        if self.fraction >= 1.0 {
            self.fraction -= 1.0;
            self.tick = self.tick.saturating_add(1);
        }
        self.drop_passed();
        self.watch_gate();
    }

    /// Speed of the faster joint where the plan stands, rad/s.
    fn planned_rad_s(&self) -> f32 {
        let Some(segment) = self.current() else { return 0.0 };
        let planned = segment.sample(self.since(segment.start_tick));
        planned.pan.velocity_rad_s.abs().max(planned.tilt.velocity_rad_s.abs())
    }

    fn drop_passed(&mut self) {
        while let Some(segment) = self.current() {
            if self.tick < segment.end_tick() {
                return;
            }
            self.rest = segment.sample(f32::from(segment.ticks)).map(|s| at_rest(s.position_rad));
            self.queue[self.head % QUEUE_LENGTH] = None;
            self.head = (self.head + 1) % QUEUE_LENGTH;
            self.length -= 1;
            self.lit -= usize::from(segment.gate);
        }
    }

    fn watch_gate(&mut self) {
        self.gate_rose = match self.current() {
            Some(segment) if segment.gate => self.gate_rose.or(Some(segment.start_tick)),
            _ => None,
        };
    }

    /// Plan time since a tick that has begun, ticks.
    fn since(&self, tick: u32) -> f32 {
        (self.tick - tick) as f32 + self.fraction
    }

    fn current(&self) -> Option<Segment> {
        self.queue[self.head % QUEUE_LENGTH]
    }
}

/// A joint that rests at an angle, rad.
pub(crate) fn at_rest(position_rad: f32) -> Setpoint {
    Setpoint { position_rad, ..Setpoint::default() }
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
        };
        let near_the_end = Player { tick: u32::MAX - 8, ..Player::resting_at(PanTilt::default()) };
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
